import gymnasium as gym
import numpy as np
import pytest
import torch

from lidarena.agents.candidate_policy import CandidatePolicy, CandidateScores
from lidarena.baselines.exploration.frontier_features import CANDIDATES, FEATURES, NAMES, RULE


def rows(count: int) -> torch.Tensor:
    torch.manual_seed(count)
    observation = torch.zeros(1, CANDIDATES, FEATURES)
    observation[0, :count] = torch.randn(count, FEATURES)
    observation[0, :count, 0] = 1.0
    return observation


def test_scores_do_not_depend_on_the_place_in_the_list() -> None:
    network = CandidateScores(CANDIDATES, FEATURES, [16, 16], torch.nn.Tanh)
    observation = rows(CANDIDATES)
    order = torch.randperm(CANDIDATES)
    scores, summary = network(observation.flatten(1))
    moved, moved_summary = network(observation[:, order].flatten(1))
    assert torch.allclose(scores[:, order], moved, atol=1e-6)
    assert torch.allclose(summary, moved_summary, atol=1e-6)


@pytest.mark.parametrize("count", [0, 1, 4])
def test_what_is_not_there_is_never_chosen(count: int) -> None:
    network = CandidateScores(CANDIDATES, FEATURES, [16], torch.nn.ReLU)
    scores, summary = network(rows(count).flatten(1))
    probabilities = torch.softmax(scores, dim=1)[0]
    assert torch.isfinite(summary).all()
    assert float(probabilities[count:].sum().detach()) < 1e-6 or count == 0


def test_an_untrained_network_prefers_what_the_rule_does() -> None:
    observation_space = gym.spaces.Box(-20.0, 20.0, (CANDIDATES, FEATURES), np.float32)
    torch.manual_seed(0)
    policy = CandidatePolicy(observation_space, gym.spaces.Discrete(CANDIDATES), lambda _: 1e-3, net_arch=[16])
    observation = rows(4)
    rule = observation[0, :4] @ torch.tensor([RULE.get(name, 0.0) for name in NAMES])
    chosen = policy.get_distribution(observation).mode()
    assert int(chosen) == int(rule.argmax())
