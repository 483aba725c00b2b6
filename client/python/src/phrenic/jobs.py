"""Work that the server does beside sessions: exports, studies, comparisons, physiology; as operations (call.py)."""

from __future__ import annotations

import hashlib
import re
import zipfile
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, BinaryIO, Callable, Mapping, Optional, Union

import numpy as np

from .arguments import names_of, new_file, path_of, text_of
from .call import FIRST, LONG, Call, Operation, new_id
from .errors import AlreadyExists, Closed, DataLoss, FailedPrecondition, InvalidArgument, NotFound, Unavailable
from .junit import Check, junit
from .names import Named, fill, is_repeated, nearest, row
from .table import Table
from .v1 import compare_pb2, export_pb2, physiology_pb2, session_pb2, study_pb2

Progress = Optional[Callable[[float, str], None]]
"""Called with 0 to 1, and what is being done."""

STUDIES = {"error": study_pb2.ErrorStudy, "stability": study_pb2.StabilityStudy, "cost": study_pb2.CostStudy,
           "streaming": study_pb2.StreamingStudy}  # fmt: skip


# --- exports ---
def export(
    session_id: str, path: Union[str, Path], options: Mapping[str, Any], progress: Progress
) -> Operation[dict[str, Any]]:
    """Records a copy of the session to a file, whose ending chooses the format. Returns the summary."""
    path = new_file("path", path)
    formats = (yield Call("ExportService.ListFormats", export_pb2.ListFormatsRequest())).formats
    known = {each.name: each for each in formats}
    name = path.suffix[1:]
    if name not in known:
        raise InvalidArgument(f"{path}: there is no format {name!r}: {nearest(name, known)}")
    id = new_id("export")
    request = export_pb2.CreateExportRequest(export_id=id, session_id=session_id, format=name, file_stem=path.stem)
    yield from _begun(Call("ExportService.CreateExport", fill(request, options), LONG))
    try:
        summary = yield from _export_done(id, progress)
        return (yield from _download(id, path, summary, known[name].ending == "zip"))
    finally:
        yield from _dropped(Call("ExportService.DeleteExport", export_pb2.DeleteExportRequest(export_id=id), repeats=FIRST))


def _begun(call: Call) -> Operation[None]:
    """Begins a job with an id of this client's choice, once, however often the call is repeated."""
    try:
        yield call
    except AlreadyExists:  # by a call whose answer was lost: no other client has the id
        pass


def _dropped(call: Call) -> Operation[None]:
    """Deletes a job, which may have ended with its server."""
    try:
        yield call
    except (NotFound, Unavailable, Closed):
        pass


def _export_done(id: str, progress: Progress) -> Operation[export_pb2.ExportSummary]:
    """Waits for the end of an export and returns its summary."""
    seen: list[export_pb2.Export] = []

    def note(event: export_pb2.WatchExportResponse) -> None:
        seen[:] = [event.job]
        if progress:
            progress(event.job.progress, "recording")

    yield Call("ExportService.WatchExport", export_pb2.WatchExportRequest(export_id=id), LONG, note)
    if not seen or seen[0].state != export_pb2.EXPORT_STATE_DONE:
        raise FailedPrecondition((seen and seen[0].problem) or "the server ended the stream before the export was done: try again")
    return seen[0].summary


def _download(
    id: str, path: Path, summary: export_pb2.ExportSummary, zipped: bool
) -> Operation[dict[str, Any]]:
    """Downloads the file of an export, checks it and puts it at the path."""
    part = path.with_name(path.name + ".part")
    try:
        with open(part, "w+b") as file:
            yield from _receive(id, file)
            digest = _sha256(file)
        if digest != summary.sha256:
            raise DataLoss(f"{path}: the file arrived damaged")
        if zipped:
            _unzip(part, path)
        else:
            part.replace(path)
        return row(summary)
    finally:
        part.unlink(missing_ok=True)


def _sha256(file: BinaryIO) -> str:
    file.seek(0)
    digest = hashlib.sha256()
    while block := file.read(1 << 20):
        digest.update(block)
    return digest.hexdigest()


def _unzip(part: Path, path: Path) -> None:
    """Extracts the files of a motion beside its path: motion.pvd and motion/motion_000000.vtp. Refuses an archive with
    any other name before it writes a file, so that no other file of the folder is replaced."""
    stem = re.escape(path.stem)
    with zipfile.ZipFile(part) as archive:
        for name in archive.namelist():
            if name != path.name and not re.fullmatch(rf"{stem}/{stem}_[A-Za-z0-9_]+\.[a-z]+", name):
                raise FailedPrecondition(f"{path}: the server's archive has a file that is none of this motion: {name!r}")
        archive.extractall(path.parent)


def _receive(id: str, file: BinaryIO) -> Operation[None]:
    """Downloads, and resumes where a lost connection left off."""
    for attempt in range(5):
        request = export_pb2.DownloadExportRequest(export_id=id, offset=file.tell())
        try:
            yield Call("ExportService.DownloadExport", request, LONG, lambda m: file.write(m.chunk), repeatable=False)
            return
        except Unavailable:
            if attempt == 4:
                raise


# --- studies ---
@dataclass
class Study:
    """The result of a study. `tables` has a Table for each kind of row; `rows` is the main one."""

    rows: Table
    tables: dict[str, Table]
    advice: str
    took: float
    """Wall time [s]."""
    page: str = field(repr=False)
    """A self-contained HTML page of it; empty where the server's viewer is not built."""

    def to_pandas(self) -> Any:
        """Returns `rows` as a pandas.DataFrame."""
        return self.rows.to_pandas()

    def _repr_html_(self) -> str:
        """What a notebook shows: the rows."""
        return self.rows._repr_html_()


def study(
    kind: str, source: session_pb2.SceneSource, parameters: Any, options: Mapping[str, Any], progress: Progress
) -> Operation[Study]:
    """Runs a study on the server and deletes it there."""
    id = new_id("study")
    request = study_pb2.CreateStudyRequest(study_id=id, source=source, parameters=parameters)
    getattr(request, kind).CopyFrom(fill(STUDIES[kind](), options))
    yield from _begun(Call("StudyService.CreateStudy", request, LONG))
    try:
        seen: list[study_pb2.Study] = []

        def note(event: study_pb2.WatchStudyResponse) -> None:
            seen[:] = [event.study]
            if progress:
                progress(event.study.progress, event.study.doing)

        yield Call("StudyService.WatchStudy", study_pb2.WatchStudyRequest(study_id=id), LONG, note)
        if not seen or seen[0].state != study_pb2.STUDY_STATE_DONE:
            raise FailedPrecondition((seen and seen[0].problem) or "the server ended the stream before the study was done: try again")
        return study_of(seen[0].result, (yield from _page(id)))
    finally:
        yield from _dropped(Call("StudyService.DeleteStudy", study_pb2.DeleteStudyRequest(study_id=id), repeats=FIRST))


def _page(id: str) -> Operation[str]:
    try:
        return (yield Call("StudyService.GetStudyPage", study_pb2.GetStudyPageRequest(study_id=id))).html
    except NotFound:  # the viewer, which draws it, is not built
        return ""


def study_of(result: Any, page: str) -> Study:
    """Returns the tables of a result."""
    table = getattr(result, result.WhichOneof("result"))
    tables = {
        field.name: Table.of(getattr(table, field.name))
        for field in table.DESCRIPTOR.fields
        if field.message_type and is_repeated(field)
    }
    main = tables.get("rows") or next((each for each in tables.values() if len(each)), Table([]))
    return Study(main, tables, getattr(table, "advice", ""), result.took_s, page)


# --- physiology ---
@dataclass
class Physiology:
    """A thorax' breath against published ranges."""

    rows: Table
    """A row a check: breath, what, unit, value, low, high, verdict, note, source."""
    curves: dict[str, dict[str, tuple[np.ndarray, np.ndarray]]] = field(repr=False)
    """curves[breath][what] is (times [s], values)."""

    def to_pandas(self) -> Any:
        """Returns `rows` as a pandas.DataFrame."""
        return self.rows.to_pandas()

    def curves_to_pandas(self) -> Any:
        """Returns `curves` as a pandas.DataFrame with the columns breath, what, time_s and value, a row a moment."""
        return Table(
            {"breath": breath, "what": what, "time_s": float(time), "value": float(value)}
            for breath, of_breath in self.curves.items()
            for what, curve in of_breath.items()
            for time, value in zip(*curve)
        ).to_pandas()

    def _repr_html_(self) -> str:
        """What a notebook shows: the rows."""
        return self.rows._repr_html_()

    @property
    def outside(self) -> Table:
        """The checks whose value is outside its range."""
        return self.rows.where(verdict="outside")

    def to_junit(self, path: Union[str, Path, None] = None, suite: str = "physiology") -> str:
        """Returns the checks as JUnit XML, and writes it to `path`: a value outside its range is a failed test, one that
        is not judged a skipped one."""
        return junit(suite, [_check_of(row) for row in self.rows], path)


def _check_of(row: Mapping[str, Any]) -> Check:
    """The check of one row, in the words of `phrenic physiology --junit`."""
    name, note = f"{row['breath']}: {row['what']}", f" ({row['note']})" if row["note"] else ""
    if row["verdict"] == "outside":
        return Check(name, f"{row['value']:.4g} is outside {row['low']:g} to {row['high']:g} {row['unit']}{note}")
    return Check(name, skipped=row["verdict"] != "inside")


def physiology(source: session_pb2.SceneSource, presets: Any, progress: Progress) -> Operation[Physiology]:
    """Simulates the breathing presets and compares them with published ranges."""
    tables: list[physiology_pb2.PhysiologyTable] = []

    def note(event: study_pb2.CheckPhysiologyResponse) -> None:
        if event.HasField("table"):
            tables.append(event.table)
        elif progress:
            progress(event.progress, "breathing")

    request = study_pb2.CheckPhysiologyRequest(source=source, presets=names_of("presets", presets))
    yield Call("StudyService.CheckPhysiology", request, LONG, note)
    curves: dict[str, dict[str, tuple[np.ndarray, np.ndarray]]] = {}
    for curve in tables[-1].curves:
        curves.setdefault(curve.breath, {})[curve.what] = (np.array(curve.time_s), np.array(curve.values))
    return Physiology(Table.of(tables[-1].rows), curves)


# --- comparison ---
@dataclass
class Comparison:
    """Distances between two surfaces or motions [mm]."""

    rows: Table
    """The whole surfaces, then regions, then times."""
    definition: str
    warnings: list[str]

    def to_pandas(self) -> Any:
        """Returns `rows` as a pandas.DataFrame."""
        return self.rows.to_pandas()

    def _repr_html_(self) -> str:
        """What a notebook shows: the rows."""
        return self.rows._repr_html_()

    def __getitem__(self, name: str) -> float:
        """Returns a distance of the whole surfaces, such as ["hd95_max"]."""
        return Named(self.rows[0], "distance")[name]


def comparison(
    session_id: str, other_id: Optional[str], file: Any, body: str, options: Mapping[str, Any]
) -> Operation[Comparison]:
    """Compares a body of a session with that of another one, or with a file."""
    of_file = {name: value for name, value in options.items() if name in ("unit_mm", "time")}
    rest = {name: value for name, value in options.items() if name not in of_file}
    b = file_of(file, of_file) if other_id is None else body_of(other_id, body)
    return (yield from compare(body_of(session_id, body), b, rest))


def compare(a: compare_pb2.ComparedSurface, b: compare_pb2.ComparedSurface, options: Any) -> Operation[Comparison]:
    """Compares two surfaces."""
    tables: list[compare_pb2.ComparisonTable] = []

    def note(event: compare_pb2.CompareResponse) -> None:
        if event.HasField("table"):
            tables.append(event.table)

    request = fill(compare_pb2.CompareRequest(a=a, b=b), options)
    yield Call("CompareService.Compare", request, LONG, note)
    rows = ({**row(each), **row(each.distance)} for each in tables[-1].rows)
    return Comparison(Table(rows), tables[-1].definition, list(tables[-1].warnings))


def body_of(session_id: str, body: str) -> compare_pb2.ComparedSurface:
    """A body of a session, as it is now; empty: the deformable body with the most triangles."""
    return compare_pb2.ComparedSurface(body=compare_pb2.SessionBody(session_id=session_id, body=text_of("body", body)))


def file_of(path: Union[str, Path], options: Mapping[str, Any]) -> compare_pb2.ComparedSurface:
    """A surface or motion file."""
    path = path_of("other", path)
    try:
        return fill(compare_pb2.ComparedSurface(name=path.name, content=path.read_bytes()), options)
    except OSError as error:
        raise InvalidArgument(f"{path}: {error.strerror}") from None
