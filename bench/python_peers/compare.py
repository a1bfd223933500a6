"""The same cube in Aspic, Newton and MuJoCo from Python, on one thread of the CPU, in turn: a table for docs/python.md.

scripts/python_peers.sh [--repeats 5] [--seconds 2]

A simulator is a program of this folder, run in a fresh process each time. Measured are the seconds from the start
of the process to the positions after one step, for the first time (nothing is in a cache of kernels) and later, and
then the steps per second. The state after 1,000 steps is hashed, and compared with that of Aspic's reference in double
precision: a program is measured only if it moves as it should. Numbers are medians.
"""

import argparse
import ast
import hashlib
import importlib
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile
import time

import numpy as np

here = pathlib.Path(__file__).parent
PROGRAMS = {"Aspic": "aspic_cube", "Newton": "newton_cube", "MuJoCo": "mujoco_cube"}
PACKAGES = {"Newton": "newton", "MuJoCo": "mujoco"}
STEPS = 1000


def measure(program: str, begun: float, seconds: float, place: str) -> None:
    """Runs a program in this process, and prints a line of JSON."""
    answers = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # libraries greet on standard output
    module = importlib.import_module(program)
    module.advance(1)
    module.positions()
    first = time.monotonic() - begun
    module.advance(STEPS - 1)
    state = np.ascontiguousarray(module.positions())
    np.save(place, state)
    count, done = STEPS, 0
    clock, processor = time.perf_counter(), time.process_time()
    while time.perf_counter() - clock < seconds:
        module.advance(count)
        done += count
    module.positions()
    by_clock, by_processor = time.perf_counter() - clock, time.process_time() - processor
    row = {"first": first, "rate": done / by_clock, "rate_of_processor": done / by_processor}
    answers.write(json.dumps({**row, "hash": hashlib.sha256(state.tobytes()).hexdigest()[:16]}) + "\n")


def lines_of(program: str) -> int:
    """Lines of code, without blank ones, comments and docstrings; those of lattice.py too where it is used."""
    text = (here / f"{program}.py").read_text(encoding="utf-8")
    tree = ast.parse(text)
    count = sum(1 for line in text.splitlines() if line.strip() and not line.strip().startswith("#"))
    for node in ast.walk(tree):
        if isinstance(node, (ast.Module, ast.FunctionDef)) and ast.get_docstring(node):
            count -= node.body[0].end_lineno - node.body[0].lineno + 1
        if isinstance(node, ast.ImportFrom) and node.module == "lattice":
            count += lines_of("lattice")
    return count


def run(program: str, seconds: float, environment: dict[str, str], place: str) -> dict[str, object]:
    """A program in a fresh process."""
    begun = time.monotonic()
    words = [sys.executable, __file__, "--program", program, "--begun", repr(begun), "--seconds", str(seconds)]
    done = subprocess.run([*words, "--place", place], capture_output=True, text=True, env=environment)
    if done.returncode != 0:
        raise SystemExit(f"{program} failed:\n{done.stderr}")
    return json.loads(done.stdout)


def exact() -> np.ndarray:
    """The state after the steps, in double precision."""
    import aspic
    import aspic_cube

    sim = aspic.Simulation(aspic_cube.scene, "reference", precision="double")
    sim.step(STEPS)
    return sim.positions


def version(name: str) -> str:
    """Of a simulator."""
    if name in PACKAGES:
        from importlib.metadata import version

        return version(PACKAGES[name])
    import aspic

    return aspic.__version__


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--repeats", type=int, default=5)
    words.add_argument("--seconds", type=float, default=2.0, help="of steps in each process")
    words.add_argument("--json", action="store_true", help="every measurement, instead of the table")
    for name in ("--program", "--begun", "--place"):
        words.add_argument(name, help=argparse.SUPPRESS)
    arguments = words.parse_args()
    sys.path.insert(0, str(here))
    if arguments.program:
        measure(arguments.program, float(arguments.begun), arguments.seconds, arguments.place)
        return

    wanted = exact()
    rows: dict[str, list[dict[str, object]]] = {name: [] for name in PROGRAMS}
    apart: dict[str, float] = {}
    with tempfile.TemporaryDirectory() as folder:
        environment = {**os.environ, "WARP_CACHE_PATH": os.path.join(folder, "kernels"), "OMP_NUM_THREADS": "1"}
        place = os.path.join(folder, "state.npy")
        for _ in range(arguments.repeats + 1):  # the first time is apart
            for name, program in PROGRAMS.items():
                rows[name].append(run(program, arguments.seconds, environment, place))
                state = np.load(place)
                apart[name] = float(np.abs(state - wanted).max())
                # What rounding once a step in the state's own precision may add up to.
                bound = STEPS * np.finfo(state.dtype).eps * float(np.abs(wanted).max())
                if apart[name] > bound:
                    raise SystemExit(f"{name} is {apart[name]:g} m off, more than {bound:g} m")
    if arguments.json:
        print(json.dumps(rows, indent=1))
        return

    def median(name: str, key: str) -> float:
        return statistics.median(float(row[key]) for row in rows[name][1:])  # type: ignore[arg-type]

    print(
        "| | lines of code | first result, the first time | first result, later | steps/s | Aspic's rate over it "
        "| the hash repeats | off by |"
    )
    print("|---|---|---|---|---|---|---|---|")
    for name, program in PROGRAMS.items():
        hashes = [row["hash"] for row in rows[name]]
        ratio = median("Aspic", "rate_of_processor") / median(name, "rate_of_processor")
        print(
            f"| {name} {version(name)} | {lines_of(program)} | {rows[name][0]['first']:.1f} s "
            f"| {median(name, 'first'):.2f} s | {median(name, 'rate'):,.0f} | {ratio:.3g}× "
            f"| {hashes.count(hashes[-1])} of {len(hashes)} | {apart[name]:.1g} m |"
        )
    print(f"\nMedians of {arguments.repeats} processes each, in turn; the ratio is by the processor's time.")


if __name__ == "__main__":
    main()
