"""How much energy each integrator loses or makes: a cube without damping swings, pinned at its top."""

import argparse
import sys

import aspic

words = argparse.ArgumentParser(description=__doc__)
words.add_argument("--seconds", type=float, default=1.0, help="simulated time of each run")
words.add_argument("--particles", type=int, default=4, help="per edge")
arguments = words.parse_args()

scene = aspic.load("cube-plane")
scene.update(
    {
        "cube[0].particles-per-edge": arguments.particles,
        "cube[0].pinned": ["top"],
        "cube[0].structural.damping": 0,
        "cube[0].shear.damping": 0,
        "cube[0].bending.damping": 0,
    }
)

timesteps = (0.002, 0.001, 0.0005)
print("energy after a run, in J more than at its start")
print(f"{'integrator':18}" + "".join(f"{f'h = {1000 * h:g} ms':>14}" for h in timesteps))
for integrator in (
    "explicit-euler",
    "symplectic-euler",
    "midpoint",
    "velocity-verlet",
    "runge-kutta-4",
    "implicit-euler",
):
    row = []
    for h in timesteps:
        run = scene.copy({"simulation.integrator": integrator, "simulation.timestep": h})
        sim = aspic.Simulation(run, "reference", precision="double")
        try:
            energy = sim.run(arguments.seconds)["energy"].total
            row.append(f"{energy[-1] - energy[0]:14.3g}")
        except aspic.DivergedError as error:
            row.append(f"{f'diverged, {error.step}':>14}")
    print(f"{integrator:18}" + "".join(row))
    sys.stdout.flush()
