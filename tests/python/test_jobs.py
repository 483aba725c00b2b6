"""Exports, studies, comparisons."""

import tempfile
from pathlib import Path

import numpy as np

import phrenic
from support import REPOSITORY, SessionTest


class JobsTest(SessionTest):
    def test_an_export_is_a_file_of_the_named_format(self):
        session = self.session()
        seen = []
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "cube.msh")
            summary = session.export(path, seconds=0.2, fps=10, progress=lambda done, what: seen.append(done))
            self.assertEqual(path.stat().st_size, summary["bytes"])
            self.assertEqual(summary["frames"], 3)
            session.export(Path(folder, "motion.pvd"), seconds=0.1)
            self.assertTrue(Path(folder, "motion.pvd").exists())
            self.assertFalse(list(Path(folder).glob("*.part")))
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "no format 'mesh': did you mean msh"):
                session.export(Path(folder, "cube.mesh"))
        self.assertEqual(session.tick, 0)
        self.assertEqual(seen[-1], 1)

    def test_a_study_of_error_is_a_table(self):
        study = self.session().study.error(seconds=0.2, levels=2, integrators=["velocity_verlet", "bdf2"])
        self.assertEqual({row["integrator"] for row in study.rows}, {"velocity_verlet", "bdf2"})
        self.assertTrue((study.rows["error_rms_mm"][study.rows["verdict"] == "ok"] > 0).all())
        if (REPOSITORY / "web" / "dist" / "report.html").exists():
            self.assertIn("<html", study.page)
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "did you mean levels"):
            self.session().study.error(level=2)

    def test_bodies_of_two_sessions_are_compared(self):
        session = self.session()
        with session.fork() as other:
            self.assertLess(session.compare(other)["hd_max"], 1e-9)
            other.step(200, read=())
            moved = np.linalg.norm(
                other.frame()["cube"].positions.astype(float) - session.frame()["cube"].positions, axis=1
            ).max()
            distance = session.compare(other)["hd_max"]
            self.assertGreater(distance, 1)
            self.assertLessEqual(distance, 1000 * moved + 1e-6)
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder, "cube.msh")
                session.export(path)
                self.assertLess(session.compare(path)["hd_max"], 1e-3)

    def test_a_table_has_columns(self):
        table = phrenic.Table([{"a": 1.0, "b": "x"}, {"a": None, "b": "y"}])
        np.testing.assert_array_equal(table["a"], [1, np.nan])
        self.assertEqual(table.where(b="y")[0]["a"], None)
        self.assertIn("<td>&lt;b&gt;</td>", phrenic.Table([{"a": "<b>"}])._repr_html_())
        with self.assertRaisesRegex(KeyError, "there is no column c"):
            table["c"]
