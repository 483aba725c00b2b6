"""The example workflow runs in Debian's Snakemake."""

import csv
import importlib.util
import os
import shutil
import subprocess
import tempfile
import unittest
from pathlib import Path

from support import REPOSITORY, program

SNAKEFILE = REPOSITORY / "client" / "examples" / "snakemake" / "Snakefile"


class SnakemakeTest(unittest.TestCase):
    def setUp(self):
        if not shutil.which("snakemake"):
            self.skipTest("there is no snakemake: apt install snakemake (669 MB with what it needs, so deploy/test does not)")
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def snakemake(self, *words, **config):
        config = {"phrenic": program("phrenic"), "seconds": 0.5, **config}
        pairs = [f"{name}={value}" for name, value in config.items()]
        words = ["snakemake", "--snakefile", SNAKEFILE, "--directory", self.folder, "--cores", "2", *words]
        environment = {**os.environ, "XDG_CACHE_HOME": str(self.folder / "cache"), "HOME": str(self.folder)}
        return subprocess.run(
            [*words, "--config", *pairs], capture_output=True, text=True, timeout=120, env=environment
        )

    def test_a_campaign_gives_a_table_and_is_not_repeated(self):
        done = self.snakemake("runs.csv", scenes="pressure-lungs,muscle", values="0.5,2")
        self.assertEqual(done.returncode, 0, done.stderr)
        with open(self.folder / "runs.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual({(row["scene"], row["breath_force"]) for row in rows},
                         {(scene, force) for scene in ("pressure-lungs", "muscle") for force in ("0.5", "2")})  # fmt: skip
        self.assertEqual(len({row["state_hash"] for row in rows}), 4)
        volumes = [float(row["maximum"]) for row in rows if row["measure"] == "lung volume"]
        self.assertEqual(len(volumes), len(set(volumes)), "the parameter has no effect")
        before = (self.folder / "runs.csv").stat().st_mtime_ns
        again = self.snakemake("runs.csv", scenes="pressure-lungs,muscle", values="0.5,2")
        self.assertEqual(again.returncode, 0, again.stderr)
        self.assertEqual((self.folder / "runs.csv").stat().st_mtime_ns, before)

    def test_it_draws_a_picture(self):
        if importlib.util.find_spec("matplotlib") is None:
            self.skipTest("there is no matplotlib: apt install python3-matplotlib")
        done = self.snakemake(values="1,2")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertGreater((self.folder / "runs.png").stat().st_size, 1000)

    def test_a_run_that_fails_leaves_no_file(self):
        done = self.snakemake("runs.csv", values="1,nonsense")
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("breath_force", done.stderr)
        self.assertFalse((self.folder / "runs/pressure-lungs/nonsense.json").exists())
        self.assertFalse((self.folder / "runs.csv").exists())
