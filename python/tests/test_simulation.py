"""Simulations: the same bits as the program's, arrays, errors, threads and signals."""

import os
import pickle
import signal
import subprocess
import sys
import threading
import warnings
from collections.abc import Callable
from typing import Any

import aspic
import numpy as np
import pytest
from conftest import set_arguments, simulation, small

Program = Callable[..., dict[str, Any]]


@pytest.mark.parametrize("backend", ["reference", "cpu", "gpu", "auto", "reference:double", "gpu:per-spring"])
def test_hashes_are_those_of_the_program(scene: aspic.Scene, backend: str, program: Program) -> None:
    sim = simulation(scene, backend)
    sim.step(300)
    run = program("run", "cube-plane", *set_arguments(small), "--steps", "300", "--backend", backend)
    assert sim.hash == run["state_hash"]
    assert sim.steps == 300 and sim.time == pytest.approx(0.3)


def test_bodies_within_each_other_at_the_start_are_named() -> None:
    scene = aspic.load("cubes-stack")
    scene.update({f"cube[{i}].particles-per-edge": 4 for i in range(3)})
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        aspic.Simulation(scene, "cpu").step(300)
    scene.update({"cube[1].position": [0, 5.9, 0]})
    with pytest.warns(aspic.OverlapWarning, match=r"cube\[0\] and cube\[1\] by 0\.\d+ m"):
        aspic.Simulation(scene, "cpu")


def test_bodies_deep_within_each_other_are_named_once() -> None:
    scene = aspic.load("cubes-stack")
    scene.update({f"cube[{i}].particles-per-edge": 6 for i in range(3)})
    # More than a spacing a step: the lower face is in the middle of the other cube at the first look.
    scene.update({"cube[1].position": [0.5, 63, 0.5], "cube[1].velocity": [0, -600, 0], "cube[2].position": [30, 3, 0]})
    with pytest.warns(aspic.RunWarning, match=r"may flatten cells permanently: cube\[1\] may arrive at 60\d m/s"):
        sim = aspic.Simulation(scene, "cpu")
    with pytest.warns(aspic.OverlapWarning, match="interpenetrate beyond the contact range at step 100 ") as told:
        sim.run(0.3)
    assert [each.category for each in told].count(aspic.OverlapWarning) == 1


def test_what_does_not_hold_is_said_before_the_first_step_and_when_it_comes_about() -> None:
    scene = aspic.load("cube-plane")
    scene.update({"cube[0].particles-per-edge": 4, "cube[0].position": [0, -20, 0]})
    with pytest.warns(aspic.RunWarning, match=r"within terrain at the start: cube\[0\] by 2\d m.* J in springs"):
        sim = aspic.Simulation(scene, "cpu")
    with pytest.warns(aspic.RunWarning, match=r"cells are flat or inverted at step 100 .*: 27 of cube\[0\]"):
        sim.run(0.3)


def test_energy_is_judged_by_what_inputs_can_add() -> None:
    sim = aspic.Simulation("worm", "cpu")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        sim.run(0.25)
        sim.velocities = sim.velocities + np.array([0.0, 30.0, 0.0])
        sim.run(0.25)
    with pytest.warns(aspic.StepWarning, match="may not be stable"):
        sim = aspic.Simulation(aspic.load("worm", {"simulation.timestep": 0.005}), "cpu")
    with pytest.warns(aspic.RunWarning, match="J above that of step 0 plus an upper bound of the work of actuators"):
        sim.run(0.1)


def test_momentum_and_heights_look_for_no_contacts(monkeypatch: pytest.MonkeyPatch) -> None:
    sim = aspic.Simulation("cubes-stack", "cpu")
    full, motion = sim.measures, sim._motion
    assert np.array_equal(motion.momentum, full.momentum) and motion[2:] == full[2:]
    monkeypatch.setattr(type(sim), "measures", property(lambda _: pytest.fail("energies were computed")))
    assert np.array_equal(sim.momentum, full.momentum)
    path = sim.run(0.1, every=0.05, record=["momentum", "max-speed", "min-height"])
    assert path["max-speed"].shape == (3,) and path["min-height"][0] == full.min_height


def test_energies_of_one_simulation_are_those_of_a_fresh_one() -> None:
    sim = aspic.Simulation("cubes-stack", "cpu")
    states = []
    for count in (0, 700, 40, 1):
        sim.step(count)
        states.append((sim.save(), sim.energy))
    # Back in time, and with other constants.
    for state, energy in reversed(states):
        sim.load(state)
        assert sim.energy == energy
        fresh = aspic.Simulation("cubes-stack", "cpu")
        fresh.load(state)
        assert fresh.energy == energy
    sim.load(states[-1][0])
    sim.update({"contact.body-gap": 0.3})
    assert sim.energy.elastic > states[-1][1].elastic
    batch = aspic.Batch("cubes-stack", count=2)
    batch.step(700)
    assert batch[1].energy == states[1][1] == batch[1].energy
    batch[1].update({"contact.body-gap": 0.3})
    assert batch[1].energy.elastic > states[1][1].elastic


def test_all_backends_give_the_same_bits(scene: aspic.Scene) -> None:
    sims = [simulation(scene, backend) for backend in ("reference", "cpu", "gpu")]
    assert sims[0].compare(sims[1], 150) is None
    assert sims[2].compare(sims[1], 0) is None and sims[2].steps == 0
    sims[2].step(150)
    assert {sim.hash for sim in sims} == {sims[0].hash}
    assert aspic.compare(sims[0], sims[2]).identical


def test_the_first_difference_is_found(scene: aspic.Scene) -> None:
    a, b = aspic.Simulation(scene, "cpu"), aspic.Simulation(scene, "reference")
    moved = b.positions
    moved[5, 1] = np.nextafter(moved[5, 1], np.float32(9))
    b.positions = moved
    difference = aspic.compare(a, b)
    assert not difference.identical and difference["positions"].ulp == 1 and difference["positions"].where == 5
    assert "positions" in repr(difference)
    assert a.compare(b, 10) == 1 and a.steps == b.steps == 1
    late = aspic.Simulation(scene, "cpu")
    assert late.compare(b, 10) == 2  # b is a step ahead


def test_arrays_are_copies_in_the_precision(sim: aspic.Simulation) -> None:
    x = sim.positions
    assert x.shape == (64, 3) and x.dtype == np.float32 and x.flags.owndata and x.flags.c_contiguous
    x[:] = 0
    assert sim.positions.max() > 1
    assert np.all(sim.velocities == 0) and sim.ball_positions.shape == (0, 3)
    doubles = aspic.Simulation(sim.scene, "reference", precision="double")
    assert doubles.positions.dtype == np.float64 and doubles.precision == "double"


def test_out_is_filled_whatever_its_strides(sim: aspic.Simulation) -> None:
    sim.step(20)
    room = np.zeros((64, 7), np.float64)
    out = room[:, 1:6:2]
    assert sim.read("positions", out=out) is out
    assert np.array_equal(out, sim.positions) and np.all(room[:, ::2] == 0)
    turned = np.empty((3, 64), np.float32).T
    assert np.array_equal(sim.read("velocities", out=turned), sim.velocities)
    for wrong in (np.empty((63, 3), np.float32), np.empty((64, 3), np.int32), [[0.0] * 3] * 64):
        with pytest.raises(aspic.UsageError, match="out has to"):
            sim.read("positions", out=wrong)
    still = np.empty((64, 3), np.float32)
    still.flags.writeable = False
    with pytest.raises(aspic.UsageError, match="writable"):
        sim.read("positions", out=still)
    with pytest.raises(aspic.UsageError, match="position"):
        sim.read("position")


@pytest.mark.parametrize("backend", ["reference", "cpu"])
def test_peeking_copies_nothing_and_keeps_the_state(scene: aspic.Scene, backend: str) -> None:
    sim = aspic.Simulation(scene, backend)
    sim.step(10)
    x = sim.peek("positions")
    assert np.array_equal(x, sim.positions) and not x.flags.writeable and not x.flags.owndata
    part = x[3]
    del x
    saved = sim.save()
    for change in (sim.step, lambda: sim.load(saved), lambda: sim.update({"simulation.timestep": 1e-4})):
        with pytest.raises(BufferError, match="peek"):
            change()
    assert sim.steps == 10
    del part
    sim.step()
    outlives = aspic.Simulation(scene, backend).peek("positions")
    assert outlives.shape == (64, 3) and outlives[0, 1] < 9


def test_peeking_at_a_device_is_an_error(scene: aspic.Scene) -> None:
    with pytest.raises(aspic.UsageError, match="device"):
        simulation(scene, "gpu").peek("positions")


def test_states_are_set_saved_and_loaded(sim: aspic.Simulation) -> None:
    sim.step(30)
    saved = sim.save()
    assert saved.step == 30 and saved.hash == sim.hash and saved.precision == "single"
    sim.step(30)
    later = sim.hash
    sim.load(saved)
    assert sim.steps == 30 and sim.hash == saved.hash
    sim.step(30)
    assert sim.hash == later
    sim.load(pickle.loads(pickle.dumps(saved)))
    sim.step(30)
    assert sim.hash == later
    v = sim.velocities
    v[:, 0] = 2.5
    sim.velocities = v
    assert np.all(sim.velocities[:, 0] == 2.5) and sim.steps == 60
    body = sim["cube[0]"]
    body.positions = body.positions + [1, 0, 0]
    assert np.all(sim.positions[:, 0] > -2)
    with pytest.raises(aspic.UsageError, match="shape"):
        saved.positions = np.zeros((3, 3))
    other = aspic.Simulation("cube-plane", "cpu")
    with pytest.raises(aspic.UsageError):
        other.load(saved)
    with pytest.raises(aspic.UsageError):
        aspic.compare(other, saved)


def test_checkpoints_go_to_the_program_and_back(sim: aspic.Simulation, program: Program) -> None:
    sim.pulls = [aspic.Pull(0, [0, 3, 0], 50.0)]
    sim.step(40)
    sim.save("half.aspic")
    with pytest.raises(aspic.FileError, match="exists"):
        sim.save("half.aspic")
    sim.step(40)
    again = aspic.resume("half.aspic", "cpu")
    assert again.steps == 40 and len(again.pulls) == 1
    again.step(40)
    run = program("run", "--resume", "half.aspic", "--steps", "80", "--checkpoint", "end.aspic", "--backend", "cpu")
    assert again.hash == sim.hash == run["state_hash"] == aspic.resume("end.aspic", "reference").hash
    sim.save("end.csv")
    assert open("end.csv", encoding="utf-8").read().count("\n") > 64
    double = aspic.Simulation(sim.scene, "reference:double")
    double.step(5)
    double.save("double.aspic")
    assert aspic.resume("double.aspic").hash == double.hash
    open("broken.aspic", "w").write("none")
    with pytest.raises(aspic.FileError):
        aspic.resume("broken.aspic")


def test_energies_momentum_and_bodies(sim: aspic.Simulation) -> None:
    masses, body = sim.masses, sim["cube"]
    assert masses.sum() == 64 and body.name == "cube[0]" and len(body) == 64 and body.particles == range(64)
    sim.step(50)
    v = sim.velocities.astype(np.float64)
    assert sim.energy.kinetic == pytest.approx(0.5 * (masses[:, None] * v**2).sum(), rel=1e-12)
    assert sim.momentum == pytest.approx((masses[:, None] * v).sum(axis=0), rel=1e-12)
    assert body.momentum == pytest.approx(sim.momentum, rel=1e-12)
    assert body.center_of_mass == pytest.approx(sim.positions.astype(np.float64).mean(axis=0), rel=1e-12)
    assert sim.measures.max_speed == pytest.approx(np.linalg.norm(v, axis=1).max(), rel=1e-12)
    assert sim.energy.total == sim.energy.kinetic + sim.energy.elastic + sim.energy.gravitational
    springs = sim.springs
    x = sim.positions.astype(np.float64)
    stretch = np.linalg.norm(x[springs.ends[:, 0]] - x[springs.ends[:, 1]], axis=1) - springs.rest_length
    assert sim.energy.elastic == pytest.approx((0.5 * springs.stiffness * stretch**2).sum(), rel=1e-9)
    assert body.surface.shape == (54, 4) and body.surface.max() < 64
    assert (
        sim._ipython_key_completions_() == ["cube[0]"] and "contact.friction" in sim.scene._ipython_key_completions_()
    )
    with pytest.raises(aspic.UsageError, match=r"did you mean 'cube\[0\]'"):
        sim["cub"]


def test_forces_strains_and_contacts(sim: aspic.Simulation) -> None:
    body = sim["cube"]
    assert body.contacts.dtype == np.bool_ and not body.contacts.any() and np.abs(body.strain).max() < 1e-6
    assert body.forces == pytest.approx(np.tile([0, -9.8, 0], (64, 1)), abs=1e-2)
    x = sim.positions
    sim.positions = x * np.float32(1.01)
    now = sim.quantities
    assert now.strain == pytest.approx(0.01, abs=1e-5) and body.strain == pytest.approx(0.01, abs=1e-5)
    assert now.tension == pytest.approx(sim.springs.stiffness * sim.springs.rest_length * 0.01, rel=1e-3)
    assert body.forces[0] @ x[0] < body.forces[0] @ np.zeros(3) and now.contact.dtype == np.bool_
    recorded = sim.run(0.0, record=["force", "tension", "contact"])
    assert recorded["force"][0] == pytest.approx(now.force, rel=1e-6, abs=1e-3)
    assert recorded["tension"][0] == pytest.approx(now.tension, rel=1e-6)
    sim.positions = x - np.float32([0, x[:, 1].min() + 1, 0])  # the ground is at −1 m
    assert body.contacts.sum() == 16 and now.contact.sum() == 0 and sim.quantities.speed.max() == 0


def test_devices_say_what_works_and_why_not() -> None:
    rows = {device.backend: device for device in aspic.devices()}
    assert list(rows) == ["gpu", "cpu", "reference"]
    for backend in ("cpu", "reference"):
        assert rows[backend].name == aspic.Simulation("cube-plane", backend).device and not rows[backend].reason
    assert bool(rows["gpu"].name) != bool(rows["gpu"].reason)


def test_bodies_and_balls_have_their_own_numbers() -> None:
    sim = aspic.Simulation("cube-and-balls", "cpu")
    ball = sim["ball[0]"]
    assert (
        ball.radius > 0 and ball.mass > 0 and ball.position.shape == (3,) and len(sim.balls) == len(sim.ball_positions)
    )
    sim.step(100)
    assert np.array_equal(ball.position, sim.ball_positions[0])
    assert np.array_equal(ball.velocity, sim.ball_velocities[0])
    assert np.array_equal(ball.angular_velocity, sim.ball_angular_velocities[0])
    net = aspic.Simulation("goal-net", "cpu")
    ranges = [net[name].particles for name in net.bodies]
    assert ranges[0].start == 0 and ranges[-1].stop == len(net.masses)


def test_runs_record_at_intervals(sim: aspic.Simulation) -> None:
    names = ["energy", "center-of-mass", "cube[0].positions", "cube[0].momentum", "velocities", "max_speed", "hash"]
    path = sim.run(0.1, every=0.0125, record=names)
    assert path.steps.tolist() == [0, 12, 25, 38, 50, 62, 75, 88, 100]  # halves to even, as round() does
    assert path.time == pytest.approx(path.steps * 1e-3)
    assert list(path) == names and sim.steps == 100
    assert path["energy"].total.shape == (9,) and path["cube[0].positions"].shape == (9, 64, 3)
    assert path["center-of-mass"].shape == (9, 3) and path["hash"][-1] == sim.hash
    assert np.array_equal(path["cube[0].positions"][-1], sim.positions)
    assert path["energy"].kinetic[-1] == sim.energy.kinetic
    again = aspic.Simulation(sim.scene, "cpu")
    ends = again.run(steps=100, record="energy")
    assert ends.steps.tolist() == [0, 100] and again.hash == sim.hash
    path.save("run.npz")
    back = aspic.Trajectory.load("run.npz")
    assert list(back) == names and np.array_equal(back["energy"].total, path["energy"].total)
    assert path.get("none") is None
    for wrong in ("sped", "cube[0].speed", "cube[0].energy", "cube[3].positions", "energi"):
        with pytest.raises(aspic.UsageError):
            sim.run(steps=0, record=[wrong])
    for lengths in ({"duration": 1.0, "steps": 3}, {"steps": -1}, {"duration": -1.0}, {"steps": 3, "every": 0.0}):
        with pytest.raises(aspic.UsageError):
            sim.run(**lengths)
    assert sim.steps == 100
    sim.run()
    assert sim.steps == 4000  # the scene's duration


def test_a_trajectory_becomes_a_dataset(scene: aspic.Scene) -> None:
    pytest.importorskip("xarray")
    names = ["energy", "cube[0].positions", "center-of-mass", "max-speed"]
    path = aspic.Simulation(scene, "cpu").run(0.1, every=0.02, record=names)
    data = path.to_xarray()
    assert data["energy.kinetic"].dims == ("time",) and data["center-of-mass"].dims == ("time", "axis")
    assert data["cube[0].positions"].shape == (6, 64, 3) and data["step"].values.tolist() == path.steps.tolist()
    assert float(data["max-speed"].sel(time=0.1)) == path["max-speed"][-1]


def test_a_divergence_is_an_error_that_keeps_the_last_good_state(sim: aspic.Simulation) -> None:
    wild = simulation(sim.scene.copy({"simulation.timestep": 0.1}), sim.backend)
    with pytest.raises(aspic.DivergedError, match="diverged at step") as caught:
        wild.run(steps=1000, every=0.1, record=["energy", "max-speed"])
    error = caught.value
    assert error.code == aspic.ErrorCode.DIVERGED and error.step == wild.steps + 1 and not error.ball
    assert error.trajectory is not None and len(error.trajectory.time) == error.step
    assert np.isfinite(wild.positions).all() and wild.measures.max_speed <= 1000
    with pytest.raises(aspic.DivergedError):
        wild.step()
    saved = wild.save()
    saved.velocities = 0 * saved.velocities
    wild.load(saved)
    wild.step()


def test_constants_change_while_it_runs(sim: aspic.Simulation) -> None:
    sim.step(20)
    sim.update({"simulation.gravity": [0, 0, 0], "cube[0].structural.stiffness": 500.0})
    assert sim.scene["simulation.gravity"] == (0, 0, 0) and sim.springs.stiffness.min() == 500
    saved = sim.save()
    sim.step(20)
    other = aspic.Simulation(sim.scene, "reference")
    other.load(saved)
    other.step(20)
    assert other.hash == sim.hash
    with pytest.raises(aspic.UsageError):
        sim.update({"cube[0].particles-per-edge": 5})
    with pytest.raises(aspic.SceneError, match="did you mean"):
        sim.update({"simulation.gravty": [0, 0, 0]})
    assert len(sim.masses) == 64


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"backend": "gpus"}, "allowed"),
        ({"backend": "cpu", "precision": "double"}, "double"),
        ({"backend": "cpu", "precision": "half"}, "precision"),
        ({"backend": "reference", "threads": 4}, "threads"),
        ({"backend": "cpu", "threads": 5000}, "threads"),
    ],
)
def test_backends_that_are_none(scene: aspic.Scene, options: dict[str, Any], says: str) -> None:
    with pytest.raises(aspic.UsageError, match=says) as caught:
        aspic.Simulation(scene, **options)
    assert caught.value.code == aspic.ErrorCode.USAGE


def test_the_number_of_threads_does_not_change_bits() -> None:
    sims = [aspic.Simulation("cube-plane", "cpu", threads=threads) for threads in (1, 3)]
    assert "3 threads" in sims[1].device
    for sim in sims:
        sim.step(50)
    assert sims[0].hash == sims[1].hash


def test_without_egl_everything_but_devices_works() -> None:
    program = """
import aspic
sim = aspic.Simulation("cube-plane", "auto")
sim.step(5)
print(sim.backend, sim.reason)
assert "libegl1" in aspic.devices()[0].reason and aspic.devices()[1].name
for fail in (lambda: aspic.Simulation("cube-plane", "gpu"), sim.render, lambda: sim.video("f", steps=1)):
    try:
        fail()
    except aspic.DeviceError as error:
        print(int(error.code), "libegl1" in str(error))
"""
    os.mkdir("no-egl")
    open("no-egl/libEGL.so.1", "w").close()
    environment = {**os.environ, "LD_LIBRARY_PATH": "no-egl"}
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, env=environment)
    assert done.stdout.splitlines()[1:] == ["4 True"] * 3 and done.stdout.startswith("cpu"), done.stderr


def interrupt_when(reached: Callable[[], bool]) -> threading.Thread:
    """A thread that sends Ctrl-C as soon as something is true: it gets there without the main thread's help alone."""

    def watch() -> None:
        while not reached():
            pass
        os.kill(os.getpid(), signal.SIGINT)

    thread = threading.Thread(target=watch)
    thread.start()
    return thread


@pytest.mark.parametrize("backend", ["reference", "cpu"])
def test_other_threads_run_and_read_while_one_steps_and_ctrl_c_leaves_a_whole_state(
    scene: aspic.Scene, backend: str
) -> None:
    sim = aspic.Simulation(scene, backend)
    seen: set[int] = set()

    def progressed() -> bool:
        seen.add(sim.steps)
        return len(seen) > 3

    thread = interrupt_when(progressed)
    with pytest.raises(KeyboardInterrupt):
        sim.step(10**12)
    thread.join()
    again = aspic.Simulation(scene, "cpu")
    again.step(sim.steps)
    assert sim.steps >= max(seen) > 0 and again.hash == sim.hash
    sim.step()
    assert sim.steps == again.steps + 1


def test_ctrl_c_ends_steps_on_a_device_and_comparisons(scene: aspic.Scene) -> None:
    sim = simulation(scene, "gpu")
    begun = threading.Event()
    thread = interrupt_when(begun.is_set)
    with pytest.raises(KeyboardInterrupt):
        begun.set()
        sim.step(10**12)
    thread.join()
    again = aspic.Simulation(scene, "cpu")
    again.step(sim.steps)
    assert again.hash == sim.hash
    begun.clear()
    thread = interrupt_when(begun.is_set)
    other = aspic.Simulation(scene, "reference")
    third = aspic.Simulation(scene, "cpu")
    with pytest.raises(KeyboardInterrupt):
        begun.set()
        other.compare(third, 10**12)
    thread.join()
    assert other.steps == third.steps and other.hash == third.hash


def test_two_threads_may_step_one_simulation(scene: aspic.Scene) -> None:
    sim = aspic.Simulation(scene, "cpu")
    threads = [threading.Thread(target=sim.step, args=(2000,)) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    again = aspic.Simulation(scene, "reference")
    again.step(4000)
    assert sim.steps == 4000 and sim.hash == again.hash


def test_a_device_refuses_another_thread(scene: aspic.Scene) -> None:
    sim = simulation(scene, "gpu")
    caught: list[BaseException] = []

    def step() -> None:
        try:
            sim.step()
        except aspic.Error as error:
            caught.append(error)

    thread = threading.Thread(target=step)
    thread.start()
    thread.join()
    assert isinstance(caught[0], aspic.DeviceError)


def test_what_one_thread_made_may_be_dropped_on_another(scene: aspic.Scene) -> None:
    simulation(scene, "gpu")
    kept: list[aspic.Simulation] = []
    made, dropped = threading.Event(), threading.Event()
    shapes: list[Any] = []

    def work() -> None:
        for backend in ("gpu", "cpu"):
            kept.append(aspic.Simulation(scene, backend))
            kept[-1].render(64, 36)
        own = aspic.Simulation(scene, "gpu")
        made.set()
        dropped.wait()
        own.step(5)
        shapes.append(own.render(64, 36).shape)

    thread = threading.Thread(target=work)
    thread.start()
    made.wait()
    kept.clear()
    dropped.set()
    thread.join()
    assert shapes == [(36, 64, 3)]
