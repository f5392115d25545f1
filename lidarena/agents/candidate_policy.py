"""A network that chooses among candidates: attention over the set of them, with the ways between them as its biases."""

from typing import Any

import torch
from stable_baselines3.common.policies import ActorCriticPolicy
from torch import nn

from lidarena.envs.exploration.goal_choice.features import FEATURES, NAMES

_SHARPNESS = 0.1
"""Scale of what the layers add to the rule before training."""
_HEADS = 4
_FAR = -1e9
RULE = {"detour": -6.0, "turn": -2.0, "size": 2.0, "pursued": 3.0, "place": -8.0, "wanted": 21.0}
"""Weights of a sound rule to begin learning from: the nearest frontier, a little for turning, size and keeping on, and
a place that is surer than here by more than the detour to it is worth. A metre weighs 2."""


class AttentionBlock(nn.Module):
    """One round in which every candidate looks at all others (Vaswani et al. 2017), near ones and far ones apart.

    Args:
        width: Of the codes.
        activation: Of the layer behind.
    """

    def __init__(self, width: int, activation: type[nn.Module]) -> None:
        super().__init__()
        self.before, self.between = nn.LayerNorm(width), nn.LayerNorm(width)
        self.qkv, self.out = nn.Linear(width, 3 * width), nn.Linear(width, width)
        self.nearness = nn.Sequential(nn.Linear(2, 8), activation(), nn.Linear(8, _HEADS))
        self.layer = nn.Sequential(nn.Linear(width, 2 * width), activation(), nn.Linear(2 * width, width))

    def forward(self, codes: torch.Tensor, ways: torch.Tensor, there: torch.Tensor) -> torch.Tensor:
        """Return new codes (B, K, width).

        Args:
            codes: (B, K, width).
            ways: (B, K, K) lengths of the ways from one to the other / 6 m.
            there: (B, K) which candidates there are.
        """
        batch, count, width = codes.shape
        split = self.qkv(self.before(codes)).view(batch, count, 3, _HEADS, width // _HEADS).permute(2, 0, 3, 1, 4)
        pair = torch.stack([ways, torch.exp(-2.0 * ways)], dim=3)
        bias = self.nearness(pair).permute(0, 3, 1, 2).masked_fill(~there[:, None, None, :], _FAR)
        seen = nn.functional.scaled_dot_product_attention(split[0], split[1], split[2], attn_mask=bias)
        codes = codes + self.out(seen.transpose(1, 2).reshape(batch, count, width))
        new: torch.Tensor = codes + self.layer(self.between(codes))
        return new


class CandidateScores(nn.Module):
    """Scores of candidates, and a summary of them for the critic.

    A candidate is a row of features, the first of which says whether it is there (1) or not (0), and of the ways to
    every candidate. Codes of the rows look at each other in some rounds, then each is scored, to which a weighted sum
    of the features themselves is added: what is plain is learned soon. Scores go with their rows in whatever order
    these stand, and rows that are not there say nothing.

    Args:
        candidates: Rows.
        widths: Of the codes, as often as there are rounds of attention; all the same.
        activation: Between the layers.
    """

    trimmed = True
    """Whether rows behind the last one that is there are not even looked at."""

    def __init__(self, candidates: int, widths: list[int], activation: type[nn.Module]) -> None:
        super().__init__()
        self._shape = (candidates, FEATURES + candidates)
        width = widths[0]
        self.encoder = nn.Linear(FEATURES, width)
        self.blocks = nn.ModuleList(AttentionBlock(width, activation) for _ in widths)
        self.scorer = nn.Sequential(nn.LayerNorm(width), nn.Linear(width, width), activation(), nn.Linear(width, 1))
        self.plain = nn.Linear(FEATURES, 1, bias=False)
        self.critic = nn.Sequential(nn.Linear(2 * width, width), activation())
        self.latent_dim_pi, self.latent_dim_vf = candidates, width

    def forward(self, flat: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor]:
        """Logits (B, K) and the critic's features (B, width) of observations (B, K × (FEATURES + K))."""
        codes, features, there = self._encode(flat)
        return self._score(codes, features, there), self._summarise(codes, there)

    def forward_actor(self, flat: torch.Tensor) -> torch.Tensor:
        """Logits; those of candidates that are not there are out of reach."""
        return self._score(*self._encode(flat))

    def forward_critic(self, flat: torch.Tensor) -> torch.Tensor:
        """Mean and largest codes, condensed."""
        codes, _, there = self._encode(flat)
        return self._summarise(codes, there)

    def _encode(self, flat: torch.Tensor) -> tuple[torch.Tensor, torch.Tensor, torch.Tensor]:
        rows = flat.reshape(-1, *self._shape)
        features, ways = rows[:, :, :FEATURES], rows[:, :, FEATURES:]
        there = features[:, :, 0] > 0.5
        if self.trimmed:  # rows that are there stand first
            shown = torch.nonzero(there.any(dim=0))
            last = int(shown.max()) + 1 if len(shown) else 1
            features, ways, there = features[:, :last], ways[:, :last, :last], there[:, :last]
        codes = self.encoder(features)
        for block in self.blocks:
            codes = block(codes, ways, there)
        return codes, features, there

    def _score(self, codes: torch.Tensor, features: torch.Tensor, there: torch.Tensor) -> torch.Tensor:
        scores = (self.scorer(codes) + self.plain(features)).squeeze(2).masked_fill(~there, _FAR)
        return nn.functional.pad(scores, (0, self._shape[0] - scores.shape[1]), value=_FAR)

    def _summarise(self, codes: torch.Tensor, there: torch.Tensor) -> torch.Tensor:
        shown = there.unsqueeze(2)
        mean = (codes * shown).sum(dim=1) / shown.sum(dim=1).clamp(min=1)
        largest = codes.masked_fill(~shown, _FAR).amax(dim=1).masked_fill(~there.any(dim=1, keepdim=True), 0.0)
        summary: torch.Tensor = self.critic(torch.cat([mean, largest], dim=1))
        return summary


class CandidatePolicy(ActorCriticPolicy):
    """Stable-Baselines3's actor-critic with ``CandidateScores`` in place of its layers.

    For ``lidarena/GoalChoice-v0``. ``net_arch`` is the width of the codes, once for every round of attention. It begins
    as ``RULE``: an agent that chose at random would seldom come to the end of a world.
    """

    def _build_mlp_extractor(self) -> None:
        shape = self.observation_space.shape
        assert shape is not None
        widths = list(self.net_arch) if isinstance(self.net_arch, list) else list(self.net_arch["pi"])
        if not widths or len(set(widths)) > 1 or widths[0] % _HEADS or shape[1] != FEATURES + shape[0]:
            raise ValueError(
                f"net_arch = {widths} for observations of shape {shape}: one width, a multiple of {_HEADS}, for every "
                f"round of attention, and {FEATURES} features and the ways to all candidates are needed"
            )
        scores: Any = CandidateScores(shape[0], widths, self.activation_fn)
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
