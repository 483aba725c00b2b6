"""Streams of steps: the states of single calls, in order."""

import asyncio
import unittest

import phrenic
from support import SessionTest


class AdvanceTest(SessionTest):
    def test_steps_sent_ahead_are_the_steps_of_calls(self):
        stream, calls = self.session(), self.session()
        with stream.advance() as steps:
            for _ in range(8):
                steps.send(3)
            self.assertEqual(steps.pending, 8)
            for _ in range(8):
                frame, expected = steps.receive(), calls.step(3)
                self.assertEqual((frame.tick, frame.state_hash), (expected.tick, expected.state_hash))
                self.assertTrue((frame.state.velocities == expected.state.velocities).all())
        self.assertEqual(stream.step(1).state_hash, calls.step(1).state_hash)

    def test_a_parameter_changes_with_the_step_that_it_begins_with(self):
        stream, calls = self.session(), self.session()
        with stream.advance(read=()) as steps:
            frame = steps.step(5, breath_force=2)
        calls.set(breath_force=2)
        self.assertEqual(frame.state_hash, calls.step(5).state_hash)
        self.assertEqual(stream.parameters["breath_force"], 2)

    def test_play_ahead_yields_the_frames_of_play(self):
        for fps in (10, 60, 1000, 7000):
            plain = [(f.tick, f.state_hash) for f in self.session().play(seconds=0.1, fps=fps)]
            ahead = [(f.tick, f.state_hash) for f in self.session().play(seconds=0.1, fps=fps, ahead=4)]
            self.assertEqual(plain, ahead)

    def test_a_loop_that_is_left_ends_the_stream_at_most_ahead(self):
        session = self.session()
        for frame in session.play(seconds=10, fps=100, ahead=3):
            break
        per_frame = frame.tick
        self.assertLessEqual(session.frame(read=()).tick, 4 * per_frame)
        session.step(1)

    def test_errors_are_those_of_calls(self):
        session = self.session()
        with session.advance() as steps:
            with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "send one first"):
                steps.receive()
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "did you mean breath_force"):
                steps.send(1, breath_forse=1)
            steps.send(1)
            with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "1 answers are pending"):
                steps.step(1)
            steps.receive()
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "breath_force: 99"):
                steps.step(1, breath_force=99)
        with self.assertRaisesRegex(phrenic.errors.InvalidArgument, "ahead: -1"):
            next(session.play(seconds=1, ahead=-1))

    def test_the_async_twin(self):
        expected = [(f.tick, f.state_hash) for f in self.session().play(seconds=0.1, fps=20)]

        async def frames():
            async with phrenic.aio.Session("cube-springs") as s:
                async with s.advance() as steps:
                    for ticks in s._frame_ticks(0.1, 20):
                        await steps.send(ticks)
                    got = [await steps.receive() for _ in range(2)]
                    with self.assertRaises(phrenic.errors.InvalidArgument):
                        await steps.step(1, breath_force=99)
                    return [(f.tick, f.state_hash) for f in got]

        self.assertEqual(asyncio.run(frames()), expected)


if __name__ == "__main__":
    unittest.main()
