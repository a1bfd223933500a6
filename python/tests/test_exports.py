"""Motions for other programs, as far as numpy and xarray read them; other libraries are for the full tier."""

import importlib.util
import json
import pathlib
import pickle
import subprocess
from typing import Any

import aspic
import numpy as np
import pytest
from aspic import _exports


@pytest.fixture
def motion(scene: aspic.Scene) -> aspic.Trajectory:
    """The small cube until it has landed."""
    return aspic.Simulation(scene, "cpu").run(0.4, every=0.02, record=["motion"])


def same(a: Any, b: Any) -> bool:
    return bool(a.dtype == b.dtype and a.shape == b.shape and np.array_equal(a, b))


def test_a_motion_has_everything_of_each_sample(scene: aspic.Scene, motion: aspic.Trajectory) -> None:
    assert list(motion) == [n for n in _exports.MOTION if not n.startswith(("ball", "actuator"))]
    sim = aspic.Simulation(scene, "cpu")
    springs, ends = sim.springs, motion.model["model.springs"]
    assert same(springs.ends, ends) and motion.scene is not None and motion.scene.toml == scene.toml
    for sample, step in enumerate(motion.steps.tolist()):
        sim.step(step - sim.steps)
        assert same(motion["positions"][sample], sim.positions) and same(motion["velocities"][sample], sim.velocities)
        e, u = (np.diff(x.astype(np.float64)[ends[:, ::-1]], axis=1)[:, 0] for x in (sim.positions, sim.velocities))
        length = np.sqrt((e * e).sum(axis=1))
        rate = (e * u).sum(axis=1) / length
        tension = springs.stiffness * (length - springs.rest_length) + springs.damping * rate
        assert np.abs(motion["strain"][sample] - (length / springs.rest_length - 1)).max() < 1e-7
        assert np.abs(motion["tension"][sample] - tension).max() <= 1e-6 * np.abs(tension).max() + 1e-9
        assert np.abs(motion["speed"][sample] - np.linalg.norm(sim.velocities, axis=1)).max() < 1e-5


def test_a_cube_at_rest_is_carried_by_its_contacts(scene: aspic.Scene) -> None:
    low = scene.copy({"cube[0].position": [0, 1, 0]})  # the plane is at −1 m
    motion = aspic.Simulation(low, "cpu").run(steps=0, record="motion")
    touches = motion["contact"][0].astype(bool)
    assert np.array_equal(touches, motion["positions"][0, :, 1] == -1) and touches.sum() == 16
    assert not motion["contact-force"][0][~touches].any() and motion["contact-force"].dtype == np.float32
    weight = 16 * motion.model["model.masses"][0] * -scene["simulation.gravity"][1]
    assert motion["contact-force"][0, touches, 1].sum() == pytest.approx(weight, 1e-4)
    assert not motion["speed"].any()


@pytest.mark.parametrize("precision", ["single", "double"])
def test_the_library_writes_what_is_recorded(scene: aspic.Scene, precision: Any) -> None:
    sim = aspic.Simulation(scene, "reference", precision=precision)
    motion = sim.run(0.1, every=0.02, record=["motion"])
    again = aspic.Simulation(scene, "reference", precision=precision)
    again.export("run.npz", 0.1)
    motion.export("other.npz")
    motion.save("saved.npz")
    files = [np.load(name) for name in ("run.npz", "other.npz", "saved.npz")]
    assert set(files[0].files) == set(files[1].files) == set(files[2].files)
    for name in files[0].files:
        if name != "scene":
            assert same(files[0][name], files[1][name]) and same(files[0][name], files[2][name]), name
    back = aspic.Trajectory.load("run.npz")
    assert list(back) == list(motion) and same(back.time, motion.time) and same(back.steps, motion.steps)
    assert back.scene is not None and back.scene.toml == sim.scene.toml
    assert all(same(back.model[name], motion.model[name]) for name in motion.model)
    assert same(back["energy"].elastic, motion["energy"].elastic)


def test_the_work_of_actuators_is_part_of_a_motion() -> None:
    motion = aspic.Simulation("worm", "cpu").run(0.2, every=0.02, record=["motion"])
    aspic.Simulation("worm", "cpu").export("run.npz", 0.2)
    motion.export("other.npz")
    work = motion["actuator-work"]
    assert list(motion)[-1] == "actuator-work" and work.shape == (11,) and work[0] == 0 and work[-1] > 0
    assert all(same(np.load(name)["actuator-work"], work) for name in ("run.npz", "other.npz"))


def test_pulls_count_in_what_a_simulation_exports(scene: aspic.Scene) -> None:
    for name in ("free.npz", "pulled.npz"):
        sim = aspic.Simulation(scene, "cpu")
        if name == "pulled.npz":
            sim.pulls = [aspic.Pull(0, (0, 50, 0), 100)]
        sim.export(name, steps=0)
        if name == "pulled.npz":
            sim.save("pulled.vtp")
    difference = np.load("pulled.npz")["force"] - np.load("free.npz")["force"]
    assert difference[0, 0, 1] > 1000 and not difference[0, 1:].any()
    assert pathlib.Path("pulled.vtp").stat().st_size > 1000


def test_a_series_for_paraview_and_for_blender(motion: aspic.Trajectory, scene: aspic.Scene) -> None:
    motion.export("run.pvd")
    aspic.Simulation(scene, "cpu").export("own.pvd", 0.4)
    assert len(list(pathlib.Path().glob("run-*.vtp"))) == len(motion.time) == 21
    assert pathlib.Path("run-00000400.vtp").read_bytes() == pathlib.Path("own-00000400.vtp").read_bytes()
    motion.export("run.pc2")
    cache = np.fromfile("run.pc2", "<f4", offset=32).reshape(21, -1, 3)
    corners = [
        list(map(int, line.split()[1:]))
        for line in pathlib.Path("run.obj").read_text().splitlines()
        if line[:2] == "f "
    ]
    assert np.array_equal(cache[:, np.array(corners) - 1], motion["positions"][:, motion.model["model.skin"]])
    with pytest.raises(aspic.UsageError, match="samples at equal intervals"):
        uneven = aspic.Trajectory(motion.steps**2, motion.time, dict(motion), motion.scene)
        uneven.export("uneven.pc2")
    assert not list(pathlib.Path().glob("uneven*")) and not list(pathlib.Path().glob(".aspic*"))


def test_what_ends_an_export_leaves_complete_files(scene: aspic.Scene) -> None:
    wild = aspic.Simulation(scene.copy({"simulation.timestep": 0.1}), "cpu")
    with pytest.raises(aspic.DivergedError):
        wild.export("wild.npz", steps=1000, every=0.1)
    assert len(np.load("wild.npz")["time"]) == wild.steps + 1
    with pytest.raises(aspic.FileError, match="overwrite=True"):
        wild.export("wild.npz", steps=0)
    wild.export("wild.npz", steps=0, overwrite=True)
    assert np.load("wild.npz")["time"].shape == (1,)


def test_wrong_arguments_say_what_is_right(scene: aspic.Scene, motion: aspic.Trajectory) -> None:
    sim = aspic.Simulation(scene, "cpu")
    with pytest.raises(aspic.UsageError, match=r"exported as \.pvd, \.pc2, \.npz, \.usd.*not as 'run\.abc'"):
        sim.export("run.abc", 1.0)
    with pytest.raises(aspic.UsageError, match="interval"):
        sim.export("run.npz", 1.0, every=0.0)
    assert sim.steps == 0
    with pytest.raises(aspic.UsageError, match=r'velocities were not recorded: run with record=\["motion"\]'):
        sim.run(steps=1, record=["positions"]).export("run.pvd")
    with pytest.raises(aspic.UsageError, match="does not know its scene"):
        aspic.Trajectory(motion.steps, motion.time, dict(motion)).export("run.pvd")
    with pytest.raises(aspic.UsageError, match=r"saved as \.npz or \.zarr"):
        motion.save("run.csv")
    pathlib.Path("there.npz").write_bytes(b"precious")
    with pytest.raises(FileExistsError):
        motion.save("there.npz")
    assert pathlib.Path("there.npz").read_bytes() == b"precious" and len(list(pathlib.Path().iterdir())) == 1
    for name, package in (("run.usdc", "usd-core"), ("run.zarr", "zarr")):
        try:
            motion.export(name)
        except ModuleNotFoundError as error:
            assert f"pip install {package}" in str(error)
    assert not list(pathlib.Path().glob(".aspic*"))


def test_datasets_have_units_and_dimensions(motion: aspic.Trajectory, scene: aspic.Scene) -> None:
    pytest.importorskip("xarray")
    data = motion.to_xarray()
    assert data["positions"].dims == ("time", "particle", "axis") and data["positions"].attrs["units"] == "m"
    assert data["strain"].dims == ("time", "spring") and data["model.springs"].dims == ("spring", "end")
    assert data["model.skin"].dims == ("quad", "corner") and data.attrs["scene"] == scene.toml
    high = data["positions"].sel(axis="y").max("particle")
    assert np.array_equal(high.values, motion["positions"][..., 1].max(axis=1))
    assert data["energy.kinetic"].attrs["units"] == "J" and data["time"].attrs["units"] == "s"
    body = aspic.Simulation(scene, "cpu").run(0.1, every=0.05, record=["cube[0].positions", "energy"]).to_xarray()
    assert body["cube[0].positions"].dims == ("time", "cube[0].particle", "axis")
    assert not [name for name in body if str(name).startswith("model.")]

    batch = aspic.Batch(scene, count=3)
    out = batch.run(0.1, every=0.05, record=["center-of-mass", "energy", "positions"])
    data = out.to_xarray()
    assert data["center-of-mass"].dims == ("instance", "sample", "axis") and data["time"].shape == (3, 3)
    assert data["positions"].shape == (3, 3, 64, 3) and data["hash"].values.tolist() == out.hash
    assert np.array_equal(data["energy.elastic"], out["energy"].elastic)


@pytest.mark.filterwarnings("ignore::aspic.RunWarning")
def test_exports_hold_what_a_run_warned_of(program: Any) -> None:
    scene = aspic.load("cube-plane", {"cube[0].particles-per-edge": 4, "cube[0].position": [0, -20, 0]})
    sim = aspic.Simulation(scene, "cpu")
    motion = sim.run(0.2, every=0.1, record=["motion"])
    kinds = [(each.kind, each.body, each.step) for each in motion.warnings]
    assert ("flat-cells", "cube[0]", 100) in kinds and ("within-terrain", "cube[0]", 0) in kinds, kinds
    assert "27 of cube[0]" in next(each.text for each in motion.warnings if each.kind == "flat-cells")
    assert motion.warnings == sim.warnings
    motion.save("saved.npz")
    motion.export("other.npz")
    again = aspic.Simulation(scene, "cpu")
    again.export("own.npz", 0.2, every=0.1)
    scene.save("deep.toml")
    program("run", "deep.toml", "--backend", "cpu", "--duration", "0.2", "--export", "program.npz")
    for name in ("saved.npz", "other.npz", "own.npz"):
        assert aspic.Trajectory.load(name).warnings == motion.warnings, name
    told = aspic.Trajectory.load("program.npz").warnings
    assert told == [each for each in motion.warnings if each.kind != "step"]
    assert pickle.loads(pickle.dumps(motion)).warnings == motion.warnings
    quiet = aspic.Simulation("cube-plane", "cpu").run(steps=1)
    quiet.save("quiet.npz")
    assert quiet.warnings == [] and "warnings" not in np.load("quiet.npz")
    if importlib.util.find_spec("xarray"):
        assert [each["kind"] for each in json.loads(motion.to_xarray().attrs["warnings"])] == [k for k, _, _ in kinds]


def test_balls_are_recorded_and_exported() -> None:
    sim = aspic.Simulation("cube-and-balls", "cpu")
    motion = sim.run(0.1, every=0.05, record="motion")
    assert same(motion["ball-positions"][-1], sim.ball_positions)
    motion.export("run.npz")
    file = np.load("run.npz")
    assert same(file["ball-angular-velocities"], motion["ball-angular-velocities"])
    assert file["model.ball-radius"].tolist() == [ball.radius for ball in sim.balls]
    again = pickle.loads(pickle.dumps(motion))
    assert motion.scene is not None and again.scene.toml == motion.scene.toml
    assert same(again["tension"], motion["tension"])


def test_the_program_writes_the_same(scene: aspic.Scene, program: Any) -> None:
    scene.save("mine.toml")
    done = program("run", "mine.toml", "--backend", "cpu", "--steps", "100", "--export", "run.npz")
    assert done["files"] == ["run.npz"]
    aspic.Simulation(scene, "cpu").export("own.npz", steps=100)
    files = [np.load(name) for name in ("run.npz", "own.npz")]
    assert files[0].files == files[1].files
    assert all(same(files[0][name], files[1][name]) for name in files[0].files if name != "scene")
    back = aspic.Trajectory.load("run.npz")
    assert back.scene is not None and back.scene["cube[0].particles-per-edge"] == 4
    listed = subprocess.run(["unzip", "-tq", "run.npz"], capture_output=True, text=True) if has_unzip() else None
    assert listed is None or listed.returncode == 0, listed


def has_unzip() -> bool:
    import shutil

    return shutil.which("unzip") is not None
