"""Reading of a simulation or an instance of a batch."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _aspic
from ._body import Ball, Body, body_index
from ._errors import Unshared, UsageError
from ._numbers import floats
from ._scene import Scene
from ._state import State, field_index
from ._trajectory import Energy

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._state import Floats

__all__ = ["Measures", "Quantities", "Readable", "Springs"]


class Measures(NamedTuple):
    """Diagnostics of a state, in double precision whatever the state's own."""

    energy: Energy
    """Energies [J]; ``energy.total`` is its sum."""
    momentum: NDArray[np.float64]
    """Momentum Σ m v of particles that are not pinned, (3,) [N·s]."""
    max_speed: float
    """[m/s]."""
    min_height: float
    """Lowest y of all particles and balls' centers [m]; 0 without any."""


class Springs(NamedTuple):
    """Every spring, sorted by its ends."""

    ends: NDArray[np.uint32]
    """Indices of particles, (m, 2), the lower one first."""
    stiffness: NDArray[np.float64]
    """k, (m,) [N/m]."""
    damping: NDArray[np.float64]
    """c, (m,) [N·s/m]."""
    rest_length: NDArray[np.float64]
    """(m,) [m]."""
    type: NDArray[np.uint8]
    """(m,): 0 structural, 1 shear, 2 bending."""
    cord: NDArray[np.uint8]
    """(m,): 1 where it resists stretch only."""


class Quantities(NamedTuple):
    """Quantities of particles and springs in a state, in double precision: docs/exports.md defines each."""

    speed: NDArray[np.float64]
    """Speeds of particles, (n,) [m/s]."""
    mean_strain: NDArray[np.float64]
    """Mean absolute strain of a particle's springs, (n,)."""
    force: NDArray[np.float64]
    """On particles, with the reaction of the ground, of other bodies and of pins, (n, 3) [N]."""
    contact_force: NDArray[np.float64]
    """Contact forces of the ground and of other bodies on particles, (n, 3) [N]."""
    contact: NDArray[np.bool_]
    """Whether particles are in contact with the ground or another body, (n,)."""
    strain: NDArray[np.float64]
    """L/r − 1 of springs, (m,); in the order of ``springs``."""
    tension: NDArray[np.float64]
    """Tensions of springs, (m,) [N]; < 0: compression."""


class Readable(Unshared):
    """The part of a simulation or of an instance of a batch that reads it."""

    _core: _aspic.Simulation | _aspic.Instance

    # What it is.

    @property
    def scene(self) -> Scene:
        """Copy of the scene with its present constants."""
        return Scene._of(self._core.scene)

    @property
    def precision(self) -> str:
        """``"single"`` or ``"double"``."""
        return "double" if self._core.doubles else "single"

    @property
    def timestep(self) -> float:
        """Time step h [s]."""
        return self._core.scene.timestep

    @property
    def masses(self) -> NDArray[np.float64]:
        """Masses of the particles, (n,) [kg], > 0, including pinned ones."""
        return self._core.masses()

    @property
    def springs(self) -> Springs:
        """All springs."""
        return Springs(*self._core.springs())

    @property
    def bodies(self) -> list[str]:
        """The names of the bodies, in the order of their particles."""
        return self._core.scene.bodies()

    @property
    def balls(self) -> list[Ball]:
        """All balls, by index."""
        return [Ball(self, i, *row) for i, row in enumerate(self._core.balls())]

    def __getitem__(self, name: str) -> Any:
        """Return the Body ``"cube[0]"`` (or ``"cube"``, the first one), one by its own name, or the Ball ``"ball[0]"``.

        ``"worm"`` and ``"voxels[worm]"`` are the body that a scene names so. Raises UsageError.
        """
        if not isinstance(name, str):
            raise UsageError(f"a body or ball is found by its name, 'cube[0]' or 'ball[0]', not by {name!r}")
        bodies = self.bodies
        index = body_index(bodies, name, self._core.scene)
        if index is not None:
            return Body(self, bodies[index], index, *self._core.ranges()[index])
        wanted = name if name.endswith("]") else f"{name}[0]"
        balls = {ball.name: ball for ball in self.balls}
        if wanted in balls:
            return balls[wanted]
        near = difflib.get_close_matches(wanted, [*bodies, *balls], 1)
        raise UsageError(
            f"the scene has no body {name!r}"
            + (f"; did you mean {near[0]!r}?" if near else f"; it has {', '.join([*bodies, *balls]) or 'none'}")
        )

    # Where it is.

    @property
    def steps(self) -> int:
        """Steps since the start."""
        return self._core.step

    @property
    def time(self) -> float:
        """Time, steps × h [s]."""
        return self.steps * self.timestep

    def read(self, field: str, out: Any = None) -> Any:
        """Return a field of the state: ``"positions"``, ``"velocities"``, ``"ball_positions"``, ``"ball_velocities"``
        or ``"ball_angular_velocities"``.

        ``out``: an array (n, 3) of float32 or float64, with any strides, which is filled and returned; None: a new one.
        Raises UsageError for an unknown field or another n.
        """
        import numpy as np

        index = field_index(field)
        count = len(self._core.balls()) if field.startswith("ball") else self._count()
        if out is None:
            out = np.empty((count, 3), np.float64 if self._core.doubles else np.float32)
        elif not isinstance(out, np.ndarray) or out.dtype not in (np.float32, np.float64) or not out.flags.writeable:
            raise UsageError("out has to be a writable array of float32 or float64")
        elif out.shape != (count, 3):
            raise UsageError(f"out has to have the shape {(count, 3)}, not {out.shape}")
        elif _overlaps(out):
            raise UsageError("out has numbers that share memory: each needs a place of its own")
        if any(stride % out.itemsize for stride in out.strides) or not out.flags.aligned:  # a field of a structured array
            out[...] = self.read(field)
        else:
            self._core.read_into(index, out)
        return out

    @property
    def positions(self) -> Floats:
        """Positions of the particles, (n, 3) [m]; can be assigned."""
        return self.read("positions")  # type: ignore[no-any-return]

    @positions.setter
    def positions(self, numbers: ArrayLike) -> None:
        self._write("positions", numbers, slice(None))

    @property
    def velocities(self) -> Floats:
        """Velocities of the particles, (n, 3) [m/s]; can be assigned."""
        return self.read("velocities")  # type: ignore[no-any-return]

    @velocities.setter
    def velocities(self, numbers: ArrayLike) -> None:
        self._write("velocities", numbers, slice(None))

    @property
    def ball_positions(self) -> Floats:
        """Positions of the balls' centers, (b, 3) [m]."""
        return self.read("ball_positions")  # type: ignore[no-any-return]

    @property
    def ball_velocities(self) -> Floats:
        """Velocities of the balls, (b, 3) [m/s]."""
        return self.read("ball_velocities")  # type: ignore[no-any-return]

    @property
    def ball_angular_velocities(self) -> Floats:
        """Angular velocities of the balls, (b, 3) [rad/s]."""
        return self.read("ball_angular_velocities")  # type: ignore[no-any-return]

    @property
    def measures(self) -> Measures:
        """Energies, momentum, largest speed and lowest height."""
        return _measures(self._core.measures())

    @property
    def _motion(self) -> Measures:
        """Measures with an elastic energy of 0, without a pass over springs and contacts."""
        return _measures(self._core.motion())

    @property
    def energy(self) -> Energy:
        """Energies [J]; ``energy.total`` is the sum of kinetic, elastic and gravitational energy."""
        return self.measures.energy

    @property
    def momentum(self) -> NDArray[np.float64]:
        """Momentum Σ m v of particles that are not pinned, (3,) [N·s]."""
        return self._motion.momentum

    @property
    def quantities(self) -> Quantities:
        """Present speeds, strains, forces and contacts; ``run()`` records them by their names."""
        speed, mean_strain, force, contact_force, contact, strain, tension = self._core.quantities()
        return Quantities(speed, mean_strain, force, contact_force, contact.astype("bool"), strain, tension)

    @property
    def hash(self) -> str:
        """The state's hash, as ``aspic run`` prints it: 16 hexadecimal digits, equal for the same bits only."""
        return self._core.state().hash

    def _count(self) -> int:
        return sum(count for _, count in self._core.ranges())

    def _write(self, field: str, numbers: ArrayLike, where: slice) -> None:
        state = State(self._core.state())
        changed = state.read(field)
        changed[where] = floats(numbers, changed[where].shape, field, not self._core.doubles)
        state.write(field, changed)
        self._core.load(state._core, None)


def _measures(row: tuple[float, float, float, tuple[float, float, float], float, float]) -> Measures:
    import numpy as np

    kinetic, elastic, gravitational, momentum, speed, height = row
    return Measures(Energy(kinetic, elastic, gravitational), np.array(momentum), speed, height)


def _overlaps(out: Any) -> bool:
    """Return whether numbers of an array (n, 3) may share memory."""
    axes = sorted((abs(stride), count) for stride, count in zip(out.strides, out.shape) if count > 1)
    reach = out.itemsize
    for stride, count in axes:
        if stride < reach:
            return True
        reach += stride * (count - 1)
    return False
