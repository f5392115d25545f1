"""A trained network as a policy: the same two methods as every baseline."""

from collections.abc import Callable
from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from numpy.typing import NDArray
from stable_baselines3.common.policies import BasePolicy
from stable_baselines3.common.preprocessing import is_image_space
from stable_baselines3.common.vec_env.vec_transpose import VecTransposeImage

from lidarena.agents.acting import Memory, has_probabilities, is_squashed, output_of, pick, wants_masks
from lidarena.agents.observation_normalizer import ObservationNormalizer
from lidarena.base.errors import PolicyFileError

_NEVER = -1e8
"""Logit of an action that a mask rules out."""


class LearnedPolicy:
    """A trained agent; `lidarena.agents.load` makes it.

    Args:
        network: Stable-Baselines3's or sb3-contrib's policy.
        env_id: Gymnasium id of the environment that it was trained in.
        env_keywords: Keywords of that environment. Those that change what an observation or action means
            (``observation``, ``action``, …) belong to any environment that the policy is to drive in.
        training: What is known of the training: algorithm, steps, seed, and so on.
        deterministic: Whether `act` takes the most probable action or draws one.
        normalizer: Of the observations; None if the network sees them as they are.

    Raises:
        PolicyFileError: Actions are to be drawn from a network that gives no probabilities.

    Attributes:
        observation_space: Of the environment that it was trained in.
        action_space: Of that environment.
        memory: What a recurrent network remembers of the episode; None at its beginning, and for other networks.
    """

    def __init__(
        self,
        network: BasePolicy,
        env_id: str,
        env_keywords: dict[str, Any],
        training: dict[str, Any],
        deterministic: bool = True,
        normalizer: ObservationNormalizer | None = None,
    ) -> None:
        if not deterministic and not has_probabilities(network):
            raise PolicyFileError(
                "an agent of QRDQN has no probabilities from which an action could be drawn; "
                "load it with deterministic=True"
            )
        network.set_training_mode(False)
        self.network = network
        self.observation_space: spaces.Space[Any] = network.observation_space
        self.action_space: spaces.Space[Any] = network.action_space
        self.env_id = env_id
        self.env_keywords = env_keywords
        self.training = training
        self.deterministic = deterministic
        self.normalizer = normalizer
        self.memory: Memory | None = None
        self._masks: Callable[[], Any] | None = None
        self._rng = np.random.default_rng()

    def reset(self, seed: int | None = None) -> None:
        """Start an episode, of which nothing is remembered yet.

        Args:
            seed: Of the actions that are drawn; it changes nothing if ``deterministic``.
        """
        self._rng = np.random.default_rng(seed)
        self.memory = None

    def ask_for_masks(self, env: Any) -> None:
        """Take the masks of allowed actions from an environment, if the network was trained with masks.

        Raises:
            PolicyFileError: The environment has no ``action_masks()``.
        """
        if not wants_masks(self.network):
            return
        if hasattr(env, "has_wrapper_attr") and env.has_wrapper_attr("action_masks"):
            self._masks = env.get_wrapper_attr("action_masks")
        elif hasattr(env, "action_masks"):
            self._masks = env.action_masks
        else:
            raise PolicyFileError(
                f"the policy was trained in {self.env_id!r} with masks, but this environment has no action_masks()"
            )

    def act(self, observation: Any, info: dict[str, Any] | None = None) -> Any:
        """Choose an action.

        Args:
            observation: One world's, as the environment returned it.
            info: Read only where the network was trained with masks and was loaded without an environment: the mask is
                ``info["action_mask"]`` then.

        Returns:
            An int for a `Discrete` action space, else an array of the action space's shape, inside its bounds.

        Raises:
            PolicyFileError: The observation is not of the kind that the policy was trained on, or a mask is missing.
        """
        self._check(observation)
        if self.normalizer is not None:
            observation = self.normalizer.apply(observation)
        with torch.inference_mode():
            tensors, _ = self.network.obs_to_tensor(observation)
            values, log_std, self.memory = output_of(self.network, tensors, self.memory)
            if isinstance(self.action_space, spaces.Box):
                return self._number(values, log_std, self.action_space)
            logits = values.cpu().numpy()[0].astype(np.float64)
        return self._choice(logits, info or {})

    def _choice(self, logits: NDArray[np.float64], info: dict[str, Any]) -> Any:
        """The best of the allowed actions, or a draw from them (the Gumbel trick)."""
        space, masked = self.action_space, wants_masks(self.network)
        if masked:
            logits = np.where(self._mask(info, logits.size), logits, _NEVER)
        if not self.deterministic:
            logits = logits + self._rng.gumbel(size=logits.shape)
        if isinstance(space, spaces.Discrete):
            return int(np.argmax(logits))
        if isinstance(space, spaces.MultiDiscrete):
            return pick(logits, space.nvec.ravel().tolist()).astype(space.dtype).reshape(space.shape)
        if masked:  # two logits a bit
            return pick(logits, [2] * (logits.size // 2)).astype(space.dtype).reshape(space.shape)
        against = 0.0 if self.deterministic else self._rng.gumbel(size=logits.shape)
        return (logits > against).astype(space.dtype).reshape(space.shape)

    def _mask(self, info: dict[str, Any], size: int) -> NDArray[np.bool_]:
        mask = self._masks() if self._masks is not None else info.get("action_mask")
        if mask is None:
            raise PolicyFileError(
                f"the policy was trained in {self.env_id!r} with masks: load it with its environment, "
                "or give act() an info with 'action_mask'"
            )
        flat = np.asarray(mask, dtype=np.bool_).ravel()
        if flat.size != size:
            raise PolicyFileError(f"the policy was trained with masks of {size} actions, but this one has {flat.size}")
        return flat

    def _number(self, mean: torch.Tensor, log_std: torch.Tensor | None, space: spaces.Box) -> NDArray[Any]:
        """Mean of the Gaussian, or a draw from it; the policy's own generator makes a seed fix an episode."""
        numbers = mean.cpu().numpy()[0].astype(np.float64)
        if not self.deterministic and log_std is not None:
            deviation = np.exp(log_std.cpu().numpy().astype(np.float64)).reshape(numbers.shape)
            numbers = numbers + deviation * self._rng.standard_normal(numbers.shape)
        if is_squashed(self.network):
            squashed = torch.tanh(torch.as_tensor(numbers, dtype=torch.float32)).numpy().reshape(space.shape)
            numbers = np.asarray(self.network.unscale_action(squashed))
        action: NDArray[Any] = np.clip(numbers.reshape(space.shape), space.low, space.high).astype(space.dtype)
        return action

    def _check(self, observation: Any) -> None:
        """Refuse an observation of another environment before PyTorch gets lost in it."""
        space = self.observation_space
        if not isinstance(space, spaces.Dict):
            self._check_shape(observation, space, "the observation")
            return
        if not isinstance(observation, dict) or observation.keys() != space.spaces.keys():
            got = f"has keys {sorted(observation)}" if isinstance(observation, dict) else "is no dict"
            raise PolicyFileError(f"{self._whose()} keys {sorted(space.spaces)}, but the observation {got}")
        for key, sub in space.spaces.items():
            self._check_shape(observation[key], sub, f"observation[{key!r}]")

    def _check_shape(self, observation: Any, space: spaces.Space[Any], what: str) -> None:
        shape = None if isinstance(observation, dict) else np.shape(observation)
        if shape != space.shape and not _is_turned_picture(observation, space):
            got = f"a dict with keys {sorted(observation)}" if shape is None else f"of shape {shape}"
            raise PolicyFileError(f"{self._whose()} shape {space.shape}, but {what} is {got}")

    def _whose(self) -> str:
        return f"the policy was trained in {self.env_id!r} on observations of"


def _is_turned_picture(observation: Any, space: spaces.Space[Any]) -> bool:
    """Whether it is a picture (height, width, channels), which Stable-Baselines3 turns to (channels, height, width)."""
    picture = np.asarray(observation)
    turned = is_image_space(space) and picture.ndim == 3
    return turned and VecTransposeImage.transpose_image(picture).shape == space.shape
