"""Winding numbers against libigl, and volumes of cells against trimesh.

`exports.sh` runs this in an environment with libigl and trimesh.
"""

from __future__ import annotations

import os
import pathlib
import subprocess
from typing import Any

import igl
import numpy as np
import pytest
import trimesh

POINTS_PROGRAM = os.environ["ASPIC_WINDING_POINTS"]
PROGRAM = os.environ["ASPIC_PROGRAM"]


def ours(path: pathlib.Path, points: Any) -> Any:
    """Winding numbers, (n, 2): by the tree, and of every triangle."""
    file = path.with_suffix(".txt")
    np.savetxt(file, points)
    made = subprocess.run([POINTS_PROGRAM, str(path), str(file)], check=True, capture_output=True, text=True)
    return np.array([line.split() for line in made.stdout.splitlines()], dtype=float)


def meshes() -> dict[str, trimesh.Trimesh]:
    random = np.random.default_rng(1)
    rabbit = trimesh.load(pathlib.Path(__file__).parents[2] / "assets/meshes/rabbit.obj", process=False)
    torus = trimesh.creation.torus(1.0, 0.4, major_sections=100, minor_sections=50)
    lost = torus.copy()
    lost.update_faces(random.random(len(lost.faces)) > 0.2)
    turned = rabbit.copy()
    chosen = random.random(len(turned.faces)) < 0.3
    turned.faces[chosen] = turned.faces[chosen][:, ::-1]
    return {"rabbit": rabbit, "torus": torus, "lost": lost, "turned": turned}


@pytest.mark.parametrize("name", ["rabbit", "torus", "lost", "turned"])
@pytest.mark.parametrize("ending", ["obj", "stl", "ply"])
def test_winding_numbers_are_libigls(tmp_path: pathlib.Path, name: str, ending: str) -> None:
    mesh = meshes()[name]
    path = tmp_path / f"mesh.{ending}"
    mesh.export(path)
    low, high = mesh.bounds
    points = np.random.default_rng(2).uniform(low - 0.2, high + 0.2, (1500, 3))
    found = ours(path, points)
    # Files hold single precision, or eight digits: a point that is nearer to the surface may be on its other side.
    corners, faces = np.asarray(mesh.vertices, float), np.asarray(mesh.faces, np.int64)
    far = igl.point_mesh_squared_distance(points, corners, faces)[0] > 1e-8
    right = igl.winding_number(corners, faces, points)
    assert np.abs(found[far, 1] - right[far]).max() < 1e-4
    assert np.abs(found[far, 0] - right[far]).max() < 0.01


def test_cells_have_the_meshes_volume(tmp_path: pathlib.Path) -> None:
    for name in ("rabbit", "torus"):
        mesh = meshes()[name]
        path = tmp_path / f"{name}.ply"
        mesh.export(path)
        words = [PROGRAM, "scene", "import", str(path), "--cells", "40"]
        toml = subprocess.run(words, check=True, capture_output=True, text=True).stdout
        size = float(toml.split("\nsize = ")[1].split()[0])
        layers = toml.split("\nlayers = ")[1].split("\n]")[0]
        assert layers.count("1") * size**3 == pytest.approx(mesh.volume, rel=0.02)
