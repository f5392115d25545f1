"""A reward of your own: a function of one step, in Python or as "module:function" in YAML; no change to the package.

python examples/own_reward.py
"""

import gymnasium as gym
import numpy as np

import lidarena
from lidarena.envs.rewards import Step


def curious_but_careful(step: Step) -> dict[str, float]:
    """Pay for every square metre that becomes known, and charge for driving closer to a wall than half a metre."""
    cell = step.info["resolution"] ** 2
    new = np.count_nonzero(step.info["map"] != -1) - np.count_nonzero(step.previous["map"] != -1)
    return {"new_area": cell * new, "closeness": -max(0.0, 0.5 - float(step.info["scan"].min()))}


env = gym.make("lidarena/Env1-v0", reward=curious_but_careful)
policy = lidarena.baselines.make("frontier", env)
observation, info = env.reset(seed=0)
policy.reset(seed=0)
earned: dict[str, float] = {}
for _ in range(200):
    observation, reward, terminated, truncated, info = env.step(policy.act(observation, info))
    for name, value in info["reward_terms"].items():
        earned[name] = earned.get(name, 0.0) + value
    if terminated or truncated:
        break
print(f"explored {info['completeness']:.0%}:", {name: round(value, 2) for name, value in earned.items()})
