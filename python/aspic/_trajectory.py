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

    from ._reading import Measures
    from ._simulation import Simulation

__all__ = ["Energy", "Trajectory"]


class Energy(NamedTuple):
    """Energies [J]: numbers of one state, or arrays (t,) of a trajectory."""

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


class Trajectory(Mapping[str, Any]):
    """What ``Simulation.run()`` recorded: ``trajectory["energy"].total``, ``trajectory["cube[0].centre-of-mass"]``.

    Arrays have the samples first: positions (t, n, 3), a centre of mass (t, 3), a speed (t,).
    """

    def __init__(self, steps: Any, time: Any, series: dict[str, Any]):
        self.steps: NDArray[np.int64] = steps
        """Steps since the start, (t,)."""
        self.time: NDArray[np.float64] = time
        """[s], (t,)."""
        self._series = series

    def __getitem__(self, name: str) -> Any:
        if name in self._series:
            return self._series[name]
        raise UsageError(f"{name!r} was not recorded; this trajectory has {', '.join(self._series)}")

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
        """How many series there are; ``len(trajectory.time)`` counts samples."""
        return len(self._series)

    def __repr__(self) -> str:
        return f"<aspic.Trajectory: {len(self.time)} samples of {', '.join(self._series) or 'nothing'}>"

    def _flat(self) -> dict[str, Any]:
        """Arrays alone: an energy becomes three."""
        flat: dict[str, Any] = {}
        for name, value in self._series.items():
            if isinstance(value, Energy):
                flat.update({f"{name}.{part}": getattr(value, part) for part in Energy._fields})
            else:
                flat[name] = value
        return flat

    def save(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Writes a compressed .npz of numpy, with ``steps`` and ``time``.

        Raises UsageError where the name has another ending; FileExistsError unless ``overwrite``.
        """
        import numpy as np

        if not os.fspath(path).endswith(".npz"):
            raise UsageError(f"a trajectory is saved as .npz, not as {os.fspath(path)!r}")
        with open(path, "wb" if overwrite else "xb") as file:
            np.savez_compressed(file, steps=self.steps, time=self.time, **self._flat())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Trajectory:
        """Reads what ``save()`` wrote. Raises what ``numpy.load()`` raises."""
        import numpy as np

        with np.load(path, allow_pickle=False) as file:
            arrays = {name: file[name] for name in file.files}
        steps, time = arrays.pop("steps"), arrays.pop("time")
        series: dict[str, Any] = {}
        for name, array in arrays.items():
            base, _, part = name.rpartition(".")
            if base.split(".")[-1] == "energy" and part in Energy._fields:
                series.setdefault(base, {})[part] = array
            else:
                series[name] = array
        return cls(steps, time, {n: Energy(**v) if isinstance(v, dict) else v for n, v in series.items()})

    def to_xarray(self) -> Any:
        """An ``xarray.Dataset`` with the coordinate ``time``; needs the package xarray."""
        import xarray  # type: ignore[import-not-found, unused-ignore]

        variables = {}
        for name, array in self._flat().items():
            others = {1: [], 2: ["axis"], 3: [f"{name}.particle", "axis"]}[array.ndim]
            variables[name] = (["time", *others], array)
        return xarray.Dataset(variables, coords={"time": self.time, "step": ("time", self.steps)})


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

    def __init__(self, simulation: Simulation):
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

    def __init__(self, simulation: Simulation, names: Sequence[str]):
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
