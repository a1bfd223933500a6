"""The runs of a sweep where they are computed: in this process, in another one, on another machine."""

from __future__ import annotations

import functools
import json
import time
from collections.abc import Callable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from . import _aspic
from ._batch import Batch, Instance
from ._errors import Error, ErrorCode, UsageError, error_of
from ._folder import Folder, Row
from ._scene import Scene, load
from ._simulation import Simulation
from ._trajectory import Recorder, Trajectory

__all__ = ["Order", "Result", "Study", "make_runs"]

# Keys and values of a run, as --set takes them, but for words.
Differences = tuple[tuple[str, str], ...]

SMALL = 2048
"""Particles up to which a batch has runs in the lanes of vector registers."""


class Study(NamedTuple):
    """Common data of all runs of a sweep. It is sent with every task."""

    scene: str
    name: str
    backend: str
    doubles: bool | None
    steps: int | None
    duration: float | None
    record: tuple[str, ...]
    every: float | None
    metrics: Mapping[str, Callable[[Trajectory], Any]]
    recipes: Mapping[str, str]
    """Hash of each metric's function and of its sources; empty: it is not reused."""
    trajectories: bool
    batch: int
    """Most runs that are stepped together."""
    threads: int
    folder: str | None
    version: str


Order = _aspic.SweepRun
"""A run that is to be made."""


class Result(NamedTuple):
    """A run that was made. ``kept``: its file is there, and the trajectory is left out."""

    row: Row
    kept: bool
    trajectory: Trajectory | None = None


def order(study: Study, scene: Scene, differences: Differences) -> Order:
    """Return the run of a sweep's scene with differences. Raises UsageError for an unknown backend."""
    return _aspic.sweep_run(scene._core, study.backend, study.doubles, list(differences), study.steps, study.duration)


def is_made(study: Study, row: Row | None) -> bool:
    """Return whether a run's file has everything requested. A failed run may be repeated."""
    if row is None or row["outcome"] == "failed":
        return False
    if row["outcome"] == "ok":
        metrics = row.get("metrics", {})
        if any(not recipe or metrics.get(name, {}).get("recipe") != recipe for name, recipe in study.recipes.items()):
            return False
    wanted = {"record": list(study.record), "every": study.every}
    return not study.trajectories or row["outcome"] == "rejected" or row.get("trajectory") == wanted


def row_of(study: Study, run: Order, outcome: str, reason: str, **result: Any) -> Row:
    """Return the row of a run; without metrics unless ``result`` has them."""
    reason = " ".join(reason.split()).encode("utf-8", "replace").decode()
    row: Row = json.loads(run.file(_scene_key(study.scene, study.name), outcome, reason, **result))
    return row


def rejected_row(study: Study, run: Order) -> Row:
    """Return the row of a run that its scene or backend rejected."""
    code, message = run.error or (0, "")
    # Its first line says what is wrong; others show where.
    return row_of(study, run, "rejected", str(error_of(code, message)).split("\n")[0])


def scene_of(study: Study) -> Scene:
    """Return the base scene of the runs."""
    return _read(study.scene, study.name)


@functools.lru_cache(maxsize=4)
def _read(text: str, name: str) -> Scene:
    return Scene(text, name)


@functools.lru_cache(maxsize=4)
def _scene_key(text: str, name: str) -> str:
    return _aspic.scene_key(_read(text, name)._core)


class _Running:
    """A run on its way: its figures, what it records, and its end."""

    def __init__(self, study: Study, run: Order, where: Simulation | Instance, solver: str):
        self.run, self.solver, self.seconds = run, solver, 0.0
        self.where = where
        self.figures = _aspic.RunFigures(where._core)
        self.recorder = Recorder(where, study.record) if study.record or study.metrics else None
        self.reason: str | None = None
        """Message of the divergence that ends the run."""

    def take(self, figures: bool, record: bool) -> None:
        if self.reason is None:
            if figures:
                self.figures.take(self.where._core)
            if record and self.recorder:
                self.recorder.take()

    def diverge(self, reason: str) -> None:
        if self.reason is None:
            self.reason = reason
            self.figures.take(self.where._core)

    def result(self, study: Study) -> tuple[Row, Trajectory | None]:
        row = row_of(
            study,
            self.run,
            "ok" if self.reason is None else "diverged",
            self.reason or "",
            figures=self.figures,
            steps=self.where.steps,
            hash=self.where.hash,
            solver=self.solver,
            seconds=self.seconds,
        )
        trajectory = self.recorder.trajectory() if self.recorder else None
        if self.reason is None and trajectory is not None and study.metrics:
            row["metrics"] = {}
            for name, metric in study.metrics.items():
                try:
                    value = number(metric(trajectory))
                except Exception as error:
                    # What a user's function raises is the run's end, not the sweep's.
                    advice = ""
                    if isinstance(error, UsageError) and "was not recorded" in str(error):
                        advice = ": name all that metrics read in record=[…]"
                    row.update(outcome="failed", reason=f"metric {name}: {type(error).__name__}: {error}{advice}")
                    break
                row["metrics"][name] = {"value": value, "recipe": study.recipes[name]}
        if study.trajectories:
            row["trajectory"] = {"record": list(study.record), "every": study.every}
        return row, trajectory if study.trajectories else None


def number(value: Any) -> Any:
    """Return a metric's value for a table. Raises UsageError for values that fit no cell."""
    import math

    if hasattr(value, "item") and getattr(value, "shape", None) == ():
        value = value.item()
    if isinstance(value, float):
        return value if math.isfinite(value) else None
    if value is None or isinstance(value, (bool, int, str)):
        return value
    what = f"an array of the shape {value.shape}" if hasattr(value, "shape") else type(value).__name__
    raise UsageError(f"a metric is a number, a word, True, False or None, not {what}")


def _marks(study: Study, steps: int, timestep: float) -> Iterator[tuple[int, bool, bool]]:
    """Return the steps after which states are sampled, for the metrics and for the record."""
    stride = _aspic.RunFigures.interval(timestep)
    k, figure, record = 0, stride, _next_sample(study, steps, timestep, 0, 0)
    done = 0
    while done < steps:
        done = min(figure, record[0], steps)
        yield done, done == min(figure, steps), done == record[0]
        if done == figure:
            figure += stride
        if done == record[0]:
            k = record[1]
            record = _next_sample(study, steps, timestep, k, done)


def _next_sample(study: Study, steps: int, timestep: float, k: int, done: int) -> tuple[int, int]:
    """Return the step and number of the next sample, as in Simulation.run(); beyond the end: none."""
    if study.every is None:
        return (steps, 1) if k == 0 else (steps + 1, k)
    while True:
        k += 1
        wanted = round(k * max(study.every, timestep) / timestep)
        if wanted > done:
            return wanted, k


def _drive(study: Study, runs: Sequence[_Running], advance: Callable[[int], None]) -> None:
    """Advance runs of one time step and number of steps to their ends."""
    steps, timestep = runs[0].run.steps, runs[0].where.timestep
    for run in runs:
        run.take(True, True)
    done = 0
    for mark, figures, record in _marks(study, steps, timestep):
        before = time.perf_counter()
        advance(mark - done)
        share = (time.perf_counter() - before) / len(runs)
        done = mark
        for run in runs:
            run.seconds += share
            run.take(figures, record)
        if all(run.reason is not None for run in runs):
            return


def _reason(found: tuple[int, int, bool, str]) -> str:
    step, _, _, text = found
    return f"{text} in step {step}"


def _alone(study: Study, run: Order, backend: str) -> tuple[Row, Trajectory | None]:
    """Run with a separate solver."""
    simulation = Simulation._quiet(
        Scene._of(run.scene), backend, threads=study.threads if backend.startswith("cpu") else 0
    )
    running = _Running(study, run, simulation, simulation.backend)

    def advance(steps: int) -> None:
        _, found, _ = simulation._core.advance(steps)
        if found:
            running.diverge(_reason(found))

    _drive(study, [running], advance)
    return running.result(study)


def _together(study: Study, runs: Sequence[Order]) -> list[_Running]:
    """Advance runs of one time step and number of steps as a batch."""
    batch = Batch([Scene._of(run.scene) for run in runs], threads=study.threads)
    running = [_Running(study, run, instance, "batch") for run, instance in zip(runs, batch)]

    def advance(steps: int) -> None:
        if batch.step(steps):
            for one in running:
                found = one.reason is None and one.where._core.divergence()  # type: ignore[union-attr]
                if found:
                    one.diverge(_reason(found))

    _drive(study, running, advance)
    return running


@functools.lru_cache(maxsize=1)
def smallest() -> Simulation:
    """Return a simulation of the smallest scene."""
    return Simulation(load("cube-plane", {"cube[0].particles-per-edge": 2}), "reference")


@functools.lru_cache(maxsize=8)
def _taken(backend: str) -> str:
    """Return the backend that ``auto`` selects on this machine, determined once."""
    return Simulation(smallest().scene, backend).backend.split(":")[0]


def _backend(run: Order) -> str:
    if not run.backend.startswith("auto"):
        return run.backend
    _, _, options = run.backend.partition(":")
    taken = _taken(run.backend)
    return f"{taken}:{options}" if options else taken


def make_runs(study: Study, batch: Sequence[Differences]) -> list[Result]:
    """Make the runs of a sweep, and store them in its folder if this process can. Failed runs have rows too."""
    scene = scene_of(study)
    folder = Folder(study.folder) if study.folder is not None else None
    if folder is not None and not folder.has(scene):
        folder = None  # another machine's: the caller keeps them
    results: list[Result] = []
    left: list[Order] = []
    for differences in batch:
        run = order(study, scene, differences)
        if study.version != _aspic.version:
            reason = f"here is aspic {_aspic.version}, where the sweep began {study.version}"
            results.append(Result(row_of(study, run, "failed", reason), False))
            continue
        # Another sweep may have made it since.
        row = folder.read(run.key) if folder else None
        if row is not None and is_made(study, row):
            results.append(Result(row, True))
        else:
            left.append(run)
    for group in _groups(study, left):
        for row, trajectory in _made(study, group):
            results.append(_keep(folder, row, trajectory))
    return results


def _groups(study: Study, runs: Sequence[Order]) -> Iterator[list[Order]]:
    """Yield runs that advance together: small ones of one time step and number of steps on the CPU."""
    alike: dict[Any, list[Order]] = {}
    for run in runs:
        if run.error is not None or run.particles > SMALL or run.doubles:
            yield [run]
        else:
            alike.setdefault((run.timestep, run.steps, run.backend), []).append(run)
    for group in alike.values():
        for first in range(0, len(group), study.batch):
            yield group[first : first + study.batch]


def _made(study: Study, runs: list[Order]) -> Iterator[tuple[Row, Trajectory | None]]:
    """Yield rows one by one, so that each can be stored before the next run."""
    first = runs[0]
    if first.error is not None:
        yield rejected_row(study, first), None
        return
    together: list[_Running] = []
    try:
        if len(runs) > 1 and _backend(first) == "cpu":
            together = _together(study, runs)
    except Exception:
        pass  # of any of them: alone, each has its own row
    if together:
        for running in together:
            yield running.result(study)
        return
    for run in runs:
        try:
            made = _alone(study, run, _backend(run))
        except Error as error:
            refused = isinstance(error, UsageError) or error.code == ErrorCode.SCENE_REJECTED
            made = row_of(study, run, "rejected" if refused else "failed", str(error).split("\n")[0]), None
        except Exception as error:
            made = row_of(study, run, "failed", f"{type(error).__name__}: {error}"), None
        yield made


def _keep(folder: Folder | None, row: Row, trajectory: Trajectory | None) -> Result:
    if folder is None:
        return Result(row, False, trajectory)
    try:
        folder.write(row, trajectory)
    except OSError as error:
        failed = {**row, "outcome": "failed", "reason": f"its file cannot be written: {error}"}
        return Result(failed, True)
    return Result(row, True)
