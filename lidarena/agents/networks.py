"""The networks of Stable-Baselines3 and sb3-contrib: their names, and how one is described and rebuilt."""

from typing import Any, Literal, get_args

import torch
from gymnasium import spaces
from pydantic import ConfigDict, Field
from sb3_contrib import qrdqn, tqc
from sb3_contrib.common.maskable.policies import (
    MaskableActorCriticCnnPolicy,
    MaskableActorCriticPolicy,
    MaskableMultiInputActorCriticPolicy,
)
from sb3_contrib.common.recurrent.policies import (
    RecurrentActorCriticCnnPolicy,
    RecurrentActorCriticPolicy,
    RecurrentMultiInputActorCriticPolicy,
)
from stable_baselines3 import sac
from stable_baselines3.common.policies import (
    ActorCriticCnnPolicy,
    ActorCriticPolicy,
    BasePolicy,
    MultiInputActorCriticPolicy,
)
from stable_baselines3.common.preprocessing import is_image_space
from stable_baselines3.common.torch_layers import CombinedExtractor, FlattenExtractor, NatureCNN
from torch import nn

from lidarena.agents.candidate_policy import CandidatePolicy
from lidarena.agents.learner_config import Algorithm
from lidarena.agents.training_config import Activation, Layers, PolicyClass, TrainingConfig, Width
from lidarena.base.errors import ConfigError, PolicyFileError
from lidarena.base.yaml_config import ConfigModel

Size = Literal["lstm_hidden_size", "n_lstm_layers", "shared_lstm", "enable_critic_lstm", "n_quantiles", "n_critics"]

ACTIVATIONS: dict[str, type[nn.Module]] = {
    "tanh": nn.Tanh,
    "relu": nn.ReLU,
    "leaky_relu": nn.LeakyReLU,
    "elu": nn.ELU,
    "silu": nn.SiLU,
    "gelu": nn.GELU,
}
"""Activation functions by their names in YAML."""

_NETWORKS: dict[Algorithm, dict[PolicyClass, type[BasePolicy]]] = {
    "PPO": {
        "MlpPolicy": ActorCriticPolicy,
        "CnnPolicy": ActorCriticCnnPolicy,
        "MultiInputPolicy": MultiInputActorCriticPolicy,
        "CandidatePolicy": CandidatePolicy,
    },
    "MaskablePPO": {
        "MlpPolicy": MaskableActorCriticPolicy,
        "CnnPolicy": MaskableActorCriticCnnPolicy,
        "MultiInputPolicy": MaskableMultiInputActorCriticPolicy,
    },
    "RecurrentPPO": {
        "MlpPolicy": RecurrentActorCriticPolicy,
        "CnnPolicy": RecurrentActorCriticCnnPolicy,
        "MultiInputPolicy": RecurrentMultiInputActorCriticPolicy,
    },
    "QRDQN": {
        "MlpPolicy": qrdqn.policies.QRDQNPolicy,
        "CnnPolicy": qrdqn.CnnPolicy,
        "MultiInputPolicy": qrdqn.MultiInputPolicy,
    },
    "SAC": {"MlpPolicy": sac.policies.SACPolicy, "CnnPolicy": sac.CnnPolicy, "MultiInputPolicy": sac.MultiInputPolicy},
    "TQC": {"MlpPolicy": tqc.policies.TQCPolicy, "CnnPolicy": tqc.CnnPolicy, "MultiInputPolicy": tqc.MultiInputPolicy},
}
"""The libraries' networks."""

SIZES: dict[Algorithm, tuple[Size, ...]] = {
    "RecurrentPPO": ("lstm_hidden_size", "n_lstm_layers", "shared_lstm", "enable_critic_lstm"),
    "QRDQN": ("n_quantiles",),
    "SAC": ("n_critics",),
    "TQC": ("n_quantiles", "n_critics"),
}
"""What in a learner's block belongs to its network."""

_EXTRACTORS = (FlattenExtractor, NatureCNN, CombinedExtractor)


class Architecture(ConfigModel):
    """Everything that `rebuild` needs besides the spaces.

    Attributes:
        algorithm: That the network is of.
        class_name: ``class`` in a file; the library's name.
        net_arch: Widths of the hidden layers, for both or for ``pi`` (actor) and ``vf`` or ``qf`` (critic).
        activation: Between the layers.
        sizes: See `SIZES`.
    """

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True)

    algorithm: Algorithm = "PPO"
    class_name: PolicyClass = Field(alias="class")
    net_arch: Layers | dict[str, Layers]
    activation: Activation
    sizes: dict[Size, bool | Width] = Field(default_factory=dict)


def class_for(config: TrainingConfig, observation_space: spaces.Space[Any]) -> PolicyClass:
    """Choose the policy class for an observation, or check the one that is asked for.

    Raises:
        ConfigError: The class cannot read such observations, or is not one of the algorithm's.
    """
    if isinstance(observation_space, spaces.Dict):
        right: PolicyClass = "MultiInputPolicy"
    else:
        right = "CnnPolicy" if is_image_space(observation_space) else "MlpPolicy"
    wanted = config.policy.class_name
    if wanted == "CandidatePolicy" and config.algorithm != "PPO":
        raise ConfigError(f"'policy.class' is {wanted!r}, but 'algorithm' is {config.algorithm}; it is for PPO only")
    if wanted == "CandidatePolicy" and isinstance(observation_space, spaces.Box) and len(observation_space.shape) == 2:
        return wanted
    if wanted == "auto" or wanted == right or (wanted == "MlpPolicy" and right == "CnnPolicy"):
        return right if wanted == "auto" else wanted
    raise ConfigError(f"'policy.class' is {wanted!r}, but observations of {observation_space} need {right!r}")


def network_class(algorithm: Algorithm, name: PolicyClass) -> type[BasePolicy]:
    """Return an algorithm's class of network of that name."""
    return _NETWORKS[algorithm][name]


def describe(network: BasePolicy) -> Architecture:
    """Describe a network so that `rebuild` makes its like.

    Raises:
        PolicyFileError: It is not one of the libraries' networks as they come.
    """
    own: Any = network
    kinds = [
        (algorithm, name)
        for algorithm, classes in _NETWORKS.items()
        for name, kind in classes.items()
        if type(network) is kind
    ]
    activations = [name for name, kind in ACTIVATIONS.items() if getattr(own, "activation_fn", None) is kind]
    if not kinds or not activations or not _is_plain(network):
        raise PolicyFileError(
            f"a network of class {type(network).__name__} cannot be written to a policy file; it should be one of "
            f"{', '.join(get_args(PolicyClass))} without options of its own beyond net_arch and activation"
        )
    algorithm, name = kinds[0]
    sizes = {size: _size(own, size) for size in SIZES.get(algorithm, ())}
    return Architecture.model_validate(
        {
            "algorithm": algorithm,
            "class": name,
            "net_arch": own.net_arch,
            "activation": activations[0],
            "sizes": sizes,
        }
    )


def _is_plain(network: Any) -> bool:
    """Whether nothing but layers and activation is of somebody's own."""
    if network.features_extractor_kwargs or network.features_extractor_class not in _EXTRACTORS:
        return False
    if hasattr(network, "actor_kwargs"):  # SAC and TQC, whose actor and critic have features of their own
        return not network.actor_kwargs["use_sde"] and not network.share_features_extractor
    plain = not getattr(network, "use_sde", False) and not getattr(network, "lstm_kwargs", None)
    return plain and bool(getattr(network, "share_features_extractor", True))


def _size(network: Any, name: Size) -> int | bool:
    """A size of a network, wherever it keeps it."""
    if name in ("lstm_hidden_size", "n_lstm_layers"):
        lstm: nn.LSTM = network.lstm_actor
        return lstm.hidden_size if name == "lstm_hidden_size" else lstm.num_layers
    kept: int | bool = getattr(network, name) if hasattr(network, name) else network.critic_kwargs[name]
    return kept


def rebuild(
    architecture: Architecture, observation_space: spaces.Space[Any], action_space: spaces.Space[Any]
) -> BasePolicy:
    """Make a network with random weights on the CPU.

    Raises:
        PolicyFileError: Such a network cannot read these observations or give these actions.
    """
    with torch.random.fork_rng(devices=[]):  # weights are drawn, then overwritten: no business of the caller's stream
        try:
            kind: Any = _NETWORKS[architecture.algorithm][architecture.class_name]
            network: BasePolicy = kind(
                observation_space,
                action_space,
                lambda _: 0.0,
                net_arch=architecture.net_arch,
                activation_fn=ACTIVATIONS[architecture.activation],
                **architecture.sizes,
            )
            return network
        except (ArithmeticError, AssertionError, AttributeError, LookupError, MemoryError) as error:
            raise _unbuildable(architecture, observation_space, error) from None
        except (NotImplementedError, RuntimeError, TypeError, ValueError) as error:
            raise _unbuildable(architecture, observation_space, error) from None


def _unbuildable(architecture: Architecture, space: spaces.Space[Any], error: Exception) -> PolicyFileError:
    reason = str(error).strip().splitlines()[0] if str(error).strip() else type(error).__name__
    kind = f"{architecture.class_name} of {architecture.algorithm}"
    return PolicyFileError(f"a {kind} cannot be built for observations of {space}: {reason}")
