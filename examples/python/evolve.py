"""Evolve voxel robots: bodies and phases of muscles, selected by the distance they crawl.

    python evolve.py                        # 200 robots × 100 generations: minutes on two CPU cores
    python evolve.py --video best.mp4        # and a video of the winner

A robot is a block of cells, each of which is empty, fat, or muscle with a phase. Every generation mutates the best
robots so far, and steps all children as one batch. Random numbers are bits of a generator, and distances have the same
bits on every machine, so a seed ends with the same winner and hash everywhere.
"""

import argparse
import time
from typing import NamedTuple

import aspic
import numpy as np

EMPTY, FAT, MUSCLE = 0, 1, 2
PHASES = 8


class Robot(NamedTuple):
    """Genes of cells, by x, y and z."""

    kinds: np.ndarray
    phases: np.ndarray  # in PHASES parts of a cycle


class Chance:
    """Whole numbers from the bits of a generator, the same on every machine."""

    def __init__(self, seed: int) -> None:
        self.bits = np.random.PCG64(seed)

    def numbers(self, count: int, below: int) -> np.ndarray:
        return (self.bits.random_raw(count) >> np.uint64(40)).astype(np.int64) % below


def yard() -> aspic.Scene:
    """Return a scene of what all robots share: ground and materials.

    The time step is well below the largest stable one of any robot: evolution would find those that blow up and fly.
    """
    scene = aspic.Scene(name="robot")
    scene.update({"simulation.integrator": "symplectic-euler", "simulation.timestep": 0.004})
    scene.update({"contact.restitution": 0.0, "contact.friction": 0.8})
    scene.add("terrain", point=[0, 0, 0])
    scene.add_material("fat", density=900, youngs_modulus=5e4, damping_ratio=0.1)
    scene.add_material("muscle", density=1000, youngs_modulus=5e4, damping_ratio=0.1)
    scene["view.camera"] = {"position": [1.2, 1.0, 2.4], "target": [0.4, 0.15, 0], "fov": 40}
    scene["view.ground"] = 0.0
    return scene


def scene_of(robot: Robot, ground: aspic.Scene) -> aspic.Scene:
    """Return a scene in which the robot stands on the ground."""
    scene = ground.copy()
    used = np.flatnonzero(robot.kinds.any(axis=(0, 2)))
    height = 0.1 * (robot.kinds.shape[1] / 2 - used[0])
    palette = {FAT: "fat", MUSCLE: "muscle"}
    scene.add_voxels(
        "robot", robot.kinds, size=0.1, palette=palette, pieces="largest", position=[0, height + 0.002, 0]
    )
    scene.add_actuator(
        "muscles", material="muscle", volume_change=0.5, frequency=2.0, phase=robot.phases / PHASES, ramp=0.25
    )
    return scene


def random_robot(shape: tuple[int, int, int], chance: Chance) -> Robot:
    """Return a robot that is mostly full and has a muscle."""
    count = int(np.prod(shape))
    kinds = np.array([EMPTY, FAT, MUSCLE, MUSCLE])[chance.numbers(count, 4)].reshape(shape)
    kinds[tuple(n // 2 for n in shape)] = MUSCLE
    return Robot(kinds, chance.numbers(count, PHASES).reshape(shape))


def mutated(robot: Robot, chance: Chance) -> Robot:
    """Return the robot with some cells changed."""
    kinds, phases = robot.kinds.copy().ravel(), robot.phases.copy().ravel()
    for cell in chance.numbers(int(1 + chance.numbers(1, 4)[0]), kinds.size):
        kinds[cell] = np.array([EMPTY, FAT, MUSCLE, MUSCLE])[chance.numbers(1, 4)[0]]
    for cell in chance.numbers(int(1 + chance.numbers(1, 4)[0]), kinds.size):
        phases[cell] = (phases[cell] + 1 + chance.numbers(1, PHASES - 1)[0]) % PHASES
    return Robot(kinds.reshape(robot.kinds.shape), phases.reshape(robot.kinds.shape))


def crawled(scenes: list[aspic.Scene], seconds: float) -> tuple[np.ndarray, list[str]]:
    """Return each body's displacement along x [m], −1 if it diverges, and the hash of its last state."""
    out = aspic.Batch(scenes).run(seconds, record=["center-of-mass"])
    moved = out["center-of-mass"][:, -1, 0] - out["center-of-mass"][:, 0, 0]
    return np.where(out.diverged, -1.0, moved), out.hash


def distances(robots: list[Robot], ground: aspic.Scene, seconds: float) -> tuple[np.ndarray, list[str]]:
    """Return each robot's displacement along x [m] and the hash of its last state; −1 if it is invalid or diverges."""
    scenes, numbers = [], []
    for number, robot in enumerate(robots):
        try:
            scenes.append(scene_of(robot, ground))
            numbers.append(number)
        except aspic.SceneError:  # its largest piece has no muscle
            pass
    reached, hashes = np.full(len(robots), -1.0), [""] * len(robots)
    for number, distance, code in zip(numbers, *crawled(scenes, seconds)):
        reached[number], hashes[number] = distance, code
    return reached, hashes


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--robots", type=int, default=200)
    words.add_argument("--generations", type=int, default=100)
    words.add_argument("--seconds", type=float, default=4.0, help="simulated, of each robot")
    words.add_argument("--shape", type=int, nargs=3, default=(5, 3, 3), help="cells along x, y and z")
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--video", metavar="FILE", help="video of the winner: .mp4, or a folder of images")
    words.add_argument("--save", metavar="FILE", help="writes the winner's scene")
    arguments = words.parse_args()

    chance, ground, began = Chance(arguments.seed), yard(), time.perf_counter()
    children = [random_robot(tuple(arguments.shape), chance) for _ in range(arguments.robots)]
    best: list[tuple[float, str, Robot]] = []
    for generation in range(arguments.generations):
        reached, hashes = distances(children, ground, arguments.seconds)
        everyone = best + list(zip(reached.tolist(), hashes, children))
        best = sorted(everyone, key=lambda one: -one[0])[: max(1, arguments.robots // 5)]
        parents = chance.numbers(arguments.robots, len(best))
        children = [mutated(best[parent][2], chance) for parent in parents]
        if generation % 10 == 9 or generation == arguments.generations - 1:
            seconds = time.perf_counter() - began
            print(f"generation {generation + 1}: the best {best[0][0]:.3f} m, {seconds:.0f} s", flush=True)

    distance, code, robot = best[0]
    scene = scene_of(robot, ground)
    scene["view.follow"] = "voxels[0]"
    alone = aspic.Simulation(scene, "cpu")
    alone.step(round(arguments.seconds / alone.timestep))
    print(f"the winner crawls {distance:.3f} m in {arguments.seconds:g} s, hash {code}")
    if alone.hash != code:
        raise SystemExit("the winner went another way alone")
    finer = scene.copy()
    finer["simulation.timestep"] = alone.timestep / 2
    half, _ = crawled([finer], arguments.seconds)
    print(f"with half the time step {half[0]:.3f} m")
    if arguments.save:
        scene.save(arguments.save, overwrite=True)
    if arguments.video:
        aspic.Simulation(scene, "cpu").video(arguments.video, arguments.seconds)


if __name__ == "__main__":
    main()
