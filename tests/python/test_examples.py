"""The example scripts run as a user starts them."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np

from support import EXAMPLES


def run(name: str, *arguments: str, folder: str = ".") -> str:
    words = [sys.executable, str(EXAMPLES / name), *arguments]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=120)
    if done.returncode != 0:
        raise AssertionError(done.stderr)
    return done.stdout


class ExamplesTest(unittest.TestCase):
    def test_a_sensitivity_study(self):
        words = ["--scene", "pressure-lungs", "--vary", "breath_force", "--by", "0.5", "2", "--seconds", "0.5"]
        lines = run("sensitivity.py", *words).splitlines()
        self.assertEqual(lines[0].split()[0], "breath_force")
        self.assertEqual(len(lines), 3)
        self.assertNotEqual(lines[1].split()[1], lines[2].split()[1], "the parameter has no effect")

    def test_error_against_run_time(self):
        with tempfile.TemporaryDirectory() as folder:
            out = run("error_against_run_time.py", "cube-springs", "--seconds", "0.2", "--levels", "2", "--page",
                      "error.html", folder=folder)  # fmt: skip
            self.assertIn("error_rms_mm", out)
            self.assertTrue(Path(folder, "error.html").exists())

    def test_a_batch_has_the_bits_of_a_loop(self):
        lines = run("batch_speed.py", "--scene", "cube-springs", "--runs", "6", "--seconds", "0.2").splitlines()
        self.assertEqual([line.split()[0] for line in lines[1:]], ["loop", "batch,", "batch,"])

    def test_a_motion_as_an_array(self):
        with tempfile.TemporaryDirectory() as folder:
            run("motion.py", "--scene", "pressure-lungs", "--seconds", "0.5", "--fps", "10", folder=folder)
            motion = np.load(Path(folder, "motion.npz"))
            self.assertEqual(motion["positions"].shape[0], 5)
            self.assertEqual(motion["positions"].shape[2], 3)
            self.assertGreater(np.ptp(motion["values"]), 0)
