"""A cube of 10³ particles hangs by its top and sags: Aspic."""

import aspic

scene = aspic.Scene(
    """
schema = 1
simulation = { integrator = "symplectic-euler", timestep = 0.001, gravity = [0, -9.8, 0] }
[[cube]]
particles-per-edge = 10
edge-length = 4.0
position = [0, 0, 0]
particle-mass = 1.0
structural = { stiffness = 2000, damping = 60 }
shear = { stiffness = 2000, damping = 60 }
bending = { stiffness = 2000, damping = 60 }
pinned = ["top"]
"""
)
sim = aspic.Simulation(scene, "cpu", threads=1)


def advance(steps):
    sim.step(steps)


def positions():
    return sim.positions
