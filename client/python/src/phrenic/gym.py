"""Environments for reinforcement learning, after the interface of Gymnasium 1: `reset(seed=, options=)` returns
(observation, info), `step(action)` returns (observation, reward, terminated, truncated, info). Gymnasium is used where it
is installed (`gymnasium.make("phrenic/VentilateCopd-v0")` after register()), and not needed.

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

from .errors import FailedPrecondition, InvalidArgument, OutOfRange
from .operations import Scene, SimulationWarning
from .session import Session

if TYPE_CHECKING:
    from .server import Server

try:  # pragma: no cover - not a package of Debian 12
    from gymnasium import Env
    from gymnasium.spaces import Box
except ImportError:

    class Env:  # type: ignore[no-redef]
        """gymnasium.Env's attributes and its end of a `with` block."""

        metadata: dict[str, Any] = {"render_modes": []}
        render_mode: Optional[str] = None
        spec: Any = None

        @property
        def unwrapped(self) -> "Env":
            """The environment itself."""
            return self

        @property
        def np_random(self) -> np.random.Generator:
            """Seeded by reset."""
            if not hasattr(self, "_random"):
                self._random = np.random.default_rng()
            return self._random

        def reset(self, *, seed: Optional[int] = None, options: Optional[Mapping[str, Any]] = None) -> Any:
            """Seeds np_random if a seed is given."""
            if seed is not None:
                self._random = np.random.default_rng(seed)

        def close(self) -> None:
            """Ends the environment."""

        def __enter__(self) -> "Env":
            return self

        def __exit__(self, *_: Any) -> None:
            self.close()

    class Box:  # type: ignore[no-redef]
        """gymnasium.spaces.Box of float32 numbers between bounds."""

        def __init__(self, low: Any, high: Any, dtype: Any = np.float32) -> None:
            self.low, self.high = np.asarray(low, dtype), np.asarray(high, dtype)
            self.shape, self.dtype = self.low.shape, np.dtype(dtype)
            self._random = np.random.default_rng()

        def seed(self, seed: Optional[int] = None) -> None:
            """Seeds sample()."""
            self._random = np.random.default_rng(seed)

        def sample(self) -> np.ndarray:
            """Returns a point, evenly distributed."""
            return self._random.uniform(self.low, self.high).astype(self.dtype)

        def contains(self, x: Any) -> bool:
            """True if x has the shape and type, and is within the bounds."""
            same = isinstance(x, np.ndarray) and x.shape == self.shape and np.can_cast(x.dtype, self.dtype)
            return bool(same and (x >= self.low).all() and (x <= self.high).all())

        __contains__ = contains


LITRE, KILOPASCAL = 1e-3, 1e3


class VentilateCopd(Env):
    """Ventilate a relaxed patient with COPD: wide airways resist three times as much as healthy ones, the lungs are
    1.6 times as compliant and hold trapped air.

    Action: the pressure at the mouth [kPa], 0 to 3, held for `interval` seconds. Observation: volume above the
    beginning [l], flow [l/s], pleural pressure [kPa], volume to reach [l], elapsed fraction of the breath. Reward, per
    action: minus the squared distance from the volume to reach over the tidal volume, minus `pressure_cost` times the
    squared pressure over 3 kPa. The patient's target is a sine of 0.5 l every 4 s, which varies by 10 % with the seed.
    Terminated if the simulation diverges (reward -10), truncated after `seconds`. Equal seeds and actions give equal
    states, bit for bit."""

    metadata = {"render_modes": []}

    def __init__(
        self,
        *,
        scene: Scene = "thorax",
        resolution_mm: Optional[float] = None,
        seconds: float = 12,
        interval: float = 0.1,
        pressure_cost: float = 0.01,
        server: Optional["Server"] = None,
    ) -> None:
        if not 0 < interval <= seconds:
            raise InvalidArgument("interval: choose one above 0 and not above seconds")
        self.action_space = Box(np.array([0], np.float32), np.array([3], np.float32))
        self.observation_space = Box(
            np.array([-10, -50, -50, 0, 0], np.float32), np.array([10, 50, 50, 2, 1], np.float32)
        )
        self._start = {"diaphragm_activation": 0, "intercostal_activation": 0, "expiratory_activation": 0}
        self._scene, self._resolution, self._server = scene, resolution_mm, server
        self._seconds, self._interval, self._cost = seconds, interval, pressure_cost
        self._session: Optional[Session] = None
        self._done = True

    def reset(
        self, *, seed: Optional[int] = None, options: Optional[Mapping[str, Any]] = None
    ) -> tuple[np.ndarray, dict[str, Any]]:
        """Begins an episode. `options`: live parameters of the patient, such as {"airway_resistance": 5}."""
        super().reset(seed=seed)
        self.close()
        self._session = Session(
            self._scene,
            preset="copd",
            set={**self._start, **(options or {})},
            resolution_mm=self._resolution,
            server=self._server,
        )
        self._tidal = 0.5 * self.np_random.uniform(0.9, 1.1)
        self._length = 4 * self.np_random.uniform(0.9, 1.1)
        self._first = self._session.measure("lung volume")
        self._done = False
        return self._observe()

    def step(self, action: Any) -> tuple[np.ndarray, float, bool, bool, dict[str, Any]]:
        """Holds a pressure for an interval. FailedPrecondition after the end of an episode."""
        if self._session is None or self._done:
            raise FailedPrecondition("the episode has ended: call reset() first")
        pressure = np.asarray(action, np.float32)
        if not self.action_space.contains(pressure):
            raise InvalidArgument(f"action: {action} is not a number from 0 to 3 in an array of one")
        session = self._session
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore", SimulationWarning)
                session.set(airway_pressure=float(pressure[0]) * KILOPASCAL)
            session.step(session.ticks_until(session.time + self._interval), read=())
        except OutOfRange as error:
            self._done = True
            return self._last, -10.0, True, False, {"diverged": str(error)}
        observation, info = self._observe()
        distance = (observation[0] - observation[3]) / self._tidal
        reward = -float(distance**2) - self._cost * float(pressure[0] / 3) ** 2
        truncated = session.time >= self._seconds - 0.5 * session.time_step
        self._done = truncated
        return observation, reward, False, truncated, info

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
        phase = time / self._length % 1
        numbers = [
            (measures["lung volume"] - self._first) / LITRE,
            measures["flow"] / LITRE,
            measures["pleural pressure"] / KILOPASCAL,
            self._tidal * 0.5 * (1 - np.cos(2 * np.pi * phase)),
            phase,
        ]
        space = self.observation_space
        self._last = np.clip(np.array(numbers, np.float32), space.low, space.high)
        info = {"seconds": time, "volume": measures["lung volume"], "state_hash": self._session.state_hash}
        return self._last, info


def register() -> None:
    """Registers phrenic/VentilateCopd-v0 with Gymnasium. Requires: gymnasium is installed."""
    import gymnasium

    gymnasium.register(id="phrenic/VentilateCopd-v0", entry_point="phrenic.gym:VentilateCopd")
