"""Many runs of one scene at different parameters, on the server's threads.

>>> runs = batch("cube-springs", [{"breath_force": force} for force in (1, 2)], seconds=0.1, fps=20, threads=2)
>>> [(run.index, run.parameters, len(run.times), run.diverged) for run in sorted(runs, key=lambda run: run.index)]
[(0, {'breath_force': 1}, 2, ''), (1, {'breath_force': 2}, 2, '')]
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import count, islice, repeat
from typing import Any, Iterable, Iterator, Mapping, Optional, Sequence

import numpy as np

from .call import Call
from .errors import InvalidArgument
from .frame import Frame, State, vectors
from .operations import Scene, parameters_of, parts_of, source_of
from .server import Server, default_server
from .v1 import batch_pb2, state_pb2

BLOCK = 256
"""Runs of one request."""


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
    start: Optional[Frame] = None,
    starts: Optional[Iterable[State]] = None,
    read: Sequence[str] = (),
    threads: Optional[int] = None,
    server: Optional[Server] = None,
) -> Iterator[Run]:
    """Runs the scene once for each set of live parameters and yields each run as it ends. `threads` runs are in progress
    at a time (default: one a core of the server). `parameters` may be endless: 256 of them are taken at a time. The runs
    are the same, bit for bit, at any number of threads. `start`: a frame of a session of this scene, with "positions",
    "velocities" and "scalars", from which every run goes on; `starts`: a state a run; default: the scene's start. `read`: parts of the last state,
    "positions", "velocities" and "scalars". A loop that breaks ends the runs in progress."""
    host = server or default_server()
    request = batch_pb2.RunBatchRequest(
        source=source_of(scene, resolution_mm), preset=preset, seconds=seconds, frames_per_second=fps,
        threads=threads or 0, read=_parts(read),
    )  # fmt: skip
    states = repeat(start.state if start is not None else None) if starts is None else starts
    values = zip(parameters, states)
    for begin in count(0, BLOCK):
        block = list(islice(values, BLOCK))
        if not block:
            return
        del request.runs[:]
        for each, state in block:
            request.runs.add(parameters=parameters_of(each), start=None if state is None else _arrays_of(state))
        yield from _run(host, request, begin, [each for each, _ in block])


def _parts(read: Sequence[str]) -> tuple[int, ...]:
    if "bodies" in read:
        raise InvalidArgument('read: "bodies" come with frames of a session; name "positions"')
    return parts_of(tuple(read))


def _arrays_of(state: State) -> state_pb2.StateArrays:
    """Returns the state as the server takes it."""
    if state.positions is None or state.velocities is None or state.scalars is None or state.scalar_rates is None:
        raise InvalidArgument('start: the state lacks a part: read ("positions", "velocities", "scalars")')
    return state_pb2.StateArrays(
        tick=state.tick, time=state.time, phase=state.phase, positions=state.positions.tobytes(),
        velocities=state.velocities.tobytes(), scalars=state.scalars.tobytes(),
        scalar_rates=state.scalar_rates.tobytes(),
    )  # fmt: skip


def _run(
    host: Server, request: batch_pb2.RunBatchRequest, begin: int, block: Sequence[Mapping[str, Any]]
) -> Iterator[Run]:
    header = batch_pb2.BatchHeader()
    for message in host.connection.stream(Call("StudyService.RunBatch", request)):
        if message.HasField("header"):
            header = message.header
        else:
            yield _run_of(message.result, header, begin, block, request.read)


def _run_of(
    result: batch_pb2.BatchResult,
    header: batch_pb2.BatchHeader,
    begin: int,
    block: Sequence[Mapping[str, Any]],
    parts: Sequence[int],
) -> Run:
    times = np.array(result.times)
    table = np.array(result.measures).reshape(len(times), -1) if header.measures else np.empty((len(times), 0))
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
