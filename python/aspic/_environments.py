"""Environments of Gymnasium over batches."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, Union

import gymnasium  # type: ignore[import-not-found, unused-ignore]
import numpy as np
from gymnasium.utils import seeding  # type: ignore[import-not-found, unused-ignore]
from gymnasium.vector import AutoresetMode, VectorEnv  # type: ignore[import-not-found, unused-ignore]
from gymnasium.vector.utils import batch_space  # type: ignore[import-not-found, unused-ignore]

from ._batch import Batch, Instance
from ._errors import Unshared, UsageError
from ._scene import Scene, load

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray

__all__ = ["BatchEnv", "SingleEnv"]

Path = Union[str, "os.PathLike[str]"]


class BatchEnv(Unshared, VectorEnv):  # type: ignore[misc, type-arg, unused-ignore]
    """The n instances of a batch as environments. Derive from it, and say what acts, what is seen and what it is worth.

    ``act()``, ``observe()`` and ``judge()`` are yours; ``begin()`` and ``figures()`` may be. They work with
    ``self.batch``. Steps, episodes, seeds, automatic resets, infos and images are done here. An environment whose
    instance diverges is terminated, at its last good state. Every array has the environment first.

    infos has what ``figures()`` gives, and ``diverged``, (n,) of bool; with automatic resets in the same step also
    ``final_obs`` and ``final_info``. Each environment has its own random generator, with the seed ``seed + i``, so its
    episodes do not depend on those of others.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 50}

    batch: Batch
    """The instances, which may be read and changed between two steps."""

    def __init__(
        self,
        scenes: Scene | Path | Iterable[Scene | Path],
        num_envs: int | None = None,
        *,
        observation_space: Any,
        action_space: Any,
        every: float = 0.02,
        episode: float = 8.0,
        autoreset_mode: AutoresetMode | str = AutoresetMode.NEXT_STEP,
        render_mode: str | None = None,
        width: int = 480,
        height: int = 270,
        threads: int = 0,
    ) -> None:
        """Create the batch. Derived classes call this first.

        ``scenes``: one, or what ``aspic.load()`` takes, of which ``num_envs`` (1) are made, or one for each
        environment, with equal time steps; ``observation_space``, ``action_space``: of a single environment; ``every``:
        how long an action acts [s], a multiple of the time step; ``episode``: after this time an episode is truncated
        [s]; ``autoreset_mode``: when the next episode begins, ``NEXT_STEP``, ``SAME_STEP`` or
        ``DISABLED`` (``reset()`` with the option ``reset_mask``); ``render_mode``: ``"rgb_array"`` or None; ``width``,
        ``height``: of images [pixels]; ``threads``: of the batch. Raises UsageError, and what ``Batch()`` raises.
        """
        if render_mode not in (None, *self.metadata["render_modes"]):
            raise UsageError(f"a render mode is 'rgb_array' or None, not {render_mode!r}")
        try:
            self.autoreset_mode = AutoresetMode(autoreset_mode)
        except ValueError:
            words = ", ".join(repr(mode.value) for mode in AutoresetMode)
            raise UsageError(f"a mode of automatic resets is one of {words}, not {autoreset_mode!r}") from None
        if isinstance(scenes, (Scene, str, os.PathLike)):
            made = [scenes if isinstance(scenes, Scene) else load(scenes)] * (1 if num_envs is None else num_envs)
        else:
            made = [scene if isinstance(scene, Scene) else load(scene) for scene in scenes]
            if num_envs not in (None, len(made)):
                raise UsageError(f"{len(made)} scenes make as many environments, not {num_envs}")
        self.batch = Batch(made, threads=threads)
        self.num_envs = len(self.batch)
        h = made[0]["simulation.timestep"]
        self._steps = _count("every", every, h)
        self._most = _count("episode", episode, self._steps * h)
        if any(scene["simulation.timestep"] != h for scene in made):
            raise UsageError("environments have the same time step")
        self.every: float = self._steps * h
        self.single_observation_space = observation_space
        self.single_action_space = action_space
        self.observation_space = batch_space(observation_space, self.num_envs)
        self.action_space = batch_space(action_space, self.num_envs)
        self.render_mode = render_mode
        self.metadata = {
            **self.metadata,
            "render_fps": max(1, round(1 / self.every)),
            "autoreset_mode": self.autoreset_mode,
        }
        self._size = (width, height)
        self._generators: list[tuple[np.random.Generator, int]] | None = None
        self._made = np.zeros(self.num_envs, np.int64)
        # Those whose episode is over; before the first reset that of all is.
        self._over = np.ones(self.num_envs, np.bool_)
        self._begun = False

    # What derived classes say.

    def act(self, actions: Any) -> None:
        """Set the inputs of the instances. ``actions``: (n, …), in the action space."""
        raise NotImplementedError

    def observe(self) -> Any:
        """Return observations of the present states: a new array (n, …), in the observation space."""
        raise NotImplementedError

    def judge(self) -> tuple[ArrayLike, ArrayLike]:
        """Return the rewards of the last step, (n,), and which episodes it ends, (n,) of bool.

        Those of environments that begin in this step do not count.
        """
        raise NotImplementedError

    def begin(self, index: int, instance: Instance, random: np.random.Generator) -> None:
        """Change an instance at the beginning of an episode, when it is at step 0 without inputs."""

    def figures(self) -> dict[str, NDArray[Any]]:
        """Return more values of infos: arrays of n numbers."""
        return {}

    # What Gymnasium asks for.

    def reset(
        self, *, seed: int | Sequence[int | None] | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin episodes; return observations, (n, …), and infos.

        ``seed``: environment i gets ``seed + i``, or one of a list; None: generators continue. ``options``: with
        ``reset_mask``, (n,) of bool, only those environments begin. Raises UsageError for other shapes and types.
        """
        mask = np.ones(self.num_envs, np.bool_)
        if options and "reset_mask" in options:
            mask = np.asarray(options["reset_mask"])
            if mask.shape != (self.num_envs,) or mask.dtype != np.bool_ or not mask.any():
                raise UsageError(f"reset_mask is an array of {self.num_envs} bool, at least one of them True")
        self._seed(seed, mask)
        self._begin(mask)
        self._begun = self._begun or bool(mask.all())
        return self.observe(), _infos(self._figures(), mask)

    def step(self, actions: Any) -> tuple[Any, Any, Any, Any, dict[str, Any]]:
        """Act for ``every`` s; return observations (n, …), rewards, terminations and truncations (n,), and infos.

        ``actions``: (n, …); numbers outside of the space become its nearest ones. Raises UsageError for another shape
        and for what is not finite, ``gymnasium.error.ResetNeeded`` before the first ``reset()`` and, without automatic
        resets, after the end of an episode. Ctrl-C (KeyboardInterrupt) leaves instances at different steps: ``reset()``
        all.
        """
        if not self._begun:
            raise gymnasium.error.ResetNeeded("call reset() before step()")
        fresh = self._over.copy()
        if self.autoreset_mode == AutoresetMode.DISABLED and fresh.any():
            raise gymnasium.error.ResetNeeded(
                f"the episode of environment {fresh.argmax()} is over: reset(options={{'reset_mask': over}}) begins one"
            )
        self.act(self._checked(actions))
        self._begun = False
        self.batch.step(self._steps)
        self._begun = True
        # All were stepped; those that begin go back after it.
        if fresh.any():
            self._begin(fresh)
        self._made += ~fresh
        given, ended = self.judge()
        rewards = np.where(fresh, 0.0, np.asarray(given, np.float64))
        figures = self._figures()
        terminations = (np.asarray(ended, np.bool_) | figures["diverged"]) & ~fresh
        truncations = self._made >= self._most
        self._over = terminations | truncations
        observations = self.observe()
        infos = _infos(figures, np.ones(self.num_envs, np.bool_))
        if self.autoreset_mode == AutoresetMode.SAME_STEP and self._over.any():
            over = self._over.copy()
            last = np.full(self.num_envs, None, dtype=object)
            for i in np.flatnonzero(over):
                last[i] = observations[i].copy()
            self._begin(over)
            observations = self.observe()
            infos = {
                **_infos(self._figures(), np.ones(self.num_envs, np.bool_)),
                "final_obs": last,
                "_final_obs": over,
                "final_info": _infos(figures, over),
                "_final_info": over.copy(),
            }
        return observations, rewards, terminations, truncations, infos

    def render(self) -> tuple[Any, ...] | None:
        """Return an image of each environment, (height, width, 3) of uint8; None without a render mode.

        Needs an OpenGL device, hardware or software (DeviceError). ``image(i)`` renders a single one.
        """
        if self.render_mode is None:
            return None
        return tuple(self.image(i) for i in range(self.num_envs))

    def image(self, index: int) -> Any:
        """Return an image of one environment, (height, width, 3) of uint8. Raises IndexError, DeviceError."""
        return np.asarray(self.batch[index].render(*self._size))

    picture = image  # until 0.4

    @property  # type: ignore[misc, unused-ignore]
    def np_random(self) -> tuple[np.random.Generator, ...]:  # type: ignore[override, unused-ignore]
        """Random generators of the environments."""
        return tuple(generator for generator, _ in self._random())

    @property
    def np_random_seed(self) -> tuple[int, ...]:  # type: ignore[misc, override, unused-ignore]
        """Seeds of the random generators."""
        return tuple(seed for _, seed in self._random())

    # Parts.

    def _random(self) -> list[tuple[np.random.Generator, int]]:
        if self._generators is None:
            self._generators = [seeding.np_random() for _ in range(self.num_envs)]
        return self._generators

    def _seed(self, seed: int | Sequence[int | None] | None, mask: NDArray[np.bool_]) -> None:
        if seed is None:
            return
        if isinstance(seed, (int, np.integer)):
            seeds: list[int | None] = [int(seed) + i for i in range(self.num_envs)]
        else:
            seeds = list(seed)
            if len(seeds) != self.num_envs:
                raise UsageError(f"{self.num_envs} environments take as many seeds, not {len(seeds)}")
        for i, (one, wanted) in enumerate(zip(seeds, mask)):
            if wanted and one is not None:
                self._random()[i] = seeding.np_random(one)

    def _begin(self, mask: NDArray[np.bool_]) -> None:
        self.batch.reset(mask)
        self._made[mask] = 0
        self._over[mask] = False
        for i in np.flatnonzero(mask):
            instance = self.batch[i]
            instance._core.set_inputs(([], [], [], []))
            self.begin(int(i), instance, self._random()[i][0])

    def _figures(self) -> dict[str, NDArray[Any]]:
        return {**self.figures(), "diverged": self.batch.diverged > 0}

    def _checked(self, actions: Any) -> Any:
        space = self.action_space
        if not isinstance(space, gymnasium.spaces.Box):
            if not space.contains(actions):
                raise UsageError(f"actions are not in {space}")
            return actions
        given = np.asarray(actions, space.dtype)
        if given.shape != space.shape:
            raise UsageError(f"actions have the shape {space.shape}, not {given.shape}")
        if not np.isfinite(given).all():
            raise UsageError(f"the action of environment {np.argwhere(~np.isfinite(given))[0][0]} is not finite")
        return np.clip(given, space.low, space.high)


def _count(name: str, duration: float, h: float) -> int:
    """Return a duration in time steps h, which it must be a multiple of to a millionth."""
    count = round(duration / h) if h > 0 and np.isfinite(duration) else 0
    if count < 1 or abs(count * h - duration) > 1e-6 * duration:
        raise UsageError(f"{name} is a multiple of {h:g} s, not {duration} s")
    return count


def _infos(figures: dict[str, NDArray[Any]], mask: NDArray[np.bool_]) -> dict[str, Any]:
    """Return infos in Gymnasium's form: an array by name, and which of its rows count."""
    infos: dict[str, Any] = {}
    for name, numbers in figures.items():
        infos[name] = np.where(mask, numbers, np.zeros((), numbers.dtype))
        infos[f"_{name}"] = mask.copy()
    return infos


class SingleEnv(Unshared, gymnasium.Env):  # type: ignore[misc, type-arg, unused-ignore]
    """A single environment: a BatchEnv of one, for what takes no vectors. Many in one BatchEnv are faster."""

    metadata: dict[str, Any] = BatchEnv.metadata

    def __init__(self, envs: BatchEnv):
        """Wrap ``envs``, a single environment with the mode ``DISABLED``. Raises UsageError for others."""
        if envs.num_envs != 1 or envs.autoreset_mode != AutoresetMode.DISABLED:
            raise UsageError("a single environment is a BatchEnv of one, without automatic resets")
        self.envs = envs
        self.observation_space = envs.single_observation_space
        self.action_space = envs.single_action_space
        self.render_mode = envs.render_mode
        self.metadata = {name: value for name, value in envs.metadata.items() if name != "autoreset_mode"}

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        """Begin an episode; return observation and info. ``seed``: of its random generator; None: it continues."""
        super().reset(seed=seed)
        # The generator is Gymnasium's.
        self.envs._generators = [(self.np_random, self.np_random_seed)]
        observations, infos = self.envs.reset(options=options)
        return observations[0], _of_one(infos)

    def step(self, action: Any) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Act for ``every`` s; return observation, reward, terminated, truncated, info. Raises as BatchEnv.step()."""
        observations, rewards, terminations, truncations, infos = self.envs.step(np.asarray(action)[None])
        return observations[0], float(rewards[0]), bool(terminations[0]), bool(truncations[0]), _of_one(infos)

    def render(self) -> Any:
        """Return an image, (height, width, 3) of uint8; None without a render mode."""
        return None if self.render_mode is None else self.envs.image(0)

    def close(self) -> None:
        """Close the environment."""
        self.envs.close()


def _of_one(infos: dict[str, Any]) -> dict[str, Any]:
    return {name: numbers[0].item() for name, numbers in infos.items() if not name.startswith("_")}
