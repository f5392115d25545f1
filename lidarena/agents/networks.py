"""Stable-Baselines3's policy networks: their names, how one is described and rebuilt, and their weights as tensors."""

from collections.abc import Mapping
from typing import Any, get_args

import torch
from gymnasium import spaces
from pydantic import ConfigDict, Field
from stable_baselines3.common.policies import (
    ActorCriticCnnPolicy,
    ActorCriticPolicy,
    MultiInputActorCriticPolicy,
)
from stable_baselines3.common.preprocessing import is_image_space
from stable_baselines3.common.torch_layers import CombinedExtractor, FlattenExtractor, NatureCNN
from torch import nn

from lidarena.agents.candidate_policy import CandidatePolicy
from lidarena.agents.training_config import Activation, Layers, PolicyClass, PolicyConfig
from lidarena.base.errors import ConfigError, PolicyFileError
from lidarena.base.yaml_config import ConfigModel

ACTIVATIONS: dict[str, type[nn.Module]] = {
    "tanh": nn.Tanh,
    "relu": nn.ReLU,
    "leaky_relu": nn.LeakyReLU,
    "elu": nn.ELU,
    "silu": nn.SiLU,
    "gelu": nn.GELU,
}
"""Activation functions by their names in YAML."""

_CLASSES: dict[PolicyClass, type[ActorCriticPolicy]] = {
    "MlpPolicy": ActorCriticPolicy,
    "CnnPolicy": ActorCriticCnnPolicy,
    "MultiInputPolicy": MultiInputActorCriticPolicy,
    "CandidatePolicy": CandidatePolicy,
}

_EXTRACTORS = (FlattenExtractor, NatureCNN, CombinedExtractor)


class Architecture(ConfigModel):
    """Everything that `rebuild` needs besides the spaces.

    Attributes:
        class_name: ``class`` in a file; Stable-Baselines3's name.
        net_arch: Widths of the hidden layers, for both or for ``pi`` (actor) and ``vf`` (critic).
        activation: Between the layers.
    """

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True)

    class_name: PolicyClass = Field(alias="class")
    net_arch: Layers | dict[str, Layers]
    activation: Activation


def class_for(config: PolicyConfig, observation_space: spaces.Space[Any]) -> PolicyClass:
    """Choose the policy class for an observation, or check the one that is asked for.

    Raises:
        ConfigError: The class cannot read such observations.
    """
    if isinstance(observation_space, spaces.Dict):
        right: PolicyClass = "MultiInputPolicy"
    else:
        right = "CnnPolicy" if is_image_space(observation_space) else "MlpPolicy"
    wanted = config.class_name
    if wanted == "CandidatePolicy" and isinstance(observation_space, spaces.Box) and len(observation_space.shape) == 2:
        return wanted
    if wanted == "auto" or wanted == right or (wanted == "MlpPolicy" and right == "CnnPolicy"):
        return right if wanted == "auto" else wanted
    raise ConfigError(f"'policy.class' is {wanted!r}, but observations of {observation_space} need {right!r}")


def policy_class(name: PolicyClass) -> type[ActorCriticPolicy]:
    """Return the class of that name."""
    return _CLASSES[name]


def describe(network: ActorCriticPolicy) -> Architecture:
    """Describe a network so that `rebuild` makes its like.

    Raises:
        PolicyFileError: It is not one of Stable-Baselines3's three policies as they come.
    """
    names: list[PolicyClass] = [name for name, kind in _CLASSES.items() if type(network) is kind]
    activations = [name for name, kind in ACTIVATIONS.items() if network.activation_fn is kind]
    plain = not network.use_sde and network.share_features_extractor and not network.features_extractor_kwargs
    plain = plain and network.features_extractor_class in _EXTRACTORS
    if not names or not activations or not plain:
        raise PolicyFileError(
            f"a network of class {type(network).__name__} cannot be written to a policy file; it should be one of "
            f"{', '.join(get_args(PolicyClass))} without options of its own beyond net_arch and activation"
        )
    return Architecture.model_validate({"class": names[0], "net_arch": network.net_arch, "activation": activations[0]})


def rebuild(
    architecture: Architecture, observation_space: spaces.Space[Any], action_space: spaces.Space[Any]
) -> ActorCriticPolicy:
    """Make a network with random weights on the CPU.

    Raises:
        PolicyFileError: Such a network cannot read these observations or give these actions.
    """
    kind = _CLASSES[architecture.class_name]
    with torch.random.fork_rng(
        devices=[]
    ):  # the weights are drawn, then overwritten: no business of the caller's stream
        try:
            return kind(
                observation_space,
                action_space,
                lambda _: 0.0,
                net_arch=architecture.net_arch,
                activation_fn=ACTIVATIONS[architecture.activation],
            )
        except (ArithmeticError, AssertionError, AttributeError, LookupError, MemoryError) as error:
            raise _unbuildable(architecture, observation_space, error) from None
        except (NotImplementedError, RuntimeError, TypeError, ValueError) as error:
            raise _unbuildable(architecture, observation_space, error) from None


def _unbuildable(architecture: Architecture, space: spaces.Space[Any], error: Exception) -> PolicyFileError:
    reason = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
    return PolicyFileError(f"a {architecture.class_name} cannot be built for observations of {space}: {reason}")


def weights_of(network: nn.Module) -> dict[str, torch.Tensor]:
    """Return the weights by name, each once, even if the network knows it under several names."""
    seen: set[tuple[int, torch.Size]] = set()
    unique = {}
    for name, tensor in network.state_dict().items():
        place = (tensor.data_ptr(), tensor.shape)
        if place not in seen or tensor.numel() == 0:
            seen.add(place)
            unique[name] = tensor.detach()
    return unique


def set_weights(network: nn.Module, weights: Mapping[str, torch.Tensor]) -> None:
    """Copy weights into a network.

    Raises:
        ValueError: A name, shape or type differs, or a weight is not finite; the network is unchanged then.
    """
    targets = weights_of(network)
    if targets.keys() != weights.keys():
        odd = sorted(targets.keys() ^ weights.keys())[0]
        raise ValueError(f"the weight {odd!r} is {'missing' if odd in targets else 'one too many'}")
    for name, target in targets.items():
        if target.shape != weights[name].shape or target.dtype != weights[name].dtype:
            raise ValueError(
                f"the weight {name!r} is {tuple(weights[name].shape)} of {weights[name].dtype}, "
                f"not {tuple(target.shape)} of {target.dtype}"
            )
    if not all_finite(weights):
        raise ValueError("some weights are not finite numbers")
    for name, target in targets.items():
        target.copy_(weights[name])


def all_finite(weights: Mapping[str, torch.Tensor]) -> bool:
    """Whether no weight is NaN or infinite."""
    return all(bool(torch.isfinite(tensor).all()) for tensor in weights.values())
