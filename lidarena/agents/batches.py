"""The batch of worlds that a training steps: an environment's own, or its worlds one after the other."""

import importlib
import warnings
from functools import partial
from typing import Any

import gymnasium as gym
from gymnasium.envs.registration import EnvSpec
from gymnasium.vector import AutoresetMode, VectorEnv

from lidarena.agents.sync_worlds import SyncWorlds
from lidarena.agents.training_config import EnvironmentConfig
from lidarena.agents.vec_env import BatchVecEnv
from lidarena.base.errors import ConfigError, LidarenaError, suggest


def make_batch(env: EnvironmentConfig, num_envs: int) -> BatchVecEnv:
    """Make a batch of worlds for Stable-Baselines3.

    It is the environment's own where there is one whose worlds restart in the step in which they end, and else a
    `SyncWorlds` of single environments.

    Raises:
        ConfigError: There is no such environment or keyword, or neither kind can be made.
    """
    spec = _spec(env.id)
    try:
        return BatchVecEnv(_own_batch(spec, env, num_envs) or _singles(spec, env, num_envs))
    except LidarenaError:
        raise
    except (TypeError, NotImplementedError, RuntimeError, gym.error.Error) as error:
        reason = (str(error) or type(error).__name__).splitlines()[0]
        raise ConfigError(f"the environment {env.id!r} cannot be made: {reason}") from None


def _own_batch(spec: EnvSpec, env: EnvironmentConfig, num_envs: int) -> VectorEnv[Any, Any, Any] | None:
    """The environment's own batch; None where there is none, or one that restarts late beside single worlds."""
    if spec.vector_entry_point is None:
        return None
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="the vector statistics of gymnasium")  # `BatchVecEnv` counts itself
        own = gym.make_vec(spec.id, num_envs, vectorization_mode="vector_entry_point", **env.keywords)
    if spec.entry_point is None or own.metadata.get("autoreset_mode") is AutoresetMode.SAME_STEP:
        return own
    own.close()
    return None


def _singles(spec: EnvSpec, env: EnvironmentConfig, num_envs: int) -> VectorEnv[Any, Any, Any]:
    return SyncWorlds([partial(gym.make, spec.id, **env.keywords)] * num_envs)


def _spec(env_id: str) -> EnvSpec:
    """What is registered under an id, the module before its colon imported."""
    module, _, name = env_id.rpartition(":")
    try:
        if module:
            importlib.import_module(module)
        return gym.spec(name)
    except ModuleNotFoundError:
        raise ConfigError(f"'env.id' is {env_id!r}, but the module {module!r} cannot be imported") from None
    except gym.error.Error:
        known = [known for known in gym.registry if known.partition("/")[0] in ("lidarena", name.partition("/")[0])]
        raise ConfigError(f"there is no environment {env_id!r}{suggest(name, known)}") from None
