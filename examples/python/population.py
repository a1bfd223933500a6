"""Which jelly bounces highest: cubes of random stiffness and damping, stepped together as one batch."""

import argparse
import random

import aspic
import numpy as np

words = argparse.ArgumentParser(description=__doc__)
words.add_argument("--cubes", type=int, default=500)
words.add_argument("--particles", type=int, default=5, help="per edge")
words.add_argument("--seconds", type=float, default=3.0, help="simulated")
arguments = words.parse_args()

kinds = ("structural", "shear", "bending")
chance = random.Random(1)
drop = aspic.load("cube-plane", {"cube[0].particles-per-edge": arguments.particles, "cube[0].position": [0, 4, 0]})
scenes = []
for _ in range(arguments.cubes):
    jelly = {"stiffness": chance.uniform(500, 8000), "damping": chance.uniform(5, 100)}
    scenes.append(drop.copy({f"cube[0].{kind}": jelly for kind in kinds}))

batch = aspic.Batch(scenes)
print(batch.description)
out = batch.run(arguments.seconds, every=0.02)
height = out["center-of-mass"][:, :, 1]
lowest = height.argmin(axis=1)
bounce = np.array([cube[low:].max() for cube, low in zip(height, lowest)])
bounce[out.diverged > 0] = np.nan  # too stiff for their time step
for i in np.argsort(-bounce, kind="stable")[:5]:
    k, c = scenes[i]["cube[0].structural.stiffness"], scenes[i]["cube[0].structural.damping"]
    print(f"cube {i}: up to {bounce[i]:.3f} m, k = {k:.0f} N/m, c = {c:.0f} N·s/m, hash {out.hash[i]}")
print(f"{int((out.diverged > 0).sum())} of {len(batch)} diverged")
