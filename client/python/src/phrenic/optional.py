"""Packages that only some functions need."""

from __future__ import annotations

from importlib import import_module
from typing import Any


def need(module: str, what: str, remedy: str) -> Any:
    """Imports a package that `what` needs. ModuleNotFoundError says how to install it.

    >>> need("no_such_package", "to_parquet", "pip install no-such-package")
    Traceback (most recent call last):
        ...
    ModuleNotFoundError: to_parquet needs no_such_package: pip install no-such-package
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module.partition(".")[0]:
            raise
        raise ModuleNotFoundError(f"{what} needs {error.name}: {remedy}", name=error.name) from None
