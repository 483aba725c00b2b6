"""The channel to a server: address, encryption, token, deadlines, repeats."""

from __future__ import annotations

import ipaddress
import os
import time
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Iterator, Optional, TypeVar, Union

import grpc

from .call import SERVICES, Call, Operation, delay_before_repeat
from .errors import InvalidArgument, error_of

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
    metadata: tuple[tuple[str, str], ...]
    timeout: float
    """Deadline of a call that does not compute [s]."""
    retries: int


def target_of(
    address: str,
    token: Optional[str] = None,
    tls: Union[bool, str, Path, Tls, None] = None,
    timeout: float = 120,
    retries: int = 5,
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
    scheme, _, host = address.rpartition("://")
    if scheme not in ("", "http", "https") or not host.rpartition(":")[2].isdigit():
        raise InvalidArgument(f"{address} is not HOST:PORT or https://HOST:PORT")
    if scheme == "https" and not tls:
        tls = True
    encryption = None if not tls else tls if isinstance(tls, Tls) else Tls() if tls is True else Tls(ca=tls)
    token = token or os.environ.get("PHRENIC_TOKEN", "")
    join = os.environ.get("PHRENIC_JOIN", "")
    metadata = tuple(p for p in (("authorization", f"Bearer {token}"), ("x-join", join)) if p[1] not in ("", "Bearer "))
    if metadata and encryption is None and not _is_loopback(host):
        raise InvalidArgument(
            f"the token would be sent to {host} unencrypted, readable by others\non the network; use https://{host}"
        )
    return Target(host, encryption, metadata, timeout, retries)


def _is_loopback(host: str) -> bool:
    name = host.rpartition(":")[0].strip("[]")
    try:
        return name == "localhost" or ipaddress.ip_address(name).is_loopback
    except ValueError:
        return False


def channel_options() -> list[tuple[str, Any]]:
    """As the command line has them."""
    return [
        ("grpc.max_receive_message_length", -1),
        ("grpc.enable_http_proxy", 0),
        ("grpc.initial_reconnect_backoff_ms", 100),
        ("grpc.max_reconnect_backoff_ms", 1000),
        ("grpc.keepalive_time_ms", 10_000),  # detects a broken connection while nothing is sent
        ("grpc.keepalive_timeout_ms", 3_000),
    ]


def credentials_of(tls: Tls) -> grpc.ChannelCredentials:
    """Reads the files. InvalidArgument names one that cannot be read."""

    def read(path: Union[str, Path, None]) -> Optional[bytes]:
        try:
            return Path(path).read_bytes() if path else None
        except OSError as error:
            raise InvalidArgument(f"tls: {path} cannot be read: {error.strerror}") from None

    return grpc.ssl_channel_credentials(read(tls.ca), read(tls.key), read(tls.cert))


class Channel:
    """What both connections share: a channel of gRPC and its stubs."""

    def __init__(self, target: Target, api: Any) -> None:
        """`api`: grpc or grpc.aio."""
        self.target = target
        self._channel = (
            api.secure_channel(target.host, credentials_of(target.tls), channel_options())
            if target.tls
            else api.insecure_channel(target.host, channel_options())
        )
        self._stubs = {name: make(self._channel) for name, make in SERVICES.items()}

    def open(self, call: Call, timeout: Optional[float] = None) -> Any:
        """Starts a call; returns its answer, or the messages of a streaming one. Without `timeout` [s] it has no
        deadline."""
        service, _, method = call.method.partition(".")
        metadata = [*self.target.metadata, *call.metadata]
        return getattr(self._stubs[service], method)(call.request, timeout=timeout, metadata=metadata)

    def converse(self, call: Call, *requests: Any) -> Any:
        """Starts a call whose requests are a stream, routed and without a deadline; returns its answers. `requests`: their
        iterator, for the blocking client."""
        service, _, method = call.method.partition(".")
        metadata = [*self.target.metadata, *call.metadata]
        return getattr(self._stubs[service], method)(*requests, metadata=metadata)


class Connection(Channel):
    """A blocking connection. Thread-safe. Does not connect before the first call."""

    def __init__(self, target: Target) -> None:
        super().__init__(target, grpc)

    def close(self) -> None:
        """Ends the calls in progress."""
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
            answer.cancel()
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
            messages.cancel()
