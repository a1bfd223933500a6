"""What a run recorded."""

from __future__ import annotations

import functools
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from ._body import weighted
from ._errors import UsageError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ._reading import Measures, Readable

__all__ = ["BatchTrajectory", "Energy", "Trajectory"]


class Energy(NamedTuple):
    """Energies [J]: numbers of one state, or arrays of several: (t,) of a trajectory, (n, t) of a batch's."""

    kinetic: Any
    """Σ ½ m v², of balls also ½ I ω²."""
    elastic: Any
    """Σ ½ k (L − r)²; a slack cord holds none."""
    gravitational: Any
    """−Σ m g·x, zero at the origin."""

    @property
    def total(self) -> Any:
        """Of all three."""
        return self.kinetic + self.elastic + self.gravitational


class Series(Mapping[str, Any]):
    """Arrays by the names that they were recorded by."""

    def __init__(self, series: dict[str, Any]):
        self._series = series

    def __getitem__(self, name: str) -> Any:
        if name in self._series:
            return self._series[name]
        raise UsageError(f"{name!r} was not recorded; this trajectory has {', '.join(self._series) or 'nothing'}")

    def get(self, name: str, default: Any = None) -> Any:
        """A series, or ``default`` where it was not recorded."""
        return self._series.get(name, default)

    def __contains__(self, name: object) -> bool:
        return name in self._series

    def __iter__(self) -> Iterator[str]:
        return iter(self._series)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._series)

    def __len__(self) -> int:
        """How many series there are; ``time.shape`` counts samples."""
        return len(self._series)

    def _flat(self) -> dict[str, Any]:
        """Arrays alone: an energy becomes three."""
        flat: dict[str, Any] = {}
        for name, value in self._series.items():
            if isinstance(value, Energy):
                flat.update({f"{name}.{part}": getattr(value, part) for part in Energy._fields})
            else:
                flat[name] = value
        return flat

    def _savez(self, path: str | os.PathLike[str], overwrite: bool, **more: Any) -> None:
        import numpy as np

        if not os.fspath(path).endswith(".npz"):
            raise UsageError(f"a trajectory is saved as .npz, not as {os.fspath(path)!r}")
        with open(path, "wb" if overwrite else "xb") as file:
            np.savez_compressed(file, **more, **self._flat())


def _loadz(path: str | os.PathLike[str], *more: str) -> tuple[list[Any], dict[str, Any]]:
    """The arrays ``more``, and the series."""
    import numpy as np

    with np.load(path, allow_pickle=False) as file:
        arrays = {name: file[name] for name in file.files}
    others = [arrays.pop(name) for name in more]
    series: dict[str, Any] = {}
    for name, array in arrays.items():
        base, _, part = name.rpartition(".")
        if base.split(".")[-1] == "energy" and part in Energy._fields:
            series.setdefault(base, {})[part] = array
        else:
            series[name] = array
    return others, {n: Energy(**v) if isinstance(v, dict) else v for n, v in series.items()}


class Trajectory(Series):
    """What ``Simulation.run()`` recorded: ``trajectory["energy"].total``, ``trajectory["cube[0].centre-of-mass"]``.

    Arrays have the samples first: positions (t, n, 3), a centre of mass (t, 3), a speed (t,).
    """

    def __init__(self, steps: Any, time: Any, series: dict[str, Any]):
        super().__init__(series)
        self.steps: NDArray[np.int64] = steps
        """Steps since the start, (t,)."""
        self.time: NDArray[np.float64] = time
        """[s], (t,)."""

    def __repr__(self) -> str:
        return f"<aspic.Trajectory: {len(self.time)} samples of {', '.join(self._series) or 'nothing'}>"

    def save(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Writes a compressed .npz of numpy, with ``steps`` and ``time``.

        Raises UsageError where the name has another ending; FileExistsError unless ``overwrite``.
        """
        self._savez(path, overwrite, steps=self.steps, time=self.time)

    def _write(self, file: Any) -> None:
        """Writes it as ``save()`` does into an open file."""
        import numpy as np

        np.savez_compressed(file, steps=self.steps, time=self.time, **self._flat())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Trajectory:
        """Reads what ``save()`` wrote. Raises what ``numpy.load()`` raises."""
        (steps, time), series = _loadz(path, "steps", "time")
        return cls(steps, time, series)

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` with the coordinate ``time``; needs the package xarray."""
        import xarray  # type: ignore[import-not-found, unused-ignore]

        variables = {}
        for name, array in self._flat().items():
            others = {1: [], 2: ["axis"], 3: [f"{name}.particle", "axis"]}[array.ndim]
            variables[name] = (["time", *others], array)
        return xarray.Dataset(variables, coords={"time": self.time, "step": ("time", self.steps)})


class BatchTrajectory(Series):
    """What ``Batch.run()`` recorded: ``out["centre-of-mass"]``, ``out["energy"].total``, ``out["cube[0].positions"]``.

    Arrays have the instance first, then the sample: a centre of mass (n, t, 3), positions (n, t, p, 3). The rows after
    a divergence repeat the last good state.
    """

    def __init__(self, time: Any, diverged: Any, hashes: list[str], series: dict[str, Any]):
        super().__init__(series)
        self.time: NDArray[np.float64] = time
        """Of each instance's samples, (n, t) [s]: its steps × its h."""
        self.diverged: NDArray[np.int64] = diverged
        """The step that failed, (n,); 0: the instance did not diverge."""
        self.hash: list[str] = hashes
        """Of each instance's last state: what ``Simulation.hash`` of its scene alone is."""

    def __repr__(self) -> str:
        instances, samples = self.time.shape
        return (
            f"<aspic.BatchTrajectory: {instances} instances, {samples} samples of "
            f"{', '.join(self._series) or 'nothing'}>"
        )

    def save(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Writes a compressed .npz of numpy, with ``time``, ``diverged`` and ``hash``.

        Raises UsageError where the name has another ending; FileExistsError unless ``overwrite``.
        """
        import numpy as np

        self._savez(path, overwrite, time=self.time, diverged=self.diverged, hash=np.array(self.hash))

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> BatchTrajectory:
        """Reads what ``save()`` wrote. Raises what ``numpy.load()`` raises."""
        (time, diverged, hashes), series = _loadz(path, "time", "diverged", "hash")
        return cls(time, diverged, hashes.tolist(), series)


# What may be recorded: of a state's measures, of all particles or of a body.
_OF_ALL: dict[str, Callable[[Measures], Any]] = {
    "energy": lambda m: m.energy,
    "momentum": lambda m: m.momentum,
    "max-speed": lambda m: m.max_speed,
    "min-height": lambda m: m.min_height,
}
_ARRAYS = ("positions", "velocities")
_OF_BODIES = ("centre-of-mass", "momentum")


class _Sample:
    """What is read of a state, at most once."""

    def __init__(self, simulation: Readable):
        self._simulation = simulation

    @functools.cached_property
    def measures(self) -> Measures:
        return self._simulation.measures

    @functools.cached_property
    def positions(self) -> Any:
        return self._simulation.positions

    @functools.cached_property
    def velocities(self) -> Any:
        return self._simulation.velocities

    @functools.cached_property
    def hash(self) -> str:
        return self._simulation.hash


class Recorder:
    """Takes samples of a simulation. Raises UsageError for a name that cannot be recorded."""

    def __init__(self, simulation: Readable, names: Sequence[str]):
        if isinstance(names, str):
            names = [names]
        self._simulation = simulation
        self._samples: dict[str, list[Any]] = {name: [] for name in names}
        self._steps: list[int] = []
        self._takers = {name: self._taker(name) for name in names}

    def _taker(self, name: str) -> Callable[[_Sample], Any]:
        body, _, what = name.rpartition(".")
        what = what.replace("_", "-")
        if not body:
            if what in _OF_ALL:
                measure = _OF_ALL[what]
                return lambda s: measure(s.measures)
            if what in _ARRAYS:
                return lambda s: getattr(s, what)
            if what == "hash":
                return lambda s: s.hash
            particles = slice(None)
        elif what in _ARRAYS + _OF_BODIES:
            found = self._simulation[body].particles
            particles = slice(found.start, found.stop)
        if what in _ARRAYS:
            return lambda s: getattr(s, what)[particles]
        if what in _OF_BODIES:
            masses = self._simulation.masses[particles]
            if what == "momentum":
                return lambda s: weighted(masses, s.velocities[particles])
            return lambda s: weighted(masses, s.positions[particles]) / float(masses.sum())
        known = [*_OF_ALL, *_ARRAYS, "centre-of-mass", "hash"]
        raise UsageError(
            f"{name!r} cannot be recorded; {', '.join(known)} can, and of a body "
            f"{', '.join(f'{self._example()}.{part}' for part in _ARRAYS + _OF_BODIES)}"
        )

    def _example(self) -> str:
        return next(iter(self._simulation.bodies), "cube[0]")

    def take(self) -> None:
        """The state as it is."""
        sample = _Sample(self._simulation)
        self._steps.append(self._simulation.steps)
        for name, taker in self._takers.items():
            self._samples[name].append(taker(sample))

    def trajectory(self) -> Trajectory:
        """All samples so far."""
        import numpy as np

        steps = np.array(self._steps, dtype=np.int64)
        series: dict[str, Any] = {}
        for name, samples in self._samples.items():
            if samples and isinstance(samples[0], Energy):
                series[name] = Energy(*(np.array(part, dtype=np.float64) for part in zip(*samples)))
            else:
                series[name] = np.array(samples)
        return Trajectory(steps, steps * self._simulation.timestep, series)
