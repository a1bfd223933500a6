"""Simulations: a scene in motion."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, Union

from . import _aspic
from ._command import page_command
from ._errors import (
    ConvergenceWarning,
    DivergedError,
    InterruptedRun,
    OverlapWarning,
    RunWarning,
    SceneError,
    StepWarning,
    UsageError,
    diverged,
)
from ._exports import OF_LIBRARY, ending_of
from ._inputs import Replayable
from ._numbers import floats, name_of, pace, positive, whole
from ._scene import Scene, changes, load
from ._state import State, field_index
from ._toml import assignments
from ._trajectory import Diagnostic, Recorder, Trajectory, json_of

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from ._image import Image

__all__ = ["Advance", "Simulation", "SolveStatistics", "resume"]

Path = Union[str, "os.PathLike[str]"]


# Result of steps from the extension module: the number made, the divergence, and whether stop() ended them.
Made = tuple[int, Union[tuple[int, int, bool, str], None], bool]


class Advance(NamedTuple):
    """How far ``Simulation.advance()`` came, and what ended it. If neither did, all steps were made."""

    steps: int
    """Made in this call."""
    divergence: DivergedError | None = None
    """The exception that ended the steps; it is not raised."""
    stopped: bool = False
    """Whether ``Simulation.stop()`` ended them."""


class SolveStatistics(NamedTuple):
    """Solves of implicit Euler since the state was loaded."""

    steps: int
    """All of them; each of the next three counts those with one end."""
    converged: int
    stagnated: int
    """Their residual no longer became smaller."""
    not_converged: int
    """They ended at the limit of iterations."""
    newton_iterations: int
    cg_iterations: int
    worst_residual: float
    """[m/s]."""


class Simulation(Replayable):
    """A scene, the solver that steps it, and the inputs so far.

    Every number is in SI units; arrays are fresh copies, (n, 3), float32, or float64 in double precision. All backends
    give the same bits in single precision. Steps run without the GIL; Ctrl-C and other signals end them between two
    steps, so that the state is that of a whole step. Several threads may use one simulation: they take turns. One on
    the backend gpu may be used by the thread that made it alone (DeviceError).
    """

    def __init__(
        self,
        scene: Scene | Path,
        backend: str = "auto",
        *,
        precision: Literal["single", "double", None] = None,
        threads: int = 0,
    ):
        """Make the solver at the scene's start; later changes of ``scene`` do not affect it.

        A RunWarning names problems at the start, an OverlapWarning overlapping bodies. During the run an
        OverlapWarning names each pair of bodies that is too deep for contact to separate, once, at most ten times per
        simulated second.

        ``scene``: one, or what ``aspic.load()`` takes; ``backend``: ``"auto"`` (a hardware GPU, else ``cpu``),
        ``"gpu"``, ``"cpu"``, ``"reference"``, with options after colons (``"gpu:gather"``, ``"gpu:fast"``);
        ``precision``: only ``reference`` has ``"double"``; ``threads``: of ``cpu``, 1 … 1024, 0: as many as are
        worthwhile. Raises UsageError for words and options that are none; SceneError where the model is larger than
        memory or the device; DeviceError without a usable device, which says what is missing.
        """
        if not isinstance(scene, Scene):
            scene = load(scene)
        if not isinstance(backend, str):
            raise UsageError(f"a backend is a word such as 'cpu' or 'gpu', not {backend!r}")
        if precision not in (None, "single", "double"):
            raise UsageError(f"a precision is 'single' or 'double', not {precision!r}")
        threads = whole(threads, "a number of threads (0: as many as are worthwhile)", most=1024)
        doubles = None if precision is None else precision == "double"
        self._core = _aspic.Simulation(scene._core, backend, doubles, threads)
        self._warn()

    @classmethod
    def _quiet(cls, scene: Scene, backend: str, doubles: bool | None = None, threads: int = 0) -> Simulation:
        """Return a simulation for the package's own use, without warnings."""
        simulation = cls.__new__(cls)
        simulation._core = _aspic.Simulation(scene._core, backend, doubles, threads)
        simulation._core.new_warnings()
        return simulation

    # What computes.

    @property
    def backend(self) -> str:
        """The backend with its options: ``"gpu:gather"``, ``"cpu"``, ``"reference:double"``."""
        return self._core.variant

    @property
    def device(self) -> str:
        """The name of the device, from its driver or its solver."""
        return self._core.device

    @property
    def reason(self) -> str:
        """Reason for which ``"auto"`` selected this backend; empty if it was named."""
        return self._core.reason

    def peek(self, field: str) -> Any:
        """Return a field of the state in the solver's memory, without a copy: a read-only array (n, 3), with strides.

        While such an array exists, what would change the state raises BufferError. Raises UsageError on the backend
        gpu, whose state is on the device.
        """
        shown = self._core.view(field_index(field))
        if shown is None:
            raise UsageError(f"the state of the backend {self.backend} is on the device: use read(), which copies it")
        return shown

    # Steps.

    def step(self, steps: int = 1) -> None:
        """Advance by ``steps`` time steps.

        Raises DivergedError where a number is no longer finite or a particle is faster than 1000 m/s: the state is the
        last good one, and further steps raise it again until ``load()``. KeyboardInterrupt (Ctrl-C) and ``stop()``
        (InterruptedRun) leave the state of a whole step.
        """
        made = self._core.advance(whole(steps, "a number of steps"))
        self._warn()
        _raise(made)

    def advance(self, steps: int = 1) -> Advance:
        """Advance by ``steps`` time steps, and return how many were made and what ended them.

        As ``step()``, but a divergence and ``stop()`` raise nothing.
        """
        count, found, stopped = self._core.advance(whole(steps, "a number of steps"))
        self._warn()
        return Advance(count, diverged(found) if found else None, stopped)

    def stop(self) -> None:
        """End a call that steps in another thread, after the step it is in. No effect otherwise.

        ``advance()`` returns; ``step()``, ``run()``, ``export()``, ``video()`` and ``page()`` raise InterruptedRun.
        """
        self._core.stop()

    @property
    def solves(self) -> SolveStatistics | None:
        """Statistics of implicit Euler's solves since the state was loaded; None with other integrators."""
        row = self._core.solves()
        return None if row is None else SolveStatistics(*row)

    @property
    def warnings(self) -> list[Diagnostic]:
        """All warnings so far, of the scene and the run."""
        return [Diagnostic(*row) for row in self._core.warnings()]

    def run(
        self,
        duration: float | None = None,
        *,
        steps: int | None = None,
        every: float | None = None,
        record: Sequence[str] = ("energy",),
        controls: ArrayLike | None = None,
    ) -> Trajectory:
        """Advance and record.

        ``duration`` [s] or ``steps``: how far from here; neither: to the end of the scene's duration. ``every``: the
        interval of samples [s], the first at once, each at the step nearest to its time; None: the start and the end
        alone. ``record``: ``"energy"``, ``"momentum"``, ``"center-of-mass"``, ``"positions"``, ``"velocities"``,
        ``"max-speed"``, ``"min-height"``, ``"hash"``, ``"actuator-work"`` [J], added up over the samples, and of a body
        ``"cube[0].positions"``, ``"….velocities"``, ``"….center-of-mass"``, ``"….momentum"``. Also ``"speed"``,
        ``"force"``, ``"contact-force"``, ``"contact"``,
        ``"mean-strain"`` of particles, ``"strain"`` and ``"tension"`` of springs, ``"ball-positions"``,
        ``"ball-velocities"``, ``"ball-angular-velocities"``; ``"motion"`` is all that exports hold. ``controls``: the
        ``inputs`` by step, (steps, inputs), in their order; the run has one step per row. Raises UsageError for
        others; DivergedError as ``step()``, with what was recorded as ``trajectory``.
        """
        if every is not None:
            positive(every, "every, the interval of samples [s],")
        recorder = Recorder(self, record)
        if controls is None:
            made = self._sample(self._steps_of(duration, steps), every, recorder.take)
        else:
            rows = self._controls(controls)
            if duration is not None or steps not in (None, len(rows)):
                raise UsageError(f"controls have {len(rows)} rows, so the run takes {len(rows)} steps: omit the rest")
            made = self._sample(len(rows), every, recorder.take, rows)
        self._warn()
        try:
            _raise(made)
        except (DivergedError, InterruptedRun) as error:
            error.trajectory = recorder.trajectory()
            raise
        return recorder.trajectory()

    def export(
        self,
        path: Path,
        duration: float | None = None,
        *,
        steps: int | None = None,
        every: float = 0.02,
        overwrite: bool = False,
    ) -> None:
        """Advance and write the motion for other programs (docs/exports.md).

        ``path``: .pvd (ParaView), .pc2 (Blender) or .npz (numpy), which take no memory for it, .zarr, or .usd, .usda,
        .usdc by the package usd-core; ``duration``, ``steps``, ``every``: as ``run()``. Ctrl-C and a divergence leave
        complete files so far. Raises UsageError, also for other endings; FileError or FileExistsError where a file
        exists, unless ``overwrite``; DivergedError as ``step()``.
        """
        count = self._steps_of(duration, steps)
        positive(every, "every, the interval of samples [s],")
        ending = ending_of(path)
        name = name_of(path)
        if ending in OF_LIBRARY:
            writer = _aspic.Export(self._core.scene, name, overwrite)
            try:
                made = self._sample(count, every, lambda: writer.add(self._core))
            finally:
                writer.finish(json_of(self.warnings))
        else:
            if os.path.lexists(name) and not overwrite:
                raise FileExistsError(f"{name!r} exists and was not changed: pass overwrite=True")
            recorder = Recorder(self, ["motion"])
            try:
                made = self._sample(count, every, recorder.take)
            finally:
                recorder.trajectory().export(path, overwrite)
        self._warn()
        _raise(made)

    def _controls(self, controls: ArrayLike) -> list[list[float]]:
        import numpy as np

        shape = np.shape(controls)
        if len(shape) != 2 or shape[1] != len(self.inputs):
            raise UsageError(f"controls are (steps, {len(self.inputs)}), of {', '.join(self.inputs)}, not {shape}")
        return floats(controls, shape, "controls").tolist()  # type: ignore[no-any-return]

    def _advance(self, steps: int, controls: Sequence[Sequence[float]]) -> Made:
        """Make a step for each row of inputs."""
        for count, row in enumerate(controls[:steps]):
            self.channels = row
            made, found, stopped = self._core.advance(1)
            if found or stopped:
                return count + made, found, stopped
        return steps, None, False

    def _sample(
        self,
        count: int,
        every: float | None,
        take: Callable[[], None],
        controls: Sequence[Sequence[float]] | None = None,
    ) -> Made:
        """Advance by ``steps`` with samples, the first at once. Steps of other threads in between do not count."""
        take()
        # In steps: the k-th sample is where it would be without the others.
        h = self.timestep
        k = done = 0
        while done < count:
            k += 1
            wanted = count if every is None else round(k * max(every, h) / h)
            more = min(wanted, count) - done
            made, found, stopped = (
                self._core.advance(more) if controls is None else self._advance(more, controls[done:])
            )
            done += made
            if found or stopped:
                return done, found, stopped
            if wanted <= count:
                take()
        return done, None, False

    def compare(self, other: Simulation, steps: int) -> int | None:
        """Advance both, and return the first step whose states differ in any bit; None if none does.

        Both stop at that step, or where they diverge alike. Raises UsageError where they have other numbers of
        particles or balls. ``aspic.compare()`` compares two states as they are.
        """
        if not isinstance(other, Simulation) or other is self:
            raise UsageError("a simulation is compared with another Simulation")
        return self._core.compare(other._core, whole(steps, "a number of steps"))

    def update(self, values: Mapping[str, Any]) -> None:
        """Change constants during the run: stiffnesses, masses, gravity, contact, the time step.

        ``values``: keys and values as ``Scene.update()`` takes them. State, time and inputs stay: with another time step
        the steps so far have other numbers. Another frequency keeps the present phase, which changes the scene's
        ``phase``. Raises SceneError for what a scene refuses; UsageError for keys of the start, and where particles,
        springs, kinds of terrain or the integrator would become others, which takes a new Simulation. Then nothing
        changes.
        """
        self._core.update(changes(values))

    # States and files.

    def save(self, path: Path | None = None, overwrite: bool = False) -> State:
        """Return a copy of the state with the inputs so far, for ``load()``.

        ``path``: also writes a file: ``.csv`` or ``.vtp``, the state as a table or for ParaView; other endings, a
        checkpoint with the scene, for ``aspic.resume()`` and ``aspic run --resume``. Raises FileError, also where the
        file exists, unless ``overwrite``.
        """
        if path is not None:
            name = name_of(path)
            if name.endswith((".csv", ".vtp")):
                self._core.write_state(name, overwrite)
            else:
                self._core.write_checkpoint(name, overwrite)
        return State(self._core.state(), self._core.log())

    def load(self, state: State) -> None:
        """Load a state of the same model, with its inputs, and clear a divergence. Raises UsageError."""
        if not isinstance(state, State):
            raise UsageError(f"load() takes a State, as save() returns, not {type(state).__name__}")
        self._core.load(state._core, state._log)

    # Images.

    def render(
        self, width: int = 960, height: int = 540, view: Mapping[str, Any] | None = None, *, text: bool = True
    ) -> Image:
        """Return an image of the state, (height, width, 3) of uint8, which notebooks show.

        ``view``: keys of the scene's table ``view``, for this image alone: ``{"color": "strain"}``,
        ``{"camera.position": [8, 4, 8]}``; ``text``: parameters, time and scales are written on it. The first one makes
        an OpenGL context; a software rasterizer is enough. Raises SceneError for a wrong key or a size that cannot be
        drawn, DeviceError without a device.
        """
        from ._image import Image

        _check_size(width, height)
        pixels: Any = self._core.image(assignments(view), width, height, text)
        return pixels.view(Image)  # type: ignore[no-any-return]

    def video(
        self,
        path: Path,
        duration: float | None = None,
        *,
        steps: int | None = None,
        fps: float | None = None,
        speed: float = 1.0,
        width: int = 1280,
        height: int = 720,
        text: bool = True,
        overwrite: bool = False,
    ) -> None:
        """Run and record a video.

        ``path``: a video with the ending of its format (``.mp4``, ``.webm``, …; needs the program ffmpeg), or a
        directory of PNG files without one; ``duration``, ``steps``: as ``run()``; ``fps``: frames per second shown,
        None: what the format has; ``speed``: simulated seconds per second shown. Ctrl-C and a divergence leave a
        complete video so far. Raises UsageError, FileError, DeviceError, and DivergedError as ``step()``.
        """
        count = self._steps_of(duration, steps)
        pace(fps, speed)
        _check_size(width, height)
        found = self._core.video(name_of(path), count, fps, speed, width, height, text, overwrite)
        self._warn()
        if found:
            raise diverged(found)

    film = video  # until 0.4

    def page(
        self,
        path: Path,
        duration: float | None = None,
        *,
        steps: int | None = None,
        fps: float = 60.0,
        speed: float = 1.0,
        live: bool = False,
        overwrite: bool = False,
    ) -> None:
        """Advance and write the run as one HTML file that browsers show without a network (docs/page.md).

        ``duration``, ``steps``: as ``run()``; ``fps``, ``speed``: as ``video()``; ``live``: the page holds no frames,
        but simulates the run in the browser and compares the bits. Where ``aspic run`` of a built-in scene would write
        it too, the page has that command to copy. Ctrl-C and a divergence leave a complete page so
        far. Raises UsageError, also for a live page of a run in double precision or with inputs; FileError, also where
        a file exists, unless ``overwrite``; DivergedError as ``step()``.
        """
        count = self._steps_of(duration, steps)
        pace(fps, speed)
        words = ["--html-live" if live else "--html", name_of(path)]
        for word, value, usual in (("--fps", fps, 60.0), ("--speed", speed, 1.0)):
            words += [] if value == usual else [word, repr(value)]
        command = page_command(self, count, words)
        found = self._core.page(name_of(path), count, fps, speed, live, overwrite, command)
        self._warn()
        if found:
            raise diverged(found)

    def view(self) -> Any:
        """Open the window with this simulation's scene at its start, as ``Scene.view()``; the state stays here."""
        return self.scene.view()

    # Parts.

    def _warn(self) -> None:
        for kind, _, _, text in self._core.new_warnings():
            warnings.warn(text, _WARNINGS.get(kind, RunWarning), stacklevel=3)

    def _ipython_key_completions_(self) -> list[str]:
        return [*self.bodies, *(ball.name for ball in self.balls)]

    def __repr__(self) -> str:
        return f"<aspic.Simulation of {self._core.scene.name!r} on {self.backend}: step {self.steps}, {self.time:g} s>"

    def _steps_of(self, duration: float | None, steps: int | None) -> int:
        if duration is not None and steps is not None:
            raise UsageError("a run is as long as either duration or steps say, not both")
        if steps is not None:
            return whole(steps, "a number of steps")
        if duration is None:
            return max(round((self._core.scene.duration - self.time) / self.timestep), 0)
        return whole(round(positive(duration, "duration [s]", zero=True) / self.timestep), "a number of steps")


_WARNINGS = {
    "overlap": OverlapWarning,
    "deep-overlap": OverlapWarning,
    "solve": ConvergenceWarning,
    "step": StepWarning,
}


def _raise(made: Made) -> None:
    """Raise the exception or divergence that ended steps early, if any."""
    _, found, stopped = made
    if found:
        raise diverged(found)
    if stopped:
        raise InterruptedRun("stop() ended the call; the state is that of a whole step")


def _check_size(width: int, height: int) -> None:
    for value, what in ((width, "the width of an image"), (height, "the height of an image")):
        whole(value, what, least=1, most=2**31 - 1)


def resume(path: Path, backend: str = "auto", *, threads: int = 0) -> Simulation:
    """Return a simulation that continues a checkpoint, of ``Simulation.save()`` or ``aspic run``, to the bit.

    Scene, state, precision and inputs are the file's. Raises FileError, SceneError, and what ``Simulation()`` raises.
    """
    scene, state, inputs = _aspic.read_checkpoint(name_of(path))
    simulation = Simulation(Scene._of(scene), backend, precision="double" if state.doubles else None, threads=threads)
    if simulation.precision != ("double" if state.doubles else "single"):
        raise SceneError(f"{path} was written in another precision than {simulation.backend} has")
    core = simulation._core
    core.load(state, core.parse_log(inputs, name_of(path)) if inputs else None)
    return simulation
