from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium import spaces
from stable_baselines3 import PPO
from stable_baselines3.common.evaluation import evaluate_policy
from stable_baselines3.common.monitor import Monitor
from stable_baselines3.common.vec_env import VecNormalize

from lidarena.agents.batches import make_batch
from lidarena.agents.training_config import EnvironmentConfig
from lidarena.agents.vec_env import BatchVecEnv
from lidarena.base.errors import ConfigError
from tests.agents.fake_batch import ID, LineBatch, NextStepBatch, RestorableLineBatch


def make(num_envs: int = 4, **keywords: Any) -> BatchVecEnv:
    env = BatchVecEnv(RestorableLineBatch(num_envs, **keywords))
    env.seed(0)
    return env


def until_done(env: BatchVecEnv, action: int) -> tuple[Any, ...]:
    """Step until some world ends; return also what was seen before, and the rewards of the world."""
    observations = [env.reset()]
    rewards = []
    while True:
        step = env.step(np.full(env.num_envs, action))
        rewards.append(step[1])
        observations.append(step[0])
        if step[2].any():
            return (*step, observations, np.array(rewards))


def test_every_array_is_fresh() -> None:
    env = make()
    first = env.reset()
    kept = first.copy()
    second, rewards, _, _ = env.step(np.ones(4, dtype=int))
    kept_rewards = rewards.copy()
    env.step(np.ones(4, dtype=int))
    assert np.array_equal(first, kept) and np.array_equal(rewards, kept_rewards)
    assert not np.shares_memory(first, second)
    rewards += 1  # Stable-Baselines3 adds the bootstrap in place
    assert env.env._rewards[0] != rewards[0]


def test_dict_observations_are_fresh_too() -> None:
    env = make(observation="map")
    first = env.reset()
    kept = {key: value.copy() for key, value in first.items()}
    env.step(np.ones(4, dtype=int))
    assert all(np.array_equal(first[key], kept[key]) for key in kept)


def test_a_world_that_terminates() -> None:
    env = make(num_envs=3)
    observations, rewards, dones, infos, seen, all_rewards = until_done(env, action=1)
    world = int(np.flatnonzero(dones)[0])
    info = infos[world]
    assert info["TimeLimit.truncated"] is False
    assert info["terminal_observation"][0] >= 0.995 and info["terminal_observation"][2] > 0
    assert 0.3 <= observations[world, 0] <= 0.5 and observations[world, 2] == 0
    episode = info["episode"]
    assert episode["l"] == len(all_rewards) and episode["r"] == pytest.approx(all_rewards[:, world].sum(), rel=1e-6)
    assert episode["completeness"] == pytest.approx(info["terminal_observation"][0]) and episode["collision"] == 0
    assert env.episodes == dones.sum()
    assert all(infos[other] == {} for other in np.flatnonzero(~dones))
    assert rewards.dtype == np.float32 and dones.dtype == bool and len(seen) == len(all_rewards) + 1


def test_a_world_that_is_cut_off() -> None:
    *_, dones, infos, _seen, _rewards = until_done(make(noise=0.0), action=0)
    assert dones.all()
    assert all(info["TimeLimit.truncated"] is True and info["episode"]["l"] == 20 for info in infos)


def test_ending_and_being_cut_off_in_the_same_step_is_no_truncation() -> None:
    *_, infos, _seen, rewards = until_done(make(noise=0.0, max_episode_steps=5), action=2)
    assert len(rewards) <= 5
    crashed = [info for info in infos if info and info["episode"]["collision"]]
    assert crashed and all(info["TimeLimit.truncated"] is False for info in crashed)


def test_counters_start_over_with_every_episode() -> None:
    env = make(num_envs=2, noise=0.0)
    env.reset()
    lengths = []
    for _ in range(60):
        lengths += [info["episode"]["l"] for info in env.step(np.zeros(2, dtype=int))[3] if info]
    assert lengths == [20] * 6


def test_a_seed_holds_for_one_reset() -> None:
    env = make()
    assert env.seed(5) == [5, 6, 7, 8]
    first = env.reset()
    second = env.reset()
    env.seed(5)
    assert np.array_equal(env.reset(), first) and not np.array_equal(first, second)
    alone = BatchVecEnv(RestorableLineBatch(1))
    alone.seed(7)
    assert np.array_equal(alone.reset()[0], first[2])


def test_infos_of_a_reset_are_told_apart() -> None:
    env = make()
    observations = env.reset()
    assert [info["completeness"] for info in env.reset_infos] == pytest.approx(observations[:, 0])
    assert "_completeness" not in env.reset_infos[0]


def test_options_must_be_the_same_for_all() -> None:
    env = make(num_envs=2)
    env.set_options([{"a": 1}, {"a": 2}])
    with pytest.raises(NotImplementedError, match="same options"):
        env.reset()
    env.set_options({"a": 1})
    env.reset()


def test_attributes_and_methods() -> None:
    env = make(num_envs=3)
    env.reset()
    assert env.get_attr("difficulty") == [1, 1, 1]
    env.set_attr("difficulty", 2)
    assert env.get_attr("difficulty", indices=[0, 2]) == [2, 2]
    assert env.get_attr("position", indices=1) == [env.env.position[1]]
    assert env.get_attr("action_space") == [spaces.Discrete(3)] * 3
    assert env.env_method("levels", 10, indices=[1, 2]) == [10, 20]
    assert env.has_attr("difficulty") and not env.has_attr("no_such_thing")
    with pytest.raises(NotImplementedError, match="shared by all worlds"):
        env.set_attr("difficulty", 3, indices=[0])
    assert env.env_is_wrapped(Monitor) == [True] * 3 and env.env_is_wrapped(gym.wrappers.TimeLimit, indices=0) == [
        False
    ]


def test_rendering() -> None:
    env = make(num_envs=4, render_mode="rgb_array")
    env.reset()
    picture = env.render()
    assert picture is not None and picture.shape == (8, 12, 3)
    assert [image[0, 0, 0] for image in env.get_images() if image is not None] == [0, 1, 2, 3]


def test_the_state_of_the_counters() -> None:
    env = make(noise=0.0)
    env.reset()
    for _ in range(7):
        env.step(np.zeros(4, dtype=int))
    state = env.get_state()
    other = make()
    other.set_state(state)
    assert all(np.array_equal(value, state[key]) for key, value in other.get_state().items())
    env.step(np.zeros(4, dtype=int))
    assert state["lengths"].tolist() == [7] * 4


def test_a_batch_that_restarts_late_is_refused() -> None:
    with pytest.raises(ConfigError, match=r"NEXT_STEP.*needs SAME_STEP"):
        BatchVecEnv(NextStepBatch(2))
    batch = LineBatch(2)
    batch.metadata = {}
    with pytest.raises(ConfigError, match="SAME_STEP"):
        BatchVecEnv(batch)


@pytest.mark.parametrize(
    ("env", "message"),
    [
        ({"id": "lidarena/Nowhere-v0"}, "no environment 'lidarena/Nowhere-v0'"),
        ({"id": "tests.agents.fake_batch:fakebatch/Lin-v0"}, "did you mean 'fakebatch/Line-v0'?"),
        ({"id": "fakebatch/Line-v7"}, "did you mean 'fakebatch/Line-v0'?"),
        ({"id": "no_such_module_of_mine:a-v0"}, "module 'no_such_module_of_mine' cannot be imported"),
        ({"id": "fakebatch/Single-v0"}, "cannot be made"),
        ({"id": "CartPole-v1", "keywords": {"sutton_reward": 1, "nonsense": 2}}, "cannot be made"),
        ({"id": "fakebatch/Late-v0"}, "cannot be made"),
        ({"id": "fakebatch/Line-v0", "keywords": {"rewrd": "x"}}, "did you mean 'reward'?"),
    ],
)
def test_environments_that_cannot_be_made(env: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError) as refusal:
        make_batch(EnvironmentConfig(**env), 2)
    assert message in str(refusal.value) and "\n" not in str(refusal.value)


@pytest.mark.parametrize("keywords", [{}, {"action": "continuous"}])
def test_ppo_sees_each_transition_once(keywords: dict[str, Any]) -> None:
    env = make_batch(EnvironmentConfig(id=ID, keywords=keywords), 3)
    model = PPO(
        "MlpPolicy", VecNormalize(env, norm_obs=False, norm_reward=False), n_steps=32, batch_size=32, n_epochs=1
    )
    model.learn(96)
    buffer = model.rollout_buffer
    flat = buffer.observations.reshape(3, 32, 3)  # swap_and_flatten: world by world
    assert np.all(np.diff(flat[:, :, 2], axis=1)[np.diff(flat[:, :, 2], axis=1) > 0] == pytest.approx(1 / 20, abs=1e-6))
    assert {info["l"] for info in model.ep_info_buffer or ()} <= set(range(1, 21))
    assert evaluate_policy(model, env, n_eval_episodes=3, warn=True)[0] is not None
