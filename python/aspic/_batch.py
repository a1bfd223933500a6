"""Batches: many scenes in motion."""

from __future__ import annotations

import operator
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import TYPE_CHECKING, Any, SupportsIndex, Union

from . import _aspic
from ._body import body_index
from ._errors import DivergedError, Unshared, UsageError, diverged
from ._exports import plain
from ._inputs import Steerable
from ._numbers import positive, whole
from ._scene import Scene, changes, load
from ._state import State, field_index
from ._trajectory import BatchTrajectory, Energy

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import ArrayLike, NDArray

    from ._image import Image
    from ._simulation import Simulation

__all__ = ["Batch", "Instance"]

Path = Union[str, "os.PathLike[str]"]

MOST = 10_000_000
"""Instances of one scene."""

# What may be recorded of all particles of an instance.
_OF_ALL = ("center-of-mass", "momentum", "energy", "actuator-work")


class Instance(Steerable):
    """An instance of a batch: ``batch[i]``, with the interface of a Simulation. Only the batch makes its steps.

    It follows the batch; its arrays are copies, (n, 3), float32.
    """

    _core: _aspic.Instance

    def __init__(self, core: _aspic.Instance, number: int, drawer: _Drawer):
        self._core = core
        self._number = number
        self._drawer = drawer

    @property
    def divergence(self) -> DivergedError | None:
        """The divergence, as the exception that a Simulation raises; None: it has not diverged."""
        found = self._core.divergence()
        return diverged(found) if found else None

    def update(self, values: Mapping[str, Any]) -> None:
        """Change constants of this instance alone, and clear its divergence.

        ``values``, and what it raises: as ``Simulation.update()``. An instance with another time step than those it is
        computed with becomes slower.
        """
        self._core.update(changes(values))

    def save(self) -> State:
        """Return a copy of the state with the present inputs, for ``load()``, also that of a Simulation."""
        return State(self._core.state(), self._core.log())

    def load(self, state: State) -> None:
        """Load a state of the same model, with its inputs, and clear a divergence.

        Raises UsageError.
        """
        if not isinstance(state, State):
            raise UsageError(f"load() takes a State, as save() returns, not {type(state).__name__}")
        self._core.load(state._core, state._log)

    def render(
        self, width: int = 960, height: int = 540, view: Mapping[str, Any] | None = None, *, text: bool = True
    ) -> Image:
        """Return an image of the state, as ``Simulation.render()``. The batch keeps its OpenGL context."""
        return self._drawer.of(self).render(width, height, view, text=text)

    def _ipython_key_completions_(self) -> list[str]:
        return [*self.bodies, *(ball.name for ball in self.balls)]

    def __repr__(self) -> str:
        return f"<aspic.Instance {self._number} of {self._core.scene.name!r}: step {self.steps}, {self.time:g} s>"


class _Drawer:
    """A simulation that shows instances, without images."""

    def __init__(self) -> None:
        self._shown: tuple[str, Simulation] | None = None

    def of(self, instance: Instance) -> Simulation:
        """Return a simulation at the instance's state, with its scene."""
        from ._simulation import Simulation

        scene = instance.scene
        if self._shown is None or self._shown[0] != scene.toml:
            self._shown = (scene.toml, Simulation._quiet(scene, "cpu", threads=1))
        self._shown[1].load(instance.save())
        return self._shown[1]


class Batch(Unshared):
    """Many scenes that are stepped together on the CPU, equal ones and others in any mixture, without contact.

    Instance i ends with the bits that ``Simulation(scenes[i])`` has, whatever the others are and however many threads
    compute. One that diverges stays at its last good state, while the others continue. Scenes with the same bodies and
    time step, an explicit method, at most 2,048 particles and no balls are the fastest, and few long calls are faster
    than many short ones. Every number is in SI units; arrays are copies with the instance first. Steps run without the
    GIL; several threads may use one batch: they take turns.
    """

    def __init__(
        self,
        scenes: Scene | Path | Iterable[Scene | Path],
        backend: str = "cpu",
        *,
        count: int | None = None,
        threads: int = 0,
    ) -> None:
        """Create n instances at the start of their scenes; later changes of the scenes have no effect.

        ``scenes``: several, each one or what ``aspic.load()`` takes, or a single one, of which ``count`` instances are
        made; the same object several times is made once. ``backend``: ``"cpu"``, or ``"auto"``, which is the same:
        there are no batches on a GPU yet. ``threads``: 1 … 1024, 0: the number of CPU cores, or the environment
        variable ASPIC_THREADS. Raises UsageError for no scenes, another backend and other numbers; SceneError where a
        model is larger than memory, and what ``load()`` raises.
        """
        if backend not in ("cpu", "auto"):
            raise UsageError(
                f"a batch is stepped on the CPU: its backend is 'cpu' or 'auto', not {backend!r}. There are no batches "
                "on a GPU yet; single simulations have all backends, and end with the same bits"
            )
        if isinstance(scenes, (Scene, str, os.PathLike)):
            copies = 1 if count is None else whole(count, "count, a number of instances,", least=1, most=MOST)
            wanted: list[Scene | Path] = [scenes] * copies
        elif count is not None:
            raise UsageError("count belongs to a single scene: a list has as many instances as scenes")
        else:
            wanted = list(scenes)
        threads = whole(threads, "a number of threads (0: as many as CPU cores)", most=1024)
        numbers: dict[Any, int] = {}
        cores: list[_aspic.Scene] = []
        which: list[int] = []
        for scene in wanted:
            key = id(scene) if isinstance(scene, Scene) else os.fspath(scene)
            if key not in numbers:
                numbers[key] = len(cores)
                cores.append((scene if isinstance(scene, Scene) else load(scene))._core)
            which.append(numbers[key])
        self._core = _aspic.Batch(cores, which, threads)
        self._size = len(which)
        self._drawer = _Drawer()

    # Instances.

    def __len__(self) -> int:
        """Return the number of instances."""
        return self._size

    def __getitem__(self, instance: SupportsIndex) -> Instance:
        """Return an instance by its number from 0, from the end if negative. Raises IndexError."""
        number = self._number(instance)
        return Instance(self._core.instance(number), number, self._drawer)

    def __iter__(self) -> Iterator[Instance]:
        return (self[i] for i in range(self._size))

    def set_scene(self, instance: SupportsIndex, scene: Scene | Path) -> None:
        """Give an instance the constants of another scene: stiffnesses, masses, gravity, contact, the time step.

        Its state and inputs stay, and a divergence is forgotten. Raises IndexError; UsageError where particles,
        springs, kinds of terrain or the integrator would become others, which takes a new Batch. Then nothing changes.
        """
        core = self._core.instance(self._number(instance))
        core.set_scene((scene if isinstance(scene, Scene) else load(scene))._core)

    # Steps.

    def step(self, steps: int = 1) -> int:
        """Advance every instance by ``steps``, and return how many have diverged: ``diverged`` names them.

        Those stay at their last good states until ``reset()``, ``set_scene()`` or their ``load()`` and ``update()``.
        Ctrl-C (KeyboardInterrupt) and ``stop()`` (InterruptedRun) leave every instance at the end of a step, but not
        all of the same, since instances are stepped in groups: ``steps`` says which, and some may not have begun.
        """
        return self._core.advance(whole(steps, "a number of steps"))

    def run(
        self, duration: float, *, every: float | None = None, record: str | Sequence[str] = ("center-of-mass",)
    ) -> BatchTrajectory:
        """Advance every instance and record it.

        ``duration``: from where each is [s], ≥ 0; ``every``: the interval of samples [s], the first at once, each at
        the step nearest to its time, the last at the end; None: the start and the end alone. ``record``:
        ``"center-of-mass"`` (n, t, 3) [m], ``"momentum"`` (n, t, 3) [N·s], ``"energy"`` of (n, t) [J],
        ``"actuator-work"`` (n, t) [J], added up over the samples, and of one body ``"cube[0].positions"`` (n, t, p, 3)
        [m], or ``"positions"`` where every instance has a single body. Raises
        UsageError for others, and for a body that has not the same number and as many particles in all instances;
        SceneError where the record is larger than memory. A divergence raises nothing: ``diverged`` of the result says
        which. Ctrl-C and ``stop()`` act as in ``step()``, and the record is lost.
        """
        names = [record] if isinstance(record, str) else list(record)
        positive(duration, "duration [s]", zero=True)
        if every is not None:
            positive(every, "every, the interval of samples [s],")
        body, kinds = self._wanted(names)
        interval = every if every is not None else duration if duration > 0 else 1.0
        center, momentum, energy, actuators = (kind in kinds for kind in _OF_ALL)
        time, centers, momenta, energies, work, positions, diverged, hashes = self._core.run(
            duration, interval, center, momentum, energy, actuators, body
        )
        of: dict[str, Any] = dict(zip(_OF_ALL, (centers, momenta, None, work)), positions=positions)
        if energies is not None:
            of["energy"] = Energy(*(energies[..., part].copy() for part in range(3)))
        series = {name: of[kind] for name, kind in zip(names, kinds)}
        return BatchTrajectory(time, diverged.astype("int64"), hashes, series)

    def stop(self) -> None:
        """Interrupt ``step()`` or ``run()`` in another thread, which raises InterruptedRun. No effect otherwise."""
        self._core.stop()

    def reset(self, mask: ArrayLike | None = None) -> None:
        """Return to step 0 of the scenes. Inputs and constants stay.

        ``mask``: (n,) of bool, which instances; None: all. Raises UsageError for another shape or type.
        """
        import numpy as np

        if mask is None:
            self._core.reset(None)
            return
        given = np.asarray(mask)
        if given.dtype != np.bool_ or given.shape != (self._size,):
            raise UsageError(
                f"the mask is an array of {self._size} bool, one of each instance, not of {given.dtype} with the shape "
                f"{given.shape}"
            )
        self._core.reset(np.ascontiguousarray(given).view(np.uint8))

    # Where they are.

    @property
    def steps(self) -> NDArray[np.int64]:
        """Steps since each one's start, (n,)."""
        return self._core.steps().astype("int64")

    @property
    def time(self) -> NDArray[np.float64]:
        """Steps × h of each, (n,) [s]."""
        return self._core.times()

    @property
    def diverged(self) -> NDArray[np.int64]:
        """The step that failed, (n,); 0: not diverged. ``batch.reset(batch.diverged > 0)`` restarts those."""
        return self._core.diverged().astype("int64")

    @property
    def hash(self) -> list[str]:
        """State hash of each instance, as ``Simulation.hash`` of its scene alone."""
        return self._core.hashes()

    def read(self, field: str) -> NDArray[np.float32]:
        """Return a field of all states, (n, p, 3): those that ``Simulation.read()`` names.

        Raises UsageError for an unknown field, and where instances have different numbers of particles or balls.
        """
        return self._core.gather(field_index(field))

    @property
    def positions(self) -> NDArray[np.float32]:
        """Positions of particles, (n, p, 3) [m]. Raises UsageError where numbers differ: use ``batch[i].positions``."""
        return self.read("positions")

    @property
    def velocities(self) -> NDArray[np.float32]:
        """Velocities of particles, (n, p, 3) [m/s]. Raises UsageError where their number differs."""
        return self.read("velocities")

    @property
    def center_of_mass(self) -> NDArray[np.float64]:
        """Center of mass of all particles of each instance, without balls, (n, 3) [m]."""
        return self._now("center-of-mass")[:, 0]  # type: ignore[no-any-return]

    centre_of_mass = center_of_mass  # until 0.4

    @property
    def momentum(self) -> NDArray[np.float64]:
        """Momentum Σ m v of particles that are not pinned, (n, 3) [N·s]."""
        return self._now("momentum")[:, 0]  # type: ignore[no-any-return]

    @property
    def energy(self) -> Energy:
        """Energies of each instance, arrays (n,) [J]; ``energy.total`` is the sum."""
        return Energy(*(part[:, 0] for part in self._now("energy")))

    # How it computes.

    @property
    def description(self) -> str:
        """Grouping of instances, threads and instruction set, in one line."""
        return self._core.description()

    @property
    def nbytes(self) -> int:
        """Memory in use without the models [bytes]."""
        return self._core.bytes()

    # Parts.

    def __repr__(self) -> str:
        return f"<aspic.Batch of {self._size} instances>"

    def _number(self, instance: SupportsIndex) -> int:
        number = operator.index(instance)
        if not -self._size <= number < self._size:
            raise IndexError(f"instance {number} does not exist: the batch has {self._size}, numbered from 0")
        return number % self._size

    def _now(self, name: str) -> Any:
        return self.run(0.0, record=[name])[name]

    def _wanted(self, names: list[str]) -> tuple[int | None, list[str]]:
        """Return the number of the body whose positions are recorded, and the quantity of each name."""
        found: set[int] = set()
        kinds = []
        for name in names:
            body, _, what = name.rpartition(".")
            kind = plain(what)
            if kind == "positions":
                found.add(self._body(body))
            elif body or kind not in _OF_ALL:
                raise UsageError(
                    f"{name!r} cannot be recorded of a batch; {', '.join(_OF_ALL)} can, and positions of one body"
                )
            kinds.append(kind)
        if len(found) > 1:
            raise UsageError("a batch records positions of one body")
        return (found.pop() if found else None), kinds

    def _body(self, name: str) -> int:
        """Return the number of a body in every instance; no name: the only one."""
        numbers = set()
        for i, bodies in enumerate(self._core.bodies()):
            if not name and len(bodies) != 1:
                raise UsageError(f"instance {i} has {len(bodies)} bodies: record one's, as in 'cube[0].positions'")
            number = body_index(bodies, name, self[i]._core.scene) if name else 0
            if number is None:
                raise UsageError(f"instance {i} has no body {name!r}; it has {', '.join(bodies) or 'none'}")
            numbers.add(number)
        if len(numbers) > 1:
            raise UsageError(f"{name!r} is not the body of the same number in all instances")
        return numbers.pop()
