"""Sweeps in this process and in others: keys, files, resuming, rows of what fails."""

from __future__ import annotations

import concurrent.futures
import csv
import functools
import json
import os
import pathlib
import subprocess
import sys
import threading
from collections.abc import Callable
from typing import Any

import aspic
import numpy as np
import pytest
from conftest import simulation, small

base: dict[str, Any] = {**small, "simulation.duration": 0.1}
CHANGING = ("solver", "host", "seconds")


@pytest.fixture
def scene() -> aspic.Scene:
    return aspic.load("cube-plane", base)


def same(table: aspic.Table) -> dict[str, list[Any]]:
    """What is equal whoever made the runs."""
    return {name: column for name, column in table.items() if name not in CHANGING}


def files(folder: str = "runs") -> dict[str, Any]:
    return {path.stem: json.loads(path.read_text()) for path in pathlib.Path(folder, "runs").glob("*.json")}


def height(run: aspic.Trajectory) -> float:
    return float(run["center-of-mass"][-1, 1])


def stretched(run: aspic.Trajectory) -> float:
    return float(np.abs(run["strain"]).max())


def test_every_row_is_the_run_of_its_values(scene: aspic.Scene) -> None:
    table = aspic.sweep(
        scene,
        {"cube[0].structural.stiffness": [500, 2000.0], "integrator": ["midpoint", "explicit-euler"]},
        {"up": height},
        backend="cpu",
    )
    assert table.size == 4 and table["outcome"] == ["ok"] * 4
    assert table["cube[0].structural.stiffness"] == [500.0, 500.0, 2000.0, 2000.0]
    for row in table.rows():
        alone = aspic.Simulation(
            scene.copy(
                {
                    "cube[0].structural.stiffness": row["cube[0].structural.stiffness"],
                    "simulation.integrator": row["integrator"],
                }
            ),
            "cpu",
        )
        path = alone.run(record=["center-of-mass"])
        assert row["hash"] == alone.hash and row["steps"] == alone.steps == 100
        assert row["up"] == path["center-of-mass"][-1, 1]
        assert row["kinetic"] == alone.energy.kinetic and row["total"] == alone.energy.total
        assert row["time"] == alone.time


def test_batches_processes_threads_and_one_by_one_give_one_table(scene: aspic.Scene) -> None:
    scene["simulation.duration"] = 0.3
    vary = {"k": np.linspace(500, 5000, 9), "h": [0.001, 0.002, 0.02]}
    metrics = {"up": height, "strain": stretched}
    complete = aspic.sweep(scene, vary, metrics, every=0.03)
    assert set(complete["solver"]) == {"batch"} and complete["outcome"].count("diverged") >= 1
    alone = aspic.sweep(scene, vary, metrics, every=0.03, batch=1, backend="cpu")
    assert set(alone["solver"]) == {"cpu"}
    for name in ("k", "h", "outcome", "reason", "steps", "hash", "up", "strain", "squash", "rest_time", "slide"):
        assert complete[name] == alone[name], name
    reference = aspic.sweep(scene, vary, metrics, every=0.03, backend="reference")
    assert [*reference["hash"], *reference["reason"]] == [*complete["hash"], *complete["reason"]]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        threads = aspic.sweep(scene, vary, metrics, executor=pool, every=0.03, out="runs")
    assert same(threads) == same(complete)
    processes = aspic.sweep(scene, vary, metrics, executor="processes", every=0.03, workers=2)
    assert same(processes) == same(complete)


def test_the_gpu_gives_the_same_table(scene: aspic.Scene) -> None:
    simulation(scene, "gpu")
    found = aspic.sweep(scene, {"backend": ["gpu", "cpu"], "k": [500, 1000]}, {"up": height}, steps=20)
    assert found["solver"][0].startswith("gpu") and found["solver"][2:] == ["batch"] * 2
    assert found["hash"][:2] == found["hash"][2:] and found["up"][:2] == found["up"][2:]


def test_a_sweep_continues_where_it_ended(scene: aspic.Scene) -> None:
    calls: list[tuple[int, int]] = []
    half = aspic.sweep(scene, {"k": [500, 1000]}, out="runs")
    complete = aspic.sweep(
        scene, {"k": [500, 1000, 2000]}, out="runs", progress=lambda made, wanted: calls.append((made, wanted))
    )
    assert calls == [(2, 3), (3, 3)]
    assert complete["seconds"][:2] == half["seconds"], "what is there is not made again"
    before = {key: os.stat(f"runs/runs/{key}.json").st_mtime_ns for key in files()}
    again = aspic.sweep(scene, {"k": [500, 1000, 2000]}, out="runs")
    assert dict(again) == dict(complete)
    assert before == {key: os.stat(f"runs/runs/{key}.json").st_mtime_ns for key in files()}


@pytest.mark.parametrize("executor", [None, "processes"])
def test_what_was_finished_before_ctrl_c_is_kept(scene: aspic.Scene, executor: str | None) -> None:
    def interrupt(made: int, wanted: int) -> None:
        if made:
            raise KeyboardInterrupt

    vary = {"k": range(500, 600, 10)}
    workers = 1 if executor else 0
    with pytest.raises(KeyboardInterrupt):
        aspic.sweep(scene, vary, out="runs", executor=executor, workers=workers, batch=2, progress=interrupt)
    there = files()
    assert 2 <= len(there) < 10
    complete = aspic.sweep(scene, vary, out="runs", batch=2)
    assert complete["outcome"] == ["ok"] * 10
    assert all(files()[key] == row for key, row in there.items())


@pytest.mark.parametrize("backend", ["reference", "cpu"])
def test_runs_of_one_task_are_kept_one_by_one(scene: aspic.Scene, backend: str) -> None:
    calls: list[int] = []

    def interrupted(run: aspic.Trajectory) -> int:
        calls.append(len(run.time))
        if len(calls) == 3:  # the first call finds out what it asks for
            raise KeyboardInterrupt
        return 1

    with pytest.raises(KeyboardInterrupt):
        aspic.sweep(scene, {"k": [1, 2, 3]}, {"x": interrupted}, out="runs", backend=backend, steps=2, batch=3)
    assert len(files()) == 1


def test_a_key_is_of_the_motion_alone(scene: aspic.Scene) -> None:
    def keys(of: aspic.Scene, vary: Any, **more: Any) -> list[str]:
        return aspic.sweep(of, vary, steps=2, **more)["key"]

    stiff = "cube[0].structural.stiffness"
    first = keys(scene, {stiff: [500.0], "h": [0.001]}, backend="cpu")
    assert len(first[0]) == 32
    looks = scene.copy({"name": "another", "view.color": "strain", "simulation.duration": 3})
    assert keys(looks, {"h": [1e-3], stiff: [500]}, backend="cpu") == first, "names, images, order, spelling"
    assert keys(scene.copy({stiff: 700}), {stiff: [500], "h": [0.001]}, backend="cpu") == first
    others = [
        keys(scene, {stiff: [501], "h": [0.001]}, backend="cpu"),
        keys(scene, {stiff: [500]}, backend="cpu"),
        keys(scene, {stiff: [500], "h": [0.001]}, backend="reference"),
        keys(scene, {stiff: [500], "h": [0.001]}, backend="reference", precision="double"),
        keys(scene.copy({"simulation.gravity": [0, -1, 0]}), {stiff: [500], "h": [0.001]}, backend="cpu"),
    ]
    assert len({*first, *(key for other in others for key in other)}) == 6


def test_what_fails_is_a_row(scene: aspic.Scene) -> None:
    def picky(run: aspic.Trajectory) -> float:
        if run["energy"].kinetic[0] > 1e3:
            raise ZeroDivisionError("not this one")
        return 1.0

    vary = [{"k": 500}, {"n": 1}, {"h": 0.05, "k": 1e5}, {"cube[0].velocity": [99, 0, 0]}]
    table = aspic.sweep(scene, vary, {"picky": picky}, out="runs", steps=200)
    assert table["outcome"] == ["ok", "rejected", "diverged", "failed"]
    assert table["picky"] == [1.0, None, None, None]
    assert "particles-per-edge" in table["reason"][1] and "in step" in table["reason"][2]
    assert table["reason"][3] == "metric picky: ZeroDivisionError: not this one"
    assert table["hash"][3] and table["hash"][2] and not table["hash"][1]
    assert table["steps"][2] < 200 and table["max_speed"][2] < 1000
    # All are kept; what failed is tried again, with another metric.
    assert len(files()) == 4
    again = aspic.sweep(scene, vary, {"picky": lambda run: 2.0}, out="runs", steps=200)
    assert again["outcome"] == ["ok", "rejected", "diverged", "ok"] and again["picky"] == [2.0, None, None, 2.0]
    assert again["seconds"][2] == table["seconds"][2]


def test_arguments_that_are_wrong_are_said_before_any_run(scene: aspic.Scene) -> None:
    for expected, vary, more in [
        ("did you mean 'stiffness'", {"cube[0].structural.stifness": [1]}, {}),
        ("did you mean 'integrator'", {"integrater": ["midpoint"]}, {}),
        ("list of values", {"k": 500}, {}),
        ("list of values", {"integrator": "midpoint"}, {}),
        ("either duration or steps", {"k": [1]}, {"steps": 3, "duration": 1.0}),
        ("cannot be recorded", {"k": [1]}, {"record": ["center"]}),
        ("cannot be recorded", {"k": [1]}, {"metrics": {"x": lambda run: run["center"]}}),
        ("already", {"k": [1]}, {"metrics": {"height": height}}),
        ("function", {"k": [1]}, {"metrics": {"x": "y"}}),
        ("out=", {"k": [1]}, {"trajectories": True, "record": ["energy"], "out": None}),
        ("record=", {"k": [1]}, {"trajectories": True}),
        ("submit", {"k": [1]}, {"executor": object()}),
        ("an executor is", {"k": [1]}, {"executor": "dask"}),
        ("for Dask", {"k": [1]}, {"submit": {"resources": {"GPU": 1}}}),
        ("number of processes", {"k": [1]}, {"workers": 2}),
        ("unknown backend", {"k": [1]}, {"backend": "cpus"}),
    ]:
        with pytest.raises(ValueError, match=expected):
            aspic.sweep(scene, vary, **{"out": "wrong", **more})  # type: ignore[arg-type]
    (pathlib.Path.cwd() / "file").write_text("")
    with pytest.raises(aspic.FileError, match="file"):
        aspic.sweep(scene, {"k": [1]}, out="file")
    with pytest.raises(aspic.FileError, match="no folder of runs"):
        aspic.collect("nowhere")


def coordinate(run: aspic.Trajectory, axis: int) -> float:
    return float(run["center-of-mass"][-1, axis])


class Coordinate:
    def __init__(self, axis: int):
        self.axis = axis

    def __call__(self, run: aspic.Trajectory) -> float:
        return coordinate(run, self.axis)

    def method(self, run: aspic.Trajectory) -> float:
        return coordinate(run, self.axis)


def closure(axis: int) -> Any:
    return lambda run: coordinate(run, axis)


def decorated(axis: int) -> Any:
    @functools.wraps(coordinate)
    def inner(run: aspic.Trajectory) -> float:
        return coordinate(run, axis)

    return inner


AXIS = 0


def of_global(axis: int) -> Any:
    global AXIS
    AXIS = axis
    return lambda run: coordinate(run, AXIS)


@pytest.mark.parametrize(
    "metric",
    [
        lambda axis: functools.partial(coordinate, axis=axis),
        closure,
        lambda axis: lambda run, axis=axis: coordinate(run, axis),
        Coordinate,
        lambda axis: Coordinate(axis).method,
        decorated,
        lambda axis: functools.partial(closure(axis)),
        of_global,
    ],
)
def test_another_metric_of_the_same_name_is_computed(scene: aspic.Scene, metric: Any) -> None:
    def made(axis: int) -> aspic.Table:
        return aspic.sweep(scene, {"k": [500]}, {"m": metric(axis)}, out="runs", steps=20)

    first, second = made(0), made(1)
    assert first["m"][0] == pytest.approx(0, abs=0.1) and second["m"][0] > 1
    again = made(1)
    assert again["seconds"] == second["seconds"], "the same metric is kept"
    assert made(0)["m"] == first["m"]


def test_a_metric_without_identity_is_computed_anew(scene: aspic.Scene) -> None:
    lock = threading.Lock()
    metric = functools.partial(lambda run, of: float(run["max-speed"].max()), of=lock)
    with pytest.warns(UserWarning, match="computed anew"):
        first = aspic.sweep(scene, {"k": [500]}, {"m": metric}, out="runs", steps=20)
    with pytest.warns(UserWarning, match="computed anew"):
        second = aspic.sweep(scene, {"k": [500]}, {"m": metric}, out="runs", steps=20)
    assert first["m"] == second["m"] and first["seconds"] != second["seconds"]


def test_a_metric_that_needs_many_samples_gets_all_that_it_asks_for(scene: aspic.Scene) -> None:
    def late(run: aspic.Trajectory) -> float:
        return float(run["max-speed"][5]) + float(run["min-height"].min())

    table = aspic.sweep(scene, {"k": [500]}, {"m": late}, every=0.001, steps=20)
    assert table["outcome"] == ["ok"] and isinstance(table["m"][0], float)


def test_a_metric_that_always_fails_says_what_to_pass(scene: aspic.Scene) -> None:
    def later(run: aspic.Trajectory) -> float:
        if run.time[-1] < 0.5:
            raise ValueError("too short")
        return float(run["min-height"].min())

    table = aspic.sweep(scene, {"k": [500]}, {"m": later}, duration=0.6)
    assert table["outcome"] == ["failed"] and "record=" in table["reason"][0] and table["m"] == [None]


def test_damaged_and_foreign_files_are_made_again(scene: aspic.Scene) -> None:
    complete = aspic.sweep(scene, {"k": [500, 1000, 2000, 4000]}, out="runs", steps=20)
    paths = [pathlib.Path("runs/runs", f"{key}.json") for key in complete["key"]]
    paths[0].write_text(paths[0].read_text()[:100])
    paths[1].write_text("[" * 100000)
    paths[2].write_text(paths[3].read_text())
    foreign = json.loads(paths[3].read_text())
    paths[3].write_text(json.dumps({**foreign, "metrics": {"up": 3}}))
    (paths[0].parent / ".half.json-host-1-1.tmp").write_text("{")
    assert aspic.collect("runs").size == 0
    paths[3].write_text(json.dumps(foreign))
    assert aspic.collect("runs").size == 1
    assert same(aspic.sweep(scene, {"k": [500, 1000, 2000, 4000]}, out="runs", steps=20)) == same(complete)
    assert same(aspic.collect("runs")) == same(complete)


def test_trajectories_are_kept_and_read_back(scene: aspic.Scene) -> None:
    pytest.importorskip("xarray")
    vary = {"k": [500, 1000], "h": [0.001, 0.02]}
    table = aspic.sweep(
        scene, vary, out="runs", record=["energy", "cube[0].positions"], every=0.02, trajectories=True, steps=100
    )
    path = table.trajectory(0)
    assert path["cube[0].positions"].shape == (6, 64, 3) and path["energy"].total.shape == (6,)
    alone = aspic.Simulation(scene.copy({"cube[0].structural.stiffness": 500}), "cpu")
    assert path.time[1] == 0.02 and path["energy"].kinetic[0] == alone.energy.kinetic
    # Another record of the same run: it is made again, and its file replaced.
    aspic.sweep(scene, {**vary, "h": [0.001]}, out="runs", record=["energy"], every=0.01, trajectories=True, steps=100)
    assert len(files()) == 4 and list(aspic.collect("runs").trajectory(0)) == ["energy"]
    grid = aspic.sweep(scene, {"k": [500, 1000], "mu": [0.1, 0.2, 0.3]}, {"up": height}, steps=10).to_xarray()
    assert dict(grid.sizes) == {"k": 2, "mu": 3}
    assert float(grid["up"].sel(k=1000, mu=0.2)) > 0 and grid["hash"].dtype.kind == "U"
    several = aspic.sweep(
        scene, {"k": [500, 1e5]}, out="more", record=["center-of-mass"], every=0.02, trajectories=True, duration=0.1
    ).to_xarray(trajectories=True)
    assert several["center-of-mass(t)"].dims == ("k", "time", "axis") and several["time"].shape == (6,)
    assert np.isnan(several["center-of-mass(t)"].sel(k=1e5).values[-1]).all() and several["end_time"][0] == 0.1


def test_tables_are_saved_and_collected(scene: aspic.Scene) -> None:
    table = aspic.sweep(scene, {"integrator": ["midpoint", "heun-3"], "k": [2000, 500]}, out="runs", steps=5)
    found = aspic.collect("runs")
    assert found["integrator"] == ["heun-3", "heun-3", "midpoint", "midpoint"] and found["k"] == [500, 2000] * 2
    assert sorted(found["key"]) == sorted(table["key"])
    assert repr(found) == "<aspic.Table: 4 runs (4 ok)>"
    found.save("table.csv")
    with open("table.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["hash"] for row in rows] == found["hash"] and float(rows[1]["total"]) == found["total"][1]
    with pytest.raises(FileExistsError):
        found.save("table.csv")
    with pytest.raises(ValueError, match=r"\.parquet"):
        found.save("table.xls")
    with pytest.raises(KeyError, match="there are integrator, k"):
        found["energy"]
    with pytest.raises(ValueError, match="trajectories=True"):
        found.trajectory(0)


def test_the_program_and_python_continue_each_others_folder(
    scene: aspic.Scene, program: Callable[..., dict[str, Any]]
) -> None:
    scene.save("scene.toml")
    words = ["sweep", "scene.toml", "--backend", "cpu", "--runs", "runs", "--jobs", "1"]
    first = program(*words, "--vary", "k=500,1000", "--vary", "h=0.001,0.02", "--vary", "n=1,3,4")
    assert (first["rejected"], first["resumed"]) == (4, 0) and first["ok"] + first["diverged"] == 8
    vary = {"k": [500, 1000, 2000], "h": [0.001, 0.02], "n": [1, 3, 4]}
    written = files()
    table = aspic.sweep(aspic.load("scene.toml"), vary, out="runs", backend="cpu")
    assert table.size == 18 and len(files()) == 18
    assert all(files()[key] == row for key, row in written.items()), "nothing is made twice"
    assert set(table["solver"][12:]) == {"batch", ""}
    # Its rows are those of Python, to the bit.
    ours = aspic.sweep(aspic.load("scene.toml"), vary, backend="cpu")
    assert same(table) == same(ours)
    # And the other way.
    second = program(
        *words, "--vary", "k=500,1000,2000", "--vary", "h=0.001,0.02", "--vary", "n=1,3,4", "--out", "t.csv"
    )
    assert second["resumed"] == 18
    with open("t.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    assert [row["hash"] for row in rows] == table["hash"] and [row["reason"] for row in rows] == table["reason"]
    assert [row["squash"] and float(row["squash"]) for row in rows] == [
        x if x is not None else "" for x in table["squash"]
    ]
    # A run that has metrics is a run.
    aspic.sweep(aspic.load("scene.toml"), {"k": [123]}, {"up": height}, out="runs", backend="cpu")
    assert program(*words, "--vary", "k=123")["resumed"] == 1


KILLER = """
import os, signal, sys
import aspic

def deadly(run):
    if run["energy"].kinetic[0] > 1e3:
        os.kill(os.getpid(), signal.SIGKILL)
    return 1.0

if __name__ == "__main__":
    scene = aspic.load("cube-plane", {"cube[0].particles-per-edge": 3, "simulation.duration": 0.02})
    vary = {"cube[0].velocity": [[x, 0, 0] for x in (0, 1, 300, 2, 3)]}
    table = aspic.sweep(scene, vary, {"deadly": deadly}, "runs", "processes", workers=2, batch=5, retries=1)
    print(*table["outcome"])
    print(table["reason"][2])
"""


def test_a_run_that_ends_its_process_costs_itself_alone() -> None:
    pathlib.Path("killer.py").write_text(KILLER)
    here = str(pathlib.Path(aspic.__file__).parents[1])
    done = subprocess.run(
        [sys.executable, "killer.py"],
        capture_output=True,
        text=True,
        env={**os.environ, "PYTHONPATH": here},
        timeout=120,
    )
    assert done.returncode == 0, done.stderr
    outcomes, reason, *_ = done.stdout.splitlines()
    assert outcomes == "ok ok failed ok ok" and "BrokenProcessPool" in reason


FULL = """
import resource, aspic
resource.setrlimit(resource.RLIMIT_FSIZE, (300, 300))
scene = aspic.load("cube-plane", {"cube[0].particles-per-edge": 3})
table = aspic.sweep(scene, {"k": [500, 1000]}, out="runs", steps=3)
print(*table["outcome"], table["reason"][0])
"""


def test_a_full_disk_is_a_reason(scene: aspic.Scene) -> None:
    """A limit on the size of files acts as a full disk does: writing ends in the middle."""
    aspic.sweep(aspic.load("cube-plane", {"cube[0].particles-per-edge": 3}), {"k": [1500]}, out="runs", steps=3)
    here = str(pathlib.Path(aspic.__file__).parents[1])
    done = subprocess.run(
        [sys.executable, "-c", FULL], capture_output=True, text=True, env={**os.environ, "PYTHONPATH": here}
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.startswith("failed failed its file cannot be written: "), done.stdout
    assert len(os.listdir("runs/runs")) == 1, "no half of a file is left"


def test_two_sweeps_may_use_one_folder_at_once(scene: aspic.Scene) -> None:
    vary = {"k": list(range(500, 900, 10))}
    tables: list[aspic.Table] = []
    threads = [
        threading.Thread(target=lambda: tables.append(aspic.sweep(scene, vary, out="runs", batch=4, steps=20)))
        for _ in range(2)
    ]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert same(tables[0]) == same(tables[1]) == same(aspic.sweep(scene, vary, steps=20))
    assert len(os.listdir("runs/runs")) == 40


def test_what_a_lost_task_had_kept_is_no_failure(scene: aspic.Scene) -> None:
    class Dying(concurrent.futures.Executor):
        """Does all but the last run of a task, and says that it did none."""

        def submit(self, f: Any, /, common: Any, task: Any) -> Any:
            f(common, task[:-1])
            future: concurrent.futures.Future[Any] = concurrent.futures.Future()
            future.set_exception(ConnectionError("gone"))
            return future

    table = aspic.sweep(scene, {"k": [500, 600, 700]}, None, "runs", Dying(), steps=9)
    assert table["outcome"] == ["ok", "ok", "failed"] and table["reason"][2] == "ConnectionError: gone"
    assert {row["outcome"] for row in files().values()} == {"ok", "failed"}


def test_a_worker_that_does_not_see_the_folder_sends_its_runs(scene: aspic.Scene, tmp_path: pathlib.Path) -> None:
    class Elsewhere(concurrent.futures.Executor):
        """As if on another machine: what is at the folder's path is another folder."""

        def submit(self, f: Any, /, common: Any, task: Any) -> Any:
            future: concurrent.futures.Future[Any] = concurrent.futures.Future()
            future.set_result(f(common._replace(folder=str(tmp_path / "none")), task))
            return future

    table = aspic.sweep(
        scene, {"k": [500, 600]}, None, "runs", Elsewhere(), steps=9, record=["energy"], trajectories=True
    )
    assert table["outcome"] == ["ok", "ok"] and len(files()) == 2
    assert table.trajectory(1)["energy"].total.shape == (2,)
