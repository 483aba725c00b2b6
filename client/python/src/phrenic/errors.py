"""Errors of calls to the server: one class a status code, each with a remedy.

>>> error = make_error("UNAUTHENTICATED", "this server has accounts")
>>> isinstance(error, PermissionError), error.code
(True, 'UNAUTHENTICATED')
>>> print(error)
this server has accounts
  pass phrenic.connect(..., token=TOKEN) or set PHRENIC_TOKEN
"""

from __future__ import annotations

import grpc


class Error(Exception):
    """A call failed. `message` is the server's text, which names the field, and often what to do; `remedy` says what to
    do where the server cannot, else it is empty."""

    code = "UNKNOWN"
    remedy = ""

    def __init__(self, message: str) -> None:
        super().__init__(message)
        self.message = message

    def __str__(self) -> str:
        return f"{self.message}\n  {self.remedy}" if self.remedy else self.message


class Cancelled(Error):
    """The call was cancelled, by the caller or because the session was deleted."""

    code = "CANCELLED"


class Unknown(Error):
    """The server failed without saying why."""

    code = "UNKNOWN"


class InvalidArgument(Error, ValueError):
    """A field is missing, outside its range or does not fit the scene; the message names it and its range."""

    code = "INVALID_ARGUMENT"


class DeadlineExceeded(Error, TimeoutError):
    """The call took longer than its deadline."""

    code = "DEADLINE_EXCEEDED"
    remedy = "allow more time with timeout=SECONDS, of the call or of phrenic.connect, or step fewer ticks a call"


class NotFound(Error, LookupError):
    """There is no such session, scene, export or file; the message lists the existing ones."""

    code = "NOT_FOUND"


class AlreadyExists(Error):
    """The id is taken."""

    code = "ALREADY_EXISTS"
    remedy = "choose another id, leave it to the server, or join the session with attach(id)"


class PermissionDenied(Error, PermissionError):
    """Another participant controls the session, or the account lacks the role."""

    code = "PERMISSION_DENIED"
    remedy = "fork() the session to change a copy of your own"


class ResourceExhausted(Error):
    """A limit of the server is reached; the message names it and what to do."""

    code = "RESOURCE_EXHAUSTED"


class FailedPrecondition(Error):
    """What the call needs is not so: the session has diverged, the tick is past, an export is not done. The message says
    what, and what to do."""

    code = "FAILED_PRECONDITION"


class Closed(FailedPrecondition):
    """The session, the connection or its server was closed by this program; the message says which, and what to do."""


class Aborted(Error):
    """The expected tick or revision is stale, or another caller steps the session."""

    code = "ABORTED"
    remedy = "read the state with frame() and repeat, or fork() the session to have it alone"


class OutOfRange(Error):
    """The session diverged during the call; the message says when, where and why, and which time step to set."""

    code = "OUT_OF_RANGE"


class Unimplemented(Error, NotImplementedError):
    """The server does not know the call."""

    code = "UNIMPLEMENTED"
    remedy = "the server is older than this package: install the same version of both"


class Internal(Error):
    """A fault of the server."""

    code = "INTERNAL"


class Unavailable(Error, ConnectionError):
    """No server answers at the address, or it is stopping."""

    code = "UNAVAILABLE"
    remedy = "start a server with deploy/run or phrenicd, check the address, or use phrenic.local()"


class NotStarted(Unavailable):
    """phrenicd was not found or did not start; the message has its own text."""

    remedy = ""


class DataLoss(Error):
    """A file arrived damaged."""

    code = "DATA_LOSS"
    remedy = "repeat the transfer"


class Unauthenticated(Error, PermissionError):
    """The server has accounts, and the call had no valid token."""

    code = "UNAUTHENTICATED"
    remedy = "pass phrenic.connect(..., token=TOKEN) or set PHRENIC_TOKEN"


_CLASSES = {each.code: each for each in Error.__subclasses__()}  # Closed and NotStarted have no code of their own


def make_error(code: str, message: str) -> Error:
    """Returns the error of a status code, given by its name."""
    return _CLASSES.get(code, Unknown)(message)


def error_of(error: grpc.RpcError) -> Error:
    """Returns the typed error of a failed call."""
    return make_error(error.code().name, error.details() or "")
