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
        package = module.partition(".")[0]
        if (error.name or "").partition(".")[0] != package:
            raise  # the package is there, and lacks something itself
        raise ModuleNotFoundError(f"{what} needs {package}: {remedy}", name=package) from None
