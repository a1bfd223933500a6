"""States of simulations, and where two of them differ."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

from . import _aspic
from ._errors import UsageError
from ._numbers import floats, whole

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._simulation import Simulation

    Floats = NDArray[np.floating[Any]]

__all__ = ["Difference", "QuantityDifference", "State", "compare"]

# In the order of the library's table.
FIELDS = ("positions", "velocities", "ball_positions", "ball_velocities", "ball_angular_velocities")


def field_index(name: str) -> int:
    """Return the number of a field. Raises UsageError for an unknown name."""
    try:
        return FIELDS.index(name.replace("-", "_"))
    except ValueError:
        raise UsageError(f"a state has no field {name!r}; it has {', '.join(FIELDS)}") from None


class State:
    """Positions and velocities after a number of steps, with the inputs that the run had so far.

    ``Simulation.save()`` makes one, ``Simulation.load()`` takes it. Arrays are (n, 3) copies, float32, or float64 of a
    simulation in double precision; they may be assigned. It can be pickled, without its inputs.
    """

    def __init__(self, core: _aspic.State, log: _aspic.InputLog | None = None):
        self._core = core
        self._log = log

    @property
    def step(self) -> int:
        """Steps since the start."""
        return self._core.step

    @step.setter
    def step(self, step: int) -> None:
        self._core.step = whole(step, "a step number")

    @property
    def precision(self) -> str:
        """``"single"`` or ``"double"``: of the solver that it came from."""
        return "double" if self._core.doubles else "single"

    @property
    def hash(self) -> str:
        """64-bit FNV-1a of all numbers (docs/files.md), 16 hexadecimal digits: equal for the same bits only."""
        return self._core.hash

    def read(self, field: str) -> Floats:
        """Return a copy of a field: ``"positions"``, ``"velocities"``, ``"ball_positions"``, … Raises UsageError."""
        numbers = self._core.read(field_index(field))
        return numbers if self._core.doubles else numbers.astype("float32")

    def write(self, field: str, numbers: ArrayLike) -> None:
        """Replace a field by finite numbers of the shape (n, 3). Raises UsageError for others."""
        index = field_index(field)
        self._core.write(index, floats(numbers, self._core.read(index).shape, field, not self._core.doubles))

    @property
    def positions(self) -> Floats:
        """Positions of the particles, (n, 3) [m]."""
        return self.read("positions")

    @positions.setter
    def positions(self, numbers: ArrayLike) -> None:
        self.write("positions", numbers)

    @property
    def velocities(self) -> Floats:
        """Velocities of the particles, (n, 3) [m/s]."""
        return self.read("velocities")

    @velocities.setter
    def velocities(self, numbers: ArrayLike) -> None:
        self.write("velocities", numbers)

    def copy(self) -> State:
        """Return a copy with the same numbers and inputs."""
        return State(self._core.copy(), self._log)

    __copy__ = copy

    def __deepcopy__(self, memo: dict[int, Any]) -> State:
        return self.copy()

    def __reduce__(self) -> tuple[Any, ...]:
        return (_restored, (self.step, self._core.doubles, [self._core.read(i) for i in range(len(FIELDS))]))

    def __repr__(self) -> str:
        return f"<aspic.State: step {self.step}, {len(self._core.read(0))} particles, hash {self.hash}>"


def _restored(step: int, doubles: bool, fields: list[Any]) -> State:
    core = _aspic.State(step, doubles)
    for index, numbers in enumerate(fields):
        core.write(index, numbers)
    return State(core)


class QuantityDifference(NamedTuple):
    """The largest differences in one quantity."""

    absolute: float
    """Largest difference of any component, in the quantity's unit."""
    where: int
    """The particle or ball it was found at."""
    ulp: int
    """Largest distance of any component in units in the last place."""
    ulp_where: int
    """The particle or ball of that."""


class Difference(Mapping[str, QuantityDifference]):
    """Where two states differ most, by quantity: ``difference["positions"].absolute``."""

    def __init__(self, parts: dict[str, QuantityDifference]):
        self._parts = parts

    @property
    def identical(self) -> bool:
        """True if all bits are equal; −0 and +0 differ."""
        return all(part.ulp == 0 for part in self._parts.values())

    def __getitem__(self, quantity: str) -> QuantityDifference:
        return self._parts[quantity]

    def __iter__(self) -> Any:
        return iter(self._parts)

    def __len__(self) -> int:
        return len(self._parts)

    def __repr__(self) -> str:
        if self.identical:
            return "<aspic.Difference: identical>"
        found = (f"{name} {part.absolute:g} ({part.ulp} ULP)" for name, part in self._parts.items() if part.ulp)
        return f"<aspic.Difference: {', '.join(found)}>"


def compare(a: State | Simulation, b: State | Simulation) -> Difference:
    """Compare two states, or the present states of simulations, component by component.

    Raises UsageError where they have other numbers of particles or balls.
    """
    states = [x if isinstance(x, State) else x.save() for x in (a, b)]
    rows = _aspic.compare_states(states[0]._core, states[1]._core)
    return Difference({FIELDS[i]: QuantityDifference(*row[1:]) for i, row in enumerate(rows)})
