"""Environments of Gymnasium: every environment is an instance of a Batch::

    import aspic.gym

    envs = aspic.gym.Walk(num_envs=64)                      # or gymnasium.make_vec("aspic/Walk-v0", num_envs=64)
    observations, infos = envs.reset(seed=1)
    observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())

Derive your environments from ``BatchEnv``. ``Walk``, a robot of voxels with muscles, and ``Crawl``, a cube with
tendons, are such classes; ``WalkEnv`` is a single environment, ``gymnasium.make("aspic/Walk-v0")``. The same seed and
the same actions give the same bits on every machine, whatever the number of environments and of threads.
Needs the package gymnasium: ``pip install gymnasium``.
"""

try:
    import gymnasium  # type: ignore[import-not-found, unused-ignore]
except ModuleNotFoundError as missing:
    if missing.name != "gymnasium":
        raise
    raise ModuleNotFoundError(
        "aspic.gym needs the package gymnasium: pip install gymnasium", name="gymnasium"
    ) from None
from gymnasium.vector import AutoresetMode  # type: ignore[import-not-found, unused-ignore]

from ._crawl import Crawl, CrawlEnv, crawler
from ._environments import BatchEnv, SingleEnv
from ._walk import Walk, WalkEnv, walker

__all__ = ["AutoresetMode", "BatchEnv", "Crawl", "CrawlEnv", "SingleEnv", "Walk", "WalkEnv", "crawler", "walker"]

for _name in ("Crawl", "Walk"):
    if f"aspic/{_name}-v0" not in gymnasium.registry:
        gymnasium.register(
            f"aspic/{_name}-v0", entry_point=f"aspic.gym:{_name}Env", vector_entry_point=f"aspic.gym:{_name}"
        )
