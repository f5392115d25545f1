import gymnasium as gym
import numpy as np
import pytest
import torch

from lidarena.agents.candidate_policy import RULE, CandidatePolicy, CandidateScores
from lidarena.envs.exploration.goal_choice.features import FEATURES, NAMES

CANDIDATES = 9


def rows(count: int, candidates: int = CANDIDATES) -> torch.Tensor:
    torch.manual_seed(count)
    observation = torch.zeros(1, candidates, FEATURES + candidates)
    ways = torch.rand(count, count) * 3.0
    observation[0, :count, :FEATURES] = torch.randn(count, FEATURES)
    observation[0, :count, FEATURES : FEATURES + count] = ways + ways.T
    observation[0, :count, 0] = 1.0
    return observation


@pytest.mark.parametrize("count", [2, 5, CANDIDATES])
def test_scores_do_not_depend_on_the_place_in_the_list(count: int) -> None:
    network = CandidateScores(CANDIDATES, [16, 16], torch.nn.Tanh)
    observation, order = rows(count), torch.randperm(CANDIDATES)
    moved = observation[:, order].clone()
    moved[:, :, FEATURES:] = moved[:, :, FEATURES:][:, :, order]
    scores, summary = network(observation.flatten(1))
    moved_scores, moved_summary = network(moved.flatten(1))
    assert torch.allclose(scores[:, order], moved_scores, atol=1e-5)
    assert torch.allclose(summary, moved_summary, atol=1e-5)


def test_room_for_more_candidates_changes_nothing() -> None:
    small, large = (CandidateScores(size, [16], torch.nn.SiLU) for size in (CANDIDATES, 30))
    large.load_state_dict(small.state_dict())
    few, many = small(rows(4).flatten(1)), large(rows(4, 30).flatten(1))
    assert torch.allclose(few[0][:, :4], many[0][:, :4], atol=1e-5) and torch.allclose(few[1], many[1], atol=1e-5)


@pytest.mark.parametrize("count", [0, 1, 4])
def test_what_is_not_there_is_never_chosen(count: int) -> None:
    network = CandidateScores(CANDIDATES, [16], torch.nn.ReLU)
    scores, summary = network(rows(count).flatten(1))
    probabilities = torch.softmax(scores, dim=1)[0]
    assert torch.isfinite(summary).all()
    assert float(probabilities[count:].sum().detach()) < 1e-6 or count == 0


def policy(net_arch: list[int]) -> CandidatePolicy:
    space = gym.spaces.Box(-60.0, 60.0, (CANDIDATES, FEATURES + CANDIDATES), np.float32)
    torch.manual_seed(0)
    return CandidatePolicy(space, gym.spaces.Discrete(CANDIDATES), lambda _: 1e-3, net_arch=net_arch)


def test_an_untrained_network_prefers_what_the_rule_does() -> None:
    observation = rows(4)
    rule = observation[0, :4, :FEATURES] @ torch.tensor([RULE.get(name, 0.0) for name in NAMES])
    assert int(policy([16]).get_distribution(observation).mode()) == int(rule.argmax())


@pytest.mark.parametrize("net_arch", [[], [16, 8], [6]])
def test_widths_that_cannot_be_are_refused(net_arch: list[int]) -> None:
    with pytest.raises(ValueError, match="one width, a multiple of 4"):
        policy(net_arch)
