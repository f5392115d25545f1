"""Whole drives as bytes, alone and in a batch, to be compared to the bit."""

from collections.abc import Iterable
from typing import Any

import gymnasium as gym
import numpy as np

from lidarena.envs.infos import row_of


def raw(value: Any) -> bytes:
    """The bits of arrays, numbers and dictionaries of them."""
    if isinstance(value, dict):
        return b"".join(raw(value[key]) for key in sorted(value))
    return np.asarray(value).tobytes()


def world_of(infos: dict[str, Any], k: int) -> dict[str, Any]:
    """What a batch's infos tell of one world."""
    own = {name: value for name, value in infos.items() if not name.startswith(("_", "final"))}
    return {name: world_of(v, k) if isinstance(v, dict) else v[k] for name, v in own.items()}


def alone(env: gym.Env, actions: Iterable[Any], seed: int) -> tuple[list[bytes], list[dict[str, Any]]]:
    """A single environment's drive, and the infos in which its episodes ended."""
    observation, info = env.reset(seed=seed)
    record, endings = [raw(observation) + raw(info)], []
    for action in actions:
        observation, reward, terminated, truncated, info = env.step(action)
        ended = b""
        if terminated or truncated:
            endings.append(info)
            last = {name: value for name, value in info.items() if name != "map"}  # batches do not keep it
            ended = raw(observation) + raw(last)
            observation, info = env.reset()
        record.append(raw(observation) + raw(info) + ended + raw([reward, terminated, truncated]))
    return record, endings


def together(batch: gym.vector.VectorEnv, table: np.ndarray) -> list[list[bytes]]:
    """The drives of all worlds of a batch; ``table`` (steps, worlds, …) are their actions."""
    observations, infos = batch.reset(seed=0)
    worlds = range(batch.num_envs)
    records = [[raw(row_of(observations, k)) + raw(world_of(infos, k))] for k in worlds]
    for actions in table:
        observations, rewards, terminated, truncated, infos = batch.step(actions)
        for k in worlds:
            ended = b""
            if terminated[k] or truncated[k]:
                ended = raw(row_of(infos["final_obs"], k)) + raw(world_of(infos["final_info"], k))
            end = raw([rewards[k], terminated[k], truncated[k]])
            records[k].append(raw(row_of(observations, k)) + raw(world_of(infos, k)) + ended + end)
    return records
