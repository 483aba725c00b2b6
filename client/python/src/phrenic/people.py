"""The breaths of many people, fitted and judged on the server with the numbers of `phrenic study motion`.

    study = phrenic.people.study("landmarks", modes=12)
    study.held_out_mm, study.from_one_number_mm, study.people["name"]
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, Mapping, Optional, Union

from .arguments import INT32, mapping, text_of, whole
from .call import LONG, Call, Operation
from .errors import InvalidArgument
from .fits import Landmarks, landmark_files
from .jobs import Progress
from .operations import Scene, check_server, source_of
from .table import Table
from .v1 import fit_pb2, session_pb2

if TYPE_CHECKING:
    from .server import Server

ENDINGS = (".csv", ".fcsv", ".mrk.json")


@dataclass(frozen=True)
class MotionStudy:
    """What is left of many people's breaths, on landmarks that were not fitted."""

    people: Table
    """A row a person: name, pairs, held_out_mm, held_out_p95_mm, from_one_number_mm, and the baselines [mm]."""
    held_out_mm: float
    """Mean over people."""
    from_one_number_mm: Optional[float]
    """The same, each predicted from the descent and the others; None with one person."""
    messages: list[fit_pb2.MotionOfPerson]
    """Each person's fit, as the API has it."""
    together: fit_pb2.MotionOfPeople
    """What they have in common."""


def study(
    cases: Union[str, Path, Mapping[str, Landmarks]],
    scene: Scene = "thorax",
    *,
    modes: int = 8,
    split: int = 1,
    resolution_mm: Optional[float] = None,
    progress: Progress = None,
    server: Optional["Server"] = None,
) -> MotionStudy:
    """Fits and judges people: `cases` is a folder with a file of pairs a person, or landmarks by name, as phrenic.fit
    takes them. A `progress` that raises ends it."""
    if server is None:
        from .server import default_server

        server = default_server()
    check_server(server)
    return server.connection.run(studied(source_of(scene, resolution_mm), cases, modes, split, progress))


def studied(
    source: session_pb2.SceneSource,
    cases: Union[str, Path, Mapping[str, Landmarks]],
    modes: int,
    split: int,
    progress: Progress,
) -> Operation[MotionStudy]:
    """The operation of study()."""
    given = _in_folder(Path(cases)) if isinstance(cases, (str, Path)) else cases
    request = fit_pb2.StudyMotionRequest(
        source=source, modes=whole("modes", modes, most=INT32), split=whole("split", split, most=INT32)
    )
    for name, landmarks in mapping("cases", given).items():
        request.cases.add(name=text_of("cases", name), landmarks=landmark_files(landmarks))
    people: dict[str, fit_pb2.MotionOfPerson] = {}  # by name: a call that is repeated brings them again
    last: list[fit_pb2.MotionOfPeople] = []

    def note(event: fit_pb2.StudyMotionResponse) -> None:
        if event.HasField("person"):
            people[event.person.name] = event.person
        elif event.HasField("people"):
            last.append(event.people)
        elif progress:
            progress(event.progress.done, event.progress.doing)

    yield Call("FitService.StudyMotion", request, LONG, note)
    together = last[-1]
    one = together.from_one_number.mean_mm if together.HasField("from_one_number") else None
    each = list(people.values())
    return MotionStudy(Table(map(_row, each)), together.held_out.mean_mm, one, each, together)


def _row(person: fit_pb2.MotionOfPerson) -> dict[str, Any]:
    return {
        "name": person.name,
        "pairs": person.pairs,
        "held_out_mm": person.fit.held_out.mean_mm,
        "held_out_p95_mm": person.fit.held_out.p95_mm,
        "from_one_number_mm": person.from_one_number.mean_mm if person.HasField("from_one_number") else None,
        **{baseline.name: baseline.mean_mm for baseline in person.fit.baselines},
    }


def _in_folder(folder: Path) -> dict[str, Landmarks]:
    if not folder.is_dir():
        raise InvalidArgument(f"{folder}: is no folder")
    files = sorted(path for path in folder.iterdir() if path.name.lower().endswith(ENDINGS))
    if not files:
        raise InvalidArgument(f"{folder} has no .csv, .fcsv or .mrk.json of landmark pairs")
    return {path.name.split(".")[0]: path for path in files}
