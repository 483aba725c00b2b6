"""The async client gives what the blocking one gives."""

import asyncio
import inspect
import itertools
import tempfile
import threading
import unittest
from pathlib import Path
from unittest import mock

import phrenic
from phrenic.call import Call, one
from phrenic.v1 import session_pb2, study_pb2
from support import FakeServer, Relay, SessionTest


class AioTest(SessionTest, unittest.IsolatedAsyncioTestCase):
    async def studies(self, server):
        answer = await server.connection.run(one(Call("StudyService.ListStudies", study_pb2.ListStudiesRequest())))
        return list(answer.studies)

    async def test_the_same_steps_give_the_same_states(self):
        blocking = self.session().step(30)
        async with phrenic.aio.Session("cube-springs") as session:
            frame = await session.step(30)
            self.assertEqual(frame.state_hash, blocking.state_hash)
            self.assertEqual(await session.state_hash(), blocking.state_hash)
            async with await session.fork(elasticity=2) as fork:
                self.assertNotEqual((await fork.step(5)).state_hash, (await session.step(5)).state_hash)
                self.assertGreater((await session.compare(fork))["hd_max"], 0)
            with tempfile.TemporaryDirectory() as folder:
                path = Path(folder, "cube.msh")
                await session.export(path)
                self.assertTrue(path.exists())

    async def test_samples_are_those_of_the_blocking_client(self):
        async with phrenic.aio.Session("hanging-sheet", set={"time_step": 0.0005}) as session:
            await session.run(speed=1)
            ticks = []
            async for sample in session.samples(["energy of the springs"], interval=0.01):
                ticks.append(sample.tick)
                if len(ticks) == 5:
                    break
            await session.pause()
        self.assertEqual([tick - ticks[0] for tick in ticks], [0, 20, 40, 60, 80])

    async def test_tissue_is_that_of_the_blocking_client(self):
        blocking = phrenic.Session("person-1")
        self.addCleanup(blocking.close)
        expected = blocking.step(500) and blocking.tissue()
        async with phrenic.aio.Session("person-1") as session:
            await session.step(500)
            read = await session.tissue()
        for name, lung in expected.lungs.items():
            self.assertTrue((read[name].amplitudes == lung.amplitudes).all(), name)
            self.assertTrue(lung.amplitudes.any(), name)

    def test_the_twin_has_every_name_and_argument(self):
        for blocking, twin in (
            (phrenic.Session, phrenic.aio.Session),
            (phrenic.Studies, phrenic.aio.Studies),
            (phrenic.Server, phrenic.aio.Server),
            (phrenic, phrenic.aio),
        ):
            names = [n for n in vars(blocking) if not n.startswith("_")] if isinstance(blocking, type) else phrenic.__all__
            for name in names:
                ours = getattr(blocking, name)
                if blocking is phrenic and (isinstance(ours, type) or not callable(ours) or name in ("local", "default_server")):
                    continue  # results and errors are the same; a server in this process's care is phrenic.local()
                theirs = getattr(twin, name, None)
                self.assertIsNotNone(theirs, f"{twin.__name__} has no {name}")
                if not callable(ours):
                    continue
                taken = inspect.signature(theirs).parameters
                for argument in inspect.signature(ours).parameters:
                    self.assertTrue(argument in taken or "options" in taken, f"{twin.__name__}.{name}({argument}=...)")

    async def test_a_batch_has_the_bits_of_the_blocking_one(self):
        forces = [{"breath_force": 0.05 * i} for i in range(300)]
        expected = {run.index: run.state_hash for run in phrenic.batch("cube-springs", forces, seconds=0.1)}
        runs = [run async for run in phrenic.aio.batch("cube-springs", forces, seconds=0.1, threads=2)]
        self.assertEqual({run.index: run.state_hash for run in runs}, expected)
        relay = Relay(phrenic.default_server().address)
        self.addCleanup(relay.stop)
        async with phrenic.aio.connect(relay.address) as server:
            seen = []
            async for run in phrenic.aio.batch("pressure-lungs", forces[:20], seconds=1, fps=1, server=server):
                seen.append(run.index)
                if len(seen) == 3:
                    relay.cut()
            self.assertEqual(sorted(seen), list(range(20)), "a run came twice or not at all")
            with self.assertRaisesRegex(phrenic.errors.InvalidArgument, r"runs\[299\]"):
                wrong = [*forces[:299], {"breath_force": -1}]
                _ = [run async for run in phrenic.aio.batch("cube-springs", wrong, seconds=0.01, server=server)]
            left = phrenic.aio.batch("cube-springs", itertools.repeat({}), seconds=60, fps=0.1, server=server)
            await left.__anext__()
            await left.aclose()

    async def test_frames_ahead_have_the_same_bits(self):
        async with phrenic.aio.Session("cube-springs") as session, await session.fork() as other:
            plain = [frame.state_hash async for frame in session.play(0.1, fps=50)]
            ahead = [frame.state_hash async for frame in other.play(0.1, fps=50, ahead=2)]
            self.assertEqual(plain, ahead)

    async def test_a_server_says_what_it_is(self):
        blocking = phrenic.default_server()
        async with phrenic.aio.connect(blocking.address) as server:
            self.assertEqual((server.address, server.version), (blocking.address, blocking.version))
            async with phrenic.aio.Session("cube-springs", server=server) as session:
                self.assertIn(session.id, await server.sessions())
                self.assertEqual(server.viewer(session), blocking.viewer(session))
            described = await server.describe("cube-springs")
            self.assertEqual(described.report.stable_step, blocking.describe("cube-springs").report.stable_step)

    async def test_sessions_run_side_by_side(self):
        async def run(force):
            async with phrenic.aio.Session("cube-springs", set={"breath_force": force}) as session:
                frames = [frame async for frame in session.play(seconds=0.1, fps=50)]
                return frames[-1].state_hash

        hashes = await asyncio.gather(*(run(force) for force in (1, 2, 2)))
        self.assertEqual(hashes[1], hashes[2])

    async def test_errors_are_typed_and_a_cancelled_job_is_deleted(self):
        address = phrenic.default_server().address
        async with phrenic.aio.connect(address) as server:
            with self.assertRaises(phrenic.errors.NotFound):
                await server.attach("nothing")
            self.assertIn("thorax", (await server.scenes())["name"])
            async with phrenic.aio.Session("cube-springs", server=server) as session:
                begun = asyncio.Event()
                work = session.study.error(lambda *_: begun.set(), seconds=60, levels=8)
                study = asyncio.create_task(work)
                await asyncio.wait_for(begun.wait(), 60)
                self.assertEqual([each.scene for each in await self.studies(server)], ["cube-springs"])
                study.cancel()
                with self.assertRaises(asyncio.CancelledError):
                    await study
                self.assertEqual(await self.studies(server), [])
                joined = await server.attach(session.id)
                self.assertEqual((await joined.step(2)).tick, 2)

    async def test_a_joined_session_reads_no_file_that_its_scene_names(self):
        fake = FakeServer()
        self.addCleanup(fake.stop)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder, "x.textproto")
            path.write_text("name: 'private'")
            status = session_pb2.Session(id="class", scene=str(path))
            fake.answers["GetSession"] = lambda *_: session_pb2.GetSessionResponse(session=status)
            async with phrenic.aio.connect(fake.address) as server:
                joined = await server.attach("class")
        self.assertEqual(joined._source, session_pb2.SceneSource(name=str(path)))

    async def test_a_server_starts_beside_the_loop(self):
        threads = []

        def start():
            threads.append(threading.current_thread())
            return phrenic.default_server()

        with mock.patch("phrenic.aio.default_server", start):
            session = phrenic.aio.Session("cube-springs")
            self.assertEqual(threads, [])
            with self.assertRaisesRegex(phrenic.errors.FailedPrecondition, "async with"):
                await session.step(1)
            await session.close()
            async with session:
                self.assertEqual((await session.step(1)).tick, 1)
        self.assertEqual(len(threads), 1)
        self.assertIsNot(threads[0], threading.current_thread())

    async def test_a_session_that_cannot_begin_closes_its_connection(self):
        session = phrenic.aio.Session("thorux")
        with self.assertRaisesRegex(phrenic.errors.NotFound, "thorax"):
            async with session:
                self.fail("it began")
        with self.assertRaisesRegex(Exception, "closed"):
            await session.step(1)

    async def test_a_running_session_is_watched(self):
        async with phrenic.aio.Session("cube-springs") as session:
            await session.run(speed=1)
            async for frame in session.watch():
                if frame.tick > 0:
                    break
            await session.pause()
            self.assertGreater(frame.tick, 0)
