"""Environments: Gymnasium's checker, modes of automatic resets, seeds, spaces, divergence, errors, images."""

from __future__ import annotations

import copy
import itertools
import subprocess
import sys
import warnings
from typing import Any

import aspic
import numpy as np
import pytest
from conftest import needs_images

gymnasium: Any = pytest.importorskip(
    "gymnasium", reason="gymnasium is not installed: pip install gymnasium"
)
import aspic.gym  # noqa: E402
from aspic.gym import AutoresetMode, BatchEnv, Crawl, CrawlEnv, Walk, WalkEnv  # noqa: E402
from gymnasium.utils.env_checker import check_env, data_equivalence  # noqa: E402
from gymnasium.utils.passive_env_checker import data_shares_objects  # noqa: E402

MODES = list(AutoresetMode)


class Lift(BatchEnv):
    """A cube of 8 particles on a hand that draws it upwards; above 3 m the episode ends."""

    def __init__(self, scenes: Any, num_envs: int | None = None, **options: Any):
        box = gymnasium.spaces.Box
        spaces = {"observation_space": box(-100, 100, (2,), np.float32), "action_space": box(-1, 1, (1,), np.float32)}
        super().__init__(scenes, num_envs, **{**spaces, "episode": 0.2, **options})

    def act(self, actions: Any) -> None:
        for one, (force,) in zip(self.batch, actions.tolist()):
            one.pulls = [aspic.Pull(0, (0, 1e4, 0), 0.1 + max(force, 0.0))]

    def observe(self) -> Any:
        return np.stack([self.batch.center_of_mass[:, 1], self.batch.time], axis=1).astype(np.float32)

    def judge(self) -> Any:
        height = self.batch.center_of_mass[:, 1]
        return height, height > 3


def small(**more: Any) -> aspic.Scene:
    values = {"cube[0].particles-per-edge": 2, "cube[0].position": [0, 2.5, 0]}
    return aspic.load("cube-plane", {**values, **more})


def played(envs: Any, steps: int, seed: int = 7) -> list[Any]:
    """What reset() and every step() return for actions that are the same for equal spaces."""
    envs.action_space.seed(seed)
    found: list[Any] = [copy.deepcopy(envs.reset(seed=seed))]
    over = np.zeros(envs.num_envs, bool)
    for _ in range(steps):
        if envs.metadata["autoreset_mode"] == AutoresetMode.DISABLED and over.any():
            found.append(copy.deepcopy(envs.reset(options={"reset_mask": over})))
        found.append(copy.deepcopy(envs.step(envs.action_space.sample())))
        over = found[-1][2] | found[-1][3]
    return found


def test_a_single_environment_passes_the_checker() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("aspic/Crawl-v0").unwrapped
        assert isinstance(env, CrawlEnv)
        check_env(env, skip_render_check=True)
        env.close()


def test_a_walker_passes_the_checker_and_walks() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("aspic/Walk-v0").unwrapped
        assert isinstance(env, WalkEnv)
        check_env(env, skip_render_check=True)
    envs = gymnasium.make_vec("aspic/Walk-v0", num_envs=2, episode=4.0)
    assert isinstance(envs, Walk) and envs.single_action_space.shape == (4,)
    names = list(envs.batch[0].inputs)
    phases = [envs.batch[0].scene[f"actuator[{name}].phase.offset"] for name in names]
    observations, _ = envs.reset(seed=1)
    assert observations.shape == (2, 17) and (observations[:, 2:6] == 0).all()
    for step in range(200):
        # The second one stands.
        gait = np.sin(2 * np.pi * (1.5 * 0.02 * step + np.array(phases)))
        observations, _, _, _, infos = envs.step(np.array([gait, np.zeros(4)]))
        assert observations in envs.observation_space
    assert infos["distance"][0] > 0.3 and abs(infos["distance"][1]) < 0.05
    assert observations[1, 10:16] == pytest.approx([1, 0, 0, 0, 1, 0], abs=0.2) and 0 <= observations[1, 16] <= 1
    for options, words in (({"rate": 0}, "rate"), ({"scenes": "worm"}, "no actuator"), ({"cycle": -1}, "cycle")):
        with pytest.raises(aspic.UsageError, match=words):
            Walk(**options)


def test_walkers_do_not_depend_on_others_nor_on_threads() -> None:
    def hashes(count: int, threads: int, seeds: Any) -> list[str]:
        envs = Walk(count, threads=threads)
        envs.reset(seed=seeds)
        for step in range(3):
            envs.step(np.full((count, 4), step / 2, np.float32))
        return envs.batch.hash

    three = hashes(3, 2, 20)
    assert three == hashes(3, 1, [20, 21, 22]) and len(set(three)) == 3 and hashes(1, 1, 21) == three[1:2]


def test_it_passes_the_checker_with_images() -> None:
    needs_images()
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = gymnasium.make("aspic/Crawl-v0", render_mode="rgb_array", width=64, height=36).unwrapped
        check_env(env)
        env.reset(seed=1)
        before = env.render()
        env.step(np.ones(8, np.float32))
        assert before.shape == (36, 64, 3) and before.dtype == np.uint8 and not np.array_equal(before, env.render())


@pytest.mark.parametrize("mode", MODES)
def test_the_vector_has_the_bits_of_single_environments(mode: AutoresetMode) -> None:
    """Gymnasium's own vector of environments that pass its checker, over several episodes."""
    options = {"episode": 0.06, "push": 0.5}
    single = gymnasium.vector.SyncVectorEnv([lambda: CrawlEnv(**options)] * 3, autoreset_mode=mode)
    envs = Crawl(3, autoreset_mode=mode, **options)
    assert envs.metadata["autoreset_mode"] is single.metadata["autoreset_mode"] is mode
    assert envs.metadata["render_fps"] == 50 and envs.num_envs == 3
    for space in ("observation_space", "action_space", "single_observation_space", "single_action_space"):
        assert getattr(envs, space) == getattr(single, space), space
    ours, theirs = played(envs, 8), played(single, 8)
    assert len(ours) == len(theirs)
    for step, (a, b) in enumerate(zip(ours, theirs)):
        assert data_equivalence(tuple(a), tuple(b), exact=True), (step, a, b)
    assert any(step[3].any() for step in ours if len(step) == 5)
    assert ("final_obs" in ours[3][-1]) == (mode == AutoresetMode.SAME_STEP)


@pytest.mark.parametrize("mode", MODES)
def test_what_is_returned_is_of_the_spaces_and_never_used_again(mode: AutoresetMode) -> None:
    envs = Lift(small(), 2, autoreset_mode=mode.value, episode=0.06)
    found = played(envs, 7)
    for number, step in enumerate(found):
        observations, infos = step[0], step[-1]
        assert observations in envs.observation_space and observations.dtype == np.float32
        assert infos["_diverged"].dtype == np.bool_ and not infos["diverged"].any()
        if len(step) == 5:
            kinds = [(part.shape, part.dtype) for part in step[1:4]]
            assert kinds == [((2,), np.float64), ((2,), np.bool_), ((2,), np.bool_)], number
    envs.reset(seed=1)
    calls = [envs.step(envs.action_space.sample()) for _ in range(3)]
    for a, b in itertools.combinations(calls, 2):
        assert not any(data_shares_objects(x, y) for x, y in zip(a, b))


def test_next_step_resets_in_the_step_after_the_end() -> None:
    envs = Lift(small(), 2, episode=0.04)
    envs.reset(seed=1)
    ends = [envs.step(np.zeros((2, 1), np.float32)) for _ in range(4)]
    assert [end[3].tolist() for end in ends] == [[False] * 2, [True] * 2, [False] * 2, [False] * 2]
    assert ends[1][0][:, 1] == pytest.approx(0.04) and (ends[2][0][:, 1] == 0).all() and (ends[2][1] == 0).all()
    assert ends[3][0][:, 1] == pytest.approx(0.02) and np.array_equal(ends[3][0], ends[0][0])


def test_same_step_keeps_the_last_observation() -> None:
    envs = Lift(small(), 2, episode=0.04, autoreset_mode="SameStep")
    envs.reset(seed=1)
    envs.step(np.zeros((2, 1), np.float32))
    observations, rewards, terminations, truncations, infos = envs.step(np.zeros((2, 1), np.float32))
    assert truncations.all() and (observations[:, 1] == 0).all() and (rewards > 0).all()
    assert infos["final_obs"].dtype == object and infos["final_obs"][1][1] == pytest.approx(0.04)
    assert infos["_final_obs"].all() and set(infos["final_info"]) == {"diverged", "_diverged"}


def test_without_automatic_resets_an_episode_that_is_over_waits() -> None:
    envs = Lift([small(), small(**{"cube[0].position": [0, 3.2, 0]})], autoreset_mode=AutoresetMode.DISABLED)
    envs.reset(seed=1)
    _, _, terminations, truncations, _ = envs.step(np.zeros((2, 1), np.float32))
    assert terminations.tolist() == [False, True] and not truncations.any()
    with pytest.raises(gymnasium.error.ResetNeeded, match="environment 1"):
        envs.step(np.zeros((2, 1), np.float32))
    state = envs.batch[0].hash
    observations, infos = envs.reset(options={"reset_mask": terminations})
    assert observations[:, 1] == pytest.approx([0.02, 0]) and infos["_diverged"].tolist() == [False, True]
    assert envs.batch[0].hash == state and envs.batch[0].pulls and not envs.batch[1].pulls
    envs.step(np.zeros((2, 1), np.float32))


def test_an_environment_that_diverges_is_terminated_alone() -> None:
    scenes = [small(), small(**{"cube[0].structural.stiffness": 1e9, "cube[0].velocity": [1, 0, 0]})]
    scenes[1]["terrain[0].point"] = [0, 2.4, 0]
    envs = Lift(scenes, autoreset_mode="SameStep", episode=4.0)
    envs.reset(seed=1)
    for _ in range(60):
        observations, rewards, terminations, _, infos = envs.step(np.zeros((2, 1), np.float32))
        assert np.isfinite(observations).all() and np.isfinite(rewards).all() and not terminations[0]
        if terminations[1]:
            break
    assert terminations[1] and infos["final_info"]["diverged"].tolist() == [False, True]
    assert not infos["diverged"].any() and observations[1, 1] == 0
    envs.step(np.zeros((2, 1), np.float32))


def test_an_environment_does_not_depend_on_others_nor_on_threads() -> None:
    def hashes(count: int, threads: int, seeds: Any) -> list[str]:
        envs = Crawl(count, threads=threads)
        envs.reset(seed=seeds)
        for step in range(5):
            envs.step(np.full((count, 8), step / 4, np.float32))
        return envs.batch.hash

    five = hashes(5, 2, 20)
    assert five == hashes(5, 1, [20, 21, 22, 23, 24]) and len(set(five)) == 5
    assert hashes(1, 1, 23) == five[3:4] and hashes(2, 1, [None, 24])[1] == five[4]


def test_generators_have_their_seeds_and_go_on() -> None:
    envs = Crawl(2)
    first, _ = envs.reset(seed=3)
    assert envs.np_random_seed == (3, 4) and len(envs.np_random) == 2
    second, _ = envs.reset()
    assert not np.array_equal(first, second)
    assert np.array_equal(envs.reset(seed=3)[0], first) and np.array_equal(envs.reset()[0], second)
    other = Crawl(2)
    assert other.np_random_seed[0] != other.np_random_seed[1]
    mask = np.array([False, True])
    envs.reset(seed=9, options={"reset_mask": mask})
    assert envs.np_random_seed == (3, 10)


def test_tendons_draw_their_ends_together_and_push_nothing() -> None:
    weightless = aspic.gym.crawler({"simulation.gravity": [0, 0, 0], "cube[0].position": [0, 5, 0]})
    envs = Crawl(2, weightless, tendons=[[0, 63], [3, 15]], push=0.0, force=200.0)
    observations, _ = envs.reset(seed=1)
    assert observations.shape == (2, 10) and np.abs(observations[:, 2:]).max() < 1e-6
    for _ in range(10):
        observations, rewards, _, _, infos = envs.step(np.array([[1, 0], [0, 1]], np.float32))
    assert observations[0, 2] < -0.01 and abs(observations[0, 3]) < 0.005
    assert observations[1, 3] < -0.01 and abs(observations[1, 2]) < 0.005
    # 20 steps hold the pulls' anchors, 1 km away: the forces are equal but for that.
    assert np.abs(envs.batch.momentum).max() < 0.02 and np.abs(rewards).max() < 1e-3
    assert infos["distance"] == pytest.approx(envs.batch.center_of_mass[:, 0], abs=1e-6)
    assert envs.ends.tolist() == [[0, 63], [3, 15]]
    edges = Crawl(1).ends
    x = aspic.Simulation(aspic.gym.crawler(), "cpu").positions
    assert np.abs(np.abs(x[edges[:, 1]] - x[edges[:, 0]]) - np.repeat([[1, 0, 0], [0, 1, 0]], 4, axis=0)).max() < 1e-6


def test_gymnasium_makes_vectors_and_its_wrappers_work() -> None:
    envs = gymnasium.make_vec("aspic/Crawl-v0", num_envs=3, episode=0.06)
    assert isinstance(envs, Crawl) and envs.spec.id == "aspic/Crawl-v0"
    wrapped = gymnasium.wrappers.vector.RecordEpisodeStatistics(envs)
    wrapped = gymnasium.wrappers.vector.NormalizeObservation(wrapped)
    wrapped.reset(seed=1)
    total = np.zeros(3)
    for _ in range(3):
        _, rewards, _, truncations, infos = wrapped.step(wrapped.action_space.sample())
        total += rewards
    episode = infos["episode"]
    assert truncations.all() and episode["r"] == pytest.approx(total) and episode["l"].tolist() == [3, 3, 3]
    wrapped.close()
    assert envs.closed
    several = gymnasium.make_vec("aspic/Crawl-v0", num_envs=2, vectorization_mode="sync")
    assert several.reset(seed=1)[0].shape == (2, 22)
    single = gymnasium.make("aspic/Crawl-v0", max_episode_steps=2)
    single.reset(seed=1)
    assert [single.step(single.action_space.sample())[3] for _ in range(2)] == [False, True]


def test_what_cannot_be_made_or_done_is_said() -> None:
    for options, words in (
        ({"render_mode": "human"}, "rgb_array"),
        ({"autoreset_mode": "Never"}, "'NextStep', 'SameStep', 'Disabled'"),
        ({"every": 0.0005}, "every is a multiple of 0.001 s"),
        ({"every": 0.0215}, "every is a multiple"),
        ({"episode": 0.03}, "episode is a multiple of 0.02 s"),
        ({"episode": float("inf")}, "episode"),
        ({"threads": 5000}, "threads"),
        ({"num_envs": 0}, "at least one"),
        ({"tendons": [[0, 64]]}, "0 to 63"),
        ({"tendons": [[5, 5]]}, "different places"),
        ({"tendons": [0, 1]}, r"\(m, 2\)"),
        ({"force": 0}, "force"),
        ({"scenes": [small()] * 2, "num_envs": 3}, "2 scenes make as many"),
        ({"scenes": [small(), small(**{"simulation.timestep": 0.002})]}, "same time step"),
        ({"scenes": aspic.Scene("schema = 1\n[[ball]]\n")}, "no body"),
    ):
        with pytest.raises(aspic.UsageError, match=words):
            Crawl(**options)
    envs = Crawl(2)
    with pytest.raises(gymnasium.error.ResetNeeded, match="reset"):
        envs.step(np.zeros((2, 8)))
    envs.reset(seed=0)
    for actions, words in ((np.zeros((2, 7)), r"\(2, 8\), not \(2, 7\)"), (np.full((2, 8), np.nan), "environment 0")):
        with pytest.raises(aspic.UsageError, match=words):
            envs.step(actions)
    for mask in (np.zeros(2, bool), np.ones(3, bool), np.ones(2)):
        with pytest.raises(aspic.UsageError, match="reset_mask"):
            envs.reset(options={"reset_mask": mask})
    with pytest.raises(aspic.UsageError, match="as many seeds"):
        envs.reset(seed=[1])
    with pytest.raises(aspic.UsageError, match="BatchEnv of one"):
        aspic.gym.SingleEnv(envs)
    assert envs.render() is None


def test_numbers_outside_of_the_space_become_its_nearest() -> None:
    results = []
    for scale in (1, 50):
        envs = Crawl(1)
        envs.reset(seed=1)
        envs.step(scale * np.array([[1, -1, 1, -1, 1, -1, 1, -1]]))
        results.append(envs.batch.hash)
    reference = Crawl(1)
    reference.reset(seed=1)
    reference.step(np.array([[1, 0] * 4], np.float32))
    assert results[0] == results[1] == reference.batch.hash


def test_images_are_of_each_environment() -> None:
    needs_images()
    envs = Crawl(2, render_mode="rgb_array", width=64, height=36)
    envs.reset(seed=1)
    envs.step(np.array([[0] * 8, [1] * 8], np.float32))
    images = envs.render()
    assert images is not None and [type(p) for p in images] == [np.ndarray] * 2 and images[0].shape == (36, 64, 3)
    assert not np.array_equal(*images) and np.array_equal(images[1], envs.image(1))
    envs.close()


def test_every_public_name_has_a_docstring() -> None:
    for name in aspic.gym.__all__:
        thing = getattr(aspic.gym, name)
        assert thing.__doc__, name
        for key in vars(thing) if isinstance(thing, type) and thing is not AutoresetMode else ():
            if callable(getattr(thing, key)) and not key.startswith("_"):
                assert getattr(thing, key).__doc__, f"{name}.{key}"


def test_importing_needs_gymnasium_and_says_so() -> None:
    program = "import sys; sys.modules['gymnasium'] = None\nimport aspic\nprint('core')\nimport aspic.gym"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert done.stdout == "core\n" and done.returncode == 1
    assert done.stderr.endswith("aspic.gym needs the package gymnasium: pip install gymnasium\n")
