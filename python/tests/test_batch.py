"""Batches: the bits of lone runs, records, resets, constants, inputs, errors, threads and signals."""

import os
import threading
import time
from collections.abc import Callable
from typing import Any

import aspic
import numpy as np
import pytest
from conftest import small
from test_simulation import interrupt_when


def cube(stiffness: float = 1500.0, /, **more: Any) -> aspic.Scene:
    """A cube of 64 particles that is about to land on a plane."""
    return aspic.load("cube-plane", {**small, "cube[0].structural.stiffness": stiffness, **more})


def pair() -> aspic.Scene:
    """Two cubes of 8 particles."""
    bodies = "".join(f"[[cube]]\nparticles-per-edge = 2\nposition = [{3 * i}, 2, 0]\n" for i in range(2))
    return aspic.Scene("schema = 1\n" + bodies)


def mixed() -> list[aspic.Scene]:
    """Scenes that share a stack, and others: of another size, step and method, with balls, with cloth."""
    return [
        *(cube(500.0 + 50.0 * i) for i in range(24)),
        cube(**{"cube[0].particles-per-edge": 5}),
        cube(**{"simulation.timestep": 0.0005}),
        cube(**{"simulation.integrator": "implicit-euler"}),
        aspic.load("cube-and-balls", {"cube[0].particles-per-edge": 4}),
    ]


def alone(scene: aspic.Scene, steps: int) -> aspic.Simulation:
    sim = aspic.Simulation(scene, "cpu", threads=1)
    sim.step(steps)
    return sim


@pytest.fixture
def batch() -> aspic.Batch:
    """Four cubes of other stiffnesses."""
    return aspic.Batch([cube(1000.0 + 100.0 * i) for i in range(4)], threads=1)


@pytest.mark.parametrize("threads", [1, 2])
def test_every_instance_has_the_bits_of_its_scene_alone(threads: int) -> None:
    scenes = mixed()
    batch = aspic.Batch(scenes, threads=threads)
    assert len(batch) == len(list(batch)) == len(scenes) and batch.nbytes > 0
    assert "28 instances, 24 of them in " in batch.description and f"cpu, {threads} thread" in batch.description
    assert batch.step(100) == 0 and batch.step() == 0
    assert batch.steps.tolist() == [101] * 28 and batch.hash == [alone(scene, 101).hash for scene in scenes]
    assert batch.time == pytest.approx(101 * np.array([scene["simulation.timestep"] for scene in scenes]), rel=1e-15)
    again = aspic.Batch(scenes, threads=threads)
    out = again.run(0.1, every=0.025)
    assert out.hash == [alone(scene, round(0.1 / scene["simulation.timestep"])).hash for scene in scenes]
    assert out.hash == again.hash and not out.diverged.any()


def test_an_instance_is_read_as_a_simulation_is(batch: aspic.Batch) -> None:
    batch.step(40)
    lone, one = alone(cube(1200.0), 40), batch[np.int64(2)]
    assert one.hash == lone.hash and one.steps == 40 and one.time == lone.time and one.precision == "single"
    assert one.positions.dtype == np.float32 and np.array_equal(one.positions, lone.positions)
    room = np.empty((64, 3))
    assert np.array_equal(one.read("velocities", out=room), lone.velocities)
    assert one.energy == lone.energy and np.array_equal(one.measures.momentum, lone.momentum)
    assert np.array_equal(one["cube"].center_of_mass, lone["cube[0]"].center_of_mass)
    assert np.array_equal(one["cube"].surface, lone["cube"].surface) and one.masses.sum() == 64
    assert np.array_equal(one.springs.rest_length, lone.springs.rest_length) and one.balls == []
    assert one.scene == cube(1200.0) and one.divergence is None and batch[-2].hash == one.hash
    assert "step 40" in repr(one) and "4 instances" in repr(batch) and one._ipython_key_completions_() == ["cube[0]"]
    v = one.velocities
    v[:, 1] += 3
    one.velocities = v
    lone.velocities = v
    lone.step(20)
    batch.step(20)
    assert one.hash == lone.hash and batch[1].hash == alone(cube(1100.0), 60).hash


def test_arrays_of_all_have_the_instance_first(batch: aspic.Batch) -> None:
    batch.step(30)
    assert batch.positions.shape == (4, 64, 3) and batch.positions.dtype == np.float32
    assert batch.read("ball-positions").shape == (4, 0, 3)
    assert batch.energy.total.shape == (4,) and batch.center_of_mass.shape == batch.momentum.shape == (4, 3)
    for i, one in enumerate(batch):
        assert np.array_equal(batch.positions[i], one.positions) and np.array_equal(batch.velocities[i], one.velocities)
        assert batch.energy.elastic[i] == one.energy.elastic and np.array_equal(batch.momentum[i], one.momentum)
        assert batch.center_of_mass[i] == pytest.approx(one["cube"].center_of_mass, rel=1e-12)
    assert batch.steps.dtype == batch.diverged.dtype == np.int64
    other = aspic.Batch([cube(), cube(**{"cube[0].particles-per-edge": 5})])
    with pytest.raises(aspic.UsageError, match="instance 0 has 64, instance 1 has 125"):
        _ = other.positions
    with pytest.raises(aspic.UsageError, match="no field"):
        batch.read("speed")


def test_runs_record_what_a_simulation_records(batch: aspic.Batch) -> None:
    names = ["center-of-mass", "momentum", "energy", "cube.positions", "positions"]
    batch.step(10)
    out = batch.run(0.05, every=0.02, record=names)
    assert list(out) == names and out.time.shape == (4, 4) and out.diverged.tolist() == [0] * 4
    assert out["center-of-mass"].shape == out["momentum"].shape == (4, 4, 3)
    assert out["energy"].total.shape == (4, 4) and out["cube.positions"].shape == (4, 4, 64, 3)
    assert out["cube.positions"].dtype == np.float32 and np.array_equal(out["positions"], out["cube.positions"])
    for i, one in enumerate(batch):
        sim = alone(one.scene, 10)
        path = sim.run(0.05, every=0.02, record=names)
        kept = [0, 1, 2]
        assert out.time[i] == pytest.approx([0.01, 0.03, 0.05, 0.06]) and path.time == pytest.approx(out.time[i, kept])
        assert np.array_equal(out["positions"][i, kept], path["positions"])
        assert np.array_equal(out["momentum"][i, kept], path["momentum"])
        assert np.array_equal(out["energy"].elastic[i, kept], path["energy"].elastic)
        assert out["center-of-mass"][i, kept] == pytest.approx(path["center-of-mass"], rel=1e-12)
        assert np.array_equal(out["positions"][i, -1], one.positions) and out.hash[i] == alone(one.scene, 60).hash
    out.save("run.npz")
    back = aspic.BatchTrajectory.load("run.npz")
    assert set(back) == set(names) and np.array_equal(back["energy"].kinetic, out["energy"].kinetic)
    assert back.hash == out.hash and np.array_equal(back.time, out.time) and "4 instances, 4 samples" in repr(back)
    with pytest.raises(FileExistsError):
        out.save("run.npz")
    ends = batch.run(0.01, record="energy")
    assert list(ends) == ["energy"] and ends.time.shape == (4, 2) and batch.steps.tolist() == [70] * 4
    assert batch.run(0).time.shape == (4, 1)
    with pytest.raises(aspic.UsageError, match="was not recorded"):
        _ = ends["momentum"]


def test_one_that_diverges_is_marked_and_the_others_go_on() -> None:
    scenes = [cube(), cube(1e9), cube(2000.0)]
    batch = aspic.Batch(scenes)
    out = batch.run(0.3, every=0.01, record=["center-of-mass", "energy"])
    step = int(out.diverged[1])
    assert out.diverged.tolist() == [0, step, 0] and 0 < step < 300 and np.array_equal(batch.diverged, out.diverged)
    with pytest.raises(aspic.DivergedError) as caught:
        alone(scenes[1], 300)
    told = batch[1].divergence
    assert isinstance(told, aspic.DivergedError) and told.step == step == caught.value.step
    assert told.index == caught.value.index and str(told) == str(caught.value)
    assert out.hash == [alone(scenes[0], 300).hash, alone(scenes[1], step - 1).hash, alone(scenes[2], 300).hash]
    assert out.time[1, -1] == pytest.approx((step - 1) * 1e-3) and np.isfinite(out["energy"].total).all()
    assert batch.step(5) == 1 and batch.steps.tolist() == [305, step - 1, 305]
    batch.reset(batch.diverged > 0)
    batch.set_scene(1, cube(800.0))
    assert batch.step(100) == 0 and batch[1].divergence is None
    assert batch.hash[1] == alone(cube(800.0), 100).hash and batch.hash[2] == alone(scenes[2], 405).hash


def test_a_mask_says_which_begin_again(batch: aspic.Batch) -> None:
    start = batch.hash
    batch.step(50)
    later = batch.hash
    batch.reset(np.array([True, False, False, True]))
    assert batch.hash == [start[0], later[1], later[2], start[3]] and batch.steps.tolist() == [0, 50, 50, 0]
    batch.reset([False] * 4)
    assert batch.steps.tolist() == [0, 50, 50, 0]
    batch.reset()
    assert batch.hash == start
    every_other = np.array([True, False] * 4)[::2]
    batch.step()
    batch.reset(every_other)
    assert batch.hash == start
    for wrong in ([True], [1, 0, 0, 1], np.ones((4, 1), bool), [0, 3]):
        with pytest.raises(aspic.UsageError, match="4 bool"):
            batch.reset(wrong)
    batch.step(50)
    assert batch.hash == later


def test_constants_and_inputs_are_each_ones_own(batch: aspic.Batch) -> None:
    sims = [aspic.Simulation(one.scene, "cpu") for one in batch]
    pull = aspic.Pull(0, (0.0, 4.0, 0.0), 200.0, 5.0)
    changed = {"simulation.gravity": [0, -1.62, 0], "cube[0].structural.stiffness": 900.0}

    def act(on: Callable[[int], Any]) -> None:
        on(1).pulls = [pull]
        on(2).pinned = on(2).positions[:, 1] > 2.6
        on(3).update(changed)

    batch.step(20)
    act(lambda i: batch[i])
    batch.set_scene(0, batch[0].scene.copy({"simulation.timestep": 0.0005}))
    for sim in sims:
        sim.step(20)
    act(lambda i: sims[i])
    sims[0].update({"simulation.timestep": 0.0005})
    assert batch[1].pulls == (pull,) and batch[0].pulls == () and len(batch[2].pinned) == 32
    assert batch[2].pinned.tolist() == sims[2].pinned.tolist()
    assert batch[3].scene["simulation.gravity"] == (0, -1.62, 0) and batch[0].timestep == 0.0005
    assert batch[3].springs.stiffness.min() == 900
    for sim in sims:
        sim.step(30)
    batch.step(30)
    assert batch.hash == [sim.hash for sim in sims] and len(set(batch.hash)) == 4
    batch[1].pulls = []
    sims[1].pulls = []
    batch.step(30)
    sims[1].step(30)
    assert batch[1].hash == sims[1].hash
    before = batch.hash
    with pytest.raises(aspic.UsageError):
        batch.set_scene(0, cube(**{"cube[0].particles-per-edge": 5}))
    with pytest.raises(aspic.SceneError, match="did you mean"):
        batch[0].update({"simulation.gravty": [0, 0, 0]})
    for wrong in (aspic.Pull(64, (0, 0, 0), 1.0), aspic.Pull(-1, (0, 0, 0), 1.0)):
        with pytest.raises(aspic.UsageError):
            batch[1].pulls = [wrong]
    assert batch.hash == before and not batch[1].pulls and batch[0].timestep == 0.0005


def test_states_go_from_one_to_another_with_their_inputs(batch: aspic.Batch) -> None:
    pull = aspic.Pull(5, (0.0, 5.0, 0.0), 300.0)
    batch[2].pulls = [pull]
    batch.step(25)
    saved = batch[2].save()
    sim = aspic.Simulation(batch[2].scene, "cpu")
    sim.load(saved)
    assert saved.step == sim.steps == 25 and sim.pulls == (pull,) and sim.hash == batch[2].hash
    batch.step(25)
    sim.step(25)
    assert batch[2].hash == sim.hash
    batch[2].pulls = []
    batch[2].load(saved)
    assert batch[2].pulls == (pull,) and batch.steps.tolist() == [50, 50, 25, 50]
    batch.step(25)
    assert batch[2].hash == sim.hash
    batch[2].load(aspic.Simulation(batch[2].scene, "cpu").save())
    assert not batch[2].pulls and batch[2].steps == 0
    with pytest.raises(aspic.UsageError):
        batch[0].load(aspic.Simulation("cube-plane", "cpu").save())


def test_copies_of_one_scene_and_names(scene: aspic.Scene) -> None:
    batch = aspic.Batch(scene, count=20)
    scene["cube[0].structural.stiffness"] = 1.0
    batch[3].update({"simulation.gravity": [0, 0, 0]})
    batch.step(50)
    assert len(batch) == 20 and len(set(batch.hash)) == 2 and batch.hash.count(batch.hash[3]) == 1
    assert batch[4].scene["cube[0].structural.stiffness"] > 1 and batch[4].scene["simulation.gravity"][1] < 0
    scene.save("mine.toml")
    named = aspic.Batch(["mine.toml", scene, "mine.toml"])
    named.step(3)
    assert len(set(named.hash)) == 1 and len(aspic.Batch("mine.toml", backend="auto")) == 1


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: aspic.Batch([]), "at least one"),
        (lambda: aspic.Batch("cube-plane", count=0), "count.* from 1"),
        (lambda: aspic.Batch([cube()], count=3), "single scene"),
        (lambda: aspic.Batch([cube()], "gpu"), "on the CPU.* not 'gpu'.*no batches on a GPU yet"),
        (lambda: aspic.Batch([cube()], backend="reference"), "not 'reference'"),
        (lambda: aspic.Batch([cube()], threads=5000), "threads"),
        (lambda: aspic.Batch([cube()], threads=-1), "threads"),
        (lambda: aspic.Batch([cube()]).step(-1), "steps"),
        (lambda: aspic.Batch([cube()]).run(-1.0), "0 or more"),
        (lambda: aspic.Batch([cube()]).run(1.0, every=0.0), "interval"),
        (lambda: aspic.Batch([cube()]).run(float("nan")), "0 or more"),
        (lambda: aspic.Batch([cube()]).run(0.0, record=["velocities"]), "cannot be recorded"),
        (lambda: aspic.Batch([cube()]).run(0.0, record=["cube.energy"]), "cannot be recorded"),
        (lambda: aspic.Batch([cube()]).run(0.0, record=["cub.positions"]), "no body 'cub'"),
        (lambda: aspic.Batch([pair()]).run(0.0, record=["cube.positions", "cube[1].positions"]), "one body"),
        (lambda: aspic.Batch(mixed()).run(0.0, record=["cube.positions"]), "as many"),
        (lambda: aspic.Batch([cube(), pair()]).run(0.0, record=["positions"]), "instance 1 has 2 bodies"),
    ],
)
def test_what_a_batch_refuses(make: Callable[[], Any], says: str) -> None:
    with pytest.raises(aspic.UsageError, match=says) as caught:
        make()
    assert caught.value.code == aspic.ErrorCode.USAGE


def test_instances_that_are_none(batch: aspic.Batch) -> None:
    for wrong in (4, -5, 10**30):
        with pytest.raises(IndexError, match="the batch has 4"):
            _ = batch[wrong]
        with pytest.raises(IndexError):
            batch.set_scene(wrong, cube())
    with pytest.raises(TypeError):
        _ = batch["cube"]  # type: ignore[index]
    with pytest.raises(aspic.FileError):
        aspic.Batch([cube(), "./none.toml"])


def begin_shortly(batch: aspic.Batch) -> None:
    batch.step(2)
    batch.step()
    batch.step(10**12)


@pytest.mark.parametrize("act", [begin_shortly, lambda b: b.run(1e9, every=1e6)])
def test_ctrl_c_leaves_every_instance_at_the_end_of_a_step(act: Callable[[aspic.Batch], Any]) -> None:
    scenes = [cube(), cube(900.0), cube(**{"cube[0].particles-per-edge": 5})]
    batch = aspic.Batch(scenes, threads=2)
    begun = threading.Event()

    def reached() -> bool:
        begun.wait()
        time.sleep(0.1)
        return True

    thread = interrupt_when(reached)
    with pytest.raises(KeyboardInterrupt):
        begun.set()
        act(batch)
    thread.join()
    steps = batch.steps
    assert steps.max() > 0
    assert batch.hash == [alone(scene, int(n)).hash for scene, n in zip(scenes, steps)]
    batch.step(2)
    assert batch.steps.tolist() == (steps + 2).tolist()


def test_another_thread_may_stop_it_and_others_run_meanwhile(batch: aspic.Batch) -> None:
    caught: list[BaseException] = []
    runs: list[Callable[[], Any]] = [lambda: batch.step(10**12), lambda: batch.run(1e9)]
    for run in runs:

        def work(run: Callable[[], Any] = run) -> None:
            try:
                run()
            except aspic.Error as error:
                caught.append(error)

        thread = threading.Thread(target=work)
        thread.start()
        while thread.is_alive():
            batch.stop()  # nothing where it has not begun
            time.sleep(0.01)
    assert [type(error) for error in caught] == [aspic.InterruptedRun] * 2
    batch.stop()
    steps = batch.steps
    assert batch.step(3) == 0 and batch.steps.tolist() == (steps + 3).tolist()
    assert batch.hash == [alone(one.scene, one.steps).hash for one in batch]


def test_ctrl_c_ends_the_wait_for_a_turn(batch: aspic.Batch) -> None:
    stepping = threading.Thread(target=lambda: pytest.raises(aspic.InterruptedRun, batch.step, 10**12))
    stepping.start()
    time.sleep(0.1)
    begun = threading.Event()
    interrupting = interrupt_when(begun.wait)
    with pytest.raises(KeyboardInterrupt):
        begun.set()
        _ = batch.steps
    interrupting.join()
    while stepping.is_alive():
        batch.stop()
        time.sleep(0.01)
    assert batch.steps.max() > 0


def test_two_threads_may_step_one_batch(batch: aspic.Batch) -> None:
    threads = [threading.Thread(target=lambda: [batch.step(100) for _ in range(5)]) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert batch.steps.tolist() == [1000] * 4 and batch.hash[0] == alone(batch[0].scene, 1000).hash


def test_threads_come_from_the_environment(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ASPIC_THREADS", "2")
    assert "2 threads" in aspic.Batch([cube()]).description and os.environ["ASPIC_THREADS"] == "2"
    monkeypatch.setenv("ASPIC_THREADS", "many")
    with pytest.raises(aspic.UsageError, match="ASPIC_THREADS"):
        aspic.Batch([cube()])
