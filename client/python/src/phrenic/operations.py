"""What a session can do, as operations (call.py). Session and aio.Session run them."""

from __future__ import annotations

import math
import os
import uuid
import warnings
from functools import lru_cache
from pathlib import Path
from typing import Any, Iterable, Iterator, Mapping, Optional, Sequence, Union

import numpy as np
from google.protobuf import text_format

from .arguments import INT32, finite, mapping, names_of, positive, text_of, vector, whole
from .call import LONG, Call, Operation, T, new_id
from .codec import Decoder
from .errors import Aborted, AlreadyExists, Cancelled, Closed, DeadlineExceeded, Error, InvalidArgument, NotFound, Unavailable
from .frame import Frame, Geometry, frame_of, watched_frame
from .names import Named, enum_names, enum_number, fill, look_up, nearest, row
from .table import Table
from .v1 import (
    frames_pb2,
    geometry_pb2,
    parameters_pb2,
    samples_pb2,
    scene_pb2,
    session_pb2,
    state_pb2,
)

Scene = Union[str, Path, scene_pb2.Scene]
"""A name of the server's catalogue, a file of scene text, or a scene."""

EVERYTHING = ("bodies", "positions", "velocities", "scalars")
"""All that a step can return; read=() returns measures and the hash alone, which is fastest."""


class SimulationWarning(UserWarning):
    """A warning of the server, for example of a time step above the largest stable one."""


def source_of(
    scene: Scene, resolution_mm: Optional[float] = None, physique: Optional[Mapping[str, Any]] = None
) -> session_pb2.SceneSource:
    """Returns the scene as requests name it. InvalidArgument names the line of a scene text that cannot be parsed, or an
    unknown number of a body."""
    edge = None if resolution_mm is None else finite("resolution_mm", resolution_mm)
    source = session_pb2.SceneSource(resolution_mm=edge, physique=physique_of(physique))
    if not isinstance(scene, (str, Path, scene_pb2.Scene)):
        raise InvalidArgument(f"scene: {scene!r} is neither a name, nor a .textproto file, nor a Scene")
    if isinstance(scene, scene_pb2.Scene):
        source.scene.CopyFrom(scene)
    elif str(scene).endswith(".textproto"):
        try:
            text_format.Parse(Path(scene).read_text(encoding="utf-8"), source.scene)
        except (OSError, text_format.ParseError) as error:
            raise InvalidArgument(f"{scene}: {error}") from None
    else:
        source.name = str(scene)
    return source


def parameters_of(values: Optional[Mapping[str, Any]]) -> parameters_pb2.Parameters:
    """Returns live parameters. InvalidArgument for an unknown name, with the nearest one."""
    return fill(parameters_pb2.Parameters(), mapping("set", values), "parameter")


def physique_of(values: Optional[Mapping[str, Any]]) -> Optional[geometry_pb2.Physique]:
    """Returns a body's numbers; None for none. InvalidArgument for an unknown name, with the nearest one; the server checks
    the ranges."""
    given = mapping("physique", values)
    return fill(geometry_pb2.Physique(), given, "number of a body") if given else None


def parts_of(read: Sequence[str]) -> tuple[int, ...]:
    """Returns the parts of the state by name. InvalidArgument names the nearest one."""
    return _parts_of(tuple(names_of("read", read)))


@lru_cache
def _parts_of(read: tuple[str, ...]) -> tuple[int, ...]:
    known = enum_names(state_pb2.StatePart.DESCRIPTOR)
    for part in read:
        if part not in known:
            raise InvalidArgument(f"read: there is no part {part}: {nearest(part, known)}")
    return tuple(enum_number(state_pb2.StatePart.DESCRIPTOR, part) for part in read)


class SessionOperations:
    """Knows one session: its id, last status and geometry. Not thread-safe."""

    _level = 6
    """Of the frame of a method's caller, seen from an operation."""

    def __init__(self, session: session_pb2.Session, token: str, owned: bool) -> None:
        self.status = session
        self._token = token
        self._owned = owned
        self._closed = False
        self._process = os.getpid()
        self._unsettled = False  # a call that steps was cut off, and the server may be at a later tick than seen
        self._stream: Any = None  # of steps (advance.py)
        self._geometry: Optional[Geometry] = None
        self._layout: Optional[state_pb2.StateLayout] = None
        self._last: Optional[Frame] = None
        self._decoder: Optional[Decoder] = None

    @property
    def id(self) -> str:
        """The session's id on the server."""
        return self.status.id

    @property
    def scene(self) -> str:
        """Name of the scene."""
        return self.status.scene

    @property
    def tick(self) -> int:
        """Steps since the last reset, as last seen."""
        return self.status.tick

    @property
    def time(self) -> float:
        """Simulated time [s], as last seen."""
        return self.status.time

    @property
    def parameters(self) -> dict[str, Any]:
        """Every live parameter, as last seen; enums by their lower-case names."""
        return Named(row(self.status.parameters), "parameter")

    @property
    def time_step(self) -> float:
        """[s]"""
        return self.status.parameters.time_step

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.id} of {self.scene} at tick {self.tick}>"

    # --- every call ---
    def _check_open(self) -> None:
        """Closed after close()."""
        if self._closed:
            raise Closed(f"the session {self.id} is closed: make another by phrenic.Session")

    def _ready(self, operation: Operation[T]) -> Operation[T]:
        """Performs an operation of an open session, once a step that was cut off has ended."""
        self._check_open()
        if self._unsettled:
            yield from self._settle()
        return (yield from operation)

    def _settle(self) -> Operation[None]:
        """Pauses the session after a call that was cut off, and takes over the tick that it reached. A session that others
        step is not paused."""
        if self._owned:
            yield from self._change("PauseSession", session_pb2.PauseSessionRequest())
        else:
            self.status = yield from attach(self.id)
        self._last, self._unsettled = None, False

    def _leave_stream(self) -> None:
        """Ends a stream of steps whose loop was left while answers were pending."""
        if self._stream is not None and self._stream.pending:
            self._stream.leave()

    # --- reading ---
    def _describe(self, parts: Iterable[int]) -> Operation[None]:
        """Reads what is constant and belongs to these parts, once."""
        if self._geometry is None and state_pb2.STATE_PART_BODIES in parts:
            bodies: list[frames_pb2.GetGeometryResponse] = []
            request = frames_pb2.GetGeometryRequest(session_id=self.id)
            yield Call("FrameService.GetGeometry", request, LONG, bodies.append)
            self._geometry = Geometry(bodies)
        if self._layout is None and any(part != state_pb2.STATE_PART_BODIES for part in parts):
            answer = yield Call("SessionService.GetState", self._state_request([state_pb2.STATE_PART_LAYOUT]))
            self._layout = answer.state.layout

    def _state_request(self, parts: Iterable[int]) -> session_pb2.GetStateRequest:
        return session_pb2.GetStateRequest(session_id=self.id, read=parts)

    def _frame_of(self, arrays: state_pb2.StateArrays, answer: Any, parts: Sequence[int]) -> Frame:
        geometry = self._geometry if state_pb2.STATE_PART_BODIES in parts else None
        layout = self._layout or state_pb2.StateLayout()
        self._last = frame_of(arrays, answer.state_hash, answer.measures, layout, geometry, parts)
        self.status.tick, self.status.time = arrays.tick, arrays.time
        return self._last

    def _read(self, read: Sequence[str]) -> Operation[Frame]:
        parts = parts_of(read)
        yield from self._describe(parts)
        answer = yield Call("SessionService.GetState", self._state_request(parts))
        return self._frame_of(answer.state, answer, parts)

    def _known(self) -> Operation[Frame]:
        """The last frame if nothing has changed since, else a new one without arrays. A session that plays, or that
        others step, has changed."""
        still = self._owned and self.status.state != session_pb2.SESSION_STATE_PLAYING
        if still and self._last is not None and self._last.tick == self.status.tick:
            return self._last
        return (yield from self._read(()))

    def _measure(self, name: str) -> Operation[float]:
        frame = yield from self._known()
        return look_up(frame.measures, name, "measure")

    def _measures(self) -> Operation[dict[str, float]]:
        return dict((yield from self._known()).measures)

    def _hash(self) -> Operation[str]:
        return (yield from self._known()).state_hash

    def _forces(self, body: str, vertex: Optional[int], kind: str) -> Operation[Any]:
        request = frames_pb2.GetForcesRequest(session_id=self.id, body=text_of("body", body), kind=text_of("kind", kind))
        if vertex is not None:
            request.vertex = whole("vertex", vertex, most=INT32)
        answer = yield Call("FrameService.GetForces", request)
        if kind:
            return np.frombuffer(answer.sizes, "<f4")
        if vertex is None:
            return list(answer.kinds)
        return {name: np.array([f.x, f.y, f.z]) for name, f in zip(answer.kinds, answer.forces)}

    # --- stepping ---
    def _step(
        self, ticks: int, read: Sequence[str], timeout: Optional[float], again: bool = True
    ) -> Operation[Frame]:
        """Takes steps. `again`: those that a lost connection left out are taken again."""
        parts, ticks = parts_of(read), whole("ticks", ticks)
        deadline = LONG if timeout is None else positive("timeout", timeout)
        self._leave_stream()
        if self._unsettled:
            yield from self._settle()
        yield from self._describe(parts)
        before = self.status.tick
        request = session_pb2.StepSessionRequest(
            session_id=self.id, ticks=ticks, control_token=self._token, read=parts
        )
        if self._owned:
            request.expected_tick = before
        try:
            answer = yield Call("SessionService.StepSession", request, deadline, repeatable=False)
        except Unavailable:
            if not self._owned or not again:
                self._unsettled = True
                raise
            return (yield from self._step_to(before, before + ticks, read, timeout))
        except BaseException as failed:  # also Ctrl-C: the server may step on
            self._unsettled |= isinstance(failed, (DeadlineExceeded, Cancelled)) or not isinstance(failed, Error)
            raise
        self.status = answer.session
        arrays = answer.state if parts else state_pb2.StateArrays(tick=self.tick, time=self.time, phase=math.nan)
        return self._frame_of(arrays, answer, parts)

    def _step_to(self, before: int, after: int, read: Sequence[str], timeout: Optional[float]) -> Operation[Frame]:
        """After a lost connection: takes the steps that were not carried out. The run is deterministic and no other client
        steps it, so the state at the tick `after` is the answer that was lost."""
        frame = yield from self._read(read)
        if frame.tick == after:
            return frame
        if not before <= frame.tick < after:
            raise Aborted(f"the connection was lost at tick {before}, and the session is at tick {frame.tick} now")
        return (yield from self._step(after - frame.tick, read, timeout, again=False))

    def ticks_until(self, time: float) -> int:
        """Number of steps to the simulated time [s], rounded; at least 1."""
        return max(1, round((finite("time", time) - self.time) / self.time_step))

    def _frame_ticks(self, seconds: float, fps: float) -> list[int]:
        """Steps to each frame from the one before, as play() takes them at an unchanged time step."""
        seconds, fps = positive("seconds", seconds), positive("fps", fps)
        count, step = max(1, round(seconds * fps)), self.time_step
        reached, ticks = 0, []
        for i in range(1, count + 1):
            tick = round(i / (fps * step))
            if tick > reached:
                ticks.append(tick - reached)
                reached = tick
        return ticks or [1]

    def _frame_times(self, seconds: float, fps: float) -> Iterator[float]:
        """Times of frames from now on that a step can reach [s]."""
        seconds, fps = positive("seconds", seconds), positive("fps", fps)
        start = self.time
        for i in range(1, max(1, round(seconds * fps)) + 1):
            if self.time < start + i / fps - 0.5 * self.time_step:
                yield start + i / fps

    # --- changing ---
    def _change(self, name: str, request: Any) -> Operation[Any]:
        """Makes a change that takes effect once, however often it is sent."""
        request.session_id = self.id
        request.control_token = self._token
        request.request_id = str(uuid.uuid4())
        answer = yield Call(f"SessionService.{name}", request, LONG)
        self.status = answer.session
        self._last = None
        return answer

    def _set(self, preset: str, at_tick: Optional[int], values: Mapping[str, Any]) -> Operation[None]:
        request = session_pb2.UpdateParametersRequest(
            parameters=parameters_of(values),
            preset=text_of("preset", preset),
            apply_at_tick=None if at_tick is None else whole("at_tick", at_tick),
        )
        answer = yield from self._change("UpdateParameters", request)
        for text in answer.warnings:
            warnings.warn(text, SimulationWarning, stacklevel=self._level)

    def _pull(self, body: str, vertex: int, force: Sequence[float]) -> Operation[None]:
        request = session_pb2.PullSessionRequest()
        pull = request.pulls.add(body=text_of("body", body), vertex=whole("vertex", vertex, most=INT32))
        pull.force.x, pull.force.y, pull.force.z = vector("force", force)
        yield from self._change("PullSession", request)

    def _release(self) -> Operation[None]:
        yield from self._change("PullSession", session_pb2.PullSessionRequest(release_others=True))

    def _reset(self) -> Operation[None]:
        yield from self._change("ResetSession", session_pb2.ResetSessionRequest())

    def _run_on(self, speed: Optional[float], until: float) -> Operation[None]:
        request = session_pb2.PlaySessionRequest(
            speed=None if speed is None else finite("speed", speed),
            until_time=finite("until", until),
            as_fast_as_possible=speed == 0,
        )
        if speed == 0:
            request.ClearField("speed")
        yield from self._change("PlaySession", request)

    def _pause(self) -> Operation[None]:
        yield from self._change("PauseSession", session_pb2.PauseSessionRequest())

    def _fork(self, fork_id: str) -> Operation[session_pb2.ForkSessionResponse]:
        """Forks. A fork of this client's choice of id is made once, however often the call is repeated."""
        request = session_pb2.ForkSessionRequest(session_id=self.id, fork_id=text_of("id", fork_id) or new_id(self.scene))
        try:
            return (yield Call("SessionService.ForkSession", request, LONG))
        except AlreadyExists:
            if fork_id:
                raise
            return session_pb2.ForkSessionResponse(session=(yield from _made_before(request.fork_id)))

    def _delete(self) -> Operation[None]:
        if self._closed:
            return
        self._closed = True
        if self._process != os.getpid():
            return  # the session is that of the process from which this one was forked
        request = session_pb2.DeleteSessionRequest(session_id=self.id, control_token=self._token)
        try:
            yield Call("SessionService.DeleteSession", request, repeatable=False)
        except (NotFound, Unavailable, Closed):
            pass  # it has ended already, or ends with its server

    # --- watching ---
    def _watch_call(self, max_fps: float, max_error_mm: Optional[float]) -> Call:
        codec = frames_pb2.CODEC_RAW if max_error_mm is None else frames_pb2.CODEC_PREDICTED
        if max_error_mm is not None and self._decoder is None and self._geometry is not None:
            self._decoder = Decoder(self._geometry.bodies.values())
        request = frames_pb2.WatchFramesRequest(
            session_id=self.id, max_fps=finite("max_fps", max_fps), codec=codec, watch_id=str(uuid.uuid4())
        )
        if max_error_mm is not None:
            request.max_error_mm = finite("max_error_mm", max_error_mm)
        return Call("FrameService.WatchFrames", request)

    def _samples_call(self, measures: Sequence[str], interval: float) -> Call:
        request = samples_pb2.WatchSamplesRequest(
            session_id=self.id, measures=names_of("measures", measures), interval=finite("interval", interval)
        )
        return Call("SampleService.WatchSamples", request)

    def _noted(self, event: frames_pb2.WatchFramesResponse) -> Optional[Frame]:
        """Returns the frame of an event of the stream; takes over a status."""
        if event.HasField("session"):
            self.status, self._last = event.session, None
        if not event.HasField("frame") or self._geometry is None:
            return None
        frame = event.frame
        if self._decoder is None or frame.codec in (frames_pb2.CODEC_UNSPECIFIED, frames_pb2.CODEC_RAW):
            return watched_frame(frame, self._geometry, frame.positions)
        return watched_frame(frame, self._geometry, self._decoder.decode(frame.codec, frame.positions))


def create(
    scene: Scene,
    set: Optional[Mapping[str, Any]],
    preset: str,
    id: str,
    resolution_mm: Optional[float],
    physique: Optional[Mapping[str, Any]],
) -> Operation[session_pb2.CreateSessionResponse]:
    """Creates a session. Without `id`, this client chooses one, so that a repeat after a lost connection makes no second
    session; with one, a repeat that finds the session made is AlreadyExists."""
    request = session_pb2.CreateSessionRequest(
        session_id=text_of("id", id) or new_id(Path(str(getattr(scene, "name", scene))).stem),
        source=source_of(scene, resolution_mm, physique),
        parameters=parameters_of(set),
        preset=text_of("preset", preset),
    )
    try:
        return (yield Call("SessionService.CreateSession", request, LONG))
    except AlreadyExists:
        if id:
            raise
        return session_pb2.CreateSessionResponse(session=(yield from _made_before(request.session_id)))
    except BaseException as failed:
        if not id and (isinstance(failed, DeadlineExceeded) or not isinstance(failed, Error)):  # Ctrl-C: it may be made
            yield from _unmade(request.session_id)
        raise


def _made_before(id: str) -> Operation[session_pb2.Session]:
    """Returns the session of a call whose answer was lost, once it exists: it may be compiling. Its control token is
    lost, but the session is not under control, so everybody may change it."""
    request = session_pb2.GetSessionRequest(session_id=id)
    return (yield Call("SessionService.GetSession", request, passing=(NotFound,))).session


def _unmade(id: str) -> Operation[None]:
    """Deletes the session of a call that was cut off, if the call has made it."""
    try:
        yield Call("SessionService.DeleteSession", session_pb2.DeleteSessionRequest(session_id=id), repeatable=False)
    except Error:
        pass


def describe(
    scene: Scene, resolution_mm: Optional[float], physique: Optional[Mapping[str, Any]]
) -> Operation[session_pb2.DescribeSceneResponse]:
    """Compiles a scene."""
    request = session_pb2.DescribeSceneRequest(source=source_of(scene, resolution_mm, physique))
    return (yield Call("SceneService.DescribeScene", request, LONG))


def scenes() -> Operation[Table]:
    """Returns the catalogue."""
    return Table.of((yield Call("SceneService.ListScenes", session_pb2.ListScenesRequest())).scenes)


def session_ids() -> Operation[list[str]]:
    """Returns the ids of the sessions that the caller may see."""
    ids: list[str] = []
    request = session_pb2.ListSessionsRequest()
    while True:
        page = yield Call("SessionService.ListSessions", request)
        ids += [session.id for session in page.sessions]
        if not page.next_page_token:
            return ids
        request.page_token = page.next_page_token


def attach(id: str) -> Operation[session_pb2.Session]:
    """Returns the status of an existing session."""
    answer = yield Call("SessionService.GetSession", session_pb2.GetSessionRequest(session_id=text_of("id", id)))
    return answer.session


def check_server(server: Any, asynchronous: bool = False) -> None:
    """InvalidArgument if `server` is not a server of this client: blocking, or asyncio."""
    if asynchronous == getattr(getattr(server, "connection", None), "asynchronous", None):
        return
    maker = "phrenic.aio.connect" if asynchronous else "phrenic.connect"
    raise InvalidArgument(f"server: {server!r} is not a server of this client: give that of {maker}(address)")
