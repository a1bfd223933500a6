"""Backends and devices of this machine."""

from __future__ import annotations

from typing import NamedTuple

from ._errors import DeviceError
from ._scene import Scene
from ._simulation import Simulation

__all__ = ["Device", "devices"]


class Device(NamedTuple):
    """A backend on this machine."""

    backend: str
    """``"gpu"``, ``"cpu"`` or ``"reference"``, as ``Simulation()`` takes it."""
    name: str
    """The name of the device, from its driver or its solver; empty: it cannot be used."""
    reason: str
    """Why it cannot be used, and what would help; empty where it can."""


def devices() -> list[Device]:
    """Return which backends work here, and why others fail. Creates a simulation on each and an OpenGL context."""
    scene = Scene("schema = 1\n[[cube]]\nparticles-per-edge = 2\n")
    found = []
    for backend in ("gpu", "cpu", "reference"):
        try:
            found.append(Device(backend, Simulation(scene, backend).device, ""))
        except DeviceError as error:
            found.append(Device(backend, "", str(error)))
    return found
