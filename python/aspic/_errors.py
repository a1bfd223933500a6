"""Errors of the library as exceptions."""

from __future__ import annotations

import enum
import re
from typing import TYPE_CHECKING, NoReturn

if TYPE_CHECKING:
    from ._trajectory import Trajectory

__all__ = [
    "CheckError",
    "ConvergenceWarning",
    "DeviceError",
    "DivergedError",
    "Error",
    "ErrorCode",
    "FileError",
    "InterruptedRun",
    "OverlapWarning",
    "RunWarning",
    "SceneError",
    "StepWarning",
    "UsageError",
]


class ErrorCode(enum.IntEnum):
    """Why a call failed. The values are the exit codes of the program ``aspic``."""

    CHECK_FAILED = 1
    USAGE = 2
    SCENE_REJECTED = 3
    NO_DEVICE = 4
    DIVERGED = 5
    IO = 6
    INTERRUPTED = 130


class Error(Exception):
    """An error of Aspic: sentences that say what is wrong, where, and how to fix it."""

    code: ErrorCode
    """Why, and what a program may end with."""


class UsageError(Error, ValueError):
    """An argument is wrong: an unknown word, sizes that differ, a particle that does not exist."""

    code = ErrorCode.USAGE


class SceneError(Error, ValueError):
    """The scene is wrong (an unknown key, a value out of range), or larger than memory."""

    code = ErrorCode.SCENE_REJECTED


class DeviceError(Error, RuntimeError):
    """No usable OpenGL device, a lost one, or a call from another thread than the one that made the solver."""

    code = ErrorCode.NO_DEVICE


class DivergedError(Error, ArithmeticError):
    """A number is not finite, or a particle is faster than 1000 m/s. The state is the last good one."""

    code = ErrorCode.DIVERGED
    step: int
    """The step that failed."""
    index: int
    """Position of the first particle or ball that failed."""
    ball: bool
    """Whether it is a ball."""
    trajectory: Trajectory | None = None
    """The recording of ``Simulation.run()`` until then."""


class FileError(Error, OSError):
    """A file cannot be read or written."""

    code = ErrorCode.IO


class CheckError(Error, AssertionError):
    """A comparison failed."""

    code = ErrorCode.CHECK_FAILED


class InterruptedRun(Error, RuntimeError):
    """The library was asked to end. Ctrl-C raises ``KeyboardInterrupt`` instead."""

    code = ErrorCode.INTERRUPTED
    trajectory: Trajectory | None = None
    """The recording of ``Simulation.run()`` until then."""


class ConvergenceWarning(UserWarning):
    """Steps of implicit Euler ended before the solve had converged: the first ones of a simulation."""


class RunWarning(UserWarning):
    """A scene or run has a defect: bodies within terrain, flat cells, unexplained energy, and others."""


class OverlapWarning(RunWarning):
    """Bodies are within each other: at the start of a simulation, or too deep for contact to separate them."""


_classes: dict[int, type[Error]] = {
    int(kind.code): kind
    for kind in (UsageError, SceneError, DeviceError, DivergedError, FileError, CheckError, InterruptedRun)
}


class StepWarning(UserWarning):
    """The time step is above the estimate of the largest stable one, or may be."""


class Unshared:
    """Base of objects with a solver or a batch of their own: they cannot be copied or pickled."""

    def __reduce_ex__(self, protocol: object) -> NoReturn:
        raise TypeError(
            f"{type(self).__name__} objects cannot be copied or pickled: make another one of the same scene, and "
            "load() there the State that save() returns here"
        )


def error_of(code: int, message: str) -> Error:
    """Return the exception of an error code; the extension module raises it."""
    # Where a key was set, the program names its option; here there is none.
    return _classes[code](re.sub(r"^--(set|view) ", "", message, flags=re.MULTILINE))


def diverged(found: tuple[int, int, bool, str]) -> DivergedError:
    """Return the exception of a divergence reported by the extension module."""
    step, index, ball, text = found
    error = DivergedError(
        f"the simulation diverged at step {step}: {text}. Its state is that of step {step - 1}. "
        "A smaller simulation.timestep helps; Scene.stable_timestep() estimates the largest."
    )
    error.step, error.index, error.ball = step, index, ball
    return error
