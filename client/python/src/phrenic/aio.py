"""The same for asyncio.

>>> import asyncio, phrenic
>>> async def main():
...     async with phrenic.aio.Session("cube-springs") as s:
...         return [frame.tick async for frame in s.play(seconds=0.02, fps=100)]
>>> len(asyncio.run(main()))
2
"""

from __future__ import annotations

import asyncio
import os
from contextlib import asynccontextmanager
from pathlib import Path
from typing import Any, AsyncGenerator, AsyncIterator, Container, Iterable, Mapping, Optional, Sequence, Union

import grpc
import grpc.aio

from . import jobs
from .advance import AsyncSteps, frames_ahead_of
from .arguments import whole
from .call import FIRST, RETRIES, Call, Operation, T, delay_before_repeat, one
from .connection import Channel, Target, Tls, target_of
from .errors import Error, FailedPrecondition, error_of
from .fits import Fit, Landmarks, fitted
from .frame import Frame, State
from .operations import (
    EVERYTHING,
    Scene,
    SessionOperations,
    attach,
    check_server,
    create,
    describe,
    scenes,
    session_ids,
    source_of,
)
from .patients import LabelFiles, Patient, made
from .runs import Run, parts, request_of
from .samples import Sample, SampleReader
from .server import ServerFacts, default_server
from .table import Table
from .tissue import Tissue, tissue
from .v1 import server_pb2, session_pb2, state_pb2


@asynccontextmanager
async def _closing(values: AsyncGenerator[T, None]) -> AsyncIterator[AsyncGenerator[T, None]]:
    """contextlib.aclosing, which Python 3.9 lacks."""
    try:
        yield values
    finally:
        await values.aclose()


class Connection(Channel):
    """An asyncio connection, of one event loop."""

    asynchronous = True

    def __init__(self, target: Target) -> None:
        super().__init__(target, grpc.aio)

    async def close(self) -> None:
        """Ends the calls in progress. Has no effect in a forked process, whose parent has the connection."""
        self._closed = True
        if self._process == os.getpid():
            await self._channel.close()

    async def run(self, operation: Operation[T]) -> T:
        """Performs the operation's calls and returns its result."""
        try:
            call = next(operation)
            while True:
                try:
                    answer = await self._perform(call)
                except BaseException as error:  # also cancellation: the operation tidies up on the server
                    call = operation.throw(error)
                else:
                    call = operation.send(answer)
        except StopIteration as done:
            return done.value

    async def _perform(self, call: Call) -> Any:
        attempt = 0
        while True:
            try:
                return await self._once(call)
            except grpc.RpcError as failed:
                error = error_of(failed)
                delay = delay_before_repeat(call, error, attempt, self.target.retries)
                if delay is None:
                    raise error from None
            await asyncio.sleep(delay)
            attempt += 1

    async def _once(self, call: Call) -> Any:
        answer = self.open(call, call.deadline or self.target.timeout)
        if call.each is None:
            return await answer
        try:
            async for message in answer:
                call.each(message)
        finally:  # a receiver that raises ends the call
            self.cancel(answer)
        return None

    async def stream(self, call: Call) -> AsyncGenerator[Any, None]:
        """As phrenic.Connection.stream."""
        messages = self.open(call, call.deadline)
        try:
            async for message in messages:
                yield message
        except grpc.RpcError as failed:
            raise error_of(failed) from None
        finally:
            self.cancel(messages)


class Session(SessionOperations):
    """phrenic.Session for asyncio: `async with Session("thorax") as s`. Created when the block begins, deleted when it
    ends. Without `server` it runs on the same server as phrenic.Session."""

    def __init__(
        self,
        scene: Scene,
        *,
        set: Optional[Mapping[str, Any]] = None,
        preset: str = "",
        id: str = "",
        resolution_mm: Optional[float] = None,
        physique: Optional[Mapping[str, Any]] = None,
        server: Optional["Server"] = None,
    ) -> None:
        super().__init__(session_pb2.Session(), "", owned=True)
        if server is not None:
            check_server(server, asynchronous=True)
        self._connection: Optional[Connection] = server.connection if server else None
        self._shared = server is not None
        self._source = source_of(scene, resolution_mm, physique)
        self._creation: Optional[Operation[Any]] = create(scene, set, preset, id, resolution_mm, physique)

    def _begun(self) -> Connection:
        if self._connection is None:
            raise FailedPrecondition("the session has not begun: use `async with`")
        self._check_open()
        return self._connection

    async def _do(self, operation: Operation[T]) -> T:
        return await self._begun().run(self._ready(operation))

    @classmethod
    def _of(
        cls,
        connection: Connection,
        status: session_pb2.Session,
        token: str,
        owned: bool,
        source: Optional[session_pb2.SceneSource] = None,
    ) -> "Session":
        session = cls.__new__(cls)
        SessionOperations.__init__(session, status, token, owned)
        session._connection, session._shared, session._creation = connection, True, None
        # The name may be that of another person's scene text: no file of this machine is read.
        session._source = source or session_pb2.SceneSource(name=status.scene)
        return session

    async def __aenter__(self) -> "Session":
        if self._creation is not None:
            if self._connection is None:  # the start of a server takes a while
                self._connection = Connection((await asyncio.to_thread(default_server)).connection.target)
            try:
                made = await self._do(self._creation)
            except BaseException:
                await self.close()
                raise
            self.status, self._token, self._creation = made.session, made.control_token, None
        return self

    async def __aexit__(self, *_: Any) -> None:
        await self.close()

    async def close(self) -> None:
        """Deletes the session, unless it was joined by attach() or has not begun."""
        if self._owned and self._creation is None and not self._closed:
            await self._begun().run(self._delete())
        self._closed = self._creation is None
        if self._connection is not None and not self._shared:
            await self._connection.close()

    async def step(self, ticks: int = 1, read: Sequence[str] = EVERYTHING, timeout: Optional[float] = None) -> Frame:
        """As phrenic.Session.step."""
        return await self._do(self._step(ticks, read, timeout))

    def advance(self, read: Sequence[str] = EVERYTHING) -> AsyncSteps:
        """As phrenic.Session.advance: `async with s.advance() as steps: await steps.step()`."""
        return AsyncSteps(self, read)

    async def play(
        self, seconds: float, fps: float = 60, read: Sequence[str] = ("bodies",), ahead: int = 0
    ) -> AsyncIterator[Frame]:
        """As phrenic.Session.play."""
        if whole("ahead", ahead) != 0:
            left = frames_ahead_of(self._frame_ticks(seconds, fps), ahead)
            async with self.advance(read) as steps:
                while left or steps.pending:
                    while left and steps.pending <= ahead:
                        await steps.send(left.popleft())
                    yield await steps.receive()
            return
        for time in self._frame_times(seconds, fps):
            yield await self.step(self.ticks_until(time), read)

    async def frame(self, read: Sequence[str] = EVERYTHING) -> Frame:
        """As phrenic.Session.frame."""
        return await self._do(self._read(read))

    async def measure(self, name: str) -> float:
        """As phrenic.Session.measure."""
        return await self._do(self._measure(name))

    async def measures(self) -> dict[str, float]:
        """All of the scene's measures."""
        return await self._do(self._measures())

    async def state_hash(self) -> str:
        """As phrenic.Session.state_hash."""
        return await self._do(self._hash())

    async def forces(self, body: str, vertex: Optional[int] = None, kind: str = "") -> Any:
        """As phrenic.Session.forces."""
        return await self._do(self._forces(body, vertex, kind))

    async def tissue(self, points: Optional[Sequence[Sequence[float]]] = None) -> Tissue:
        """As phrenic.Session.tissue."""
        return await self._do(tissue(self, points))

    async def set(self, preset: str = "", at_tick: Optional[int] = None, **parameters: Any) -> None:
        """As phrenic.Session.set."""
        await self._do(self._set(preset, at_tick, parameters))

    async def pull(self, body: str, vertex: int, force: Sequence[float]) -> None:
        """As phrenic.Session.pull."""
        await self._do(self._pull(body, vertex, force))

    async def release(self) -> None:
        """As phrenic.Session.release."""
        await self._do(self._release())

    async def reset(self) -> None:
        """As phrenic.Session.reset."""
        await self._do(self._reset())

    async def fork(self, id: str = "", **parameters: Any) -> "Session":
        """As phrenic.Session.fork."""
        made = await self._do(self._fork(id))
        fork = Session._of(self._begun(), made.session, made.control_token, True, self._source)
        try:
            if parameters:
                await fork.set(**parameters)
        except BaseException:
            await fork.close()
            raise
        return fork

    async def run(self, speed: float = 1, until: float = 0) -> None:
        """As phrenic.Session.run."""
        await self._do(self._run_on(speed, until))

    async def pause(self) -> None:
        """As phrenic.Session.pause."""
        await self._do(self._pause())

    async def watch(self, max_fps: float = 60, max_error_mm: Optional[float] = None) -> AsyncIterator[Frame]:
        """As phrenic.Session.watch."""
        await self._do(self._describe([state_pb2.STATE_PART_BODIES]))
        async with _closing(self._begun().stream(self._watch_call(max_fps, max_error_mm))) as events:
            async for event in events:
                frame = self._noted(event)
                if frame is not None:
                    yield frame

    async def samples(self, measures: Sequence[str] = (), interval: float = 0.02) -> AsyncIterator[Sample]:
        """As phrenic.Session.samples."""
        reader = SampleReader()
        async with _closing(self._begun().stream(self._samples_call(measures, interval))) as batches:
            async for response in batches:
                for sample in reader.read(response.batch):
                    yield sample

    async def export(
        self,
        path: Union[str, Path],
        seconds: float = 0,
        fps: Optional[float] = None,
        bodies: Sequence[str] = (),
        progress: jobs.Progress = None,
        **options: Any,
    ) -> dict[str, Any]:
        """As phrenic.Session.export."""
        fields = {"seconds": seconds, "frames_per_second": fps, "bodies": bodies, **options}
        return await self._do(jobs.export(self.id, path, fields, progress))

    @property
    def study(self) -> Studies:
        """As phrenic.Session.study: `await s.study.error(levels=4)`."""
        return Studies(self)

    async def physiology(self, presets: Sequence[str] = (), progress: jobs.Progress = None) -> jobs.Physiology:
        """As phrenic.Session.physiology."""
        return await self._do(jobs.physiology(self._source, presets, progress))

    async def fit(self, landmarks: Optional[Landmarks] = None, progress: jobs.Progress = None, **options: Any) -> Fit:
        """As phrenic.Session.fit."""
        return await self._do(fitted(self._source, landmarks, options, progress))

    async def compare(self, other: Union["Session", str, Path], body: str = "", **options: Any) -> jobs.Comparison:
        """As phrenic.Session.compare."""
        operation = jobs.comparison(self.id, getattr(other, "id", None), other, body, options)
        return await self._do(operation)


class Studies:
    """phrenic.Studies for asyncio."""

    def __init__(self, session: Session) -> None:
        self._session = session

    async def error(self, progress: jobs.Progress = None, **options: Any) -> jobs.Study:
        """As phrenic.Studies.error."""
        return await self._run("error", options, progress)

    async def stability(self, progress: jobs.Progress = None, **options: Any) -> jobs.Study:
        """As phrenic.Studies.stability."""
        return await self._run("stability", options, progress)

    async def cost(self, progress: jobs.Progress = None, **options: Any) -> jobs.Study:
        """As phrenic.Studies.cost."""
        return await self._run("cost", options, progress)

    async def streaming(self, progress: jobs.Progress = None, **options: Any) -> jobs.Study:
        """As phrenic.Studies.streaming."""
        return await self._run("streaming", options, progress)

    async def _run(self, kind: str, options: Mapping[str, Any], progress: jobs.Progress) -> jobs.Study:
        session = self._session
        return await session._do(jobs.study(kind, session._source, session.status.parameters, options, progress))


class Server(ServerFacts):
    """phrenic.Server for asyncio: `async with connect(address) as server`. `about` is empty before."""

    connection: Connection

    def __init__(self, target: Target) -> None:
        self.connection = Connection(target)
        self.about = server_pb2.GetServerResponse()

    async def __aenter__(self) -> "Server":
        request = server_pb2.GetServerRequest()
        try:
            self.about = await self.connection.run(one(Call("ServerService.GetServer", request, repeats=FIRST)))
        except BaseException:
            await self.connection.close()
            raise
        return self

    async def __aexit__(self, *_: Any) -> None:
        await self.close()

    async def close(self) -> None:
        """Ends the connection."""
        await self.connection.close()

    async def scenes(self) -> Table:
        """As phrenic.Server.scenes."""
        return await self.connection.run(scenes())

    async def describe(
        self, scene: Scene, resolution_mm: Optional[float] = None, physique: Optional[Mapping[str, Any]] = None
    ) -> session_pb2.DescribeSceneResponse:
        """As phrenic.Server.describe."""
        return await self.connection.run(describe(scene, resolution_mm, physique))

    async def sessions(self) -> list[str]:
        """As phrenic.Server.sessions."""
        return await self.connection.run(session_ids())

    async def attach(self, id: str) -> Session:
        """As phrenic.Server.attach."""
        return Session._of(self.connection, await self.connection.run(attach(id)), "", owned=False)


def connect(
    address: str = "127.0.0.1:50051",
    *,
    token: Optional[str] = None,
    tls: Union[bool, str, Path, Tls, None] = None,
    timeout: float = 120,
    retries: int = RETRIES,
) -> Server:
    """As phrenic.connect. phrenic.local().address is a server to connect to."""
    return Server(target_of(address, token, tls, timeout, retries))


@asynccontextmanager
async def _connected(server: Optional[Server]) -> AsyncIterator[Connection]:
    """The server's connection, or one to the default server, which is closed at the end."""
    if server is not None:
        check_server(server, asynchronous=True)
        yield server.connection
        return
    connection = Connection((await asyncio.to_thread(default_server)).connection.target)
    try:
        yield connection
    finally:
        await connection.close()


async def batch(
    scene: Scene,
    parameters: Iterable[Mapping[str, Any]],
    *,
    seconds: float,
    fps: float = 20,
    preset: str = "",
    resolution_mm: Optional[float] = None,
    physique: Optional[Mapping[str, Any]] = None,
    start: Union[Frame, State, None] = None,
    starts: Optional[Iterable[Union[Frame, State]]] = None,
    read: Sequence[str] = (),
    summary: bool = False,
    threads: Optional[int] = None,
    finished: Container[int] = (),
    server: Optional[Server] = None,
) -> AsyncIterator[Run]:
    """As phrenic.batch: `async for run in batch(...)`. A loop that breaks ends the runs in progress when the iterator is
    closed: `async with contextlib.aclosing(batch(...)) as runs`."""
    request = request_of(scene, seconds, fps, preset, resolution_mm, physique, read, summary, threads)
    async with _connected(server) as connection:
        for part in parts(request, parameters, start, starts, finished, connection.target.retries):
            while not part.ended:
                try:
                    async with _closing(connection.stream(part.call)) as messages:
                        async for message in messages:
                            for run in part.runs_of(message):
                                yield run
                    part.ended = True
                except Error as error:
                    delay = part.delay_after(error)
                    await asyncio.sleep(delay)


async def fit(
    landmarks: Optional[Landmarks] = None,
    scene: Scene = "thorax",
    *,
    resolution_mm: Optional[float] = None,
    progress: jobs.Progress = None,
    server: Optional[Server] = None,
    **options: Any,
) -> Fit:
    """As phrenic.fit, with its options."""
    async with _connected(server) as connection:
        return await connection.run(fitted(source_of(scene, resolution_mm), landmarks, options, progress))


async def patient(
    files: LabelFiles,
    *,
    labels: Optional[Mapping[int, str]] = None,
    progress: jobs.Progress = None,
    server: Optional[Server] = None,
    **options: Any,
) -> Patient:
    """As phrenic.patient, with its options."""
    async with _connected(server) as connection:
        return await connection.run(made(files, labels, options, progress))
