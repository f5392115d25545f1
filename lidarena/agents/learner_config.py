"""The learners' blocks of a training file: hyper-parameters under their libraries' names and with their defaults."""

from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from lidarena.base.yaml_config import ConfigModel

Algorithm = Literal["PPO", "MaskablePPO", "RecurrentPPO", "QRDQN", "SAC", "TQC"]

BLOCKS: dict[Algorithm, str] = {
    "PPO": "ppo",
    "MaskablePPO": "maskable_ppo",
    "RecurrentPPO": "recurrent_ppo",
    "QRDQN": "qrdqn",
    "SAC": "sac",
    "TQC": "tqc",
}
"""Every algorithm and the key of its block in a training file."""

ON_POLICY = ("ppo", "maskable_ppo", "recurrent_ppo")
"""Blocks of the algorithms that learn from their last steps alone; the others have a memory of transitions."""


class Linear(ConfigModel):
    """A value that runs in a straight line over the training.

    Attributes:
        start: At the first step.
        end: At the last step.
    """

    start: float = Field(gt=0)
    end: float = Field(default=0.0, ge=0)


Scheduled = Annotated[float, Field(gt=0)] | Linear
Share = Annotated[float, Field(ge=0, le=1)]
Count = Annotated[int, Field(ge=1, le=10_000_000)]


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
    n_steps: Count = 2048
    batch_size: int = Field(default=64, ge=2)
    n_epochs: int = Field(default=10, ge=1, le=10_000)
    gamma: float = Field(default=0.99, gt=0, le=1)
    gae_lambda: Share = 0.95
    clip_range: Scheduled = 0.2
    clip_range_vf: Scheduled | None = None
    normalize_advantage: bool = True
    ent_coef: float = Field(default=0.0, ge=0)
    vf_coef: float = Field(default=0.5, ge=0)
    max_grad_norm: float = Field(default=0.5, gt=0)
    target_kl: float | None = Field(default=None, gt=0)
    stats_window_size: int = Field(default=100, ge=1, le=1_000_000)


class MaskablePPOConfig(PPOConfig):
    """PPO that never tries an action that the environment's ``action_masks()`` rules out (Huang and Ontañón 2022)."""


class RecurrentPPOConfig(PPOConfig):
    """PPO with an LSTM between the features and the layers of ``policy.net_arch``, under sb3-contrib's names.

    Attributes:
        lstm_hidden_size: Units of an LSTM layer.
        n_lstm_layers: LSTM layers.
        shared_lstm: Whether the critic uses the actor's LSTM, without training it.
        enable_critic_lstm: Whether the critic has an LSTM of its own.
    """

    n_steps: Count = 128
    batch_size: int = Field(default=128, ge=2)
    lstm_hidden_size: int = Field(default=256, ge=1, le=65_536)
    n_lstm_layers: int = Field(default=1, ge=1, le=64)
    shared_lstm: bool = False
    enable_critic_lstm: bool = True

    @model_validator(mode="after")
    def _one_lstm_for_the_critic(self) -> Self:
        if self.shared_lstm and self.enable_critic_lstm:
            raise ValueError(
                "'shared_lstm' and 'enable_critic_lstm' are both true, but the critic should use one LSTM; "
                "set enable_critic_lstm: false"
            )
        return self


class OffPolicyConfig(ConfigModel):
    """What the learners have in common that learn from a memory of transitions.

    Attributes:
        learning_rate: Of Adam; a number or a line.
        buffer_size: Transitions that the memory holds, those of all worlds together.
        learning_starts: Steps of random actions before the first update.
        batch_size: Of one gradient step.
        tau: How far the target network moves towards the network in one update of it; 1 copies it.
        gamma: Discount factor.
        train_freq: Steps of every world between two updates.
        gradient_steps: Gradient steps of an update; -1: as many as transitions have come.
        n_steps: Of the returns; above 1 for plain observations only.
        stats_window_size: Episodes over which the logged means are taken.
    """

    learning_rate: Scheduled = 3e-4
    buffer_size: int = Field(default=1_000_000, ge=1, le=10**10)
    learning_starts: int = Field(default=100, ge=0)
    batch_size: Count = 256
    tau: float = Field(default=0.005, gt=0, le=1)
    gamma: float = Field(default=0.99, gt=0, le=1)
    train_freq: Count = 1
    gradient_steps: int = Field(default=1, ge=-1, le=10_000_000)
    n_steps: int = Field(default=1, ge=1, le=10_000)
    stats_window_size: int = Field(default=100, ge=1, le=1_000_000)


class QRDQNConfig(OffPolicyConfig):
    """Q-learning with the distribution of returns as quantiles (Dabney et al. 2018) under sb3-contrib's names.

    Attributes:
        target_update_interval: Steps, of all worlds together, between two updates of the target network.
        exploration_fraction: Share of the training over which the rate of random actions falls.
        exploration_initial_eps: That rate at the beginning.
        exploration_final_eps: That rate at the end.
        max_grad_norm: Gradients longer than this are shortened; empty for no limit.
        n_quantiles: Of every action's return.
    """

    learning_rate: Scheduled = 5e-5
    batch_size: Count = 32
    tau: float = Field(default=1.0, gt=0, le=1)
    train_freq: Count = 4
    target_update_interval: Count = 10_000
    exploration_fraction: float = Field(default=0.005, gt=0, le=1)
    exploration_initial_eps: Share = 1.0
    exploration_final_eps: Share = 0.01
    max_grad_norm: float | None = Field(default=None, gt=0)
    n_quantiles: int = Field(default=200, ge=1, le=100_000)


class SACConfig(OffPolicyConfig):
    """Soft actor-critic (Haarnoja et al. 2018) under Stable-Baselines3's names and defaults.

    Attributes:
        ent_coef: Weight of the entropy; ``auto`` learns it, ``auto_0.1`` from 0.1 on.
        target_update_interval: Gradient steps between two updates of the target networks.
        target_entropy: That ``auto`` aims at; ``auto``: minus the number of action dimensions.
        n_critics: Critics, the smallest of which counts.
    """

    ent_coef: Annotated[float, Field(ge=0)] | Annotated[str, Field(pattern=r"^auto(_\d*\.?\d+)?$")] = "auto"
    target_update_interval: Count = 1
    target_entropy: float | Literal["auto"] = "auto"
    n_critics: int = Field(default=2, ge=1, le=64)


class TQCConfig(SACConfig):
    """Truncated quantile critics (Kuznetsov et al. 2020) under sb3-contrib's names and defaults.

    Attributes:
        n_critics: Critics, whose quantiles are put together.
        n_quantiles: Of every critic.
        top_quantiles_to_drop_per_net: The largest ones, left out against overestimation.
    """

    n_quantiles: int = Field(default=25, ge=1, le=100_000)
    top_quantiles_to_drop_per_net: int = Field(default=2, ge=0)

    @model_validator(mode="after")
    def _some_quantiles_stay(self) -> Self:
        if self.top_quantiles_to_drop_per_net >= self.n_quantiles:
            raise ValueError(
                f"'top_quantiles_to_drop_per_net' is {self.top_quantiles_to_drop_per_net}, but it should be less than "
                f"n_quantiles = {self.n_quantiles}"
            )
        return self


LearnerConfig = PPOConfig | OffPolicyConfig
"""The block of a learner that learns from its last steps alone, or of one with a memory."""
