"""Environments for reinforcement learning, after the interface of Gymnasium 1: `reset(seed=, options=)` returns
(observation, info), `step(action)` returns (observation, reward, terminated, truncated, info). Gymnasium is used where it
is installed (`gymnasium.make("phrenic/VentilateCopd-v0")`), and not needed. vector.py has many of them
side by side.

>>> env = VentilateCopd(resolution_mm=12, seconds=0.2)
>>> observation, info = env.reset(seed=1)
>>> observation in env.observation_space, sorted(info)
(True, ['seconds', 'state_hash', 'volume'])
>>> observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
>>> terminated, truncated
(False, False)
>>> *_, truncated, info = env.step(env.action_space.sample())
>>> truncated
True
>>> env.close()
"""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING, Any, Mapping, Optional

import numpy as np

from .arguments import mapping, positive, whole
from .errors import FailedPrecondition, InvalidArgument, OutOfRange
from .operations import Scene, SimulationWarning
from .session import Session
from .spaces import Env
from .tasks import DIVERGED, FOLLOW_VOLUME, KEEP_BREATHING, VENTILATE_COPD, Episode, Task, actions_of

if TYPE_CHECKING:
    from .server import Server


class BreathingEnv(Env):
    """A thorax to breathe for: a session that a viewer can show.

    Observation: volume above the beginning [l], flow [l/s], pleural pressure [kPa], volume to reach [l], elapsed fraction
    of the breath. Reward, per action: minus the squared distance from the volume to reach over the tidal volume, minus
    `cost` times the squared action over its highest. The volume to reach is a sine of 0.5 l every 4 s, which varies by
    10 % with the seed. Terminated if the simulation diverges (reward -10), truncated after `seconds`. Equal seeds and
    actions give equal states, bit for bit."""

    metadata = {"render_modes": []}
    task: Task

    def __init__(
        self,
        *,
        scene: Scene = "thorax",
        resolution_mm: Optional[float] = None,
        seconds: float = 12,
        interval: float = 0.1,
        cost: float = 0.01,
        server: Optional["Server"] = None,
    ) -> None:
        """`interval`: time for which an action is held [s]."""
        seconds, interval = positive("seconds", seconds), positive("interval", interval)
        if not 0 < interval <= seconds:
            raise InvalidArgument("interval: choose one above 0 and not above seconds")
        self.action_space, self.observation_space = self.task.action_space, self.task.observation_space
        self._scene, self._resolution, self._server = scene, resolution_mm, server
        self._seconds, self._interval, self._cost = seconds, interval, cost
        self._session: Optional[Session] = None
        self._done = True

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Mapping[str, Any]] = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode. `options`: live parameters of the patient, such as {"airway_resistance": 5}."""
        super().reset(seed=None if seed is None else whole("seed", seed))
        self.close()
        self._episode = Episode.begin(self.task, self.np_random, self._cost)
        self._session = Session(
            self._scene,
            preset=self.task.preset,
            set={**self._episode.start, **mapping("options", options)},
            resolution_mm=self._resolution,
            server=self._server,
        )
        self._episode.first = self._session.measure("lung volume")
        self._done, self._actions = False, 0
        return self._observe()

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Holds an action for an interval. FailedPrecondition after the end of an episode."""
        if self._session is None or self._done:
            raise FailedPrecondition("the episode has ended: call reset() first")
        numbers = self.task.check(action)
        session, episode = self._session, self._episode
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", SimulationWarning)
                session.set(**self.task.parameters(numbers))
            session.step(max(1, round(self._interval / session.time_step)), read=())
        except OutOfRange as error:
            self._done = True
            return self._last, DIVERGED, True, False, {"diverged": str(error)}
        observation, info = self._observe()
        suffocated = episode.suffocated(observation, session.time)
        reward = DIVERGED if suffocated else episode.reward(observation, numbers)
        self._actions += 1
        truncated = not suffocated and self._actions >= actions_of(self._seconds, self._interval)
        self._done = truncated or suffocated
        return observation, reward, suffocated, truncated, info

    def render(self) -> None:
        """There is no picture: phrenic.default_server().viewer(session) is the address of one."""

    def close(self) -> None:
        """Deletes the session."""
        if self._session is not None:
            self._session.close()
            self._session = None
        self._done = True

    def _observe(self) -> tuple[np.ndarray, dict[str, Any]]:
        assert self._session is not None
        measures, time = self._session.measures, self._session.time
        self._last = self._episode.observe(measures, time)
        info = {"seconds": time, "volume": measures["lung volume"], "state_hash": self._session.state_hash}
        return self._last, info


class VentilateCopd(BreathingEnv):
    """Ventilate a relaxed patient with COPD: airways resist three times as much as healthy ones, the lungs are 1.6 times
    as compliant and hold trapped air. Action: the pressure at the mouth [kPa], 0 to 3."""

    task = VENTILATE_COPD


class FollowVolume(BreathingEnv):
    """Breathe by muscle. Actions: the activations of the diaphragm, 0 to 0.5, and of the intercostal muscles, 0 to 1, at
    the peak of the breath; both follow the breath's wave, which has the length of the breath to reach."""

    task = FOLLOW_VOLUME


class KeepBreathing(BreathingEnv):
    """Keep a patient alive whose breathing muscles are paralysed. Action: the pressure at the mouth [kPa], 0 to 3.
    Terminated (reward -10) when less than a fifth of the tidal volume was moved for 8 s."""

    task = KEEP_BREATHING


ENVIRONMENTS = {"VentilateCopd": VentilateCopd, "FollowVolume": FollowVolume, "KeepBreathing": KeepBreathing}


def register() -> None:
    """Registers phrenic/VentilateCopd-v0, FollowVolume-v0 and KeepBreathing-v0 with Gymnasium, each with its vector
    environment. Gymnasium calls it by itself if pip has installed this package. Requires: gymnasium is installed."""
    import gymnasium

    for name in ENVIRONMENTS:
        gymnasium.register(
            id=f"phrenic/{name}-v0",
            entry_point=f"phrenic.gym:{name}",
            vector_entry_point=f"phrenic.vector:{name}Vector",
        )
