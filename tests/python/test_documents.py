"""The examples in docstrings and in README.md do what they say."""

import doctest
import importlib
import pkgutil
from pathlib import Path

import phrenic

README = Path(__file__).resolve().parents[2] / "client" / "python" / "README.md"
FLAGS = doctest.NORMALIZE_WHITESPACE | doctest.ELLIPSIS


def load_tests(loader, tests, pattern):
    for module in pkgutil.iter_modules(phrenic.__path__):
        if module.name != "v1":
            tests.addTests(doctest.DocTestSuite(importlib.import_module(f"phrenic.{module.name}"), optionflags=FLAGS))
    tests.addTests(doctest.DocTestSuite(phrenic, optionflags=FLAGS))
    tests.addTests(doctest.DocFileSuite(str(README), module_relative=False, optionflags=FLAGS))
    return tests
