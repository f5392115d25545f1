"""A family of one's own: its environment, and what is measured and drawn of it, compared as the built-in ones are."""

import gymnasium as gym
import numpy as np

from lidarena.envs.registration import Family, Registration, register_family
from lidarena.evaluation import FamilyMeasures, Measure, RobotTrace, compare


class Buoys(gym.Env):
    """A boat rounds one buoy after the other."""

    family = "buoys"
    observation_space, action_space = gym.spaces.Box(-20, 20, (2,)), gym.spaces.Box(-1, 1, (2,))

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.boat, self.rounded, self.buoy = np.zeros(2), 0, self.np_random.uniform(-9, 9, 2)
        return self.observe()

    def step(self, action):
        self.boat = np.clip(self.boat + action, -10, 10)
        near = np.linalg.norm(self.buoy - self.boat) < 1.0
        if near:
            self.rounded, self.buoy = self.rounded + 1, self.np_random.uniform(-9, 9, 2)
        observation, info = self.observe()
        return observation, float(near), False, False, info

    def observe(self):
        return (self.buoy - self.boat).astype(np.float32), {"pose": np.append(self.boat, 0.0), "buoys": self.rounded}


class BuoyMeasures(FamilyMeasures):
    columns = (Measure("buoys", "Buoys rounded", better="high", main=True),)  # info["buoys"] at the end
    kept = ("pose",)  # of every step

    def picture(self, recording):
        return RobotTrace(recording.positions("pose"))


class Straight:
    def __init__(self, env):
        self.reset()

    def reset(self, seed=None):
        pass

    def act(self, observation, info):
        return observation / max(1.0, np.abs(observation).max())


MEASURES = BuoyMeasures()
ENTRY = Registration("own_family:Buoys", max_episode_steps=200)
register_family(Family("buoys", {"own/Buoys-v0": ENTRY}, measures="own_family:MEASURES"))

if __name__ == "__main__":
    file = {"envs": ["own_family:own/Buoys-v0"], "policies": ["random", "own_family:Straight"]}
    for row in compare(file | {"out": "results/own_family"}).rows:
        print(f"{row.policy}: {row.metrics['buoys'].interval.mean:.1f} buoys")
