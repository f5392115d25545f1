"""Small networks of Stable-Baselines3, hardly trained."""

from typing import Any

from stable_baselines3 import PPO

from lidarena.agents.vec_env import BatchVecEnv
from tests.agents.fake_batch import RestorableLineBatch


def make_model(
    kind: str = "MlpPolicy", env: dict[str, Any] | None = None, network: dict[str, Any] | None = None
) -> PPO:
    batch = BatchVecEnv(RestorableLineBatch(2, **env or {}))
    model = PPO(kind, batch, policy_kwargs=network or {}, n_steps=32, batch_size=32, n_epochs=1, seed=0)
    return model.learn(64)
