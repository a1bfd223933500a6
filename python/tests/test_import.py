"""Importing does nothing that a program could notice."""

import subprocess
import sys
from pathlib import Path

import pytest

import aspic

REPORT = """
import sys
before = set(sys.modules)
import aspic
foreign = {name.partition(".")[0] for name in set(sys.modules) - before} - set(sys.stdlib_module_names)
print("modules", *sorted(foreign))
libraries = {line.split()[-1].rsplit("/", 1)[-1] for line in open("/proc/self/maps") if ".so" in line}
print("graphics", *sorted(name for name in libraries if name.startswith(("libEGL", "libGL", "libX11", "libgallium"))))
import os
print("threads", len(os.listdir("/proc/self/task")))
"""


# A wheel's module is for the stable ABI, with nanobind's run time outside of it; a distribution's has it inside.
RUN_TIME = " nanobind_backend" if ".abi3." in str(sys.modules["aspic._aspic"].__file__) else ""


def report(program: str) -> dict[str, str]:
    out = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    return {line.partition(" ")[0]: line.partition(" ")[2] for line in out.splitlines()}


def test_importing_loads_no_other_package_no_graphics_and_starts_no_thread() -> None:
    # Neither numpy, which takes longer than all the rest: it comes with the first array.
    assert report(REPORT) == {"modules": "aspic" + RUN_TIME, "graphics": "", "threads": "1"}


def test_importing_takes_under_a_tenth_of_a_second(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PYTHONDONTWRITEBYTECODE", raising=False)
    monkeypatch.setenv("PYTHONPYCACHEPREFIX", str(tmp_path))  # the first import compiles the module's files
    program = "import time; before = time.process_time(); import aspic; print('took', time.process_time() - before)"
    # Other work on the machine makes it longer, never shorter.
    assert any(float(report(program)["took"]) < 0.1 for _ in range(20))


def test_stepping_on_the_cpu_loads_no_graphics() -> None:
    out = report(REPORT.replace("import aspic\n", "import aspic\naspic.Simulation('cube-plane', 'cpu').step()\n"))
    assert out["graphics"] == ""


def test_arrays_need_numpy_alone() -> None:
    out = report(REPORT.replace("import aspic\n", "import aspic\naspic.Simulation('cube-plane', 'cpu').positions\n"))
    # Those of Cython are numpy's own, before numpy 2.
    modules = [name for name in out["modules"].split() if not name.startswith(("_cython", "cython_runtime"))]
    assert modules == f"aspic{RUN_TIME} numpy".split()


def test_the_version_is_that_of_the_library() -> None:
    assert aspic.__version__.count(".") == 2


def test_every_public_name_has_a_docstring() -> None:
    for name in aspic.__all__:
        thing = getattr(aspic, name)
        assert thing.__doc__, name
        if isinstance(thing, type):
            for key in (k for k in dir(thing) if not k.startswith("_")):
                member = getattr(thing, key)
                if callable(member) or isinstance(member, property):
                    assert member.__doc__, f"{name}.{key}"
