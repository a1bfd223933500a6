"""Scenes, their keys and values."""

import copy
import math
import os
import pathlib
import pickle

import aspic
import numpy as np
import pytest


def test_every_builtin_scene_loads_and_reads_back() -> None:
    assert len(aspic.scenes()) > 10
    for builtin in aspic.scenes():
        scene = aspic.load(builtin.name)
        assert aspic.Scene(scene.toml, scene.name).toml == scene.toml


def test_every_key_can_be_read_and_set_to_what_it_is() -> None:
    for name in ("cube-plane", "goal-net", "flag", "elevator", "bridge", "swing"):
        scene = aspic.load(name)
        assert len(scene) == len(scene.keys()) > 20
        for key in scene:
            assert key in scene
            value = scene[key]
            if value is None or key == "schema":
                continue
            before = scene.toml
            scene[key] = value
            assert scene.toml == before, key


def test_values_have_the_types_of_python(scene: aspic.Scene) -> None:
    assert scene["simulation.timestep"] == 0.001
    assert scene["simulation.integrator"] == "explicit-euler"
    assert scene["simulation.gravity"] == (0.0, -9.8, 0.0)
    assert scene["cube[0].particles-per-edge"] == 4 and isinstance(scene["cube[0].particles-per-edge"], int)
    assert scene["contact.spin"] is True
    assert scene["view.follow"] is None and scene["cube[0].material.density"] is None
    scene["cube[0].pinned"] = ["top", 3]
    assert scene["cube[0].pinned"] == ["top", 3]


def test_bodies_of_cells_are_lists_dicts_and_arrays(tmp_path: pathlib.Path) -> None:
    text = """
schema = 1
[material]
muscle = { density = 1000.0, youngs-modulus = 1e5, damping-ratio = 0.1 }
fat = { density = 900.0 }
[[voxels]]
name = "worm"
layers = [["12"]]
palette = { 1 = "muscle", 2 = "fat" }
"""
    scene = aspic.Scene(text)
    assert scene["voxels[worm].layers"] == [["12"]]
    assert scene["voxels[0].palette"] == {"1": "muscle", "2": "fat"}
    assert scene["material[fat].density"] == 900.0
    scene["material[fat].density"] = 800
    scene["voxels[worm].palette"] = {"#": "fat", "1": "muscle", "2": "muscle"}
    scene["voxels[worm].layers"] = [["12", "##"], ["1.", "#."]]
    assert aspic.Simulation(scene).positions.shape == (24, 3)
    cells = np.zeros((3, 2, 1), dtype=np.uint8)
    cells[:, 0] = 1
    cells[1, 1] = 12
    np.save(tmp_path / "body.npy", cells)
    path = str(tmp_path / "body.npy")
    scene.update({"voxels[worm].palette": {"1": "muscle", "12": "fat"}, "voxels[worm].file": path})
    assert [len(row) for layer in scene["voxels[worm].layers"] for row in layer] == [3, 3]
    with pytest.raises(aspic.SceneError, match="did you mean 'fat'"):
        scene["material[fta].density"] = 1.0


def test_values_of_python_and_numpy_are_taken(scene: aspic.Scene) -> None:
    scene["simulation.gravity"] = np.array([0.0, -1.62, 0.0])
    assert scene["simulation.gravity"] == (0.0, -1.62, 0.0)
    scene["simulation.timestep"] = np.float64(1e-4)
    assert scene["simulation.timestep"] == 1e-4
    scene["cube[0].structural"] = {"stiffness": 1e3, "damping": 0.1 + 0.2}
    assert scene["cube[0].structural.damping"] == 0.1 + 0.2
    scene["name"] = 'A "name" with \\ and\nlines'
    assert scene["name"] == 'A "name" with \\ and\nlines'
    assert aspic.Scene(scene.toml)["name"] == scene["name"]


@pytest.mark.parametrize(
    ("key", "value", "says"),
    [
        ("simulation.timestp", 0.1, "did you mean 'timestep'?"),
        ("simulation.timestep", -1, "out of range"),
        ("simulation.timestep", math.nan, "finite"),
        ("simulation.integrator", "midpont", "did you mean"),
        ("cube[1].edge-length", 1.0, "only one"),
        ("cube.edge-length", 1.0, "did you mean 'cube[0].edge-length'?"),
        ("cube[0].position", [1.0, 2.0], "three numbers"),
        ("simulation.timestep", object(), "not object"),
        ("a=b", 1.0, "a key of a scene"),
    ],
)
def test_wrong_keys_and_values_are_errors_and_change_nothing(
    scene: aspic.Scene, key: str, value: object, says: str
) -> None:
    before = scene.toml
    with pytest.raises(ValueError, match="(?s).*") as caught:
        scene[key] = value
    assert isinstance(caught.value, aspic.Error)
    assert says in str(caught.value) and "--set" not in str(caught.value)
    assert scene.toml == before


def test_reading_an_unknown_key_names_the_nearest(scene: aspic.Scene) -> None:
    with pytest.raises(aspic.SceneError, match="did you mean 'timestep'") as caught:
        scene["simulation.timestp"]
    assert str(caught.value).startswith("simulation.timestp: unknown key") and "=0" not in str(caught.value)
    assert caught.value.code == aspic.ErrorCode.SCENE_REJECTED == 3
    for key in ("cube[7].edge-length", "cube[7]", "", "cube[0x].edge-length"):
        with pytest.raises(aspic.SceneError):
            scene[key]
    assert "simulation.timestp" not in scene


def test_several_keys_are_set_at_once_or_none(scene: aspic.Scene) -> None:
    before = scene.toml
    with pytest.raises(aspic.SceneError):
        scene.update({"simulation.timestep": 0.5e-3, "simulation.gravity": "down"})
    assert scene.toml == before
    scene.update({"simulation.timestep": 0.5e-3, "simulation.gravity": [0, 0, 0]})
    assert scene["simulation.timestep"] == 0.5e-3 and scene["simulation.gravity"] == (0, 0, 0)


def test_text_with_a_mistake_names_line_and_word() -> None:
    with pytest.raises(aspic.SceneError, match=r"lab\.toml:3:1: unknown key 'timestp'"):
        aspic.Scene("schema = 1\n[simulation]\ntimestp = 1\n", "lab.toml")


def test_files_are_read_and_written(scene: aspic.Scene) -> None:
    scene.save("mine.toml")
    assert aspic.load("mine.toml") == scene
    with pytest.raises(FileExistsError):
        scene.save("mine.toml")
    scene.save("mine.toml", overwrite=True)
    with pytest.raises(aspic.FileError) as caught:
        aspic.load("none/such.toml")
    assert isinstance(caught.value, OSError) and caught.value.code == aspic.ErrorCode.IO
    with pytest.raises(aspic.SceneError, match="did you mean"):
        aspic.load("cube-plan")


def test_copies_are_independent(scene: aspic.Scene) -> None:
    for other in (copy.copy(scene), copy.deepcopy(scene), scene.copy(), pickle.loads(pickle.dumps(scene))):
        assert other == scene
        other["simulation.timestep"] = 2e-3
        assert scene["simulation.timestep"] == 1e-3 and other != scene
    assert scene.copy({"simulation.timestep": 2e-3})["simulation.timestep"] == 2e-3


def test_parameters_are_the_reference(scene: aspic.Scene) -> None:
    rows = {row.path: row for row in aspic.parameters()}
    assert len(rows) > 100
    assert rows["simulation.timestep"].unit == "s" and rows["simulation.timestep"].default == "0.001"
    assert rows["cube[].structural.stiffness"].live and not rows["cube[].particles-per-edge"].live
    assert {key.replace("[0]", "[]") for key in scene} <= set(rows)


def test_stable_steps(scene: aspic.Scene) -> None:
    scene["simulation.integrator"] = "symplectic-euler"
    step = scene.stable_timestep()
    assert step is not None and 1e-4 < step < 1.0
    scene["cube[0].structural.stiffness"] = 100 * scene["cube[0].structural.stiffness"]
    stiffer = scene.stable_timestep()
    assert stiffer is not None and stiffer < step
    scene["simulation.integrator"] = "implicit-euler"
    assert scene.stable_timestep() == math.inf


def test_the_window_says_what_is_missing(scene: aspic.Scene, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PATH", "")
    monkeypatch.delenv("ASPIC_PROGRAM", raising=False)
    with pytest.raises(aspic.FileError, match="ASPIC_PROGRAM"):
        scene.view()
    monkeypatch.setenv("ASPIC_PROGRAM", "/no/such/program")
    with pytest.raises(aspic.FileError, match="no/such/program"):
        scene.view()


def test_the_window_gets_the_scene(scene: aspic.Scene, monkeypatch: pytest.MonkeyPatch, tmp_path: object) -> None:
    stand_in = f"{tmp_path}/aspic-stand-in"
    with open(stand_in, "w", encoding="utf-8") as file:
        file.write(f'#!/bin/sh\necho "$1" > {tmp_path}/word; cp "$2" {tmp_path}/seen.toml\n')
    os.chmod(stand_in, 0o755)
    monkeypatch.setenv("ASPIC_PROGRAM", stand_in)
    assert scene.view().wait() == 0
    assert open(f"{tmp_path}/word", encoding="utf-8").read() == "view\n"
    assert aspic.load(f"{tmp_path}/seen.toml") == scene


def test_former_names_are_accepted() -> None:
    scene = aspic.load("cube-sphere")
    scene["contact.epsilon"] = 0.02
    assert scene["contact.distance"] == scene["contact.resting-speed"] == scene["contact.epsilon"] == 0.02
    assert scene["terrain[0].centre"] == scene["terrain[0].center"]
    with pytest.raises(aspic.SceneError, match="former name of contact.distance"):
        scene.update({"contact.epsilon": 0.01, "contact.distance": 0.01})
    sim = aspic.Simulation(scene, "cpu")
    assert np.array_equal(sim["cube[0]"].centre_of_mass, sim["cube[0]"].center_of_mass)
    run = sim.run(0.01, record=["centre-of-mass", "cube[0].center-of-mass"])
    assert np.array_equal(run["centre-of-mass"], run["cube[0].centre-of-mass"])
    assert aspic.Simulation.film is aspic.Simulation.video
