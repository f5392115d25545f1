"""A network that chooses among candidates: each is scored by the same layers, whatever place it has in the list."""

from typing import Any

import torch
from stable_baselines3.common.policies import ActorCriticPolicy
from torch import nn

from lidarena.baselines.exploration.frontier_features import NAMES, RULE

_SHARPNESS = 0.01
"""Scale of what the layers add to the rule before training."""


class CandidateScores(nn.Module):
    """Scores of candidates, and a summary of them for the critic.

    A candidate is a row of features; the first one says whether it is there (1) or not (0). Rows are encoded one by
    one, and scored by their code beside the mean code of all that are there (deep sets, Zaheer et al. 2017), to which a
    weighted sum of the features themselves is added: what is plain is learned soon.

    Args:
        candidates: Rows.
        features: Of each.
        widths: Of the encoder's layers.
        activation: Between the layers.
    """

    def __init__(self, candidates: int, features: int, widths: list[int], activation: type[nn.Module]) -> None:
        super().__init__()
        self._shape = (candidates, features)
        layers: list[nn.Module] = []
        for before, after in zip([features, *widths], widths, strict=False):
            layers += [nn.Linear(before, after), activation()]
        self.encoder = nn.Sequential(*layers)
        code = widths[-1] if widths else features
        self.scorer = nn.Sequential(nn.Linear(2 * code, code), activation(), nn.Linear(code, 1))
        self.plain = nn.Linear(features, 1, bias=False)
        self.critic = nn.Sequential(nn.Linear(2 * code, code), activation())
        self.latent_dim_pi, self.latent_dim_vf = candidates, code

    def forward(self, flat: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Logits (B, candidates) and the critic's features (B, code) of observations (B, candidates × features)."""
        return self.forward_actor(flat), self.forward_critic(flat)

    def forward_actor(self, flat: torch.Tensor) -> torch.Tensor:
        """Logits; those of candidates that are not there are out of reach."""
        codes, there, mean = self._encode(flat)
        beside = mean.unsqueeze(1).expand_as(codes)
        scores: torch.Tensor = self.scorer(torch.cat([codes, beside], dim=2)) + self.plain(
            flat.reshape(-1, *self._shape)
        )
        return scores.squeeze(2).masked_fill(~there, -1e9)

    def forward_critic(self, flat: torch.Tensor) -> torch.Tensor:
        """Mean and largest codes, condensed."""
        codes, there, mean = self._encode(flat)
        largest = codes.masked_fill(~there.unsqueeze(2), -1e9).amax(dim=1)
        largest = largest.masked_fill(~there.any(dim=1, keepdim=True), 0.0)
        summary: torch.Tensor = self.critic(torch.cat([mean, largest], dim=1))
        return summary

    def _encode(self, flat: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        rows = flat.reshape(-1, *self._shape)
        there = rows[:, :, 0] > 0.5
        codes: torch.Tensor = self.encoder(rows) * there.unsqueeze(2)
        mean = codes.sum(dim=1) / there.sum(dim=1, keepdim=True).clamp(min=1)
        return codes, there, mean


class CandidatePolicy(ActorCriticPolicy):
    """Stable-Baselines3's actor-critic with ``CandidateScores`` in place of its layers.

    For ``lidarena/GoalChoice-v0``: observations ``Box`` of shape (CANDIDATES, FEATURES) and actions
    ``Discrete(CANDIDATES)``. The encoder's widths are ``net_arch``, a list. It begins as ``frontier_features.RULE``: an
    agent that chose at random would seldom come to the end of a world.
    """

    def _build_mlp_extractor(self) -> None:
        shape = self.observation_space.shape
        assert shape is not None
        widths = list(self.net_arch) if isinstance(self.net_arch, list) else list(self.net_arch["pi"])
        scores: Any = CandidateScores(shape[0], shape[1], widths, self.activation_fn)
        self.mlp_extractor = scores.to(self.device)

    def _build(self, lr_schedule: Any) -> None:
        super()._build(lr_schedule)
        self.action_net = nn.Identity()  # the scores are the logits
        scores: Any = self.mlp_extractor
        with torch.no_grad():
            scores.scorer[-1].weight.mul_(_SHARPNESS)
            scores.plain.weight.copy_(torch.tensor([[RULE.get(name, 0.0) for name in NAMES]]))
        optimizer: Any = self.optimizer_class
        self.optimizer = optimizer(self.parameters(), lr=lr_schedule(1), **self.optimizer_kwargs)
