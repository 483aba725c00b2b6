"""The channel to a server: address, encryption, token, deadlines, repeats."""

from __future__ import annotations

import ctypes
import ipaddress
import os
import time
import weakref
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Iterator, Optional, TypeVar, Union

import grpc

from .call import RETRIES, SERVICES, Call, Operation, delay_before_repeat
from .arguments import path_of, positive, text_of, whole
from .errors import Closed, FailedPrecondition, InvalidArgument, error_of

T = TypeVar("T")


@dataclass(frozen=True)
class Tls:
    """Encryption. Files are in PEM."""

    ca: Union[str, Path, None] = None
    """Certificate authorities; None: those of gRPC."""
    cert: Union[str, Path, None] = None
    key: Union[str, Path, None] = None
    """The client's certificate, if the server requires one."""


@dataclass(frozen=True)
class Target:
    """Where a server is and how it is called."""

    host: str
    """HOST:PORT."""
    tls: Optional[Tls]
    metadata: tuple[tuple[str, str], ...] = field(repr=False)
    timeout: float
    """Deadline of a call that does not compute [s]."""
    retries: int


def target_of(
    address: str,
    token: Optional[str] = None,
    tls: Union[bool, str, Path, Tls, None] = None,
    timeout: float = 120,
    retries: int = RETRIES,
) -> Target:
    """Reads an address and the environment: PHRENIC_TOKEN, PHRENIC_JOIN.

    >>> target_of("https://phrenic.example.org:443", token="t").host
    'phrenic.example.org:443'
    >>> target_of("phrenic.example.org:50051", token="t")
    Traceback (most recent call last):
        ...
    phrenic.errors.InvalidArgument: the token would be sent to phrenic.example.org:50051 unencrypted, readable by others
    on the network; use https://phrenic.example.org:50051
    """
    scheme, _, host = text_of("address", address).rpartition("://")
    if scheme not in ("", "http", "https") or not host.rpartition(":")[2].isdigit():
        raise InvalidArgument(f"{address} is not HOST:PORT or https://HOST:PORT")
    if scheme == "https" and not tls:
        tls = True
    encryption = None if not tls else tls if isinstance(tls, Tls) else Tls() if tls is True else Tls(ca=tls)
    token = _secret("token", text_of("token", token or "") or os.environ.get("PHRENIC_TOKEN", ""))
    join = _secret("PHRENIC_JOIN", os.environ.get("PHRENIC_JOIN", ""))
    timeout, retries = positive("timeout", timeout), whole("retries", retries)
    metadata = tuple(p for p in (("authorization", f"Bearer {token}"), ("x-join", join)) if p[1] not in ("", "Bearer "))
    if metadata and encryption is None and not _is_loopback(host):
        raise InvalidArgument(
            f"the token would be sent to {host} unencrypted, readable by others\non the network; use https://{host}"
        )
    return Target(host, encryption, metadata, timeout, retries)


def _secret(name: str, value: str) -> str:
    """Returns the value if a header can have it. InvalidArgument, which does not show it, if not."""
    if not all("!" <= letter <= "~" for letter in value):
        raise InvalidArgument(
            f"{name}: it has a space, a line break or another character that no token has: "
            "take the text that was given to you alone, as by .strip()"
        )
    return value


def _is_loopback(host: str) -> bool:
    name = host.rpartition(":")[0].strip("[]")
    try:
        return name == "localhost" or ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False


def channel_options() -> list[tuple[str, Any]]:
    """As the command line has them, but for a shorter wait between two attempts to connect."""
    return [
        ("grpc.max_receive_message_length", -1),
        ("grpc.enable_http_proxy", 0),
        ("grpc.initial_reconnect_backoff_ms", 100),
        ("grpc.max_reconnect_backoff_ms", 300),
        ("grpc.keepalive_time_ms", 10_000),  # detects a broken connection while nothing is sent
        ("grpc.keepalive_timeout_ms", 3_000),
    ]


def credentials_of(tls: Tls) -> grpc.ChannelCredentials:
    """Reads the files. InvalidArgument names one that cannot be read."""

    def read(path: Union[str, Path, None]) -> Optional[bytes]:
        try:
            return path_of("tls", path).read_bytes() if path else None
        except OSError as error:
            raise InvalidArgument(f"tls: {path} cannot be read: {error.strerror}") from None

    return grpc.ssl_channel_credentials(read(tls.ca), read(tls.key), read(tls.cert))


FORKED = (
    "this process was forked from one that had called a server, and gRPC's connections do not outlive a fork: start "
    'processes by multiprocessing.get_context("spawn"), or fork before the first call'
)
_first_process = 0  # that has made a channel; a forked process inherits it
_grpc_objects: weakref.WeakSet[Any] = weakref.WeakSet()


def _noted(grpc_object: T) -> T:
    _grpc_objects.add(grpc_object)
    return grpc_object


def _keep_alive() -> None:
    """In a forked process: threads that only the parent has may hold gRPC's locks, and `__del__` of gRPC's objects would
    wait for these locks forever. So the objects are never finalised here, also when the process ends."""
    for grpc_object in list(_grpc_objects):
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(grpc_object))


os.register_at_fork(after_in_child=_keep_alive)


def check_process() -> None:
    """Notes that this process uses gRPC. FailedPrecondition if it was forked from one that did."""
    global _first_process
    _first_process = _first_process or os.getpid()
    if _first_process != os.getpid():
        raise FailedPrecondition(FORKED)


class Channel:
    """What both connections share: a channel of gRPC and its stubs."""

    def __init__(self, target: Target, api: Any) -> None:
        """`api`: grpc or grpc.aio."""
        self.target = target
        self._process, self._closed = os.getpid(), False
        check_process()
        self._channel = _noted(
            api.secure_channel(target.host, credentials_of(target.tls), channel_options())
            if target.tls
            else api.insecure_channel(target.host, channel_options())
        )
        self._stubs = {name: make(self._channel) for name, make in SERVICES.items()}

    def open(self, call: Call, timeout: Optional[float] = None) -> Any:
        """Starts a call; returns its answer, or the messages of a streaming one. Without `timeout` [s] it has no
        deadline."""
        metadata = [*self.target.metadata, *call.metadata]
        answer = self._method(call)(call.request, timeout=timeout, metadata=metadata)
        return _noted(answer) if isinstance(answer, (grpc.Call, grpc.aio.Call)) else answer

    def converse(self, call: Call, *requests: Any) -> Any:
        """Starts a call whose requests are a stream, routed and without a deadline; returns its answers. `requests`: their
        iterator, for the blocking client."""
        metadata = [*self.target.metadata, *call.metadata]
        return _noted(self._method(call)(*requests, metadata=metadata))

    def cancel(self, answers: Any) -> None:
        """Ends a call. Has no effect in a forked process, whose parent has the call."""
        if self._process == os.getpid():
            answers.cancel()

    @property
    def closed(self) -> bool:
        """True after close()."""
        return self._closed

    def _method(self, call: Call) -> Any:
        """Returns the stub of a call. Closed after close(), FailedPrecondition in a forked process."""
        if self._process != os.getpid():
            raise FailedPrecondition(FORKED)
        if self._closed:
            raise Closed(f"the connection to {self.target.host} is closed: make another by phrenic.connect or phrenic.local")
        service, _, method = call.method.partition(".")
        return getattr(self._stubs[service], method)


class Connection(Channel):
    """A blocking connection. Thread-safe. Does not connect before the first call."""

    asynchronous = False

    def __init__(self, target: Target) -> None:
        super().__init__(target, grpc)

    def close(self) -> None:
        """Ends the calls in progress. Has no effect in a forked process, whose parent has the connection."""
        self._closed = True
        if self._process == os.getpid():
            self._channel.close()

    def run(self, operation: Operation[T]) -> T:
        """Performs the operation's calls and returns its result."""
        try:
            call = next(operation)
            while True:
                try:
                    answer = self._perform(call)
                except BaseException as error:  # also Ctrl-C: the operation tidies up on the server
                    call = operation.throw(error)
                else:
                    call = operation.send(answer)
        except StopIteration as done:
            return done.value

    def _perform(self, call: Call) -> Any:
        attempt = 0
        while True:
            try:
                return self._once(call)
            except grpc.RpcError as failed:
                error = error_of(failed)
                delay = delay_before_repeat(call, error, attempt, self.target.retries)
                if delay is None:
                    raise error from None
            time.sleep(delay)
            attempt += 1

    def _once(self, call: Call) -> Any:
        answer = self.open(call, call.deadline or self.target.timeout)
        if call.each is None:
            return answer
        try:
            for message in answer:
                call.each(message)
        finally:  # a receiver that raises ends the call
            self.cancel(answer)
        return None

    def stream(self, call: Call) -> Iterator[Any]:
        """Yields the messages of a streaming call as they come; the server waits while none is taken. A loop that breaks
        ends the call. Nothing is repeated after a lost connection."""
        messages = self.open(call, call.deadline)
        try:
            yield from messages
        except grpc.RpcError as failed:
            raise error_of(failed) from None
        finally:
            self.cancel(messages)
