"""A wrong argument raises an error of phrenic that names the argument, for every type and every method."""

import math
import os
import tempfile
import unittest
from pathlib import Path
from unittest import mock

import numpy as np

import phrenic
from phrenic import arguments
from phrenic.errors import Closed, InvalidArgument
from support import SessionTest

HUGE, NAN = 2**40, math.nan


class ArgumentsTest(SessionTest):
    def refused(self, name, call):
        """The call is InvalidArgument, a ValueError, whose text begins with the argument's name."""
        with self.subTest(name=name), self.assertRaises(InvalidArgument) as caught:
            result = call()
            if hasattr(result, "__next__"):
                next(result)
        self.assertIsInstance(caught.exception, ValueError)
        self.assertIn(name, str(caught.exception).split(" ")[0])

    def test_methods_of_a_session_name_the_argument(self):
        s = self.session()
        for ticks in (1.5, "5", 2**63, True, None, -1):
            self.refused("ticks", lambda ticks=ticks: s.step(ticks))
            self.refused("ticks", lambda ticks=ticks: s.advance().send(ticks))
        for timeout in (0, -1, NAN, "1"):
            self.refused("timeout", lambda timeout=timeout: s.step(1, timeout=timeout))
        for read in ("bodies", 3, (3,), ("bodis",)):
            self.refused("read", lambda read=read: s.step(1, read))
        for seconds in (0, -1, NAN, math.inf, "1", None):
            self.refused("seconds", lambda seconds=seconds: s.play(seconds))
            self.refused("seconds", lambda seconds=seconds: s.play(seconds, ahead=1))
        self.refused("fps", lambda: s.play(1, 0))
        self.refused("ahead", lambda: s.play(1, ahead=0.5))
        for vertex in (HUGE, -1, 0.5, "0"):
            self.refused("vertex", lambda vertex=vertex: s.forces("cube", vertex=vertex))
            self.refused("vertex", lambda vertex=vertex: s.pull("cube", vertex, (0, 0, 1)))
        for force in ((1, 2), (1, 2, "3"), 4, (1, 2, NAN), None):
            self.refused("force", lambda force=force: s.pull("cube", 7, force))
        self.refused("integrator", lambda: s.set(integrator=HUGE))
        self.refused("integrator", lambda: s.set(integrator="rk5"))
        self.refused("breath_force", lambda: s.set(breath_force="2"))
        self.refused("at_tick", lambda: s.set(at_tick=1.5))
        self.refused("speed", lambda: s.run("fast"))
        self.refused("measures", lambda: s.samples("lung volume"))
        self.refused("measure", lambda: s.measure(3))
        self.refused("bodies", lambda: s.export("motion.msh", bodies="cube"))
        self.refused("path", lambda: s.export(3))
        self.refused("other", lambda: s.compare(3))
        self.refused("id", lambda: s.fork(id=7))
        self.assertEqual(s.step(np.int64(2)).tick, 2, "nothing of the above was taken")

    def test_makers_name_the_argument(self):
        self.refused("set", lambda: phrenic.Session("cube-springs", set=[1]))
        self.refused("preset", lambda: phrenic.Session("cube-springs", preset=3))
        self.refused("id", lambda: phrenic.Session("cube-springs", id=7))
        self.refused("resolution_mm", lambda: phrenic.Session("thorax", resolution_mm="8"))
        self.refused("scene", lambda: phrenic.Session(None))
        for make in (phrenic.Session, phrenic.aio.Session, phrenic.fit):
            self.refused("server", lambda make=make: make("thorax", server="host:1"))
        self.refused("server", lambda: phrenic.aio.Session("thorax", server=phrenic.default_server()))
        self.refused("server", lambda: phrenic.batch("thorax", [], seconds=1, server="host:1"))
        self.refused("address", lambda: phrenic.connect(50051))
        self.refused("retries", lambda: phrenic.connect(retries=1.5))
        self.refused("flags", lambda: phrenic.local(flags="--help"))
        self.refused("seconds", lambda: phrenic.batch("cube-springs", [{}], seconds=NAN))
        self.refused("runs[0]", lambda: phrenic.batch("cube-springs", ["a"], seconds=1))
        self.refused("parameters", lambda: phrenic.batch("cube-springs", 3, seconds=1))
        self.refused("runs[0]", lambda: phrenic.batch("cube-springs", [{}], seconds=1, start=3))

    def test_results_and_files_name_the_argument(self):
        frames, lungs = list(self.session().play(0.1, fps=20)), self.session("thorax", resolution_mm=12)
        for points in ([1], [(1, 2)], "abc"):
            self.refused("points", lambda points=points: lungs.tissue(points))
        self.refused("path", lambda: lungs.export("/no/folder/x.msh"))
        self.refused("tls", lambda: phrenic.connect("https://127.0.0.1:1", tls=3))
        self.refused("cases", lambda: phrenic.people.study(3))
        self.refused("errors", lambda: phrenic.fit(np.zeros((20, 6)), errors=3))
        self.refused("frames", lambda: phrenic.motion.Motion.of(3))
        self.refused("frames", lambda: phrenic.motion.Motion.of([3]))
        self.refused("finished", lambda: phrenic.batch("cube-springs", [{}], seconds=1, finished=3))
        self.refused("seed", lambda: phrenic.gym.VentilateCopd().reset(seed=-1))
        self.refused("path", lambda: phrenic.motion.to_netcdf(frames, "/no/folder/x.nc"))

    def test_a_frame_is_a_start(self):
        frame = self.session().step(5)
        (a,), (b,) = (list(phrenic.batch("cube-springs", [{}], seconds=0.1, **start))
                      for start in ({"starts": [frame]}, {"starts": [frame.state]}))  # fmt: skip
        self.assertEqual(a.state_hash, b.state_hash)

    def test_an_error_does_not_print_a_token(self):
        for name in ("PHRENIC_TOKEN", "PHRENIC_JOIN"):
            with mock.patch.dict(os.environ, {name: "secret\n"}), self.assertRaises(InvalidArgument) as caught:
                phrenic.connect("127.0.0.1:1")
            self.assertNotIn("secret", repr(caught.exception))
        for token in ("secret\n", "sec ret", "gehéim"):
            with self.assertRaisesRegex(InvalidArgument, "^token: .*strip") as caught:
                phrenic.connect("127.0.0.1:1", token=token)
            self.assertNotIn(token[:3], repr(caught.exception))
            self.assertIsNone(caught.exception.__cause__)

    def test_names_that_are_not_there_are_answered_with_the_nearest(self):
        with self.session() as a, self.session() as b:
            with self.assertRaisesRegex(KeyError, "did you mean hd95_max"):
                a.compare(b)["hd95_maxx"]
            with self.assertRaisesRegex(KeyError, "did you mean breath_force"):
                a.parameters["breath_forse"]
            with self.assertRaisesRegex(InvalidArgument, "read: .*did you mean bodies"):
                a.step(1, ("bodis",))

    def test_what_is_closed_says_so(self):
        s = phrenic.Session("cube-springs")
        steps = s.advance()
        s.close()
        for call in (s.step, s.advance, s.frame, lambda: s.measures, lambda: next(s.watch()), lambda: next(s.samples())):
            with self.assertRaisesRegex(Closed, f"session {s.id} is closed"):
                call()
        s.close()
        with self.assertRaisesRegex(Closed, "is closed"):
            steps.send()
        steps.close()
        server = phrenic.connect(phrenic.default_server().address)
        s = phrenic.Session("cube-springs", server=server)
        phrenic.default_server().attach(s.id)
        server.close()
        for call in (s.step, server.sessions, lambda: phrenic.Session("cube-springs", server=server)):
            with self.assertRaisesRegex(Closed, "phrenic.connect"):
                call()
        s.close()

    def test_numbers_of_numpy_are_numbers(self):
        self.assertEqual(arguments.whole("n", np.uint8(3)), 3)
        self.assertEqual(arguments.vector("v", np.arange(3.0)), (0, 1, 2))
        self.assertEqual(arguments.finite("x", np.float32(0.5)), 0.5)


class ClosedAioTest(unittest.IsolatedAsyncioTestCase):
    async def test_what_is_closed_says_so(self):
        async with phrenic.aio.Session("cube-springs") as s:
            await s.step()
        with self.assertRaisesRegex(Closed, f"session {s.id} is closed"):
            await s.step()
        async with phrenic.aio.connect(phrenic.default_server().address) as server:
            pass
        with self.assertRaisesRegex(Closed, "connection"):
            await server.sessions()


class NetcdfTest(SessionTest):
    def test_text_is_utf_8_and_a_file_is_whole_or_not_there(self):
        try:
            from scipy.io import netcdf_file
        except ImportError:
            self.skipTest("there is no scipy: apt install python3-scipy")
        frames = list(self.session().play(0.1, fps=20))
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "m.nc")
            for bad in ({"note": object()}, {"é": "1"}, {"note": {}}):
                with self.assertRaisesRegex(InvalidArgument, "attributes"):
                    phrenic.motion.to_netcdf(frames, path, **bad)
                self.assertEqual(os.listdir(folder), [])
            phrenic.motion.to_netcdf(frames, path, note="é", count=3, list=[0.5, 1])
            with netcdf_file(str(path), mmap=False) as file:
                self.assertEqual(file.note.decode(), "é")
                self.assertEqual((int(file.count), file.list.tolist()), (3, [0.5, 1]))


if __name__ == "__main__":
    unittest.main()
