"""Inputs of a simulation, by step."""

from __future__ import annotations

import difflib
import operator
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, NamedTuple

from . import _aspic
from ._errors import UsageError
from ._numbers import name_of
from ._reading import Readable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

__all__ = ["Pull", "Replayable", "Signals", "Steerable"]


class Pull(NamedTuple):
    """A damped spring of rest length 0 from a particle to a fixed anchor, as a hand pulls."""

    particle: int
    """Index, of a ball where ``ball``. A pinned particle stays."""
    anchor: Sequence[float]
    """(3,) [m]."""
    stiffness: float
    """k [N/m], ≥ 0."""
    damping: float = 0.0
    """c [N·s/m], ≥ 0."""
    ball: bool = False
    """Pulls the center of a ball instead of a particle."""


def _row(pull: Pull) -> tuple[int, tuple[float, float, float], float, float, bool]:
    """Return the row that the extension module takes. Raises UsageError."""
    if not isinstance(pull, Pull):
        raise UsageError(f"a pull is an aspic.Pull(particle, anchor, stiffness), not {pull!r}")
    particle, anchor, stiffness, damping, ball = pull
    try:
        if isinstance(particle, bool):
            raise TypeError
        number, (x, y, z) = operator.index(particle), anchor
        row = (number, (float(x), float(y), float(z)), float(stiffness), float(damping), bool(ball))
    except (TypeError, ValueError):
        raise UsageError(f"a pull has an index, an anchor of three numbers, a stiffness and a damping, not {pull!r}") from None
    if not 0 <= number < 2**32:
        raise UsageError(f"a pull's particle is an index, 0 or more, not {number}")
    return row


class Steerable(Readable):
    """The part of a simulation or of an instance of a batch that takes inputs."""

    @property
    def pulls(self) -> tuple[Pull, ...]:
        """Pulls that act from this step on; assign one, or up to 256. Raises UsageError with the index."""
        return tuple(Pull(*row) for row in self._core.inputs()[0])

    @pulls.setter
    def pulls(self, pulls: Iterable[Pull] | Pull) -> None:
        if not isinstance(pulls, Pull) and not isinstance(pulls, Iterable):
            raise UsageError(f"pulls are one aspic.Pull or a list of them, not {type(pulls).__name__}")
        rows = [_row(pull) for pull in ([pulls] if isinstance(pulls, Pull) else pulls)]
        _, pinned, released, channels = self._core.inputs()
        self._core.set_inputs((rows, pinned, released, channels))

    @property
    def pinned(self) -> NDArray[np.intp]:
        """Indices of pinned particles, ascending: those of the scene, or as assigned.

        May be assigned: indices, or (n,) of bool. A particle that moves stops. Raises UsageError for other indices.
        """
        import numpy as np

        pulls, pinned, released, channels = self._core.inputs()
        now = (set(self._core.pinned().tolist()) | set(pinned)) - set(released)
        return np.array(sorted(now), dtype=np.intp)

    @pinned.setter
    def pinned(self, particles: ArrayLike) -> None:
        import numpy as np

        given = np.asarray(particles)
        if given.dtype == object or given.dtype.kind == "U":
            raise UsageError(
                f"pinned particles are a list or an array of indices, not {type(particles).__name__}; faces and corners "
                "are named by the scene's key 'pinned'"
            )
        if given.dtype == np.bool_:
            if given.shape != (self._count(),):
                raise UsageError(f"{self._count()} of bool say which particles are pinned, not {given.shape}")
            given = np.flatnonzero(given)
        if given.size and (given.dtype.kind not in "iu" or given.min() < 0 or given.max() >= self._count()):
            raise UsageError(f"pinned particles are given by indices from 0 to {self._count() - 1}")
        wanted = {int(i) for i in given.ravel()}
        scene = set(self._core.pinned().tolist())
        pulls, _, _, channels = self._core.inputs()
        self._core.set_inputs((pulls, sorted(wanted - scene), sorted(scene - wanted), channels))

    @property
    def channels(self) -> tuple[float, ...]:
        """Input channels by index, which actuators with ``signal = "input"`` read; ``inputs`` has them by name.

        They may be assigned, and are kept and replayed as pulls are; those that are missing are 0. Raises UsageError
        for numbers that are not finite, and for more than the scene's actuators read, where it has any.
        """
        return tuple(self._core.inputs()[3])

    @channels.setter
    def channels(self, channels: Iterable[float]) -> None:
        pulls, pinned, released, _ = self._core.inputs()
        try:
            numbers = [float(number) for number in channels]
        except (TypeError, ValueError):
            raise UsageError(f"channels are a list of numbers, not {channels!r}") from None
        self._core.set_inputs((pulls, pinned, released, numbers))

    @property
    def inputs(self) -> Signals:
        """Signals of the actuators with ``signal = "input"``, by their names: ``sim.inputs["legs"] = 0.3``.

        A dict in its place sets several; the others stay. They hold from this step on. Raises UsageError for unknown
        names and numbers that are not finite.
        """
        return Signals(self)

    @inputs.setter
    def inputs(self, values: Mapping[str, float]) -> None:
        Signals(self).update(values)


class Signals(Mapping[str, float]):
    """Inputs by the names of their actuators, in the order of the scene. Those that were never set are 0."""

    def __init__(self, of: Steerable):
        self._of = of
        self._names: list[str] = of._core.input_names()

    def __getitem__(self, name: str) -> float:
        number = self._number(name)
        channels = self._of.channels
        return channels[number] if number < len(channels) else 0.0

    def __setitem__(self, name: str, value: float) -> None:
        self.update({name: value})

    def update(self, values: Mapping[str, float]) -> None:
        """Set several signals."""
        channels = list(self._of.channels)
        channels += [0.0] * (len(self._names) - len(channels))
        for name, value in values.items():
            channels[self._number(name)] = float(value)
        self._of.channels = channels

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __repr__(self) -> str:
        return repr(dict(self))

    def _number(self, name: str) -> int:
        if name in self._names:
            return self._names.index(name)
        near = difflib.get_close_matches(name, self._names, 1)
        has = f"the inputs are {', '.join(self._names)}" if self._names else "no actuator has signal = \"input\""
        raise UsageError(f"there is no input {name!r}; " + (f"did you mean {near[0]!r}?" if near else has))


class Replayable(Steerable):
    """The part of a simulation that keeps its inputs by step."""

    _core: _aspic.Simulation

    @property
    def input_log(self) -> str:
        """All inputs so far by step, as TOML for ``aspic run --replay`` and ``replay()``."""
        return self._core.log_text()

    def save_inputs(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Write ``input_log``. Raises FileExistsError unless ``overwrite``, and what ``open()`` raises."""
        with open(path, "w" if overwrite else "x", encoding="utf-8") as file:
            file.write(self.input_log)

    def replay(self, path: str | os.PathLike[str]) -> None:
        """Load the inputs of a file by step: the run repeats to the bit on every backend.

        Later assignments to ``pulls`` and ``pinned`` replace the rest of it. Raises SceneError with every mistake
        and its line; FileError.
        """
        self._core.set_log(self._core.read_log(name_of(path)))
