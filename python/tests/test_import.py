"""Importing does nothing that a program could notice."""

import subprocess
import sys

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


def report(program: str) -> dict[str, str]:
    out = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True).stdout
    return {line.partition(" ")[0]: line.partition(" ")[2] for line in out.splitlines()}


def test_importing_loads_no_other_package_no_graphics_and_starts_no_thread() -> None:
    # Neither numpy, which takes longer than all the rest: it comes with the first array.
    assert report(REPORT) == {"modules": "aspic nanobind_backend", "graphics": "", "threads": "1"}


def test_stepping_on_the_cpu_loads_no_graphics() -> None:
    out = report(REPORT.replace("import aspic\n", "import aspic\naspic.Simulation('cube-plane', 'cpu').step()\n"))
    assert out["graphics"] == ""


def test_arrays_need_numpy_alone() -> None:
    out = report(REPORT.replace("import aspic\n", "import aspic\naspic.Simulation('cube-plane', 'cpu').positions\n"))
    assert out["modules"] == "aspic nanobind_backend numpy"


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
