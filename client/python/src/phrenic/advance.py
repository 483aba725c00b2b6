"""Steps by one ordered stream, SessionService.Advance: a step costs less than a call, and steps can be sent ahead.

>>> import phrenic
>>> with phrenic.Session("cube-springs") as s, s.advance(read=("positions",)) as steps:
...     for _ in range(3):
...         steps.send(10)                         # the server computes while this process does something else
...     [steps.receive().tick for _ in range(3)]
...     frame = steps.step(1, breath_force=2)      # changes a parameter, takes a step, and waits for it
[10, 20, 30]
"""

from __future__ import annotations

import queue
import warnings
from collections import deque
from typing import TYPE_CHECKING, Any, Iterator, Optional, Sequence

import grpc

from .arguments import whole
from .call import Call
from .errors import Error, FailedPrecondition, Unavailable, error_of
from .frame import Frame
from .operations import SimulationWarning, parameters_of, parts_of
from .v1 import session_pb2

if TYPE_CHECKING:
    from . import aio
    from .connection import Channel
    from .operations import SessionOperations

METHOD = "SessionService.Advance"


class Requests:
    """What both streams share: makes the requests, and takes the answers in their order."""

    def __init__(self, session: "SessionOperations", read: Sequence[str]) -> None:
        self._session = session
        self._parts = parts_of(read)
        self._pending: deque[int] = deque()
        self._tick = session.tick
        self._channel: Optional["Channel"] = None
        self._answers: Any = None

    @property
    def pending(self) -> int:
        """Number of requests whose answer was not received."""
        return len(self._pending)

    def _request(self, ticks: int, parameters: dict[str, Any]) -> session_pb2.AdvanceRequest:
        self._session._check_open()
        ticks = whole("ticks", ticks)
        if not self._pending:  # other calls may have stepped
            self._tick = self._session.tick
        request = session_pb2.AdvanceRequest(
            session_id=self._session.id, ticks=ticks, control_token=self._session._token, read=self._parts
        )
        if parameters:
            request.parameters.CopyFrom(parameters_of(parameters))
        if self._session._owned:
            request.expected_tick = self._tick
        self._tick += ticks
        self._pending.append(ticks)
        return request

    def _expect(self) -> None:
        if not self._pending:
            raise FailedPrecondition("every step that was sent has been received; send one first")

    def _frame(self, answer: session_pb2.AdvanceResponse) -> Frame:
        self._pending.popleft()
        if answer.HasField("session"):
            self._session.status = answer.session
        for text in answer.warnings:
            warnings.warn(text, SimulationWarning, stacklevel=4)
        return self._session._frame_of(answer.state, answer, self._parts)

    def _failed(self, failed: grpc.RpcError) -> Error:
        """Returns the error that has ended the stream. Steps that were sent after it are not taken."""
        self.leave()
        return error_of(failed)

    def leave(self) -> None:
        """Ends the stream. While answers are pending, the session's next call finds out how far the steps were taken."""
        self._session._unsettled |= bool(self._pending)
        self._pending.clear()
        if self._channel is not None:
            self._channel.cancel(self._answers)

    def _call(self) -> Call:
        return Call(METHOD, session_pb2.AdvanceRequest(session_id=self._session.id))


class Steps(Requests):
    """The stream of a blocking session, made by Session.advance; a context manager. Not thread-safe. The first error
    ends it, and steps that were sent after the one that failed are not taken. A pause of a minute ends it too
    (DeadlineExceeded): make a new one."""

    def __init__(self, session: "SessionOperations", channel: "Channel", read: Sequence[str]) -> None:
        session._leave_stream()
        super().__init__(session, read)
        session._stream = self
        self._sent: queue.SimpleQueue[Optional[session_pb2.AdvanceRequest]] = queue.SimpleQueue()
        self._channel = channel
        self._answers = channel.converse(self._call(), iter(self._sent.get, None))

    def __enter__(self) -> "Steps":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def send(self, ticks: int = 1, **parameters: Any) -> None:
        """Asks for steps, after a change of live parameters if some are given. Does not wait. InvalidArgument for an
        unknown parameter; other errors come from receive()."""
        self._sent.put(self._request(ticks, parameters))

    def receive(self) -> Frame:
        """Returns the state after the oldest steps whose answer was not received, when it is there. OutOfRange if the
        session diverges, Aborted if another caller has stepped it."""
        self._expect()
        try:
            return self._frame(next(self._answers))
        except StopIteration:
            self.leave()
            raise Unavailable("the stream of steps was closed") from None
        except grpc.RpcError as failed:
            raise self._failed(failed) from None

    def step(self, ticks: int = 1, **parameters: Any) -> Frame:
        """Sends and receives. FailedPrecondition while answers of other steps are pending."""
        if self._pending:
            raise FailedPrecondition(f"{self.pending} answers are pending; receive them first")
        self.send(ticks, **parameters)
        return self.receive()

    def close(self) -> None:
        """Ends the stream. Of the steps that were sent and not received, some may be taken; the session's next call knows
        how many."""
        self._sent.put(None)
        self.leave()


def frames_ahead_of(ticks: Sequence[int], ahead: int) -> deque[int]:
    """Returns the steps of each frame that is left. InvalidArgument if `ahead` is negative."""
    whole("ahead", ahead)
    return deque(ticks)


def frames_ahead(session: Any, channel: "Channel", ticks: Sequence[int], read: Sequence[str], ahead: int) -> Iterator[Frame]:
    """Yields the state after each number of ticks; the server is at most `ahead` of them further. InvalidArgument if
    `ahead` is negative."""
    left = frames_ahead_of(ticks, ahead)
    with Steps(session, channel, read) as steps:
        while left or steps.pending:
            while left and steps.pending <= ahead:
                steps.send(left.popleft())
            yield steps.receive()


class AsyncSteps(Requests):
    """Steps for asyncio: `async with s.advance() as steps: await steps.step()`."""

    def __init__(self, session: "aio.Session", read: Sequence[str]) -> None:
        session._leave_stream()
        super().__init__(session, read)

    async def __aenter__(self) -> "AsyncSteps":
        session: Any = self._session
        await session._do(session._describe(self._parts))
        self._channel = session._begun()
        self._answers = self._channel.converse(self._call())
        session._stream = self
        return self

    async def __aexit__(self, *_: Any) -> None:
        self.leave()

    async def send(self, ticks: int = 1, **parameters: Any) -> None:
        """As Steps.send."""
        try:
            await self._answers.write(self._request(ticks, parameters))
        except (grpc.RpcError, grpc.aio.UsageError):  # the stream has ended: receive() says why
            pass

    async def receive(self) -> Frame:
        """As Steps.receive."""
        self._expect()
        try:
            answer = await self._answers.read()
            if answer is grpc.aio.EOF:
                await self._answers  # raises the status
                self.leave()
                raise Unavailable("the stream of steps was closed")
            return self._frame(answer)
        except grpc.RpcError as failed:
            raise self._failed(failed) from None

    async def step(self, ticks: int = 1, **parameters: Any) -> Frame:
        """As Steps.step."""
        if self._pending:
            raise FailedPrecondition(f"{self.pending} answers are pending; receive them first")
        await self.send(ticks, **parameters)
        return await self.receive()
