"""Soft bodies of point masses and springs, with the same bits on GPU and CPU.

    import aspic

    sim = aspic.Simulation(aspic.load("cube-plane"))
    sim.step(1000)
    print(sim.time, sim.positions.shape, sim.energy.total, sim.hash)

Importing opens no display, makes no OpenGL context and starts no thread. docs/python.md teaches the package; all
numbers are in SI units.
"""

from . import _aspic
from ._batch import Batch, Instance
from ._body import Ball, Body, Skin
from ._devices import Device, devices
from ._errors import (
    CheckError,
    DeviceError,
    DivergedError,
    Error,
    ErrorCode,
    FileError,
    InterruptedRun,
    OverlapWarning,
    SceneError,
    UsageError,
)
from ._inputs import Pull
from ._reading import Measures, Quantities, Springs
from ._scene import BuiltinScene, Parameter, Scene, load, parameters, scenes
from ._simulation import Simulation, resume
from ._state import Difference, QuantityDifference, State, compare
from ._sweep import sweep
from ._table import Table, collect
from ._trajectory import BatchTrajectory, Energy, Trajectory

__version__: str = _aspic.version

__all__ = [
    "Ball",
    "Batch",
    "BatchTrajectory",
    "Body",
    "BuiltinScene",
    "CheckError",
    "Device",
    "DeviceError",
    "Difference",
    "DivergedError",
    "Energy",
    "Error",
    "ErrorCode",
    "FileError",
    "Instance",
    "InterruptedRun",
    "Measures",
    "OverlapWarning",
    "Parameter",
    "Pull",
    "Quantities",
    "QuantityDifference",
    "Scene",
    "SceneError",
    "Simulation",
    "Skin",
    "Springs",
    "State",
    "Table",
    "Trajectory",
    "UsageError",
    "collect",
    "compare",
    "devices",
    "load",
    "parameters",
    "resume",
    "scenes",
    "sweep",
]
