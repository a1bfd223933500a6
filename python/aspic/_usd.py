"""Trajectories as USD, by the package usd-core."""

from __future__ import annotations

import functools
import operator
import re
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from ._errors import UsageError
from ._exports import needs, recorded, scene_of

if TYPE_CHECKING:
    from ._trajectory import Trajectory

__all__ = ["write"]

# What points of a prim have of a sample of all particles or springs.
Follow = Callable[[Any], Any]

# USD plays integer time codes; Blender has as many frames a second.
PER_SECOND = 24.0
# Of which more than the numbers alone is known: of particles, and of springs.
OF_PARTICLES = ("speed", "mean-strain", "force", "contact-force", "contact")
OF_SPRINGS = ("strain", "tension")


def write(path: str, trajectory: Trajectory, springs: bool) -> None:
    """Write skins of bodies as Mesh, particles as Points, springs as BasisCurves, balls as Sphere.

    ``path``: it ends in .usd, .usda or .usdc; ``springs``: also those of bodies that have a skin. Raises UsageError
    where positions were not recorded; ModuleNotFoundError without usd-core.
    """
    try:
        from pxr import Usd, UsdGeom  # type: ignore[import-not-found, import-untyped, unused-ignore]
    except ModuleNotFoundError:
        raise needs("usd-core", "a trajectory as USD") from None
    if len(trajectory.time) == 0:
        raise UsageError("a trajectory without samples is no motion")
    scene = scene_of(trajectory)
    stage = Usd.Stage.CreateNew(path)
    UsdGeom.SetStageMetersPerUnit(stage, 1.0)
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    stage.SetTimeCodesPerSecond(PER_SECOND)
    stage.SetFramesPerSecond(PER_SECOND)
    codes = (trajectory.time * PER_SECOND).tolist()
    stage.SetStartTimeCode(codes[0])
    stage.SetEndTimeCode(codes[-1])
    stage.GetRootLayer().customLayerData = {f"aspic:{name}": text for name, text in trajectory._texts().items()}
    root = UsdGeom.Xform.Define(stage, "/aspic")
    stage.SetDefaultPrim(root.GetPrim())
    writer = _Writer(stage, trajectory, codes)
    bodies = scene._core.bodies()
    for number, name in enumerate(bodies):
        writer.body(number, name, springs)
    if "model.ball-radius" in trajectory.model:
        writer.balls()
    stage.GetRootLayer().Save()


def identifier(name: str) -> str:
    """Return a name as USD takes it: ``cube_0`` for ``cube[0]``."""
    return re.sub(r"\W+", "_", name).strip("_")


def of_particles(which: Any) -> Follow:
    """Return attributes of points that are particles. Springs have the same."""
    return lambda sample: sample[which]


def of_cells(corners: Any, weights: Any) -> Follow:
    """Return attributes of mesh vertices: the mean of their cells' corners; integers from the nearest corner."""
    import numpy as np

    nearest = np.take_along_axis(corners, weights.argmax(axis=1)[:, None], axis=1)[:, 0]

    def values(sample: Any) -> Any:
        if sample.dtype.kind in "bui":
            return sample[nearest]
        parts = [(weight * sample[corner].T).T for weight, corner in zip(weights.T, corners.T)]
        return functools.reduce(operator.add, parts)

    return values


class _Writer:
    def __init__(self, stage: Any, trajectory: Trajectory, codes: list[float]):
        self._stage = stage
        self._trajectory = trajectory
        self._codes = codes
        (self._positions,) = recorded(trajectory, ["positions"])
        self._velocities = trajectory.get("velocities")

    def body(self, number: int, name: str, springs: bool) -> None:
        """Write a body's skin, particles and springs below one Xform."""
        import numpy as np
        from pxr import UsdGeom

        model = self._trajectory.model
        place = f"/aspic/{identifier(name)}"
        UsdGeom.Xform.Define(self._stage, place)
        particles = np.flatnonzero(model["model.body"] == number)
        skin = self._skin_of(number)
        self._particles(f"{place}/particles", particles)
        if skin:
            self._skin(f"{place}/skin", *skin)
        if springs or not skin:
            of_body = model["model.body"][model["model.springs"][:, 0]] == number
            self._springs(f"{place}/springs", np.flatnonzero(of_body), guide=skin is not None)

    def _skin_of(self, number: int) -> tuple[Any, Follow] | None:
        """Return faces, and what their vertices follow; None: the body has no surface."""
        import numpy as np

        model = self._trajectory.model
        of_body = model["model.mesh-body"] == number if "model.mesh-body" in model else np.zeros(0, bool)
        if of_body.any():
            vertices = np.flatnonzero(of_body)
            triangles = model["model.mesh-triangles"].astype(np.int64) - vertices[0]
            own = ((triangles >= 0) & (triangles < len(vertices))).all(axis=1)
            return triangles[own], of_cells(model["model.mesh-corners"][vertices], model["model.mesh-weights"][vertices])
        quads = model["model.skin"][model["model.skin-body"] == number]
        if not len(quads):
            return None
        particles, corners = np.unique(quads, return_inverse=True)
        return corners.reshape(quads.shape), of_particles(particles)

    def _skin(self, place: str, faces: Any, follow: Follow) -> None:
        import numpy as np
        from pxr import UsdGeom, Vt

        mesh = UsdGeom.Mesh.Define(self._stage, place)
        mesh.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(faces), faces.shape[1], np.int32)))
        mesh.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(faces.reshape(-1).astype(np.int32)))
        mesh.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
        mesh.CreateDoubleSidedAttr(True)
        self._points(mesh, follow, UsdGeom.Tokens.vertex)

    def _particles(self, place: str, particles: Any) -> None:
        from pxr import UsdGeom, Vt

        points = UsdGeom.Points.Define(self._stage, place)
        points.CreatePurposeAttr(UsdGeom.Tokens.guide)
        points.CreateIdsAttr(Vt.Int64Array.FromNumpy(particles.astype("int64")))
        points.CreateWidthsAttr(Vt.FloatArray([self._width()]))
        points.SetWidthsInterpolation(UsdGeom.Tokens.constant)
        self._points(points, of_particles(particles), UsdGeom.Tokens.vertex)

    def _springs(self, place: str, springs: Any, guide: bool) -> None:
        import numpy as np
        from pxr import UsdGeom, Vt

        curves = UsdGeom.BasisCurves.Define(self._stage, place)
        if guide:
            curves.CreatePurposeAttr(UsdGeom.Tokens.guide)
        curves.CreateTypeAttr(UsdGeom.Tokens.linear)
        curves.CreateCurveVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(springs), 2, np.int32)))
        curves.CreateWidthsAttr(Vt.FloatArray([0.5 * self._width()]))
        curves.SetWidthsInterpolation(UsdGeom.Tokens.constant)
        ends = self._trajectory.model["model.springs"][springs].reshape(-1)
        self._places(curves, of_particles(ends))
        for name in OF_SPRINGS:
            self._primvar(curves, name, of_particles(springs), UsdGeom.Tokens.uniform)

    def balls(self) -> None:
        """Write balls as spheres that do not turn."""
        from pxr import Gf, UsdGeom

        (positions,) = recorded(self._trajectory, ["ball-positions"])
        for number, radius in enumerate(self._trajectory.model["model.ball-radius"].tolist()):
            sphere = UsdGeom.Sphere.Define(self._stage, f"/aspic/ball_{number}")
            sphere.CreateRadiusAttr(radius)
            sphere.CreateExtentAttr([(-radius, -radius, -radius), (radius, radius, radius)])
            move = sphere.AddTranslateOp()
            for code, place in zip(self._codes, positions[:, number].astype("float64").tolist()):
                move.Set(Gf.Vec3d(*place), code)

    def _width(self) -> float:
        rest = self._trajectory.model["model.rest-length"]
        return float(rest.min()) / 10 if len(rest) else 0.01

    def _points(self, prim: Any, follow: Follow, interpolation: Any) -> None:
        from pxr import Vt

        self._places(prim, follow)
        if self._velocities is not None:
            velocities = prim.CreateVelocitiesAttr()
            for code, sample in zip(self._codes, self._velocities):
                velocities.Set(Vt.Vec3fArray.FromNumpy(follow(sample).astype("float32")), code)
        for name in OF_PARTICLES:
            self._primvar(prim, name, follow, interpolation)

    def _places(self, prim: Any, follow: Follow) -> None:
        import numpy as np
        from pxr import Vt

        points, extent = prim.CreatePointsAttr(), prim.CreateExtentAttr()
        for code, sample in zip(self._codes, self._positions):
            places = follow(sample).astype(np.float32)
            points.Set(Vt.Vec3fArray.FromNumpy(places), code)
            ends = np.stack([places.min(axis=0), places.max(axis=0)])
            extent.Set(Vt.Vec3fArray.FromNumpy(ends), code)

    def _primvar(self, prim: Any, name: str, follow: Follow, interpolation: Any) -> None:
        from pxr import Sdf, UsdGeom, Vt

        series = self._trajectory.get(name)
        if series is None:
            return
        types: dict[int, tuple[Any, Any]] = {
            2: (Sdf.ValueTypeNames.FloatArray, Vt.FloatArray),
            3: (Sdf.ValueTypeNames.Vector3fArray, Vt.Vec3fArray),
        }
        kind, array = types[series.ndim]
        primvar = UsdGeom.PrimvarsAPI(prim).CreatePrimvar(name.replace("-", "_"), kind, interpolation)
        for code, sample in zip(self._codes, series):
            primvar.Set(array.FromNumpy(follow(sample).astype("float32")), code)
