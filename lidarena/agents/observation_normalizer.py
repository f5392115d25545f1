"""Observations shifted and scaled to mean 0, deviation 1: while training, and the same by the loaded policy."""

from collections.abc import Mapping
from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from numpy.typing import NDArray
from stable_baselines3.common.preprocessing import is_image_space
from stable_baselines3.common.running_mean_std import RunningMeanStd
from stable_baselines3.common.vec_env import VecNormalize

from lidarena.base.errors import ConfigError

CLIP = 10.0
"""Deviations beyond which a normalized number is cut off."""
EPSILON = 1e-8
"""Added to the variance, so that a number that never changes becomes 0."""
PREFIX = "observation_normalizer."
"""What the names of its arrays begin with in a policy file."""


class ObservationNormalizer:
    """Running mean and variance of an observation's numbers, as they were at the end of the training.

    Args:
        means: By the keys of a dictionary of observations; under ``""`` for a plain one.
        variances: The same.
    """

    def __init__(self, means: Mapping[str, NDArray[np.float64]], variances: Mapping[str, NDArray[np.float64]]) -> None:
        self._means, self._variances = dict(means), dict(variances)

    def apply(self, observation: Any) -> Any:
        """Return the observation, array or dictionary, with its numbers normalized; pictures stay as they are."""
        if "" in self._means:
            return self._normalized("", observation)
        return {
            key: self._normalized(key, value) if key in self._means else value for key, value in observation.items()
        }

    def _normalized(self, key: str, values: Any) -> NDArray[np.float32]:
        scaled = (values - self._means[key]) / np.sqrt(self._variances[key] + EPSILON)
        normalized: NDArray[np.float32] = np.clip(scaled, -CLIP, CLIP).astype(np.float32)
        return normalized

    def tensors(self) -> dict[str, torch.Tensor]:
        """The arrays under the names that a policy file gives them."""
        both = {"mean": self._means, "variance": self._variances}
        return {
            f"{PREFIX}{what}.{key}": torch.from_numpy(np.array(array))
            for what, arrays in both.items()
            for key, array in arrays.items()
        }

    @classmethod
    def from_tensors(cls, tensors: Mapping[str, torch.Tensor], space: spaces.Space[Any]) -> "ObservationNormalizer":
        """Make it from a policy file.

        Raises:
            ValueError: The arrays do not fit the observations, or are not finite.
        """
        means, variances = (
            {name.removeprefix(start): tensor.numpy() for name, tensor in tensors.items() if name.startswith(start)}
            for start in (f"{PREFIX}mean.", f"{PREFIX}variance.")
        )
        parts: dict[str, Any] = {**space.spaces} if isinstance(space, spaces.Dict) else {"": space}
        if means.keys() != variances.keys() or not means.keys() <= parts.keys() or not means:
            raise ValueError("the means and variances of the observations do not belong together")
        for key, array in [*means.items(), *variances.items()]:
            if array.shape != parts[key].shape or not np.isfinite(array).all():
                raise ValueError(f"the mean or variance of observation {key!r} has another shape, or is not finite")
        return cls(means, variances)

    @classmethod
    def of(cls, env: VecNormalize | None) -> "ObservationNormalizer | None":
        """Return what a training has found out so far; None where observations are not normalized."""
        if env is None or not env.norm_obs:
            return None
        running = running_statistics(env)
        return cls(
            {key: np.array(one.mean) for key, one in running.items()},
            {key: np.array(one.var) for key, one in running.items()},
        )


def running_statistics(env: VecNormalize) -> dict[str, RunningMeanStd]:
    """Stable-Baselines3's own statistics of the observations by key, ``""`` for a plain one; none without them."""
    if not env.norm_obs:
        return {}
    return {**env.obs_rms} if isinstance(env.obs_rms, dict) else {"": env.obs_rms}


def keys_to_normalize(space: spaces.Space[Any]) -> list[str] | None:
    """Which parts of a dictionary of observations are numbers; None for a plain observation.

    Raises:
        ConfigError: There are no numbers to normalize.
    """
    parts = {**space.spaces} if isinstance(space, spaces.Dict) else {"": space}
    keys = [key for key, part in parts.items() if isinstance(part, spaces.Box) and not is_image_space(part)]
    if not keys:
        raise ConfigError(
            f"'normalize_observation' is true, but observations of {space} hold no numbers to normalize; "
            "leave it out, pictures are scaled by the network"
        )
    return keys if isinstance(space, spaces.Dict) else None
