"""Tables of results.

>>> table = Table([{"what": "tidal volume", "value": 0.5}, {"what": "rate", "value": 12.0}])
>>> table["value"]
array([ 0.5, 12. ])
>>> len(table), table[0]["what"]
(2, 'tidal volume')
>>> print(table)
what          value
tidal volume    0.5
rate             12
"""

from __future__ import annotations

import csv
import io
import json
import math
from html import escape
from pathlib import Path
from typing import Any, Iterable, Iterator, Optional, Sequence, Union, overload

import numpy as np
from google.protobuf.message import Message

from .names import nearest, row
from .optional import need


class Table(Sequence[dict[str, Any]]):
    """Rows of named values; `table["column"]` is a numpy array. A value that could not be determined is None in a row
    and NaN in a column of numbers."""

    def __init__(self, rows: Iterable[dict[str, Any]]) -> None:
        self._rows = list(rows)

    @classmethod
    def of(cls, messages: Iterable[Message]) -> "Table":
        """Returns a table with a row a message."""
        return cls(row(message) for message in messages)

    @property
    def columns(self) -> list[str]:
        """The names of the columns that any row has, in the order in which they come."""
        return list(dict.fromkeys(name for each in self._rows for name in each))

    @overload
    def __getitem__(self, key: int) -> dict[str, Any]: ...

    @overload
    def __getitem__(self, key: slice) -> "Table": ...

    @overload
    def __getitem__(self, key: str) -> np.ndarray: ...

    def __getitem__(self, key: Any) -> Any:
        if isinstance(key, str):
            return self._column(key)
        return Table(self._rows[key]) if isinstance(key, slice) else self._rows[key]

    def _column(self, name: str) -> np.ndarray:
        if name not in self.columns:
            raise KeyError(f"there is no column {name}: {nearest(name, self.columns)}")
        column = [each.get(name) for each in self._rows]
        numbers = any(isinstance(value, float) for value in column)
        return np.array([np.nan if numbers and value is None else value for value in column])

    def __len__(self) -> int:
        return len(self._rows)

    def __iter__(self) -> Iterator[dict[str, Any]]:
        return iter(self._rows)

    def where(self, **conditions: Any) -> "Table":
        """Returns the rows whose columns have these values."""
        return Table(r for r in self._rows if all(r.get(name) == value for name, value in conditions.items()))

    def to_pandas(self) -> Any:
        """Returns a pandas.DataFrame. Requires: pandas is installed."""
        pandas = need("pandas", "to_pandas", "apt install python3-pandas, or pip install pandas")
        return pandas.DataFrame(self._rows, columns=self.columns)

    def to_csv(self, path: Union[str, Path, None] = None) -> str:
        """Returns the table as CSV (RFC 4180), and writes it to `path`. Numbers have all their digits, a missing value is
        an empty cell, a list is JSON.

        >>> Table([{"what": "rate", "value": 0.1}, {"what": "peak, deep", "value": None}]).to_csv().splitlines()
        ['what,value', 'rate,0.1', '"peak, deep",']
        """
        text = io.StringIO(newline="")
        lines = csv.writer(text)
        names = self.columns
        lines.writerow(names)
        lines.writerows([_csv_cell(r.get(name)) for name in names] for r in self._rows)
        return _written(text.getvalue(), path)

    def to_json_lines(self, path: Union[str, Path, None] = None) -> str:
        """Returns a JSON document a row, each on its line, and writes them to `path`. NaN and infinity are null, as JSON
        has no such numbers.

        >>> Table([{"what": "rate", "value": 12.0}, {"what": "peak", "value": float("nan")}]).to_json_lines()
        '{"what": "rate", "value": 12.0}\\n{"what": "peak", "value": null}\\n'
        """
        lines = (json.dumps(_json(r), ensure_ascii=False, allow_nan=False) + "\n" for r in self._rows)
        return _written("".join(lines), path)

    def to_parquet(self, path: Union[str, Path]) -> None:
        """Writes an Apache Parquet file. Requires: pyarrow is installed."""
        names = self.columns
        pyarrow = need("pyarrow", "to_parquet", "pip install pyarrow (Debian 12 has no package of it), or use to_csv")
        need("pyarrow.parquet", "to_parquet", "pip install pyarrow").write_table(
            pyarrow.Table.from_pylist([{name: _plain(r.get(name)) for name in names} for r in self._rows]), path
        )

    def __str__(self) -> str:
        if not self._rows:
            return "(no rows)"
        names = self.columns
        cells = [names] + [[_cell(r.get(name)) for name in names] for r in self._rows]
        widths = [max(len(line[i]) for line in cells) for i in range(len(names))]
        numeric = [self._has_numbers(name) for name in names]
        return "\n".join(
            "  ".join(
                text.rjust(width) if right else text.ljust(width) for text, width, right in zip(line, widths, numeric)
            ).rstrip()
            for line in cells
        )

    def _has_numbers(self, name: str) -> bool:
        return any(isinstance(r.get(name), (int, float, np.number)) for r in self._rows)

    def _repr_html_(self) -> str:
        """The table as notebooks show it."""
        sides = {name: "right" if self._has_numbers(name) else "left" for name in self.columns}

        def cells(tag: str, texts: Iterable[str]) -> str:
            each = zip(texts, sides.values())
            return "".join(f'<{tag} style="text-align:{side}">{escape(text)}</{tag}>' for text, side in each)

        head = cells("th", self.columns)
        body = "".join(f"<tr>{cells('td', (_cell(r.get(name)) for name in sides))}</tr>" for r in self._rows)
        return f"<table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"

    def __repr__(self) -> str:
        return f"Table of {len(self)} rows: {', '.join(self.columns)}"


def _plain(value: Any) -> Any:
    """A number or list of numpy's as Python's."""
    return value.tolist() if isinstance(value, (np.generic, np.ndarray)) else value


def _csv_cell(value: Any) -> Any:
    value = _plain(value)
    return json.dumps(value, ensure_ascii=False) if isinstance(value, (list, dict)) else value


def _json(value: Any) -> Any:
    """The value without NaN and infinity, which become None."""
    value = _plain(value)
    if isinstance(value, dict):
        return {name: _json(each) for name, each in value.items()}
    if isinstance(value, (list, tuple)):
        return [_json(each) for each in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def _written(text: str, path: Optional[Union[str, Path]]) -> str:
    if path is not None:
        with open(path, "w", encoding="utf-8", newline="") as file:
            file.write(text)
    return text


def _cell(value: Any) -> str:
    if value is None:
        return "-"
    return f"{value:.4g}" if isinstance(value, (float, np.floating)) else str(value)
