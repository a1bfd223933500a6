"""Recorded runs."""

from __future__ import annotations

import functools
import json
import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _aspic, _exports
from ._body import weighted
from ._errors import UsageError
from ._scene import Scene

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from ._reading import Measures, Readable

__all__ = ["BatchTrajectory", "Diagnostic", "Energy", "Trajectory"]


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
        """Sum of the three energies."""
        return self.kinetic + self.elastic + self.gravitational


class Diagnostic(NamedTuple):
    """A warning of a scene or a run."""

    kind: str
    """``"flat-cells"``, ``"overlap"``, …: docs/commands.md lists them; also ``"step"`` and ``"solve"``."""
    body: str
    """The first that it is about; empty: none."""
    step: int
    """At which it was found."""
    text: str
    """Sentences: what was found, what it means and what to do."""


def json_of(warnings: Sequence[Diagnostic]) -> str:
    """Return warnings as exports hold them; empty without any."""
    return json.dumps([each._asdict() for each in warnings]) if warnings else ""


class Series(Mapping[str, Any]):
    """Arrays by the names that they were recorded by."""

    def __init__(self, series: dict[str, Any]):
        self._series = series

    def __getitem__(self, name: str) -> Any:
        for known in (name, name.replace("centre", "center")):
            if known in self._series:
                return self._series[known]
        raise UsageError(f"{name!r} was not recorded; this trajectory has {', '.join(self._series) or 'nothing'}")

    def get(self, name: str, default: Any = None) -> Any:
        """Return a series, or ``default`` where it was not recorded."""
        return self._series.get(name, default)

    def __contains__(self, name: object) -> bool:
        return name in self._series

    def __iter__(self) -> Iterator[str]:
        return iter(self._series)

    def _ipython_key_completions_(self) -> list[str]:
        return list(self._series)

    def __len__(self) -> int:
        """Return the number of series; ``time.shape`` counts samples."""
        return len(self._series)

    def _flat(self) -> dict[str, Any]:
        """Return arrays alone: an energy becomes three."""
        flat: dict[str, Any] = {}
        for name, value in self._series.items():
            if isinstance(value, Energy):
                flat.update({f"{name}.{part}": getattr(value, part) for part in Energy._fields})
            else:
                flat[name] = value
        return flat

    def _save(self, path: str | os.PathLike[str], overwrite: bool, arrays: dict[str, Any]) -> None:
        import numpy as np

        ending = os.path.splitext(os.fspath(path))[1]

        def write(name: str) -> None:
            if ending == ".npz":
                np.savez_compressed(name, **arrays)
                return
            try:
                import zarr  # type: ignore[import-not-found, unused-ignore]  # noqa: F401
            except ModuleNotFoundError:
                raise _exports.needs("zarr", "a trajectory as .zarr") from None
            data = self.to_xarray()
            # Text of any length is what the format knows.
            texts = {n: a.astype(object) for n, a in data.variables.items() if a.dtype.kind == "U"}
            data.assign_coords({n: texts.pop(n) for n in list(texts) if n in data.coords}).assign(texts).to_zarr(
                name, mode="w", consolidated=False
            )

        if ending not in (".npz", ".zarr"):
            raise UsageError(f"a trajectory is saved as .npz or .zarr, not as {os.fspath(path)!r}")
        _exports.write_complete(path, overwrite, write)

    def to_xarray(self) -> Any:
        """Return an ``xarray.Dataset``."""
        raise NotImplementedError

    def _dataset(self, sample: Sequence[str], arrays: dict[str, Any], coordinates: dict[str, Any], **more: Any) -> Any:
        """Return an ``xarray.Dataset``; ``sample``: the first dimensions of series."""
        try:
            import xarray  # type: ignore[import-not-found, unused-ignore]
        except ModuleNotFoundError:
            raise _exports.needs("xarray", "a dataset") from None
        variables = {}
        for name, array in arrays.items():
            kind = _exports.kind_of(name)
            attributes = {"long_name": kind.meaning, **({"units": kind.unit} if kind.unit else {})}
            before = () if name.startswith("model.") else tuple(sample)
            variables[name] = ((*before, *kind.dimensions), array, attributes)
        found = {d for dimensions, _, _ in variables.values() for d in dimensions}
        if "axis" in found:
            coordinates = {**coordinates, "axis": ["x", "y", "z"]}
        return xarray.Dataset(variables, coordinates, {"aspic_version": _aspic.version, **more})


def _arrays_of(path: str | os.PathLike[str]) -> dict[str, Any]:
    """Return the arrays of a file, by name."""
    import numpy as np

    if not os.fspath(path).endswith(".zarr"):
        with np.load(path, allow_pickle=False) as file:
            return {name: file[name] for name in file.files}
    try:
        import xarray
    except ModuleNotFoundError:
        raise _exports.needs("xarray and zarr", "a trajectory as .zarr") from None
    with xarray.open_zarr(os.fspath(path), consolidated=False) as data:
        arrays = {str(name): array.values for name, array in data.variables.items()}
        arrays = {name: np.array(a.tolist()) if a.dtype.kind in "OT" else a for name, a in arrays.items()}
        arrays.pop("axis", None)
        if "step" in arrays:
            arrays["steps"] = arrays.pop("step")
        arrays |= {name: data.attrs[name] for name in ("scene", "warnings") if name in data.attrs}
    return arrays


def _text(array: Any) -> str | None:
    """Return the text of an array or attribute; bytes are UTF-8."""
    if array is None or isinstance(array, str):
        return array
    return array.item().decode() if array.dtype.kind == "S" else str(array)


def _load(path: str | os.PathLike[str], *more: str) -> tuple[list[Any], dict[str, Any]]:
    """Return the arrays ``more``, and the series."""
    arrays = _arrays_of(path)
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
    """A recording of ``Simulation.run()``: ``trajectory["energy"].total``, ``trajectory["cube[0].center-of-mass"]``.

    Arrays have the samples first: positions (t, n, 3), a center of mass (t, 3), a speed (t,).
    """

    def __init__(
        self,
        steps: Any,
        time: Any,
        series: dict[str, Any],
        scene: Scene | None = None,
        warnings: Sequence[Diagnostic] = (),
    ):
        super().__init__(series)
        self.steps: NDArray[np.int64] = steps
        """Steps since the start, (t,)."""
        self.time: NDArray[np.float64] = time
        """[s], (t,)."""
        self.scene = scene
        """Backend that ran; None if a file does not have it."""
        self.warnings = list(warnings)
        """Warnings of the simulation by the end of the run: flat cells, overlaps and others."""

    @functools.cached_property
    def model(self) -> dict[str, Any]:
        """Constant arrays, by the names of exports (docs/exports.md): ``model["model.springs"]``, ….

        Raises UsageError where the scene is not known.
        """
        return _exports.model_arrays(_exports.scene_of(self))

    def __repr__(self) -> str:
        return f"<aspic.Trajectory: {len(self.time)} samples of {', '.join(self._series) or 'nothing'}>"

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name != "model"}

    def _arrays(self) -> dict[str, Any]:
        """Return series, and constant arrays if a series is of all particles or springs."""
        flat = self._flat()
        return {**flat, **self.model} if self.scene is not None and _exports.about_all(flat) else flat

    def _texts(self) -> dict[str, str]:
        """Return the scene and the warnings, if there are any."""
        scene = {} if self.scene is None else {"scene": self.scene.toml}
        return {**scene, "warnings": json_of(self.warnings)} if self.warnings else scene

    def save(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Write the record for ``load()``: a compressed .npz of numpy, or a folder .zarr.

        Both hold ``steps``, ``time`` and the scene, and with positions, strains or the like also masses, springs and
        surfaces. They appear complete or not at all. .zarr needs the packages xarray and zarr. Raises UsageError where
        the name has another ending; FileExistsError unless ``overwrite``.
        """
        self._save(path, overwrite, {"steps": self.steps, "time": self.time, **self._arrays(), **self._texts()})

    def _write(self, file: Any) -> None:
        """Write the record to an open file, as ``save()``."""
        import numpy as np

        np.savez_compressed(file, steps=self.steps, time=self.time, **self._flat())

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Trajectory:
        """Read what ``save()`` wrote, or ``aspic run --export`` as .npz. Raises what ``numpy.load()`` raises."""
        (steps, time), series = _load(path, "steps", "time")
        scene, warnings = (_text(series.pop(name, None)) for name in ("scene", "warnings"))
        series = {name: array for name, array in series.items() if not name.startswith("model.")}
        found = [Diagnostic(**each) for each in json.loads(warnings or "[]")]
        return cls(steps, time, series, None if scene is None else Scene(scene), found)

    def export(self, path: str | os.PathLike[str], overwrite: bool = False, *, springs: bool = False) -> None:
        """Write the motion for other programs (docs/exports.md).

        ``path``: .pvd (ParaView), .pc2 (Blender), .npz (numpy) or .zarr, or .usd, .usda, .usdc by the package usd-core;
        ``springs``: in USD also the springs of bodies that have a skin, which makes files large. Needs what
        ``record=["motion"]`` records; USD and .zarr take what there is. Contact and force are those of a run without
        pulls. Files appear complete or not at all. Raises UsageError, also for other endings; FileError or
        FileExistsError where a file exists, unless ``overwrite``.
        """
        _exports.export(self, path, overwrite, springs)

    def to_xarray(self) -> Any:
        """Return an ``xarray.Dataset`` with the coordinate ``time`` and units; needs the package xarray.

        With what is recorded of all particles or springs it holds masses, springs and surfaces too, ``model.…``.
        """
        coordinates = {
            "time": ("time", self.time, {"units": "s", "long_name": "time"}),
            "step": ("time", self.steps),
        }
        return self._dataset(("time",), self._arrays(), coordinates, **self._texts())


class BatchTrajectory(Series):
    """A recording of ``Batch.run()``: ``out["center-of-mass"]``, ``out["energy"].total``, ``out["cube[0].positions"]``.

    Arrays have the instance first, then the sample: a center of mass (n, t, 3), positions (n, t, p, 3). The rows after
    a divergence repeat the last good state.
    """

    def __init__(self, time: Any, diverged: Any, hashes: list[str], series: dict[str, Any]):
        super().__init__(series)
        self.time: NDArray[np.float64] = time
        """Times of each instance's samples, (n, t) [s]: its steps × its h."""
        self.diverged: NDArray[np.int64] = diverged
        """The step that failed, (n,); 0: the instance did not diverge."""
        self.hash: list[str] = hashes
        """Hash of each instance's last state, as ``Simulation.hash`` of its scene alone."""

    def __repr__(self) -> str:
        instances, samples = self.time.shape
        return (
            f"<aspic.BatchTrajectory: {instances} instances, {samples} samples of "
            f"{', '.join(self._series) or 'nothing'}>"
        )

    def save(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Write the record with ``time``, ``diverged`` and ``hash``: a compressed .npz, or a folder .zarr.

        It appears complete or not at all. .zarr needs the packages xarray and zarr. Raises UsageError where the name
        has another ending; FileExistsError unless ``overwrite``.
        """
        import numpy as np

        more = {"time": self.time, "diverged": self.diverged, "hash": np.array(self.hash)}
        self._save(path, overwrite, {**more, **self._flat()})

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> BatchTrajectory:
        """Read what ``save()`` wrote. Raises what ``numpy.load()`` raises."""
        (time, diverged, hashes), series = _load(path, "time", "diverged", "hash")
        return cls(time, diverged, hashes.tolist(), series)

    def to_xarray(self) -> Any:
        """Return an ``xarray.Dataset`` with the dimensions ``instance`` and ``sample``; needs the package xarray.

        ``time`` is that of each instance's samples; ``diverged`` and ``hash`` are of instances.
        """
        coordinates = {
            "time": (("instance", "sample"), self.time, {"units": "s", "long_name": "time"}),
            "diverged": ("instance", self.diverged, {"long_name": "the step that failed; 0: none did"}),
            "hash": ("instance", self.hash, {"long_name": "hash of the last state"}),
        }
        return self._dataset(("instance", "sample"), self._flat(), coordinates)


# Names that can be recorded: measures that need no springs, arrays of all particles, arrays of a body.
_OF_MOTION = ("momentum", "max-speed", "min-height")
_ARRAYS = ("positions", "velocities")
_OF_BALLS = ("ball-positions", "ball-velocities", "ball-angular-velocities")
# In the order in which the library tells them.
_QUANTITIES = ("speed", "mean-strain", "force", "contact-force", "contact", "strain", "tension")
_OF_BODIES = ("center-of-mass", "momentum")


class _Sample:
    """Quantities of a state, each read at most once."""

    def __init__(self, simulation: Readable):
        self._simulation = simulation

    @functools.cached_property
    def energy(self) -> Energy:
        return self._simulation.energy

    @functools.cached_property
    def motion(self) -> Measures:
        return self._simulation._motion

    @functools.cached_property
    def positions(self) -> Any:
        return self._simulation.positions

    @functools.cached_property
    def velocities(self) -> Any:
        return self._simulation.velocities

    @functools.cached_property
    def quantities(self) -> dict[str, Any]:
        """Quantities in the precision of the run."""
        core = self._simulation._core
        float_type = "float64" if core.doubles else "float32"
        found: dict[str, Any] = dict(zip(_QUANTITIES, core.quantities()))
        return {name: a if a.dtype == "uint8" else a.astype(float_type, copy=False) for name, a in found.items()}

    @functools.cached_property
    def hash(self) -> str:
        return self._simulation.hash


def _of_motion(simulation: Readable) -> list[str]:
    """Return the quantities of exports."""
    core = simulation._core
    left = set() if core.balls() else set(_OF_BALLS)
    if core.add_work(_aspic.ActuatorWork()) is None:
        left.add("actuator-work")
    return [name for name in _exports.MOTION if name not in left]


class Recorder:
    """Takes samples of a simulation. Raises UsageError for a name that cannot be recorded."""

    def __init__(self, simulation: Readable, names: Sequence[str]):
        if isinstance(names, str):
            names = [names]
        self._work = _aspic.ActuatorWork()
        motion = _of_motion(simulation) if "motion" in names else []
        names = [part for name in names for part in (motion if name == "motion" else [name])]
        self._simulation = simulation
        self._samples: dict[str, list[Any]] = {name: [] for name in names}
        self._steps: list[int] = []
        self._takers = {name: self._taker(name) for name in names}

    def _taker(self, name: str) -> Callable[[_Sample], Any]:
        body, _, what = name.rpartition(".")
        what = _exports.plain(what)
        if not body:
            if what == "energy":
                return lambda s: s.energy
            if what in _OF_MOTION:
                return lambda s: getattr(s.motion, what.replace("-", "_"))
            if what in _ARRAYS:
                return lambda s: getattr(s, what)
            if what in _OF_BALLS:
                return lambda s: self._simulation.read(what.replace("-", "_"))
            if what in _QUANTITIES:
                return lambda s: s.quantities[what]
            if what == "actuator-work":
                return lambda s: self._simulation._core.add_work(self._work) or 0.0
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
        parts = ("center-of-mass", "hash", "actuator-work")
        known = ["motion", "energy", *_OF_MOTION, *_ARRAYS, *parts, *_QUANTITIES, *_OF_BALLS]
        raise UsageError(
            f"{name!r} cannot be recorded; {', '.join(known)} can, and of a body "
            f"{', '.join(f'{self._example()}.{part}' for part in _ARRAYS + _OF_BODIES)}"
        )

    def _example(self) -> str:
        return next(iter(self._simulation.bodies), "cube[0]")

    def take(self) -> None:
        """Add the present state."""
        sample = _Sample(self._simulation)
        self._steps.append(self._simulation.steps)
        for name, taker in self._takers.items():
            self._samples[name].append(taker(sample))

    def trajectory(self) -> Trajectory:
        """Return all samples so far."""
        import numpy as np

        steps = np.array(self._steps, dtype=np.int64)
        series: dict[str, Any] = {}
        for name, samples in self._samples.items():
            if samples and isinstance(samples[0], Energy):
                series[name] = Energy(*(np.array(part, dtype=np.float64) for part in zip(*samples)))
            else:
                series[name] = np.array(samples)
        sim = self._simulation
        return Trajectory(steps, steps * sim.timestep, series, sim.scene, getattr(sim, "warnings", ()))
