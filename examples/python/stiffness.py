"""Measure how high cubes of several stiffnesses bounce: a run each, on all CPU cores."""

import argparse
import concurrent.futures
import multiprocessing

import aspic


def bounce(scene: aspic.Scene, stiffness: float) -> tuple[float, float, str]:
    """Return the lowest and the next highest center of mass [m] after the drop, and the hash of the last state."""
    names = ("structural", "shear", "bending")
    sim = aspic.Simulation(scene.copy({f"cube[0].{name}.stiffness": stiffness for name in names}), "cpu", threads=1)
    height = sim.run(every=0.01, record=["center-of-mass"])["center-of-mass"][:, 1]
    lowest = int(height.argmin())
    return float(height[lowest]), float(height[lowest:].max()), sim.hash


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__)
    words.add_argument("--particles", type=int, default=6, help="per edge")
    words.add_argument("--stiffness", type=float, nargs="+", default=[1000.0, 2000.0, 4000.0, 8000.0], help="N/m")
    arguments = words.parse_args()
    scene = aspic.load("cube-plane", {"cube[0].particles-per-edge": arguments.particles})
    # Not by fork: a child of a process with threads may hang.
    with concurrent.futures.ProcessPoolExecutor(mp_context=multiprocessing.get_context("spawn")) as processes:
        runs = [processes.submit(bounce, scene, stiffness) for stiffness in arguments.stiffness]
        for stiffness, run in zip(arguments.stiffness, runs):
            lowest, highest, hash_ = run.result()
            print(f"k = {stiffness:6g} N/m: down to {lowest:.3f} m, up to {highest:.3f} m, hash {hash_}")


if __name__ == "__main__":
    main()
