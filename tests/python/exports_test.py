"""Exports as the programs' own libraries read them, number by number against the states of the run.

`exports.sh` runs this in an environment with vtk, usd-core, trimesh, zarr and xarray.
"""

from __future__ import annotations

import functools
import os
import pathlib
import subprocess
import xml.etree.ElementTree
from collections.abc import Iterator
from typing import Any

import aspic
import numpy as np
import pytest
import trimesh
import xarray
import zarr
from pxr import Usd, UsdGeom, UsdValidation
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

PROGRAM = os.environ["ASPIC_PROGRAM"]
ROOT = pathlib.Path(__file__).resolve().parents[2]
# A cube that lands, a net with balls in it, a flag, a mesh on cells, cells of two materials with balls on them.
SCENES = {
    "cube": ("cube-plane", ["cube[0].particles-per-edge=4", "cube[0].position=[0,2.2,0]"], 400),
    "net": ("penalty", [], 100),
    "cloth": ("flag", [], 100),
    "figure": ("jelly-figure", ["voxels[0].cells=10"], 100),
    "cells": ("bridge", [], 60),
}
EVERY = 20


@pytest.fixture(autouse=True)
def own_folder(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[None]:
    monkeypatch.chdir(tmp_path)
    yield


class Run:
    """A run of the program, and the same one in Python."""

    def __init__(self, name: str, precision: str = "single"):
        scene, keys, self.steps = SCENES[name]
        self.words = [scene, "--backend", "reference", "--precision", precision, "--steps", str(self.steps)]
        for key in keys:
            self.words += ["--set", key]
        made = dict(key.split("=", 1) for key in keys)
        values = {k: eval(v) for k, v in made.items()}
        given: Any = precision
        self.sim = aspic.Simulation(aspic.load(scene, values), "reference", precision=given)
        self.motion = self.sim.run(steps=self.steps, every=EVERY * self.sim.timestep, record=["motion"])

    def export(self, path: str) -> None:
        subprocess.run([PROGRAM, "run", *self.words, "--export", path, "--export-every", str(EVERY)], check=True)

    def balls(self, name: str) -> Any:
        """Of each sample, (t, b, …), empty without balls."""
        found = self.motion.get(name)
        return np.empty((len(self.motion.time), 0, 3)) if found is None else found


@pytest.fixture(params=SCENES)
def run(request: pytest.FixtureRequest) -> Run:
    return Run(request.param)


def equal(a: Any, b: Any) -> None:
    assert a.shape == b.shape and np.array_equal(a, b), np.abs(np.asarray(a, float) - np.asarray(b, float)).max()


def near(a: Any, b: Any) -> None:
    """Equal but for the roundings of a sum of eight products and of its result."""
    assert a.shape == b.shape
    bound = 0.0 if a.dtype.kind == "u" else 16 * np.finfo(a.dtype).eps * np.abs(b).max(initial=0.0)
    assert np.abs(a.astype(float) - b).max(initial=0.0) <= bound


def of_vertices(model: Any, of_particles: Any) -> Any:
    """What docs/exports.md says that the vertices of meshes have of their particles."""
    weights, corners = model["model.mesh-weights"], model["model.mesh-corners"]
    if of_particles.dtype.kind == "u":
        return of_particles[corners[np.arange(len(corners)), weights.argmax(axis=1)]]
    found = of_particles[corners].astype(float)
    return (weights.reshape(weights.shape + (1,) * (found.ndim - 2)) * found).sum(axis=1)


def meshes_of(model: Any) -> tuple[Any, Any]:
    """Triangles and bodies of meshes' vertices; both are empty where no body has a mesh."""
    return model.get("model.mesh-triangles", np.empty((0, 3), int)), model.get("model.mesh-body", np.empty(0, int))


def drawn_quads(model: Any) -> Any:
    """Which squares of surfaces are drawn: those of bodies that have no mesh."""
    return ~np.isin(model["model.skin-body"], meshes_of(model)[1])


def read_vtp(path: str) -> Any:
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    reader.Update()
    assert reader.GetErrorCode() == 0
    return reader.GetOutput()


def array_of(part: Any, name: str) -> Any:
    return vtk_to_numpy(part.GetArray(name))


@pytest.mark.parametrize("precision", ["single", "double"])
@pytest.mark.parametrize("name", SCENES)
def test_vtk_reads_the_series(name: str, precision: str) -> None:
    run = Run(name, precision)
    run.export("run.pvd")
    entries = list(xml.etree.ElementTree.parse("run.pvd").getroot().iter("DataSet"))
    equal(np.array([float(e.attrib["timestep"]) for e in entries]), run.motion.time)
    model, motion = run.motion.model, run.motion
    n, springs = len(model["model.masses"]), model["model.springs"]
    triangles, mesh_body = meshes_of(model)
    balls = len(model.get("model.ball-radius", ()))
    for sample, entry in enumerate(entries):
        data = read_vtp(entry.attrib["file"])
        time = vtk_to_numpy(data.GetFieldData().GetArray("TimeValue"))
        assert time.tolist() == [motion.time[sample]]

        points, cells = (functools.partial(array_of, part) for part in (data.GetPointData(), data.GetCellData()))
        places = vtk_to_numpy(data.GetPoints().GetData())
        assert places.dtype == motion["positions"].dtype and len(places) == n + balls + len(mesh_body)
        equal(places[:n], motion["positions"][sample])
        equal(places[n : n + balls], run.balls("ball-positions")[sample])
        equal(points("velocity")[n : n + balls], run.balls("ball-velocities")[sample])
        equal(points("velocity")[:n], motion["velocities"][sample])
        for of_particles in ("speed", "mean-strain", "force", "contact-force", "contact"):
            equal(points(of_particles)[:n], motion[of_particles][sample])
            if len(mesh_body):
                near(points(of_particles)[n + balls :], of_vertices(model, motion[of_particles][sample]))
        if len(mesh_body):
            near(places[n + balls :], of_vertices(model, motion["positions"][sample]))
            near(points("velocity")[n + balls :], of_vertices(model, motion["velocities"][sample]))
        equal(cells("tension")[balls : balls + len(springs)], motion["tension"][sample])
        strain = cells("strain")[balls : balls + len(springs)]
        equal(strain.astype(motion["strain"].dtype), motion["strain"][sample])
        lines, polys = data.GetLines(), data.GetPolys()
        equal(vtk_to_numpy(lines.GetConnectivityArray()).reshape(-1, 2), springs)
        assert data.GetVerts().GetNumberOfCells() == balls
        corners, ends = (vtk_to_numpy(a) for a in (polys.GetConnectivityArray(), polys.GetOffsetsArray()))
        owners = cells("body")[balls + len(springs) :]
        assert (np.diff(owners) >= 0).all() and len(ends) == len(owners) + 1
        wide = np.diff(ends) == 4
        equal(corners[np.repeat(wide, np.diff(ends))].reshape(-1, 4), model["model.skin"][drawn_quads(model)])
        equal(owners[wide], model["model.skin-body"][drawn_quads(model)])
        equal(corners[np.repeat(~wide, np.diff(ends))].reshape(-1, 3) - n - balls, triangles)
        equal(owners[~wide], mesh_body[triangles[:, 0]])


def test_trimesh_reads_the_object_of_a_cache(run: Run) -> None:
    run.export("run.pc2")
    with open("run.pc2", "rb") as file:
        head = file.read(32)
        places = np.frombuffer(file.read(), "<f4")
    assert head[:12] == b"POINTCACHE2\0" and np.frombuffer(head[28:], "<i4")[0] == len(run.motion.time)
    places = places.reshape(len(run.motion.time), -1, 3)
    model, positions = run.motion.model, run.motion["positions"]
    quads, (triangles, _) = model["model.skin"][drawn_quads(model)], meshes_of(model)
    scene = trimesh.load("run.obj", process=False, maintain_order=True, group_material=False, split_objects=False)
    if isinstance(scene, trimesh.Trimesh):  # a net's edges make something else of it
        equal(scene.vertices.astype(np.float32), places[0])
        # It makes two triangles of each square; a ball has 96 squares and 32 triangles.
        radii = model.get("model.ball-radius", np.empty(0))
        assert len(scene.faces) == 2 * len(quads) + len(triangles) + 224 * len(radii)
        flat = positions[0][quads].astype(np.float64)
        squares = np.linalg.norm(np.cross(flat[:, 2] - flat[:, 0], flat[:, 3] - flat[:, 1]), axis=1).sum() / 2
        if len(triangles):  # all of it: the shape of the file that it was made from
            assert scene.is_watertight and scene.is_winding_consistent
            figure = trimesh.load(ROOT / "assets/meshes/rabbit.obj")
            assert len(figure.faces) == len(triangles)
            # Vertices are on steps of a 2,048th of a cell; with so many cells none is far from all of them.
            assert scene.volume / scene.area**1.5 == pytest.approx(figure.volume / figure.area**1.5, rel=1e-3)
        elif len(radii) == 0:
            assert scene.area == pytest.approx(squares, rel=1e-5)
        elif len(quads) == 0:
            assert scene.is_watertight and scene.is_winding_consistent
            assert 0.9 < scene.volume / (4 / 3 * np.pi * radii**3).sum() < 1.0
    if run.words[0] == "cube-plane":
        assert scene.is_watertight and scene.is_winding_consistent
        edge = np.ptp(positions[0], axis=0)
        assert scene.volume == pytest.approx(edge.prod(), rel=1e-5)  # counterclockwise from outside
    # Every square, and every triangle of a mesh, of every sample, by the file's own faces.
    lines = pathlib.Path("run.obj").read_text().splitlines()
    faces = [[int(w) - 1 for w in line.split()[1:]] for line in lines if line.startswith("f ")]
    equal(places[:, np.array(faces[: len(quads)], int).reshape(-1, 4)], positions[:, quads])
    if len(triangles):
        for sample, moved in zip(places, positions):
            near(sample[np.array(faces, int)], of_vertices(model, moved)[triangles])
    edges = [[int(w) - 1 for w in line.split()[1:]] for line in lines if line.startswith("l ")]
    if edges:
        bare = ~np.isin(model["model.body"][model["model.springs"][:, 0]], model["model.skin-body"])
        equal(places[:, np.array(edges)], positions[:, model["model.springs"][bare]])


def test_numpy_reads_the_arrays(run: Run) -> None:
    run.export("run.npz")
    with np.load("run.npz", allow_pickle=False) as file:
        for name, array in {**run.motion._flat(), **run.motion.model}.items():
            assert file[name].dtype == array.dtype, name
            equal(file[name], array)
        equal(file["time"], run.motion.time)
        assert file["scene"].item().decode() == run.sim.scene.toml
    scene = aspic.Trajectory.load("run.npz").scene
    assert scene is not None and scene["simulation.timestep"] == run.sim.timestep


@pytest.mark.parametrize("ending", ["usda", "usdc"])
def test_usd_has_every_number(run: Run, ending: str) -> None:
    path = f"run.{ending}"
    run.motion.export(path, springs=True)
    stage = Usd.Stage.Open(path)
    validators = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert len(validators) > 20
    found = UsdValidation.ValidationContext(validators).Validate(stage)
    assert not found, [error.GetMessage() for error in found]
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1.0 and UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.y
    assert stage.GetDefaultPrim().GetPath() == "/aspic"
    codes = run.motion.time * stage.GetTimeCodesPerSecond()
    assert (stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (codes[0], codes[-1])
    assert stage.GetRootLayer().customLayerData == {f"aspic:{n}": text for n, text in run.motion._texts().items()}
    assert stage.GetRootLayer().customLayerData["aspic:scene"] == run.sim.scene.toml
    model, motion = run.motion.model, run.motion
    for number, name in enumerate(run.sim.bodies):
        place = "/aspic/" + name.replace("-", "_").replace("[", "_").replace("]", "")
        particles = np.flatnonzero(model["model.body"] == number)
        skin = model["model.skin"][(model["model.skin-body"] == number) & drawn_quads(model)]
        own = meshes_of(model)[1] == number
        springs = np.flatnonzero(model["model.body"][model["model.springs"][:, 0]] == number)
        points = UsdGeom.Points(stage.GetPrimAtPath(f"{place}/particles"))
        curves = UsdGeom.BasisCurves(stage.GetPrimAtPath(f"{place}/springs"))
        mesh = UsdGeom.Mesh(stage.GetPrimAtPath(f"{place}/skin"))
        assert bool(mesh) == (len(skin) > 0 or own.any()) and points.GetPointsAttr().GetTimeSamples() == codes.tolist()
        assert np.array(curves.GetCurveVertexCountsAttr().Get()).tolist() == [2] * len(springs)
        for sample, code in enumerate(codes.tolist()):
            positions = motion["positions"][sample]
            equal(np.array(points.GetPointsAttr().Get(code)), positions[particles])
            equal(np.array(points.GetVelocitiesAttr().Get(code)), motion["velocities"][sample][particles])
            ends = model["model.springs"][springs].reshape(-1)
            equal(np.array(curves.GetPointsAttr().Get(code)), positions[ends])
            for prim, names, which in (
                (points, ("speed", "mean-strain", "force", "contact-force", "contact"), particles),
                (curves, ("strain", "tension"), springs),
            ):
                for array in names:
                    primvar = UsdGeom.PrimvarsAPI(prim).GetPrimvar(array.replace("-", "_"))
                    equal(np.array(primvar.Get(code)), motion[array][sample][which])
            if mesh:
                vertices = np.array(mesh.GetPointsAttr().Get(code))
                faces = np.array(mesh.GetFaceVertexIndicesAttr().Get())
                assert set(mesh.GetFaceVertexCountsAttr().Get()) == {3 if own.any() else 4}
                if own.any():
                    equal(faces.reshape(-1, 3), meshes_of(model)[0].astype(faces.dtype))
                    near(vertices, of_vertices(model, positions))
                    near(np.array(mesh.GetVelocitiesAttr().Get(code)), of_vertices(model, motion["velocities"][sample]))
                    for array in ("speed", "mean-strain", "force", "contact-force", "contact"):
                        primvar = UsdGeom.PrimvarsAPI(mesh).GetPrimvar(array.replace("-", "_"))
                        near(np.array(primvar.Get(code)), of_vertices(model, motion[array][sample]))
                else:
                    equal(vertices[faces.reshape(-1, 4)], positions[skin])
                extent = np.array(mesh.GetExtentAttr().Get(code))
                equal(extent, np.stack([vertices.min(axis=0), vertices.max(axis=0)]))
    for ball, radius in enumerate(model.get("model.ball-radius", np.empty(0)).tolist()):
        sphere = UsdGeom.Sphere(stage.GetPrimAtPath(f"/aspic/ball_{ball}"))
        assert sphere.GetRadiusAttr().Get() == radius
        for sample, code in enumerate(codes.tolist()):
            moved = UsdGeom.Xformable(sphere).ComputeLocalToWorldTransform(code).ExtractTranslation()
            equal(np.array(moved), motion["ball-positions"][sample, ball].astype(np.float64))


def test_zarr_and_xarray_read_what_is_saved(run: Run) -> None:
    run.motion.save("run.zarr")
    arrays = {**run.motion._flat(), **run.motion.model, "time": run.motion.time, "step": run.motion.steps}
    group = zarr.open_group("run.zarr", mode="r")
    with xarray.open_zarr("run.zarr", consolidated=False) as data:
        for name, array in arrays.items():
            equal(group[name][:], array)
            equal(data[name].values, array)
            assert group[name].dtype == data[name].dtype == array.dtype, name
        assert data["positions"].attrs["units"] == "m" and data.attrs["scene"] == run.sim.scene.toml
    back = aspic.Trajectory.load("run.zarr")
    assert list(back) == list(run.motion) or set(back) == set(run.motion)
    equal(back["tension"], run.motion["tension"])
    equal(back["energy"].elastic, run.motion["energy"].elastic)
    with pytest.raises(FileExistsError):
        run.motion.save("run.zarr")
    run.motion.save("run.zarr", overwrite=True)
    assert sorted(os.listdir()) == ["run.zarr"]


def test_a_simulation_exports_to_all_of_them() -> None:
    run = Run("cube")
    for path in ("run.usdc", "run.zarr"):
        sim = aspic.Simulation(run.sim.scene, "cpu")
        sim.export(path, steps=run.steps, every=EVERY * sim.timestep)
    stage = Usd.Stage.Open("run.usdc")
    code = float(run.motion.time[-1] * stage.GetTimeCodesPerSecond())
    points = UsdGeom.Points(stage.GetPrimAtPath("/aspic/cube_0/particles")).GetPointsAttr().Get(code)
    equal(np.array(points), run.motion["positions"][-1])
    equal(zarr.open_group("run.zarr", mode="r")["force"][:], run.motion["force"])
    with pytest.warns(aspic.StepWarning, match="not stable"):
        wild = aspic.Simulation(run.sim.scene.copy({"simulation.timestep": 0.1}), "cpu")
    with pytest.warns(aspic.RunWarning, match="energy"), pytest.raises(aspic.DivergedError):
        wild.export("wild.usda", steps=1000, every=0.1)
    stage = Usd.Stage.Open("wild.usda")
    assert stage.GetEndTimeCode() == pytest.approx(wild.time * stage.GetTimeCodesPerSecond())


def test_batches_are_saved_as_zarr() -> None:
    batch = aspic.Batch(Run("cube").sim.scene, count=3)
    out = batch.run(0.1, every=0.05, record=["center-of-mass", "energy", "positions"])
    out.save("run.zarr")
    with xarray.open_zarr("run.zarr", consolidated=False) as data:
        equal(data["positions"].values, out["positions"])
        equal(data["energy.kinetic"].values, out["energy"].kinetic)
        assert [str(word) for word in data["hash"].values] == out.hash
    back = aspic.BatchTrajectory.load("run.zarr")
    assert back.hash == out.hash
    equal(back["center-of-mass"], out["center-of-mass"])
