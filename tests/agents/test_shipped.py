"""The shipped agents load, and drive in the environments they are for."""

import gymnasium as gym
import pytest

from lidarena import agents
from lidarena.agents.exploration.goal_choice_agent import GoalChoiceAgent
from lidarena.agents.exploration.goal_choice_env import GOAL_CHOICE_ID
from lidarena.base.errors import PolicyFileError
from lidarena.envs.corridor import SHARED_ID


@pytest.mark.parametrize("name", agents.pretrained())
def test_a_shipped_agent_says_how_it_was_trained(name: str) -> None:
    policy = agents.load(f"pretrained:{name}")
    assert policy.training["steps"] >= policy.training["total_steps"] > 0
    assert policy.training["seed"] is not None


@pytest.mark.parametrize("name", [name for name in agents.pretrained()])
def test_a_shipped_agent_drives(name: str) -> None:
    policy = agents.load(f"pretrained:{name}")
    if policy.env_id in (GOAL_CHOICE_ID, SHARED_ID):
        return  # tests/evaluation, and tests/agents/test_shared_fleet_agent.py, drive these
    env = gym.make(policy.env_id, **policy.env_keywords)
    agents.load(f"pretrained:{name}", env)
    observation, info = env.reset(seed=4)
    policy.reset(seed=0)
    distance = info.get("distance")
    for _ in range(20):
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        if terminated or truncated:
            break
    if "completeness" in info:
        assert info["completeness"] > 0.1
    else:
        assert info["distance"] < distance


def test_the_combined_agent_explores_a_world_that_it_was_not_trained_in() -> None:
    env = gym.make("lidarena/Env4-v0", max_episode_steps=5000, stop_at=None)
    policy = GoalChoiceAgent(env, agents.load("pretrained:combined"))
    observation, info = env.reset(seed=4)
    policy.reset(seed=0)
    while True:
        action = policy.act(observation, info)
        if policy.finished:
            break
        observation, _, terminated, truncated, info = env.step(action)
        assert not (terminated or truncated)
    assert info["completeness"] > 0.98


def test_an_agent_that_was_told_other_features_is_refused_in_one_sentence() -> None:
    env = gym.make("lidarena/Env1-v0")
    with pytest.raises(PolicyFileError, match=r"trained to choose by features of shape \(76,\).*: train it anew$"):
        GoalChoiceAgent(env, agents.load("pretrained:compass"))


def test_the_compass_agent_explores_a_world_that_it_was_not_trained_in() -> None:
    policy = agents.load("pretrained:compass")
    env = gym.make("lidarena/Env2-v0", observation="compass", max_episode_steps=None)
    observation, info = env.reset(seed=4)
    policy.reset(seed=0)
    ended = False
    while not ended:
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        ended = terminated or truncated or info["time"] > 600.0
    assert info["completeness"] >= 0.95 and not info["collision"]


def test_an_agent_that_is_not_shipped_is_refused() -> None:
    with pytest.raises(PolicyFileError, match=r"'completness' is shipped.*completeness"):
        agents.load("pretrained:completness")
