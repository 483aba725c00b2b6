"""Exports, studies, comparisons."""

import hashlib
import io
import tempfile
import tracemalloc
import zipfile
from pathlib import Path

import numpy as np

import phrenic
from phrenic import jobs
from phrenic.v1 import export_pb2
from support import REPOSITORY, SessionTest


def zip_of(*names: str) -> bytes:
    content = io.BytesIO()
    with zipfile.ZipFile(content, "w") as archive:
        for name in names:
            archive.writestr(name, "new")
    return content.getvalue()


def exported(path: Path, blocks: list[bytes]) -> tuple[dict, list[str]]:
    """Exports from a server whose file has these blocks; returns the summary and the calls."""
    digest, made = hashlib.sha256(), []
    for block in blocks:
        digest.update(block)
    done = export_pb2.Export(id="e", state="EXPORT_STATE_DONE", summary={"frames": 7, "sha256": digest.hexdigest()})
    formats = [{"name": "pvd", "ending": "zip"}, {"name": "msh", "ending": "msh"}]
    streams = {
        "WatchExport": [export_pb2.WatchExportResponse(job=job) for job in (export_pb2.Export(id="e"), done)],
        "DownloadExport": (export_pb2.DownloadExportResponse(chunk=block) for block in blocks),
    }
    answers = {
        "ListFormats": export_pb2.ListFormatsResponse(formats=formats),
        "CreateExport": export_pb2.CreateExportResponse(job={"id": "e"}),
        "ListExports": export_pb2.ListExportsResponse(),  # it has been deleted by somebody else
    }
    operation = jobs.export("s", path, {}, None)
    answer = None
    while True:
        try:
            call = operation.send(answer)
        except StopIteration as end:
            return end.value, made
        made.append(call.method.partition(".")[2])
        for message in streams.get(made[-1], ()):
            call.each(message)
        answer = answers.get(made[-1])


class JobsTest(SessionTest):
    def test_an_archive_with_a_file_that_is_none_of_the_motion_is_refused(self):
        hostile = ("analysis.py", "motion.py", "motion", "motion/../other", "../motion.pvd", "/motion.pvd", "motion/x.vtp",
                   "motion/motion_0/x.vtp", "motion/motion_0.vtp\n", "motion_2.pvd")  # fmt: skip
        for name in hostile:
            with self.subTest(name), tempfile.TemporaryDirectory() as folder:
                Path(folder, "analysis.py").write_text("mine")
                with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "none of this motion"):
                    exported(Path(folder, "motion.pvd"), [zip_of("motion/motion_000000.vtp", name)])
                self.assertEqual([each.name for each in Path(folder).iterdir()], ["analysis.py"])
                self.assertEqual(Path(folder, "analysis.py").read_text(), "mine")

    def test_an_export_is_known_from_its_last_message(self):
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "motion.pvd")
            summary, calls = exported(path, [zip_of("motion/motion_000000.vtp", "motion.pvd")])
            self.assertEqual((path.read_text(), summary["frames"]), ("new", 7))
            self.assertEqual(Path(folder, "motion", "motion_000000.vtp").read_text(), "new")
        self.assertEqual(calls, ["ListFormats", "CreateExport", "WatchExport", "DownloadExport", "DeleteExport"])

    def test_a_large_file_is_checked_by_blocks(self):
        tracemalloc.start()
        self.addCleanup(tracemalloc.stop)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "motion.msh")
            exported(path, [bytes(1 << 20)] * 32)
            self.assertEqual(path.stat().st_size, 32 << 20)
        self.assertLess(tracemalloc.get_traced_memory()[1], 8 << 20)

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
            self.assertTrue(list(Path(folder, "motion").glob("motion_*.vtp")))
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
        self.assertIn(">&lt;b&gt;</td>", phrenic.Table([{"a": "<b>"}])._repr_html_())
        with self.assertRaisesRegex(KeyError, "there is no column c"):
            table["c"]
