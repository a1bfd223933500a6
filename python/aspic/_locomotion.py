"""Common parts of environments in which a body moves along."""

from __future__ import annotations

import os
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import numpy as np

from ._batch import Instance
from ._environments import BatchEnv, Path
from ._scene import Scene

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float32]


def scenes_of(
    scenes: Scene | Path | Iterable[Scene | Path],
) -> tuple[Scene | Path | list[Scene | Path], Scene | Path]:
    """Return the scenes, as a list if there are several, and the first of them."""
    if isinstance(scenes, (Scene, str, os.PathLike)):
        return scenes, scenes
    several = list(scenes)
    return several, several[0]


class Locomotion(BatchEnv):
    """Environments whose reward is how far the center of mass moves along +x [m].

    infos["distance"]: since the beginning of the episode [m]. An episode begins at the scene's start with a random
    velocity, the same of all particles.
    """

    cycle: float
    """Period of the clock [s]."""
    push: float
    """The largest component of the velocity at the beginning [m/s]."""

    def _keep_start(self) -> NDArray[np.float64]:
        """Store the centers of mass of positions, (n, particles, 3)."""
        x = self.batch.positions.astype(np.float64)
        self._masses = np.array([instance.masses for instance in self.batch])[:, :, None]
        self._start = self._center(x)
        self._place = self._start[:, 0].copy()
        return x

    def begin(self, index: int, instance: Instance, random: np.random.Generator) -> None:
        """Give all particles the same velocity, each component within ±``push``."""
        instance.velocities = instance.velocities + random.uniform(-self.push, self.push, 3)
        self._place[index] = self._start[index, 0]

    def judge(self) -> tuple[ArrayLike, ArrayLike]:
        """Return the displacements along x since the last step [m]; they end no episode."""
        place = self._center(self.batch.positions.astype(np.float64))[:, 0]
        moved = place - self._place
        self._place = place
        return moved, np.zeros(self.num_envs, np.bool_)

    def figures(self) -> dict[str, NDArray[Any]]:
        """Return the distance since the beginning of the episode [m]."""
        return {"distance": self._place - self._start[:, 0]}

    def _clock(self) -> NDArray[np.float64]:
        """Return two triangle waves a quarter of ``cycle`` apart, (n, 2)."""
        time = self._made * self.every / self.cycle
        return np.stack([4 * np.abs((time + shift) % 1.0 - 0.5) - 1 for shift in (0.0, 0.25)], axis=1)

    def _higher(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the heights of the centers of mass above those at the start [m], (n, 1)."""
        return (self._center(x) - self._start)[:, 1:2]

    def _center(self, vectors: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the center of mass, (n, 3), summed in the order of the particles: the same bits everywhere."""
        sums = np.cumsum(self._masses * vectors, axis=1)[:, -1]
        return sums / np.cumsum(self._masses, axis=1)[:, -1]  # type: ignore[no-any-return]


def seen(*parts: NDArray[Any]) -> Floats:
    """Return an observation of its parts side by side, within ±10."""
    observations: Floats = np.clip(np.concatenate(parts, axis=1), -10, 10).astype(np.float32)
    return observations
