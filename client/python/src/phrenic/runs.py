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

from .call import Call, delay_before_repeat
from .errors import Error, InvalidArgument, ResourceExhausted, Unavailable
from .frame import Frame, State, vectors
from .operations import Scene, parameters_of, parts_of, source_of
from .server import Server, default_server
from .v1 import batch_pb2, state_pb2

BLOCK = 256
"""The most runs of one request."""
BLOCK_BYTES = 8_000_000
"""About the size of one request [byte]: half of what a server accepts."""
NOTICED = 20.0
"""Time within which a server notices a lost connection, ends its batch and has room for the rest [s]."""


@dataclass(frozen=True)
class Run:
    """One run of a batch."""

    index: int
    """Its place among the parameters."""
    parameters: Mapping[str, Any]
    times: np.ndarray
    """Simulated times of the samples [s]."""
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


def batch(
    scene: Scene,
    parameters: Iterable[Mapping[str, Any]],
    *,
    seconds: float,
    fps: float = 20,
    preset: str = "",
    resolution_mm: Optional[float] = None,
    start: Union[Frame, State, None] = None,
    starts: Optional[Iterable[State]] = None,
    read: Sequence[str] = (),
    threads: Optional[int] = None,
    finished: Container[int] = (),
    server: Optional[Server] = None,
) -> Iterator[Run]:
    """Runs the scene once for each set of live parameters and yields each run as it ends. `threads` runs are in progress
    at a time (default: one a core of the server). `parameters` may be endless: at most 256 of them are taken
    at a time. The runs
    are the same, bit for bit, at any number of threads. `start`: a frame of a session of this scene, with "positions",
    "velocities" and "scalars", from which every run goes on; `starts`: a state a run; default: the scene's start. (An
    integrator that remembers the step before, velocity_verlet or bdf2, begins there as after a reset.) `read`: parts of the last state,
    "positions", "velocities" and "scalars". A loop that breaks ends the runs in progress; `finished`, the indices of the
    runs that it had, lets another call with the same arguments run the rest. After a lost connection the batch goes on by
    itself with the runs that are missing; Unavailable once `retries` attempts have given none."""
    host = server or default_server()
    request = batch_pb2.RunBatchRequest(
        source=source_of(scene, resolution_mm), preset=preset, seconds=seconds, frames_per_second=fps,
        threads=threads or 0, read=_parts(read),
    )  # fmt: skip
    if isinstance(parameters, Mapping):
        raise InvalidArgument("parameters: give a list of sets, one a run: [{...}, {...}]")
    values, begin = _with_starts(parameters, start, starts), 0
    while True:
        block, size = [], 0
        del request.runs[:], request.finished[:]
        for each, state in values:
            index = begin + len(block)
            try:
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
        if len(request.finished) < len(block):
            yield from _run(host, request, begin, block)
        begin += len(block)


def _with_starts(
    parameters: Iterable[Mapping[str, Any]], start: Union[Frame, State, None], starts: Optional[Iterable[State]]
) -> Iterator[tuple[Mapping[str, Any], Optional[State]]]:
    """Yields each run's parameters with its start. InvalidArgument if there are fewer starts than runs."""
    if start is not None and starts is not None:
        raise InvalidArgument("start: give it or starts, not both")
    states = iter(starts) if starts is not None else repeat(start.state if isinstance(start, Frame) else start)
    for index, each in enumerate(parameters):
        try:
            yield each, next(states)
        except StopIteration:
            raise InvalidArgument(f"starts: runs[{index}] has none: give a state for each run") from None


def _parts(read: Sequence[str]) -> tuple[int, ...]:
    if isinstance(read, str):
        raise InvalidArgument(f'read: give names in a tuple: ("{read}",)')
    if "bodies" in read:
        raise InvalidArgument('read: "bodies" come with frames of a session; name "positions"')
    return parts_of(tuple(read))


def _arrays_of(state: State) -> state_pb2.StateArrays:
    """Returns the state as the server takes it."""
    if state.positions is None or state.velocities is None or state.scalars is None or state.scalar_rates is None:
        raise InvalidArgument('start: the state lacks a part: read ("positions", "velocities", "scalars")')
    numbers = (np.asarray(each, "<f8").tobytes() for each in
               (state.positions, state.velocities, state.scalars, state.scalar_rates))  # fmt: skip
    positions, velocities, scalars, rates = numbers
    return state_pb2.StateArrays(
        tick=state.tick, time=state.time, phase=state.phase, positions=positions, velocities=velocities,
        scalars=scalars, scalar_rates=rates,
    )  # fmt: skip


def _run(
    host: Server, request: batch_pb2.RunBatchRequest, begin: int, block: Sequence[Mapping[str, Any]]
) -> Iterator[Run]:
    """Yields the runs of one request that are not finished. After a lost connection it asks for those that are missing."""
    call, attempt, lost = Call("StudyService.RunBatch", request), 0, -NOTICED
    while True:
        header = batch_pb2.BatchHeader()
        try:
            for message in host.connection.stream(call):
                if message.HasField("header"):
                    header = message.header
                    continue
                request.finished.append(message.result.run)
                attempt = 0
                yield _run_of(message.result, header, begin, block, request.read)
            return
        except Error as error:
            delay = delay_before_repeat(call, error, attempt, host.connection.target.retries)
            if isinstance(error, Unavailable):
                lost = time.monotonic()
                attempt += 1
            elif isinstance(error, ResourceExhausted) and time.monotonic() - lost < NOTICED:
                delay = 0.5  # the lost stream may hold its place still
            if delay is None:  # the message names a run by its place in this request
                error.message = re.sub(r"^runs\[(\d+)\]", lambda m: f"runs[{begin + int(m[1])}]", error.message)
                error.args = (error.message, *error.args[1:])
                raise
        time.sleep(delay)


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
               result.cpu_seconds)  # fmt: skip


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
