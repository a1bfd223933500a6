"""Bodies and balls of a simulation, by name."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from . import _aspic
    from ._reading import Readable
    from ._state import Floats

__all__ = ["Ball", "Body", "Skin", "body_index"]


def body_index(bodies: list[str], name: str, scene: _aspic.Scene) -> int | None:
    """Return the number of the body named ``cube[0]``, ``cube`` or as in the scene; None without one."""
    wanted = name if name.endswith("]") else f"{name}[0]"
    if wanted in bodies:
        return bodies.index(wanted)
    named = set(scene.keys())
    for index, body in enumerate(bodies):
        own = scene.value(f"{body}.name") if f"{body}.name" in named else None
        if own and name in (own, f"{body.partition('[')[0]}[{own}]"):
            return index
    return None


class Skin(NamedTuple):
    """The mesh that is drawn on a body of cells in place of their faces."""

    vertices: NDArray[np.float64]
    """(v, 3) [m], where the cells carry them."""
    triangles: NDArray[np.uint32]
    """(t, 3) indices into ``vertices``, counterclockwise from outside."""


class Body:
    """A body of a simulation: ``sim["cube[0]"]``. It follows the simulation; its arrays are copies."""

    def __init__(self, simulation: Readable, name: str, index: int, first: int, count: int):
        self._simulation = simulation
        self._index = index
        self._first = first
        self._count = count
        self._name = name

    @property
    def name(self) -> str:
        """Name of the body, ``"cube[0]"``."""
        return self._name

    @property
    def particles(self) -> range:
        """Indices of its particles in the simulation's arrays."""
        return range(self._first, self._first + self._count)

    @property
    def _slice(self) -> slice:
        return slice(self._first, self._first + self._count)

    @property
    def positions(self) -> Floats:
        """Positions of its particles, (n, 3) [m]; can be assigned."""
        return self._simulation.positions[self._slice]

    @positions.setter
    def positions(self, numbers: ArrayLike) -> None:
        self._simulation._write("positions", numbers, self._slice)

    @property
    def velocities(self) -> Floats:
        """Velocities of its particles, (n, 3) [m/s]; can be assigned."""
        return self._simulation.velocities[self._slice]

    @velocities.setter
    def velocities(self, numbers: ArrayLike) -> None:
        self._simulation._write("velocities", numbers, self._slice)

    @property
    def masses(self) -> NDArray[np.float64]:
        """Masses of its particles, (n,) [kg], including pinned ones."""
        return self._simulation.masses[self._slice]

    @property
    def center_of_mass(self) -> NDArray[np.float64]:
        """Center of mass, (3,) [m]."""
        return weighted(self.masses, self.positions) / float(self.masses.sum())

    centre_of_mass = center_of_mass  # until 0.4

    @property
    def momentum(self) -> NDArray[np.float64]:
        """Momentum Σ m v, (3,) [N·s]."""
        return weighted(self.masses, self.velocities)

    @property
    def forces(self) -> NDArray[np.float64]:
        """Forces on its particles, with the reaction of the ground and of pins, (n, 3) [N]."""
        return self._simulation.quantities.force[self._slice]

    @property
    def contacts(self) -> NDArray[np.bool_]:
        """Flags of particles in contact with terrain or another body, (n,) of bool."""
        return self._simulation.quantities.contact[self._slice]

    @property
    def strain(self) -> NDArray[np.float64]:
        """Mean absolute strain of each particle's springs, (n,)."""
        return self._simulation.quantities.mean_strain[self._slice]

    @property
    def surface(self) -> NDArray[np.uint32]:
        """Surface quads, (m, 4) indices into ``positions``, counterclockwise from outside; none for nets."""
        faces = self._simulation._core.surface(self._index)
        return faces - faces.dtype.type(self._first)

    @property
    def skin(self) -> Skin | None:
        """The mesh that the body was made from, at its present place; None without one."""
        corners, weights, triangles = self._simulation._core.mesh(self._index)
        if len(triangles) == 0:
            return None
        at = self._simulation.positions[corners].astype("float64")
        return Skin((weights[:, :, None] * at).sum(axis=1), triangles)

    def __len__(self) -> int:
        return self._count

    def __repr__(self) -> str:
        return f"<aspic.Body {self._name}: {self._count} particles>"


class Ball:
    """A ball of a simulation: ``sim["ball[0]"]``, a solid sphere. Those of launchers come after those of [[ball]]."""

    def __init__(self, simulation: Readable, index: int, radius: float, mass: float, launch_step: int):
        self._simulation = simulation
        self._index = index
        self._radius = radius
        self._mass = mass
        self._launch_step = launch_step

    @property
    def name(self) -> str:
        """Name of the ball, ``"ball[0]"``."""
        return f"ball[{self._index}]"

    @property
    def radius(self) -> float:
        """Radius [m]."""
        return self._radius

    @property
    def mass(self) -> float:
        """Mass [kg]."""
        return self._mass

    @property
    def launch_step(self) -> int:
        """First step number at which the ball moves."""
        return self._launch_step

    @property
    def position(self) -> Floats:
        """Position of its center, (3,) [m]."""
        return self._simulation.ball_positions[self._index]  # type: ignore[no-any-return]

    @property
    def velocity(self) -> Floats:
        """Velocity, (3,) [m/s]."""
        return self._simulation.ball_velocities[self._index]  # type: ignore[no-any-return]

    @property
    def angular_velocity(self) -> Floats:
        """Angular velocity, (3,) [rad/s]."""
        return self._simulation.ball_angular_velocities[self._index]  # type: ignore[no-any-return]

    def __repr__(self) -> str:
        return f"<aspic.Ball {self._index}: radius {self._radius:g} m, mass {self._mass:g} kg>"


def weighted(masses: Any, vectors: Any) -> NDArray[np.float64]:
    """Return Σ m·v in double precision, (3,); each axis has its own sum, independent of the array's other columns."""
    return (masses[:, None] * vectors.astype("float64")).sum(axis=0)  # type: ignore[no-any-return]
