"""What Gymnasium 1 gives its environments, for machines without it."""

from __future__ import annotations

from typing import Any, Mapping, Optional

import numpy as np

try:  # pragma: no cover - not a package of Debian 12
    from gymnasium import Env
    from gymnasium.spaces import Box
    from gymnasium.vector import AutoresetMode, VectorEnv

    NEXT_STEP: Any = AutoresetMode.NEXT_STEP
except ImportError:
    NEXT_STEP = "NextStep"

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

    class VectorEnv:  # type: ignore[no-redef]
        """gymnasium.vector.VectorEnv's attributes and its end of a `with` block."""

        metadata: dict[str, Any] = {}
        render_mode: Optional[str] = None
        spec: Any = None
        num_envs = 0

        @property
        def unwrapped(self) -> "VectorEnv":
            """The environment itself."""
            return self

        def close(self, **options: Any) -> None:
            """Ends the environment."""

        def __enter__(self) -> "VectorEnv":
            return self

        def __exit__(self, *_: Any) -> None:
            self.close()
