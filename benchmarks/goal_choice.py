"""Choices a second in `lidarena/GoalChoice-v0`: the native batch beside a process a world, in mazes drawn afresh.

python benchmarks/goal_choice.py [--worlds 64] [--processes 8] [--seconds 20] [--map MAP]

A rule chooses from the observation alone: the nearest frontier, a little for turning, size and keeping on. The rival is
gymnasium's `AsyncVectorEnv` of the same environment alone, one process a world, which was how this environment was
trained before there was the batch. Times begin after a run-up in which everything is compiled and episodes have ended.
The last column is the processor's time, all threads together; of processes it is not known.
"""

import argparse
import time
from functools import partial
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium.vector import AsyncVectorEnv, AutoresetMode
from numpy.typing import NDArray

import lidarena
from lidarena.base.terminal import make_output_printable
from lidarena.envs.exploration.goal_choice.features import NAMES

ENV = "lidarena/GoalChoice-v0"
MAZES = "random:maze?area_min=60&area_max=60"
RUN_UP = 20


def nearest(rows: NDArray[np.float32]) -> NDArray[np.int64]:
    """The rule: of observations (worlds, K, features and ways) to choices (worlds,)."""
    told = {name: rows[:, :, k] for k, name in enumerate(NAMES)}
    costs = 3.0 * told["way"] + told["turn"] - told["size"] - told["pursued"]
    costs = np.where((told["there"] > 0.5) & (told["place"] < 0.5), costs, np.inf)
    return np.asarray(costs.argmin(axis=1), np.int64)


def make_world(keywords: dict[str, Any]) -> gym.Env[Any, Any]:
    """One world; in a process of its own."""
    lidarena.envs.set_num_threads(1)
    return gym.make(ENV, **keywords)


def rate(envs: Any, seconds: float) -> tuple[float, float]:
    """Choices a second, and the processor's time for one here [ms]."""
    observations = envs.reset(seed=0)[0]
    for _ in range(RUN_UP):
        observations = envs.step(nearest(observations))[0]
    begin, used, choices = time.perf_counter(), time.process_time(), 0
    while time.perf_counter() - begin < seconds:
        observations = envs.step(nearest(observations))[0]
        choices += envs.num_envs
    return choices / (time.perf_counter() - begin), 1e3 * (time.process_time() - used) / choices


def main() -> None:
    """Print the table."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--worlds", type=int, default=64)
    parser.add_argument("--processes", type=int, default=8, help="0: no rival")
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--map", default=MAZES)
    options = parser.parse_args()
    print(f"lidarena {lidarena.__version__}, {ENV}, {options.map}, {options.seconds:g} s each")
    print(f"{'':24}{'':24}{'choices/s':>10}{'ms/choice':>11}")
    for name, slam in (("SLAM live", "rbpf"), ("true poses", "truth")):
        keywords = {"map": options.map, "start": "random", "slam": slam}
        envs: Any = gym.make_vec(ENV, options.worlds, "vector_entry_point", **keywords)
        speed, used = rate(envs, options.seconds)
        envs.close()
        print(f"{name:24}{f'batch of {options.worlds}':24}{speed:10,.0f}{used:11.2f}", flush=True)
        if options.processes:
            makers = [partial(make_world, keywords)] * options.processes
            envs = AsyncVectorEnv(makers, context="spawn", autoreset_mode=AutoresetMode.SAME_STEP)
            speed, _ = rate(envs, options.seconds)
            envs.close()
            print(f"{name:24}{f'{options.processes} processes':24}{speed:10,.0f}", flush=True)


if __name__ == "__main__":
    main()
