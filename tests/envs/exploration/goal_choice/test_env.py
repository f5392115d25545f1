import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env

from lidarena.base.errors import ActionError, ConfigError
from lidarena.envs.exploration.goal_choice.env import BatchedGoalChoice, GoalChoiceEnv
from lidarena.envs.exploration.goal_choice.features import NAMES

MAZE = "maze:5?width=5&height=5"
KEYWORDS = {"map": [MAZE, "maze:6?width=5&height=5"], "start": "random", "slam": "truth", "candidates": 6}


def test_gymnasium_finds_nothing_to_complain_of() -> None:
    check_env(GoalChoiceEnv(**KEYWORDS, max_episode_steps=20), skip_render_check=True)


def test_a_world_of_a_batch_is_the_single_world_to_the_bit() -> None:
    batch, rng = BatchedGoalChoice(3, **KEYWORDS, time_limit=60.0), np.random.default_rng(0)
    table = rng.integers(0, 3, (25, 3))
    seen, _ = batch.reset(seed=11)
    single = GoalChoiceEnv(**KEYWORDS, time_limit=60.0)
    alone, _ = single.reset(seed=12)
    assert np.array_equal(seen[1], alone)
    for choices in table:
        seen, rewards, terminated, truncated, infos = batch.step(choices)
        alone, reward, ended, cut_off, info = single.step(choices[1])
        assert (rewards[1], terminated[1], truncated[1]) == (reward, ended, cut_off)
        if ended or cut_off:
            assert np.array_equal(infos["final_obs"][1], alone)
            alone, info = single.reset()
        assert np.array_equal(seen[1], alone) and infos["path_length"][1] == info["path_length"]


def test_a_state_goes_on_to_the_bit() -> None:
    batch = BatchedGoalChoice(2, **KEYWORDS)
    batch.reset(seed=3)
    for _ in range(4):
        batch.step(np.zeros(2, np.int64))
    state = batch.get_state()
    other = BatchedGoalChoice(2, **KEYWORDS)
    other.reset(seed=99)
    other.set_state(state)
    for choice in (1, 0, 1, 0):
        one, two = batch.step(np.full(2, choice)), other.step(np.full(2, choice))
        assert np.array_equal(one[0], two[0]) and np.array_equal(one[1], two[1])


def test_always_the_nearest_explores_everything_and_the_end_is_told() -> None:
    env = gym.make("lidarena/GoalChoice-v0", map=MAZE, slam="truth", preference=0.0)
    rows, info = env.reset(seed=0)
    total, terminated = 0.0, False
    while not terminated:
        assert env.unwrapped.action_masks()[0]
        rows, reward, terminated, truncated, info = env.step(int(np.argmax(rows[:, NAMES.index("nearest")])))
        assert not truncated
        total += reward
    assert info["success"] and info["completeness"] > 0.98 and not info["action_mask"].any()
    assert set(info["reward_terms"]) == {"explored", "path", "time", "uncertainty", "collision"}


def test_waiting_is_never_paid_for() -> None:
    env = GoalChoiceEnv(map=MAZE, slam="truth", preference=1.0)
    env.reset(seed=0)
    for _ in range(15):
        _, _, terminated, _, info = env.step(0)
        terms = info["reward_terms"]
        assert terms["path"] <= 0.0 and terms["time"] < 0.0
        assert terms["explored"] > 0.0 or terms["uncertainty"] == 0.0
        if terminated:
            break


@pytest.mark.parametrize("choice", [-1, 24, 1.5, np.nan])
def test_choices_that_there_are_not_are_refused(choice: float) -> None:
    env = GoalChoiceEnv(map=MAZE, slam="truth")
    env.reset(seed=0)
    with pytest.raises(ActionError):
        env.step(choice)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"preference": 1.5}, "preference = 1.5 is out of range; a number from 0 to 1 is allowed"),
        ({"preference": "sure"}, "preference = 'sure' must be a number from 0 to 1, or 'random'"),
        ({"candidates": 1}, "candidates = 1 is out of range"),
        ({"prefrence": 1}, "unexpected keyword argument 'prefrence'.*preference"),
        ({"reward": {"paht": 1.0}}, "unknown term 'paht' of the reward.*path"),
        ({"stop_at": 0.9}, "unexpected keyword argument 'stop_at'"),
    ],
)
def test_keywords_that_mean_nothing_are_refused(keywords: dict[str, object], message: str) -> None:
    with pytest.raises(ConfigError, match=message):
        GoalChoiceEnv(map=MAZE, **keywords)
