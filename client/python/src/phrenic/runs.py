"""Many runs of one scene at different parameters, side by side.

>>> runs = batch("cube-springs", [{"breath_force": force} for force in (1, 2)], seconds=0.1, fps=20, threads=2)
>>> [(run.index, run.parameters, len(run.times), run.diverged) for run in sorted(runs, key=lambda run: run.index)]
[(0, {'breath_force': 1}, 2, ''), (1, {'breath_force': 2}, 2, '')]
"""

from __future__ import annotations

import os
from collections import deque
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from dataclasses import dataclass
from typing import Any, Iterable, Iterator, Mapping, Optional

import numpy as np

from .errors import OutOfRange
from .operations import Scene
from .server import Server, default_server
from .session import Session


@dataclass(frozen=True)
class Run:
    """One run of a batch."""

    index: int
    """Its place among the parameters."""
    parameters: Mapping[str, Any]
    times: np.ndarray
    """Simulated times of the frames [s]."""
    measures: dict[str, np.ndarray]
    """Each measure at these times, in its SI unit."""
    state_hash: str
    """Of the last frame."""
    diverged: str
    """When, where and why the run diverged; empty if it did not. The arrays end before."""


def batch(
    scene: Scene,
    parameters: Iterable[Mapping[str, Any]],
    *,
    seconds: float,
    fps: float = 20,
    preset: str = "",
    threads: Optional[int] = None,
    server: Optional[Server] = None,
) -> Iterator[Run]:
    """Runs the scene once for each set of live parameters and yields each run as it ends. `threads` runs are in progress
    at a time (default: one a core); no more than these are in memory, and `parameters` may be endless. The runs are the
    same, bit for bit, at any number of threads. A loop that breaks takes the runs in progress to their end and begins no
    more. Errors other than a divergence end the batch."""
    host = server or default_server()
    waiting = enumerate(parameters)
    running: deque[Future[Run]] = deque()
    count = threads or os.cpu_count() or 1
    with ThreadPoolExecutor(count, "phrenic-batch") as pool:
        while True:
            for index, values in waiting:
                running.append(pool.submit(_run, index, values, scene, seconds, fps, preset, host))
                if len(running) >= count:
                    break
            if not running:
                return
            wait(running, return_when=FIRST_COMPLETED)
            done = next(each for each in running if each.done())
            running.remove(done)
            yield done.result()


def _run(
    index: int, values: Mapping[str, Any], scene: Scene, seconds: float, fps: float, preset: str, server: Server
) -> Run:
    times: list[float] = []
    measures: dict[str, list[float]] = {}
    state_hash = diverged = ""
    with Session(scene, set=values, preset=preset, server=server) as session:
        try:
            for frame in session.play(seconds, fps, read=()):
                times.append(frame.time)
                for name, value in frame.measures.items():
                    measures.setdefault(name, []).append(value)
                state_hash = frame.state_hash
        except OutOfRange as error:
            diverged = error.message
    return Run(index, values, np.array(times), {k: np.array(v) for k, v in measures.items()}, state_hash, diverged)
