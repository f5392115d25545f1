"""The world of choices, the network that learns in it, and the agent that comes of it."""

from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
import torch
from gymnasium.utils.env_checker import check_env

from lidarena import agents
from lidarena.agents.candidate_policy import CandidateScores
from lidarena.agents.exploration.goal_choice_agent import GoalChoiceAgent
from lidarena.agents.exploration.goal_choice_env import GOAL_CHOICE_ID, GoalChoiceEnv
from lidarena.agents.training_config import TrainingConfig
from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import check_config
from lidarena.baselines.exploration.frontier_features import CANDIDATES, FEATURES
from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.participants import make_participants

MAZE = "maze:5?width=5&height=5"


def test_gymnasium_finds_nothing_to_complain_about() -> None:
    check_env(GoalChoiceEnv(map=MAZE, max_episode_steps=200), skip_render_check=True)


def episode(**weights: float) -> tuple[float, dict, dict, list[float]]:
    """Sum of the rewards with these weights alone, first and last info, and D-optimality at every decision."""
    only = dict.fromkeys(("path", "uncertainty", "completeness", "collision"), 0.0)
    env = GoalChoiceEnv(map=MAZE, reward=only | weights, certain_enough=1e-9, max_episode_steps=400)
    _, start = env.reset(seed=1)
    seen: list[float] = []
    step = env._world.step
    env._world.step = lambda action: note(step(action), seen)  # type: ignore[method-assign]
    total, ended = 0.0, False
    while not ended:
        _, reward, terminated, truncated, info = env.step(0)
        total, ended = total + reward, terminated or truncated
    return total, start, info, seen


def note(outcome: tuple, seen: list[float]) -> tuple:
    seen.append(outcome[4]["d_optimality"])
    return outcome


def test_rewards_are_what_their_weights_say() -> None:
    total, start, end, _ = episode(completeness=1.0)
    assert total == pytest.approx(end["completeness"] - start["completeness"]) and total > 0.5
    total, start, end, _ = episode(path=1.0)
    assert total == pytest.approx(-(end["path_length"] - start["path_length"]) / (0.55 * 25))
    total, *_, seen = episode(uncertainty=1.0)
    usual = np.full(50, np.log(1.3e-4))
    gain = usual[0] - np.concatenate([usual, np.log(seen)]).mean()
    assert total == pytest.approx((25 / 56) ** 1.5 * gain)  # less than in a larger world


def test_unknown_weights_are_refused() -> None:
    with pytest.raises(ConfigError, match=r"unknown term 'paht' of the reward; did you mean 'path'"):
        GoalChoiceEnv(map=MAZE, reward={"preset": "combined", "paht": 1.0})


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


def test_an_agent_is_trained_saved_loaded_and_driven(tmp_path: Path) -> None:
    content = {
        "env": {"id": GOAL_CHOICE_ID, "keywords": {"map": MAZE, "max_episode_steps": 150, "particles": 5}},
        "total_steps": 16,
        "num_envs": 2,
        "ppo": {"n_steps": 8, "batch_size": 16, "n_epochs": 1},
        "policy": {"class": "CandidatePolicy", "net_arch": [8]},
        "out": str(tmp_path / "run"),
    }
    folder = agents.train(check_config(content, TrainingConfig), progress=False)
    env, policy = make_participants(
        EnvEntry(id="lidarena/Exploration-v0", keywords={"map": MAZE}), PolicyEntry(name="own", path=str(folder))
    )
    assert isinstance(policy, GoalChoiceAgent)
    paths = []
    for _ in range(2):
        observation, info = env.reset(seed=3)
        policy.reset(seed=0)
        for _ in range(60):
            observation, _, _, _, info = env.step(policy.act(observation, info))
        paths.append(info["pose"])
    assert np.array_equal(*paths) and not policy.finished


def test_a_world_that_lives_through_its_episode_again_goes_on_alike() -> None:
    one, other = (GoalChoiceEnv(map=[MAZE, "maze:6?width=5&height=5"], start="random") for _ in range(2))
    one.reset(seed=7)
    for choice in (0, 1, 0, 2):
        one.step(choice)
    other.reset(seed=8)
    other.step(1)
    other.memory = one.memory
    for choice in (0, 3, 0):
        for first, second in zip(one.step(choice), other.step(choice), strict=True):
            np.testing.assert_equal(first, second)
    for first, second in zip(one.reset(), other.reset(), strict=True):  # the generators stand at the same number, too
        np.testing.assert_equal(first, second)


def test_a_training_that_was_cut_off_goes_on_to_the_bit(tmp_path: Path) -> None:
    content = {
        "env": {"id": GOAL_CHOICE_ID, "keywords": {"map": MAZE, "max_episode_steps": 250, "particles": 5}},
        "num_envs": 2,
        "ppo": {"n_steps": 8, "batch_size": 16, "n_epochs": 1},
        "policy": {"class": "CandidatePolicy", "net_arch": [8]},
    }
    halves, whole = (
        check_config(content | {"total_steps": steps, "out": str(tmp_path / name)}, TrainingConfig)
        for steps, name in ((16, "halves"), (32, "whole"))
    )
    cut = agents.train(halves, progress=False)
    agents.train(halves.model_copy(update={"total_steps": 32, "out": str(cut)}), resume=cut, progress=False)
    left_alone = agents.train(whole, progress=False)
    assert (cut / "policy.safetensors").read_bytes() == (left_alone / "policy.safetensors").read_bytes()


def test_the_id_is_registered_once() -> None:
    assert GOAL_CHOICE_ID in gym.registry
