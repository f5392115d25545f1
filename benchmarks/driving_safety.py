"""Collisions of the explorers' driver whatever is chosen: `lidarena/GoalChoice-v0` with choosers that are no good.

python benchmarks/driving_safety.py [--map MAP] [--episodes 24] [--chooser stray] [--limit 500] [--seed 0] [--slam rbpf]

`stray` drives to a frontier or known place drawn at random and then, mostly, to the end; `waver` draws anew at every
choice; `far` takes the farthest, `nearest` the nearest frontier, a little for turning, size and keeping on.
"""

import argparse
import time

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

import lidarena
from lidarena.base.terminal import make_output_printable
from lidarena.envs.exploration.goal_choice.features import NAMES

_KEPT = 0.95
"""Share of choices at which ``stray`` keeps to the candidate that is driven to."""


def choose(chooser: str, rows: NDArray[np.float32], rng: np.random.Generator) -> int:
    """The candidate that a chooser takes, by what is told of them (K, features and ways)."""
    told = {name: rows[:, k] for k, name in enumerate(NAMES)}
    there = np.flatnonzero(told["there"] > 0.5)
    if len(there) == 0:
        return 0
    pursued = np.flatnonzero(told["pursued"] > 0.5)
    if chooser == "stray" and len(pursued) and rng.random() < _KEPT:
        return int(pursued[0])
    if chooser in ("stray", "waver"):
        return int(rng.choice(there))
    if chooser == "far":
        return int(there[np.argmax(told["way"][there])])
    costs = 3.0 * told["way"] + told["turn"] - told["size"] - told["pursued"] + 1e3 * told["place"]
    return int(there[np.argmin(costs[there])])


def main() -> None:
    """Print how the episodes went."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--map", default="willow_lobby")
    parser.add_argument("--episodes", type=int, default=24)
    parser.add_argument("--chooser", choices=["stray", "waver", "far", "nearest"], default="stray")
    parser.add_argument("--limit", type=float, default=500.0, help="of an episode [s]")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--slam", default="rbpf")
    options = parser.parse_args()
    worlds, rng, begin = min(options.episodes, 24), np.random.default_rng(options.seed), time.process_time()
    keywords = {"map": options.map, "slam": options.slam, "time_limit": options.limit}
    envs = gym.make_vec("lidarena/GoalChoice-v0", worlds, "vector_entry_point", **keywords)
    rows, _ = envs.reset(seed=options.seed)
    ends: list[tuple[bool, float, float, float]] = []
    while len(ends) < options.episodes:
        choices = np.array([choose(options.chooser, rows[w], rng) for w in range(worlds)])
        rows, _, terminated, truncated, info = envs.step(choices)
        for w in np.flatnonzero(terminated | truncated):
            told = {name: info["final_info"][name][w] for name in ("collision", "completeness", "path_length", "time")}
            ends.append((bool(told["collision"]), *(float(told[k]) for k in ("completeness", "path_length", "time"))))
    mean = np.array(ends, np.float64).mean(axis=0)
    print(
        f"lidarena {lidarena.__version__}, {options.map}, {options.chooser}, {options.slam}: "
        f"{sum(end[0] for end in ends)} collisions in {len(ends)} episodes; explored {100 * mean[1]:.1f}%, "
        f"{mean[2]:.0f} m, {mean[3]:.0f} s each; {time.process_time() - begin:.0f} s of processor time"
    )


if __name__ == "__main__":
    main()
