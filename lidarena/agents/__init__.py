"""Learned agents: training, checkpoints, policy files.

    from lidarena import agents

    config = agents.load_config("configs/train/quick.yaml", agents.TrainingConfig, ["seed=1"])
    folder = agents.train(config)
    policy = agents.load(folder, env)

PyTorch and Stable-Baselines3 are imported when one of these names is used for the first time.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lidarena.agents.interruption import TrainingStopped
    from lidarena.agents.learned_policy import LearnedPolicy
    from lidarena.agents.loading import load, ready
    from lidarena.agents.policy_file import save_policy
    from lidarena.agents.seeds import train_seeds
    from lidarena.agents.shipped import pretrained
    from lidarena.agents.training import train
    from lidarena.agents.training_config import TrainingConfig
    from lidarena.agents.vec_env import BatchVecEnv
    from lidarena.base.yaml_config import ConfigModel, dump_config, load_config

__all__ = [
    "BatchVecEnv",
    "ConfigModel",
    "LearnedPolicy",
    "TrainingConfig",
    "TrainingStopped",
    "dump_config",
    "load",
    "load_config",
    "pretrained",
    "ready",
    "save_policy",
    "train",
    "train_seeds",
]

_HOMES = {
    "BatchVecEnv": "lidarena.agents.vec_env",
    "ConfigModel": "lidarena.base.yaml_config",
    "LearnedPolicy": "lidarena.agents.learned_policy",
    "TrainingConfig": "lidarena.agents.training_config",
    "TrainingStopped": "lidarena.agents.interruption",
    "dump_config": "lidarena.base.yaml_config",
    "load": "lidarena.agents.loading",
    "load_config": "lidarena.base.yaml_config",
    "pretrained": "lidarena.agents.shipped",
    "ready": "lidarena.agents.loading",
    "save_policy": "lidarena.agents.policy_file",
    "train": "lidarena.agents.training",
    "train_seeds": "lidarena.agents.seeds",
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(import_module(_HOMES[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
