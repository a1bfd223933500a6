"""A thousand cubes of 6³ as one batch, and as simulations on the CPU that are stepped one after the other.

python bench/batch.py [--cubes 1000] [--steps 100] [--threads 0] [--repeats 5]

Both make the same steps from the start, in the air, in turn. Printed are medians of the processor's time (of all
threads) and of the clock, and how many times as much the simulations take. `one run after the other`: all steps of a
simulation, then the next one; `a step of each in turn`: as a program that looks at all of them after each step.
"""

import argparse
import statistics
import time
from collections.abc import Callable

import aspic


def scenes(count: int) -> list[aspic.Scene]:
    """Cubes that differ in place, gravity and stiffness."""
    cube = aspic.load("cube-plane", {"cube[0].particles-per-edge": 6})
    return [
        cube.copy(
            {
                "cube[0].position": [0.01 * i, 2.2, 0],
                "cube[0].structural.stiffness": 1500 + i,
                "simulation.gravity": [0, -9.8 + 1e-3 * i, 0],
            }
        )
        for i in range(count)
    ]


def times(act: Callable[[], object]) -> tuple[float, float]:
    """The processor's and the clock's [s]."""
    processor, clock = time.process_time(), time.perf_counter()
    act()
    return time.process_time() - processor, time.perf_counter() - clock


def main() -> None:
    words = argparse.ArgumentParser(description="a batch of cubes of 6³ against simulations one after the other")
    words.add_argument("--cubes", type=int, default=1000)
    words.add_argument("--steps", type=int, default=100)
    words.add_argument("--threads", type=int, default=0, help="of the batch; 0: as many as there are processors")
    words.add_argument("--repeats", type=int, default=5)
    arguments = words.parse_args()
    steps = arguments.steps

    made = scenes(arguments.cubes)
    batch = aspic.Batch(made, threads=arguments.threads)
    alone = [aspic.Simulation(scene, backend="cpu", threads=1) for scene in made]
    starts = [sim.save() for sim in alone]

    def runs() -> None:
        for sim in alone:
            sim.step(steps)

    def turns() -> None:
        for _ in range(steps):
            for sim in alone:
                sim.step()

    def turns_of_batch() -> None:
        for _ in range(steps):
            batch.step()

    measured: dict[str, list[tuple[float, float]]] = {}
    acts = {
        "batch, step(n)": lambda: batch.step(steps),
        "one run after the other": runs,
        "batch, n × step()": turns_of_batch,
        "a step of each in turn": turns,
    }
    for _ in range(arguments.repeats):
        hashes = []
        for name, act in acts.items():
            batch.reset()
            for sim, start in zip(alone, starts):
                sim.load(start)
            measured.setdefault(name, []).append(times(act))
            hashes.append(batch.hash if name.startswith("batch") else [sim.hash for sim in alone])
        if any(other != hashes[0] for other in hashes):
            raise SystemExit("the hashes differ")

    print(f"{batch.description}; {steps} steps, medians of {arguments.repeats}, hashes equal")
    medians = {name: [statistics.median(part) for part in zip(*rows)] for name, rows in measured.items()}
    for name, (processor, clock) in medians.items():
        print(f"{name:24} {processor:8.3f} s of processors {clock:8.3f} s by the clock")
    for one, many in (
        ("one run after the other", "batch, step(n)"),
        ("a step of each in turn", "batch, n × step()"),
        ("a step of each in turn", "batch, step(n)"),
    ):
        processor, clock = (a / b for a, b in zip(medians[one], medians[many]))
        print(f"{one} / {many}: {processor:.2f} by processor time, {clock:.2f} by the clock")


if __name__ == "__main__":
    main()
