"""Scenes that are built part by part."""

import pathlib
from typing import Any

import aspic
import numpy as np
import pytest
from conftest import simulation


@pytest.fixture
def yard() -> aspic.Scene:
    """A plane and two materials."""
    made = aspic.Scene(name="yard")
    made.add("terrain", {"point": [0, 0, 0]})
    assert made.add_material("muscle", density=1000, youngs_modulus=1e5, damping_ratio=0.2) == "material[muscle]"
    made.add_material("fat", density=900.0, youngs_modulus=3e4, damping_ratio=0.3)
    return made


def worm() -> Any:
    cells = np.ones((6, 2, 3), np.int64)
    cells[2:4, 0] = 0
    cells[:, 1] = 2
    return cells


def test_voxels_are_those_of_the_array(yard: aspic.Scene) -> None:
    path = yard.add_voxels("worm", worm(), size=0.05, palette={1: "muscle", 2: "fat"}, position=[0, 0.2, 0])
    assert path == "voxels[worm]" and yard.bodies == ["voxels[0]"]
    assert yard["voxels[worm].layers"] == [["11..11"] * 3, ["222222"] * 3]
    assert yard["voxels[worm].palette"] == {"1": "muscle", "2": "fat"} and yard["voxels[0].size"] == 0.05
    text = """schema = 1
[[terrain]]
point = [0, 0, 0]
[[material]]
name = "muscle"
density = 1000.0
youngs-modulus = 1e5
damping-ratio = 0.2
[[material]]
name = "fat"
density = 900.0
youngs-modulus = 3e4
damping-ratio = 0.3
[[voxels]]
name = "worm"
size = 0.05
position = [0.0, 0.2, 0.0]
palette = { 1 = "muscle", 2 = "fat" }
layers = [["11..11", "11..11", "11..11"], ["222222", "222222", "222222"]]
"""
    assert yard.toml == aspic.Scene(text, "yard").toml
    assert aspic.Scene(yard.toml, "yard") == yard


@pytest.mark.parametrize("kind", [bool, np.uint8, np.int16, ">i4", np.uint64])
def test_cells_have_any_kind_of_whole_numbers_and_any_order(yard: aspic.Scene, kind: Any) -> None:
    full = (worm() == 1).astype(kind)
    yard.add_voxels("a", full, material="fat", pieces="all")
    yard.add_voxels("b", np.asfortranarray(full), material="fat", pieces="all")
    yard.add_voxels("c", full.tolist(), material="fat", pieces="all")
    yard.add_voxels("d", [["11..11"] * 3, ["......"] * 3], material="fat", pieces="all")
    assert len({str(yard[f"voxels[{i}].layers"]) for i in range(4)}) == 1


def test_a_body_that_has_a_name_is_found_by_it(yard: aspic.Scene) -> None:
    yard.add("cube", edge_length=0.4, particles_per_edge=3, position=[2, 1, 0])
    yard.add_voxels("worm", worm() > 0, size=0.05, material="muscle", position=[0, 0.3, 0], pinned=["top"])
    sim = simulation(yard, "cpu")
    assert sim["worm"].name == sim["voxels[worm]"].name == sim["voxels"].name == "voxels[0]"
    record = sim.run(0.02, record=["worm.positions", "voxels[0].center-of-mass"])
    assert record["worm.positions"].shape == (2, len(sim["worm"].particles), 3)
    batch = aspic.Batch(yard, count=2)
    assert batch.run(0.01, record=["worm.positions"])["worm.positions"].shape[0] == 2
    with pytest.raises(aspic.UsageError, match="no body 'wurm'"):
        sim["wurm"]
    with pytest.raises(aspic.UsageError, match="no body 'wurm'"):
        batch.run(0.01, record=["wurm.positions"])


def test_meshes_become_bodies_and_say_what_was_repaired(yard: aspic.Scene, own_folder: None) -> None:
    path = yard.add_mesh("hare", "rabbit", cells=8, height=0.4, material="fat", position=[0, 1, 0], pieces="largest")
    assert path == "voxels[hare]"
    assert yard["voxels[hare].size"] == pytest.approx(0.05) and yard["voxels[hare].skin"]
    # The skin goes where the cells go.
    sim = aspic.Simulation(yard, backend="reference")
    skin = sim["hare"].skin
    assert skin is not None and skin.triangles.max() == len(skin.vertices) - 1
    center = skin.vertices.mean(axis=0)
    assert np.allclose(center, sim["hare"].center_of_mass, atol=0.05)
    moved = np.float32([0.5, -0.25, 2.0])
    sim["hare"].positions = sim["hare"].positions + moved
    after = sim["hare"].skin
    assert after is not None and np.allclose(after.vertices, skin.vertices + moved, atol=1e-6)
    assert aspic.Simulation(aspic.load("cube-plane"), backend="reference")["cube"].skin is None
    assert len(yard.notes) > 0 and all(note.startswith("rabbit: ") for note in yard.notes)
    # A box, in millimeters, z upwards; first of one side alone.
    corners = [(x, y, z) for x in (0, 20) for y in (0, 20) for z in (0, 40)]
    sides = [(1, 3, 4, 2), (5, 6, 8, 7), (1, 2, 6, 5), (3, 7, 8, 4), (1, 5, 7, 3)]
    lines = [f"v {x} {y} {z}" for x, y, z in corners] + [f"f {' '.join(map(str, side))}" for side in sides]
    pathlib.Path("box.obj").write_text("\n".join(lines[: len(corners) + 1]), encoding="utf-8")
    before = yard.copy()
    with pytest.raises(aspic.SceneError, match="fills none of"):
        yard.add_mesh("box", "box.obj", cells=8, height=0.2, up="z", material="fat")
    assert yard == before and yard.notes == before.notes
    pathlib.Path("box.obj").write_text("\n".join([*lines, "f 2 4 8 6"]), encoding="utf-8")
    yard.add_mesh("box", pathlib.Path("box.obj"), cells=8, height=0.2, up="z", material="fat", position=[2, 1, 0])
    assert yard["voxels[box].layers"] == [["1111"] * 4] * 8
    assert len(yard.notes) > len(before.notes)
    again = aspic.Scene(yard.toml, "yard")
    assert again == yard and again.notes == []


def test_every_list_of_scenes_can_be_added_to() -> None:
    scene = aspic.Scene()
    lists = sorted({row.path.split("[")[0] for row in aspic.parameters() if "[]" in row.path.split(".")[0]})
    assert {"cube", "voxels", "cloth", "goal-net", "terrain", "ball", "material"} <= set(lists)
    for kind in lists:
        if kind in ("actuator", "launcher"):  # need what they act on, or where to
            continue
        assert scene.add(kind) == f"{kind}[0]" and scene.add(kind) == f"{kind}[1]"
    assert scene.add("cube", {"edge-length": 1.5}, particle_mass=0.25, material=None) == "cube[2]"
    assert scene["cube[2].edge-length"] == 1.5 and scene["cube[2].particle-mass"] == 0.25


def test_what_is_wrong_is_said_and_changes_nothing(yard: aspic.Scene) -> None:
    before = yard.copy()
    apart = np.array([[[1]], [[0]], [[1]]])
    for arguments, words in (
        ((worm(), {"palette": {1: "muscle"}}), "cells: it has the number 2 at .*, which 'palette' does not name"),
        ((worm(), {"palette": {1: "muscle", 2: "fatt"}}), 'material "fatt".*did you mean \'fat\''),
        ((worm(), {"material": "muscel"}), "did you mean 'muscle'"),
        ((apart, {"material": "fat"}), 'pieces = "largest"'),
        ((worm() * 0.5, {"material": "fat"}), "cells: it must be an array of integers"),
        ((worm()[0], {"material": "fat"}), "three axes"),
        ((np.zeros((2, 2, 2), int), {"material": "fat"}), "all its cells are empty"),
        ((worm(), {"material": "fat", "size": -1}), "'voxels.size' is out of range"),
        ((worm(), {"material": "fat", "siez": 1}), "did you mean 'size'"),
    ):
        with pytest.raises(aspic.SceneError, match=words):
            yard.add_voxels("worm", arguments[0], **arguments[1])
        assert yard == before
    with pytest.raises(aspic.UsageError, match="cells: an array of numbers"):
        yard.add_voxels("worm", [[[object()]]], material="fat")
    yard.add_voxels("worm", worm() > 0, material="fat")
    with pytest.raises(aspic.SceneError, match='"worm" is taken'):
        yard.add_voxels("worm", worm() > 0, material="fat", position=[3, 3, 3])
    with pytest.raises(aspic.SceneError, match="did you mean 'rabbit'"):
        yard.add_mesh("hare", "rabit", material="fat")
    with pytest.raises(aspic.SceneError, match="did you mean 'cube'"):
        yard.add("cub")
    with pytest.raises(aspic.SceneError, match="taken"):
        yard.add_material("fat")
