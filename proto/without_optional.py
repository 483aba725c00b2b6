#!/usr/bin/env python3
"""Writes the protos for versions of protoc before 3.15, which do not accept explicit `optional`.

    proto/without_optional.py OUT           # OUT/phrenic/v1/*.proto

Each `optional T name = 1;` becomes `oneof _name { T name = 1; }`, which is what newer versions make of it: the same
bytes on the wire, and has_name() or HasField("name") as before.
"""

import re
import sys
from pathlib import Path

BEGIN = re.compile(r"^( *)optional +(?=[\w.]+ +(\w+) *=)", re.MULTILINE)


def end_of_statement(text: str, begin: int) -> int:
    """Returns the place after the statement's semicolon. Strings may have semicolons."""
    quote = ""
    place = begin
    while place < len(text):
        letter = text[place]
        if quote:
            if letter == "\\":
                place += 1
            elif letter == quote:
                quote = ""
        elif letter in "\"'":
            quote = letter
        elif letter == ";":
            return place + 1
        place += 1
    raise ValueError("a field has no semicolon")


def without_optional(text: str) -> str:
    """Returns the proto with a oneof in place of each `optional`; every line stays where it is.

    >>> without_optional('message A {\\n  optional int32 b = 1 [(help) = "c; d"];\\n  int32 e = 2;\\n}')
    'message A {\\n  oneof _b { int32 b = 1 [(help) = "c; d"]; }\\n  int32 e = 2;\\n}'
    """
    parts, place = [], 0
    while found := BEGIN.search(text, place):
        end = end_of_statement(text, found.end())
        parts += [text[place : found.start()], found[1], f"oneof _{found[2]} {{ {text[found.end() : end]} }}"]
        place = end
    return "".join(parts) + text[place:]


def main() -> None:
    if len(sys.argv) != 2 or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    protos = Path(__file__).resolve().parent
    for path in sorted(protos.glob("phrenic/v1/*.proto")):
        out = Path(sys.argv[1], path.relative_to(protos))
        out.parent.mkdir(parents=True, exist_ok=True)
        out.write_text(without_optional(path.read_text(encoding="utf-8")), encoding="utf-8")


if __name__ == "__main__":
    main()
