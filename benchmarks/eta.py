"""Calibrate η of the uncertainty reward: the median D-optimality of random driving in Env-1.

python benchmarks/eta.py [--episodes 500]

With η = 1, as printed, 1 + tanh(η / D) is 2 in every step; with this η it varies with D.
"""

import argparse

import gymnasium as gym
import numpy as np

import lidarena  # noqa: F401
from lidarena.base.terminal import make_output_printable
from lidarena.evaluation.statistics import bootstrap

WORLDS = 64


def main() -> None:
    """Print the median over all steps, and the mean over episodes of the episodes' medians."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--episodes", type=int, default=500)
    wanted = parser.parse_args().episodes
    batch = gym.make_vec("lidarena/Env1-v0", WORLDS, "vector_entry_point", start="random")
    batch.reset(seed=9000)
    rng = np.random.default_rng(9000)
    running: list[list[float]] = [[] for _ in range(WORLDS)]
    ended: list[list[float]] = []
    while len(ended) < wanted:
        _, _, terminated, truncated, infos = batch.step(rng.integers(3, size=WORLDS))
        for world in range(WORLDS):
            done = terminated[world] or truncated[world]
            info = infos["final_info"] if done else infos
            running[world].append(float(info["d_optimality"][world]))
            if done:
                ended.append(running[world])
                running[world] = []
    values = np.concatenate(ended)
    low, middle, high = np.quantile(values, (0.25, 0.5, 0.75))
    print(f"D-optimality over {len(values):,} steps of {len(ended)} episodes with random starts:")
    print(f"median {middle:.2e}, quartiles {low:.2e} and {high:.2e}")
    mean, least, most = bootstrap(np.array([np.median(episode) for episode in ended]))
    print(f"episodes' medians: mean {mean:.2e} [{least:.2e}, {most:.2e}]")


if __name__ == "__main__":
    main()
