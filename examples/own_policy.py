"""A policy of one's own, measured beside the package's: it drives to where there is room.

python examples/own_policy.py             the same from YAML: policies: [frontier, "own_policy:RoomSeeker"]
"""

import gymnasium as gym
import numpy as np

from lidarena.evaluation import compare


class RoomSeeker:
    """Turns towards the roomiest of what it sees ahead, and drives the faster the more room there is."""

    def __init__(self, env: gym.Env):
        self.noise = np.random.default_rng()

    def reset(self, seed=None):
        self.noise = np.random.default_rng(seed)

    def act(self, observation, info):
        beams = observation[:5]  # over the longest range, from right to left
        turn = (beams * [-1.0, -0.6, 0.0, 0.6, 1.0]).sum() / beams.sum() + self.noise.normal(0.0, 0.05)
        blocked = beams[1:4].min() < 0.12
        speed = -1.0 if blocked else 2.0 * beams[2] - 1.0
        return np.clip([speed, 1.0 if blocked else 2.0 * turn], -1.0, 1.0).astype(np.float32)


if __name__ == "__main__":
    env = {"id": "lidarena/Env1-v0", "keywords": {"action": "continuous", "max_episode_steps": 300}}
    policies = ["random", {"name": "own_policy:RoomSeeker", "label": "room seeker"}]
    file = {"envs": [env], "policies": policies, "episodes": 4, "out": "results/own_policy"}
    for row in compare(file).rows:
        print(f"{row.policy}: {row.metrics['completeness'].interval.mean:.0%} of Env-1 mapped")
