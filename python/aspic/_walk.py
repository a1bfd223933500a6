"""An environment: a robot of voxels that learns to walk."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import gymnasium  # type: ignore[import-not-found, unused-ignore]
import numpy as np
from gymnasium.vector import AutoresetMode  # type: ignore[import-not-found, unused-ignore]

from ._batch import Instance
from ._environments import Path, SingleEnv
from ._errors import UsageError
from ._locomotion import Locomotion, scenes_of, seen
from ._scene import Scene, load

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Floats = NDArray[np.float32]

__all__ = ["Walk", "WalkEnv", "walker"]


def walker(overrides: dict[str, Any] | None = None) -> Scene:
    """Return the scene of ``Walk``: the built-in ``walker``, whose actuators take their signals from inputs.

    ``overrides``: keys and values set afterwards. Raises SceneError.
    """
    scene = load("walker")
    names = [key.partition(".")[0] for key in scene.keys() if key.startswith("actuator[") and key.endswith("].signal")]
    inputs: dict[str, Any] = {f"{name}.signal": "input" for name in names}
    return scene.copy({**inputs, **(overrides or {})})


class Walk(Locomotion):
    """A soft robot walks along +x by muscles: actuators with ``signal = "input"``.

    Action, (m,) of −1 … 1: the signal w of each actuator, in the order of the scene. Signals follow actions at
    ``rate`` at most, so that they jump at no step.

    Observation, (m + 13,) float32, within ±10: a clock, as two triangle waves a quarter of ``cycle`` apart (2,); the
    signals (m,); velocity of the center of mass [m/s] (3,); how much higher it is than at the start [m] (1,); where the
    ends of the body's long and upright axes point, over their lengths at the start (6,); the part of its lowest particles
    that is near the ground (1,).

    Reward: how far the center of mass moved along x [m]. infos["distance"]: since the beginning of the episode [m].
    An episode begins at the scene's start with a random velocity, the same of all particles.
    """

    def __init__(
        self,
        num_envs: int | None = None,
        scenes: Scene | Path | Iterable[Scene | Path] | None = None,
        *,
        rate: float = 8.0,
        cycle: float = 0.5,
        push: float = 0.02,
        **options: Any,
    ) -> None:
        """Create the environments.

        ``scenes``: ``walker()``, ``num_envs`` times, or others with as many particles and inputs in each; ``rate``: by
        how much a signal changes [1/s], > 0; ``cycle``: of the clock [s], > 0; ``push``: the largest component of the
        velocity at the beginning [m/s], ≥ 0; ``options``: those of ``BatchEnv()``. Raises UsageError, SceneError.
        """
        if not (rate > 0 and cycle > 0 and push >= 0):
            raise UsageError(f"rate and cycle are > 0, push is ≥ 0, not {rate}, {cycle}, {push}")
        made, first = scenes_of(walker() if scenes is None else scenes)
        m = len(_inputs_of(first if isinstance(first, Scene) else load(first)))
        if m == 0:
            raise UsageError("the scene has no actuator with signal = \"input\"")
        box = gymnasium.spaces.Box
        super().__init__(
            made,
            num_envs,
            observation_space=box(-10.0, 10.0, (m + 13,), np.float32),
            action_space=box(-1.0, 1.0, (m,), np.float32),
            **options,
        )
        self.rate, self.cycle, self.push = rate, cycle, push
        if any(len(instance.inputs) != m for instance in self.batch):
            raise UsageError(f"environments have as many inputs each: the first has {m}")
        x = self._keep_start()
        self._signals = np.zeros((self.num_envs, m))
        self._ends = _ends(x[0])
        self._lowest = x[0, :, 1] < x[0, :, 1].min() + 1e-6
        self._axes = self._axes_of(x)

    def begin(self, index: int, instance: Instance, random: np.random.Generator) -> None:
        """Give all particles the same velocity, each component within ±``push``, and set signals to 0."""
        super().begin(index, instance, random)
        self._signals[index] = 0.0

    def act(self, actions: Any) -> None:
        """Move the signals towards the actions."""
        most = self.rate * self.every
        self._signals += np.clip(actions.astype(np.float64) - self._signals, -most, most)
        for instance, row in zip(self.batch, self._signals.tolist()):
            instance.channels = row

    def observe(self) -> Floats:
        """Return clock, signals, velocity, height, axes and contact, (n, m + 13)."""
        x, v = self.batch.positions.astype(np.float64), self.batch.velocities.astype(np.float64)
        length = np.sqrt((self._axes**2).sum(axis=2))[:, :, None]
        axes = (self._axes_of(x) / length).reshape(len(x), 6)
        near = (x[:, self._lowest, 1] < x[:, :, 1].min(axis=1)[:, None] + 0.01).mean(axis=1)[:, None]
        return seen(self._clock(), self._signals, self._center(v), self._higher(x), axes, near)

    def _axes_of(self, x: NDArray[np.float64]) -> NDArray[np.float64]:
        """Return the axes from rear to front and from bottom to top, by particles at the ends, (n, 2, 3)."""
        front, rear, top, low = self._ends
        return np.stack([x[:, front] - x[:, rear], x[:, top] - x[:, low]], axis=1)


def _inputs_of(scene: Scene) -> list[str]:
    return [key for key in scene.keys() if key.endswith("].signal") and scene[key] == "input"]


def _ends(x: NDArray[np.float64]) -> tuple[int, int, int, int]:
    """Return the foremost, hindmost, highest and lowest particles; the first of several."""
    return int(x[:, 0].argmax()), int(x[:, 0].argmin()), int(x[:, 1].argmax()), int(x[:, 1].argmin())


class WalkEnv(SingleEnv):
    """A single environment of ``Walk``: ``gymnasium.make("aspic/Walk-v0")``."""

    def __init__(self, **options: Any):
        """Create the environment. ``options``: those of ``Walk()`` except ``num_envs`` and ``autoreset_mode``."""
        super().__init__(Walk(1, autoreset_mode=AutoresetMode.DISABLED, **options))
