"""A trained network as a policy: the same two methods as every baseline."""

from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from numpy.typing import NDArray
from stable_baselines3.common.distributions import CategoricalDistribution, DiagGaussianDistribution
from stable_baselines3.common.policies import ActorCriticPolicy

from lidarena.world.refusals import PolicyFileError


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
        with torch.no_grad():
            tensors, _ = self.network.obs_to_tensor(observation)
            distribution = self.network.get_distribution(tensors)
            if self.deterministic:
                action = distribution.get_actions(deterministic=True).cpu().numpy()[0]
            else:
                action = self._draw(distribution)
        if isinstance(self.action_space, spaces.Discrete):
            return int(action)
        if isinstance(self.action_space, spaces.Box):
            return np.clip(action, self.action_space.low, self.action_space.high).astype(self.action_space.dtype)
        return action.reshape(self.action_space.shape)

    def _draw(self, distribution: Any) -> NDArray[Any]:
        """Draw an action from the policy's own generator, so that a seed fixes an episode."""
        if isinstance(distribution, CategoricalDistribution):
            logits = distribution.distribution.logits.cpu().numpy()[0].astype(np.float64)
            return np.asarray(np.argmax(logits + self._rng.gumbel(size=logits.shape)))
        if isinstance(distribution, DiagGaussianDistribution):
            mean, deviation = (
                tensor.cpu().numpy()[0] for tensor in (distribution.distribution.mean, distribution.distribution.stddev)
            )
            return np.asarray(mean + deviation * self._rng.standard_normal(mean.shape))
        raise PolicyFileError(
            f"actions of {self.action_space} can only be taken with deterministic=True, the most probable one"
        )

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
