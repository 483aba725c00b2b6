"""A running simulation."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Iterator, Mapping, Optional, Sequence, Union

import grpc

from . import jobs
from .advance import Steps, frames_ahead
from .arguments import whole
from .call import T, Operation
from .connection import Connection
from .errors import error_of
from .fits import Fit, Landmarks, fitted
from .frame import Frame
from .operations import EVERYTHING, Scene, SessionOperations, check_server, create, parts_of, source_of
from .samples import Sample, SampleReader
from .tissue import Tissue, tissue
from .v1 import session_pb2, state_pb2

if TYPE_CHECKING:
    from .server import Server


class Session(SessionOperations):
    """A simulation on a server, made from a scene; deleted when the `with` block ends.

    Without `server`, it runs on the server that PHRENIC_SERVER names, else on one that this process starts and ends.
    Not thread-safe: one thread a session.

    >>> with Session("cube-springs", set={"breath_force": 1.5}) as s:
    ...     frame = s.step(10)
    ...     frame["cube"].positions.shape, frame.tick, len(frame.state_hash)
    ((8, 3), 10, 16)
    """

    def __init__(
        self,
        scene: Scene,
        *,
        set: Optional[Mapping[str, Any]] = None,
        preset: str = "",
        id: str = "",
        resolution_mm: Optional[float] = None,
        physique: Optional[Mapping[str, Any]] = None,
        server: Optional["Server"] = None,
    ) -> None:
        """`scene`: a name of the catalogue, a .textproto file or a Scene. `set`: live parameters by name. `id`: empty
        for a new one. `physique`: numbers of the generated body by name, {"height": 1.62, "sex": "female"}."""
        if server is None:
            from .server import default_server

            server = default_server()
        check_server(server)
        self._connection = server.connection
        made = self._connection.run(create(scene, set, preset, id, resolution_mm, physique))
        super().__init__(made.session, made.control_token, owned=True)
        self._source = source_of(scene, resolution_mm, physique)

    @classmethod
    def _of(
        cls,
        connection: Connection,
        status: session_pb2.Session,
        token: str,
        owned: bool,
        source: Optional[session_pb2.SceneSource] = None,
    ) -> "Session":
        session = cls.__new__(cls)
        SessionOperations.__init__(session, status, token, owned)
        session._connection = connection
        session._source = source or session_pb2.SceneSource(name=status.scene)
        return session

    def _do(self, operation: Operation[T]) -> T:
        return self._connection.run(self._ready(operation))

    def __enter__(self) -> "Session":
        return self

    def __exit__(self, *_: Any) -> None:
        self.close()

    def _repr_html_(self) -> Optional[str]:
        """What a notebook shows: the viewer of this session."""
        from .notebook import shown

        return shown(self)

    def close(self) -> None:
        """Deletes the session, unless it was joined by attach(). A second call has no effect."""
        if self._owned and not self._closed:
            self._connection.run(self._delete())
        self._closed = True

    # --- stepping ---
    def step(self, ticks: int = 1, read: Sequence[str] = EVERYTHING, timeout: Optional[float] = None) -> Frame:
        """Takes steps and returns the state after the last one without loss. `read`: parts to return; fewer are faster,
        () returns measures and the hash alone, and NaN as the phase. OutOfRange if the session diverges."""
        return self._do(self._step(ticks, read, timeout))

    def advance(self, read: Sequence[str] = EVERYTHING) -> Steps:
        """Returns a stream of steps, a context manager: an answer for each step in order, steps sent ahead, parameters
        changed by the step that they begin with. Do not use other methods that step while answers are pending."""
        self._do(self._describe(parts_of(read)))
        return Steps(self, self._connection, read)

    def play(
        self, seconds: float, fps: float = 60, read: Sequence[str] = ("bodies",), ahead: int = 0
    ) -> Iterator[Frame]:
        """Steps and yields `fps` frames a simulated second, as fast as they are taken: none is ever dropped, and the
        same call gives the same frames. run() and watch() are for real time. `ahead`: frames that the server may compute
        before the loop asks for them, with the same bits, while the loop works with the last one; a change made in the
        loop then takes effect after them, and a loop that is left leaves the session up to so many frames ahead.

        >>> with Session("cube-springs") as s:
        ...     [round(frame.time, 2) for frame in s.play(seconds=0.2, fps=10)]
        [0.1, 0.2]
        """
        if whole("ahead", ahead) != 0:
            self._do(self._describe(parts_of(read)))
            yield from frames_ahead(self, self._connection, self._frame_ticks(seconds, fps), read, ahead)
            return
        for time in self._frame_times(seconds, fps):
            yield self.step(self.ticks_until(time), read)

    # --- reading ---
    def frame(self, read: Sequence[str] = EVERYTHING) -> Frame:
        """Returns the present state without a step."""
        return self._do(self._read(read))

    def measure(self, name: str) -> float:
        """Returns one of the scene's measures, in its SI unit: measure("lung volume")."""
        return self._do(self._measure(name))

    @property
    def measures(self) -> dict[str, float]:
        """All of the scene's measures."""
        return self._do(self._measures())

    @property
    def state_hash(self) -> str:
        """64-bit hash of the state, in hexadecimal. Equal states have equal hashes."""
        return self._do(self._hash())

    def forces(self, body: str, vertex: Optional[int] = None, kind: str = "") -> Any:
        """Returns the forces on a vertex by kind, {"springs": (3,) array, ...} [N]; with `kind`, its magnitude on each
        vertex of the body [N]; with neither, the kinds."""
        return self._do(self._forces(body, vertex, kind))

    def tissue(self, points: Optional[Sequence[Sequence[float]]] = None) -> Tissue:
        """Returns how the inside of the lungs has moved since rest; `points`: at most 64 places at rest [m], read as well.
        FailedPrecondition for a scene without lung tissue. The first call takes a second or two."""
        return self._do(tissue(self, points))

    # --- changing ---
    def set(self, preset: str = "", at_tick: Optional[int] = None, **parameters: Any) -> None:
        """Changes live parameters, now or before the step from `at_tick`. A change that still waits for its tick belongs to
        this session alone: fork() and export() leave it out. Warns (SimulationWarning) of a time step above
        the largest stable one.

        >>> with Session("cube-springs") as s:
        ...     s.set(breath_force=25)
        Traceback (most recent call last):
            ...
        phrenic.errors.InvalidArgument: parameters.breath_force: 25 is outside 0 to 20
        """
        self._do(self._set(preset, at_tick, parameters))

    def pull(self, body: str, vertex: int, force: Sequence[float]) -> None:
        """Pulls a vertex with a force [N], until another call changes it."""
        self._do(self._pull(body, vertex, force))

    def release(self) -> None:
        """Releases every vertex."""
        self._do(self._release())

    def reset(self) -> None:
        """Returns to t = 0; keeps parameters and pulls, clears a divergence."""
        self._do(self._reset())

    def fork(self, id: str = "", **parameters: Any) -> "Session":
        """Returns a new session that continues from the present state, with some parameters changed. Changes that wait
        for their tick, set(at_tick=...), are not copied. After an error there is no new session.

        >>> with Session("cube-springs") as s, s.fork() as other:
        ...     s.step(20).state_hash == other.step(20).state_hash
        True
        """
        made = self._do(self._fork(id))
        fork = Session._of(self._connection, made.session, made.control_token, True, self._source)
        try:
            if parameters:
                fork.set(**parameters)
        except BaseException:
            fork.close()
            raise
        return fork

    # --- real time ---
    def run(self, speed: float = 1, until: float = 0) -> None:
        """Lets the session run on the server at `speed` simulated seconds a second (0: as fast as possible), until a
        simulated time [s] if given. pause() stops it."""
        self._do(self._run_on(speed, until))

    def pause(self) -> None:
        """Stops a session that runs."""
        self._do(self._pause())

    def watch(self, max_fps: float = 60, max_error_mm: Optional[float] = None) -> Iterator[Frame]:
        """Yields the newest frame of a session that runs, as a viewer sees it: a slow loop misses frames. Ends by
        `break`. `max_error_mm`: positions may be off by so much [mm] and come compressed, in a tenth of the bytes or less;
        None: exact. FailedPrecondition if the decoder of compressed frames is not there."""
        self._do(self._describe([state_pb2.STATE_PART_BODIES]))
        events = self._connection.open(self._watch_call(max_fps, max_error_mm))
        try:
            for event in events:
                frame = self._noted(event)
                if frame is not None:
                    yield frame
        except grpc.RpcError as failed:
            raise error_of(failed) from None
        finally:
            self._connection.cancel(events)

    def samples(self, measures: Sequence[str] = (), interval: float = 0.02) -> Iterator[Sample]:
        """Yields the session's measures, all or those named, at every `interval` of simulated time [s], whichever client
        steps it. No sample is dropped unless the loop falls 4096 samples behind; Sample.left_out counts them. Begins with
        the next multiple of the interval. Ends by `break`."""
        self._check_open()
        batches = self._connection.open(self._samples_call(measures, interval))
        reader = SampleReader()
        try:
            for response in batches:
                yield from reader.read(response.batch)
        except grpc.RpcError as failed:
            raise error_of(failed) from None
        finally:
            self._connection.cancel(batches)

    # --- results ---
    def export(
        self,
        path: Union[str, Path],
        seconds: float = 0,
        fps: Optional[float] = None,
        bodies: Sequence[str] = (),
        progress: jobs.Progress = None,
        **options: Any,
    ) -> dict[str, Any]:
        """Records a copy of the session from now on, `seconds` long, to a file: .msh, .depl, .pvd, .glb, .csv, or
        .html, a page that plays one breath if `seconds` is 0. The session itself does not move, and changes that wait
        for their tick are left out. `options`: fields of CreateExportRequest, such as steps_per_frame. Returns the
        summary: frames, vertices, state_hash at the end and more."""
        fields = {"seconds": seconds, "frames_per_second": fps, "bodies": bodies, **options}
        return self._do(jobs.export(self.id, path, fields, progress))

    @property
    def study(self) -> "Studies":
        """Studies of this session's scene at its present parameters: study.error(levels=4)."""
        return Studies(self)

    def physiology(self, presets: Sequence[str] = (), progress: jobs.Progress = None) -> jobs.Physiology:
        """Simulates the scene's breathing presets (a minute a preset) and compares them with published ranges."""
        return self._do(jobs.physiology(self._source, presets, progress))

    def fit(self, landmarks: Optional[Landmarks] = None, progress: jobs.Progress = None, **options: Any) -> Fit:
        """Fits a person's breath to landmarks or other data with the lungs of this session's scene, as phrenic.fit does;
        the session itself does not move. `options`: modes, split, assimilate, scene_name, show_landmarks, and the kinds of
        data: exhale, surfaces, lung_surfaces, volume, m_mode, markers, errors."""
        return self._do(fitted(self._source, landmarks, options, progress))

    def compare(self, other: Union["Session", str, Path], body: str = "", **options: Any) -> jobs.Comparison:
        """Compares a body of this session, as it is now, with the same body of another session, or with a surface or
        motion file (unit_mm=..., time=...). Distances in mm: compare(other)["hd95_max"]."""
        return self._do(jobs.comparison(self.id, other.id if isinstance(other, Session) else None, other, body, options))


class Studies:
    """Studies of a session's scene, run on the server. Options are the fields of the messages in study.proto; enums by
    their lower-case names: error(integrators=["velocity_verlet", "rk4"], seconds=1, levels=4)."""

    def __init__(self, session: Session) -> None:
        self._session = session

    def error(self, progress: jobs.Progress = None, **options: Any) -> jobs.Study:
        """Error against run time of every integrator, by an independent reference (ErrorStudy)."""
        return self._run("error", options, progress)

    def stability(self, progress: jobs.Progress = None, **options: Any) -> jobs.Study:
        """Largest stable steps, predicted and measured (StabilityStudy)."""
        return self._run("stability", options, progress)

    def cost(self, progress: jobs.Progress = None, **options: Any) -> jobs.Study:
        """Cost of each part of the scene (CostStudy)."""
        return self._run("cost", options, progress)

    def streaming(self, progress: jobs.Progress = None, **options: Any) -> jobs.Study:
        """Error of every encoding against bandwidth (StreamingStudy)."""
        return self._run("streaming", options, progress)

    def _run(self, kind: str, options: Mapping[str, Any], progress: jobs.Progress) -> jobs.Study:
        session = self._session
        operation = jobs.study(kind, session._source, session.status.parameters, options, progress)
        return session._do(operation)
