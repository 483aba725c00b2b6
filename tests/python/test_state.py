"""Steps lose nothing: the state hash can be computed from what a step returns."""

import struct

import numpy as np

import phrenic
from phrenic.v1 import frames_pb2
from support import SessionTest

BASIS, PRIME, WORD = 0xCBF29CE484222325, 0x100000001B3, (1 << 64) - 1


def mix(value: float, lane: int) -> int:
    lane = ((lane ^ struct.unpack("<Q", struct.pack("<d", value))[0]) * PRIME) & WORD
    return lane ^ (lane >> 29)


def hash_of(state: phrenic.State) -> str:
    """server/mechanics/state.cc, in Python."""
    lanes = [BASIS, BASIS + 1, BASIS + 2, BASIS + 3]
    for array in (state.positions, state.velocities, state.scalars, state.scalar_rates):
        numbers = [] if array is None else array.ravel().tolist()
        whole = len(numbers) // 4 * 4
        for i, number in enumerate(numbers):
            lane = i % 4 if i < whole else 0
            lanes[lane] = mix(number, lanes[lane])
    total = mix(state.phase, mix(state.time, BASIS))
    for lane in lanes:
        total = mix(struct.unpack("<d", struct.pack("<Q", lane))[0], total)
    return f"{total:016x}"


class StateTest(SessionTest):
    def test_the_hash_of_the_returned_arrays_is_the_state_hash(self):
        for scene in ("cube-springs", "pressure-lungs", "muscle"):  # the last has scalar coordinates
            with self.subTest(scene):
                frame = self.session(scene).step(50)
                self.assertEqual(hash_of(frame.state), frame.state_hash)
                changed = frame.state.positions.copy()
                changed[0, 0] = np.nextafter(changed[0, 0], 1)
                bent = phrenic.State(
                    frame.tick, frame.time, frame.state.phase, changed, frame.state.velocities,
                    frame.state.scalars, frame.state.scalar_rates,
                )  # fmt: skip
                self.assertNotEqual(hash_of(bent), frame.state_hash, "one bit of one number must count")

    def test_reading_the_state_changes_nothing(self):
        read, unread = self.session(), self.session()
        for _ in range(10):
            read.step(1)
            read.frame()
        self.assertEqual(read.state_hash, unread.step(10, read=()).state_hash)

    def test_an_unread_part_is_absent_and_named(self):
        frame = self.session().step(1, read=("positions",))
        self.assertIsNone(frame.state.velocities)
        with self.assertRaisesRegex(ValueError, "velocities"):
            frame.state.velocities_of("cube")
        with self.assertRaisesRegex(ValueError, "bodies"):
            frame["cube"]
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "did you mean positions"):
            self.session().step(1, read=("position",))

    def test_a_part_that_is_read_and_has_no_numbers_is_empty(self):
        for frame in (self.session().step(1), self.session().frame()):
            self.assertEqual((frame.state.scalars.shape, frame.state.scalar_rates.shape), ((0,), (0,)))
            self.assertEqual(frame.state.named_scalars, {})
        self.assertIsNone(self.session().step(1, read=("positions",)).state.scalars)

    def test_bodies_need_no_layout(self):
        session = self.session()
        self.assertEqual(session.step(1, read=("bodies",))["cube"].positions.shape, (8, 3))
        self.assertIsNone(session._layout)
        self.assertEqual(session.step(1).state.positions_of("cube").shape, (8, 3))

    def test_a_phase_means_the_same_in_every_frame(self):
        session = self.session()
        frame = session.step(1200)
        self.assertGreater(frame.state.phase, 1)
        self.assertEqual(frame.phase, frame.state.phase % 1)
        unread = session.step(1, read=())
        self.assertTrue(np.isnan(unread.phase) and np.isnan(unread.state.phase))
        watched = next(session.watch())
        self.assertLess(abs(watched.phase - session.frame(("positions",)).phase), 1e-6)
        self.assertTrue(np.isnan(watched.state.phase), "a stream does not count breaths")

    def test_bodies_are_the_state_in_float32_and_share_the_memory_of_the_answer(self):
        frame = self.session().step(20)
        seen = frame["cube"].positions
        self.assertEqual(seen.dtype, np.float32)
        np.testing.assert_array_equal(seen, frame.state.positions_of("cube").astype(np.float32))
        self.assertIsNotNone(seen.base)
        self.assertFalse(seen.flags.owndata)
        self.assertIs(frame["cube"].positions.base.base, seen.base.base)

    def test_a_frame_equals_an_export_of_the_same_run(self):
        session = self.session()
        with self.subTest("the hash of an export's end is that of the steps"):
            import tempfile

            with tempfile.TemporaryDirectory() as folder:
                summary = session.export(f"{folder}/cube.msh", seconds=0.2, fps=10)
            self.assertEqual(session.step(summary["end_tick"], read=()).state_hash, summary["state_hash"])

    def test_rigid_and_still_bodies_are_placed(self):
        session = self.session("thorax", preset="deep", resolution_mm=20)
        frame = session.step(200)
        placements = {name: body.placement for name, body in frame._geometry.bodies.items()}
        kinds = {frames_pb2.PLACEMENT_STILL, frames_pb2.PLACEMENT_RIGID, frames_pb2.PLACEMENT_STREAMED}
        self.assertEqual(set(placements.values()), kinds)
        moved = {kind: 0.0 for kind in kinds}
        for name in frame.bodies:
            body = frame[name]
            self.assertEqual(body.positions.shape, body.rest.shape)
            self.assertTrue(np.isfinite(body.positions).all())
            way = float(np.abs(body.positions - body.rest).max())
            moved[placements[name]] = max(moved[placements[name]], way)
            if placements[name] == frames_pb2.PLACEMENT_RIGID:
                sizes = [np.linalg.norm(points - points[0], axis=1) for points in (body.positions, body.rest)]
                np.testing.assert_allclose(*sizes, atol=1e-6)
        self.assertEqual(moved[frames_pb2.PLACEMENT_STILL], 0)
        self.assertGreater(moved[frames_pb2.PLACEMENT_RIGID], 0)
        self.assertGreater(moved[frames_pb2.PLACEMENT_STREAMED], 0)

    def test_a_coordinate_has_a_name(self):
        state = self.session("muscle").step(20).state
        self.assertEqual(list(state.named_scalars), [row.name for row in state.layout.scalars])
        self.assertIn("muscle:dome:stretch-rate-0", state.named_scalars)
        np.testing.assert_array_equal(list(state.named_scalars.values()), state.scalars)
        self.assertTrue(any(state.named_scalars.values()))
