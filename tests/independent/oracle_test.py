#!/usr/bin/python3
"""Runs the aspic program and the independent oracle on the same scenes and compares every column of the final state.

usage: oracle_test.py ASPIC explicit|implicit|each
Each scene is written by `aspic scene show`, so that both read one file. `each` takes each scene once, the explicit methods and
the contact models in turn, until it has touched something. Exit code 1 if any case differs by more than its tolerance, or if
a case never touched its terrain (such a case would say nothing about contact).
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

FALLING = {
    "cube[0].rotation.axis": "[1.0, 0.3, 0.7]", "cube[0].rotation.angle": 25.0, "cube[0].velocity": "[1.0, -1.0, 0.5]",
}
SECOND_PLANE = """
[[terrain]]
shape = "plane"
point = [0.0, -1.0, 0.0]
normal = {normal}
restitution = 0.5
friction = 0.1
mass = {mass}
"""
SECOND_CUBE = """
[[cube]]
particles-per-edge = {n}
edge-length = {edge}
position = {position}
rotation = {{ axis = [1.0, 0.3, 0.7], angle = {angle} }}
velocity = {velocity}
particle-mass = 0.8
"""
BALL = """
[[ball]]
radius = {radius}
mass = {mass}
position = {position}
velocity = {velocity}
angular-velocity = {spin}
"""
# Name: built-in scene, settings, text appended to the scene file, how many times the usual number of steps.
SCENES = {
    "plane": ("cube-plane", FALLING | {"cube[0].position": "[0.0, 1.9, 0.0]"}, "", 1),
    "tilted plane": ("cube-tilted-plane", FALLING | {"cube[0].position": "[1.0, 3.2, 0.0]"}, "", 1),
    "sphere": ("cube-sphere", FALLING | {"cube[0].position": "[0.4, 4.9, 0.2]"}, "", 1),
    "bowl": ("cube-bowl", FALLING | {"simulation.drag": 1.3, "cube[0].position": "[2.3, 5.5, 1.2]"}, "", 1),
    "light ground": ("cube-plane", FALLING | {"cube[0].position": "[0.0, 2.1, 0.0]", "terrain[0].mass": 10.0}, "", 1),
    "pinned corner": ("cube-plane", FALLING | {"cube[0].position": "[0.0, 1.8, 0.0]",
                                               "cube[0].pinned": '["top-left-front"]'}, "", 1),
    # Boxes: of springs, pinned by a face of unequal sides, and of a material.
    "box": ("cube-plane", FALLING | {"cube[0].position": "[0.0, 1.6, 0.0]", "cube[0].particles": "[4, 3, 6]",
                                     "cube[0].pinned": '["right-top-front", 5]'}, "", 1),
    "box of a material": ("cube-plane", FALLING | {"cube[0].position": "[0.0, 1.5, 0.0]", "cube[0].particles": "[5, 2, 3]",
                                                   "cube[0].material": "{}"}, "", 1),
    # Two planes: what the first leaves is what the second acts on, in the forces and at the step's end.
    "groove": ("cube-plane", FALLING | {"simulation.drag": 0.2, "cube[0].position": "[0.2, 2.2, 0.0]", "terrain[0].normal": "[1.0, 1.0, 0.0]"},
               SECOND_PLANE.format(normal="[-1.0, 1.2, 0.0]", mass=50.0), 1),
    "corner": ("cube-plane", {"cube[0].position": "[0.0, 1.13, 0.0]", "cube[0].velocity": "[1.0, 0.0, 0.3]",
                              "cube[0].rotation.axis": "[1.0, 0.3, 0.7]", "cube[0].rotation.angle": 2.0},
               SECOND_PLANE.format(normal="[-1.0, 0.0, 0.0]", mass=1e9).replace("[0.0, -1.0, 0.0]", "[2.2, 0.0, 0.0]"), 1),
    # Resting contact from the first step on: sliding, sticking, on curved ground.
    "slide": ("cube-tilted-plane", {"cube[0].position": "[0.519, 1.937, 0.0]", "cube[0].rotation.axis": "[0.0, 0.0, 1.0]",
                                    "cube[0].rotation.angle": -15.0, "terrain[0].normal": "[0.2679491924, 1.0, 0.0]",
                                    "contact.friction": 0.2}, "", 2),
    "stick": ("cube-tilted-plane", {"cube[0].position": "[0.519, 1.937, 0.0]", "cube[0].rotation.axis": "[0.0, 0.0, 1.0]",
                                    "cube[0].rotation.angle": -15.0, "terrain[0].normal": "[0.2679491924, 1.0, 0.0]",
                                    "contact.friction": 0.5}, "", 2),
    # Nothing bounces: what the springs throw back up is limited.
    "dead ground": ("cube-plane", FALLING | {"cube[0].position": "[0.0, 2.1, 0.0]", "terrain[0].restitution": 0.0}, "", 1),
    # Two planes in one, with different friction.
    "double slope": ("cube-tilted-plane", {"cube[0].position": "[0.519, 1.937, 0.0]", "cube[0].rotation.axis": "[0.0, 0.0, 1.0]",
                                           "cube[0].rotation.angle": -15.0, "terrain[0].normal": "[0.2679491924, 1.0, 0.0]",
                                           "contact.friction": 0.05},
                     SECOND_PLANE.format(normal="[0.2679491924, 1.0, 0.0]", mass=1e9)
                     .replace("[0.0, -1.0, 0.0]", "[1.0, -0.2679491924, 0.0]").replace("friction = 0.1", "friction = 0.2"), 1),
    # Bodies that touch: an edge and a corner on a face, light on heavy, one held; and a slide on another cube.
    "two bodies": ("cube-plane", {"contact.bodies": "true", "contact.body-friction": 0.4, "cube[0].position": "[0.0, -0.05, 0.0]",
                                  "cube[0].particles": "[4, 3, 4]", "cube[0].edge-length": 1.8, "cube[0].rotation.axis": "[0.0, 1.0, 0.0]",
                                  "cube[0].rotation.angle": 10.0, "cube[0].pinned": '["left-bottom-front"]', "cube[0].friction": 0.15},
                   SECOND_CUBE.format(n=3, edge=0.9, position="[0.5, 1.2, 0.1]", angle=25.0, velocity="[1.0, -2.0, 0.5]"), 1),
    "bodies that overlap": ("cube-plane", {"contact.bodies": "true", "contact.self": "true", "cube[0].position": "[0.0, 0.6, 0.0]",
                                           "cube[0].particles": "[3, 3, 3]", "cube[0].edge-length": 1.0},
                            SECOND_CUBE.format(n=2, edge=0.6, position="[0.3, 1.3, 0.1]", angle=5.0, velocity="[0.0, 0.0, 0.0]"), 1),
    # Balls on corners, on an edge and on a coarse face, one spinning; and on a cube that they tumble.
    "balls": ("cube-plane", {"contact.bodies": "true", "contact.ball-restitution": 0.4, "cube[0].position": "[0.0, 0.05, 0.0]", "simulation.drag": 0.6,
                             "cube[0].particles": "[3, 2, 3]", "cube[0].edge-length": 2.0, "cube[0].rotation.axis": "[0.0, 1.0, 0.0]",
                             "cube[0].rotation.angle": 10.0},
              BALL.format(radius=0.2, mass=2.0, position="[-0.5, 0.9, 0.3]", velocity="[0.2, -1.0, 0.0]", spin="[0.0, 0.0, 9.0]")
              + BALL.format(radius=0.15, mass=1.0, position="[0.55, 1.0, -0.4]", velocity="[0.0, 0.0, 0.0]", spin="[0.0, 0.0, 0.0]")
              + BALL.format(radius=0.1, mass=0.5, position="[0.04, 1.2, 0.03]", velocity="[0.0, -2.0, 0.0]", spin="[3.0, 0.0, 0.0]"), 0.3),
    # Cells of two materials with holes and a margin, held by a face; a wave, a table along an axis, and phases by cell with a
    # triangle, which share springs. Contact between bodies is off: it has scenes of its own.
    "robot": ("worm", {"contact.bodies": "false", "material[muscle].youngs-modulus": 60000.0, "material[skin].youngs-modulus": 40000.0,
                       "voxels[0].position": "[0.1, 0.23, 0.0]", "voxels[0].rotation.angle": 35.0,
                       "voxels[0].velocity": "[0.4, -0.5, 0.2]", "voxels[0].layers": '[[".....", ".12.1", ".1122"], [".....", ".2..1", ".1.22"]]',
                       "voxels[0].pieces": "largest", "actuator[0].amplitude": 0.15, "actuator[0].ramp": 0.1,
                       "actuator[0].phase": "{ along = \"x\", wavelength = 0.25, offset = 0.1 }"},
              """
[[actuator]]
body = ["voxels[0]"]
select = { springs = ["structural", "shear"], voxels = [["11111", "11111", "11.11"], ["11111", "11111", "11111"]] }
axis = "y"
volume-change = 0.3
signal = "table"
table = [[0.0, -0.5], [0.3, 1.0], [1.0, -0.5]]
frequency = 2.0
start = 0.02
[[actuator]]
amplitude = 0.1
signal = "triangle"
frequency = 3.0
phase = { cells = "5 2 3: 0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9 0 0.25 0.5 0.75 1 0.3 0.6 0.9 0.2 0.4 0 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9" }
""", 0.5),
    # A cube whose lower part swells along two axes, and springs over two steps that jump.
    "muscles of a cube": ("cube-plane", {"cube[0].position": "[0.0, 1.2, 0.0]", "cube[0].particles": "[5, 3, 4]",
                                         "cube[0].rotation.axis": "[1.0, 0.3, 0.7]", "cube[0].rotation.angle": 25.0,
                                         "cube[0].bending.stiffness": 700.0, "cube[0].particle-mass": 3.0, "contact.bodies": "false"}, """
[[actuator]]
body = "cube[0]"
select = { box = { min = [-9.0, -9.0, -9.0], max = [0.6, 0.0, 9.0] } }
axis = "x"
amplitude = 0.3
[[actuator]]
axis = "z"
select = { box = { min = [-9.0, -9.0, -9.0], max = [0.6, 0.0, 9.0] } }
amplitude = -0.2
frequency = 3.0
[[actuator]]
select = { springs = ["bending"] }
signal = "square"
amplitude = 0.1
frequency = 7.3
ramp = 0.3
""", 0.5),
    "cradle": ("cube-bowl", {"cube[0].position": "[2.1, 3.3, 1.2]", "terrain[0].friction": 0.6}, "", 1),
}
# Both programs work in double precision; what sets them apart is the order of sums and, for implicit-euler, where
# iterations end: the product at a residual of 1e-12 m/s, which 120 steps may add up.
CASES = {
    "explicit": {"integrators": list(INTEGRATORS), "steps": 1200, "timestep": 0.0009, "edge": 5, "tolerance": 1e-9},
    "implicit": {"integrators": ["implicit-euler"], "steps": 120, "timestep": 0.01, "edge": 4, "tolerance": 1e-7},
}
CASES["each"] = CASES["explicit"] | {"steps": 800, "edge": 3}


def cells_of(kind, case):
    """Scene, contact model and integrator of each case."""
    models, integrators = ("coulomb", "course"), case["integrators"]
    if kind == "each":
        return list(zip(SCENES, itertools.cycle(models), itertools.cycle(integrators)))
    return list(itertools.product(SCENES, models, integrators))


def compare(aspic, name, model, integrator, case):
    """Returns the case's name, its largest difference over all columns, and whether the terrain acted."""
    scene, placed, appended, longer = SCENES[name]
    steps = round(case["steps"] * longer)
    settings = placed | {
        "simulation.integrator": integrator, "simulation.timestep": case["timestep"], "contact.model": model,
    }
    if scene.startswith("cube") and "cube[0].particles" not in placed:
        settings["cube[0].particles-per-edge"] = case["edge"]
    if integrator == "implicit-euler":
        settings["simulation.implicit.tolerance"] = 1e-12
    words = [word for key, value in settings.items() for word in ("--set", f"{key}={value}")]
    with tempfile.TemporaryDirectory() as directory:
        file, state = os.path.join(directory, "scene.toml"), os.path.join(directory, "state.csv")
        with open(file, "w") as out:
            subprocess.run([aspic, "scene", "show", scene, *words], stdout=out, check=True)
        with open(file, "a") as out:
            out.write(appended)
        subprocess.run([aspic, "run", file, "--backend", "reference", "--precision", "double", "--steps",
                        str(steps), "--state", state], stdout=subprocess.DEVNULL, check=True)
        with open(state, newline="") as rows:
            product = np.array([row[2:] for row in list(csv.reader(rows))[1:]], dtype=float)
        world = World(read_scene(file), Readings())
    in_contact = False
    for _ in range(steps):
        world.step()
        in_contact |= world.body_contact is not None and world.body_contact.acted
        in_contact |= world.balls is not None and world.balls.acted
        in_contact |= any(np.any(t.distance_and_normal(world.x)[0][world.free] < world.distance) for t in world.terrains)
    ours = np.hstack([world.x, world.v, np.zeros_like(world.v)])
    if world.balls:
        ours = np.vstack([ours, world.balls.numbers()])
    return f"{integrator}, {name}, {model}", np.abs(ours - product).max(), in_contact and ours.shape == product.shape


def main():
    aspic, kind = sys.argv[1:]
    case = CASES[kind]
    cells = cells_of(kind, case)
    bad = 0
    with ProcessPoolExecutor() as pool:
        for name, difference, in_contact in pool.map(compare, *zip(*[(aspic, *cell, case) for cell in cells])):
            good = difference <= case["tolerance"] and in_contact
            bad += not good
            print(f"{'ok  ' if good else 'FAIL'} {difference:.2e}  {name}{'' if in_contact else ': never touched the ground'}")
    print(f"{len(cells)} cases, {bad} failed, tolerance {case['tolerance']}")
    return int(bad > 0)


if __name__ == "__main__":
    sys.exit(main())
