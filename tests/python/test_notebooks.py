"""Notebooks: the viewer and plots in them, and the examples, which run as they are by the command of the README."""

import importlib.util
import json
import os
import resource
import subprocess
import sys
import tempfile
import time
import unittest
import urllib.request
from html import unescape
from pathlib import Path
from unittest import mock

import numpy as np

import phrenic
from phrenic import notebook
from phrenic.local import binary
from support import EXAMPLES, REPOSITORY, SessionTest

NOTEBOOKS = sorted((EXAMPLES / "notebooks").glob("*.ipynb"))
ALONE = ["--HTMLExporter.mathjax_url=", "--HTMLExporter.require_js_url="]
"""The page needs no other file."""
ORIGIN = "http://localhost:8888"


def needs(*modules: str):
    missing = [name for name in modules if importlib.util.find_spec(name) is None]
    debian = " ".join(f"python3-{name}" for name in missing)
    return unittest.skipIf(missing, f"there is no {' and no '.join(missing)}: apt install {debian}")


class ViewTest(SessionTest):
    def setUp(self):
        if not phrenic.default_server().about.viewer_is_built:
            self.skipTest("the viewer is not built: deploy/run --build-only")

    def test_a_server_that_forbids_frames_gives_a_link_and_the_reason(self):
        session = self.session()
        shown = notebook.view(session)
        self.assertIn(f"?session={session.id}", repr(shown))
        html = shown._repr_html_()
        self.assertNotIn("<iframe", html)
        self.assertIn("--allow-origin", html)
        self.assertIn(f'href="{shown.address}"', html)
        with urllib.request.urlopen(shown.address) as answer:
            self.assertEqual(answer.status, 200)

    def test_a_server_that_allows_the_page_is_framed(self):
        with phrenic.local(flags=["--allow-origin", ORIGIN]) as server:
            session = self.session(server=server)
            html = notebook.view(session, height=321)._repr_html_()
            self.assertIn(f'<iframe src="http://127.0.0.1:{server.about.web_port}/?session={session.id}"', html)
            self.assertIn('height="321"', html)
            with urllib.request.urlopen(str(notebook.view(session))) as answer:
                self.assertIn(f"frame-ancestors {ORIGIN}", answer.headers["Content-Security-Policy"])
            session.close()

    def test_a_kernels_own_server_allows_the_page_of_its_jupyter(self):
        with tempfile.TemporaryDirectory() as folder:
            Path(folder, "jpserver-1.json").write_text(json.dumps({"url": f"{ORIGIN}/"}))
            paths = mock.Mock(jupyter_runtime_dir=lambda: folder)
            jupyter = {"jupyter_core": mock.Mock(paths=paths), "jupyter_core.paths": paths}
            with mock.patch.dict(os.environ, {"JPY_PARENT_PID": "1"}), mock.patch.dict(sys.modules, jupyter):
                with phrenic.local() as server:
                    session = self.session(server=server)
                    self.assertIn("<iframe", notebook.view(session)._repr_html_())
                    session.close()

    def test_a_player_needs_no_server(self):
        session = self.session(set={"breath_length": 0.5})
        player = notebook.player(session, seconds=0.2, height=321)
        session.close()
        html = player._repr_html_()
        self.assertRegex(html, r'^<iframe srcdoc="[^"]*" sandbox="allow-scripts" [^>]* height="321" [^>]*></iframe>$')
        page = unescape(html.split('"', 2)[1])
        self.assertEqual(page, player.page)
        self.assertIn("default-src 'none'", page)
        self.assertNotRegex(page, r'<(script|link|img)[^>]* (src|href)="(https?|file|/)')
        self.assertEqual(session.tick, 0)
        with tempfile.TemporaryDirectory() as folder:
            player.save(Path(folder, "breath.html"))
            self.assertEqual(Path(folder, "breath.html").read_text(), page)

    def test_an_address_is_shown_and_its_text_stays_text(self):
        html = notebook.view('http://127.0.0.1:1/?session="><script>')._repr_html_()
        self.assertIn("<iframe", html)
        self.assertNotIn("<script>", html)
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "http://"):
            notebook.view("javascript:alert(1)")

    def test_a_session_without_a_server_is_shown_as_text(self):
        session = phrenic.Session("cube-springs")
        self.assertIn("Open in a tab", notebook.shown(session))
        with mock.patch.object(phrenic.Server, "viewer", side_effect=phrenic.errors.Unavailable("gone")):
            self.assertIsNone(notebook.shown(session))
        session.close()

    def test_a_join_link_admits_who_has_the_notebook(self):
        with tempfile.TemporaryDirectory() as folder:
            tokens = ["--tokens", str(Path(folder, "tokens"))]
            words = [binary(), *tokens, "token", "add", "--name", "anna", "--role", "owner"]
            token = subprocess.run(words, capture_output=True, text=True, check=True).stdout.strip()
            with phrenic.local(flags=tokens) as local, phrenic.connect(local.address, token=token) as server:
                session = self.session(server=server)
                self.assertNotIn("#join=", repr(notebook.view(session)))
                address, _, secret = repr(notebook.view(session, role="viewer", hours=1)).partition("#join=")
                self.assertIn(f"?session={session.id}", address)
                with mock.patch.dict(os.environ, {"PHRENIC_JOIN": secret}):
                    with phrenic.connect(local.address) as joined:
                        self.assertEqual(joined.attach(session.id).scene, "cube-springs")
                session.close()
        with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "the server has no accounts"):
            notebook.view(self.session(), role="viewer")

    def test_a_role_is_one_that_there_is(self):
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "did you mean viewer"):
            notebook.view(self.session(), role="viewr")


class PlotTest(SessionTest):
    def test_without_matplotlib_the_remedy_is_said(self):
        with mock.patch.dict(sys.modules, {"matplotlib": None}):
            with self.assertRaisesRegex(ModuleNotFoundError, "plot needs matplotlib: apt install python3-matplotlib"):
                notebook.plot([])

    @needs("matplotlib")
    def test_frames_and_runs_are_curves(self):
        session = self.session("pressure-lungs")
        frames = list(session.play(0.5, fps=10, read=()))
        figure = notebook.plot(frames, "lung volume").figure
        (line,) = figure.axes[0].lines
        np.testing.assert_array_equal(line.get_ydata(), [frame.measures["lung volume"] for frame in frames])
        self.assertEqual(figure.axes[0].get_ylabel(), "lung volume [m^3]")
        self.assertEqual(len(notebook.plot(frames).figure.axes), len(frames[0].measures))
        runs = list(phrenic.batch("pressure-lungs", [{"breath_force": f} for f in (1, 2)], seconds=0.5))
        lines = notebook.plot(runs, "flow").figure.axes[0].lines
        self.assertEqual({line.get_label() for line in lines}, {"breath_force 1", "breath_force 2"})
        self.assertEqual(len(notebook.plot({"a": frames, "b": runs[0]}, "flow").figure.axes[0].lines), 2)
        self.assertTrue(notebook.plot(frames, "flow")._repr_png_().startswith(b"\x89PNG"))
        with self.assertRaisesRegex(phrenic.errors.NotFound, "did you mean lung volume"):
            notebook.plot(frames, "lung volumes")
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "nothing to plot"):
            notebook.plot([])


class ExamplesTest(unittest.TestCase):
    def test_they_are_kept_without_results(self):
        self.assertEqual(len(NOTEBOOKS), 3)
        for path in NOTEBOOKS:
            for cell in json.loads(path.read_text())["cells"]:
                self.assertEqual((cell.get("outputs", []), cell.get("execution_count")), ([], None), path.name)

    def page(self, path: Path, folder: str) -> str:
        words = [sys.executable, "-m", "nbconvert", "--to", "html", "--execute", "--output-dir", folder, *ALONE, str(path)]
        environment = {**os.environ, "IPYTHONDIR": folder, "JUPYTER_RUNTIME_DIR": folder, "MPLCONFIGDIR": folder}
        before, began = resource.getrusage(resource.RUSAGE_CHILDREN), time.monotonic()
        done = subprocess.run(words, capture_output=True, text=True, timeout=200, env=environment, cwd=REPOSITORY)
        self.assertEqual(done.returncode, 0, done.stderr[-3000:])
        used = resource.getrusage(resource.RUSAGE_CHILDREN)  # other programs do not lengthen it
        seconds = used.ru_utime + used.ru_stime - before.ru_utime - before.ru_stime
        self.assertGreater(seconds, 1)
        self.assertLess(seconds, 60)
        self.assertLess(time.monotonic() - began, 120, "it waits, though it uses little of the processor")
        return Path(folder, path.stem + ".html").read_text()

    @needs("nbconvert", "ipykernel", "matplotlib")
    def test_they_run_and_stand_as_pages(self):
        expected = {
            "sensitivity": ["tidal volume [l]", "muscle_strength", "data:image/png;base64,"],
            "error_against_run_time": ["For an error of", "time_step_s", "data:image/png;base64,"],
            "fit_to_landmarks": ["piston-right", "on the half that was not fitted", "data:image/png;base64,",
                                 '<iframe srcdoc="&lt;!doctype html&gt;'],
        }
        with tempfile.TemporaryDirectory() as folder:
            for path in NOTEBOOKS:
                if "notebook.player" in path.read_text() and not phrenic.default_server().about.viewer_is_built:
                    continue
                with self.subTest(path.name):
                    page = self.page(path, folder)
                    for part in expected[path.stem]:
                        self.assertIn(part, page)
                    self.assertNotIn("Traceback", page)
                    self.assertNotRegex(page, r'<(script|link|img)[^>]* (src|href)="(https?|file):', "it needs no other file")
