"""A trained network as a policy: the same two methods as every baseline."""

from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from numpy.typing import NDArray
from stable_baselines3.common.policies import ActorCriticPolicy

from lidarena.base.errors import PolicyFileError


class LearnedPolicy:
    """A trained agent; `lidarena.agents.load` makes it.

    It carries no memory from step to step: what it knows of the past is in the observation.

    Attributes:
        network: Stable-Baselines3's policy.
        observation_space: Of the environment that it was trained in.
        action_space: Of the environment that it was trained in.
        env_id: Gymnasium id of that environment.
        env_keywords: Keywords of that environment. Those that change what an observation means (``observation``,
            ``reward``, ``action``) belong to any environment that the policy is to drive in.
        training: What is known of the training: steps, seed, and so on.
        deterministic: Whether `act` takes the most probable action or draws one.
    """

    def __init__(
        self,
        network: ActorCriticPolicy,
        env_id: str,
        env_keywords: dict[str, Any],
        training: dict[str, Any],
        deterministic: bool = True,
    ) -> None:
        network.set_training_mode(False)
        self.network = network
        self.observation_space: spaces.Space[Any] = network.observation_space
        self.action_space: spaces.Space[Any] = network.action_space
        self.env_id = env_id
        self.env_keywords = env_keywords
        self.training = training
        self.deterministic = deterministic
        self._rng = np.random.default_rng()

    def reset(self, seed: int | None = None) -> None:
        """Start an episode.

        Args:
            seed: Of the actions that are drawn; it changes nothing if ``deterministic``.
        """
        self._rng = np.random.default_rng(seed)

    def act(self, observation: Any, info: dict[str, Any] | None = None) -> Any:
        """Choose an action.

        Args:
            observation: One world's, as the environment returned it.
            info: Not read; every policy gets it.

        Returns:
            An int for a `Discrete` action space, else an array of the action space's shape, inside its bounds.

        Raises:
            PolicyFileError: The observation is not of the kind that the policy was trained on.
        """
        self._check(observation)
        space, network = self.action_space, self.network
        with torch.inference_mode():
            tensors, _ = network.obs_to_tensor(observation)
            features: Any = network.extract_features(tensors, network.pi_features_extractor)
            outputs = network.action_net(network.mlp_extractor.forward_actor(features))
            if isinstance(space, spaces.Discrete):
                return int(np.argmax(self._logits(outputs)))
            if isinstance(space, spaces.Box):
                return np.clip(self._numbers(outputs), space.low, space.high).astype(space.dtype).reshape(space.shape)
            if not self.deterministic:
                raise PolicyFileError(f"actions of {space} cannot be drawn; load the policy with deterministic=True")
            distribution = network.get_distribution(tensors)
            return distribution.get_actions(deterministic=True).cpu().numpy().reshape(space.shape)

    def _logits(self, outputs: torch.Tensor) -> NDArray[np.float64]:
        """Logits whose largest is the action: of the network, or shaken so that it is a draw (the Gumbel trick)."""
        logits: NDArray[np.float64] = outputs.cpu().numpy()[0].astype(np.float64)
        return logits if self.deterministic else logits + self._rng.gumbel(size=logits.shape)

    def _numbers(self, outputs: torch.Tensor) -> NDArray[np.float64]:
        """Mean of the Gaussian, or a draw from it; the policy's own generator makes a seed fix an episode."""
        mean: NDArray[np.float64] = outputs.cpu().numpy()[0].astype(np.float64)
        if self.deterministic:
            return mean
        deviation: NDArray[np.float64] = np.exp(self.network.log_std.cpu().numpy().astype(np.float64))
        return mean + deviation * self._rng.standard_normal(mean.shape)

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
        if shape != space.shape:
            got = f"a dict with keys {sorted(observation)}" if shape is None else f"of shape {shape}"
            raise PolicyFileError(f"{self._whose()} shape {space.shape}, but {what} is {got}")

    def _whose(self) -> str:
        return f"the policy was trained in {self.env_id!r} on observations of"
