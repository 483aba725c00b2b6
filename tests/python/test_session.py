"""A session from its creation to its end, by a real server over a real socket."""

import tempfile
import time
import warnings
from pathlib import Path

import numpy as np

import phrenic
from support import SessionTest


class SessionsTest(SessionTest):
    def test_play_yields_every_frame_in_order_and_repeats(self):
        first = [(f.time, f.state_hash) for f in self.session().play(seconds=0.5, fps=20)]
        again = [(f.time, f.state_hash) for f in self.session().play(seconds=0.5, fps=20)]
        self.assertEqual(first, again)
        np.testing.assert_allclose([t for t, _ in first], np.arange(1, 11) / 20, atol=1e-3)

    def test_a_change_that_waits_for_its_tick_belongs_to_one_session(self):
        with self.session() as s:
            s.set(at_tick=5, breath_force=3)
            with s.fork() as fork:
                self.assertEqual((s.status.waiting_updates, fork.status.waiting_updates), (1, 0))
                s.step(10), fork.step(10)
                s.frame(), fork.frame()
                self.assertNotEqual(s.state_hash, fork.state_hash)

    def test_parameters_apply_now_or_at_a_tick(self):
        session, late = self.session(set={"breath_force": 1.5}), self.session()
        self.assertEqual(session.parameters["breath_force"], 1.5)
        late.set(breath_force=2, at_tick=5)
        late.step(4, read=())
        self.assertEqual(late.parameters["breath_force"], 1)
        late.step(1, read=())
        self.assertEqual(late.parameters["breath_force"], 2)
        late.set(integrator="velocity_verlet", apply_links=False)
        self.assertEqual(late.parameters["integrator"], "velocity_verlet")
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "did you mean breath_force"):
            late.set(breath_forse=1)
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "wrong type"):
            late.set(breath_force="strong")

    def test_a_body_is_chosen_by_its_numbers(self):
        adult = self.session("thorax", resolution_mm=20)
        small = self.session("thorax", resolution_mm=20, physique={"height": 1.5, "sex": "male"})
        top = [s.frame(read=("bodies",))["t1"].positions[:, 2].max() for s in (adult, small)]
        self.assertAlmostEqual(top[1] / top[0], 1.5 / 1.75, places=5)
        self.assertLess(small.measure("lung volume"), 0.9 * adult.measure("lung volume"))
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "did you mean height"):
            self.session("thorax", physique={"hight": 1.5})
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "physique.height: 3 is outside 1.2 to 2.2"):
            self.session("thorax", physique={"height": 3})
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "generates no body"):
            self.session("cube-springs", physique={"height": 1.5})
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "give {name: value}"):
            self.session("thorax", physique=1.5)

    def test_a_step_that_is_too_long_warns(self):
        session = self.session("pressure-lungs")
        with self.assertWarnsRegex(phrenic.SimulationWarning, "largest stable step") as caught:
            session.set(elasticity=2)
        self.assertEqual(Path(caught.filename), Path(__file__), "the warning is of the caller's line")

    def test_a_fork_goes_its_own_way(self):
        session = self.session()
        session.step(10, read=())
        with session.fork() as same, session.fork(elasticity=3) as other:
            expected = session.step(10, read=()).state_hash
            self.assertEqual(same.step(10, read=()).state_hash, expected)
            self.assertNotEqual(other.step(10, read=()).state_hash, expected)

    def test_measures_are_read_by_name_and_follow_changes(self):
        session = self.session("pressure-lungs")
        session.step(20)
        name = next(iter(session.measures))
        self.assertEqual(session.measure(name), session.measures[name])
        self.assertEqual(session.step(1).units["lung volume"], "m^3")
        with self.assertRaisesRegex(phrenic.errors.NotFound, "there is no measure lung volumes"):
            session.measure("lung volumes")

    def test_pulls_and_forces(self):
        session = self.session()
        session.pull("cube", 6, (0, 0, 2.0))
        forces = session.forces("cube", 6)
        np.testing.assert_allclose(forces["pull"], (0, 0, 2.0))
        np.testing.assert_allclose(sum(f for kind, f in forces.items() if kind != "net"), forces["net"], atol=1e-9)
        self.assertEqual(session.forces("cube", kind="net").shape, (8,))
        session.release()
        self.assertNotIn("pull", session.forces("cube"))

    def test_reset_returns_to_the_start(self):
        session = self.session()
        start = session.state_hash
        session.step(5)
        self.assertNotEqual(session.state_hash, start)
        session.reset()
        self.assertEqual((session.tick, session.state_hash), (0, start))

    def test_a_session_ends_with_its_block_and_a_joined_one_does_not(self):
        server = phrenic.default_server()
        with phrenic.Session("cube-springs", id="ours") as session:
            with server.attach("ours") as joined:
                joined.step(3)
            self.assertIn("ours", server.sessions())
            self.assertEqual(session.frame(()).tick, 3)
        self.assertNotIn("ours", server.sessions())
        session.close()

    def test_a_running_session_is_watched(self):
        session = self.session()
        session.run(speed=1)
        frames = []
        for frame in session.watch():
            frames.append(frame)
            if len(frames) == 5:
                break
        session.pause()
        self.assertTrue(all(a.tick < b.tick for a, b in zip(frames[1:], frames[2:])))
        self.assertEqual(frames[-1]["cube"].positions.shape, (8, 3))
        session.step(1)

    def test_samples_are_equally_spaced_and_none_is_missing(self):
        session = self.session("hanging-sheet", set={"time_step": 0.0005})
        session.run(speed=1)
        samples = []
        for sample in session.samples(["energy of the springs"], interval=0.01):
            samples.append(sample)
            if len(samples) == 20:
                break
        session.pause()
        self.assertEqual([sample.left_out for sample in samples], [0] * 20)
        self.assertEqual({b.tick - a.tick for a, b in zip(samples, samples[1:])}, {20})
        self.assertEqual(list(samples[0].measures), ["energy of the springs"])
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "^interval:"):
            next(session.samples(interval=0))

    def test_a_running_session_is_read_anew(self):
        session = self.session()
        session.run(speed=1)
        first, tick = session.state_hash, session.tick
        for _ in range(1000):
            if session.state_hash != first:
                break
            time.sleep(0.01)
        self.assertNotEqual(session.state_hash, first)
        self.assertGreater(session.tick, tick)
        session.pause()
        self.assertEqual(session.state_hash, session.state_hash)

    def test_a_joined_session_is_read_anew(self):
        session = self.session()
        joined = phrenic.default_server().attach(session.id)
        start = joined.state_hash
        session.step(5, read=())
        self.assertEqual(joined.state_hash, session.state_hash)
        self.assertNotEqual(joined.state_hash, start)

    def test_a_divergence_is_an_error_with_a_remedy(self):
        session = self.session()
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            session.set(integrator="explicit_euler", time_step=0.1, elasticity=10)
        with self.assertRaisesRegex(phrenic.errors.OutOfRange, "diverged at t = .*(?s:.)*reset"):
            session.step(1000, read=())
        with self.assertRaises(phrenic.errors.FailedPrecondition):
            session.step(1)

    def test_a_scene_of_ones_own_is_read_and_its_mistakes_are_named(self):
        text = (
            "name: 'dot' bodies { name: 'dot' role: ROLE_DEFORMABLE mass: 1 "
            "grid { columns: 2 rows: 2 u { x: 1 } v { y: 1 } } } forces { name: 'g' gravity { bodies: 'dot' acceleration { z: -9.81 } } }"
        )
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "dot.textproto")
            path.write_text(text)
            self.assertEqual(self.session(path).scene, "dot")
            path.write_text(text.replace("columns", "colums"))
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "dot.textproto.*colums"):
                phrenic.Session(path)
        with self.assertRaisesRegex(phrenic.errors.NotFound, "thorax"):
            phrenic.Session("thorux")

    def test_a_session_closes_within_a_second(self):
        session = self.session()
        start = time.monotonic()
        session.close()
        self.assertLess(time.monotonic() - start, 1)
