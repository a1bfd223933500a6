"""A soft cube learns to crawl: a small evolution strategy on 64 environments of aspic.gym.

    python crawl.py                         # minutes on two CPU cores
    python crawl.py --video crawl.mp4        # and a video of what it learned

The policy is linear: the tension of each tendon is a weighted sum of what the cube observes, within 0 … 1. In every
generation the weights are moved by the same amount in random directions and in their opposites; each of these policies
crawls for an episode, and their ranks say where the weights go. Sums run in a fixed order and random signs are bits of
a generator, so a seed ends with the same hash on every machine.
"""

import argparse
import hashlib
import os
import tempfile

import aspic.gym
import numpy as np


def tensions(weights: np.ndarray, observations: np.ndarray) -> np.ndarray:
    """Return the actions of policies: weights (n, observations + 1, tendons), observations (n, observations)."""
    sums = weights[:, -1].copy()
    for j in range(observations.shape[1]):  # in this order, products of matrices have another on each machine
        sums += observations[:, j, None].astype(np.float64) * weights[:, j]
    return sums


def distances(envs: aspic.gym.Crawl, weights: np.ndarray, seed: int) -> np.ndarray:
    """Return the distances that policies crawl in an episode, from the same start [m]."""
    observations, _ = envs.reset(seed=[seed] * envs.num_envs)
    reached = np.zeros(envs.num_envs)
    over = np.zeros(envs.num_envs, bool)
    while not over.all():
        observations, rewards, terminations, truncations, _ = envs.step(tensions(weights, observations))
        reached += np.where(over, 0.0, rewards)
        over |= terminations | truncations
    return reached


def main() -> None:
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("--generations", type=int, default=120)
    words.add_argument("--pairs", type=int, default=32, help="of opposite directions in a generation")
    words.add_argument("--seconds", type=float, default=4.0, help="of an episode, a multiple of 0.02")
    words.add_argument("--seed", type=int, default=1)
    words.add_argument("--video", metavar="FILE", help="video of the last policy: .mp4, or a folder of images")
    arguments = words.parse_args()

    pairs = arguments.pairs
    envs = aspic.gym.Crawl(2 * pairs, episode=arguments.seconds)
    shape = (envs.single_observation_space.shape[0] + 1, envs.single_action_space.shape[0])
    weights = np.zeros(shape)
    weights[-1] = 0.25  # at first every tendon is a little tense
    spread, rate = 0.25, 0.5
    generator = np.random.PCG64(arguments.seed)
    for generation in range(arguments.generations):
        bits = np.unpackbits(generator.random_raw(pairs * weights.size // 64 + 1).view(np.uint8))
        signs = 2.0 * bits[: pairs * weights.size].reshape(pairs, *shape) - 1
        reached = distances(envs, np.concatenate([weights + spread * signs, weights - spread * signs]), generation)
        ranks = np.argsort(np.argsort(reached, kind="stable"), kind="stable")
        gain = (ranks[:pairs] - ranks[pairs:])[:, None, None]
        # Whole numbers until here, so their sum is exact.
        weights += rate * 2 * (gain * signs).sum(axis=0) / (2 * pairs * pairs)
        if generation % 10 == 9:
            print(f"generation {generation + 1}: {reached.mean():.3f} m, the best {reached.max():.3f} m", flush=True)

    print(f"weights {hashlib.sha256(weights.tobytes()).hexdigest()[:16]}")
    show(weights, arguments.seconds, arguments.video)


def show(weights: np.ndarray, seconds: float, video: str | None) -> None:
    """Simulate an episode of the policy, which a simulation repeats by its inputs."""
    envs = aspic.gym.Crawl(1, episode=seconds)
    observations, _ = envs.reset(seed=0)
    sim = aspic.Simulation(envs.batch[0].scene, "cpu")
    start = envs.batch[0].save()
    sim.load(start)
    truncated = False
    while not truncated:
        observations, _, _, truncations, infos = envs.step(tensions(weights[None], observations))
        truncated = bool(truncations[0])
        sim.pulls = envs.batch[0].pulls
        sim.step(20)
    print(f"crawled {infos['distance'][0]:.3f} m in {seconds:g} s, hash {sim.hash}")
    if sim.hash != envs.batch.hash[0]:
        raise SystemExit("the simulation went another way")
    if video:
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "crawl.toml")
            sim.save_inputs(path)
            steps = sim.steps
            sim.load(start)
            sim.replay(path)
            sim.video(video, steps=steps)


if __name__ == "__main__":
    main()
