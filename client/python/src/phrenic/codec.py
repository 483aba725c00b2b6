"""Compressed frames to positions, by the server's own decoder: native/libphrenic_decoder.so."""

from __future__ import annotations

import ctypes
from functools import lru_cache
from pathlib import Path
from typing import Iterable, Sequence

import numpy as np

from .errors import FailedPrecondition, InvalidArgument
from .frame import vectors
from .v1 import frames_pb2

LIBRARY = Path(__file__).with_name("native") / "libphrenic_decoder.so"


@lru_cache
def library() -> ctypes.CDLL:
    """Returns the decoder. FailedPrecondition if it is not there or of another machine."""
    try:
        found = ctypes.CDLL(str(LIBRARY))
    except OSError as error:
        raise FailedPrecondition(
            f"compressed frames need the decoder, which cannot be loaded: {error}. Build the package on this machine "
            "(deploy/run, or the Debian package python3-phrenic), or watch without max_error_mm"
        ) from None
    found.phrenic_decoder_make.argtypes = [ctypes.c_void_p, ctypes.c_int64, ctypes.c_void_p, ctypes.c_int64]
    found.phrenic_decoder_make.restype = ctypes.c_void_p
    found.phrenic_decoder_set_basis.argtypes = [ctypes.c_void_p, ctypes.c_void_p, ctypes.c_int64]
    found.phrenic_decoder_set_basis.restype = ctypes.c_char_p
    found.phrenic_decoder_decode.argtypes = [ctypes.c_void_p, ctypes.c_int32, ctypes.c_char_p, ctypes.c_int64,
                                             ctypes.c_void_p]  # fmt: skip
    found.phrenic_decoder_decode.restype = ctypes.c_char_p
    found.phrenic_decoder_free.argtypes = [ctypes.c_void_p]
    found.phrenic_decoder_free.restype = None
    return found


class Decoder:
    """Decodes Frame.positions of one session. One thread at a time may use it."""

    def __init__(self, bodies: Iterable[frames_pb2.GetGeometryResponse]) -> None:
        """`bodies`: the session's geometry, all of it."""
        self._made = None
        streamed = [body for body in bodies if body.placement == frames_pb2.PLACEMENT_STREAMED]
        streamed.sort(key=lambda body: body.body_index)
        self.rest = np.concatenate([np.empty((0, 3), "<f4"), *(vectors(body.rest_positions) for body in streamed)])
        """Of the streamed vertices [m], (n, 3) float32."""
        edges = np.concatenate([np.empty((0, 2), "<u4"), *(edges_of(body) + body.first_vertex for body in streamed)])
        edges = np.ascontiguousarray(edges, "<u4")
        self._library = library()
        self._made = self._library.phrenic_decoder_make(
            self.rest.ctypes.data, len(self.rest), edges.ctypes.data, len(edges)
        )
        if self._made is None:
            raise InvalidArgument("the geometry has an edge between vertices that it does not have")

    def __del__(self) -> None:
        if self._made is not None:
            self._library.phrenic_decoder_free(self._made)

    def decode(self, codec: int, data: bytes) -> np.ndarray:
        """Returns the positions [m], (n, 3) float32, read-only. `codec`: a number of phrenic.v1.Codec. InvalidArgument
        for bytes that are not an encoding of the vertices."""
        positions = np.empty_like(self.rest)
        problem = self._library.phrenic_decoder_decode(self._made, codec, data, len(data), positions.ctypes.data)
        if problem is not None:
            raise InvalidArgument(problem.decode())
        positions.setflags(write=False)
        return positions

    def set_basis(self, shapes: Sequence[bytes]) -> None:
        """Sets the shapes of CODEC_BASIS: those of GetBasisResponse."""
        moved = [self.decode(frames_pb2.CODEC_PREDICTED, shape) - self.rest for shape in shapes]
        numbers = np.ascontiguousarray(moved, "<f4")
        problem = self._library.phrenic_decoder_set_basis(self._made, numbers.ctypes.data, len(moved))
        if problem is not None:
            raise InvalidArgument(problem.decode())


def edges_of(body: frames_pb2.GetGeometryResponse) -> np.ndarray:
    """Returns the pairs of neighbouring vertices of a body: its edges or, if it has none, the sides of its triangles.

    >>> edges_of(frames_pb2.GetGeometryResponse(triangles=np.array([0, 1, 2, 2, 1, 3], "<u4").tobytes())).tolist()
    [[0, 1], [0, 2], [1, 2], [1, 3], [2, 3]]
    """
    if body.edges:
        return vectors(body.edges, "<u4", 2)
    triangles = vectors(body.triangles, "<u4")
    sides = np.concatenate([triangles[:, :2], triangles[:, 1:], triangles[:, ::2]])
    return np.unique(np.sort(sides, axis=1), axis=0)
