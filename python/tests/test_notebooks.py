"""The notebooks run from top to bottom, show what they say, and are kept without their outputs."""

import json
import os
import pathlib
from typing import Any

import pytest
from conftest import needs_images, root

folder = root / "examples/notebooks"
NOTEBOOKS = ["integrators.ipynb", "parameters.ipynb", "stability.ipynb"]


def run(name: str) -> dict[str, Any]:
    """The names that the notebook's cells leave. A test's figures are drawn, and shown nowhere."""
    if not folder.exists():
        pytest.skip("the notebooks are not here")
    matplotlib: Any = pytest.importorskip("matplotlib")
    pytest.importorskip("matplotlib.pyplot")
    needs_images()
    matplotlib.use("agg")
    cells = json.loads((folder / name).read_text(encoding="utf-8"))["cells"]
    names: dict[str, Any] = {}
    for number, cell in enumerate(cells):
        if cell["cell_type"] != "code":
            continue
        exec(compile("".join(cell["source"]), f"{name}, cell {number}", "exec"), names)
        if matplotlib.pyplot.get_fignums():  # as a notebook shows it below its cell
            matplotlib.pyplot.savefig(f"{number}.png", dpi=int(os.environ.get("ASPIC_FIGURE_DPI", 20)))
            matplotlib.pyplot.close("all")
    return names


def test_integrators() -> None:
    names = run("integrators.ipynb")
    wanted = {
        "explicit-euler": 1,
        "symplectic-euler": 1,
        "midpoint": 2,
        "velocity-verlet": 2,
        "runge-kutta-4": 4,
        "implicit-euler": 1,
    }
    found = {method: round(float(order)) for method, order in names["orders"].items()}
    assert found == wanted
    rough, exact = ({m: work[i] for m, work in names["work"].items()} for i in (0, 2))
    assert min(exact, key=exact.__getitem__) == "runge-kutta-4" != min(rough, key=rough.__getitem__)


def test_stability() -> None:
    agreement = run("stability.ipynb")["agreement"]
    assert min(agreement.values()) > 0.9, agreement


def test_parameters() -> None:
    names = run("parameters.ipynb")
    assert sorted(names["lowest"].values()) == list(names["lowest"].values())  # stiffer ones stay higher
    assert sorted(names["distance"].values(), reverse=True) == list(names["distance"].values())


def test_notebooks_are_kept_without_outputs() -> None:
    if not folder.exists():
        pytest.skip("the notebooks are not here")
    assert sorted(path.name for path in folder.iterdir()) == NOTEBOOKS
    for path in folder.iterdir():
        notebook = json.loads(pathlib.Path(path).read_text(encoding="utf-8"))
        assert notebook["nbformat"] == 4
        for cell in notebook["cells"]:
            assert cell["cell_type"] == "markdown" or (cell["outputs"] == [] and cell["execution_count"] is None)
