"""How well the filter tracks: position error beside the odometry's, and whether its covariance is honest (NEES).

python benchmarks/filter_accuracy.py [--env lidarena/Env3-v0] [--episodes 20] [--policy frontier] [--slam rbpf]

NEES is eᵀ Σ⁻¹ e of the pose's error e; its mean is 3 for a filter whose covariance is right. Steps of one episode err
together, so the χ² bounds are for one step of each: the mean of n independent NEES, times n, is χ² with 3 n degrees of
freedom, which holds 95% of the time between the bounds printed.
"""

import argparse
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from multiprocessing import get_context

import gymnasium as gym
import numpy as np
from scipy.stats import chi2

import lidarena
from lidarena.base.terminal import make_output_printable
from lidarena.envs import set_num_threads
from lidarena.evaluation.statistics import bootstrap


def episode(env_id: str, policy_name: str, slam: str, seed: int) -> tuple[float, float, float, float, float]:
    """Mean position error [m], the odometry's [m], mean and median NEES of one episode, and NEES at a random step."""
    set_num_threads(1)
    env = gym.make(env_id, slam=slam, expose_truth=True, max_episode_steps=5000)
    policy = lidarena.baselines.make(policy_name, env)
    observation, info = env.reset(seed=seed)
    policy.reset(seed=seed)
    errors, odometry, nees, ended = [], [], [], False
    while not ended and not getattr(policy, "finished", False):
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        ended = terminated or truncated
        truth = info["truth"]["pose"]
        error = info["pose"] - truth
        error[2] = np.arctan2(np.sin(error[2]), np.cos(error[2]))
        errors.append(np.hypot(*error[:2]))
        odometry.append(np.hypot(*(info["odometry_pose"] - truth)[:2]))
        nees.append(error @ np.linalg.solve(info["covariance"], error))
    chosen = float(np.random.default_rng(seed).choice(nees))
    return float(np.mean(errors)), float(np.mean(odometry)), float(np.mean(nees)), float(np.median(nees)), chosen


def main() -> None:
    """Print mean and 95% interval over episodes."""
    make_output_printable()
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--env", default="lidarena/Env3-v0")
    parser.add_argument("--episodes", type=int, default=20)
    parser.add_argument("--policy", default="frontier")
    parser.add_argument("--slam", default="rbpf")
    options = parser.parse_args()
    work = partial(episode, options.env, options.policy, options.slam)
    with ProcessPoolExecutor(mp_context=get_context("spawn")) as pool:
        table = np.array(list(pool.map(work, range(5000, 5000 + options.episodes))))
    print(f"{options.env}, {options.policy}, {options.slam}, {options.episodes} episodes, seeds 5000 …")
    names = ("position error [m]", "odometry's error [m]", "NEES, mean", "NEES, median", "NEES, one step each")
    for name, column in zip(names, table.T, strict=True):
        value, low, high = bootstrap(column)
        print(f"{name:24} {value:8.3f}  [{low:.3f}, {high:.3f}]")
    low, high = chi2.ppf((0.025, 0.975), 3 * options.episodes) / options.episodes
    print(f"{'χ² bounds for the last':24} {'':8}  [{low:.3f}, {high:.3f}]")
    print(f"{'ratio of the errors':24} {table[:, 0].mean() / table[:, 1].mean():8.3f}")


if __name__ == "__main__":
    main()
