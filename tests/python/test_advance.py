"""Streams of steps: the states of single calls, in order."""

import asyncio
import os
import signal
import threading
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
        ahead = session.frame(read=()).tick
        self.assertLessEqual(ahead, 4 * per_frame)
        self.assertEqual(session.step(1).tick, ahead + 1)

    def test_a_session_goes_on_after_a_stream_that_was_left(self):
        session, same = self.session(), self.session()
        for ending in (None, KeyboardInterrupt):
            try:
                with session.advance() as steps:
                    for _ in range(4):
                        steps.send(10)
                    if ending:
                        raise ending
            except KeyboardInterrupt:
                pass
            frame = session.step(1)
            self.assertEqual(frame.state_hash, same.step(frame.tick - same.tick).state_hash)
        with session.advance() as steps:
            steps.send(1)
            tick = session.step(1).tick  # ends the stream
            with self.assertRaises(phrenic.errors.FailedPrecondition):
                steps.receive()
        self.assertEqual(session.step(1).tick, tick + 1)

    def test_a_session_goes_on_after_an_error_of_a_stream(self):
        session = self.session()
        with session.advance() as steps:
            for force in (1, 99, 1):
                steps.send(1, breath_force=force)
            with self.assertRaises(phrenic.errors.InvalidArgument):
                [steps.receive() for _ in range(2)]
        self.assertEqual(session.step(1).tick, 2)

    def test_a_stream_follows_steps_beside_it(self):
        session = self.session()
        with session.advance() as steps:
            ticks = [steps.step(1).tick, session.step(1).tick, steps.step(1).tick]
        self.assertEqual(ticks, [1, 2, 3])

    def test_a_session_goes_on_after_a_step_that_was_cut_off(self):
        session = self.session("thorax", resolution_mm=12)
        with self.assertRaises(phrenic.errors.DeadlineExceeded):
            session.step(10**6, read=(), timeout=0.2)
        tick = session.step(1).tick
        self.assertEqual(session.step(1).tick, tick + 1)
        interrupt = threading.Timer(0.2, os.kill, (os.getpid(), signal.SIGINT))
        interrupt.start()
        with self.assertRaises(KeyboardInterrupt):
            session.step(10**6, read=())
        interrupt.join()
        self.assertEqual(session.step(1).tick, session.tick)

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

    def test_the_async_twin_goes_on_after_what_was_left(self):
        async def left():
            async with phrenic.aio.Session("thorax", resolution_mm=12) as s:
                async for _ in s.play(10, fps=100, ahead=3):
                    break
                self.assertEqual((await s.step(1)).tick, s.tick)
                async with s.advance() as steps:
                    for _ in range(4):
                        await steps.send(10)
                self.assertEqual((await s.step(1)).tick, s.tick)
                with self.assertRaises(asyncio.TimeoutError):
                    await asyncio.wait_for(s.step(10**6), 0.2)
                tick = (await s.step(1)).tick
                self.assertEqual((await s.step(1)).tick, tick + 1)

        asyncio.run(left())


if __name__ == "__main__":
    unittest.main()
