"""A person's breathing thorax from a segmentation, made on the server as by `phrenic patient`.

    found = phrenic.patient("labels.nii.gz")
    found = phrenic.patient("moose/segmentations")     # a folder with a file for each structure or model
    found.verdict, found.findings["what"]
    with phrenic.Session(found.scene) as s: ...
"""

from __future__ import annotations

import io
import tarfile
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, Union

from .arguments import path_of, whole
from .call import FIRST, LONG, Call, Operation
from .errors import FailedPrecondition, InvalidArgument, NotFound
from .jobs import Progress
from .names import fill, nearest
from .operations import check_server
from .table import Table
from .v1 import patient_pb2, patients_pb2, scene_pb2, upload_pb2

if TYPE_CHECKING:
    from .server import Server

LabelFiles = Union[str, Path, Sequence[Union[str, Path]]]
"""A label file (NIfTI, DICOM Segmentation, RT Structure Set), a zip or tar archive, a folder, or several files."""

CHUNK = 1 << 20
"""[bytes]"""


@dataclass(frozen=True, repr=False)
class Patient:
    """A patient that the server has made of labels, or has refused."""

    message: patients_pb2.Patient
    """The message of the API, with all fields."""
    findings: Table
    """Reasons of the verdict, the gravest first: verdict, what, kind, parts, values."""
    surfaces: Table
    """A row for each surface: body, vertices, triangles, volume_ml, label_volume_ml, from_template."""
    ribs: Table
    """Axes of the ribs: body, neck_mm, axis_degrees, drop_degrees."""

    def __repr__(self) -> str:
        return f"<Patient of {len(self.surfaces)} surfaces, {self.verdict}>"

    @property
    def report(self) -> patient_pb2.PatientReport:
        """The report of `phrenic patient`."""
        return self.message.report

    @property
    def verdict(self) -> str:
        """"ready", "usable with care" or "not usable"."""
        name = patient_pb2.ReadinessVerdict.Name(self.report.readiness.verdict)
        return name[len("READINESS_VERDICT_") :].lower().replace("_", " ")

    @property
    def assumptions(self) -> list[str]:
        """What the labels did not define, and what was done instead."""
        return list(self.report.fallbacks)

    @property
    def scene(self) -> scene_pb2.Scene:
        """The person's thorax: phrenic.Session(patient.scene) on the same server. FailedPrecondition with the gravest
        reason if the labels are not usable."""
        if not self.message.HasField("scene"):
            raise FailedPrecondition(self.message.problem)
        return self.message.scene


def patient(
    files: LabelFiles,
    *,
    map: str = "",
    labels: Optional[Mapping[int, str]] = None,
    vertices: Optional[int] = None,
    edge_length_mm: Optional[float] = None,
    anyway: bool = False,
    progress: Progress = None,
    server: Optional["Server"] = None,
) -> Patient:
    """Makes a person's breathing thorax of label files, which are sent without the names of their folders.

    map: program that numbered the labels, such as "vista3d" or "moose"; by default names count, else the map that fits
        best.
    labels: structures by label number, named as in the label maps: {3: "liver"}; other labels are left out.
    vertices: of the diaphragm, about.
    edge_length_mm: of the bones' triangles.
    anyway: makes the patient also if the labels are not usable.
    progress: is called with the fraction that is done and the current step; if it raises, the patient is cancelled.

    InvalidArgument names the file and what is wrong with it."""
    if server is None:
        from .server import default_server

        server = default_server()
    check_server(server)
    options = {"map": map, "vertices": vertices, "edge_length_mm": edge_length_mm, "anyway": anyway}
    return server.connection.run(made(files, labels, options, progress))


def made(
    files: LabelFiles, labels: Optional[Mapping[int, str]], options: Mapping[str, Any], progress: Progress
) -> Operation[Patient]:
    """Uploads the files, makes the patient and deletes both on the server; its surfaces stay. `options`: those of
    `patient`."""
    given = {name: value for name, value in options.items() if value is not None}
    request = fill(patients_pb2.CreatePatientRequest(), given)
    path = yield from _uploaded(_content(files))
    try:
        request.path = path
        if labels is not None:
            request.labels.extend((yield from _meanings(path, request.map, labels)))
        return (yield from _watched(request, progress))
    finally:
        try:
            yield Call("UploadService.DeleteUpload", upload_pb2.DeleteUploadRequest(path=path), repeats=FIRST)
        except NotFound:
            pass


def _watched(request: patients_pb2.CreatePatientRequest, progress: Progress) -> Operation[Patient]:
    id = (yield Call("PatientService.CreatePatient", request, LONG, repeatable=False)).patient.id
    seen: list[patients_pb2.Patient] = []

    def note(event: patients_pb2.WatchPatientResponse) -> None:
        seen[:] = [event.patient]
        if progress:
            progress(event.patient.progress, event.patient.doing)

    try:
        yield Call("PatientService.WatchPatient", patients_pb2.WatchPatientRequest(patient_id=id), LONG, note)
    finally:
        try:
            yield Call("PatientService.DeletePatient", patients_pb2.DeletePatientRequest(patient_id=id), repeats=FIRST)
        except NotFound:
            pass
    if not seen or not (seen[0].HasField("scene") or seen[0].report.HasField("readiness")):
        raise InvalidArgument((seen and seen[0].problem) or "the server ended the stream before the patient was made: try again")
    report = seen[0].report
    return Patient(seen[0], Table.of(report.readiness.findings), Table.of(report.surfaces), Table.of(report.ribs))


def _meanings(path: str, map: str, labels: Mapping[int, str]) -> Operation[list[patient_pb2.LabelMeaning]]:
    request = patients_pb2.InspectLabelsRequest(path=path, map=map)
    choices = {each.name: each for each in (yield Call("PatientService.InspectLabels", request, LONG)).choices}
    meanings = []
    for number, name in labels.items():
        if name not in choices:
            raise InvalidArgument(f"labels: there is no structure {name!r}: {nearest(str(name), choices)}")
        meaning = patient_pb2.LabelMeaning()
        meaning.CopyFrom(choices[name])
        meaning.number = whole("labels", number, 1, 65535)
        meanings.append(meaning)
    return meanings


def _uploaded(content: bytes) -> Operation[str]:
    begin = upload_pb2.BeginUploadRequest(name="labels", size=len(content), kind=upload_pb2.UPLOAD_KIND_LABELS)
    begun = yield Call("UploadService.BeginUpload", begin)
    if not begun.upload_id:
        return begun.file.path
    for at in range(0, len(content), CHUNK):
        chunk = upload_pb2.AddUploadChunkRequest(upload_id=begun.upload_id, offset=at, chunk=content[at : at + CHUNK])
        yield Call("UploadService.AddUploadChunk", chunk)
    finish = upload_pb2.FinishUploadRequest(upload_id=begun.upload_id)
    return (yield Call("UploadService.FinishUpload", finish)).file.path


def _content(files: LabelFiles) -> bytes:
    """Returns the file, or the files as one archive."""
    paths = [path_of("files", each) for each in ([files] if isinstance(files, (str, Path)) else files)]
    if not paths:
        raise InvalidArgument("files: is empty; give a label file, a folder or several files")
    try:
        if len(paths) == 1 and not paths[0].is_dir():
            return paths[0].read_bytes()
        return _packed(paths)
    except OSError as error:
        raise InvalidArgument(f"{error.filename}: {error.strerror}") from None


def _packed(paths: Sequence[Path]) -> bytes:
    content = io.BytesIO()
    with tarfile.open(fileobj=content, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for path in paths:
            inside = sorted(each for each in path.rglob("*") if each.is_file()) if path.is_dir() else [path]
            for file in inside:
                name = str(file.relative_to(path)) if path.is_dir() else file.name
                info = tarfile.TarInfo(name[-100:])
                info.size = file.stat().st_size
                with open(file, "rb") as stream:
                    archive.addfile(info, stream)
    return content.getvalue()
