"""A motion as labelled arrays: xarray, Zarr, NetCDF.

>>> import phrenic
>>> with phrenic.Session("cube-springs") as s:
...     motion = Motion.of(s.play(seconds=0.2, fps=10), scene=s.scene)
>>> motion.variables["cube"].dims, motion.variables["cube"].values.shape
(('time', 'cube_vertex', 'axis'), (2, 8, 3))
>>> motion.coordinates["time"].attributes["units"], motion.attributes["scene"]
('s', 'cube-springs')

`to_xarray(frames)`, `to_zarr(frames, path)` and `to_netcdf(frames, path)` take the frames of Session.play(), or a list.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterable, Optional, Sequence, Union

import numpy as np

from .arguments import new_file
from .errors import InvalidArgument
from .frame import Frame
from .optional import need

ORIENTATION = "LPS: +x to the patient's left, +y posterior, +z superior"


@dataclass(frozen=True)
class Variable:
    """An array whose dimensions have names."""

    dims: tuple[str, ...]
    values: np.ndarray
    attributes: dict[str, str] = field(default_factory=dict)


@dataclass(frozen=True)
class Motion:
    """Frames as named arrays.

    coordinates: time [s], tick, axis (x, y, z) and, where the frames have one, state_hash.
    variables: for each body its positions (time, BODY_vertex, axis) float32 [m], and BODY_triangles; for each measure its
    values (time) in its SI unit. A "/" in a name, which the file formats do not allow, becomes "_"."""

    coordinates: dict[str, Variable]
    variables: dict[str, Variable]
    attributes: dict[str, Any]

    @classmethod
    def of(cls, frames: Iterable[Frame], bodies: Optional[Sequence[str]] = None, **attributes: Any) -> "Motion":
        """Returns the motion of these frames. `bodies`: names; default: all that the frames have. `attributes`: noted as
        they are, such as scene=session.scene. InvalidArgument if there is no frame."""
        frames = list(frames) if isinstance(frames, Iterable) else [frames]
        if not all(isinstance(frame, Frame) for frame in frames):
            raise InvalidArgument("frames: give frames of Session.play(), or a list of them")
        if not frames:
            raise InvalidArgument("frames: a motion needs one at least")
        names = frames[0].bodies if bodies is None else list(bodies)
        variables: dict[str, Variable] = {}
        for name in names:
            _add_body(variables, name, frames)
        for name, unit in frames[0].units.items():
            values = np.array([frame.measures[name] for frame in frames])
            _add(variables, name, Variable(("time",), values, {"units": unit}))
        hashes = {"state_hash": frames[-1].state_hash} if frames[-1].state_hash else {}
        return cls(_coordinates(frames), variables, {"source": "Phrenic", **hashes, **attributes})

    def to_xarray(self) -> Any:
        """Returns an xarray.Dataset. Requires: xarray is installed."""
        xarray = need("xarray", "to_xarray", "apt install python3-xarray, or pip install xarray")
        return xarray.Dataset(
            {name: (v.dims, v.values, v.attributes) for name, v in self.variables.items()},
            {name: (v.dims, v.values, v.attributes) for name, v in self.coordinates.items()},
            self.attributes,
        )

    def to_zarr(self, path: Union[str, Path]) -> None:
        """Writes a Zarr store, a folder; replaces one that is there. Requires: xarray and zarr are installed."""
        need("zarr", "to_zarr", "apt install python3-xarray python3-zarr, or pip install xarray zarr; or use to_netcdf")
        self.to_xarray().to_zarr(str(path), mode="w")

    def to_netcdf(self, path: Union[str, Path]) -> None:
        """Writes a NetCDF 3 file, which xarray.open_dataset reads; text is UTF-8. A file that is there is replaced once the
        new one is whole. Requires: scipy is installed; xarray is not needed."""
        scipy_io = need("scipy.io", "to_netcdf", "apt install python3-scipy, or pip install scipy")
        target = new_file("path", path)
        part = target.with_name(target.name + ".part")
        try:
            with scipy_io.netcdf_file(str(part), "w", version=2) as file:
                for name, value in self.attributes.items():
                    if hasattr(file, name):
                        raise InvalidArgument(f"attributes: {name} has another meaning in NetCDF: choose another name")
                    setattr(file, _ascii(name), _attribute(name, value))
                for name, variable in {**self.coordinates, **self.variables}.items():
                    _write(file, _ascii(name), variable)
            part.replace(target)
        finally:
            part.unlink(missing_ok=True)


def to_xarray(frames: Iterable[Frame], bodies: Optional[Sequence[str]] = None, **attributes: Any) -> Any:
    """Returns the motion as an xarray.Dataset: dataset["diaphragm"] has the dimensions time, diaphragm_vertex and axis,
    dataset["lung volume"] the dimension time. `bodies` and `attributes`: as of Motion.of. ModuleNotFoundError says how to
    install xarray."""
    return Motion.of(frames, bodies, **attributes).to_xarray()


def to_zarr(
    frames: Iterable[Frame], path: Union[str, Path], bodies: Optional[Sequence[str]] = None, **attributes: Any
) -> None:
    """Writes the motion as a Zarr store."""
    Motion.of(frames, bodies, **attributes).to_zarr(path)


def to_netcdf(
    frames: Iterable[Frame], path: Union[str, Path], bodies: Optional[Sequence[str]] = None, **attributes: Any
) -> None:
    """Writes the motion as a NetCDF file."""
    Motion.of(frames, bodies, **attributes).to_netcdf(path)


def _coordinates(frames: Sequence[Frame]) -> dict[str, Variable]:
    rows = {
        "time": Variable(("time",), np.array([f.time for f in frames]), {"units": "s", "long_name": "simulated time"}),
        "tick": Variable(("time",), _ticks(frames), {"long_name": "steps since the last reset"}),
        "axis": Variable(("axis",), np.array(["x", "y", "z"]), {"long_name": ORIENTATION}),
    }
    if all(frame.state_hash for frame in frames):
        rows["state_hash"] = Variable(("time",), np.array([frame.state_hash for frame in frames]))
    return rows


def _ticks(frames: Sequence[Frame]) -> np.ndarray:
    """As int32, which every format has, while they fit."""
    ticks = np.array([frame.tick for frame in frames], np.int64)
    return ticks.astype(np.int32) if ticks.max() < 2**31 else ticks.astype(np.float64)


def _add_body(variables: dict[str, Variable], name: str, frames: Sequence[Frame]) -> None:
    safe = name.replace("/", "_")
    shown = {"units": "m", "long_name": f"positions of {name}", "orientation": ORIENTATION}
    positions = np.stack([frame[name].positions for frame in frames])
    _add(variables, name, Variable(("time", f"{safe}_vertex", "axis"), positions, shown))
    triangles = frames[0][name].triangles.astype(np.int32)
    _add(
        variables,
        f"{name}_triangles",
        Variable((f"{safe}_triangle", "corner"), triangles, {"long_name": f"vertices of the triangles of {name}"}),
    )


def _add(variables: dict[str, Variable], name: str, variable: Variable) -> None:
    """InvalidArgument if a body and a measure have the same name."""
    name = name.replace("/", "_")
    if name in variables:
        raise InvalidArgument(f"bodies: {name} is also the name of a measure or of a body: choose others")
    variables[name] = variable


def _ascii(name: str) -> str:
    """Returns the name. InvalidArgument if scipy cannot write it."""
    if not name.isascii():
        raise InvalidArgument(f"attributes, bodies: {name!r} is not ASCII, as scipy's NetCDF has names: choose another")
    return name


def _attribute(name: str, value: Any) -> Any:
    """Returns an attribute as NetCDF 3 has it: a text, a number or numbers of 32 bits. InvalidArgument for others."""
    if isinstance(value, str):
        return value.encode("utf-8")
    numbers = np.asarray(value)
    if numbers.dtype.kind in "iu" and numbers.size and not (np.abs(numbers.astype(float)) < 2**31).all():
        numbers = numbers.astype(float)
    if numbers.dtype.kind not in "iuf" or numbers.ndim > 1:
        raise InvalidArgument(f"attributes: {name}: {value!r} is neither a text, nor a number or a list of numbers")
    return numbers.astype(np.int32 if numbers.dtype.kind in "iu" else np.float64)


def _write(file: Any, name: str, variable: Variable) -> None:
    """Adds a variable to a file of scipy's. Text is an array of characters, as NetCDF 3 has it."""
    values, dims = variable.values, variable.dims
    if values.dtype.kind == "U":
        width = values.dtype.itemsize // 4
        values = np.frombuffer(values.astype(f"S{width}").tobytes(), "S1").reshape(*values.shape, width)
        dims = (*dims, f"string{width}")
    for dim, size in zip(dims, values.shape):
        if dim not in file.dimensions:
            file.createDimension(dim, size)
    kind = "c" if values.dtype.kind == "S" else values.dtype.newbyteorder(">")
    made = file.createVariable(name, kind, dims)
    made[:] = values
    for key, value in variable.attributes.items():
        setattr(made, key, value.encode("utf-8"))
