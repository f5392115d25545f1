"""What a network of each kind says to an observation, before an action is made of it."""

from typing import Any, NamedTuple

import numpy as np
import torch
from numpy.typing import NDArray
from sb3_contrib.common.maskable.policies import MaskableActorCriticPolicy
from sb3_contrib.common.recurrent.policies import RecurrentActorCriticPolicy
from sb3_contrib.qrdqn.policies import QRDQNPolicy
from stable_baselines3.common.policies import BasePolicy

Memory = tuple[torch.Tensor, torch.Tensor]
"""Hidden and cell state of an LSTM, each (layers, 1, units)."""


class Output(NamedTuple):
    """What the last layer says.

    Attributes:
        values: (actions,) logits or values of actions to choose from; of a Box the means, as a tensor (1, actions).
        log_std: (1, actions) of the Gaussian around the means; None for choices.
        memory: Of a recurrent network after this observation.
    """

    values: torch.Tensor
    log_std: torch.Tensor | None = None
    memory: Memory | None = None


def is_recurrent(network: BasePolicy) -> bool:
    """Whether a network remembers what it has seen."""
    return isinstance(network, RecurrentActorCriticPolicy)


def wants_masks(network: BasePolicy) -> bool:
    """Whether a network was trained to be told which actions are allowed."""
    return isinstance(network, MaskableActorCriticPolicy)


def has_probabilities(network: BasePolicy) -> bool:
    """Whether actions can be drawn; a network of values only knows the best one."""
    return not isinstance(network, QRDQNPolicy)


def is_squashed(network: BasePolicy) -> bool:
    """Whether the means and draws go through tanh, into [-1, 1], and are scaled to the bounds of the actions."""
    return hasattr(network, "actor")


def output_of(network: BasePolicy, observation: Any, memory: Memory | None = None) -> Output:
    """Ask a network.

    Args:
        network: Of one of the six algorithms.
        observation: As tensors, a batch of one.
        memory: Of a recurrent network, None at the beginning of an episode.
    """
    own: Any = network
    if isinstance(network, QRDQNPolicy):
        return Output(network.quantile_net(observation).mean(dim=1))
    if is_squashed(network):
        mean, log_std, _ = own.actor.get_action_dist_params(observation)
        return Output(mean, log_std)
    features = own.extract_features(observation, own.pi_features_extractor)
    if is_recurrent(network):
        features, memory = _remember(own, features, memory)
    return Output(own.action_net(own.mlp_extractor.forward_actor(features)), getattr(own, "log_std", None), memory)


def _remember(network: Any, features: torch.Tensor, memory: Memory | None) -> tuple[torch.Tensor, Memory]:
    """What the actor's LSTM makes of features and memory."""
    if memory is None:
        memory = (torch.zeros(network.lstm_hidden_state_shape), torch.zeros(network.lstm_hidden_state_shape))
    latent, after = network._process_sequence(features, memory, torch.zeros(1), network.lstm_actor)
    return latent, after


def pick(logits: NDArray[np.float64], sizes: list[int]) -> NDArray[np.int64]:
    """The largest of every choice's logits, which are one after the other."""
    parts = np.split(logits, np.cumsum(sizes)[:-1])
    return np.array([np.argmax(part) for part in parts], dtype=np.int64)
