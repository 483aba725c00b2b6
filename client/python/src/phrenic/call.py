"""Calls as values. An operation is a generator that yields calls and receives their answers, so that the blocking and
the async client share every line but the one that waits."""

from __future__ import annotations

import logging
import random
import re
import uuid
from dataclasses import dataclass
from typing import Any, Callable, Generator, Optional, TypeVar

from google.protobuf.message import Message

from .errors import Error, Unavailable
from .v1 import (
    access_pb2_grpc,
    compare_pb2_grpc,
    export_pb2_grpc,
    fit_pb2_grpc,
    frames_pb2_grpc,
    patients_pb2_grpc,
    samples_pb2_grpc,
    server_pb2_grpc,
    session_pb2_grpc,
    study_pb2_grpc,
    tissue_pb2_grpc,
    upload_pb2_grpc,
)

SERVICES: dict[str, Callable[[Any], Any]] = {
    "AccessService": access_pb2_grpc.AccessServiceStub,
    "CompareService": compare_pb2_grpc.CompareServiceStub,
    "ExportService": export_pb2_grpc.ExportServiceStub,
    "FitService": fit_pb2_grpc.FitServiceStub,
    "FrameService": frames_pb2_grpc.FrameServiceStub,
    "PatientService": patients_pb2_grpc.PatientServiceStub,
    "SampleService": samples_pb2_grpc.SampleServiceStub,
    "SceneService": session_pb2_grpc.SceneServiceStub,
    "ServerService": server_pb2_grpc.ServerServiceStub,
    "SessionService": session_pb2_grpc.SessionServiceStub,
    "StudyService": study_pb2_grpc.StudyServiceStub,
    "TissueService": tissue_pb2_grpc.TissueServiceStub,
    "UploadService": upload_pb2_grpc.UploadServiceStub,
}

LONG = 3600.0
"""Deadline of calls that compute: steps, compiling, studies, exports [s]."""

T = TypeVar("T")
Operation = Generator["Call", Any, T]
"""Yields calls, receives their answers, and returns a T."""


@dataclass
class Call:
    """One call of the API."""

    method: str
    """"SessionService.StepSession"."""
    request: Message
    deadline: Optional[float] = None
    """[s]; None: the connection's."""
    each: Optional[Callable[[Any], None]] = None
    """For a streaming call: receives each message. The answer is then None."""
    repeatable: bool = True
    """True if a repeat after a lost connection changes nothing more."""
    repeats: Optional[int] = None
    """The most repeats; None: the connection's `retries`."""
    passing: tuple[type[Error], ...] = ()
    """Errors beside Unavailable after which the call is repeated."""

    @property
    def metadata(self) -> list[tuple[str, str]]:
        """`x-session-id`, by which a proxy routes the call to the server that has the session."""
        session = getattr(self.request, "session_id", "")
        return [("x-session-id", session)] if session and session.isascii() and session.isprintable() else []


RETRIES = 160
"""Repeats of a call while the server is unavailable, which take about a minute, as long as the command line waits."""
FIRST = 6
"""Repeats of the first call of a connection, about 2 s: an address without a server is an error soon."""


def delay_before_repeat(call: Call, error: Error, attempt: int, retries: int) -> Optional[float]:
    """Returns how long to wait before the call is repeated [s], or None if the error is final. Calls are repeated after
    UNAVAILABLE and after the call's `passing` errors, with delays of 0.1, 0.2, 0.4 ... s with jitter, at most 0.5 s. All
    calls follow this rule, batches too. The logger "phrenic" warns once, after about 1 s."""
    most = retries if call.repeats is None else min(call.repeats, retries)
    if not isinstance(error, (Unavailable, *call.passing)) or not call.repeatable or attempt >= most:
        return None
    if attempt == 4 and most > FIRST:
        logging.getLogger("phrenic").warning("%s; repeating %s up to %d times", error.message, call.method, most)
    return min(0.5, 0.1 * 2 ** min(attempt, 10)) * random.uniform(0.5, 1)


def new_id(stem: str) -> str:
    """Returns an id that nothing else on a server has, by which a repeated call makes it once: `stem` and 48 random bits.

    >>> len(new_id("thorax")), new_id("My scene")[:9]
    (19, 'my-scene-')
    """
    name = re.sub(r"[^a-z0-9]+", "-", stem.lower()).strip("-")[:40].strip("-")
    return f"{name or 'new'}-{uuid.uuid4().hex[:12]}"


def one(call: Call) -> Operation[Any]:
    """The operation of a single call."""
    return (yield call)
