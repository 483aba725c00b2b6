"""Compressed frames have the bits that the server's and the viewer's decoders give, and keep their bound."""

import json
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
import zipfile
from pathlib import Path
from unittest import mock

import numpy as np

import phrenic
from phrenic import codec
from phrenic.v1 import frames_pb2
from support import REPOSITORY, SessionTest

GOLDEN = json.loads((REPOSITORY / "tests" / "golden" / "codecs.json").read_text())


def rows(numbers) -> np.ndarray:
    return np.array(numbers, "<f4").reshape(-1, 3)


def body(rest, triangles=(), index=0, first=0, edges=()) -> frames_pb2.GetGeometryResponse:
    return frames_pb2.GetGeometryResponse(
        body_index=index, first_vertex=first, placement=frames_pb2.PLACEMENT_STREAMED,
        rest_positions=np.array(rest, "<f4").tobytes(), triangles=np.array(triangles, "<u4").tobytes(),
        edges=np.array(edges, "<u4").tobytes(),
    )  # fmt: skip


def golden_decoder() -> codec.Decoder:
    return codec.Decoder([body(GOLDEN["rest"], GOLDEN["triangles"])])


class GoldenTest(unittest.TestCase):
    def test_each_codec_gives_the_positions_in_the_file(self):
        decoder = golden_decoder()
        for shape in GOLDEN["shapes"]:
            moved = decoder.decode(frames_pb2.CODEC_PREDICTED, bytes.fromhex(shape["bytes"])) - decoder.rest
            np.testing.assert_array_equal(moved, rows(shape["displacements"]))
        decoder.set_basis([bytes.fromhex(shape["bytes"]) for shape in GOLDEN["shapes"]])
        seen = set()
        for each in GOLDEN["encodings"]:
            number = frames_pb2.Codec.Value(each["codec"])
            seen.add(number)
            np.testing.assert_array_equal(decoder.decode(number, bytes.fromhex(each["bytes"])), rows(each["positions"]))
        self.assertEqual(seen, set(frames_pb2.Codec.values()) - {frames_pb2.CODEC_UNSPECIFIED})

    def test_other_bytes_are_refused(self):
        decoder = golden_decoder()
        for each in GOLDEN["encodings"]:
            number, data = frames_pb2.Codec.Value(each["codec"]), bytes.fromhex(each["bytes"])
            for bad in (b"", data[:-1], data[: len(data) // 2]):
                with self.subTest(each["codec"]), self.assertRaises(phrenic.errors.InvalidArgument):
                    decoder.decode(number, bad)
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "codec: this version does not know it"):
            decoder.decode(77, b"")
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "edge"):
            codec.Decoder([body([0, 0, 0, 1, 0, 0], edges=[0, 2])])

    def test_a_session_without_streamed_bodies_has_no_vertices(self):
        self.assertEqual(codec.Decoder([]).decode(frames_pb2.CODEC_RAW, b"").shape, (0, 3))


class WatchTest(SessionTest):
    def watched(self, session, **options) -> phrenic.Frame:
        frames = session.watch(**options)
        frame = next(frames)
        frames.close()
        return frame

    def test_compressed_frames_keep_their_bound(self):
        for scene in ("cube-springs", "mixed-methods", "thorax-thesis"):
            session = self.session(scene, **({"resolution_mm": 12} if scene == "thorax-thesis" else {}))
            exact = session.step(40)
            for bound in (0.02, 1):
                frame = self.watched(session, max_error_mm=bound)
                self.assertEqual(frame.tick, exact.tick)
                self.assertEqual(dict(frame.measures), dict(exact.measures))
                off = max(np.abs(frame[name].positions - exact[name].positions).max() for name in exact.bodies)
                self.assertLessEqual(1000 * off, bound + 1e-4)
                self.assertFalse(frame[exact.bodies[0]].positions.flags.writeable)
            self.assertGreater(off, 0, "nothing was compressed")
            self.assertTrue((self.watched(session)[exact.bodies[0]].positions == exact[exact.bodies[0]].positions).all())

    def test_without_the_decoder_the_remedy_is_said_and_exact_frames_come(self):
        session = self.session()
        codec.library.cache_clear()
        self.addCleanup(codec.library.cache_clear)
        with mock.patch.object(codec, "LIBRARY", Path("/none.so")):
            with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "python3-phrenic.*without max_error_mm"):
                next(session.watch(max_error_mm=0.1))
            self.assertEqual(self.watched(session).tick, 0)

    def test_decoders_of_several_threads_do_not_disturb_each_other(self):
        data = next(each for each in GOLDEN["encodings"] if each["codec"] == "CODEC_PREDICTED")
        wrong = []

        def work():
            decoder = golden_decoder()
            for _ in range(200):
                found = decoder.decode(frames_pb2.CODEC_PREDICTED, bytes.fromhex(data["bytes"]))
                if not (found == rows(data["positions"])).all():
                    wrong.append(found)

        threads = [threading.Thread(target=work) for _ in range(4)]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        self.assertEqual(wrong, [])


class AioWatchTest(unittest.IsolatedAsyncioTestCase):
    async def test_the_async_twin_decodes_too(self):
        async with phrenic.aio.Session("cube-springs") as session:
            exact = await session.step(30)
            async for frame in session.watch(max_error_mm=0.1):
                break
            off = np.abs(frame["cube"].positions - exact["cube"].positions).max()
            self.assertLessEqual(1000 * off, 0.1)


class WheelTest(unittest.TestCase):
    @unittest.skipUnless(shutil.which("readelf"), "there is no readelf: apt install binutils")
    def test_the_decoder_needs_only_what_every_linux_has(self):
        done = subprocess.run(["readelf", "--dynamic", codec.LIBRARY], capture_output=True, text=True, check=True)
        needed = set(re.findall(r"\(NEEDED\).*\[(.+)\]", done.stdout))
        self.assertTrue(needed)
        base = {"libc.so.6", "libm.so.6", "libstdc++.so.6", "libgcc_s.so.1"}
        self.assertLessEqual({name for name in needed if not name.startswith("ld-linux")}, base)

    def test_the_wheel_has_the_decoder_and_the_tag_of_its_platform(self):
        package = Path(phrenic.__file__).parents[2]
        if not (package / "pyproject.toml").exists():
            self.skipTest("this package is installed: it is no source tree")
        try:
            import setuptools  # noqa: F401
            import wheel  # noqa: F401
        except ImportError:
            self.skipTest("there is no wheel: apt install python3-setuptools python3-wheel")
        with tempfile.TemporaryDirectory() as folder:
            code = f"import setuptools.build_meta as b; print(b.build_wheel({folder!r}))"
            copy = Path(folder, "package")
            subprocess.run(["cp", "-r", str(package), str(copy)], check=True)
            done = subprocess.run([sys.executable, "-c", code], cwd=copy, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr[-2000:])
            (made,) = Path(folder).glob("*.whl")
            self.assertRegex(made.name, r"^phrenic-[0-9.]+-py3-none-linux_\w+\.whl$")
            with zipfile.ZipFile(made) as archive:
                names = archive.namelist()
        for name in ("phrenic/native/libphrenic_decoder.so", "phrenic/v1/fit_pb2.py", "phrenic/py.typed"):
            self.assertIn(name, names)
