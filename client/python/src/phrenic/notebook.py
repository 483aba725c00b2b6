"""Sessions and results in notebooks.

    from phrenic import notebook
    notebook.view(s)                                     # the viewer of a session, in the page
    notebook.player(s)                                   # a breath that plays in the page, also without a server
    notebook.plot(s.play(seconds=4), "lung volume")      # measures over time

A page may frame a viewer if phrenicd was started with `--allow-origin` and the page's origin. The server that
phrenic.local() starts from a kernel of Jupyter allows Jupyter's own page; where that is elsewhere (Visual Studio Code,
JupyterHub), start it with phrenic.local(flags=["--allow-origin", "https://HOST"]).
"""

from __future__ import annotations

import io
import urllib.request
from html import escape
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any, Iterable, Mapping, Optional, Sequence, Union
from urllib.parse import urlsplit

import numpy as np

from .call import Call, one
from .errors import Error, FailedPrecondition, InvalidArgument
from .frame import Frame
from .names import enum_number, look_up
from .optional import need
from .runs import Run
from .server import Server
from .session import Session
from .v1 import access_pb2

Series = Union[Run, Iterable[Frame]]


class View:
    """A viewer in a notebook's page."""

    def __init__(self, address: str, height: int = 600, problem: str = "") -> None:
        """`problem`: why the page cannot frame it; empty if nothing is known of one."""
        self.address = address
        self.height = height
        self.problem = problem

    def _repr_html_(self) -> str:
        """As notebooks show it: the viewer, or why it cannot be there, and a link to it."""
        address = escape(self.address)
        frame = f'<iframe src="{address}" title="Viewer" width="100%" height="{self.height}" style="border:0"></iframe>'
        shown = f"<p>{escape(self.problem)}</p>" if self.problem else frame
        link = f'<a href="{address}" target="_blank" rel="noopener">Open in a tab of its own</a>'
        return f"{shown}<p>{link}, while its server runs. For a page that is kept: phrenic.notebook.player.</p>"

    def __repr__(self) -> str:
        return self.address


def view(session: Union[Session, str], height: int = 600, role: str = "", hours: float = 2) -> View:
    """Returns the viewer of a session, `height` pixels high, as the last value of a notebook's cell shows it.

    `session`: a Session, or the address of a viewer. `role`: "viewer" or "controller" adds a join link, by which readers
    of the notebook are admitted for `hours`, on a server with accounts; without it the viewer asks for a token.
    FailedPrecondition if the server serves no viewer."""
    if isinstance(session, str):
        if urlsplit(session).scheme not in ("http", "https"):
            raise InvalidArgument(f"session: {session} is not an address that begins with http:// or https://")
        return View(session, height, problem_of(session))
    server = Server(session._connection)
    address = server.viewer(session)
    if not address or not server.about.viewer_is_built:
        remedy = "build it with deploy/run, or start phrenicd with --web"
        raise FailedPrecondition(f"{server.address} serves no viewer: {remedy}")
    return View(address + _joined(session, role, hours), height, problem_of(address))


class Player:
    """A motion that plays in a notebook's page. It needs no server and no network, so that a page that nbconvert writes
    plays it too."""

    def __init__(self, page: str, height: int = 600) -> None:
        """`page`: of Session.export("motion.html")."""
        self.page = page
        self.height = height

    def save(self, path: Union[str, Path]) -> None:
        """Writes the page as a file of its own."""
        Path(path).write_text(self.page, encoding="utf-8")

    def _repr_html_(self) -> str:
        """As notebooks show it. The frame has an origin of its own: its script sees nothing of the notebook's page."""
        style = f'width="100%" height="{self.height}" style="border:0"'
        return f'<iframe srcdoc="{escape(self.page)}" sandbox="allow-scripts" title="Motion" {style}></iframe>'

    def __repr__(self) -> str:
        return f"<Player of {len(self.page) / 1e6:.1f} MB>"


def player(session: Session, seconds: float = 0, height: int = 600, **options: Any) -> Player:
    """Returns `seconds` of a session from now on, or one breath, as a motion that plays in the page, `height` pixels high.
    About 1 MB and the motion. `options`: those of Session.export. FailedPrecondition if the server's viewer is not built."""
    with TemporaryDirectory() as folder:
        path = Path(folder, f"{session.scene}.html")
        session.export(path, seconds=seconds, **options)
        return Player(path.read_text(encoding="utf-8"), height)


def shown(session: Session) -> Optional[str]:
    """Returns the session as notebooks show it (Session._repr_html_): its viewer, or None, for its text, where the server
    serves none or does not answer."""
    try:
        return view(session)._repr_html_()
    except Error:
        return None


def _joined(session: Session, role: str, hours: float) -> str:
    """The part of an address that admits to the session; empty without a role."""
    if not role:
        return ""
    request = access_pb2.CreateLinkRequest(
        session_id=session.id,
        role=enum_number(access_pb2.AccessRole.DESCRIPTOR, role),
        time_to_live=3600 * hours,
    )
    answer = session._connection.run(one(Call("AccessService.CreateLink", request, repeatable=False)))
    return f"#join={answer.secret}"


def problem_of(address: str) -> str:
    """Returns why a page cannot frame the viewer, as far as its headers tell; empty if they do not."""
    try:
        with urllib.request.urlopen(urllib.request.Request(address, method="HEAD"), timeout=3) as answer:
            policy = answer.headers.get("Content-Security-Policy", "")
    except (OSError, ValueError):
        return ""  # the browser may reach what this machine does not
    if "frame-ancestors 'none'" not in policy:
        return ""
    return (
        "This server does not let pages frame its viewer. Start phrenicd with --allow-origin and the origin of this page, "
        'or phrenic.local(flags=["--allow-origin", "http://HOST:PORT"]).'
    )


class Plot:
    """A picture in a notebook's page. `figure` is matplotlib's, to change it; save() writes a file."""

    def __init__(self, figure: Any) -> None:
        self.figure = figure

    def save(self, path: Union[str, Path], **options: Any) -> None:
        """Writes a picture, whose ending chooses the format (.png, .svg, .pdf)."""
        self.figure.savefig(path, **options)

    def _repr_png_(self) -> bytes:
        picture = io.BytesIO()
        self.figure.savefig(picture, format="png", dpi=100)
        return picture.getvalue()


def plot(of: Union[Series, Sequence[Run], Mapping[str, Series]], *measures: str) -> Plot:
    """Returns measures over time, a panel each (default: all). `of`: frames, a run of a batch, several runs, or a dict of
    either by the names of their curves. Requires: matplotlib is installed. NotFound names the nearest measure."""
    need("matplotlib", "plot", "apt install python3-matplotlib, or pip install matplotlib")
    from matplotlib.figure import Figure

    curves = _curves(of)
    if not curves:
        raise InvalidArgument("of: there is nothing to plot")
    names = measures or tuple(next(iter(curves.values()))[1])
    figure = Figure(figsize=(7, 2.2 * max(len(names), 1) + 0.4), layout="constrained")
    panels = figure.subplots(max(len(names), 1), sharex=True, squeeze=False)[:, 0]
    for axes, name in zip(panels, names):
        for label, (times, values, units) in curves.items():
            axes.plot(times, look_up(values, name, "measure"), label=label)
            axes.set_ylabel(f"{name} [{units[name]}]" if name in units else name)
    panels[-1].set_xlabel("time [s]")
    if len(curves) > 1:
        panels[0].legend(fontsize="small", loc="upper left", bbox_to_anchor=(1, 1))
    return Plot(figure)


Curves = tuple[np.ndarray, Mapping[str, np.ndarray], Mapping[str, str]]


def _curves(of: Any) -> dict[str, Curves]:
    """Times, measures and their units by the names of the curves."""
    if isinstance(of, Mapping):
        return {str(name): _curve(each) for name, each in of.items()}
    if isinstance(of, Run):
        return {"": _curve(of)}
    items = list(of)
    if items and isinstance(items[0], Run):
        return {_label(run): _curve(run) for run in items}
    return {"": _curve(items)} if items else {}


def _label(run: Run) -> str:
    return ", ".join(f"{name} {value}" for name, value in run.parameters.items()) or f"run {run.index}"


def _curve(series: Series) -> Curves:
    if isinstance(series, Run):
        return series.times, series.measures, {}
    frames: list[Frame] = list(series)
    if not frames:
        raise InvalidArgument("of: a series has no frame")
    values = {name: np.array([frame.measures[name] for frame in frames]) for name in frames[0].measures}
    return np.array([frame.time for frame in frames]), values, frames[0].units
