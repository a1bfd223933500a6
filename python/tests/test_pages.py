"""The blocks of Python in the documentation run from top to bottom, and so do the examples."""

import importlib.util
import os
import pathlib
import re
import subprocess
import sys
from collections.abc import Callable
from typing import Any

import aspic
import pytest
from conftest import needs_images, root

# What is optional; test_sweep_engines.py has the tests of the first two.
ENGINES = ("dask", "submitit", "gymnasium")


def blocks(page: str) -> list[tuple[int, str]]:
    """Line and text of every block of Python."""
    path = root / page
    if not path.exists():
        pytest.skip(f"{page} is not here")
    text = path.read_text(encoding="utf-8")
    found = [(text[: m.start(1)].count("\n"), m[1]) for m in re.finditer(r"^```python\n(.*?)^```$", text, re.M | re.S)]
    assert found
    return found


PAGES = ["docs/python.md", "docs/sweeps.md", "docs/tutorial-python.md", "python/README.md", "README.md"]


def test_no_page_with_python_is_forgotten() -> None:
    if not (root / "docs").exists():
        pytest.skip("the pages are not here")
    pages = [root / "README.md", *(root / "docs").glob("*.md")]
    found = [page for page in pages if page.exists() and "\n```python\n" in page.read_text(encoding="utf-8")]
    assert {str(page.relative_to(root)) for page in found} <= set(PAGES)


@pytest.mark.parametrize("page", PAGES)
def test_every_block_of_a_page_runs(page: str) -> None:
    needs_images()
    names: dict[str, object] = {"__name__": "__main__"}
    for line, block in blocks(page):
        wanted = [engine for engine in ENGINES if re.search(rf"(import|from) {engine}\b", block)]
        if not all(importlib.util.find_spec(engine) for engine in wanted):
            continue
        exec(compile("\n" * line + block, str(root / page), "exec"), names)


def test_the_readme_prints_the_hash_of_the_program_on_every_backend(
    capsys: pytest.CaptureFixture[str], program: Callable[..., dict[str, Any]]
) -> None:
    text = re.sub(r"^image = .*$", "", "".join(block for _, block in blocks("README.md")), flags=re.M)
    for backend in ("reference", "cpu", "gpu"):
        if backend == "gpu":
            needs_images()
        names: dict[str, Any] = {}
        exec(text.replace("aspic.Simulation(scene)", f"aspic.Simulation(scene, {backend!r})"), names)
        walked, last = capsys.readouterr().out.splitlines()
        assert f"# {walked}" in text
        if backend == "reference":
            names["scene"].save("walker.toml")
            names["robot"].save_inputs("gait.toml")
            words = ["walker.toml", "--replay", "gait.toml", "--steps", "4000", "--backend", "cpu"]
            wanted = program("run", *words)["state_hash"]
        assert last.split()[-1] == wanted


EXAMPLES = {
    "integrators.py": (
        ["--seconds", "0.05", "--particles", "3"],
        r"explicit-euler +[-\d.e]+ .*\n(.*\n)+implicit-euler",
    ),
    "stiffness.py": (["--particles", "3", "--stiffness", "1000", "4000"], r"k = +4000 N/m: down to \d"),
    "dask_sweep.py": (
        ["--runs", "2", "--seconds", "0.1", "--out", "runs"],
        r"4 of 4 runs\nfarthest: \d.\d+ m .*\nhash [0-9a-f]{16}",
    ),
    "crawl.py": (
        ["--generations", "2", "--pairs", "4", "--seconds", "0.2"],
        r"weights 892ca1a7e9ca56a5\ncrawled -0.012 m in 0.2 s, hash 22ca02d0539aa422\n",
    ),
    "evolve.py": (
        ["--robots", "12", "--generations", "3", "--seconds", "0.4", "--shape", "3", "2", "2"],
        r"generation 3: the best 0.019 m.*\nthe winner crawls 0.019 m in 0.4 s, hash bec3cd9c26e3d91e\n"
        r"with half the time step 0.018 m\n",
    ),
    "population.py": (
        ["--cubes", "20", "--particles", "3", "--seconds", "1"],
        r"20 instances, 20 of them in 2 stacks.*\n(cube \d+: up to \d.*\n){5}\d of 20 diverged\n",
    ),
    "throw.py": ([], r"cpu ([0-9a-f]{16}), replayed on reference \1\n"),
}


@pytest.mark.parametrize("name", EXAMPLES)
def test_examples_run(name: str) -> None:
    path = root / "examples/python" / name
    if not path.exists():
        pytest.skip("the examples are not here")
    if name.startswith("dask"):
        pytest.importorskip("distributed")
    if name.startswith("crawl"):
        pytest.importorskip("gymnasium")
    words, says = EXAMPLES[name]
    # A process that spawn starts finds the package as this one did.
    here = os.pathsep.join([str(pathlib.Path(aspic.__file__).parents[1]), os.environ.get("PYTHONPATH", "")])
    done = subprocess.run(
        [sys.executable, path, *words], capture_output=True, text=True, env={**os.environ, "PYTHONPATH": here}
    )
    assert done.returncode == 0, done.stderr
    assert re.search(says, done.stdout), done.stdout


def test_no_example_is_forgotten() -> None:
    folder = root / "examples/python"
    if folder.exists():
        assert {path.name for path in folder.glob("*.py")} == set(EXAMPLES)
        page = (root / "docs/python.md").read_text(encoding="utf-8")
        assert all(f"examples/python/{name}" in page for name in EXAMPLES)
