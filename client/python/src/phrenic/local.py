"""A server in this process's care."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import tempfile
import threading
import time
from pathlib import Path
from typing import Optional, Sequence, Union
from urllib.parse import urlsplit

from .errors import NotStarted

_PREFIX = "phrenic-"


def binary(path: Union[str, Path, None] = None) -> str:
    """Returns phrenicd: the given one, that of $PHRENICD, of the build that this package lies in, or of the PATH.
    NotStarted if there is none."""
    built = Path(__file__).resolve().parents[3] / "phrenicd"  # build/python/src/phrenic/local.py
    for candidate in (path, os.environ.get("PHRENICD"), built if built.is_file() else None, shutil.which("phrenicd")):
        if candidate:
            found = shutil.which(str(candidate))
            if found is None:
                raise NotStarted(f"{candidate} is not a program: give the path of phrenicd")
            return found
    raise NotStarted("there is no phrenicd: install the package phrenic, run deploy/run --build-only, or set PHRENICD")


class Process:
    """phrenicd on free loopback ports, with a temporary folder. Ends with stop(), and with this process, however that
    ends: the kernel signals it (setpriv --pdeathsig). A process that is forked from this one does not end it."""

    def __init__(self, program: str, flags: Sequence[str], data: Union[str, Path, None]) -> None:
        _sweep()
        self._parent = os.getpid()
        # Not a TemporaryDirectory: the exit of a forked process would remove it.
        self._folder = tempfile.mkdtemp(prefix=f"{_PREFIX}{self._parent}-")
        self.log = Path(self._folder) / "log"
        words = [program, "--listen", "127.0.0.1:0", "--web", "127.0.0.1:0", "--start", "none", "--store", "none"]
        words += ["--spool", self._folder, "--max-sessions", "1000", "--pause-minutes", "0"]
        words += ["--data", str(data)] if data else []
        words += [word for origin in notebook_origins() for word in ("--allow-origin", origin)]
        self._words = [*_tied(), *words, *flags]
        self._process: Optional[subprocess.Popen[bytes]] = None
        self._started = threading.Event()
        # The kernel sends the signal when the thread that started the server ends, so that thread stays.
        threading.Thread(target=self._keep, name="phrenicd", daemon=True).start()
        self._started.wait()
        self.address = self._await_text("gRPC:   ")
        self.web = "http://" + self._await_text("://")

    @property
    def pid(self) -> int:
        """Process id of the server."""
        assert self._process is not None
        return self._process.pid

    @property
    def runs(self) -> bool:
        """True until the server has ended, or is ending. Requires: this process started it."""
        if self._process is None or self._process.returncode is not None:
            return False
        try:  # not poll(), which is late: it leaves the end to the thread that waits, and until every thread has ended
            status = Path(f"/proc/{self._process.pid}/stat").read_text()
        except OSError:
            return False
        return status.rpartition(")")[2].split()[0] not in "ZX"

    def stop(self) -> None:
        """Ends the server and removes its folder. A second call has no effect, nor has one by a forked process."""
        if self._parent != os.getpid():
            return
        if self._process is not None and self._process.poll() is None:
            self._process.terminate()
            try:
                self._process.wait(15)
            except subprocess.TimeoutExpired:
                self._process.kill()
        shutil.rmtree(self._folder, ignore_errors=True)

    def _keep(self) -> None:
        # Settings of a server that the user runs elsewhere are not this one's.
        environment = {k: v for k, v in os.environ.items() if not k.startswith("PHRENICD")}
        try:
            with open(self.log, "wb") as log:
                self._process = subprocess.Popen(
                    self._words,
                    stdin=subprocess.DEVNULL,
                    stdout=log,
                    stderr=log,
                    env=environment,
                    start_new_session=True,  # Ctrl-C in a terminal interrupts Python alone
                )
        finally:
            self._started.set()
        self._process.wait()

    def _await_text(self, word: str) -> str:
        """Returns what the server prints after `word`, up to a slash or the end of the line."""
        deadline = time.monotonic() + 30
        while self._process is not None and self._process.poll() is None and time.monotonic() < deadline:
            _, found, rest = self.log.read_text(errors="replace").partition(word)
            if found and "\n" in rest:
                return rest.partition("\n")[0].partition("/")[0].strip()
            time.sleep(0.005)
        text = self.log.read_text(errors="replace").strip()
        self.stop()
        raise NotStarted(f"phrenicd did not start: {text or 'it ended without a message; is it the right program?'}")


def notebook_origins() -> list[str]:
    """Returns the origins of the page of the Jupyter server that started this kernel, so that it may frame the viewer;
    none in other programs."""
    parent = os.environ.get("JPY_PARENT_PID", "")
    try:
        from jupyter_core.paths import jupyter_runtime_dir
    except ImportError:
        return []
    for kind in ("jpserver", "nbserver"):
        try:
            about = json.loads(Path(jupyter_runtime_dir(), f"{kind}-{int(parent)}.json").read_text())
            return _origins_of(str(about["url"]))
        except (OSError, ValueError, KeyError, TypeError):
            continue
    return []


def _origins_of(url: str) -> list[str]:
    """The origins by which a browser may have opened the address: with both of loopback's names, if it is one.

    >>> _origins_of("http://localhost:8888/lab")
    ['http://127.0.0.1:8888', 'http://localhost:8888']
    """
    parts = urlsplit(url)
    loopback = {"127.0.0.1", "localhost"}
    port = f":{parts.port}" if parts.port else ""
    hosts = loopback if parts.hostname in loopback else {str(parts.hostname)}
    return [f"{parts.scheme}://{host}{port}" for host in sorted(hosts)]


def _tied() -> list[str]:
    """The words that tie a program's life to this process; none where util-linux has no setpriv."""
    setpriv = shutil.which("setpriv")
    return [setpriv, "--pdeathsig", "TERM"] if setpriv else []


def _sweep() -> None:
    """Removes folders of processes that were killed."""
    for folder in Path(tempfile.gettempdir()).glob(f"{_PREFIX}[0-9]*-*"):
        if not Path("/proc", folder.name.split("-")[1]).exists():
            shutil.rmtree(folder, ignore_errors=True)
