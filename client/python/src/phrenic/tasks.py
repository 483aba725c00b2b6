"""Tasks of the environments: a patient, actions, observations, rewards."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any, Mapping, Optional

import numpy as np

from .errors import InvalidArgument
from .spaces import Box

LITRE, KILOPASCAL = 1e-3, 1e3
DIVERGED = -10.0
"""Reward of an action after which the simulation diverges, and of letting a patient suffocate."""


def actions_of(seconds: float, interval: float) -> int:
    """Number of actions, held for `interval` each, in an episode of `seconds`."""
    return max(1, math.ceil(seconds / interval - 1e-6))


@dataclass(frozen=True)
class Action:
    """A live parameter that an action sets."""

    parameter: str
    high: float
    """The largest value; the smallest is 0."""
    unit: float = 1
    """Of the action's number, in the parameter's SI unit."""


@dataclass(frozen=True)
class Task:
    """A patient, and the breath to reach: a sine of 0.5 l every 4 s, each varied by 10 % with the seed."""

    preset: str
    fixed: Mapping[str, Any]
    """Live parameters that the task sets."""
    actions: tuple[Action, ...]
    litres: float = 0.5
    """Tidal volume."""
    paced: bool = False
    """True if the breath's wave, which the muscles follow, has the length of the breath to reach."""
    suffocates: Optional[float] = None
    """The episode is terminated after so many seconds in which less than a fifth of the tidal volume was moved [s]."""

    @property
    def action_space(self) -> Box:
        """One number an action, in its unit."""
        high = np.array([action.high for action in self.actions], np.float32)
        return Box(np.zeros_like(high), high)

    @property
    def observation_space(self) -> Box:
        """Volume above the beginning [l], flow [l/s], pleural pressure [kPa], volume to reach [l], elapsed fraction of
        the breath."""
        return Box(np.array([-10, -50, -50, 0, 0], np.float32), np.array([10, 50, 50, 2, 1], np.float32))

    def parameters(self, action: np.ndarray) -> dict[str, float]:
        """Returns the live parameters that an action sets."""
        return {each.parameter: float(number) * each.unit for each, number in zip(self.actions, action)}

    def check(self, action: Any) -> np.ndarray:
        """Returns the action as an array. InvalidArgument if it is not in the space."""
        try:
            numbers = np.asarray(action, np.float32)
        except (TypeError, ValueError):
            numbers = np.full(0, np.nan, np.float32)
        if not self.action_space.contains(numbers):
            highest = ", ".join(f"{each.high:g}" for each in self.actions)
            raise InvalidArgument(f"action: {action} is not an array of {len(self.actions)} from 0 to {highest}")
        return numbers


@dataclass
class Episode:
    """One patient from reset to the end."""

    task: Task
    tidal: float
    """[l]"""
    length: float
    """Of a breath [s]."""
    cost: float
    """Of an action at its highest."""
    first: float = 0
    """Volume at the beginning [m^3]."""
    moved: list[tuple[float, float]] = field(default_factory=list)
    """Times [s] and volumes [l] of the last seconds."""

    @staticmethod
    def begin(task: Task, random: np.random.Generator, cost: float) -> "Episode":
        """Draws the breath to reach."""
        return Episode(task, task.litres * random.uniform(0.9, 1.1), 4 * random.uniform(0.9, 1.1), cost)

    @property
    def start(self) -> dict[str, Any]:
        """Live parameters of the patient."""
        pace = {"breath_length": self.length} if self.task.paced else {}
        return {**self.task.fixed, **pace}

    def observe(self, measures: Mapping[str, float], time: float) -> np.ndarray:
        """Returns the observation."""
        phase = time / self.length % 1
        numbers = [
            (measures["lung volume"] - self.first) / LITRE,
            measures["flow"] / LITRE,
            measures["pleural pressure"] / KILOPASCAL,
            self.tidal * 0.5 * (1 - np.cos(2 * np.pi * phase)),
            phase,
        ]
        space = self.task.observation_space
        return np.clip(np.array(numbers, np.float32), space.low, space.high)

    def reward(self, observation: np.ndarray, action: np.ndarray) -> float:
        """Minus the squared distance from the volume to reach, over the tidal volume, and minus the action's cost."""
        distance = (observation[0] - observation[3]) / self.tidal
        effort = action / self.task.action_space.high
        return -float(distance**2) - self.cost * float(np.mean(effort**2))

    def suffocated(self, observation: np.ndarray, time: float) -> bool:
        """True if too little air was moved for too long."""
        if self.task.suffocates is None:
            return False
        self.moved.append((time, float(observation[0])))
        while len(self.moved) > 1 and time - self.moved[1][0] >= self.task.suffocates:
            del self.moved[0]
        volumes = [volume for _, volume in self.moved]
        return time - self.moved[0][0] >= self.task.suffocates and max(volumes) - min(volumes) < 0.2 * self.tidal


AIRWAY_PRESSURE = Action("airway_pressure", 3, KILOPASCAL)
RELAXED = {"diaphragm_activation": 0, "intercostal_activation": 0, "expiratory_activation": 0}

VENTILATE_COPD = Task("copd", RELAXED, (AIRWAY_PRESSURE,))
FOLLOW_VOLUME = Task(
    "quiet", {}, (Action("diaphragm_activation", 0.5), Action("intercostal_activation", 1)), paced=True
)
KEEP_BREATHING = Task("palsy-both", RELAXED, (AIRWAY_PRESSURE,), suffocates=8)
