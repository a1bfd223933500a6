"""The command of the program that repeats what Python did."""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

from ._errors import SceneError
from ._scene import Scene, load, scenes
from ._toml import assignments

if TYPE_CHECKING:
    from ._simulation import Simulation

__all__ = ["page_command"]


def differences(scene: Scene) -> list[str] | None:
    """Return arguments of --set that turn the built-in scene of this name into this one, or None."""
    if scene.name not in (builtin.name for builtin in scenes()):
        return None
    builtin = load(scene.name)
    try:
        values = {key: scene[key] for key in scene if key not in builtin or builtin[key] != scene[key]}
        found = {key: value for key, value in values.items() if value is not None}
        return assignments(found) if builtin.copy(found) == scene else None
    except SceneError:  # an element that the built-in scene does not have
        return None


def page_command(sim: Simulation, steps: int, words: list[str]) -> str:
    """Return the ``aspic run`` command that writes the page, with ``words`` for the page; empty without one.

    One does for built-in scenes of which some keys were changed, from their start, without pulls and pins of hands.
    """
    changed = differences(sim.scene) if sim.steps == 0 and "fast" not in sim.backend else None
    if changed is None:
        return ""
    start = sim._quiet(sim.scene, "reference", doubles=sim.precision == "double")
    if (start.hash, start.input_log) != (sim.hash, sim.input_log) or start._core.inputs() != sim._core.inputs():
        return ""
    command = ["aspic", "run", sim.scene.name]
    for assignment in changed:
        command += ["--set", assignment]
    if sim.precision == "double":
        command += ["--backend", "reference", "--precision", "double"]
    return shlex.join([*command, "--steps", str(steps), *words])
