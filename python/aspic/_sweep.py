"""Sweeps: a scene with many values, a run for each."""

from __future__ import annotations

import itertools
import math
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, Literal

from . import _aspic, _executors
from ._errors import UsageError, error_of
from ._folder import Folder, Row
from ._numbers import positive, whole
from ._runs import (
    SMALL,
    Differences,
    Order,
    Result,
    Study,
    is_made,
    make_runs,
    order,
    rejected_row,
    row_of,
    scene_of,
    smallest,
)
from ._scene import Scene, load
from ._simulation import Simulation
from ._table import AFTER, BEFORE, Table
from ._toml import toml_of
from ._trajectory import Energy, Recorder, Trajectory

__all__ = ["sweep"]

Metric = Callable[[Trajectory], Any]
Vary = Mapping[str, Iterable[Any]] | Iterable[Mapping[str, Any]]

# Short names take numbers and words as --vary does.
_SHORT = ("integrator", "h", "k", "c", "n", "e", "mu", "backend")


def sweep(
    scene: Scene | str | os.PathLike[str],
    vary: Vary,
    metrics: Mapping[str, Metric] | None = None,
    out: str | os.PathLike[str] | None = None,
    executor: Any = None,
    *,
    backend: str = "auto",
    precision: Literal["single", "double", None] = None,
    duration: float | None = None,
    steps: int | None = None,
    record: str | Sequence[str] | None = None,
    every: float | None = None,
    trajectories: bool = False,
    batch: int | None = None,
    threads: int = 0,
    workers: int = 0,
    retries: int = 3,
    submit: Mapping[str, Any] | None = None,
    progress: Callable[[int, int], Any] | None = None,
) -> Table:
    """Run a scene with every combination of values; return a table with a row for each run.

    ``scene``: one, or what ``aspic.load()`` takes. ``vary``: keys, each with its values, of which all combinations are
    made, the last key varying fastest; or dicts, a run each. A key is a path of ``--set``, ``"backend"``, or a short
    name of ``aspic sweep``: ``integrator``, ``h``, ``k``, ``c``, ``n``, ``e``, ``mu``. ``backend``, ``precision``: as
    of ``Simulation``; ``duration`` [s] or ``steps``: of each run, neither: the scene's duration.

    The table keeps the metrics of each run (docs/report.md), its hash, and

    ``metrics``: functions by the names of their columns. Each gets the run's ``Trajectory`` and returns a number, a
    word, True, False or None; it is called where the run is made. ``record``, ``every``: as of ``Simulation.run()``;
    None: what the metrics ask for, found by trying them on the scene's first step. ``trajectories``: keeps the records.
    ``out``: the folder of runs, a file each; a run that is there is not made again, whoever made it: another sweep,
    another machine, ``aspic sweep --runs``. None: nothing is kept.

    Where:

    ``executor``: None, this process; ``"processes"``, started by spawn; a ``distributed.Client`` or the address of a
    Dask scheduler, ``"tcp://…"``; a submitit executor, for Slurm; any executor like those of ``concurrent.futures``.
    ``workers``: of ``"processes"``; 0: a process for each CPU core. ``batch``: most runs that are sent and, if they
    are small, stepped together; None: 16 to 64. ``threads``: of each task; 0: the number of CPU cores here, one
    elsewhere. ``retries``: how often a task is repeated whose process died; ``submit``: keywords of Dask's
    ``Client.submit()``, such as ``resources``. ``progress``: called with the numbers of runs that are made and wanted.

    A run that diverges, is rejected, or fails is a row with its ``outcome`` and ``reason``; runs that failed are made
    again by the next call. Ctrl-C loses what is under way. Raises UsageError for arguments that are wrong, also for
    what a metric asks for and cannot be recorded, and SceneError for a key whose every value is rejected; FileError
    where the folder cannot be made.
    """
    if not isinstance(scene, Scene):
        scene = load(scene)
    if steps is not None and duration is not None:
        raise UsageError("a run is as long as either duration or steps say, not both")
    if steps is not None:
        steps = whole(steps, "a number of steps")
    if duration is not None:
        positive(duration, "duration [s]", zero=True)
    if every is not None:
        positive(every, "every, the interval of samples [s],")
    if batch is not None:
        batch = whole(batch, "batch, the most runs that are sent at once,", least=1)
    threads = whole(threads, "a number of threads", most=1024)
    if precision not in (None, "single", "double"):
        raise UsageError(f"a precision is 'single' or 'double', not {precision!r}")
    if trajectories and out is None:
        raise UsageError("trajectories are kept in a folder: out=…")
    metrics = dict(metrics or {})
    points = _points(vary)
    keys = list(dict.fromkeys(key for point in points for key, _ in point))
    _check_names(keys, metrics)
    if isinstance(record, str):
        record = [record]
    recorded = tuple(_asked(scene, metrics) if record is None else record)
    if record is not None:
        Recorder(Simulation._quiet(scene, "reference"), recorded)  # raises for names that cannot be recorded
    if trajectories and not recorded:
        raise UsageError("trajectories have what record=… names")
    here = executor is None
    study = Study(
        scene=scene.toml,
        name=scene.name,
        backend=backend,
        doubles=None if precision is None else precision == "double",
        steps=steps,
        duration=duration,
        record=recorded,
        every=every,
        metrics=metrics,
        recipes={name: "" if out is None else _recipe(name, metric, recorded, every) for name, metric in metrics.items()},
        trajectories=trajectories,
        batch=batch or 64,
        threads=threads or (0 if here else 1),
        folder=None if out is None else os.path.abspath(out),
        version=_aspic.version,
    )
    perform = _executors.submitter(executor, workers, retries, submit or {})
    rows = _Rows(study, points, progress)
    tasks = rows.tasks(batch, _executors.workers_of(executor, workers))
    ended = perform(make_runs, study, tasks)
    try:
        for task, results in ended:
            rows.take(task, results)
    finally:
        # At once, so that Ctrl-C ends what is under way.
        ended.close()  # type: ignore[attr-defined]
    return Table(rows.in_order(), study.folder, keys, metrics)


class _Rows:
    """The rows of a sweep: those that are there, and those that are still to come."""

    def __init__(self, study: Study, points: list[Differences], progress: Callable[[int, int], Any] | None):
        self._study, self._progress = study, progress
        self._folder = None if study.folder is None else Folder(study.folder)
        self._scene = scene_of(study)
        there: set[str] = set()
        if self._folder:
            self._folder.make(self._scene)
            there = self._folder.keys()
        self._keys: list[str] = []
        self._rows: dict[str, Row] = {}
        self._left: dict[str, tuple[Any, Differences]] = {}
        """By key, what runs that may be made together have in common, and the run's differences."""
        rejected: list[Order] = []
        for point in points:
            # A scene is some kilobytes: it is not kept.
            one = order(study, self._scene, point)
            self._keys.append(one.key)
            if one.key in self._rows or one.key in self._left:
                continue  # two points may be one run
            if one.error is not None:
                rejected.append(one)
                continue
            row = self._folder.read(one.key) if self._folder and one.key in there else None
            if row is not None and is_made(study, row):
                self._rows[one.key] = row
            else:
                small = one.particles <= SMALL
                alike = (one.timestep, one.steps, one.backend) if small else one.key
                self._left[one.key] = (alike, point)
        if rejected and not self._left and not self._rows:
            # A key that is wrong, rather than some of its values.
            assert rejected[0].error is not None
            raise error_of(*rejected[0].error)
        for one in rejected:
            self._take(Result(rejected_row(study, one), False))
        self._tell()

    def tasks(self, batch: int | None, workers: int) -> list[Sequence[Differences]]:
        """Return the remaining runs as tasks; small runs of one time step and length share one."""
        groups: dict[Any, list[Differences]] = {}
        for alike, point in self._left.values():
            groups.setdefault(alike, []).append(point)
        size = batch or _size(len(self._left), workers)
        return [group[i : i + size] for group in groups.values() for i in range(0, len(group), size)]

    def take(self, task: Sequence[Differences], results: Any) -> None:
        """Add the results of a task, or its exception."""
        if isinstance(results, BaseException):
            results = [self._lost(order(self._study, self._scene, point), _why(results)) for point in task]
        for result in results:
            self._take(result)
        self._tell()

    def _lost(self, run: Order, reason: str) -> Result:
        """Return the row of a run whose task ended with an exception; it may have been stored before."""
        row = self._folder.read(run.key) if self._folder else None
        if row is not None and is_made(self._study, row):
            return Result(row, True)
        return Result(row_of(self._study, run, "failed", reason), False)

    def in_order(self) -> list[Row]:
        """Return the rows of the points, in their order."""
        return [self._rows[key] for key in self._keys]

    def _take(self, result: Result) -> None:
        row = result.row
        if self._folder and not result.kept:
            try:
                self._folder.write(row, result.trajectory)
            except OSError as error:
                row = {**row, "outcome": "failed", "reason": f"its file cannot be written: {error}"}
        self._rows[row["key"]] = row

    def _tell(self) -> None:
        if self._progress:
            self._progress(len(self._rows), len(self._rows.keys() | self._left.keys()))


def _why(error: BaseException) -> str:
    """Return an exception in a line, with its cause."""
    import re

    lines = f"{type(error).__name__}: {error}".strip().split("\n")
    named = [line for line in lines[1:] if re.match(r"[\w.]+(Error|Exception|Exit|Interrupt)\b", line)]
    return " ".join([lines[0], *named[-1:]])


def _size(runs: int, workers: int) -> int:
    """Return the number of runs in a task: at least as many as share vector lanes, few enough for all workers."""
    share = math.ceil(runs / (4 * workers)) if workers else 16
    return min(64, max(16, 16 * math.ceil(share / 16)))


def _points(vary: Vary) -> list[Differences]:
    if isinstance(vary, Mapping):
        for key, values in vary.items():
            if isinstance(values, (str, bytes)) or not isinstance(values, Iterable):
                raise UsageError(f"{key!r} needs a list of values, not {values!r}")
        columns = [[(key, _word(key, value)) for value in values] for key, values in vary.items()]
        return list(itertools.product(*columns))
    points = []
    for point in vary:
        if not isinstance(point, Mapping):
            raise UsageError(f"vary is a dict of lists, or a list of dicts with a value for each key, not of {point!r}")
        points.append(tuple((key, _word(key, value)) for key, value in point.items()))
    return points


def _word(key: Any, value: Any) -> str:
    """Return a value as --vary takes it."""
    if not isinstance(key, str) or "=" in key:
        raise UsageError(f"a key of a sweep is a path such as 'cube[0].edge-length', or a short name, not {key!r}")
    if key in _SHORT and isinstance(value, str):
        return value
    return toml_of(value)


def _check_names(keys: Sequence[str], metrics: Mapping[str, Metric]) -> None:
    figures = [name for name, _ in _figures()]
    for name, metric in metrics.items():
        if not callable(metric):
            raise UsageError(f"the metric {name!r} is a function of a trajectory, not {type(metric).__name__}")
        if name in (*keys, *BEFORE, *AFTER, *figures):
            raise UsageError(f"the table has a column {name!r} already: give the metric another name")


def _figures() -> list[tuple[str, float | None]]:
    figures = _aspic.RunFigures(smallest()._core)
    figures.take(smallest()._core)
    return figures.figures()


class _Asked(Trajectory):
    """The first samples of a run, a step apart, recorded as they are asked for."""

    def __init__(self, scene: Scene, samples: int):
        import numpy as np

        simulation = Simulation._quiet(scene, "reference")
        self._states = [simulation.save()]
        while len(self._states) < samples and simulation.advance(1).steps == 1:
            self._states.append(simulation.save())
        self._simulation = simulation
        steps = np.arange(len(self._states))
        super().__init__(steps, steps * simulation.timestep, {})

    def __getitem__(self, name: str) -> Any:
        import numpy as np

        if name not in self._series:
            values = []
            for state in self._states:
                self._simulation.load(state)
                recorder = Recorder(self._simulation, [name])
                recorder.take()
                values.append(recorder.trajectory()[name])
            if isinstance(values[0], Energy):
                self._series[name] = Energy(*(np.concatenate(part) for part in zip(*values)))
            else:
                self._series[name] = np.concatenate(values)
        return self._series[name]

    def get(self, name: str, default: Any = None) -> Any:
        return self[name]


def _asked(scene: Scene, metrics: Mapping[str, Metric]) -> list[str]:
    """Return the names that metrics read from a trajectory. Raises UsageError for those that cannot be recorded."""
    if not metrics:
        return []
    import warnings

    found: dict[str, None] = {}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        few, more = _Asked(scene, 2), None
        for metric in metrics.values():
            try:
                metric(few)
                continue
            except UsageError:
                raise
            except Exception:
                pass  # two samples may be too few for it
            more = more or _Asked(scene, 64)
            try:
                metric(more)
            except UsageError:
                raise
            except Exception:
                pass  # each run says why
    for asked in (few, more):
        found.update(dict.fromkeys(asked or ()))
    return list(found)


def _recipe(name: str, metric: Metric, record: Sequence[str], every: float | None) -> str:
    """Return a hash of a metric's function and its data. Empty, with a warning: it has none."""
    import hashlib
    import warnings

    from ._identity import identity

    try:
        what = identity(metric)
    except Exception as error:
        warnings.warn(
            f"the metric {name!r} uses what cannot be pickled ({error}), so it is computed anew in every sweep",
            stacklevel=3,
        )
        return ""
    return hashlib.sha256(what + repr((sorted(record), every)).encode()).hexdigest()[:16]
