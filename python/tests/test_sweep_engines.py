"""Sweeps on other people's engines: Dask, submitit; tables as parquet and pandas. The full tier installs them."""

from __future__ import annotations

import os
import pathlib
import signal
import subprocess
import sys
import time
from collections.abc import Iterator
from typing import Any

import aspic
import numpy as np
import pytest
from test_sweep import files, height, same

distributed = pytest.importorskip("distributed")

base = {"cube[0].particles-per-edge": 5, "cube[0].position": [0, 2.2, 0]}
vary = {"k": np.geomspace(300, 300000, 40).round(2), "mu": [0.0, 0.1, 0.2, 0.4, 0.8]}
"""200 runs, of which the stiffest diverge."""
options: dict[str, Any] = {"duration": 2.0, "every": 0.1}


@pytest.fixture
def scene() -> aspic.Scene:
    return aspic.load("cube-plane", {**base, "simulation.timestep": 0.002})


@pytest.fixture
def cluster() -> Iterator[Any]:
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as local:
        yield local


def test_200_runs_survive_the_death_of_a_worker(scene: aspic.Scene, cluster: Any) -> None:
    one = aspic.sweep(scene, vary, {"up": height}, **options)
    assert one.size == 200 and {"ok", "diverged"} <= set(one["outcome"])
    killed: list[int] = []

    with distributed.Client(cluster) as client:

        def progress(made: int, wanted: int) -> None:
            assert wanted == 200
            if made >= 100 and not killed:
                killed.append(next(iter(client.run(os.getpid).values())))
                os.kill(killed[0], signal.SIGKILL)

        table = aspic.sweep(scene, vary, {"up": height}, "runs", client, batch=2, progress=progress, **options)
        assert killed and killed[0] not in client.run(os.getpid).values()
        assert same(table) == same(one)
        assert len(files()) == 200 and set(table["outcome"]) == {"ok", "diverged"}

        # Again: no run is made, and no task is sent.
        before = {path: path.stat().st_mtime_ns for path in pathlib.Path("runs/runs").iterdir()}
        client.submit = None
        again = aspic.sweep(scene, vary, {"up": height}, "runs", client, **options)
        assert dict(again) == dict(table)
        assert before == {path: path.stat().st_mtime_ns for path in pathlib.Path("runs/runs").iterdir()}
    assert sorted(aspic.collect("runs")["key"]) == sorted(one["key"])


def test_a_task_that_ends_every_worker_is_a_row(scene: aspic.Scene) -> None:
    def deadly(run: aspic.Trajectory) -> int:
        if run["energy"].kinetic[0] > 1e3:
            os.kill(os.getpid(), signal.SIGKILL)
        return 1

    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as local:
        with distributed.Client(local) as client:
            table = aspic.sweep(
                scene,
                {"cube[0].velocity": [[0, 0, 0], [300, 0, 0], [1, 0, 0]]},
                {"deadly": deadly},
                "runs",
                client,
                steps=5,
                batch=1,
            )
    assert table["outcome"] == ["ok", "failed", "ok"]
    assert table["reason"][1].startswith("KilledWorker")


def test_futures_are_released_once_their_runs_are_kept(scene: aspic.Scene, cluster: Any) -> None:
    held: list[int] = []
    with distributed.Client(cluster) as client:
        aspic.sweep(
            scene,
            {"k": range(500, 800)},
            out="runs",
            executor=client,
            batch=1,
            steps=2,
            progress=lambda made, wanted: held.append(len(client.futures)),
        )
        assert not client.futures
    assert max(held) <= 70, "the scheduler holds what is under way alone"


def test_the_executor_of_a_client_is_one_of_concurrent_futures(scene: aspic.Scene, cluster: Any) -> None:
    with distributed.Client(cluster) as client:
        table = aspic.sweep(scene, {"k": [500, 1000]}, {"up": height}, None, client.get_executor(), steps=20)
    assert same(table) == same(aspic.sweep(scene, {"k": [500, 1000]}, {"up": height}, steps=20))


def test_a_scheduler_and_workers_of_the_command_line(scene: aspic.Scene, tmp_path: pathlib.Path) -> None:
    """The commands of docs/sweeps.md, on one machine."""
    environment = {**os.environ, "PYTHONPATH": os.pathsep.join(sys.path)}
    dask = [sys.executable, "-m", "dask"]
    log = open(tmp_path / "log", "w")
    started = [
        subprocess.Popen(
            [*dask, "scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard", "--scheduler-file", "s.json"],
            env=environment, stdout=log, stderr=log,
        ),
        subprocess.Popen(
            [*dask, "worker", "--scheduler-file", "s.json", "--nworkers", "1", "--nthreads", "1", "--no-dashboard",
             "--resources", "CARD=1"],
            env=environment, stdout=log, stderr=log,
        ),
    ]  # fmt: skip
    try:
        until = time.monotonic() + 60
        while not pathlib.Path("s.json").exists():
            assert time.monotonic() < until, (tmp_path / "log").read_text()
            time.sleep(0.05)
        with distributed.Client(scheduler_file="s.json") as client:
            client.wait_for_workers(1, timeout=60)
            address = client.scheduler.address
            cards = aspic.sweep(scene, {"k": [700]}, None, "runs", client, steps=20, submit={"resources": {"CARD": 1}})
        table = aspic.sweep(scene, {"k": [500, 1000]}, None, "runs", address, steps=20)
    finally:
        for process in started:
            process.terminate()
        for process in started:
            process.wait()
        log.close()
    assert cards["outcome"] == ["ok"]
    assert same(table) == same(aspic.sweep(scene, {"k": [500, 1000]}, steps=20))


def test_submitit(scene: aspic.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    """On its executor for one machine, which starts a process for each job as Slurm does."""
    submitit = pytest.importorskip("submitit")
    executor = submitit.AutoExecutor(folder="jobs", cluster="local")
    executor.update_parameters(timeout_min=2)
    # The jobs find what this process finds.
    monkeypatch.setenv("PYTHONPATH", os.pathsep.join(sys.path))
    table = aspic.sweep(scene, {"k": [500, 1000, 2000]}, {"up": height}, "runs", executor, steps=20, batch=2)
    assert same(table) == same(aspic.sweep(scene, {"k": [500, 1000, 2000]}, {"up": height}, steps=20))
    assert len(files()) == 3


def test_tables_as_parquet_and_pandas(scene: aspic.Scene) -> None:
    pandas = pytest.importorskip("pandas")
    pytest.importorskip("pyarrow")
    table = aspic.sweep(scene, {"cube[0].velocity": [[0, 0, 0], [1, 0, 0]], "n": [1, 3]}, {"up": height}, steps=5)
    table.save("table.parquet")
    frame = pandas.read_parquet("table.parquet")
    assert list(frame.columns) == list(table) == list(table.to_pandas().columns)
    assert frame["hash"].tolist() == table["hash"] and frame["cube[0].velocity"][3] == "[1.0, 0.0, 0.0]"
    assert np.isnan(frame["up"][0]) and frame["up"][1] == table["up"][1]
