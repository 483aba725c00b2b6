"""What a session looks like between two steps: bodies, measures, and every bit of its state.

Positions come as float32 arrays over the bytes that protobuf hands out; nothing is decoded or copied after that. The
encoding is the raw one (CODEC_RAW, STATE_PART_BODIES), which is exact, unless watch() is given an error bound (codec.py).
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Iterable, Mapping, Optional, Sequence, Union

import numpy as np

from .names import look_up
from .v1 import frames_pb2, measures_pb2, state_pb2


def vectors(data: Union[bytes, np.ndarray], kind: str = "<f4", width: int = 3) -> np.ndarray:
    """Returns the bytes as rows of `width` numbers, read-only and without a copy.

    >>> vectors(np.arange(6, dtype="<f4").tobytes()).shape
    (2, 3)
    """
    return np.frombuffer(data, dtype=kind).reshape(-1, width)


class Geometry:
    """The constant data of a session's bodies, by name."""

    def __init__(self, bodies: Iterable[frames_pb2.GetGeometryResponse]) -> None:
        self.bodies: dict[str, frames_pb2.GetGeometryResponse] = {body.name: body for body in bodies}
        self.rest = {name: vectors(body.rest_positions) for name, body in self.bodies.items()}
        """Positions at rest, (n, 3) float32 [m]."""
        self.triangles = {name: vectors(body.triangles, "<u4") for name, body in self.bodies.items()}
        """Three vertex indices a triangle, (m, 3) uint32, anticlockwise seen from outside."""


@dataclass(frozen=True)
class Body:
    """A body in a frame."""

    name: str
    positions: np.ndarray
    """(n, 3) float32 [m], in the frame LPS: +x left, +y posterior, +z superior. Read-only: copy() to change it."""
    triangles: np.ndarray
    """(m, 3) uint32."""
    rest: np.ndarray
    """(n, 3) float32 [m], the positions at rest."""


@dataclass(frozen=True)
class State:
    """The simulated state, float64, bit for bit what `state_hash` is computed from. Parts that were not read are
    None; a part that was read and has no numbers is an empty array."""

    tick: int
    time: float
    phase: float
    """Breaths since the start. NaN where the server does not send it: after step(read=()) and in a frame of watch()."""
    positions: Optional[np.ndarray] = None
    """(n, 3) [m] of all simulated vertices."""
    velocities: Optional[np.ndarray] = None
    """(n, 3) [m/s]."""
    scalars: Optional[np.ndarray] = None
    """Generalised coordinates that are not vertices, each in its own unit."""
    scalar_rates: Optional[np.ndarray] = None
    layout: state_pb2.StateLayout = field(default_factory=state_pb2.StateLayout, repr=False)

    def positions_of(self, body: str) -> np.ndarray:
        """Positions of one simulated body, (n, 3) [m]."""
        return self._part(self.positions, body)

    def velocities_of(self, body: str) -> np.ndarray:
        """Velocities of one simulated body, (n, 3) [m/s]."""
        return self._part(self.velocities, body)

    def _part(self, array: Optional[np.ndarray], body: str) -> np.ndarray:
        if array is None:
            raise ValueError('this part of the state was not read: add "positions" or "velocities" to read=')
        row = look_up({each.name: each for each in self.layout.bodies}, body, "simulated body")
        return array[row.first_vertex : row.first_vertex + row.vertices]

    @property
    def named_scalars(self) -> dict[str, float]:
        """The generalised coordinates by name."""
        numbers: Sequence[float] = [] if self.scalars is None else self.scalars.tolist()
        return {row.name: value for row, value in zip(self.layout.scalars, numbers)}


@dataclass(frozen=True)
class Frame:
    """A session between two steps; `frame["diaphragm"]` is a Body."""

    tick: int
    time: float
    """Simulated time [s]."""
    phase: float
    """Elapsed fraction of the present breath, 0 to 1. NaN after step(read=()): the server sends it with a part of the
    state."""
    measures: Mapping[str, float]
    """The scene's measures by name, in SI units."""
    state_hash: str
    """16 hexadecimal digits; equal states have equal hashes. Empty in a frame of watch()."""
    state: State
    _positions: Union[bytes, np.ndarray] = field(repr=False)
    _poses: bytes = field(repr=False)
    _geometry: Optional[Geometry] = field(repr=False)
    _readings: Sequence[measures_pb2.MeasureReading] = field(repr=False, default=())

    @property
    def units(self) -> dict[str, str]:
        """The units of the measures: {"lung volume": "m^3"}."""
        return {reading.name: reading.unit for reading in self._readings}

    @property
    def bodies(self) -> list[str]:
        """Names of the bodies."""
        return list(self._geometry.bodies) if self._geometry else []

    def __getitem__(self, name: str) -> Body:
        """Returns a body. NotFound lists the bodies for an unknown one."""
        if self._geometry is None:
            raise ValueError('this frame has no bodies: add "bodies" to read=')
        body = look_up(self._geometry.bodies, name, "body")
        rest = self._geometry.rest[name]
        return Body(name, self._placed(body, rest), self._geometry.triangles[name], rest)

    def _placed(self, body: frames_pb2.GetGeometryResponse, rest: np.ndarray) -> np.ndarray:
        if body.placement == frames_pb2.PLACEMENT_STREAMED:
            return vectors(self._positions)[body.first_vertex : body.first_vertex + len(rest)]
        if body.placement == frames_pb2.PLACEMENT_RIGID:
            return moved(vectors(self._poses, width=7)[body.pose], rest)
        return rest


def moved(pose: np.ndarray, rest: np.ndarray) -> np.ndarray:
    """Returns x = R(q) x_rest + t of a pose qx qy qz qw tx ty tz.

    >>> moved(np.array([0, 0, 1, 0, 5, 0, 0], "f4"), np.array([[1, 0, 0]], "f4"))
    array([[4., 0., 0.]], dtype=float32)
    """
    axis, w, translation = pose[:3], pose[3], pose[4:]
    turned = rest + 2 * np.cross(axis, np.cross(axis, rest) + w * rest)
    return (turned + translation).astype(np.float32)


def readings(messages: Iterable[measures_pb2.MeasureReading]) -> dict[str, float]:
    """Returns measures by name."""
    return {reading.name: reading.value for reading in messages}


def frame_of(
    arrays: state_pb2.StateArrays,
    state_hash: str,
    measures: Sequence[measures_pb2.MeasureReading],
    layout: state_pb2.StateLayout,
    geometry: Optional[Geometry],
    parts: Sequence[int],
) -> Frame:
    """Returns the frame of a lossless answer to a request for `parts`; `geometry` is None if bodies were not read."""

    def rows(part: int, data: bytes) -> Optional[np.ndarray]:
        return vectors(data, "<f8") if part in parts else None

    def numbers(data: bytes) -> Optional[np.ndarray]:
        return np.frombuffer(data, "<f8") if state_pb2.STATE_PART_SCALARS in parts else None

    state = State(
        arrays.tick,
        arrays.time,
        arrays.phase,
        rows(state_pb2.STATE_PART_POSITIONS, arrays.positions),
        rows(state_pb2.STATE_PART_VELOCITIES, arrays.velocities),
        numbers(arrays.scalars),
        numbers(arrays.scalar_rates),
        layout,
    )
    return Frame(
        arrays.tick,
        arrays.time,
        arrays.phase % 1,
        readings(measures),
        state_hash,
        state,
        arrays.body_positions,
        arrays.poses,
        geometry,
        measures,
    )


def watched_frame(frame: frames_pb2.Frame, geometry: Geometry, positions: Union[bytes, np.ndarray]) -> Frame:
    """Returns the frame of a stream, which has the fraction of a breath alone, with its decoded positions."""
    state = State(frame.tick, frame.time, math.nan)
    return Frame(
        frame.tick,
        frame.time,
        frame.phase,
        readings(frame.measures),
        "",
        state,
        positions,
        frame.poses,
        geometry,
        frame.measures,
    )
