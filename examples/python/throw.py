"""Two hands swing a cube up and throw it; another backend replays the throw to the bit."""

import argparse
import math
import os
import tempfile

import aspic

words = argparse.ArgumentParser(description=__doc__)
words.add_argument("--backend", default="cpu")
words.add_argument("--replay", default="reference", metavar="BACKEND")
words.add_argument("--video", metavar="FILE", help="video of the replay")
arguments = words.parse_args()

scene = aspic.load("cube-plane", {"cube[0].particles-per-edge": 5, "cube[0].position": [0, 2.5, 0]})
sim = aspic.Simulation(scene, arguments.backend)
corners = sim.positions.argmin(axis=0)[0], sim.positions.argmax(axis=0)[0]  # one to the left, one to the right
held = [sim.positions[c] for c in corners]
for i in range(100):  # for a second, the hands go round half a circle
    angle = math.pi * i / 100
    by = 3 * math.sin(angle), 3 - 3 * math.cos(angle), 0.0
    sim.pulls = [aspic.Pull(int(c), [x + d for x, d in zip(start, by)], 3000, 50) for c, start in zip(corners, held)]
    sim.step(10)
sim.pulls = []
flight = sim.run(1.0, every=0.05, record=["center-of-mass"])["center-of-mass"]
print(f"thrown from {flight[0, 1]:.2f} m to {flight[:, 1].max():.2f} m, {flight[-1, 0] - flight[0, 0]:.2f} m far")

with tempfile.TemporaryDirectory() as folder:
    path = os.path.join(folder, "throw.toml")
    sim.save_inputs(path)
    again = aspic.Simulation(scene, arguments.replay)
    again.replay(path)
    if arguments.video:
        again.video(arguments.video, steps=sim.steps)
    else:
        again.step(sim.steps)
print(f"{sim.backend} {sim.hash}, replayed on {again.backend} {again.hash}")
if again.hash != sim.hash:
    raise SystemExit(1)
