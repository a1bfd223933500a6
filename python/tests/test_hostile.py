"""Numbers, processes and threads that go wrong: every setter, fork(), copies, the interpreter's end, time that goes on."""

from __future__ import annotations

import copy
import functools
import inspect
import os
import pickle
import subprocess
import sys
import textwrap
import threading
from collections.abc import Callable
from typing import Any

import aspic
import numpy as np
import pytest
from conftest import simulation, small

NAN, INF = float("nan"), float("inf")
UsageOrScene = (aspic.UsageError, aspic.SceneError)


def touching() -> aspic.Scene:
    """A cube that may touch itself and a ball, an actuator and terrain that moves: something for every setter."""
    scene = aspic.Scene(name="hostile")
    scene["contact.self"] = True
    scene.add("terrain", {"point": [0, 0, 0], "motion": {"amplitude": 0.1, "frequency": 1.0}})
    scene.add_material("jelly", density=1000, youngs_modulus=1e5, damping_ratio=0.2)
    scene.add_voxels("body", np.ones((3, 3, 3), int), size=0.1, material="jelly", position=[0, 0.4, 0])
    scene.add("ball", radius=0.05, mass=0.2, position=[0, 0.8, 0])
    scene.add_actuator("muscle", body="body", amplitude=0.1, signal="input")
    return scene


def bad_arrays(like: Any) -> list[Any]:
    """What is no array of finite numbers of the shape of another."""
    one, all_ = np.array(like, float), np.full(np.shape(like), NAN)
    one.flat[-1] = NAN
    infinite, huge = np.array(like, float), np.array(like, float)
    infinite.flat[0], huge.flat[0] = INF, 1e300
    masked = np.ma.masked_array(np.array(like, float), mask=np.zeros(np.shape(like), bool))
    masked.mask.flat[0] = True
    return [None, one, all_, infinite, -infinite, huge, masked, np.array(like, complex), "text", [[1.0, 2.0], [3.0]]]


BAD = (NAN, INF, -INF)

# By class and attribute that may be assigned: bad values for an object. Every one has a row.
SETTERS: dict[tuple[str, str], Callable[[Any], list[Any]]] = {
    ("Simulation", "positions"): lambda sim: bad_arrays(sim.positions),
    ("Simulation", "velocities"): lambda sim: bad_arrays(sim.velocities),
    ("Simulation", "pulls"): lambda sim: [
        *(aspic.Pull(0, (0, bad, 0), 5.0) for bad in BAD),
        *(aspic.Pull(0, (0, 1, 0), bad) for bad in (*BAD, -1.0, None)),
        *(aspic.Pull(0, (0, 1, 0), 5.0, bad) for bad in (*BAD, -1.0)),
        *(aspic.Pull(bad, (0, 1, 0), 5.0) for bad in (NAN, 1.7, True, -1, 10**9, 2**40)),
        aspic.Pull(0, (0, 1), 5.0),
        (0, (0, 1, 0), 5.0),
        [{"particle": 0}],
        None,
    ],
    ("Simulation", "pinned"): lambda sim: [[NAN], [1.5], [-1], [10**9], {1, 2}, None, "top", np.ones(3, bool)],
    ("Simulation", "channels"): lambda sim: [*([bad] for bad in BAD), [1e300], [1.0, 2.0], None, ["a"]],
    ("Simulation", "inputs"): lambda sim: [{"muscle": bad} for bad in BAD],
    ("State", "step"): lambda state: [NAN, INF, -1, 2.0, None, 2**60],
    ("State", "positions"): lambda state: bad_arrays(state.positions),
    ("State", "velocities"): lambda state: bad_arrays(state.velocities),
    ("Body", "positions"): lambda body: bad_arrays(body.positions),
    ("Body", "velocities"): lambda body: bad_arrays(body.velocities),
}
SETTERS.update({("Instance", name): row for (of, name), row in SETTERS.items() if of == "Simulation"})


@functools.cache
def objects() -> dict[str, Any]:
    sim, batch = aspic.Simulation(touching(), "cpu"), aspic.Batch(touching(), count=2)
    return {"Simulation": sim, "Instance": batch[1], "State": sim.save(), "Body": sim["body"], "batch": batch}


def setters() -> set[tuple[str, str]]:
    """Of all public classes."""
    found = set()
    for name in aspic.__all__:
        kind = getattr(aspic, name)
        if inspect.isclass(kind):
            for key, value in inspect.getmembers(kind):
                if isinstance(value, property) and value.fset is not None:
                    found.add((name, key))
    return found


def test_every_setter_has_a_row() -> None:
    assert setters() == set(SETTERS)


@pytest.mark.parametrize(("kind", "name"), sorted(SETTERS))
def test_setters_refuse_what_is_no_finite_number(kind: str, name: str) -> None:
    of = objects()[kind]
    sim = objects()["Simulation"]
    hashes = (sim.hash, objects()["Instance"].hash, objects()["State"].hash)
    for bad in SETTERS[kind, name](of):
        with pytest.raises(UsageOrScene):
            setattr(of, name, bad)
            pytest.fail(f"{kind}.{name} = {bad!r} was taken")
    assert hashes == (sim.hash, objects()["Instance"].hash, objects()["State"].hash)
    sim.step(2)
    assert objects()["batch"].step(2) == 0 and np.isfinite(sim.energy.total)


# Methods that take numbers: (name, calls with a bad number). Those without numbers are named in NO_NUMBERS.
Calls = Callable[[Any, Any], list[Callable[[], Any]]]
METHODS: dict[tuple[str, str], Calls] = {
    ("Simulation", "step"): lambda sim, bad: [lambda: sim.step(bad)],
    ("Simulation", "advance"): lambda sim, bad: [lambda: sim.advance(bad)],
    ("Simulation", "run"): lambda sim, bad: [
        lambda: sim.run(bad),
        lambda: sim.run(steps=bad),
        lambda: sim.run(0.0, every=bad),
        lambda: sim.run(controls=[[0.0], [bad]]),
    ],
    ("Simulation", "export"): lambda sim, bad: [
        lambda: sim.export("x.npz", bad),
        lambda: sim.export("x.npz", steps=bad),
        lambda: sim.export("x.npz", 0.0, every=bad),
    ],
    ("Simulation", "video"): lambda sim, bad: [
        lambda: sim.video("x.mp4", bad),
        lambda: sim.video("x.mp4", steps=bad),
        lambda: sim.video("x.mp4", 0.0, fps=bad),
        lambda: sim.video("x.mp4", 0.0, speed=bad),
        lambda: sim.video("x.mp4", 0.0, width=bad),
    ],
    ("Simulation", "page"): lambda sim, bad: [
        lambda: sim.page("x.html", bad),
        lambda: sim.page("x.html", steps=bad),
        lambda: sim.page("x.html", 0.0, fps=bad),
        lambda: sim.page("x.html", 0.0, speed=bad),
    ],
    ("Simulation", "render"): lambda sim, bad: [lambda: sim.render(bad), lambda: sim.render(64, bad)],
    ("Simulation", "compare"): lambda sim, bad: [lambda: sim.compare(aspic.Simulation(sim.scene, "cpu"), bad)],
    ("Simulation", "update"): lambda sim, bad: [
        lambda: sim.update({"simulation.timestep": bad}),
        lambda: sim.update({"simulation.gravity": [0, bad, 0]}),
        lambda: sim.update({"contact.distance": bad}),
    ],
    ("Batch", "step"): lambda sim, bad: [lambda: objects()["batch"].step(bad)],
    ("Batch", "run"): lambda sim, bad: [
        lambda: objects()["batch"].run(bad),
        lambda: objects()["batch"].run(0.0, every=bad),
    ],
    ("State", "write"): lambda sim, bad: [lambda: sim.save().write("positions", np.full((64, 3), bad))],
}
METHODS["Instance", "update"] = lambda sim, bad: [
    lambda: objects()["Instance"].update({"simulation.timestep": bad}),
    lambda: objects()["Instance"].update({"simulation.gravity": [0, bad, 0]}),
]
METHODS["Instance", "render"] = lambda sim, bad: [lambda: objects()["Instance"].render(bad)]
NO_NUMBERS = {
    "Batch": {"read", "reset", "set_scene", "stop"},
    "Instance": {"load", "read", "save"},
    "Simulation": {"load", "peek", "read", "replay", "save", "save_inputs", "stop", "view"},
    "State": {"copy", "read"},
}


def test_every_method_has_a_row() -> None:
    for kind in NO_NUMBERS:
        public = inspect.getmembers(getattr(aspic, kind), inspect.isfunction)
        rows = {name for of, name in METHODS if of == kind}
        own = {name for name, method in public if name[0] != "_" and method.__name__ == name}  # no former names
        assert own == rows | NO_NUMBERS[kind], kind


@pytest.mark.parametrize(("kind", "name"), sorted(METHODS))
def test_methods_refuse_what_is_no_finite_number(kind: str, name: str) -> None:
    sim = objects()["Simulation"]
    before = sim.hash
    for bad in (*BAD, -1.0):
        for number, call in enumerate(METHODS[kind, name](sim, bad)):
            if bad == -1.0 and (name == "write" or (name in ("update", "run") and number > 0)):
                continue  # a number like others
            with pytest.raises(UsageOrScene):
                call()
                pytest.fail(f"{kind}.{name} took {bad} in call {number}")
    assert sim.hash == before and not os.listdir()


@pytest.mark.parametrize("bad", [*BAD, 1e300])
def test_scenes_refuse_numbers_that_are_not_finite(bad: float) -> None:
    scene = touching()
    for parameter in aspic.parameters():
        for key in (key for key in scene.keys() if parameter.path.replace("[]", "[0]") == key):
            value = scene[key]
            if isinstance(value, float):
                with pytest.raises(aspic.SceneError):
                    scene[key] = bad
                    pytest.fail(f"{key} took {bad}")
            elif isinstance(value, tuple) and value and isinstance(value[0], float):
                with pytest.raises(aspic.SceneError):
                    scene[key] = [bad, *value[1:]]
                    pytest.fail(f"{key} took {bad}")


def test_pickled_states_are_checked() -> None:
    state = objects()["State"]
    function, (step, doubles, fields) = state.__reduce__()
    fields[0][3, 1] = NAN
    with pytest.raises(aspic.UsageError, match="finite"):
        function(step, doubles, fields)


# Time and motion go on where constants change.


@pytest.mark.parametrize("backend", ["reference", "cpu", "gpu"])
@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_another_time_step_keeps_the_time(backend: str, factor: float) -> None:
    sim = simulation(aspic.load("elevator"), backend)
    sim.step(1000)
    sim.pinned = [0]
    before, h = sim.positions, sim.timestep
    sim.update({"simulation.timestep": factor * h})
    assert sim.time == pytest.approx(1000 * h) and sim.steps == 1000 / factor
    sim.step(2)
    assert np.abs(sim.positions - before).max() < 0.01  # the plate moved by a meter
    assert f"step = {round(1000 / factor)}" in sim.input_log


def test_an_instance_keeps_its_time_and_its_balls() -> None:
    batch = aspic.Batch("penalty", count=2)
    batch.step(600)
    before = batch[0].ball_positions
    batch[0].update({"simulation.timestep": 0.0005})
    assert batch.time[0] == pytest.approx(0.6) and batch.time[1] == pytest.approx(0.6)
    batch.step(20)
    moved = np.linalg.norm(batch[0].ball_positions - before, axis=1)
    assert (moved[:2] > 0.01).all() and (moved[2:] == 0).all()  # two fly, the others wait


@pytest.mark.parametrize("kind", ["simulation", "instance"])
def test_another_frequency_goes_on_from_its_phase(kind: str) -> None:
    def after(factor: float) -> float:
        """The largest speed three steps after the frequency was multiplied."""
        whole: Any = aspic.Simulation("worm", "cpu") if kind == "simulation" else aspic.Batch("worm")
        sim = whole if kind == "simulation" else whole[0]
        whole.step(7000)
        sim.update({key: factor * sim.scene[key]})
        whole.step(3)
        return float(np.linalg.norm(sim.velocities, axis=1).max())

    key = next(key for key in aspic.load("worm").keys() if key.endswith(".frequency"))
    assert after(1.01) == pytest.approx(after(1.0), abs=0.02)  # a jump of the phase kicks by a meter a second


def test_moving_terrain_goes_on_from_its_phase() -> None:
    sim = aspic.Simulation("elevator", "cpu")
    sim.step(1300)
    before = sim.positions
    sim.update({"terrain[0].motion.frequency": 1.3 * sim.scene["terrain[0].motion.frequency"]})
    sim.step(2)
    assert np.abs(sim.positions - before).max() < 0.01


# Steps that end early.


def test_advance_says_how_many_steps_it_made_and_why(scene: aspic.Scene) -> None:
    sim = aspic.Simulation(scene, "cpu")
    assert sim.advance(7) == aspic.Advance(7, None, False) and sim.steps == 7
    wild = aspic.Simulation(scene.copy({"simulation.timestep": 0.1}), "cpu")
    made = wild.advance(1000)
    assert made.divergence is not None and made.steps == wild.steps == made.divergence.step - 1
    assert not made.stopped and wild.advance(5).steps == 0


@pytest.mark.parametrize("backend", ["reference", "cpu", "gpu"])
def test_stop_ends_a_call_of_another_thread(scene: aspic.Scene, backend: str) -> None:
    sim = simulation(scene, backend)
    sim.pulls = [aspic.Pull(0, (0, 5, 0), 10.0)]
    timer = threading.Timer(0.3, sim.stop)
    timer.start()
    made = sim.advance(10**9)
    assert made.stopped and made.divergence is None and made.steps == sim.steps > 0
    timer = threading.Timer(0.3, sim.stop)
    timer.start()
    with pytest.raises(aspic.InterruptedRun) as caught:
        sim.run(steps=10**9)
    assert caught.value.trajectory is not None
    other = simulation(scene, "reference")
    other.pulls = [aspic.Pull(0, (0, 5, 0), 10.0)]
    other.step(made.steps)
    other.load(sim.save())
    other.step(3)
    sim.step(3)
    assert sim.hash == other.hash


def test_a_run_counts_its_own_steps(scene: aspic.Scene) -> None:
    sim = aspic.Simulation(scene, "cpu")
    ended = threading.Event()

    def step() -> None:
        while not ended.is_set():
            sim.step(7)

    thread = threading.Thread(target=step)
    thread.start()
    try:
        path = sim.run(steps=200, every=sim.timestep, record=["max-speed"])
    finally:
        ended.set()
        thread.join()
    assert len(path.time) == 201 and sim.steps > 200


def test_solves_that_do_not_converge_are_told_once() -> None:
    scene = aspic.load("cube-plane", {**small, "simulation.integrator": "implicit-euler", "simulation.timestep": 0.02})
    assert aspic.Simulation("cube-plane", "cpu").solves is None
    scene["simulation.implicit.newton-iterations"] = 1
    sim = aspic.Simulation(scene, "cpu")
    with pytest.warns(aspic.ConvergenceWarning, match="did not converge") as told:
        sim.step(60)
        sim.step(60)
    assert len(told) == 1
    solves = sim.solves
    assert solves is not None and solves.steps == 120 and solves.not_converged > 0 and solves.worst_residual > 1e-4


def test_a_step_that_is_not_stable_is_told() -> None:
    with pytest.warns(aspic.StepWarning, match="stable"):
        aspic.Simulation(aspic.load("cube-plane", {**small, "simulation.timestep": 0.05}), "cpu")


# Copies.


@pytest.mark.parametrize("make", [copy.copy, copy.deepcopy, pickle.dumps])
@pytest.mark.parametrize("kind", ["Simulation", "Instance", "batch"])
def test_solvers_are_not_copied(kind: str, make: Callable[[Any], Any]) -> None:
    with pytest.raises(TypeError, match="load"):
        make(objects()[kind])


@pytest.mark.parametrize("make", [copy.copy, copy.deepcopy])
def test_copies_of_states_have_their_inputs(scene: aspic.Scene, make: Callable[[Any], Any]) -> None:
    sim = aspic.Simulation(scene, "cpu")
    sim.pulls = [aspic.Pull(0, (0, 9, 0), 50.0)]
    sim.step(3)
    state = make(sim.save())
    sim.pulls = []
    sim.load(state)
    assert len(sim.pulls) == 1
    state.velocities = 0 * state.velocities
    assert sim.save().hash != state.hash


# Numbers in and out.


def test_arrays_of_any_layout_are_read_into(scene: aspic.Scene) -> None:
    sim = aspic.Simulation(scene, "cpu")
    x = sim.positions
    n = len(x)
    fields = np.zeros(n, dtype=[("tag", "u1"), ("x", "f4", (3,))])
    for out in (np.empty((3, n), "f4").T, np.empty((2 * n, 6))[::2, ::2], np.empty((n, 3))[::-1], fields["x"]):
        sim.read("positions", out=out)
        assert np.array_equal(out, x)
    for out in (np.broadcast_to(np.zeros(3), (n, 3)).copy()[:1].repeat(n, 0)[:0], np.empty((n, 3), ">f4")):
        with pytest.raises(aspic.UsageError):
            sim.read("positions", out=out)
    shared = np.zeros(3 * n + 3, "f4")
    for strides in ((0, 4), (4, 4), (8, 4), (12, 0)):
        with pytest.raises(aspic.UsageError, match="share memory"):
            sim.read("positions", out=np.lib.stride_tricks.as_strided(shared, (n, 3), strides))


def test_small_intervals_are_steps(scene: aspic.Scene) -> None:
    for every in (1e-9, 1e-300):
        path = aspic.Simulation(scene, "cpu").run(0.01, every=every, record=["hash"])
        assert len(path.time) == 11
    table = aspic.sweep(scene, {"k": [500, 600]}, {"n": lambda run: len(run["max-speed"])}, every=1e-300, duration=0.01)
    assert table["n"] == [11, 11]


def test_pages_have_a_largest_rate(scene: aspic.Scene) -> None:
    with pytest.raises(aspic.UsageError, match="1000"):
        aspic.Simulation(scene, "cpu").page("x.html", 0.1, fps=1e300)


# Sentences.


@pytest.mark.parametrize(
    ("call", "says"),
    [
        (lambda sim: sim.step(2.0), "whole number"),
        (lambda sim: sim.step(True), "whole number"),
        (lambda sim: sim.run(1e300), "number of steps"),
        (lambda sim: sim.render("64", 64), "width of an image"),
        (lambda sim: aspic.Simulation(sim.scene, None), "backend is a word"),
        (lambda sim: setattr(sim, "pinned", {1, 2}), "list or an array"),
        (lambda sim: setattr(sim, "pinned", "top"), "scene's key"),
        (lambda sim: setattr(sim, "pulls", aspic.Pull(0, (0, 9), 5)), "anchor of three numbers"),
        (lambda sim: sim.load(None), "State"),
        (lambda sim: sim.load(sim), "State"),
        (lambda sim: sim[0], "by its name"),
        (lambda sim: aspic.load("cube-plan"), "did you mean 'cube-plane'"),
        (lambda sim: sim.scene.__delitem__("name"), "cannot be removed"),
        (lambda sim: sim.update({"cube[0].position": [0, 9, 0]}), "start"),
        (lambda sim: sim.save("a\0b.aspic"), "no path of a file"),
        (lambda sim: sim.export("a\0b.npz", 0.0), "no path of a file"),
        (lambda sim: sim.video(None, 0.0), "path is a str"),
    ],
)
def test_errors_say_what_to_do(scene: aspic.Scene, call: Callable[[Any], Any], says: str) -> None:
    with pytest.raises(aspic.Error, match=says):
        call(aspic.Simulation(scene, "cpu"))


def test_a_folder_that_is_gone_is_a_file_error(scene: aspic.Scene) -> None:
    os.mkdir("gone")
    os.chdir("gone")
    os.rmdir(os.getcwd())
    sim = aspic.Simulation(scene, "cpu")
    for call in (lambda: sim.export("x.pvd", 0.0), lambda: sim.save("x.aspic")):
        with pytest.raises(aspic.FileError):
            call()


def test_a_scene_is_a_mapping(scene: aspic.Scene) -> None:
    assert scene["simulation"]["timestep"] == scene["simulation.timestep"] == dict(scene.items())["simulation.timestep"]
    assert scene["cube[0]"]["structural.stiffness"] == 2000 and scene.get("none") is None and len(scene.values()) == len(scene)


def test_many_elements_are_added_at_once(scene: aspic.Scene) -> None:
    paths = scene.add_many("ball", [{"position": [x, 9, 0]} for x in range(3)])
    assert paths == ["ball[0]", "ball[1]", "ball[2]"] and scene["ball[2].position"] == (2, 9, 0)
    with pytest.raises(aspic.SceneError):
        scene.add_many("ball", [{"radius": 0.1}, {"radius": -1}])
    assert scene.add_many("ball", []) == [] and "ball[3].radius" not in scene


# Processes and threads.


def run_script(text: str, seconds: float = 60.0) -> subprocess.CompletedProcess[str]:
    script = "import os, sys, threading, time\nimport aspic\nimport numpy as np\n" + textwrap.dedent(text)
    environment = {**os.environ, "PYTHONWARNINGS": "ignore"}
    return subprocess.run(
        [sys.executable, "-c", script], capture_output=True, text=True, timeout=seconds, env=environment
    )


FORKED = """
def child(work):
    pid = os.fork()
    if pid == 0:
        try:
            print(work(), flush=True)
        except aspic.Error as error:
            print(type(error).__name__, error, flush=True)
        os._exit(0)
    for _ in range(200):
        if os.waitpid(pid, os.WNOHANG)[0]:
            return
        time.sleep(0.1)
    os.kill(pid, 9)
    print("hangs", flush=True)
"""


def test_a_forked_child_steps_on_with_threads_of_its_own() -> None:
    done = run_script(
        FORKED
        + """
sim = aspic.Simulation(aspic.load("cube-plane"), "cpu", threads=2)
batch = aspic.Batch(aspic.load("cube-plane", {"cube[0].particles-per-edge": 4}), count=40, threads=2)
sim.step(3), batch.step(3)
child(lambda: (sim.step(3), sim.hash)[1])
child(lambda: (batch.step(3), batch.hash[0])[1])
sim.step(3), batch.step(3)
print(sim.hash, batch.hash[0])
"""
    )
    words = done.stdout.split()
    assert done.returncode == 0 and words[:2] == words[2:], done.stdout + done.stderr


def test_a_forked_child_is_told_that_another_thread_was_at_work() -> None:
    done = run_script(
        FORKED
        + """
sim = aspic.Simulation(aspic.load("large-cube"), "cpu", threads=2)
thread = threading.Thread(target=lambda: sim.advance(10**6))
thread.start()
time.sleep(0.5)
child(lambda: sim.steps)
sim.stop()
thread.join()
"""
    )
    assert done.returncode == 0 and ("DeviceError another thread" in done.stdout or done.stdout.strip().isdigit())


def test_a_forked_child_is_told_that_opengl_was_in_use(scene: aspic.Scene) -> None:
    simulation(scene, "gpu")
    done = run_script(
        FORKED
        + """
scene = aspic.load("cube-plane", {"cube[0].particles-per-edge": 4})
gpu = aspic.Simulation(scene, "gpu")
drawn = aspic.Simulation(scene, "cpu")
gpu.step(2), drawn.render(64, 64)
child(lambda: gpu.step(2))
child(lambda: drawn.render(64, 64))
child(lambda: aspic.Simulation(scene, "gpu"))
child(lambda: (drawn.step(2), drawn.steps)[1])
"""
    )
    lines = done.stdout.splitlines()
    assert done.returncode == 0 and len(lines) == 4, done.stdout + done.stderr
    assert all("forked" in line for line in lines[:3]) and lines[3] == "2"


@pytest.mark.parametrize(
    "call",
    [
        "aspic.Simulation(scene, 'cpu', threads=2).step(10**9)",
        "aspic.Simulation(scene, 'cpu', threads=1).run(steps=10**9, every=0.01)",
        "aspic.Batch(scene, count=20).step(10**9)",
        "aspic.Batch(scene, count=20).run(1e6, every=1e3)",
        "[aspic.Simulation(scene, 'cpu').energy for _ in range(10**9)]",
    ],
)
def test_the_interpreter_ends_with_daemon_threads_in_a_call(call: str) -> None:
    done = run_script(
        f"""
        scene = aspic.load("cube-plane", {{"cube[0].particles-per-edge": 8}})
        for _ in range(3):
            threading.Thread(target=lambda: {call}, daemon=True).start()
        time.sleep(0.7)
        print("ends", flush=True)
        """
    )
    assert done.returncode == 0 and done.stdout == "ends\n", done.stderr


def test_sub_interpreters_are_refused() -> None:
    done = run_script(
        """
        try:
            import _interpreters as interpreters
        except ImportError:
            import _xxsubinterpreters as interpreters
        other = interpreters.create()
        try:
            failed = interpreters.run_string(other, "import aspic")
        except Exception as error:
            failed = error
        print(failed)
        sim = aspic.Simulation(aspic.load("cube-plane"), "cpu")
        sim.step(2)
        print(sim.steps)
        """
    )
    assert "main interpreter" in done.stdout and done.stdout.splitlines()[-1] == "2", done.stdout + done.stderr
