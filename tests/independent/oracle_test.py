#!/usr/bin/python3
"""Runs the aspic program and the independent oracle on the same scenes and compares every column of the final state.

usage: oracle_test.py ASPIC explicit|implicit
Each scene is written by `aspic scene show`, so that both read one file. Exit code 1 if any case differs by more than
its tolerance, or if a case never touched its terrain (such a case would say nothing about contact).
"""

import csv
import itertools
import os
import subprocess
import sys
import tempfile
from concurrent.futures import ProcessPoolExecutor

import numpy as np

from oracle import INTEGRATORS, World
from oracle_scene import Readings, read_scene

POSITIONS = {
    "cube-plane": "[0.0, 1.9, 0.0]", "cube-tilted-plane": "[1.0, 3.2, 0.0]",
    "cube-sphere": "[0.4, 4.9, 0.2]", "cube-bowl": "[2.3, 5.5, 1.2]",
}
# Both programs work in double precision; what sets them apart is the order of sums and, for implicit-euler, where
# iterations end: the product at a residual of 1e-12 m/s, which 120 steps may add up.
CASES = {
    "explicit": {"integrators": list(INTEGRATORS), "steps": 1200, "timestep": 0.0009, "edge": 5, "tolerance": 1e-9},
    "implicit": {"integrators": ["implicit-euler"], "steps": 120, "timestep": 0.01, "edge": 4, "tolerance": 1e-7},
}


def compare(aspic, scene, model, integrator, case):
    """Returns the case's name, its largest difference over all columns, and whether the terrain acted."""
    settings = {
        "simulation.integrator": integrator, "simulation.timestep": case["timestep"], "contact.model": model,
        "cube[0].particles-per-edge": case["edge"], "cube[0].position": POSITIONS[scene],
        "cube[0].rotation.axis": "[1.0, 0.3, 0.7]", "cube[0].rotation.angle": 25.0,
        "cube[0].velocity": "[1.0, -1.0, 0.5]",
    }
    if integrator == "implicit-euler":
        settings["simulation.implicit.tolerance"] = 1e-12
    words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    with tempfile.TemporaryDirectory() as directory:
        file, state = os.path.join(directory, "scene.toml"), os.path.join(directory, "state.csv")
        with open(file, "w") as out:
            subprocess.run([aspic, "scene", "show", scene, *words], stdout=out, check=True)
        subprocess.run([aspic, "run", file, "--backend", "reference", "--precision", "double", "--steps",
                        str(case["steps"]), "--state", state], stdout=subprocess.DEVNULL, check=True)
        with open(state, newline="") as rows:
            product = np.array([row[2:8] for row in list(csv.reader(rows))[1:]], dtype=float)
        world = World(read_scene(file), Readings())
    for _ in range(case["steps"]):
        world.step()
    ours = np.hstack([world.x, world.v])
    # In free fall all particles of the undeformed cube keep one velocity.
    touched = np.abs(world.v - world.v.mean(axis=0)).max() > 1e-3
    return f"{integrator}, {scene}, {model}", np.abs(ours - product).max(), touched and ours.shape == product.shape


def main():
    aspic, kind = sys.argv[1:]
    case = CASES[kind]
    cells = list(itertools.product(POSITIONS, ("coulomb", "course"), case["integrators"]))
    bad = 0
    with ProcessPoolExecutor() as pool:
        for name, difference, touched in pool.map(compare, *zip(*[(aspic, *cell, case) for cell in cells])):
            good = difference <= case["tolerance"] and touched
            bad += not good
            print(f"{'ok  ' if good else 'FAIL'} {difference:.2e}  {name}{'' if touched else ': never touched the ground'}")
    print(f"{len(cells)} cases, {bad} failed, tolerance {case['tolerance']}")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
