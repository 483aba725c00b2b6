"""Results of checks in the JUnit XML format, which test runners and CI read; as `phrenic ... --junit` writes it."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path
from typing import Optional, Sequence, Union
from xml.etree import ElementTree


@dataclass(frozen=True)
class Check:
    """One check."""

    name: str
    failure: str = ""
    """Why it failed; empty if it did not."""
    skipped: bool = False


def junit(suite: str, checks: Sequence[Check], path: Optional[Union[str, Path]] = None) -> str:
    """Returns the checks as JUnit XML, and writes it to `path`.

    >>> print(junit("breath", [Check("rate"), Check("volume", "0.1 is outside 0.3 to 0.7 l")]))
    <testsuites>
      <testsuite name="breath" tests="2" failures="1" skipped="0">
        <testcase classname="breath" name="rate" />
        <testcase classname="breath" name="volume">
          <failure message="0.1 is outside 0.3 to 0.7 l" />
        </testcase>
      </testsuite>
    </testsuites>
    """
    suite = _legal(suite)
    root = ElementTree.Element("testsuites")
    failed, skipped = sum(bool(each.failure) for each in checks), sum(each.skipped for each in checks)
    counts = {"tests": str(len(checks)), "failures": str(failed), "skipped": str(skipped)}
    group = ElementTree.SubElement(root, "testsuite", {"name": suite, **counts})
    for check in checks:
        case = ElementTree.SubElement(group, "testcase", classname=suite, name=_legal(check.name))
        if check.skipped:
            ElementTree.SubElement(case, "skipped")
        if check.failure:
            ElementTree.SubElement(case, "failure", message=_legal(check.failure))
    ElementTree.indent(root)
    text = ElementTree.tostring(root, encoding="unicode")
    if path is not None:
        Path(path).write_text(f'<?xml version="1.0" encoding="utf-8"?>\n{text}\n', encoding="utf-8")
    return text


def _legal(text: str) -> str:
    """The text without the characters that XML cannot hold."""
    return re.sub("[^\t\n\r\x20-\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]", "\ufffd", text)
