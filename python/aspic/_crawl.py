"""A soft cube that crawls."""

from __future__ import annotations

import itertools
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import gymnasium  # type: ignore[import-not-found, unused-ignore]
import numpy as np
from gymnasium.vector import AutoresetMode  # type: ignore[import-not-found, unused-ignore]

from ._environments import Path, SingleEnv
from ._errors import UsageError
from ._inputs import Pull
from ._locomotion import Locomotion, scenes_of, seen
from ._scene import Scene, load
from ._simulation import Simulation

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[np.float32]

__all__ = ["Crawl", "CrawlEnv", "crawler"]


def crawler(overrides: dict[str, Any] | None = None) -> Scene:
    """Return the scene of ``Crawl``: a soft cube with edges of 1 m and 64 particles of 1 kg, on rough ground.

    ``overrides``: keys and values set afterwards. Raises SceneError.
    """
    values: dict[str, Any] = {
        "name": "crawl",
        "cube[0].particles-per-edge": 4,
        "cube[0].edge-length": 1.0,
        "cube[0].position": [0, -0.5, 0],
        "cube[0].structural.stiffness": 600.0,
        "cube[0].shear.stiffness": 600.0,
        "cube[0].bending.stiffness": 600.0,
        "contact.restitution": 0.0,
        "contact.friction": 0.9,
        "view.camera.position": [1.6, 0.6, 5.0],
        "view.camera.target": [0.4, -0.5, 0.0],
        "view.camera.fov": 28.0,
    }
    return load("cube-plane", {**values, **(overrides or {})})


# A tendon's force hardly changes while its ends move, since they are pulled from this far away [m].
_FAR = 1000.0


class Crawl(Locomotion):
    """A soft body crawls along +x by tendons, which draw two of its particles together.

    Action, (m,) of 0 … 1: the tension of each tendon as a part of ``force``, constant for ``every`` s. Both ends feel
    it, in opposite directions, so tendons alone do not move its center of mass: it has to walk by friction.

    Observation, (2m + 6,) float32, within ±10: a clock, as two triangle waves a quarter of ``cycle`` apart (2,);
    lengths of the tendons over those at the start, less 1 (m,); their rates over those lengths [1/s] (m,); velocity of
    the center of mass [m/s] (3,); how much higher it is than at the start [m] (1,).

    Reward: how far the center of mass moved along x [m]. infos["distance"]: since the beginning of the episode [m].
    An episode begins at the scene's start with a random velocity, the same of all particles.
    """

    ends: NDArray[np.int64]
    """Particles that each tendon draws together, (m, 2)."""

    def __init__(
        self,
        num_envs: int | None = None,
        scenes: Scene | Path | Iterable[Scene | Path] | None = None,
        *,
        tendons: ArrayLike | None = None,
        force: float = 1000.0,
        cycle: float = 0.5,
        push: float = 0.05,
        **options: Any,
    ) -> None:
        """Create the environments.

        ``scenes``: ``crawler()``, ``num_envs`` times, or others with as many particles in each; ``tendons``: the ends
        of each, (m, 2) indices of particles, 1 … 128 pairs; None: the eight edges along x and y of the box around the
        first body; ``force``: the largest tension [N], > 0; ``cycle``: of the clock [s], > 0; ``push``: the largest
        component of the velocity at the beginning [m/s], ≥ 0; ``options``: those of ``BatchEnv()``. Raises UsageError,
        SceneError.
        """
        if not (force > 0 and cycle > 0 and push >= 0):
            raise UsageError(f"force and cycle are > 0, push is ≥ 0, not {force}, {cycle}, {push}")
        made, first = scenes_of(crawler() if scenes is None else scenes)
        self.ends = _edges(first) if tendons is None else np.array(tendons, np.int64)
        if self.ends.ndim != 2 or self.ends.shape[1] != 2 or not 1 <= len(self.ends) <= 128:
            raise UsageError(f"tendons are 1 to 128 pairs of particles, (m, 2), not {self.ends.shape}")
        m = len(self.ends)
        box = gymnasium.spaces.Box
        super().__init__(
            made,
            num_envs,
            observation_space=box(-10.0, 10.0, (2 * m + 6,), np.float32),
            action_space=box(0.0, 1.0, (m,), np.float32),
            **options,
        )
        self.force, self.cycle, self.push = force, cycle, push
        x = self._keep_start()
        if self.ends.min() < 0 or self.ends.max() >= x.shape[1]:
            raise UsageError(f"a tendon's ends are indices of particles, 0 to {x.shape[1] - 1}")
        self._rest = self._spans(x)[1]
        if not (self._rest > 0).all():
            raise UsageError("the ends of a tendon are at different places")

    def act(self, actions: Any) -> None:
        """Pull the tendons."""
        x = self.batch.positions.astype(np.float64)
        across, length = self._spans(x)
        far = across / np.maximum(length, 1e-9)[:, :, None] * _FAR
        stiffness = self.force * actions.astype(np.float64) / _FAR
        anchors = np.stack([x[:, self.ends[:, 0]] + far, x[:, self.ends[:, 1]] - far], axis=2)
        ends = self.ends.tolist()
        for instance, ks, places in zip(self.batch, stiffness.tolist(), anchors.tolist()):
            instance.pulls = [
                Pull(end, place, k) for k, pair, two in zip(ks, ends, places) for end, place in zip(pair, two) if k > 0
            ]

    def observe(self) -> Floats:
        """Return clock, lengths, rates, velocity and height, (n, 2m + 6)."""
        x, v = self.batch.positions.astype(np.float64), self.batch.velocities.astype(np.float64)
        across, length = self._spans(x)
        difference = v[:, self.ends[:, 1]] - v[:, self.ends[:, 0]]
        rates = _dot(across, difference) / np.maximum(length, 1e-9)
        return seen(
            self._clock(), length / self._rest - 1, rates / self._rest, self._center(v), self._higher(x)
        )

    def _spans(self, x: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the vectors between the ends of tendons, (n, m, 3), and their lengths, (n, m)."""
        across = x[:, self.ends[:, 1]] - x[:, self.ends[:, 0]]
        return across, np.sqrt(_dot(across, across))


def _dot(a: NDArray[np.float64], b: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the dot product over the last axis, summed in a fixed order."""
    return a[..., 0] * b[..., 0] + a[..., 1] * b[..., 1] + a[..., 2] * b[..., 2]


def _edges(scene: Scene | Path) -> NDArray[np.int64]:
    """Return the edges along x and y of the first body's box, by the particles nearest to its corners."""
    sim = Simulation(scene, "cpu", threads=1)
    if not sim.bodies:
        raise UsageError("the scene has no body to crawl")
    body = sim[sim.bodies[0]]
    signs = list(itertools.product((-1, 1), repeat=3))
    corner = {sign: body.particles[int((body.positions * np.array(sign)).sum(axis=1).argmax())] for sign in signs}
    pairs = []
    for axis in (0, 1):
        for sign in signs:
            if sign[axis] < 0:
                other = tuple(1 if i == axis else s for i, s in enumerate(sign))
                pairs.append((corner[sign], corner[other]))
    return np.array(pairs, np.int64)


class CrawlEnv(SingleEnv):
    """A single environment of ``Crawl``: ``gymnasium.make("aspic/Crawl-v0")``."""

    def __init__(self, **options: Any):
        """Create the environment. ``options``: those of ``Crawl()`` except ``num_envs`` and ``autoreset_mode``."""
        super().__init__(Crawl(1, autoreset_mode=AutoresetMode.DISABLED, **options))
