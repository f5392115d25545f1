"""The training file: what is trained where, for how long, and with which hyper-parameters."""

import math
from collections.abc import Callable
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, ConfigDict, Field, field_validator, model_serializer, model_validator

from lidarena.agents.learner_config import (
    BLOCKS,
    ON_POLICY,
    Algorithm,
    LearnerConfig,
    MaskablePPOConfig,
    OffPolicyConfig,
    PPOConfig,
    QRDQNConfig,
    RecurrentPPOConfig,
    SACConfig,
    TQCConfig,
)
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


class PolicyConfig(ConfigModel):
    """The network.

    Attributes:
        class_name: ``class`` in a file: one of Stable-Baselines3's policies, ``CandidatePolicy`` (one row a candidate,
            see `candidate_policy`), or ``auto``: ``MultiInputPolicy`` for dict observations, ``CnnPolicy`` for images,
            ``MlpPolicy`` otherwise.
        net_arch: Widths of the hidden layers, ``[64, 64]`` for actor and critic each, or ``{pi: […], vf: […]}``, or
            ``{pi: […], qf: […]}`` for SAC and TQC; Stable-Baselines3's default if left out.
        activation: Between the layers; in a training file that leaves it out, ``tanh`` for PPO and its kin and ``relu``
            for the others, as in the libraries.
        first_action: That the untrained network of PPO and its kin mostly takes, e² times as often as any other: the
            number of a discrete action, or one for each of several; say that of a sound rule, where trying all others
            as often costs too much. Left out: all are as likely.
        log_std_init: Logarithm of the standard deviation with which continuous actions are drawn at first; left out
            Stable-Baselines3's. Deviations hardly shrink in a training: one that is used without them should not have
            learned to live on them.
    """

    model_config = ConfigDict(validate_by_name=True, validate_by_alias=True)

    class_name: PolicyClass | Literal["auto"] = Field(default="auto", alias="class")
    net_arch: Layers | dict[str, Layers] | None = None
    activation: Activation = "tanh"
    first_action: int | list[int] | None = None
    log_std_init: float | None = Field(default=None, ge=-10, le=10)


class TrainingConfig(ConfigModel):
    """A training file.

    Attributes:
        env: Environment; a plain id stands for one without keywords.
        algorithm: Who learns: ``PPO``, ``MaskablePPO``, ``RecurrentPPO``, ``QRDQN``, ``SAC`` or ``TQC``.
        seed: Of everything: networks, sampling, and world i of the batch on ``seed + i``.
        total_steps: Steps of all worlds together; the training ends with the update that reaches them.
        num_envs: Worlds that step in one call.
        checkpoint_every: Steps between two checkpoints, each taken at the end of an update; there is always one at
            the end.
        normalize_reward: Whether rewards are divided by the running deviation of the discounted return (and cut off at
            ±10 deviations) before they are learned from. Logged returns are those of the environment. Worth it where
            one episode sums to some 100, as with ``completeness``: the value loss grows with the square.
        normalize_observation: Whether the numbers of an observation are shifted and scaled to their running mean and
            deviation, and cut off at ±10 deviations; pictures are left alone. The policy file holds both, so that the
            loaded policy does the same.
        ppo: Hyper-parameters of ``algorithm: PPO``; the blocks of the others are for those alone.
        maskable_ppo: Of ``algorithm: MaskablePPO``.
        recurrent_ppo: Of ``algorithm: RecurrentPPO``.
        qrdqn: Of ``algorithm: QRDQN``.
        sac: Of ``algorithm: SAC``.
        tqc: Of ``algorithm: TQC``.
        policy: Network; a plain class name stands for one with defaults.
        device: Where the network computes: ``cpu`` or ``cuda``.
        torch_threads: Threads of PyTorch; more than one rarely pays for networks this small.
        out: Run folder. If it is taken, ``NAME-2``, ``NAME-3``, …
    """

    env: Annotated[EnvironmentConfig, _named("id")]
    algorithm: Algorithm = "PPO"
    seed: int = Field(default=0, ge=0, lt=2**31)
    total_steps: int = Field(default=1_000_000, ge=1, le=10**13)
    num_envs: int = Field(default=64, ge=1, le=65_536)
    checkpoint_every: int = Field(default=500_000, ge=1)
    normalize_reward: bool = False
    normalize_observation: bool = False
    ppo: PPOConfig | None = None
    maskable_ppo: MaskablePPOConfig | None = None
    recurrent_ppo: RecurrentPPOConfig | None = None
    qrdqn: QRDQNConfig | None = None
    sac: SACConfig | None = None
    tqc: TQCConfig | None = None
    policy: Annotated[PolicyConfig, _named("class")] = PolicyConfig()
    device: Literal["cpu", "cuda"] = "cpu"
    torch_threads: int = Field(default=1, ge=1, le=1024)
    out: str = Field(default="runs/training", min_length=1)

    @model_validator(mode="before")
    @classmethod
    def _fill_in_what_depends_on_the_algorithm(cls, content: Any) -> Any:
        if not isinstance(content, dict) or content.get("algorithm", "PPO") not in list(BLOCKS):
            return content
        block = BLOCKS[content.get("algorithm", "PPO")]
        policy = content.get("policy", {})
        policy = {"class": policy} if isinstance(policy, str) else policy
        if isinstance(policy, dict):
            policy = {"activation": "tanh" if block in ON_POLICY else "relu"} | policy
        filled = {**content, "policy": policy}
        return filled if filled.get(block) is not None else filled | {block: {}}

    @model_validator(mode="after")
    def _one_learner(self) -> Self:
        for algorithm, block in BLOCKS.items():
            if algorithm != self.algorithm and getattr(self, block) is not None:
                raise ValueError(
                    f"{block!r} is the block of {algorithm}, but 'algorithm' is {self.algorithm}, whose block is "
                    f"{BLOCKS[self.algorithm]!r}"
                )
        return self

    @model_validator(mode="after")
    def _the_learner_fits_the_batch(self) -> Self:
        learner = getattr(self, BLOCKS[self.algorithm])
        if isinstance(learner, OffPolicyConfig):
            self._check_memory(learner)
        elif self.algorithm != "RecurrentPPO" and (rollout := learner.n_steps * self.num_envs) % learner.batch_size:
            block = BLOCKS[self.algorithm]
            raise ValueError(
                f"'{block}.batch_size' is {learner.batch_size}, but it should divide {block}.n_steps × num_envs = "
                f"{rollout}{_nearest_divisor(rollout, learner.batch_size)}"
            )
        return self

    @model_validator(mode="after")
    def _the_learner_has_these_networks(self) -> Self:
        block, layers = BLOCKS[self.algorithm], self.policy.net_arch
        parts = {"pi", "vf"} if block in ON_POLICY else set() if block == "qrdqn" else {"pi", "qf"}
        if isinstance(layers, dict) and set(layers) != parts:
            wanted = f"{{{', '.join(f'{part}: […]' for part in sorted(parts))}}} or a list" if parts else "a list"
            raise ValueError(f"'policy.net_arch' is {layers}, but {self.algorithm} takes {wanted}")
        return self

    def _check_memory(self, learner: OffPolicyConfig) -> None:
        block = BLOCKS[self.algorithm]
        if learner.buffer_size < self.num_envs:
            raise ValueError(
                f"'{block}.buffer_size' is {learner.buffer_size}, but it should be at least num_envs = {self.num_envs}"
            )
        if isinstance(learner, QRDQNConfig) and learner.target_update_interval < self.num_envs:
            raise ValueError(
                f"'{block}.target_update_interval' is {learner.target_update_interval}, but it should be at least "
                f"num_envs = {self.num_envs}, as all worlds step together"
            )

    @model_serializer(mode="wrap")
    def _without_the_blocks_of_others(self, dump: Callable[[Any], dict[str, Any]]) -> dict[str, Any]:
        others = {block for algorithm, block in BLOCKS.items() if algorithm != self.algorithm}
        return {key: value for key, value in dump(self).items() if key not in others}

    @property
    def learner(self) -> LearnerConfig:
        """The block of the algorithm."""
        block: LearnerConfig = getattr(self, BLOCKS[self.algorithm])
        return block


def _nearest_divisor(number: int, wanted: int) -> str:
    """The end of a sentence that proposes the divisor of ``number`` nearest to ``wanted``, if there is any but 1."""
    small = [divisor for divisor in range(1, math.isqrt(number) + 1) if number % divisor == 0]
    divisors = {*small, *(number // divisor for divisor in small)} - {1}
    return f", such as {min(divisors, key=lambda size: (abs(size - wanted), size))}" if divisors else ""
