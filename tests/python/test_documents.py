"""The examples in docstrings and in README.md do what they say."""

import doctest
import importlib
import pkgutil
import contextlib
import io
import re
import unittest
from pathlib import Path

import phrenic

ROOT = Path(__file__).resolve().parents[2]
README = ROOT / "client" / "python" / "README.md"
FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


class FirstPageTest(unittest.TestCase):
    def test_the_lines_of_the_first_page_run(self):
        (block,) = re.findall(r"^```python\n(.*?)^```", (ROOT / "README.md").read_text(), re.MULTILINE | re.DOTALL)
        self.assertLessEqual(len(block.splitlines()), 8)
        said = io.StringIO()
        with contextlib.redirect_stdout(said):
            exec(block.replace("seconds=4", "seconds=0.05"), {})
        frames, (hash, *runs) = said.getvalue().splitlines()[:3], said.getvalue().splitlines()[3:]
        self.assertTrue(all(re.match(r"0\.0\d+ [0-9.e-]+ \(\d+, 3\)$", line) for line in frames), frames)
        self.assertRegex(hash, "^[0-9a-f]{16}$")
        self.assertEqual(len(runs), 3)


def load_tests(loader, tests, pattern):
    for module in pkgutil.iter_modules(phrenic.__path__):
        if module.name != "v1":
            tests.addTests(doctest.DocTestSuite(importlib.import_module(f"phrenic.{module.name}"), optionflags=FLAGS))
    tests.addTests(doctest.DocTestSuite(phrenic, optionflags=FLAGS))
    tests.addTests(doctest.DocFileSuite(str(README), module_relative=False, optionflags=FLAGS))
    return tests
