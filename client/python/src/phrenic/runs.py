"""Many runs of one scene at different parameters, on the server's threads.

>>> runs = batch("cube-springs", [{"breath_force": force} for force in (1, 2)], seconds=0.1, fps=20, threads=2)
>>> [(run.index, run.parameters, len(run.times), run.diverged) for run in sorted(runs, key=lambda run: run.index)]
[(0, {'breath_force': 1}, 2, ''), (1, {'breath_force': 2}, 2, '')]
"""

from __future__ import annotations

import re
import time
from dataclasses import dataclass
from itertools import repeat
from typing import Any, Container, Iterable, Iterator, Mapping, Optional, Sequence, Union

import numpy as np

from .arguments import INT32, names_of, positive, text_of, whole
from .call import Call, delay_before_repeat
from .errors import Error, InvalidArgument, ResourceExhausted, Unavailable
from .frame import Frame, State, vectors
from .operations import Scene, check_server, parameters_of, parts_of, source_of
from .server import Server, default_server
from .v1 import batch_pb2, state_pb2

BLOCK = 256
"""The most runs of one request."""
BLOCK_BYTES = 8_000_000
"""About the size of one request [byte]: half of what a server accepts."""
NOTICED = 20.0
"""Time within which a server notices a lost connection, ends its batch and has room for the rest [s]."""


@dataclass(frozen=True)
class Summary:
    """What was seen in a run `fps` times a simulated second, at least 40 times, and at its end; measures in SI units."""

    steps: int
    simulated_seconds: float
    last: dict[str, float]
    least: dict[str, float]
    greatest: dict[str, float]
    constraint_residual: Optional[float]
    """Largest violation of a rigid link or length limit [m]; None if the scene has none."""


@dataclass(frozen=True)
class Run:
    """One run of a batch."""

    index: int
    """Its place among the parameters."""
    parameters: Mapping[str, Any]
    times: np.ndarray
    """Simulated times of the samples [s]; none of a run with a summary."""
    measures: dict[str, np.ndarray]
    """Each measure at these times, in its SI unit."""
    state_hash: str
    """Of the state at the last sample: that of a session with the same parameters."""
    diverged: str
    """When, where and why the run diverged, or was cut short; empty if it was not. The arrays end before."""
    state: Optional[State] = None
    """At the last sample, the parts that `read` names."""
    cpu_seconds: float = 0
    """CPU time of the run."""
    summary: Optional[Summary] = None
    """Instead of samples, if it was asked for."""


def batch(
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
) -> Iterator[Run]:
    """Runs the scene once for each set of live parameters and yields each run as it ends. `parameters` may be endless:
    at most 256 of them are taken at a time.

    threads: number of runs in progress at a time (default: one a core of the server). The runs are the same, bit for bit,
        at any number of threads.
    start: a frame of a session of this scene, with "positions", "velocities" and "scalars", from which every run goes on;
        default: the scene's start. An integrator that remembers the step before, velocity_verlet or bdf2, begins there
        as after a reset.
    starts: the same, a state for each run.
    read: parts of the last state: "positions", "velocities" and "scalars".
    physique: the generated body, as of a Session.
    summary: instead of samples, the range of each measure; a run then ends at the first step that reaches `seconds`.
    finished: indices of runs that are left out: those that an earlier call with the same arguments has yielded.

    A loop that breaks ends the runs in progress. After a lost connection the batch requests the missing runs again;
    Unavailable after `retries` attempts (a minute) without a run."""
    server = server or default_server()
    check_server(server)
    connection = server.connection
    request = request_of(scene, seconds, fps, preset, resolution_mm, physique, read, summary, threads)
    for part in parts(request, parameters, start, starts, finished, connection.target.retries):
        while not part.ended:
            try:
                for message in connection.stream(part.call):
                    yield from part.runs_of(message)
                part.ended = True
            except Error as error:
                time.sleep(part.delay_after(error))


def request_of(
    scene: Scene,
    seconds: float,
    fps: float,
    preset: str,
    resolution_mm: Optional[float],
    physique: Optional[Mapping[str, Any]],
    read: Sequence[str],
    summary: bool,
    threads: Optional[int],
) -> batch_pb2.RunBatchRequest:
    """Returns the request without its runs."""
    return batch_pb2.RunBatchRequest(
        source=source_of(scene, resolution_mm, physique), preset=text_of("preset", preset),
        seconds=positive("seconds", seconds), frames_per_second=positive("fps", fps),
        threads=whole("threads", threads or 0, most=INT32), read=_parts(read), summary=bool(summary),
    )  # fmt: skip


class Part:
    """One request of a batch: makes runs of its answers, and asks again for those that a lost connection cost."""

    def __init__(
        self, request: batch_pb2.RunBatchRequest, begin: int, block: Sequence[Mapping[str, Any]], retries: int
    ) -> None:
        self.call = Call("StudyService.RunBatch", request)
        self.ended = len(request.finished) == len(block)
        """True once every run was received."""
        self._request, self._begin, self._block, self._retries = request, begin, block, retries
        self._header = batch_pb2.BatchHeader()
        self._attempt, self._lost = 0, -NOTICED

    def runs_of(self, message: batch_pb2.RunBatchResponse) -> Iterator[Run]:
        """Yields the run that the message has, if it has one."""
        if message.HasField("header"):
            self._header = message.header
            return
        self._request.finished.append(message.result.run)
        self._attempt = 0
        yield _run_of(message.result, self._header, self._begin, self._block, self._request.read)

    def delay_after(self, error: Error) -> float:
        """Returns how long to wait before the missing runs are asked for [s]. Raises the error if it is final."""
        delay = delay_before_repeat(self.call, error, self._attempt, self._retries)
        if isinstance(error, Unavailable):
            self._lost = time.monotonic()
            self._attempt += 1
        elif isinstance(error, ResourceExhausted) and time.monotonic() - self._lost < NOTICED:
            delay = 0.5  # the lost stream may hold its place still
        if delay is not None:
            return delay
        # The message names a run by its place in this request.
        error.message = re.sub(r"^runs\[(\d+)\]", lambda m: f"runs[{self._begin + int(m[1])}]", error.message)
        error.args = (error.message, *error.args[1:])
        raise error


def parts(
    request: batch_pb2.RunBatchRequest,
    parameters: Iterable[Mapping[str, Any]],
    start: Union[Frame, State, None],
    starts: Optional[Iterable[Union[Frame, State]]],
    finished: Container[int],
    retries: int,
) -> Iterator[Part]:
    """Yields the parts of a batch, one after the other; each takes its parameters when it is asked for. They share
    `request`."""
    if isinstance(parameters, Mapping):
        raise InvalidArgument("parameters: give a list of sets, one a run: [{...}, {...}]")
    values, begin = _with_starts(parameters, start, starts), 0
    while True:
        block, size = [], 0
        del request.runs[:], request.finished[:]
        if not isinstance(finished, Container):
            raise InvalidArgument(f"finished: {finished!r} has no indices of runs: give a set")
        for each, state in values:
            index = begin + len(block)
            try:
                if not isinstance(each, Mapping):
                    raise InvalidArgument(f"{each!r} is not a dict of parameters; of a DataFrame: df.to_dict('records')")
                request.runs.add(parameters=parameters_of(each), start=None if state is None else _arrays_of(state))
            except InvalidArgument as error:
                raise InvalidArgument(f"runs[{index}]: {error.message}") from None
            if index in finished:
                request.finished.append(len(block))
            block.append(each)
            size += request.runs[-1].ByteSize()
            if len(block) == BLOCK or size > BLOCK_BYTES:
                break
        if not block:
            return
        yield Part(request, begin, block, retries)
        begin += len(block)


def _with_starts(
    parameters: Iterable[Mapping[str, Any]],
    start: Union[Frame, State, None],
    starts: Optional[Iterable[Union[Frame, State]]],
) -> Iterator[tuple[Mapping[str, Any], Optional[State]]]:
    """Yields each run's parameters with its start. InvalidArgument if there are fewer starts than runs."""
    if start is not None and starts is not None:
        raise InvalidArgument("start: give it or starts, not both")
    states: Iterator[Any] = repeat(start)
    try:
        runs = iter(parameters)
        if starts is not None:
            states = iter(starts)
    except TypeError as error:
        raise InvalidArgument(f"parameters, starts: give lists with an item a run: {error}") from None
    for index, each in enumerate(runs):
        try:
            state = next(states)
            yield each, state.state if isinstance(state, Frame) else state
        except StopIteration:
            raise InvalidArgument(f"starts: runs[{index}] has none: give a state for each run") from None


def _parts(read: Sequence[str]) -> tuple[int, ...]:
    if "bodies" in names_of("read", read):
        raise InvalidArgument('read: "bodies" come with frames of a session; name "positions"')
    return parts_of(tuple(read))


def _arrays_of(state: State) -> state_pb2.StateArrays:
    """Returns the state as the server takes it."""
    if not isinstance(state, State):
        raise InvalidArgument(f"start: {type(state).__name__} is neither a Frame nor a State")
    if state.positions is None or state.velocities is None or state.scalars is None or state.scalar_rates is None:
        raise InvalidArgument('start: the state lacks a part: read ("positions", "velocities", "scalars")')
    numbers = (np.asarray(each, "<f8").tobytes() for each in
               (state.positions, state.velocities, state.scalars, state.scalar_rates))  # fmt: skip
    positions, velocities, scalars, rates = numbers
    return state_pb2.StateArrays(
        tick=state.tick, time=state.time, phase=state.phase, positions=positions, velocities=velocities,
        scalars=scalars, scalar_rates=rates,
    )  # fmt: skip


def _run_of(
    result: batch_pb2.BatchResult,
    header: batch_pb2.BatchHeader,
    begin: int,
    block: Sequence[Mapping[str, Any]],
    parts: Sequence[int],
) -> Run:
    times = np.array(result.times)
    table = np.array(result.measures).reshape(len(times), len(header.measures))
    measures = {name: table[:, column] for column, name in enumerate(header.measures)}
    state = _state_of(result.state, header.layout, parts) if parts else None
    return Run(begin + result.run, block[result.run], times, measures, result.state_hash, result.problem, state,
               result.cpu_seconds, _summary_of(result, header))  # fmt: skip


def _summary_of(result: batch_pb2.BatchResult, header: batch_pb2.BatchHeader) -> Optional[Summary]:
    if not result.HasField("summary"):
        return None
    seen = result.summary

    def named(values: Iterable[float]) -> dict[str, float]:
        return dict(zip(header.measures, values))

    residual = seen.constraint_residual if seen.HasField("constraint_residual") else None
    return Summary(seen.steps, seen.simulated_seconds, named(seen.last), named(seen.least), named(seen.greatest), residual)


def _state_of(arrays: state_pb2.StateArrays, layout: state_pb2.StateLayout, parts: Sequence[int]) -> State:
    def numbers(part: int, data: bytes, width: int = 3) -> Optional[np.ndarray]:
        return vectors(data, "<f8", width) if part in parts else None

    scalars = numbers(state_pb2.STATE_PART_SCALARS, arrays.scalars, 1)
    rates = numbers(state_pb2.STATE_PART_SCALARS, arrays.scalar_rates, 1)
    return State(
        arrays.tick, arrays.time, arrays.phase,
        numbers(state_pb2.STATE_PART_POSITIONS, arrays.positions),
        numbers(state_pb2.STATE_PART_VELOCITIES, arrays.velocities),
        None if scalars is None else scalars[:, 0], None if rates is None else rates[:, 0], layout,
    )  # fmt: skip
