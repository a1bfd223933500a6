"""Soft bodies of point masses and springs, with the same bits on GPU and CPU::

    import aspic

    sim = aspic.Simulation(aspic.load("cube-plane"))
    sim.step(1000)
    print(sim.time, sim.positions.shape, sim.energy.total, sim.hash)

Importing opens no display, makes no OpenGL context and starts no thread. docs/python.md teaches the package; all
numbers are in SI units.
"""

import atexit

from . import _interpreter  # first: it refuses sub-interpreters
from . import _aspic
from ._batch import Batch, Instance
from ._body import Ball, Body, Skin
from ._devices import Device, devices
from ._errors import (
    CheckError,
    ConvergenceWarning,
    DeviceError,
    DivergedError,
    Error,
    ErrorCode,
    FileError,
    InterruptedRun,
    OverlapWarning,
    RunWarning,
    SceneError,
    StepWarning,
    UsageError,
)
from ._inputs import Pull
from ._reading import Measures, Quantities, Springs
from ._scene import BuiltinScene, Parameter, Scene, load, parameters, scenes
from ._simulation import Advance, Simulation, SolveStatistics, resume
from ._state import Difference, QuantityDifference, State, compare
from ._sweep import sweep
from ._table import Table, collect
from ._trajectory import BatchTrajectory, Diagnostic, Energy, Trajectory

__version__: str = _aspic.version

# Threads in a call of the library would be ended within it.
atexit.register(_aspic.end)

__all__ = [
    "Advance",
    "Ball",
    "Batch",
    "BatchTrajectory",
    "Body",
    "BuiltinScene",
    "CheckError",
    "ConvergenceWarning",
    "Device",
    "DeviceError",
    "Diagnostic",
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
    "RunWarning",
    "Scene",
    "SceneError",
    "Simulation",
    "Skin",
    "SolveStatistics",
    "Springs",
    "State",
    "StepWarning",
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
