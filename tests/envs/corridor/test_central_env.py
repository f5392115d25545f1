"""One implementation: every interface to a team's world gives the same bits, whatever the batch and the threads."""

import gymnasium as gym
import numpy as np
import pytest
from numba import config

import lidarena  # noqa: F401
from lidarena.base.errors import ActionError, ConfigError
from lidarena.envs import BatchedCorridor, corridor_v0, set_num_threads
from lidarena.envs.corridor import SHARED_ID
from lidarena.envs.corridor.shared_env import SharedCorridor

STEPS = 50
CROWD = {
    "places": "random",
    "robots": 3,
    "max_episode_steps": 30,
    "robot": {"radius": 0.3},
    "stall_rate": 0.05,
    "neighbours": 1,
}


def actions_for(seed):
    return np.random.default_rng(100 + seed).uniform(-0.3, 1, (STEPS, 3, 2)).astype(np.float32)


def raw(value):
    if isinstance(value, dict):
        return b"".join(raw(value[key]) for key in sorted(value))
    return np.asarray(value).tobytes()


def alone(seed):
    env = gym.make("lidarena/CorridorCentral-v0", **CROWD)
    record = [raw(env.reset(seed=seed)[0])]
    for action in actions_for(seed):
        observation, reward, terminated, truncated, info = env.step(action)
        ended = b""
        if terminated or truncated:
            ended = raw(observation) + raw(info)
            observation, _ = env.reset()
        record.append(raw(observation) + ended + raw([reward, terminated, truncated]))
    return record


def world_of(infos, k):
    own = {name: value for name, value in infos.items() if not name.startswith(("_", "final"))}
    return {name: world_of(v, k) if isinstance(v, dict) else v[k] for name, v in own.items()}


def together(count):
    batch = gym.make_vec("lidarena/CorridorCentral-v0", count, "vector_entry_point", **CROWD)
    observations, _ = batch.reset(seed=0)
    records = [[raw(observations[k])] for k in range(count)]
    for actions in np.stack([actions_for(k) for k in range(count)], axis=1):
        observations, rewards, terminated, truncated, infos = batch.step(actions)
        for k in range(count):
            ended = b""
            if terminated[k] or truncated[k]:
                ended = raw(infos["final_obs"][k]) + raw(world_of(infos["final_info"], k))
            records[k].append(raw(observations[k]) + ended + raw([rewards[k], terminated[k], truncated[k]]))
    return records


def test_world_i_of_any_batch_equals_the_single_environment_with_its_seed():
    singles = {seed: alone(seed) for seed in (0, 1, 5)}
    for count in (1, 2, 6):
        records = together(count)
        for seed, expected in singles.items():
            if seed < count:
                assert records[seed] == expected


def test_the_number_of_threads_changes_no_bit():
    try:
        set_num_threads(1)
        single = together(5)
        set_num_threads(3)
        assert together(5) == single
    finally:
        set_num_threads(config.NUMBA_NUM_THREADS)


def test_pettingzoo_sees_what_the_controller_of_the_team_sees():
    keywords = {"places": "random", "robots": 3}
    fleet, central = corridor_v0.parallel_env(**keywords), gym.make("lidarena/CorridorCentral-v0", **keywords)
    observations, _ = fleet.reset(seed=4)
    stacked, _ = central.reset(seed=4)
    assert np.array_equal(np.stack(list(observations.values())), stacked)
    for action in actions_for(4)[:20]:
        if len(fleet.agents) < 3:
            break
        observations, rewards, *_ = fleet.step({f"robot_{k}": action[k] for k in range(3)})
        stacked, reward, *_ = central.step(action)
        assert reward == pytest.approx(sum(rewards.values()))
    live = [int(name[-1]) for name in fleet.agents]
    assert np.array_equal(np.stack([observations[f"robot_{k}"] for k in live]), stacked[live])


@pytest.mark.parametrize("make", [BatchedCorridor, lambda n, **k: SharedCorridor(3 * n, **k)], ids=["team", "shared"])
def test_a_saved_batch_continues_to_the_bit(make):
    batch = make(4, **CROWD)
    batch.reset(seed=1)
    shape = batch.action_space.shape
    table = np.random.default_rng(0).uniform(-0.3, 1, (STEPS, *shape)).astype(np.float32)
    for actions in table[:20]:
        batch.step(actions)
    saved = batch.get_state()
    assert not any(array.dtype.hasobject for array in saved.values())
    expected = [[raw(part) for part in batch.step(actions)[:4]] for actions in table[20:]]
    other = make(4, **CROWD)
    other.set_state(saved)
    assert [[raw(part) for part in other.step(actions)[:4]] for actions in table[20:]] == expected


def test_pettingzoos_form_is_saved_too():
    env = corridor_v0.parallel_env()
    env.reset(seed=2)
    go = np.array([0.6, 0.1], np.float32)
    for _ in range(5):
        env.step({name: go for name in env.agents})
    saved = env.get_state()
    expected = raw(env.step({name: go for name in env.agents})[0])
    other = corridor_v0.parallel_env()
    other.set_state(saved)
    assert other.agents == env.agents and raw(other.step({name: go for name in other.agents})[0]) == expected


def test_robots_that_share_a_policy_end_their_episodes_with_their_team():
    envs = gym.make_vec(SHARED_ID, 6, "vector_entry_point", robots=3, max_episode_steps=12, places="random")
    observations, _ = envs.reset(seed=0)
    assert observations.shape == (6, 44)
    for step in range(12):
        observations, rewards, terminated, truncated, infos = envs.step(np.zeros((6, 2), np.float32))
        assert (terminated | truncated).all() == (step == 11) and rewards.shape == (6,)
    assert truncated.all() and infos["final_obs"][5].shape == (44,)
    assert infos["final_info"]["success"].tolist() == [False] * 6
    team = BatchedCorridor(2, robots=3, places="random")
    assert np.array_equal(team.reset(seed=0)[0].reshape(6, -1), envs.reset(seed=0)[0])


def test_a_finished_robot_sees_and_earns_nothing():
    envs = SharedCorridor(2, robots=2, starts=[(2.0, 7.5), (8.0, 7.0)], goals=[(2.3, 7.5), (17.0, 7.0)])
    envs.reset(seed=0)
    for _ in range(8):
        observations, rewards, terminated, truncated, _ = envs.step(np.array([(0.5, 0.0), (0.0, 0.0)], np.float32))
    assert not observations[0].any() and rewards[0] == 0.0 and observations[1].any()
    assert not (terminated.any() or truncated.any())


@pytest.mark.parametrize(("make", "count"), [(BatchedCorridor, 0), (SharedCorridor, 6), (SharedCorridor, 0)])
def test_the_number_of_worlds_is_checked(make, count):
    with pytest.raises(ConfigError, match="num_envs"):
        make(count)


def test_a_batch_refuses_actions_and_seeds_that_make_no_sense():
    batch = BatchedCorridor(2)
    with pytest.raises(gym.error.ResetNeeded):
        batch.step(np.zeros((2, 4, 2)))
    with pytest.raises(ConfigError, match="3 seeds were given for 2 worlds"):
        batch.reset(seed=[1, 2, 3])
    batch.reset(seed=0)
    with pytest.raises(ActionError, match="not a pair of numbers"):
        batch.step(np.zeros((2, 3, 2)))


def test_the_central_environment_keeps_to_gymnasiums_rules():
    from gymnasium.utils.env_checker import check_env

    env = gym.make("lidarena/CorridorCentral-v0", robots=2, disable_env_checker=True)
    check_env(env.unwrapped, skip_render_check=True)
    with pytest.raises(gym.error.ResetNeeded):
        gym.make("lidarena/CorridorCentral-v0").unwrapped.step(np.zeros((4, 2), np.float32))
