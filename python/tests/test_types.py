"""The package is typed: its own code, and the stub of the extension module."""

import ast
import os
import pathlib
import subprocess
import sys

import aspic
import pytest

pytest.importorskip("mypy")
package = pathlib.Path(aspic.__file__).parent


def mypy(folder: pathlib.Path, *words: str) -> str:
    """What it complains about, from a folder that has no modules: those of the current one would hide others."""
    environment = dict(os.environ)
    if package.parent.name != "site-packages":
        environment["MYPYPATH"] = str(package.parent)
    done = subprocess.run([sys.executable, "-m", *words], capture_output=True, text=True, cwd=folder, env=environment)
    return "" if done.returncode == 0 else done.stdout + done.stderr


def test_the_package_and_a_program_that_uses_it_are_typed(tmp_path: pathlib.Path) -> None:
    assert (package / "py.typed").exists() and (package / "_aspic.pyi").exists()
    program = tmp_path / "program.py"
    program.write_text(
        "import aspic\n"
        'sim = aspic.Simulation(aspic.load("cube-plane"), "cpu", precision="single")\n'
        "reveal_type(sim.positions)\nreveal_type(sim.step(3))\nreveal_type(sim.energy.total)\n"
        'batch = aspic.Batch([sim.scene, "cube-plane"], threads=1)\n'
        "reveal_type(batch[0].positions)\nreveal_type(batch.step(3) + 1)\nreveal_type(batch.run(0.1).time)\n"
        "batch.reset(batch.diverged > 0)\n"
        'table = aspic.sweep(sim.scene, {"k": [1.0]}, {"end": lambda run: run.time[-1]}, steps=1)\n'
        'reveal_type(table["end"])\naspic.sweep(sim.scene, 3)  # type: ignore[arg-type]\n'
        'sim.step("3")  # type: ignore[arg-type]\n'
        "sim.stepp()  # type: ignore[attr-defined]\n"
    )
    # Unused ignores are errors: both mistakes are found.
    strict = ("mypy", "--strict", "--cache-dir", str(package.parent / ".mypy_cache"))
    assert mypy(tmp_path, *strict, "-p", "aspic") == ""
    assert mypy(tmp_path, *strict, str(program)) == ""


def names(body: list[ast.stmt]) -> set[str]:
    """What a part of a stub defines for users."""
    found: set[str] = set()
    for statement in body:
        if isinstance(statement, (ast.FunctionDef, ast.ClassDef)):
            found.add(statement.name)
        elif isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name):
            found.add(statement.target.id)
    return {name for name in found if not name.startswith("_")}


def test_the_stub_has_what_the_extension_module_has() -> None:
    """mypy's stubtest takes functions of nanobind for something else."""
    stub = ast.parse((package / "_aspic.pyi").read_text(encoding="utf-8"))
    module = sys.modules["aspic._aspic"]
    assert names(stub.body) == {name for name in dir(module) if not name.startswith("_")}
    classes = [part for part in stub.body if isinstance(part, ast.ClassDef)]
    present = {"ActuatorWork", "Batch", "Export", "InputLog", "Instance", "RunFigures", "RunFolder", "Scene", "Simulation", "State", "SweepRun"}
    assert {part.name for part in classes} == present
    for part in classes:
        members = {name for name in vars(getattr(module, part.name)) if not name.startswith("_")}
        assert names(part.body) == members, part.name
    for node in ast.walk(stub):
        if isinstance(node, ast.FunctionDef):
            assert node.returns is not None, node.name
            assert node.name.startswith("__") or ast.get_docstring(node) or setter(node) or overload(node), node.name


def setter(node: ast.FunctionDef) -> bool:
    return any(isinstance(d, ast.Attribute) and d.attr == "setter" for d in node.decorator_list)


def overload(node: ast.FunctionDef) -> bool:
    return any(isinstance(d, ast.Name) and d.id == "overload" for d in node.decorator_list)
