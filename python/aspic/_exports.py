"""Files of motions for other programs, and what their arrays are."""

from __future__ import annotations

import itertools
import os
import shutil
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple, Union

from . import _aspic
from ._errors import UsageError
from ._numbers import name_of

if TYPE_CHECKING:
    from ._scene import Scene
    from ._trajectory import Trajectory

__all__ = ["Kind", "export", "kind_of", "model_arrays", "write_complete"]

Path = Union[str, "os.PathLike[str]"]

# The library writes these, and the packages usd-core and zarr the others.
OF_LIBRARY = (".pvd", ".pc2", ".npz")
OF_USD = (".usd", ".usda", ".usdc")
ENDINGS = (*OF_LIBRARY, *OF_USD, ".zarr")


class Kind(NamedTuple):
    """Metadata of an array, besides time."""

    dimensions: tuple[str, ...]
    """Dimensions of a sample: ``("particle", "axis")``."""
    unit: str
    """SI unit; empty: it has none."""
    meaning: str
    """A phrase."""


VECTOR, SCALAR = ("particle", "axis"), ("particle",)
KINDS: dict[str, Kind] = {
    "positions": Kind(VECTOR, "m", "positions of the particles"),
    "velocities": Kind(VECTOR, "m/s", "velocities of the particles"),
    "ball-positions": Kind(("ball", "axis"), "m", "centers of the balls"),
    "ball-velocities": Kind(("ball", "axis"), "m/s", "velocities of the balls"),
    "ball-angular-velocities": Kind(("ball", "axis"), "rad/s", "angular velocities of the balls"),
    "speed": Kind(SCALAR, "m/s", "speed of the particles"),
    "mean-strain": Kind(SCALAR, "1", "mean |L/r − 1| of a particle's springs"),
    "force": Kind(VECTOR, "N", "net force on the particles"),
    "contact-force": Kind(VECTOR, "N", "force of terrain and other bodies on the particles"),
    "contact": Kind(SCALAR, "", "1 where a particle touches terrain"),
    "strain": Kind(("spring",), "1", "L/r − 1 of the springs"),
    "tension": Kind(("spring",), "N", "force of the springs, positive where they pull"),
    "energy.kinetic": Kind((), "J", "kinetic energy"),
    "energy.elastic": Kind((), "J", "elastic energy"),
    "energy.gravitational": Kind((), "J", "gravitational energy"),
    "actuator-work": Kind((), "J", "work of actuators since the first sample"),
    "momentum": Kind(("axis",), "N s", "momentum"),
    "center-of-mass": Kind(("axis",), "m", "center of mass"),
    "max-speed": Kind((), "m/s", "largest speed"),
    "min-height": Kind((), "m", "lowest y"),
    "hash": Kind((), "", "hash of the state"),
    "model.masses": Kind(SCALAR, "kg", "masses of the particles"),
    "model.pinned": Kind(SCALAR, "", "1 where the scene pins a particle"),
    "model.body": Kind(SCALAR, "", "body of a particle, by number"),
    "model.springs": Kind(("spring", "end"), "", "particles that the springs join"),
    "model.spring-type": Kind(("spring",), "", "0 structural, 1 shear, 2 bending"),
    "model.cord": Kind(("spring",), "", "1 where a spring resists stretch only"),
    "model.stiffness": Kind(("spring",), "N/m", "stiffness of the springs"),
    "model.damping": Kind(("spring",), "N s/m", "damping of the springs"),
    "model.rest-length": Kind(("spring",), "m", "rest length of the springs"),
    "model.skin": Kind(("quad", "corner"), "", "particles at the corners of the surfaces"),
    "model.skin-body": Kind(("quad",), "", "body of a square of the surfaces, by number"),
    "model.mesh-corners": Kind(("vertex", "cell-corner"), "", "particles at the corners of the cell of a mesh's vertex"),
    "model.mesh-weights": Kind(("vertex", "cell-corner"), "", "their weights in the vertex's position"),
    "model.mesh-body": Kind(("vertex",), "", "body of a mesh's vertex, by number"),
    "model.mesh-triangles": Kind(("triangle", "triangle-corner"), "", "vertices of the meshes' triangles"),
    "model.ball-radius": Kind(("ball",), "m", "radii of the balls"),
    "model.ball-mass": Kind(("ball",), "kg", "masses of the balls"),
}
# What a record of "motion" is, and an export holds.
MOTION = (
    "positions",
    "velocities",
    "ball-positions",
    "ball-velocities",
    "ball-angular-velocities",
    "speed",
    "mean-strain",
    "force",
    "contact-force",
    "contact",
    "strain",
    "tension",
    "energy",
    "momentum",
    "actuator-work",
)


def plain(name: str) -> str:
    """Return a quantity's name with hyphens; the spelling ``centre`` is accepted until 0.4."""
    return name.replace("_", "-").replace("centre", "center")


def kind_of(name: str) -> Kind:
    """Return metadata of an array by its name; ``"cube[0].positions"`` has that body's particles as a dimension."""
    if plain(name) in KINDS:
        return KINDS[plain(name)]
    body, _, what = name.rpartition(".")
    kind = KINDS[plain(what)]
    return kind._replace(dimensions=tuple(f"{body}.{d}" if d == "particle" else d for d in kind.dimensions))


def about_all(names: Iterable[str]) -> bool:
    """Return whether an array is of all particles or springs, so that arrays of the model belong to it."""
    found = {d for name in names if not name.startswith("model.") for d in kind_of(name).dimensions}
    return not found.isdisjoint(("particle", "spring"))


def model_arrays(scene: Scene) -> dict[str, Any]:
    """Return constant arrays: masses, springs, surfaces."""
    import numpy as np

    from ._simulation import Simulation

    sim = Simulation._quiet(scene, "reference")
    core, springs, balls = sim._core, sim.springs, sim.balls
    pinned = np.zeros(len(sim.masses), np.uint8)
    pinned[core.pinned()] = 1
    bodies = core.ranges()
    skins = [core.surface(b) for b in range(len(bodies))]
    arrays = {
        "model.masses": sim.masses,
        "model.pinned": pinned,
        "model.body": np.repeat(np.arange(len(bodies), dtype=np.int32), [count for _, count in bodies]),
        "model.springs": springs.ends,
        "model.spring-type": springs.type,
        "model.cord": springs.cord,
        "model.stiffness": springs.stiffness,
        "model.damping": springs.damping,
        "model.rest-length": springs.rest_length,
        "model.skin": np.concatenate([np.empty((0, 4), np.uint32), *skins]),
        "model.skin-body": np.repeat(np.arange(len(bodies), dtype=np.int32), [len(skin) for skin in skins]),
    }
    arrays |= _meshes([core.mesh(b) for b in range(len(bodies))])
    if balls:
        arrays["model.ball-radius"] = np.array([ball.radius for ball in balls])
        arrays["model.ball-mass"] = np.array([ball.mass for ball in balls])
    return arrays


def _meshes(of_bodies: list[tuple[Any, Any, Any]]) -> dict[str, Any]:
    """Return the meshes of bodies of cells; empty if no body has one."""
    import numpy as np

    counts = [len(corners) for corners, _, _ in of_bodies]
    if not any(counts):
        return {}
    first = np.cumsum([0, *counts[:-1]])
    return {
        "model.mesh-corners": np.concatenate([corners for corners, _, _ in of_bodies]),
        "model.mesh-weights": np.concatenate([weights for _, weights, _ in of_bodies]),
        "model.mesh-body": np.repeat(np.arange(len(counts), dtype=np.int32), counts),
        "model.mesh-triangles": np.concatenate(
            [triangles + np.uint32(n) for n, (_, _, triangles) in zip(first, of_bodies)]
        ),
    }


def needs(package: str, use: str) -> ModuleNotFoundError:
    """Return the error for a missing package."""
    return ModuleNotFoundError(f"{use} needs the package {package}: pip install {package}", name=package)


_numbers = itertools.count()


def write_complete(path: Path, overwrite: bool, write: Callable[[str], None]) -> None:
    """Write a file or folder next to its place, and rename it when it is complete.

    Raises FileExistsError unless ``overwrite``, and what ``write`` raises; then nothing is left.
    """
    name = os.fspath(path)
    folder, base = os.path.split(name)
    if not overwrite and os.path.lexists(name):
        raise FileExistsError(f"{name!r} exists and was not changed: choose another name, or pass overwrite=True")
    mark = f".aspic-{os.getpid()}-{next(_numbers)}.tmp"
    ending = os.path.splitext(base)[1]  # by which writers choose
    temporary = os.path.join(folder, mark + ending)
    try:
        write(temporary)
        if os.path.isdir(temporary):
            _replace_folder(temporary, name, os.path.join(folder, mark + ".old"))
        elif overwrite:
            os.replace(temporary, name)
        else:
            os.link(temporary, name)  # which does not replace what came in the meantime
    finally:
        _remove(temporary)


def _replace_folder(temporary: str, name: str, aside: str) -> None:
    if os.path.lexists(name):
        os.rename(name, aside)
    os.rename(temporary, name)
    _remove(aside)


def _remove(path: str) -> None:
    if os.path.isdir(path) and not os.path.islink(path):
        shutil.rmtree(path, ignore_errors=True)
    elif os.path.lexists(path):
        os.unlink(path)


def ending_of(path: Path) -> str:
    """Return the ending in lower case, one of ``ENDINGS``. Raises UsageError for others."""
    name = name_of(path)
    ending = os.path.splitext(name)[1].lower()
    if ending not in ENDINGS:
        raise UsageError(f"a motion is exported as {', '.join(ENDINGS)}, not as {name!r}")
    return ending


def export(trajectory: Trajectory, path: Path, overwrite: bool, springs: bool) -> None:
    """Write a trajectory for another program, as ``Trajectory.export()`` says."""
    ending = ending_of(path)
    if ending == ".zarr":
        trajectory.save(path, overwrite)
    elif ending in OF_USD:
        from ._usd import write

        write_complete(path, overwrite, lambda name: write(name, trajectory, springs))
    else:
        _by_library(trajectory, path, overwrite)


def _by_library(trajectory: Trajectory, path: Path, overwrite: bool) -> None:
    import numpy as np

    scene = scene_of(trajectory)
    fields = ["positions", "velocities"]
    if "model.ball-radius" in trajectory.model:
        fields += ["ball-positions", "ball-velocities", "ball-angular-velocities"]
    arrays = recorded(trajectory, fields)
    writer = _aspic.Export(scene._core, os.fspath(path), overwrite)
    doubles = arrays[0].dtype == np.float64
    for sample, step in enumerate(trajectory.steps.tolist()):
        state = _aspic.State(step, doubles)
        for field, array in enumerate(arrays):
            state.write(field, np.ascontiguousarray(array[sample], dtype=np.float64))
        writer.add_state(state)
    writer.finish(trajectory._texts().get("warnings", ""))


def scene_of(trajectory: Trajectory) -> Scene:
    """Return the scene of a trajectory. Raises UsageError if it is unknown."""
    if trajectory.scene is None:
        raise UsageError("this trajectory does not know its scene, which says what its particles are: record it again")
    return trajectory.scene


def recorded(series: Mapping[str, Any], names: Iterable[str]) -> list[Any]:
    """Return required series. Raises UsageError, which names what to record."""
    of = {plain(name): name for name in series}
    missing = [name for name in names if name not in of]
    if missing:
        raise UsageError(f'{", ".join(missing)} were not recorded: run with record=["motion"], which is all of it')
    return [series[of[name]] for name in names]
