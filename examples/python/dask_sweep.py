"""How far cubes slide, by friction and stiffness: a sweep on a Dask cluster, here or elsewhere.

    python dask_sweep.py                                   # a cluster of processes on this machine
    python dask_sweep.py --scheduler tcp://node-1:8786     # one that `dask scheduler` and `dask worker` made

Interrupt it, kill a worker, or start it again: what is in the folder is not computed twice.
"""

import argparse

import aspic
import numpy as np


def reach(run: aspic.Trajectory) -> float:
    """Return the displacement of the center of mass along the ground [m]."""
    way = run["center-of-mass"][-1] - run["center-of-mass"][0]
    return float(np.hypot(way[0], way[2]))


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--scheduler", help="address; without it, a cluster on this machine")
    words.add_argument("--out", default="slides", help="folder of the runs, which all workers see")
    words.add_argument("--runs", type=int, default=10, help="values of each parameter")
    words.add_argument("--seconds", type=float, default=2.0, help="simulated")
    arguments = words.parse_args()
    from dask.distributed import Client

    scene = aspic.load("cube-plane", {"cube[0].particles-per-edge": 5, "cube[0].velocity": [3, 0, 0]})
    vary = {"mu": np.linspace(0, 0.9, arguments.runs), "k": np.geomspace(500, 5000, arguments.runs)}
    client = Client(arguments.scheduler) if arguments.scheduler else Client(threads_per_worker=1)
    with client:
        table = aspic.sweep(
            scene,
            vary,
            {"reach": reach},
            arguments.out,
            client,
            duration=arguments.seconds,
            progress=lambda made, wanted: print(f"\r{made} of {wanted} runs", end="", flush=True),
        )
    print()
    best = max(range(table.size), key=lambda i: table["reach"][i] or 0.0)
    print(f"farthest: {table['reach'][best]:.3f} m with μ = {table['mu'][best]:.2f}, k = {table['k'][best]:.0f} N/m")
    print(f"hash {table['hash'][best]}, {sum(table['seconds']):.1f} s of steps")
    table.save("slides.csv", overwrite=True)


if __name__ == "__main__":
    main()
