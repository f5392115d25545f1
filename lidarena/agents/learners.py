"""The six algorithms: who learns what, made from a configuration; nothing else needs to tell them apart."""

import warnings
from dataclasses import dataclass
from typing import Any

import numpy as np
import torch
from gymnasium import spaces
from sb3_contrib import QRDQN, TQC, MaskablePPO, RecurrentPPO
from stable_baselines3 import PPO, SAC
from stable_baselines3.common.base_class import BaseAlgorithm
from stable_baselines3.common.utils import LinearSchedule
from stable_baselines3.common.vec_env import VecEnv, VecNormalize
from torch.optim import Adam, Optimizer

from lidarena.agents.learner_config import Algorithm, Linear
from lidarena.agents.networks import ACTIVATIONS, SIZES, class_for, network_class
from lidarena.agents.observation_normalizer import keys_to_normalize
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.errors import ConfigError

_GAUSSIAN: tuple[Algorithm, ...] = ("PPO", "RecurrentPPO")
"""Those whose continuous actions have deviations of their own, whatever is observed."""
_PREFERENCE = 2.0
"""Of an untrained policy for the action that it is to begin with, as a difference of logarithms."""
_CHOICES = (spaces.Discrete, spaces.MultiDiscrete, spaces.MultiBinary)


@dataclass(frozen=True)
class Learner:
    """One of the algorithms.

    Attributes:
        algorithm: Its class.
        actions: Spaces of actions that it can learn.
        optimizers: Where it keeps its optimizers, by the names that a checkpoint gives them.
        optimizer: Keywords of Adam; one fused kernel does the work of a dozen.
    """

    algorithm: type[BaseAlgorithm]
    actions: tuple[type[spaces.Space[Any]], ...]
    optimizers: tuple[tuple[str, str], ...] = (("optimizer", "policy.optimizer"),)
    optimizer: tuple[tuple[str, Any], ...] = (("eps", 1e-5), ("fused", True))  # the ε of PPO's implementations


_ACTOR_CRITIC = (
    ("actor_optimizer", "policy.actor.optimizer"),
    ("critic_optimizer", "policy.critic.optimizer"),
    ("ent_coef_optimizer", "ent_coef_optimizer"),
)
_FUSED = (("fused", True),)
LEARNERS: dict[Algorithm, Learner] = {
    "PPO": Learner(PPO, (spaces.Box, *_CHOICES)),
    "MaskablePPO": Learner(MaskablePPO, _CHOICES),
    "RecurrentPPO": Learner(RecurrentPPO, (spaces.Box, *_CHOICES)),
    "QRDQN": Learner(QRDQN, (spaces.Discrete,), optimizer=_FUSED),
    "SAC": Learner(SAC, (spaces.Box,), _ACTOR_CRITIC, _FUSED),
    "TQC": Learner(TQC, (spaces.Box,), _ACTOR_CRITIC, _FUSED),
}
"""The algorithms by their names in a training file."""


def normalized(config: TrainingConfig, env: VecEnv) -> VecEnv:
    """Wrap a batch so that its rewards and observations are normalized, as far as the configuration asks for it.

    Raises:
        ConfigError: There are no numbers in the observations to normalize.
    """
    if not (config.normalize_reward or config.normalize_observation):
        return env
    keys = keys_to_normalize(env.observation_space) if config.normalize_observation else None
    return VecNormalize(
        env,
        norm_obs=config.normalize_observation,
        norm_reward=config.normalize_reward,
        gamma=config.learner.gamma,
        norm_obs_keys=keys,
    )


def make_model(config: TrainingConfig, env: VecEnv) -> BaseAlgorithm:
    """Make a learner with fresh weights, and seed Python's, NumPy's and PyTorch's generators as well as the worlds.

    Raises:
        ConfigError: The algorithm cannot learn in this environment, the policy cannot read its observations, or there
            is no such device.
    """
    if config.device == "cuda" and not torch.cuda.is_available():
        raise ConfigError("'device' is 'cuda', but PyTorch finds no CUDA device here; allowed here: cpu")
    check_fit(config, env)
    sizes = SIZES.get(config.algorithm, ())
    settings = {name: _schedule(value) for name, value in config.learner if name not in sizes}
    kind = network_class(config.algorithm, class_for(config, env.observation_space))
    make: Any = LEARNERS[config.algorithm].algorithm
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message="You are trying to run .* on the GPU")  # the user asked for it
        try:
            model: BaseAlgorithm = make(
                kind, env, policy_kwargs=_network(config), seed=config.seed, device=config.device, **settings
            )
        except (AssertionError, ValueError, MemoryError) as error:
            reason = (str(error) or type(error).__name__).splitlines()[0]
            raise ConfigError(f"{config.algorithm} cannot learn in {config.env.id!r}: {reason}") from None
    if config.policy.first_action is not None:
        prefer(model, config.policy.first_action)
    env.seed(first_world_seed(config.seed))
    return model


def prefer(model: BaseAlgorithm, action: int | list[int]) -> None:
    """Let an untrained policy mostly take one action; see ``PolicyConfig.first_action``.

    Raises:
        ConfigError: Its actions are no choices, it has no probabilities, or there is no such action.
    """
    space, net = model.action_space, getattr(model.policy, "action_net", None)
    sizes = [int(space.n)] if isinstance(space, spaces.Discrete) else getattr(space, "nvec", np.empty(0)).tolist()
    numbers = action if isinstance(action, list) else [action]
    if not sizes or not isinstance(net, torch.nn.Linear):
        raise ConfigError(
            f"'policy.first_action' is for policies that draw among discrete actions, not for {type(model).__name__} "
            f"with actions {space}"
        )
    if len(numbers) != len(sizes) or not all(0 <= one < size for one, size in zip(numbers, sizes, strict=False)):
        raise ConfigError(f"'policy.first_action' is {action}, but the actions are {space}")
    first = np.cumsum([0, *sizes[:-1]])
    with torch.no_grad():
        net.bias[first + np.array(numbers)] += _PREFERENCE


def check_fit(config: TrainingConfig, env: VecEnv) -> None:
    """Refuse an environment in which an algorithm cannot learn.

    Raises:
        ConfigError: It takes other actions, or has no masks where the algorithm wants them.
    """
    space, wanted = env.action_space, LEARNERS[config.algorithm].actions
    if not isinstance(space, wanted):
        fitting = [name for name, learner in LEARNERS.items() if isinstance(space, learner.actions)]
        raise ConfigError(
            f"'algorithm' is {config.algorithm}, which takes actions of {' or '.join(one.__name__ for one in wanted)}, "
            f"but {config.env.id!r} has {space}; {_allowed(fitting)}"
        )
    _check_deviation(config, space)
    if isinstance(space, spaces.Discrete) and space.start != 0:
        raise ConfigError(f"{config.env.id!r} has actions {space}, but only those that begin at 0 can be learned")
    if isinstance(space, spaces.Box) and not space.is_bounded():
        raise ConfigError(f"{config.env.id!r} has actions {space}, but only those with finite bounds can be learned")
    if config.algorithm == "MaskablePPO" and not env.has_attr("action_masks"):
        raise ConfigError(
            f"'algorithm' is MaskablePPO, but {config.env.id!r} has no action_masks(); {_allowed(['PPO'])}"
        )


def _check_deviation(config: TrainingConfig, space: spaces.Space[Any]) -> None:
    """Refuse ``log_std_init`` where there is no such deviation."""
    if config.policy.log_std_init is None or (isinstance(space, spaces.Box) and config.algorithm in _GAUSSIAN):
        return
    raise ConfigError(
        f"'policy.log_std_init' is for continuous actions of {' or '.join(_GAUSSIAN)}, not for {config.algorithm} with "
        f"actions {space}"
    )


def _allowed(algorithms: list[Algorithm]) -> str:
    return f"allowed here: {', '.join(sorted(algorithms)) or 'none'}"


def optimizers(model: BaseAlgorithm) -> dict[str, Optimizer]:
    """Return the optimizers that a model has, by the names that a checkpoint gives them."""
    paths = next(learner.optimizers for learner in LEARNERS.values() if type(model) is learner.algorithm)
    found = {}
    for name, path in paths:
        place: Any = model
        for part in path.split("."):
            place = getattr(place, part)
        if place is not None:
            found[name] = place
    return found


def first_world_seed(seed: int) -> int:
    """Seed of a training's first world; the next ones count on from it.

    Trainings with the seeds 0 and 1 would share all worlds but two if their worlds began to count there.
    """
    return int(np.random.SeedSequence(seed).generate_state(1)[0])


def _network(config: TrainingConfig) -> dict[str, Any]:
    """Keywords of the network."""
    adam = dict(LEARNERS[config.algorithm].optimizer)
    if config.algorithm == "QRDQN":
        adam["eps"] = 0.01 / getattr(config.learner, "batch_size")  # noqa: B009  as in its paper and sb3-contrib
    network: dict[str, Any] = {
        "activation_fn": ACTIVATIONS[config.policy.activation],
        "optimizer_class": Adam,
        "optimizer_kwargs": adam,
    }
    if config.policy.log_std_init is not None:
        network["log_std_init"] = config.policy.log_std_init
    network |= {size: getattr(config.learner, size) for size in SIZES.get(config.algorithm, ())}
    return network if config.policy.net_arch is None else network | {"net_arch": config.policy.net_arch}


def _schedule(value: Any) -> Any:
    return LinearSchedule(value.start, value.end, end_fraction=1.0) if isinstance(value, Linear) else value
