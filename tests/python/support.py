"""One server for all tests of this process, and a server whose answers a test chooses."""

from __future__ import annotations

import socket
import threading
import unittest
from concurrent import futures
from pathlib import Path
from typing import Any, Callable

import grpc

import phrenic
from phrenic.local import binary
from phrenic.v1 import server_pb2, server_pb2_grpc, session_pb2, session_pb2_grpc

REPOSITORY = Path(__file__).resolve().parents[2]
EXAMPLES = REPOSITORY / "client" / "python" / "examples"


class SessionTest(unittest.TestCase):
    """Tests that need a server use phrenic's own default one."""

    def session(self, scene: Any = "cube-springs", **options: Any) -> phrenic.Session:
        session = phrenic.Session(scene, **options)
        self.addCleanup(session.close)
        return session


class FakeServer(server_pb2_grpc.ServerServiceServicer, session_pb2_grpc.SessionServiceServicer):
    """Answers from a table of functions, and notes each call with its metadata."""

    def __init__(self, **options: Any) -> None:
        self.calls: list[tuple[str, Any, dict[str, str]]] = []
        self.answers: dict[str, Callable[[Any, grpc.ServicerContext], Any]] = {}
        self._server = grpc.server(futures.ThreadPoolExecutor(2), options=list(options.items()))
        server_pb2_grpc.add_ServerServiceServicer_to_server(self, self._server)
        session_pb2_grpc.add_SessionServiceServicer_to_server(self, self._server)
        self.address = f"127.0.0.1:{self._server.add_insecure_port('127.0.0.1:0')}"
        self._server.start()

    def stop(self) -> None:
        self._server.stop(0)

    def made(self, method: str) -> list[Any]:
        """The requests of one method."""
        return [request for name, request, _ in self.calls if name == method]

    def _answer(self, method: str, request: Any, context: grpc.ServicerContext, default: Any) -> Any:
        self.calls.append((method, request, dict(context.invocation_metadata())))
        return self.answers[method](request, context) if method in self.answers else default

    def GetServer(self, request, context):  # noqa: N802
        return self._answer("GetServer", request, context, server_pb2.GetServerResponse(version=phrenic.__version__))

    def GetSession(self, request, context):  # noqa: N802
        session = session_pb2.Session(id=request.session_id)
        return self._answer("GetSession", request, context, session_pb2.GetSessionResponse(session=session))

    def ListSessions(self, request, context):  # noqa: N802
        return self._answer("ListSessions", request, context, session_pb2.ListSessionsResponse())

    def CreateSession(self, request, context):  # noqa: N802
        answer = session_pb2.CreateSessionResponse(session={"id": "fake"}, control_token="key")
        return self._answer("CreateSession", request, context, answer)

    def ForkSession(self, request, context):  # noqa: N802
        answer = session_pb2.ForkSessionResponse(session={"id": request.fork_id}, control_token="key")
        return self._answer("ForkSession", request, context, answer)

    def PauseSession(self, request, context):  # noqa: N802
        answer = session_pb2.PauseSessionResponse(session={"id": request.session_id})
        return self._answer("PauseSession", request, context, answer)

    def StepSession(self, request, context):  # noqa: N802
        return self._answer("StepSession", request, context, session_pb2.StepSessionResponse())

    def GetState(self, request, context):  # noqa: N802
        return self._answer("GetState", request, context, session_pb2.GetStateResponse())

    def UpdateParameters(self, request, context):  # noqa: N802
        answer = session_pb2.UpdateParametersResponse(session={"id": request.session_id})
        return self._answer("UpdateParameters", request, context, answer)

    def DeleteSession(self, request, context):  # noqa: N802
        return self._answer("DeleteSession", request, context, session_pb2.DeleteSessionResponse())


class Relay:
    """A TCP relay to a server, whose connections a test can cut."""

    def __init__(self, target: str) -> None:
        host, _, port = target.rpartition(":")
        self._target = (host, int(port))
        self._listener = socket.create_server(("127.0.0.1", 0))
        self._open: list[_Pair] = []
        self._lock = threading.Lock()
        self.address = f"127.0.0.1:{self._listener.getsockname()[1]}"
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self) -> None:
        """Closes the connections; new ones are accepted."""
        with self._lock:
            for each in self._open:
                each.close_now()
            self._open.clear()

    def stop(self) -> None:
        """Closes the connections for good. A second call has no effect."""
        if self._listener.fileno() >= 0:
            self._listener.shutdown(socket.SHUT_RDWR)
            self._listener.close()
        self.cut()

    def _accept(self) -> None:
        while True:
            try:
                client, _ = self._listener.accept()
                pair = _Pair(client, socket.create_connection(self._target))
            except OSError:
                return
            with self._lock:
                self._open.append(pair)


class _Pair:
    """A connection and the one that it is relayed to."""

    def __init__(self, *ends: socket.socket) -> None:
        self._ends = ends
        for source, sink in (ends, ends[::-1]):
            threading.Thread(target=self._copy, args=(source, sink), daemon=True).start()

    def close_now(self) -> None:
        for end in self._ends:
            try:
                end.shutdown(socket.SHUT_RDWR)
            except OSError:
                pass  # it is closed
            end.close()

    def _copy(self, source: socket.socket, sink: socket.socket) -> None:
        try:
            while data := source.recv(1 << 16):
                sink.sendall(data)
        except OSError:
            pass
        self.close_now()


def failing(code: grpc.StatusCode, times: int, then: Any) -> Callable[[Any, grpc.ServicerContext], Any]:
    """An answer that fails the first `times` calls."""
    left = [times]

    def answer(request: Any, context: grpc.ServicerContext) -> Any:
        if left[0] > 0:
            left[0] -= 1
            context.abort(code, "not now")
        return then(request) if callable(then) else then

    return answer


def program(name: str) -> str:
    """A program of the build that the package lies in: beside phrenicd."""
    return str(Path(binary()).with_name(name))
