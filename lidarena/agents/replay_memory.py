"""The memory of transitions of QRDQN, SAC and TQC in a checkpoint."""

from typing import Any

import numpy as np
from numpy.typing import NDArray
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.buffers import ReplayBuffer
from stable_baselines3.common.off_policy_algorithm import OffPolicyAlgorithm

Arrays = dict[str, NDArray[Any]]

LARGEST = 2 * 2**30
"""Bytes of a memory beyond which checkpoints leave it out: it would take minutes to write, and fill disks."""

_NAMES = ("observations", "next_observations", "actions", "rewards", "dones", "timeouts")


def memory_of(model: BaseAlgorithm) -> Arrays:
    """What a learner remembers, as far as it has been filled; nothing if it has no memory, or one beyond `LARGEST`."""
    buffer = _buffer(model)
    if buffer is None or _size(buffer) > LARGEST:
        return {}
    filled = {name: array[: buffer.size()] for name, array in _arrays(buffer).items()}
    return filled | {"position": np.array([buffer.pos, buffer.full], dtype=np.int64)}


def set_memory(arrays: Arrays, model: BaseAlgorithm) -> str | None:
    """Put back what `memory_of` returned.

    Returns:
        What is lost, as the end of a sentence; None if nothing is.
    """
    buffer = _buffer(model)
    if buffer is None or not isinstance(model, OffPolicyAlgorithm):
        return None
    if not arrays:
        model.learning_starts += model.num_timesteps
        return (
            f"the memory of transitions, which was too large for a checkpoint: it fills anew with random actions up to "
            f"step {model.learning_starts:,}"
        )
    for name, array in _arrays(buffer).items():
        array[: len(arrays[name])] = arrays[name]
    buffer.pos, buffer.full = int(arrays["position"][0]), bool(arrays["position"][1])
    return None


def _buffer(model: BaseAlgorithm) -> ReplayBuffer | None:
    return model.replay_buffer if isinstance(model, OffPolicyAlgorithm) else None


def _arrays(buffer: ReplayBuffer) -> Arrays:
    """The arrays of a memory by name, those of dictionaries with a dot."""
    arrays: Arrays = {}
    for name in _NAMES:
        held: Any = getattr(buffer, name)
        arrays |= {f"{name}.{key}": part for key, part in held.items()} if isinstance(held, dict) else {name: held}
    return arrays


def _size(buffer: ReplayBuffer) -> int:
    """Bytes of what has been filled."""
    return sum(array[: buffer.size()].nbytes for array in _arrays(buffer).values())
