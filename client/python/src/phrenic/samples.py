"""Measures sampled by simulated time."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import Iterator

from .v1 import samples_pb2


@dataclass(frozen=True)
class Sample:
    """The measures after one step."""

    tick: int
    time: float
    """Simulated time [s]."""
    breath: float
    """The breath's signal, -1 to 1."""
    measures: dict[str, float]
    """By name, in SI units."""
    left_out: int = 0
    """Samples before this one that were left out, because they were read too slowly."""


@dataclass
class SampleReader:
    """Turns the batches of one stream into samples."""

    names: list[str] = field(default_factory=list)

    def read(self, batch: samples_pb2.SampleBatch) -> Iterator[Sample]:
        """Yields the samples of a batch."""
        if batch.quantities:
            self.names = [quantity.name for quantity in batch.quantities]
        left_out = batch.left_out
        for each in batch.samples:
            yield Sample(each.tick, each.time, each.breath, dict(zip(self.names, each.values)), left_out)
            left_out = 0
