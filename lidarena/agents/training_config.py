"""The training file: what is trained where, for how long, and with which hyper-parameters."""

import math
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, ConfigDict, Field, field_validator, model_validator

from lidarena.base.yaml_config import ConfigModel

PolicyClass = Literal["MlpPolicy", "CnnPolicy", "MultiInputPolicy", "CandidatePolicy"]
Activation = Literal["tanh", "relu", "leaky_relu", "elu", "silu", "gelu"]
Width = Annotated[int, Field(ge=1, le=65_536)]
Layers = Annotated[list[Width], Field(max_length=64)]

CONFIG_FILE = "config.yaml"
"""Name of the resolved training file in a run folder."""

_RESERVED_KEYWORDS = {"num_envs": "num_envs beside env", "vectorization_mode": None, "vector_kwargs": None}


def _named(key: str) -> BeforeValidator:
    """Let a plain text stand for a section with one key."""
    return BeforeValidator(lambda value: {key: value} if isinstance(value, str) else value)


class EnvironmentConfig(ConfigModel):
    """The environment to train in.

    Attributes:
        id: Gymnasium's, such as ``lidarena/Env1-v0``; ``module:id`` imports a module of yours first.
        keywords: Handed to `gymnasium.make_vec`, such as ``reward`` or ``map``.
    """

    id: str = Field(min_length=1)
    keywords: dict[str, Any] = Field(default_factory=dict)

    @field_validator("keywords")
    @classmethod
    def _leave_the_batch_to_the_training(cls, keywords: dict[str, Any]) -> dict[str, Any]:
        for key in _RESERVED_KEYWORDS.keys() & keywords.keys():
            place = _RESERVED_KEYWORDS[key]
            raise ValueError(f"should not hold {key!r}, which {f'stands as {place}' if place else 'train.py sets'}")
        return keywords


class Linear(ConfigModel):
    """A value that runs in a straight line over the training.

    Attributes:
        start: At the first step.
        end: At the last step.
    """

    start: float = Field(gt=0)
    end: float = Field(default=0.0, ge=0)


Scheduled = Annotated[float, Field(gt=0)] | Linear


class PPOConfig(ConfigModel):
    """Proximal policy optimisation (Schulman et al. 2017) under Stable-Baselines3's names and defaults.

    Attributes:
        learning_rate: Of Adam; a number, or ``{start: 1e-3, end: 0}`` for a line over the training.
        n_steps: Steps of every world between two updates, so an update sees ``n_steps × num_envs`` steps.
        batch_size: Of one gradient step; it divides ``n_steps × num_envs``.
        n_epochs: Passes over the steps of an update.
        gamma: Discount factor.
        gae_lambda: Bias against variance of the advantage estimate; 1 is Monte Carlo.
        clip_range: How far a probability may move in one update; a number or a line.
        clip_range_vf: The same for the value function; empty for no limit.
        normalize_advantage: Whether every batch's advantages are shifted and scaled to mean 0, deviation 1.
        ent_coef: Weight of the entropy bonus.
        vf_coef: Weight of the value loss.
        max_grad_norm: Gradients longer than this are shortened.
        target_kl: An update ends early beyond 1.5 times this divergence; empty for no limit.
        stats_window_size: Episodes over which the logged means are taken.
    """

    learning_rate: Scheduled = 3e-4
    n_steps: int = Field(default=2048, ge=1, le=10_000_000)
    batch_size: int = Field(default=64, ge=2)
    n_epochs: int = Field(default=10, ge=1, le=10_000)
    gamma: float = Field(default=0.99, gt=0, le=1)
    gae_lambda: float = Field(default=0.95, ge=0, le=1)
    clip_range: Scheduled = 0.2
    clip_range_vf: Scheduled | None = None
    normalize_advantage: bool = True
    ent_coef: float = Field(default=0.0, ge=0)
    vf_coef: float = Field(default=0.5, ge=0)
    max_grad_norm: float = Field(default=0.5, gt=0)
    target_kl: float | None = Field(default=None, gt=0)
    stats_window_size: int = Field(default=100, ge=1, le=1_000_000)


class PolicyConfig(ConfigModel):
    """The network.

    Attributes:
        class_name: ``class`` in a file: one of Stable-Baselines3's policies, ``CandidatePolicy`` (one row a candidate,
            see `candidate_policy`), or ``auto``: ``MultiInputPolicy`` for dict observations, ``CnnPolicy`` for images,
            ``MlpPolicy`` otherwise.
        net_arch: Widths of the hidden layers, ``[64, 64]`` for actor and critic each, or ``{pi: […], vf: […]}``;
            Stable-Baselines3's default if left out.
        activation: Between the layers.
    """

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True)

    class_name: PolicyClass | Literal["auto"] = Field(default="auto", alias="class")
    net_arch: Layers | dict[Literal["pi", "vf"], Layers] | None = None
    activation: Activation = "tanh"


class TrainingConfig(ConfigModel):
    """A training file.

    Attributes:
        env: Environment; a plain id stands for one without keywords.
        seed: Of everything: networks, sampling, and world i of the batch on ``seed + i``.
        total_steps: Steps of all worlds together; the training ends with the update that reaches them.
        num_envs: Worlds that step in one call.
        checkpoint_every: Steps between two checkpoints, each taken at the end of an update; there is always one at
            the end.
        normalize_reward: Whether rewards are divided by the running deviation of the discounted return (and cut off at
            ±10 deviations) before PPO sees them. Logged returns are those of the environment. Worth it where one
            episode sums to some 100, as with ``completeness``: the value loss grows with the square.
        ppo: Hyper-parameters.
        policy: Network; a plain class name stands for one with defaults.
        device: Where the network computes: ``cpu`` or ``cuda``.
        torch_threads: Threads of PyTorch; more than one rarely pays for networks this small.
        out: Run folder. If it is taken, ``NAME-2``, ``NAME-3``, …
    """

    env: Annotated[EnvironmentConfig, _named("id")]
    seed: int = Field(default=0, ge=0, lt=2**31)
    total_steps: int = Field(default=1_000_000, ge=1, le=10**13)
    num_envs: int = Field(default=64, ge=1, le=65_536)
    checkpoint_every: int = Field(default=500_000, ge=1)
    normalize_reward: bool = False
    ppo: PPOConfig = PPOConfig()
    policy: Annotated[PolicyConfig, _named("class")] = PolicyConfig()
    device: Literal["cpu", "cuda"] = "cpu"
    torch_threads: int = Field(default=1, ge=1, le=1024)
    out: str = Field(default="runs/training", min_length=1)

    @model_validator(mode="after")
    def _batches_fill_the_rollout(self) -> Self:
        rollout = self.rollout_steps
        if rollout % self.ppo.batch_size:
            raise ValueError(
                f"'ppo.batch_size' is {self.ppo.batch_size}, but it should divide ppo.n_steps × num_envs = {rollout}"
                f"{_nearest_divisor(rollout, self.ppo.batch_size)}"
            )
        return self

    @property
    def rollout_steps(self) -> int:
        """Steps of all worlds together between two updates."""
        return self.ppo.n_steps * self.num_envs


def _nearest_divisor(number: int, wanted: int) -> str:
    """The end of a sentence that proposes the divisor of ``number`` nearest to ``wanted``, if there is any but 1."""
    small = [divisor for divisor in range(1, math.isqrt(number) + 1) if number % divisor == 0]
    divisors = {*small, *(number // divisor for divisor in small)} - {1}
    return f", such as {min(divisors, key=lambda size: (abs(size - wanted), size))}" if divisors else ""
