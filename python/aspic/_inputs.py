"""What acts on a simulation from outside, by step."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, NamedTuple

from . import _aspic
from ._errors import UsageError
from ._reading import Readable

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

__all__ = ["Pull", "Replayable", "Steerable"]


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
    """Pulls the centre of a ball instead of a particle."""


class Steerable(Readable):
    """The part of a simulation or of an instance of a batch that takes inputs."""

    @property
    def pulls(self) -> tuple[Pull, ...]:
        """The pulls that act from this step on; may be assigned, one or up to 256. Raises UsageError with the index."""
        return tuple(Pull(*row) for row in self._core.inputs()[0])

    @pulls.setter
    def pulls(self, pulls: Iterable[Pull] | Pull) -> None:
        rows = []
        for particle, anchor, stiffness, damping, ball in [pulls] if isinstance(pulls, Pull) else pulls:
            if particle < 0:
                raise UsageError(f"a pull's particle is an index, 0 or more, not {particle}")
            x, y, z = (float(a) for a in anchor)
            rows.append((int(particle), (x, y, z), float(stiffness), float(damping), bool(ball)))
        _, pinned, released, channels = self._core.inputs()
        self._core.set_inputs((rows, pinned, released, channels))

    @property
    def pinned(self) -> NDArray[np.intp]:
        """Indices of the particles that are pinned, ascending: the scene's, and what was assigned since.

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
        """Numbers by index, at most 65,536, for parts of a model that read an input, which none does yet.

        They may be assigned, and are kept and replayed as pulls are. Raises UsageError for numbers that are not finite.
        """
        return tuple(self._core.inputs()[3])

    @channels.setter
    def channels(self, channels: Iterable[float]) -> None:
        pulls, pinned, released, _ = self._core.inputs()
        self._core.set_inputs((pulls, pinned, released, [float(number) for number in channels]))


class Replayable(Steerable):
    """The part of a simulation that keeps its inputs by step."""

    _core: _aspic.Simulation

    @property
    def input_log(self) -> str:
        """All inputs so far by step, as TOML: what ``aspic run --replay`` and ``replay()`` read."""
        return self._core.log_text()

    def save_inputs(self, path: str | os.PathLike[str], overwrite: bool = False) -> None:
        """Writes ``input_log``. Raises FileExistsError unless ``overwrite``, and what ``open()`` raises."""
        with open(path, "w" if overwrite else "x", encoding="utf-8") as file:
            file.write(self.input_log)

    def replay(self, path: str | os.PathLike[str]) -> None:
        """Takes over the inputs of a file by step: the run repeats to the bit on every backend.

        What is assigned to ``pulls`` and ``pinned`` later replaces the rest of it. Raises SceneError with every mistake
        and its line; FileError.
        """
        self._core.set_log(self._core.read_log(os.fspath(path)))
