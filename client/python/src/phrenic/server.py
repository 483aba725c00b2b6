"""Servers: one that runs, or one in this process's care."""

from __future__ import annotations

import atexit
import os
import threading
from pathlib import Path
from typing import Any, Mapping, Optional, Sequence, Union

from .arguments import names_of
from .call import FIRST, RETRIES, Call, one
from .connection import Channel, Connection, Tls, target_of
from .local import Process, binary
from .operations import Scene, SessionOperations, attach, describe, scenes, session_ids
from .session import Session
from .table import Table
from .v1 import server_pb2, session_pb2


class ServerFacts:
    """What the blocking and the async server share: what a server says of itself."""

    connection: Channel
    about: server_pb2.GetServerResponse

    @property
    def address(self) -> str:
        """HOST:PORT."""
        return self.connection.target.host

    @property
    def version(self) -> str:
        """Of the server."""
        return self.about.version

    def viewer(self, session: SessionOperations) -> str:
        """Returns the address at which a browser shows the session; empty if the server serves no viewer."""
        scheme = "https" if self.about.encrypted else "http"
        host = self.address.rpartition(":")[0]
        return f"{scheme}://{host}:{self.about.web_port}/?session={session.id}" if self.about.web_port else ""


class Server(ServerFacts):
    """A server that is called. Thread-safe. Close it, or use `with`."""

    connection: Connection

    def __init__(self, connection: Connection) -> None:
        self.connection = connection
        request = server_pb2.GetServerRequest()
        try:
            self.about = connection.run(one(Call("ServerService.GetServer", request, repeats=FIRST)))
        except BaseException:
            connection.close()
            raise

    def scenes(self) -> Table:
        """The catalogue: name, title, description, presets."""
        return self.connection.run(scenes())

    def describe(
        self, scene: Scene, resolution_mm: Optional[float] = None, physique: Optional[Mapping[str, Any]] = None
    ) -> session_pb2.DescribeSceneResponse:
        """Compiles a scene: what runs, what was left out and why, the largest stable step (report.stable_step)."""
        return self.connection.run(describe(scene, resolution_mm, physique))

    def sessions(self) -> list[str]:
        """Ids of the sessions that the caller may see."""
        return self.connection.run(session_ids())

    def attach(self, id: str) -> Session:
        """Joins a session that another client made; closing it does not delete it."""
        return Session._of(self.connection, self.connection.run(attach(id)), "", owned=False)

    def close(self) -> None:
        """Ends the connection."""
        self.connection.close()

    def __enter__(self) -> "Server":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self.version} at {self.address}>"


class LocalServer(Server):
    """phrenicd in this process's care: close() ends it."""

    def __init__(self, process: Process) -> None:
        self.process = process
        try:
            super().__init__(Connection(target_of(process.address, retries=0)))
        except BaseException:
            process.stop()
            raise
        atexit.register(self.close)

    def close(self) -> None:
        """Ends the connection and the server. A process that was forked from the one that started it does not end it."""
        atexit.unregister(self.close)
        super().close()
        self.process.stop()


def connect(
    address: str = "127.0.0.1:50051",
    *,
    token: Optional[str] = None,
    tls: Union[bool, str, Path, Tls, None] = None,
    timeout: float = 120,
    retries: int = RETRIES,
) -> Server:
    """Connects to a server that runs. `address`: HOST:PORT, or https://HOST:PORT with encryption. `token`: of an account;
    default PHRENIC_TOKEN. `tls`: True, a file of certificate authorities, or Tls(ca, cert, key). `timeout`: deadline of a
    call that does not compute [s]. `retries`: how often a call is repeated while the server is unavailable, for about a
    minute by default; a change takes effect once. Unavailable if no server answers the first call within about 2 s.

    >>> connect("127.0.0.1:1", retries=0)
    Traceback (most recent call last):
        ...
    phrenic.errors.Unavailable: ...
    """
    return Server(Connection(target_of(address, token, tls, timeout, retries)))


def local(
    *, data: Union[str, Path, None] = None, program: Union[str, Path, None] = None, flags: Sequence[str] = ()
) -> LocalServer:
    """Starts phrenicd on free ports of this machine with a temporary folder; it ends with close(), with a `with` block,
    or with this process, also if that crashes. `data`: the folder of surface files and scenes. `program`: phrenicd,
    default $PHRENICD, that of this build, or of the PATH. `flags`: those of `phrenicd --help`.

    >>> with local() as server:
    ...     "thorax" in server.scenes()["name"]
    True
    """
    return LocalServer(Process(binary(program), names_of("flags", flags), data))


_default: Optional[Server] = None
_lock = threading.Lock()


def default_server() -> Server:
    """The server of sessions that name none: that of PHRENIC_SERVER, else one that is started at the first use, and again
    if it was closed or has crashed; sessions of the one before have ended with it. Thread-safe."""
    global _default
    with _lock:
        if _default is not None and not _usable(_default):
            _default.close()
            _default = None
        if _default is None:
            address = os.environ.get("PHRENIC_SERVER", "")
            _default = connect(address) if address else local()
        return _default


def _usable(server: Server) -> bool:
    return not server.connection.closed and (not isinstance(server, LocalServer) or server.process.runs)


def _forget_default() -> None:
    """In a forked process: the parent has the server, and perhaps the lock."""
    global _default, _lock
    _default, _lock = None, threading.Lock()


os.register_at_fork(after_in_child=_forget_default)
