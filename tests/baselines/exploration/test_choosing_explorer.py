import gymnasium as gym
import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.baselines.exploration.choosing_explorer import ChoosingExplorer
from lidarena.envs.exploration.goal_choice.features import NAMES

MAZE = "maze:5?width=5&height=5"


def test_it_chooses_as_in_the_environment_of_choices() -> None:
    """The same world and choices, once as a policy of the exploration world and once as its own environment."""
    asked: list[np.ndarray] = []

    def choose(rows: np.ndarray) -> int:
        asked.append(rows.copy())
        return int(np.argmax(rows[:, NAMES.index("nearest")])) if len(asked) % 5 else 1

    env = gym.make("lidarena/Exploration-v0", map=MAZE, slam="truth", stop_at=None, max_episode_steps=3000)
    policy = ChoosingExplorer(env, choose, preference=0.3)
    observation, info = env.reset(seed=2)
    policy.reset()
    while not policy.finished:
        observation, _, ended, _, info = env.step(policy.act(observation, info))
        assert not ended
    choices = gym.make("lidarena/GoalChoice-v0", map=MAZE, slam="truth", preference=0.3)
    rows, _ = choices.reset(seed=2)
    for k, told in enumerate(asked, 1):
        assert np.array_equal(np.clip(told, -60.0, 60.0), rows)
        choice = int(np.argmax(rows[:, NAMES.index("nearest")])) if k % 5 else 1
        rows, _, terminated, _, end = choices.step(choice)
        if terminated:
            break
    assert k == len(asked) and terminated and info["completeness"] == end["completeness"] > 0.98
    assert policy.ending == end["ending"] == "explored"
    policy.reset()
    assert policy.ending == ""


@pytest.mark.parametrize("preference", [-0.1, 1.1, np.nan])
def test_a_preference_out_of_range_is_refused(preference: float) -> None:
    with pytest.raises(ConfigError, match=r"preference = .* is out of range; a number from 0 to 1 is allowed"):
        ChoosingExplorer(gym.make("lidarena/Env1-v0"), lambda _: 0, preference=preference)


@pytest.mark.parametrize("keywords", [{"action": "continuous"}, {"observation": "sectors"}])
def test_any_action_and_observation_will_do(keywords: dict[str, str]) -> None:
    env = gym.make("lidarena/Exploration-v0", map=MAZE, slam="truth", **keywords)
    policy = ChoosingExplorer(env, lambda rows: 0)
    observation, info = env.reset(seed=0)
    for _ in range(60):
        observation, _, ended, _, info = env.step(policy.act(observation, info))
        assert not ended
    assert len(policy.path) and info["completeness"] > 0.3
