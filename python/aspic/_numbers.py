"""Checks of numbers for the library."""

from __future__ import annotations

import operator
import os
from typing import TYPE_CHECKING, Any

from ._errors import UsageError

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

__all__ = ["floats", "name_of", "pace", "positive", "whole"]

MOST_STEPS = 2**53
MOST_FPS = 1000


def whole(value: Any, what: str, least: int = 0, most: int = MOST_STEPS) -> int:
    """Return a whole number. Raises UsageError for others, also for bool, and outside of the range."""
    try:
        if isinstance(value, bool):
            raise TypeError
        number = operator.index(value)
    except TypeError:
        raise UsageError(f"{what} is a whole number, not {value!r}") from None
    if not least <= number <= most:
        raise UsageError(f"{what} is a whole number from {least} to {most}, not {number}")
    return number


def positive(value: Any, what: str, zero: bool = False, most: float = float("inf")) -> float:
    """Return a finite number above 0, or from 0 on. Raises UsageError."""
    range_ = ("0 or more" if zero else "more than 0") + (f", at most {most:g}" if most < float("inf") else "")
    try:
        number = float(value)
    except (TypeError, ValueError, OverflowError):
        raise UsageError(f"{what} is a number, {range_}, not {value!r}") from None
    if not (0 <= number if zero else 0 < number) or not number < float("inf") or number > most:
        raise UsageError(f"{what} is a finite number, {range_}, not {number}")
    return number


def pace(fps: Any, speed: Any) -> None:
    """Check frames per second and simulated seconds per second shown. Raises UsageError."""
    if fps is not None:
        positive(fps, "fps", most=MOST_FPS)
    positive(speed, "speed")


def floats(numbers: Any, shape: tuple[int, ...], what: str, single: bool = False) -> NDArray[np.float64]:
    """Return finite real numbers of that shape, in single precision too if ``single``.

    Raises UsageError for others, such as None, masked or complex ones.
    """
    import numpy as np

    try:
        given = numbers if isinstance(numbers, np.ndarray) else np.asarray(numbers)
    except ValueError:
        raise UsageError(f"{what} have the shape {shape}; rows of different lengths have none") from None
    if np.ma.is_masked(given):
        raise UsageError(f"{what} have a value for each particle: fill the masked ones first")
    if given.dtype.kind not in "fiu":
        raise UsageError(f"{what} are real numbers, not {given.dtype if given.dtype != object else type(numbers).__name__}")
    if given.shape != shape:
        raise UsageError(f"{what} have the shape {shape}, not {given.shape}")
    with np.errstate(over="ignore"):
        result = np.ascontiguousarray(given, dtype=np.float64)
    bad = np.argwhere(~(np.abs(result) <= np.finfo(np.float32 if single else np.float64).max))
    if len(bad):
        raise UsageError(f"{what} are finite numbers; that at {tuple(bad[0].tolist())} is {result[tuple(bad[0])]}")
    return result



def name_of(path: Any) -> str:
    """Return a path for the library. Raise UsageError if the value is not a path or contains a NUL character."""
    try:
        name = os.fsdecode(path)
    except TypeError:
        raise UsageError(f"a path is a str or an os.PathLike, not {type(path).__name__}") from None
    if not name or "\0" in name:
        raise UsageError(f"{name!r} is no path of a file")
    return name
