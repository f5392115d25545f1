"""An environment of one's own trains like the built-in ones, here with PPO that knows which actions are allowed."""

import tempfile

import gymnasium as gym
import numpy as np

from lidarena import agents
from lidarena.evaluation import run_episode


class Walk(gym.Env):
    """Walk right from 0 to 10; at 0 there is no way back."""

    observation_space, action_space = gym.spaces.Box(0, 10, (1,), np.float32), gym.spaces.Discrete(2)

    def reset(self, *, seed=None, options=None):
        super().reset(seed=seed)
        self.place = 0
        return np.array([0], np.float32), {}

    def step(self, action):
        self.place += 1 if action == 1 else -1
        success = self.place == 10
        return np.array([self.place], np.float32), float(success) - 0.1, success, False, {"success": success}

    def action_masks(self):
        return np.array([self.place > 0, True])


gym.register("own/Walk-v0", entry_point=Walk, max_episode_steps=40)

# from YAML: env: {id: "own_environment:own/Walk-v0"}
if __name__ == "__main__":
    settings = {"env": "own/Walk-v0", "algorithm": "MaskablePPO", "num_envs": 4, "total_steps": 4096}
    settings |= {"maskable_ppo": {"n_steps": 64}, "out": f"{tempfile.mkdtemp()}/walk"}
    env = gym.make("own/Walk-v0")
    policy = agents.load(agents.train(settings, progress=False), env)
    print(f"the trained agent needs {run_episode(env, policy, seed=0).measures['steps']:.0f} steps")
