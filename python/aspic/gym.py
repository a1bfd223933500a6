"""Environments of Gymnasium: every environment is an instance of a Batch.

    import aspic.gym

    envs = aspic.gym.Crawl(num_envs=64)                     # or gymnasium.make_vec("aspic/Crawl-v0", num_envs=64)
    observations, infos = envs.reset(seed=1)
    observations, rewards, terminations, truncations, infos = envs.step(envs.action_space.sample())

Derive your environments from ``BatchEnv``; ``Crawl`` is such a class, and ``CrawlEnv`` a single environment of it,
``gymnasium.make("aspic/Crawl-v0")``. The same seed and the same actions give the same bits on every machine, whatever
the number of environments and of threads. Needs the package gymnasium: ``pip install "aspic[gym]"``.
"""

try:
    import gymnasium  # type: ignore[import-not-found, unused-ignore]
except ModuleNotFoundError as missing:
    if missing.name != "gymnasium":
        raise
    raise ModuleNotFoundError(
        "aspic.gym needs the package gymnasium: pip install 'aspic[gym]'", name="gymnasium"
    ) from None
from gymnasium.vector import AutoresetMode  # type: ignore[import-not-found, unused-ignore]

from ._crawl import Crawl, CrawlEnv, crawler
from ._environments import BatchEnv, SingleEnv

__all__ = ["AutoresetMode", "BatchEnv", "Crawl", "CrawlEnv", "SingleEnv", "crawler"]

if "aspic/Crawl-v0" not in gymnasium.registry:
    gymnasium.register("aspic/Crawl-v0", entry_point="aspic.gym:CrawlEnv", vector_entry_point="aspic.gym:Crawl")
