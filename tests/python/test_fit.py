"""A fit on the server has the numbers of `phrenic fit`, refuses by line or field, and ends when its caller does."""

import json
import subprocess
import tempfile
import threading
import time
import unittest
from functools import lru_cache
from pathlib import Path

import numpy as np
from google.protobuf import text_format

import phrenic
from phrenic.fits import COLUMNS
from phrenic.v1 import scene_pb2
from support import SessionTest, program


@lru_cache
def pairs() -> np.ndarray:
    """Landmarks of a shipped person's breath, in mm."""
    random = np.random.default_rng(3)
    with phrenic.Session("person-1") as s:
        exhale = s.frame()
        inhale = s.step(s.ticks_until(s.parameters["breath_length"] / 2))
    rows = []
    for lung in exhale.bodies:
        chosen = random.choice(len(exhale[lung].positions), 130, replace=False)
        rows.append(1000.0 * np.hstack([exhale[lung].positions[chosen], inhale[lung].positions[chosen]]))
    return np.vstack(rows) + np.hstack([np.zeros((260, 3)), random.normal(0, 0.5, (260, 3))])


@lru_cache
def fitted() -> phrenic.Fit:
    return phrenic.fit(pairs(), modes=12, split=5)


def write(folder: str, name: str, rows: np.ndarray) -> Path:
    path = Path(folder, name)
    path.write_text("\n".join([COLUMNS, *(",".join(map(repr, row)) for row in rows.tolist())]))
    return path


class StudyTest(SessionTest):
    def test_many_people_are_judged_as_one_by_one(self):
        said = []
        cases = {"anna": pairs(), "ben": pairs()[::-1].copy()}
        study = phrenic.people.study(cases, modes=12, split=5, progress=lambda done, text: said.append((done, text)))
        self.assertEqual(list(study.people["name"]), ["anna", "ben"])
        self.assertAlmostEqual(study.people[0]["held_out_mm"], fitted().held_out_mm, places=9)
        self.assertAlmostEqual(study.held_out_mm, float(np.mean(study.people["held_out_mm"])), places=9)
        self.assertGreater(study.from_one_number_mm, 0)
        self.assertTrue(any(text.startswith("ben, ") for _, text in said))
        self.assertEqual(sorted(done for done, _ in said), [done for done, _ in said])
        self.assertEqual(len(study.together.mean), 12)

    def test_what_cannot_be_studied_is_refused(self):
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "cases"):
            phrenic.people.study({})
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, r"cases\[0\].name"):
            phrenic.people.study({"\n": pairs()})
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "modes"):
            phrenic.people.study({"anna": pairs()}, modes=9)

    def test_it_ends_when_its_caller_does(self):
        def leave(done: float, text: str) -> None:
            raise KeyboardInterrupt

        began = time.monotonic()
        with self.assertRaises(KeyboardInterrupt):
            phrenic.people.study({str(i): pairs() for i in range(40)}, progress=leave)
        self.assertLess(time.monotonic() - began, 20)


class FitTest(SessionTest):
    def test_it_has_the_numbers_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            path = write(folder, "pairs.csv", pairs())
            words = "fit thorax --landmarks pairs.csv --modes 12 --split 5 --out anna.textproto -o json".split()
            done = subprocess.run([program("phrenic"), *words], cwd=folder, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            expected = json.loads(done.stdout)
            scene = text_format.Parse(Path(folder, "anna.textproto").read_text(), scene_pb2.Scene())
            found = phrenic.fit(path, modes=12, split=5, scene_name="anna")
        self.assertEqual(found.scene, scene)
        message = found.message
        self.assertEqual(round(message.held_out.mean_mm, 6), expected["held_out_mean_mm"])
        self.assertEqual(round(message.held_out.p95_mm, 6), expected["held_out_p95_mm"])
        self.assertEqual(round(message.fitting.mean_mm, 6), expected["fitting_mean_mm"])
        self.assertEqual(round(message.descent_mm, 6), expected["descent_mm"])
        self.assertEqual(len(found.parameters), 12)
        for name, other in (("value_mm", "value"), ("standard_error_mm", "standard_error"), ("determined", "determined"),
                            ("spread_between_people_mm", "spread_between_people"), ("name", "name")):  # fmt: skip
            column = [row[name] for row in found.parameters]
            rounded = [round(value, 6) if isinstance(value, float) else value for value in column]
            self.assertEqual(rounded, [row[other] for row in expected["parameters"]])
        np.testing.assert_allclose(found.correlation, expected["correlation"], atol=5.1e-5)
        for table, rows in ((found.baselines, expected["baselines"]), (found.regions, expected["regions"])):
            self.assertEqual([round(row["mean_mm"], 6) for row in table], [row["mean_mm"] for row in rows])
        self.assertEqual([row["scale_x"] for row in found.lungs],
                         [lung["scale"][0] for lung in expected["registration"]["lungs"]])  # fmt: skip
        again = phrenic.fit(pairs(), modes=12, split=5)
        self.assertEqual(again.message.parameters, found.message.parameters)

    def test_the_landmarks_come_back_and_the_error_is_theirs(self):
        found = fitted()
        np.testing.assert_allclose(1000 * found.exhale, pairs()[:, :3], atol=1e-9)
        left = np.linalg.norm(found.motion - found.predicted, axis=1)[found.held_out]
        self.assertAlmostEqual(1000 * left.mean(), found.held_out_mm, 9)
        self.assertEqual(len(found.held_out), 130)
        self.assertLess(found.held_out_mm, 2)

    def test_a_session_fits_as_its_scene_does(self):
        session = self.session("thorax", resolution_mm=20)
        expected = phrenic.fit(pairs(), "thorax", resolution_mm=20).message
        self.assertEqual(session.fit(pairs()).message, expected)
        self.assertEqual(session.tick, 0)

    def test_its_scene_breathes_and_it_is_json(self):
        found = fitted()
        frame = self.session(found.scene).step(50)
        self.assertGreater(np.abs(frame["lung-right"].positions - self.session(found.scene).frame()["lung-right"].positions).max(), 1e-3)  # fmt: skip
        with tempfile.TemporaryDirectory() as folder:
            found.to_scene(Path(folder, "anna.textproto"))
            self.assertEqual(self.session(Path(folder, "anna.textproto")).step(50).state_hash, frame.state_hash)
            self.assertEqual(json.loads(found.to_json())["held_out"]["mean_mm"], found.held_out_mm)
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "NAME.textproto"):
                found.to_scene(Path(folder, "anna.txt"))

    def test_other_kinds_have_the_numbers_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            write(folder, "pairs.csv", pairs())
            times = np.arange(600) / 25
            volumes = 0.4 * (1 - np.cos(2 * np.pi * times / 4)) / 2
            rows = "".join(f"{t},{v}\n" for t, v in zip(times, volumes))
            Path(folder, "spiro.csv").write_text("time_s,volume_l\n" + rows)
            metres = "".join(f"{t},{v / 1000}\n" for t, v in zip(times, volumes))
            Path(folder, "mmode.csv").write_text("time_s,displacement_mm\n" + metres)
            words = "fit thorax --exhale pairs.csv --volume spiro.csv --error volume=0.02 --out person.textproto -o json"
            done = subprocess.run([program("phrenic"), *words.split()], cwd=folder, capture_output=True, text=True)
            self.assertEqual(done.returncode, 0, done.stderr)
            expected = json.loads(done.stdout)
            found = phrenic.fit(exhale=Path(folder, "pairs.csv"), volume=Path(folder, "spiro.csv"),
                                errors={"volume": 0.02})  # fmt: skip
            with phrenic.Session("thorax") as session:
                again = session.fit(exhale=Path(folder, "pairs.csv"), volume=Path(folder, "spiro.csv"),
                                    errors={"volume": 0.02})  # fmt: skip
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "mmode.csv: the breaths are .* mm deep"):
                phrenic.fit(m_mode=str(Path(folder, "mmode.csv")) + "@left")
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "errors: 'colour' is no kind"):
                phrenic.fit(volume=Path(folder, "spiro.csv"), errors={"colour": 1})
        for name, key in (("numbers", "fitted"), ("derived", "derived")):
            for mine, theirs in zip(getattr(found, name), expected[key]):
                self.assertEqual(mine["name"], theirs["name"])
                self.assertAlmostEqual(mine["value"], theirs["value"], places=5)
                self.assertAlmostEqual(mine["standard_error"], theirs["standard_error"], places=5)
        self.assertEqual([row["kind"] for row in found.kinds], ["volume", "breath lengths"])
        self.assertEqual(list(again.numbers["value"]), list(found.numbers["value"]))
        self.assertAlmostEqual(found.scene.parameters.breath_length, 4, places=1)

    def test_neither_landmarks_nor_other_data_is_refused(self):
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "landmarks: is required, or measured"):
            phrenic.fit()

    def test_what_is_wrong_is_named_by_file_and_line_or_field(self):
        invalid, unfit = phrenic.errors.InvalidArgument, phrenic.errors.FailedPrecondition
        with tempfile.TemporaryDirectory() as folder:
            path = write(folder, "pairs.csv", pairs())
            lines = path.read_text().split("\n")
            lines[2] = lines[2].replace(",", ",x", 1)
            path.write_text("\n".join(lines))
            with self.assertRaisesRegex(invalid, r'^pairs.csv:3: "x.*" in column 2 is not a finite number'):
                phrenic.fit(path)
            with self.assertRaisesRegex(invalid, "none.csv: No such file"):
                phrenic.fit([path, Path(folder, "none.csv")])
            with self.assertRaisesRegex(invalid, "landmarks: 3 files: give one of pairs"):
                phrenic.fit([path] * 3)
        many = np.tile(pairs(), (80, 1))
        for error, words, landmarks, options in (
            (invalid, "landmarks: an array of shape", pairs()[:, :3], {}),
            (invalid, "there are 100 landmark pairs; a fit needs 200", pairs()[:100], {}),
            (invalid, "landmarks: 20800 pairs are more than 20000: send every 2th", many, {}),
            (invalid, "landmarks:2: \"nan\" in column 1", np.where(np.arange(6) == 0, np.nan, pairs()), {}),
            (invalid, "modes: 9 is neither 8 nor 12", pairs(), {"modes": 9}),
            (invalid, "split: -1 is outside", pairs(), {"split": -1}),
            (invalid, "scene_name: give at most 64", pairs(), {"scene_name": "Anna/../x"}),
            (invalid, "show_landmarks: .*leave assimilate out", pairs(), {"show_landmarks": True, "assimilate": True}),
            (unfit, "cube-springs.* has no right lung", pairs(), {"scene": "cube-springs"}),
            (phrenic.errors.NotFound, "thorax", pairs(), {"scene": "thorux"}),
        ):  # fmt: skip
            with self.subTest(words), self.assertRaisesRegex(error, words):
                phrenic.fit(landmarks, **options)

    def test_a_caller_that_stops_ends_the_fit_and_frees_its_place(self):
        class Enough(Exception):
            pass

        def stop(done, doing):
            seen.append(doing)
            raise Enough

        def when_there_is_room(progress):
            """A fit that was stopped holds its place until the server's next look."""
            for _ in range(100):
                seen.clear()
                try:
                    return phrenic.fit(pairs(), progress=progress)
                except phrenic.errors.ResourceExhausted:
                    time.sleep(0.1)
            self.fail("no place became free")

        seen = []
        for _ in range(4):  # more than the server runs at a time
            with self.assertRaises(Enough):
                when_there_is_room(stop)
            self.assertEqual(seen, ["registering"])
        when_there_is_room(lambda done, doing: seen.append((done, doing)))
        self.assertEqual([done for done, _ in seen], sorted(done for done, _ in seen))
        self.assertEqual({doing for _, doing in seen}, {"registering", "solving", "fitting"})

    def test_above_the_limit_a_fit_is_refused(self):
        begun, go_on = threading.Event(), threading.Event()

        def wait(*_):
            begun.set()
            go_on.wait(60)

        with phrenic.local(flags=["--max-exports", "1"]) as server:
            first = threading.Thread(target=lambda: phrenic.fit(pairs(), assimilate=True, progress=wait, server=server))
            first.start()
            self.assertTrue(begun.wait(60))
            with self.assertRaisesRegex(phrenic.errors.ResourceExhausted, "fits.*--max-exports"):
                phrenic.fit(pairs(), server=server)
            go_on.set()
            first.join()


class AioFitTest(unittest.IsolatedAsyncioTestCase):
    async def test_the_async_twin_fits_alike(self):
        async with phrenic.aio.Session("thorax", resolution_mm=20) as session:
            found = await session.fit(pairs())
        self.assertEqual(found.message, phrenic.fit(pairs(), "thorax", resolution_mm=20).message)
