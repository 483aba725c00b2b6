"""The async client gives what the blocking one gives."""

import asyncio
import tempfile
import threading
import unittest
from pathlib import Path
from unittest import mock

import phrenic
from phrenic.call import Call, one
from phrenic.v1 import session_pb2, study_pb2
from support import FakeServer, SessionTest


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
                work = session.study("error", lambda *_: begun.set(), seconds=60, levels=8)
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
