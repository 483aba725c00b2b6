"""Lung tissue of a session: how any point inside the lungs has moved and stretched since rest.

    with phrenic.Session("thorax", preset="quiet") as s:
        s.step(1000)
        now = s.tissue(points=[(-0.06, 0, 0.24)])
        now.points["ventilation"], now["lung-right"].displacement, now["lung-right"].regions
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Sequence, Union
from weakref import WeakKeyDictionary

import numpy as np

from .arguments import rows_of
from .call import LONG, Call, Operation
from .errors import InvalidArgument
from .operations import SessionOperations
from .table import Table
from .v1 import tissue_pb2

Points = Union[np.ndarray, Sequence[Sequence[float]], None]

CORNERS = np.array([(c & 1, c >> 1 & 1, c >> 2 & 1) for c in range(8)])
"""Of a brick, in cells."""


@dataclass(frozen=True)
class Lattice:
    """One lung at rest: a lattice of cubic cells, some of which are bricks of tissue, whose corners are the nodes."""

    name: str
    """Of the body."""
    origin: np.ndarray
    """Corner of the first cell [m], (3,)."""
    edge: float
    """Of a cell [m]."""
    inside: np.ndarray
    """Part of each cell's volume inside the lung, 0 to 1, (nx, ny, nz)."""
    nodes: np.ndarray
    """Places of the nodes at rest [m], (n, 3)."""
    bricks: np.ndarray
    """Nodes at the eight corners of each brick, x fastest, (b, 8)."""
    cells: np.ndarray
    """The cell of each brick, (b, 3)."""
    shapes: np.ndarray
    """Displacement of each node per amplitude, (shapes, n, 3) [1]."""

    @property
    def centres(self) -> np.ndarray:
        """Middles of the bricks at rest [m], (b, 3)."""
        return self.origin + self.edge * (self.cells + 0.5)

    @property
    def volumes(self) -> np.ndarray:
        """Volume of each brick inside the lung at rest [m^3], (b,)."""
        return self.edge**3 * self.inside[tuple(self.cells.T)]


@dataclass(frozen=True)
class LungNow:
    """One lung at one moment, relative to rest."""

    lattice: Lattice
    amplitudes: np.ndarray
    """Of the shapes [m]."""
    volume: float
    """That the tissue gained [m^3]."""
    regions: Table
    """A row a region (base, middle, apex, back, front): mean descent [m], ventilation (volume gained per volume) [1]."""

    @property
    def displacement(self) -> np.ndarray:
        """Of each node [m], (n, 3)."""
        return np.tensordot(self.amplitudes, self.lattice.shapes, 1)

    @property
    def gradient(self) -> np.ndarray:
        """du_i/dx_j in the middle of each brick [1], (b, 3, 3)."""
        slopes = (2 * CORNERS - 1) / (4 * self.lattice.edge)
        return np.einsum("bci,cj->bij", self.displacement[self.lattice.bricks], slopes)

    @property
    def ventilation(self) -> np.ndarray:
        """Volume gained per volume at rest, in the middle of each brick [1], (b,)."""
        return np.trace(self.gradient, axis1=1, axis2=2)

    @property
    def strain(self) -> np.ndarray:
        """Largest principal value of the small strain, in the middle of each brick [1], (b,)."""
        gradient = self.gradient
        return np.linalg.eigvalsh((gradient + gradient.transpose(0, 2, 1)) / 2)[:, 2]


@dataclass(frozen=True)
class Tissue:
    """The tissue of all lungs at one moment: tissue["lung-right"]."""

    tick: int
    time: float
    """[s]"""
    lungs: dict[str, LungNow]
    points: Table
    """A row a point of the call: lung (empty outside), dx, dy, dz [m], ventilation, strain [1]."""

    def __getitem__(self, name: str) -> LungNow:
        if name not in self.lungs:
            raise InvalidArgument(f"the scene has no lung {name!r}: {', '.join(self.lungs)}")
        return self.lungs[name]


def read_lattices(session_id: str) -> Operation[list[Lattice]]:
    """The lungs at rest. FailedPrecondition for a scene without lung tissue. The first call for a scene takes seconds."""
    parts: list[tissue_pb2.GetTissueResponse] = []
    request = tissue_pb2.GetTissueRequest(session_id=session_id)
    yield Call("TissueService.GetTissue", request, LONG, parts.append)
    return [lattice_of(part) for part in parts]


def lattice_of(part: tissue_pb2.GetTissueResponse) -> Lattice:
    """The lattice of a message: nodes are numbered in the order of the lattice, x fastest, without those at no brick."""
    size = tuple(part.cells)
    kept = np.frombuffer(part.bricks, np.uint8).reshape(size, order="F")
    cells = np.argwhere(kept.T > 0)[:, ::-1]  # x fastest
    at_corners = cells[:, None, :] + CORNERS
    steps = np.array([1, size[0] + 1, (size[0] + 1) * (size[1] + 1)])
    numbers, bricks = np.unique(at_corners @ steps, return_inverse=True)
    lattice = np.stack([numbers % steps[1], numbers // steps[1] % (size[1] + 1), numbers // steps[2]], axis=1)
    origin = np.array([part.origin.x, part.origin.y, part.origin.z])
    shapes = np.frombuffer(part.shapes, "<f4").reshape(part.shape_count, len(numbers), 3).astype(float)
    inside = np.where(kept > 0, (kept.astype(float) - 1) / 254, 0)
    places = origin + part.edge * lattice
    return Lattice(part.name, origin, part.edge, inside, places, bricks.reshape(-1, 8), cells, shapes)


def read_tissue(session_id: str, lattices: Sequence[Lattice], points: Points) -> Operation[Tissue]:
    """The tissue now. `points`: at most 64 places at rest [m], (k, 3)."""
    request = tissue_pb2.ReadTissueRequest(session_id=session_id)
    for x, y, z in rows_of("points", points, 3) if points is not None else ():
        request.points.add(x=x, y=y, z=z)
    answer = yield Call("TissueService.ReadTissue", request, LONG)
    lungs = {
        lattice.name: LungNow(
            lattice,
            np.frombuffer(reading.amplitudes, "<f4").astype(float),
            reading.volume,
            Table({"name": r.name, "descent": r.descent, "ventilation": r.ventilation} for r in reading.regions),
        )
        for lattice, reading in zip(lattices, answer.lungs)
    }
    rows = ({name: getattr(p, name) for name in ("lung", "dx", "dy", "dz", "ventilation", "strain")} for p in answer.points)
    return Tissue(answer.tick, answer.time, lungs, Table(rows))


_LATTICES: WeakKeyDictionary[object, list[Lattice]] = WeakKeyDictionary()
"""Of sessions whose tissue was read: they are constant."""


def tissue(session: SessionOperations, points: Points = None) -> Operation[Tissue]:
    """Reads the tissue of a session; the first time also its lattices."""
    if session not in _LATTICES:
        _LATTICES[session] = yield from read_lattices(session.id)
    return (yield from read_tissue(session.id, _LATTICES[session], points))
