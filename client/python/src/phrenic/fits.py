"""A person's lungs and breath from measured data, fitted on the server with the numbers of `phrenic fit`.

    found = phrenic.fit("pairs.csv", modes=12)
    found = phrenic.fit(exhale="points.csv", surfaces=["dome.stl@inhale"], volume="spirogram.csv")
    found.held_out_mm, found.parameters.where(determined=False)
    with phrenic.Session(found.scene) as s: ...
"""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterable, Mapping, Optional, Sequence, Union

import numpy as np
from google.protobuf import text_format

from .arguments import finite, mapping, path_of
from .call import LONG, Call, Operation
from .errors import FailedPrecondition, InvalidArgument
from .frame import vectors
from .jobs import Progress
from .names import fill, row
from .operations import Scene, check_server, source_of
from .table import Table
from .v1 import fit_pb2, geometry_pb2, scene_pb2, session_pb2

if TYPE_CHECKING:
    from .server import Server

Landmarks = Union[str, Path, np.ndarray, Sequence[Union[str, Path]]]
"""A file of pairs, a pair of files (end exhale, end inhale), or an array (n, 6) in mm and LPS: places at end exhale and at
end inhale."""

COLUMNS = "exhale_x,exhale_y,exhale_z,inhale_x,inhale_y,inhale_z"


@dataclass(frozen=True, repr=False)
class Fit:
    """A fitted breath, and how far off it is on the half of the landmarks that was not fitted."""

    message: fit_pb2.MotionFitResult
    """All of it, as the API has it."""
    parameters: Table
    """A row a number: name, what, value_mm, standard_error_mm, spread_between_people_mm, determined."""
    correlation: np.ndarray
    """Of the numbers, (k, k)."""
    baselines: Table
    """Plain models, fitted to the same half: name, numbers, mean_mm, p95_mm."""
    regions: Table
    """Errors by thirds and halves of the lungs."""
    lungs: Table
    """How the scene's lungs were scaled and shifted."""
    exhale: np.ndarray
    """The landmarks at end exhale [m], (n, 3)."""
    motion: np.ndarray
    """From there to end inhale [m]."""
    predicted: np.ndarray
    """The same by the fit [m]."""
    held_out: np.ndarray
    """Indices of the landmarks that were not fitted."""
    numbers: Table
    """Of a fit to several kinds: every number with unit, standard_error, prior, prior_sd, low, high, determined."""
    derived: Table
    """What follows from them: tidal volume, descents, abdominal share, rate."""
    kinds: Table
    """How well each kind of data is met: data, error, rms_still, rms_before, rms_after, rms_held_out."""

    def __repr__(self) -> str:
        count = len(self.parameters) or len(self.numbers)
        return f"<Fit of {count} numbers, {self.held_out_mm:.2f} mm off on the unseen half>"

    def to_pandas(self) -> Any:
        """Returns the fitted numbers as a pandas.DataFrame: `parameters`, or `numbers` of several kinds of data."""
        return (self.parameters if len(self.parameters) else self.numbers).to_pandas()

    @property
    def held_out_mm(self) -> float:
        """Mean error of the half that was not fitted [mm]: of the fitted numbers alone."""
        return self.message.held_out.mean_mm

    @property
    def doubts(self) -> list[str]:
        """Warnings about axes that the landmarks do not determine."""
        return list(self.message.doubts)

    @property
    def scene(self) -> scene_pb2.Scene:
        """The person's lungs and breath: phrenic.Session(fit.scene). FailedPrecondition if no breath moves so."""
        if not self.message.HasField("scene"):
            raise FailedPrecondition(self.message.scene_problem)
        return self.message.scene

    def to_scene(self, path: Union[str, Path]) -> None:
        """Writes `scene` as a file, NAME.textproto."""
        if Path(path).suffix != ".textproto":
            raise InvalidArgument(f"{path}: a scene's file is NAME.textproto")
        Path(path).write_text(text_format.MessageToString(self.scene), encoding="utf-8")

    def to_json(self, path: Union[str, Path, None] = None) -> str:
        """Returns the numbers as JSON, without landmarks and scene, and writes them to `path`."""
        names = ("parameters", "baselines", "regions", "lungs", "numbers", "derived", "kinds")
        tables = {name: list(getattr(self, name)) for name in names}
        errors = {name: row(getattr(self.message, name)) for name in ("fitting", "held_out", "assimilated")
                  if self.message.HasField(name)}  # fmt: skip
        numbers = {**row(self.message), "correlation": self.correlation.tolist(), **errors, **tables}
        text = json.dumps(numbers, indent=1)
        if path is not None:
            Path(path).write_text(text, encoding="utf-8")
        return text


Files = Union[None, str, Path, Sequence[Union[str, Path]]]

KINDS = {"landmarks": fit_pb2.MEASURED_KIND_LANDMARKS, "exhale": fit_pb2.MEASURED_KIND_EXHALE,
         "surface": fit_pb2.MEASURED_KIND_DIAPHRAGM, "lung-surface": fit_pb2.MEASURED_KIND_LUNGS,
         "volume": fit_pb2.MEASURED_KIND_VOLUME, "m-mode": fit_pb2.MEASURED_KIND_M_MODE,
         "markers": fit_pb2.MEASURED_KIND_MARKERS}  # fmt: skip


OPTIONS = {"exhale": "exhale", "surfaces": "surface", "lung_surfaces": "lung-surface", "volume": "volume",
           "m_mode": "m-mode", "markers": "markers"}  # fmt: skip
"""The options of `fit` that take files, and their kinds."""


def fit(
    landmarks: Optional[Landmarks] = None,
    scene: Scene = "thorax",
    *,
    exhale: Files = None,
    surfaces: Files = None,
    lung_surfaces: Files = None,
    volume: Files = None,
    m_mode: Files = None,
    markers: Files = None,
    errors: Optional[Mapping[str, float]] = None,
    modes: int = 8,
    split: int = 1,
    assimilate: bool = False,
    scene_name: str = "",
    show_landmarks: bool = False,
    resolution_mm: Optional[float] = None,
    progress: Progress = None,
    server: Optional["Server"] = None,
) -> Fit:
    """Fits a person's breath to landmarks, on the server; the numbers are those of `phrenic fit` with the same landmarks
    and options. `scene`: its lungs are moved onto the person's. `modes`: 8 or 12 numbers. `split`: seed of the half that
    is fitted. `assimilate`: adds the smallest elastic deformation. `scene_name`: of the person's scene, which has up to
    400 landmarks with `show_landmarks`. InvalidArgument names the file and the line. A `progress` that raises ends the fit.

    Other kinds of data are fitted together with the landmarks, from people's breaths as a prior: `exhale`, points that
    give the lungs their shape; `surfaces` of the diaphragm and `lung_surfaces`, "FILE@inhale" or "FILE@exhale"; `volume`,
    a spirogram; `m_mode`, "FILE@right" or "FILE@left"; `markers` on the chest; landmarks of other times, "FILE@0.5".
    `errors`: the standard error of a kind, {"volume": 0.05} [l, mm]."""
    if server is None:
        from .server import default_server

        server = default_server()
    check_server(server)
    options = {"modes": modes, "split": split, "assimilate": assimilate, "scene_name": scene_name,
               "show_landmarks": show_landmarks}  # fmt: skip
    options |= {"exhale": exhale, "surfaces": surfaces, "lung_surfaces": lung_surfaces, "volume": volume,
                "m_mode": m_mode, "markers": markers, "errors": errors}  # fmt: skip
    return server.connection.run(fitted(source_of(scene, resolution_mm), landmarks, options, progress))


def fitted(
    source: session_pb2.SceneSource, landmarks: Optional[Landmarks], options: Mapping[str, Any], progress: Progress
) -> Operation[Fit]:
    """Fits, and returns the result. `options`: those of `fit`."""
    given = {kind: options.get(name) for name, kind in OPTIONS.items()}
    measured = _measured(landmarks, given, mapping("errors", options.get("errors")))
    files = [] if landmarks is None or measured else landmark_files(landmarks)
    fields = {name: value for name, value in options.items() if name not in OPTIONS and name != "errors"}
    request = fill(fit_pb2.FitMotionRequest(source=source, landmarks=files, measured=measured), fields)
    results: list[fit_pb2.MotionFitResult] = []

    def note(event: fit_pb2.FitMotionResponse) -> None:
        if event.HasField("result"):
            results.append(event.result)
        elif progress:
            progress(event.progress.done, event.progress.doing)

    yield Call("FitService.FitMotion", request, LONG, note)
    return _fit_of(results[-1])


def _measured(
    landmarks: Optional[Landmarks], given: Mapping[str, Files], errors: Mapping[str, float]
) -> list[fit_pb2.MeasuredFile]:
    """Returns the files of a fit to several kinds; none if there are landmarks at end inhale alone."""
    for kind in errors:
        if kind not in KINDS:
            raise InvalidArgument(f"errors: {kind!r} is no kind of data: there are {', '.join(KINDS)}")
    files: list[fit_pb2.MeasuredFile] = []
    for kind, paths in given.items():
        files += [_measured_file(kind, str(path), errors) for path in _listed(paths)]
    pairs = [] if landmarks is None or isinstance(landmarks, np.ndarray) else [str(path) for path in _listed(landmarks)]
    phased = any(_suffix(path)[1] for path in pairs)
    if not files and not phased and not errors:
        return []
    if isinstance(landmarks, np.ndarray):
        content = landmark_files(landmarks)[0].content
        files.append(fit_pb2.MeasuredFile(kind=KINDS["landmarks"], name="landmarks", content=content))
        if "landmarks" in errors:
            files[-1].error = finite("errors: landmarks", errors["landmarks"])
    return files + [_measured_file("landmarks", path, errors) for path in pairs]


def _listed(paths: Any) -> list[Any]:
    if paths is None:
        return []
    each = [paths] if isinstance(paths, (str, Path)) else paths
    if not isinstance(each, Iterable):
        raise InvalidArgument(f"{paths!r} is neither a file nor a list of files")
    return [path_of("files", path) for path in each]


def _suffix(text: str) -> tuple[str, str]:
    """Returns a file and the suffix after its "@"."""
    path, at, suffix = text.rpartition("@")
    if at and (suffix in ("inhale", "exhale", "right", "left") or suffix.replace(".", "", 1).isdigit()):
        return path, suffix
    return text, ""


def _measured_file(kind: str, text: str, errors: Mapping[str, float]) -> fit_pb2.MeasuredFile:
    name, suffix = _suffix(text)
    path = Path(name)
    try:
        file = fit_pb2.MeasuredFile(kind=KINDS[kind], name=path.name, content=path.read_bytes())
    except OSError as error:
        raise InvalidArgument(f"{path}: {error.strerror}") from None
    if kind in errors:
        file.error = finite(f"errors: {kind}", errors[kind])
    if suffix in ("right", "left"):
        file.side = geometry_pb2.SIDE_LEFT if suffix == "left" else geometry_pb2.SIDE_RIGHT
    elif suffix in ("inhale", "exhale"):
        file.at_exhale = suffix == "exhale"
    elif suffix:
        file.phase = float(suffix)
    return file


def landmark_files(landmarks: Landmarks) -> list[fit_pb2.LandmarkFile]:
    """Returns the landmarks as the server takes them."""
    if isinstance(landmarks, np.ndarray):
        if landmarks.ndim != 2 or landmarks.shape[1] != 6:
            raise InvalidArgument(f"landmarks: an array of shape {landmarks.shape} is not (n, 6): {COLUMNS} in mm")
        lines = (",".join(repr(float(number)) for number in row) for row in landmarks)
        return [fit_pb2.LandmarkFile(name="landmarks", content="\n".join((COLUMNS, *lines)).encode())]
    return [_file(path) for path in _listed(landmarks)]


def _file(path: Path) -> fit_pb2.LandmarkFile:
    try:
        return fit_pb2.LandmarkFile(name=path.name, content=path.read_bytes())
    except OSError as error:
        raise InvalidArgument(f"{path}: {error.strerror}") from None


def _fit_of(result: fit_pb2.MotionFitResult) -> Fit:
    count = len(result.parameters)
    places = (vectors(part, "<f8") for part in (result.points.exhale, result.points.motion, result.points.predicted))
    return Fit(
        result, Table.of(result.parameters), np.array(result.correlation).reshape(count, count),
        Table.of(result.baselines), Table.of(result.regions), Table.of(result.lungs), *places,
        np.array(result.points.held_out, dtype=int), Table.of(result.numbers), Table.of(result.derived),
        Table.of(result.kinds),
    )  # fmt: skip
