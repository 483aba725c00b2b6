"""Many patients side by side: vector environments after the interface of Gymnasium 1, whose steps are one call of the
server (runs.py). Each patient has the states of the single environment with its seed, bit for bit (but with the
integrators velocity_verlet and bdf2, which remember the step before).

>>> patients = VentilateCopdVector(2, resolution_mm=12, seconds=0.2)
>>> observations, infos = patients.reset(seed=[1, 2])
>>> observations.shape, infos["seconds"]
((2, 5), array([0., 0.]))
>>> observations, rewards, terminated, truncated, infos = patients.step(patients.action_space.sample())
>>> rewards.shape, terminated, truncated
((2,), array([False, False]), array([False, False]))
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, Optional, Sequence, Union

import numpy as np

from .arguments import mapping, positive, whole
from .errors import FailedPrecondition, InvalidArgument
from .frame import State
from .operations import Scene
from .runs import Run, batch
from .session import Session
from .spaces import NEXT_STEP, Box, VectorEnv
from .tasks import DIVERGED, FOLLOW_VOLUME, KEEP_BREATHING, VENTILATE_COPD, Episode, Task, actions_of

if TYPE_CHECKING:
    from .server import Server

Seeds = Union[None, int, Sequence[Optional[int]]]
Start = tuple[State, Mapping[str, float], str]
PARTS = ("positions", "velocities", "scalars")


class BreathingVector(VectorEnv):
    """`num_envs` thoraxes to breathe for. Parameters, observations, rewards and ends are those of gym.BreathingEnv, one
    row a patient. A patient whose episode has ended is reset by the next step, whose action it ignores, with a reward of
    0 (Gymnasium's AutoresetMode.NEXT_STEP)."""

    metadata = {"render_modes": [], "autoreset_mode": NEXT_STEP}
    task: Task

    def __init__(
        self,
        num_envs: int,
        *,
        scene: Scene = "thorax",
        resolution_mm: Optional[float] = None,
        seconds: float = 12,
        interval: float = 0.1,
        cost: float = 0.01,
        threads: Optional[int] = None,
        server: Optional["Server"] = None,
    ) -> None:
        """`threads`: patients that the server simulates at a time; default: one a core."""
        num_envs = whole("num_envs", num_envs, least=1)
        seconds, interval = positive("seconds", seconds), positive("interval", interval)
        if not 0 < interval <= seconds:
            raise InvalidArgument("interval: choose one above 0 and not above seconds")
        self.num_envs = num_envs
        self.single_action_space, self.single_observation_space = self.task.action_space, self.task.observation_space
        self.action_space = rows_of(self.single_action_space, num_envs)
        self.observation_space = rows_of(self.single_observation_space, num_envs)
        self._scene, self._resolution, self._server, self._threads = scene, resolution_mm, server, threads
        self._seconds, self._interval, self._cost = seconds, interval, cost
        self._options: Mapping[str, Any] = {}
        self._randoms = [np.random.default_rng() for _ in range(num_envs)]
        self._episodes: list[Episode] = []
        self._done = np.zeros(num_envs, bool)
        self._rest: Start

    def reset(
        self, *, seed: Seeds = None, options: Optional[Mapping[str, Any]] = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode of every patient. `seed`: one a patient, or that of the first, from which the others count
        up. `options`: live parameters of all patients."""
        seeds = self._seeds_of(seed)
        chosen = dict(mapping("options", options))
        first = self._start_of(chosen)  # from here on, nothing fails: an error above leaves the episodes as they were
        for i, each in enumerate(seeds):
            if each is not None:
                self._randoms[i] = np.random.default_rng(each)
        self._options, self._rest = chosen, first
        self._episodes = [self._begin(random) for random in self._randoms]
        self._states: list[State] = [self._rest[0]] * self.num_envs
        self._done[:] = False
        self._actions = np.zeros(self.num_envs, int)
        self._observations = np.stack([each.observe(self._rest[1], 0) for each in self._episodes])
        hashes = [self._rest[2]] * self.num_envs
        return self._observations.copy(), self._infos([self._rest[1]["lung volume"]] * self.num_envs, hashes)

    def step(self, actions: Any) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, dict[str, Any]]:
        """Holds an action for an interval, for every patient. FailedPrecondition before reset()."""
        if not self._episodes:
            raise FailedPrecondition("no episode has begun: call reset() first")
        going = [int(i) for i in np.flatnonzero(~self._done)]
        numbers = self._actions_of(actions, going)
        runs = self._simulate(going, numbers)  # an error leaves the episodes as they were
        rewards, terminated = np.zeros(self.num_envs), np.zeros(self.num_envs, bool)
        volumes, hashes = [self._rest[1]["lung volume"]] * self.num_envs, [self._rest[2]] * self.num_envs
        for i in np.flatnonzero(self._done):
            self._episodes[i], self._states[i] = self._begin(self._randoms[i]), self._rest[0]
            self._actions[i] = 0
            self._observations[i] = self._episodes[i].observe(self._rest[1], 0)
        for run in runs:
            i = going[run.index]
            rewards[i], terminated[i] = self._judge(i, run, numbers[i])
            volumes[i] = float(run.measures["lung volume"][-1]) if len(run.times) else volumes[i]
            hashes[i] = run.state_hash
        self._actions[going] += 1
        truncated = (self._actions >= actions_of(self._seconds, self._interval)) & ~terminated
        self._done = terminated | truncated
        return self._observations.copy(), rewards, terminated, truncated, self._infos(volumes, hashes)

    def close(self, **options: Any) -> None:
        """Ends the episodes: a step is then FailedPrecondition, until reset()."""
        self._episodes = []
        super().close(**options)

    def _seeds_of(self, seed: Seeds) -> list[Optional[int]]:
        if seed is None:
            return []
        if isinstance(seed, (int, np.integer)):
            return [whole("seed", seed) + i for i in range(self.num_envs)]
        try:
            seeds = [None if each is None else whole("seed", each) for each in seed]
        except TypeError:
            raise InvalidArgument(f"seed: {seed!r} is neither a whole number nor a list of them") from None
        if len(seeds) != self.num_envs:
            raise InvalidArgument(f"seed: {len(seeds)} seeds for {self.num_envs} patients")
        return seeds

    def _actions_of(self, actions: Any, going: Sequence[int]) -> dict[int, np.ndarray]:
        """Returns the actions of the patients whose episodes go on, after a check of these alone."""
        try:
            rows = np.asarray(actions, np.float32)
        except (TypeError, ValueError) as error:
            raise InvalidArgument(f"actions: give an array with a row a patient: {error}") from None
        if rows.ndim != 2 or len(rows) != self.num_envs:
            raise InvalidArgument(
                f"actions: an array of shape {rows.shape} for {self.num_envs} patients: give a row for each"
            )
        return {i: self.task.check(rows[i]) for i in going}

    def _simulate(self, going: Sequence[int], actions: Mapping[int, np.ndarray]) -> list[Run]:
        if not going:
            return []
        parameters = [
            {**self._episodes[i].start, **self._options, **self.task.parameters(actions[i])} for i in going
        ]
        starts = [self._states[i] for i in going]
        return list(
            batch(
                self._scene, parameters, seconds=self._interval, fps=1 / self._interval, preset=self.task.preset,
                resolution_mm=self._resolution, starts=starts, read=PARTS, threads=self._threads,
                server=self._server,
            )  # fmt: skip
        )

    def _judge(self, i: int, run: Run, action: np.ndarray) -> tuple[float, bool]:
        """Takes a run's end as the state of a patient. Returns the reward, and whether the episode is terminated."""
        if run.diverged or run.state is None:
            return DIVERGED, True
        episode, self._states[i] = self._episodes[i], run.state
        measures = {name: float(values[-1]) for name, values in run.measures.items()}
        observation = episode.observe(measures, run.state.time)
        self._observations[i] = observation
        suffocated = episode.suffocated(observation, run.state.time)
        return (DIVERGED if suffocated else episode.reward(observation, action)), suffocated

    def _start_of(self, options: Mapping[str, Any]) -> Start:
        """Returns the state, measures and hash with which every episode with these options begins."""
        start = {**self.task.fixed, **options}
        with Session(
            self._scene, preset=self.task.preset, set=start, resolution_mm=self._resolution, server=self._server
        ) as session:
            frame = session.frame(PARTS)
        return frame.state, dict(frame.measures), frame.state_hash

    def _begin(self, random: np.random.Generator) -> Episode:
        episode = Episode.begin(self.task, random, self._cost)
        episode.first = self._rest[1]["lung volume"]
        return episode

    def _infos(self, volumes: Sequence[float], hashes: Sequence[str]) -> dict[str, Any]:
        """As Gymnasium's vector environments give them: an array a key, and which patients have it."""
        seconds = np.array([state.time for state in self._states])
        infos = {"seconds": seconds, "volume": np.array(volumes), "state_hash": np.array(hashes, object)}
        return {**infos, **{f"_{key}": np.ones(self.num_envs, bool) for key in infos}}


def rows_of(space: Box, rows: int) -> Box:
    """Returns the space of `rows` points of another."""
    return Box(np.tile(space.low, (rows, 1)), np.tile(space.high, (rows, 1)))


class VentilateCopdVector(BreathingVector):
    """Many of gym.VentilateCopd."""

    task = VENTILATE_COPD


class FollowVolumeVector(BreathingVector):
    """Many of gym.FollowVolume."""

    task = FOLLOW_VOLUME


class KeepBreathingVector(BreathingVector):
    """Many of gym.KeepBreathing."""

    task = KEEP_BREATHING
