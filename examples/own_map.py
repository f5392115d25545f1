"""A map generator of one's own: every episode explores another hall, with pillars where chance puts them."""

import gymnasium as gym
import numpy as np

import lidarena
from lidarena.world.floorplan import Floorplan

WIDTH, HEIGHT = 8.0, 6.0  # metres
WALLS = [(0, 0, WIDTH, 0), (WIDTH, 0, WIDTH, HEIGHT), (WIDTH, HEIGHT, 0, HEIGHT), (0, HEIGHT, 0, 0)]


def hall(rng: np.random.Generator) -> Floorplan:
    """Draw a hall with 3 to 7 pillars; nothing random but from rng, so that a seed always gives the same hall."""
    count = rng.integers(3, 8)
    places = rng.uniform((1.5, 1.0), (WIDTH - 1.0, HEIGHT - 1.0), (count, 2))
    pillars = np.column_stack([places, rng.uniform(0.15, 0.4, count)])
    return Floorplan.from_shapes("hall", (0, 0, WIDTH, HEIGHT), WALLS, circles=pillars, start=(0.6, 0.6, 0.0))


if __name__ == "__main__":
    env = gym.make("lidarena/Exploration-v0", map=hall, max_episode_steps=200)  # from YAML: map: "own_map:hall"
    policy = lidarena.baselines.make("frontier", env)
    for seed in range(3):
        observation, info = env.reset(seed=seed)
        policy.reset(seed=seed)
        done = False
        while not done:
            observation, reward, terminated, truncated, info = env.step(policy.act(observation, info))
            done = terminated or truncated
        pillars = len(env.unwrapped.floorplan.circles)
        print(f"hall {seed} with {pillars} pillars: {info['completeness']:.0%} mapped in {info['time']:.0f} s")
