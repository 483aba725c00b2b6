"""Phrenic from Python: simulates the breathing diaphragm and returns numpy arrays.

>>> import phrenic
>>> with phrenic.Session("cube-springs") as s:
...     for frame in s.play(seconds=0.1, fps=20):
...         print(frame["cube"].positions.shape)
(8, 3)
(8, 3)

A session without a server runs on one that this process starts, and that ends with it. `phrenic.connect(address)` calls
a server that runs. `phrenic.aio` is the same for asyncio, `phrenic.gym` and `phrenic.vector` have environments for
reinforcement learning, `phrenic.notebook` shows sessions and results in Jupyter, `phrenic.motion` has motions for xarray,
Zarr and NetCDF, `phrenic.v1` the generated messages.
"""

import os
from importlib import import_module
from typing import Any

# gRPC resolves names as other programs do (nsswitch.conf); its own resolver knows DNS and /etc/hosts alone.
os.environ.setdefault("GRPC_DNS_RESOLVER", "native")
# gRPC polls an idle connection every 0.2 s instead of every 5 s. phrenicd closes a connection after three pings without
# an answer, and between two repeats of a call gRPC notices a new connection only when it polls.
os.environ.setdefault("GRPC_CLIENT_CHANNEL_BACKUP_POLL_INTERVAL_MS", "200")
# With fork support, which is gRPC's default in Python, fork() first ends gRPC's threads, and hangs if one of them waits
# for a connection.
os.environ.setdefault("GRPC_ENABLE_FORK_SUPPORT", "0")

from . import aio, errors  # noqa: E402
from .connection import Tls
from .errors import Error
from .fits import Fit, fit
from .frame import Body, Frame, State
from .jobs import Comparison, Physiology, Study
from .operations import EVERYTHING, SimulationWarning
from .patients import Patient, patient
from .runs import Run, batch
from .server import LocalServer, Server, connect, default_server, local
from .session import Session, Studies
from .table import Table
from .tissue import Tissue

__version__ = "0.1.0"
__all__ = [
    "Body",
    "Comparison",
    "EVERYTHING",
    "Error",
    "Fit",
    "Frame",
    "LocalServer",
    "Patient",
    "Physiology",
    "Run",
    "Server",
    "Session",
    "SimulationWarning",
    "State",
    "Studies",
    "Study",
    "Table",
    "Tissue",
    "Tls",
    "aio",
    "batch",
    "connect",
    "default_server",
    "errors",
    "fit",
    "local",
    "patient",
]


def __getattr__(name: str) -> Any:
    """Imports the modules that few programs need when they are first used: phrenic.motion.to_netcdf(...)."""
    if name in ("gym", "motion", "notebook", "people", "vector"):
        return import_module(f".{name}", __name__)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
