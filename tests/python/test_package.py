"""What pip installs."""

import re
import unittest
import warnings

import phrenic
from support import REPOSITORY

PYPROJECT = REPOSITORY / "client" / "python" / "pyproject.toml"


class PackageTest(unittest.TestCase):
    def test_the_version_is_written_once(self):
        text = PYPROJECT.read_text()
        self.assertNotIn(phrenic.__version__, re.findall(r'^version = "(.*)"$', text, re.MULTILINE))
        self.assertIn("phrenic.__version__", text)

    def test_setuptools_finds_the_version(self):
        try:
            from setuptools.config.pyprojecttoml import read_configuration
        except ImportError:
            self.skipTest("there is no setuptools")
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # older versions call this table beta
            project = read_configuration(PYPROJECT)["project"]
        self.assertEqual((project["dynamic"], project["version"]), (["version"], phrenic.__version__))
