"""Checks of arguments: each returns the value as the messages have it, or raises InvalidArgument with the argument's name,
its value and what to give instead. Ranges that belong to a scene are the server's to check.

>>> whole("ticks", 3)
3
>>> whole("ticks", 1.5)
Traceback (most recent call last):
    ...
phrenic.errors.InvalidArgument: ticks: 1.5 is not a whole number: give an int
"""

from __future__ import annotations

import math
import operator
from pathlib import Path
from typing import Any, Mapping, Sequence

import numpy as np

from .errors import InvalidArgument

INT32 = 2**31 - 1
INT64 = 2**63 - 1


def whole(name: str, value: Any, least: int = 0, most: int = INT64) -> int:
    """Returns a whole number from `least` to `most`; numpy's too, but not a bool."""
    try:
        number = None if isinstance(value, bool) else operator.index(value)
    except TypeError:
        number = None
    if number is None:
        raise InvalidArgument(f"{name}: {_shown(value)} is not a whole number: give an int")
    if not least <= number <= most:
        raise InvalidArgument(f"{name}: {number} is outside {least} to {most}")
    return number


def finite(name: str, value: Any, least: float = -math.inf) -> float:
    """Returns a finite number, not below `least`."""
    try:
        number = math.nan if isinstance(value, (str, bytes)) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not math.isfinite(number):
        raise InvalidArgument(f"{name}: {_shown(value)} is not a finite number: give a float")
    if number < least:
        raise InvalidArgument(f"{name}: {number:g} is below {least:g}")
    return number


def positive(name: str, value: Any) -> float:
    """Returns a finite number above 0."""
    number = finite(name, value)
    if number <= 0:
        raise InvalidArgument(f"{name}: {number:g} is not above 0")
    return number


def text_of(name: str, value: Any) -> str:
    """Returns a text that a message can have."""
    if not isinstance(value, str):
        raise InvalidArgument(f"{name}: {_shown(value)} is not a text: give a str")
    try:
        value.encode("utf-8")
    except UnicodeEncodeError as error:
        raise InvalidArgument(f"{name}: {_shown(value)} cannot be written in UTF-8: {error.reason}") from None
    return value


def names_of(name: str, value: Any) -> Sequence[str]:
    """Returns several texts. One text alone, whose letters would be taken for names, is refused."""
    if isinstance(value, str):
        raise InvalidArgument(f'{name}: give names in a tuple: ("{value}",)')
    try:
        return tuple(text_of(name, each) for each in value)
    except TypeError:
        raise InvalidArgument(f"{name}: {_shown(value)} is not a list of names") from None


def mapping(name: str, value: Any) -> Mapping[str, Any]:
    """Returns values by name; none for None."""
    if value is None:
        return {}
    if not isinstance(value, Mapping):
        raise InvalidArgument(f"{name}: {_shown(value)} is not a dict: give {{name: value}}")
    return value


def vector(name: str, value: Any) -> tuple[float, float, float]:
    """Returns three finite numbers."""
    try:
        numbers = [finite(name, each) for each in value]
    except TypeError:
        numbers = []
    if len(numbers) != 3:
        raise InvalidArgument(f"{name}: {_shown(value)} has not three numbers: give (x, y, z)")
    return numbers[0], numbers[1], numbers[2]


def path_of(name: str, value: Any) -> Path:
    """Returns the path of a file."""
    if not isinstance(value, (str, Path)):
        raise InvalidArgument(f"{name}: {_shown(value)} is not the path of a file: give a str or Path")
    return Path(value)


def new_file(name: str, value: Any) -> Path:
    """Returns the path of a file that is to be written, in a folder that is there."""
    path = path_of(name, value)
    if not path.parent.is_dir():
        raise InvalidArgument(f"{name}: there is no folder {path.parent}: make it first")
    return path


def rows_of(name: str, value: Any, width: int) -> np.ndarray:
    """Returns rows of `width` numbers, as an array of float64."""
    try:
        rows = np.asarray(value, float)
    except (TypeError, ValueError):
        rows = np.zeros(0)
    if rows.size == 0 and value is not None and np.size(value) == 0:
        return np.zeros((0, width))
    if rows.ndim != 2 or rows.shape[1] != width:
        raise InvalidArgument(f"{name}: {_shown(value)} is not a list of rows of {width} numbers")
    return rows


def _shown(value: Any) -> str:
    """The value, shortened."""
    text = repr(value)
    return text if len(text) <= 60 else f"{text[:60]}..."
