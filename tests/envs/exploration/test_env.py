import gymnasium as gym
import numpy as np
import pytest
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env

import lidarena  # noqa: F401
from lidarena.base.errors import ActionError, ConfigError, MapError
from lidarena.envs import BatchedExploration, ExplorationEnv
from lidarena.envs.exploration import FAMILY
from lidarena.envs.registration import register_all

IDS = sorted(set(FAMILY.ids) - {"lidarena/GoalChoice-v0"})


@pytest.mark.parametrize("name", IDS)
def test_gymnasium_finds_nothing_to_complain_about(name: str) -> None:
    check_env(gym.make(name).unwrapped)


@pytest.mark.parametrize(
    "keywords",
    [
        {"observation": "sectors"},
        {"observation": "frontier_histogram"},
        {"observation": "frontier_arcs"},
        {"observation": "map"},
        {"observation": "map", "action": "continuous", "reward": "combined"},
        {"reward": "d_optimality", "observation": "da_slam_entropy", "action": "continuous"},
        {"slam": "truth", "render_mode": "rgb_array"},
        {"map": "maze:4", "start": "random", "particles": 5},
    ],
)
def test_every_variant_passes_both_checkers(keywords: dict) -> None:
    from stable_baselines3.common.env_checker import check_env as check_for_sb3

    check_env(gym.make("lidarena/Exploration-v0", **keywords).unwrapped)
    check_for_sb3(gym.make("lidarena/Exploration-v0", **keywords))


def test_registering_twice_changes_nothing() -> None:
    before = dict(gym.registry)
    register_all()
    assert dict(gym.registry) == before


def test_forward_moves_the_robot_and_turns_turn_it() -> None:
    env = gym.make("lidarena/Env3-v0", expose_truth=True)
    _, info = env.reset(seed=0)
    start = info["truth"]["pose"]
    for action, distance, angle in [(0, 0.1, 0.0), (1, 0.01, 0.06), (2, 0.01, -0.06)]:
        _, _, _, _, after = env.step(action)
        pose = after["truth"]["pose"]
        assert np.hypot(*(pose - start)[:2]) == pytest.approx(distance, rel=1e-3)
        assert pose[2] - start[2] == pytest.approx(angle, abs=1e-9)
        start = pose


def test_the_reward_is_the_gain_in_completeness_and_the_terms_add_up() -> None:
    env = gym.make("lidarena/Env1-v0")
    _, info = env.reset(seed=0)
    for action in [0, 0, 0, 1, 0, 0, 0]:
        before = info["completeness"]
        _, reward, terminated, _, info = env.step(action)
        assert not terminated
        assert reward == pytest.approx(100 * (info["completeness"] - before))
        assert sum(info["reward_terms"].values()) == pytest.approx(reward)


def test_driving_into_a_wall_ends_the_episode_with_the_crash_reward() -> None:
    env = gym.make("lidarena/Env1-v0")
    env.reset(seed=0)
    for _ in range(200):
        _, reward, terminated, _, info = env.step(0)
        if terminated:
            break
    assert terminated
    assert info["collision"]
    assert reward == -100.0
    with pytest.raises(ResetNeeded, match="reset"):
        env.unwrapped.step(0)


def test_the_uncertainty_reward_is_equation_three() -> None:
    env = gym.make("lidarena/Env2-v0", reward="d_optimality", observation="da_slam_entropy", eta=1e-4)
    observation, _ = env.reset(seed=0)
    for _ in range(5):
        observation, reward, _, _, info = env.step(1)
        assert reward == pytest.approx(1 + np.tanh(1e-4 / info["d_optimality"]))
        assert observation[-1] == pytest.approx(info["entropy"] / np.log(30), abs=1e-6)


def test_reaching_stop_at_ends_the_episode_as_done() -> None:
    env = gym.make("lidarena/Env1-v0", stop_at=0.05)
    env.reset(seed=0)
    _, _, terminated, truncated, info = env.step(0)
    assert terminated
    assert not truncated
    assert not info["collision"]


def test_gym_makes_own_limit_truncates_in_every_mode() -> None:
    env = gym.make("lidarena/Env3-v0", max_episode_steps=3)
    env.reset(seed=0)
    assert [env.step(1)[3] for _ in range(3)] == [False, False, True]
    batch = gym.make_vec("lidarena/Env3-v0", 2, "vector_entry_point", max_episode_steps=3)
    batch.reset(seed=0)
    assert [batch.step(np.ones(2, int))[3].tolist() for _ in range(3)] == [[False] * 2, [False] * 2, [True] * 2]
    assert gym.make("lidarena/Env3-v0").spec.max_episode_steps == 1000
    assert ExplorationEnv(map="env3").episodes.options.max_episode_steps == 1000


def test_a_sector_holds_the_nearest_of_its_beams() -> None:
    env = ExplorationEnv(map="env3", observation="sectors", slam="truth")
    observation, info = env.reset(seed=3)
    scan = env.episodes.core.sensors.scans[0, 0] / np.float32(3.5)
    assert observation.shape == (38,) and observation[-1] == pytest.approx(info["completeness"], abs=1e-6)
    for sector in range(36):
        beams = np.arange(10 * sector - 5, 10 * sector + 5) % 360
        assert observation[sector] == scan[beams].min()


def test_the_observation_holds_beams_previous_action_and_completeness() -> None:
    env = gym.make("lidarena/Env1-v0", lidar={"noise": 0.0})
    observation, info = env.reset(seed=3)
    assert observation[5] == 0.0
    observation, _, _, _, info = env.step(2)
    scan = env.unwrapped.episodes.core.sensors.scans[0, 0]
    assert observation[:5] == pytest.approx(scan[[0, 45, 90, 315, 270]] / 3.5)
    assert observation[5] == 1.0
    assert observation[6] == pytest.approx(info["completeness"], abs=1e-6)


def test_the_picture_of_the_map_is_egocentric_and_heading_up() -> None:
    env = gym.make("lidarena/Env3-v0", observation="map", slam="truth", lidar={"noise": 0.0})
    observation, _ = env.reset(seed=0)
    picture = observation["map"]
    assert picture.shape == (3, 64, 64)
    assert (picture.sum(axis=0) == 255).all()  # every pixel is wall, free or unknown
    assert picture[1, 31, 32] == 255
    ahead = round(float(observation["scan"][0]) * 3.5 / 0.1)
    column = picture[0, :32, 31:33].max(axis=1)
    walls = 31 - np.flatnonzero(column)
    assert observation["scan"][0] == 1.0 or abs(walls.min() - ahead) <= 1


def test_random_starts_are_free_and_differ() -> None:
    env = gym.make("lidarena/Env4-v0", start="random", expose_truth=True)
    plan = env.unwrapped.episodes.core.plans[0]
    poses = np.array([env.reset(seed=k)[1]["truth"]["pose"] for k in range(30)])
    assert (plan.clearance(poses[:, :2]) >= 0.2).all()
    assert np.unique(poses, axis=0).shape[0] > 25


def test_a_list_of_maps_is_drawn_from_at_every_reset() -> None:
    batch = BatchedExploration(num_envs=16, map=["maze:1", "maze:2", "env1"], slam="truth")
    batch.reset(seed=0)
    assert set(batch.episodes.core.plan) == {0, 1, 2}


@pytest.mark.parametrize("action", [3, -1, 0.5, np.nan, [0], "0", None, 1.0, True])
def test_bad_discrete_actions_are_refused(action: object) -> None:
    env = ExplorationEnv(map="env1")
    env.reset(seed=0)
    with pytest.raises(ActionError, match="action"):
        env.step(action)


@pytest.mark.parametrize("action", [[0.0], [0.0, np.nan], [2.0, 0.0], 0.5, [[0.0, 0.0]], ["a", "b"]])
def test_bad_continuous_actions_are_refused(action: object) -> None:
    env = ExplorationEnv(map="env1", action="continuous")
    env.reset(seed=0)
    with pytest.raises(ActionError, match="action"):
        env.step(action)


def test_a_refused_action_leaves_the_episode_as_it_was() -> None:
    first, second = ExplorationEnv(map="env1"), ExplorationEnv(map="env1")
    for env in (first, second):
        env.reset(seed=0)
    with pytest.raises(ActionError):
        first.step(7)
    assert first.step(0)[0].tobytes() == second.step(0)[0].tobytes()


@pytest.mark.parametrize("make", [ExplorationEnv, BatchedExploration])
def test_stepping_before_reset_is_refused(make: type) -> None:
    with pytest.raises(ResetNeeded, match="reset"):
        make(map="env1").step([0] if make is BatchedExploration else 0)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"rewrad": "completeness"}, "did you mean 'reward'"),
        ({"reward": "completenes"}, "did you mean 'completeness'"),
        ({"particles": 0}, "particles = 0"),
        ({"particles": 2.5}, "whole number"),
        ({"decision_period": float("nan")}, "decision_period"),
        ({"lidar": {"noise": -1}}, "lidar.noise = -1"),
        ({"stop_at": 2}, "stop_at"),
        ({"max_episode_steps": 0}, "max_episode_steps"),
        ({"slam": "gmapping"}, "slam"),
        ({"expose_truth": 1}, "expose_truth"),
        ({"map": []}, "map"),
        ({"reward": {"paht": 1}}, "unknown term 'paht' of the reward; did you mean 'path'"),
        ({"reward": {"path": -1}}, "reward.path = -1 is out of range"),
        ({"reward": {"path": "long"}}, "reward.path = 'long' is out of range"),
        ({"reward": 2.0}, "reward = 2.0 must be a function of a step, weights by term, or one of"),
        ({"reward": "combined", "weights": 2.0}, "weights = 2.0 is given as reward = "),
        ({"reward": "combined", "certain_enough": 0}, "certain_enough = 0 is out of range"),
        ({"weights": {"path": 1.0}}, "weights = .* went with reward = 'combined'"),
    ],
)
def test_bad_keywords_are_refused_in_one_sentence(keywords: dict, message: str) -> None:
    with pytest.raises(ConfigError, match=message) as refusal:
        ExplorationEnv(**keywords)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize("start", [(0.0, 0.0, 0.0), (99.0, 1.0, 0.0), "somewhere", (1.0, 2.0), ("a", 1, 2)])
def test_bad_starts_are_refused(start: object) -> None:
    with pytest.raises(MapError, match="start"):
        ExplorationEnv(map="env1", start=start)


def test_ppo_of_stable_baselines_takes_the_environment_as_it_is() -> None:
    from stable_baselines3 import PPO

    model = PPO("MlpPolicy", gym.make("lidarena/Env1-v0"), n_steps=16, batch_size=16)
    model.learn(32)


def test_patience_ends_an_episode_that_finds_nothing_new() -> None:
    env = gym.make("lidarena/Env1-v0", patience=4.0, max_episode_steps=500)
    env.reset(seed=0)
    gains, completeness = [0], 0.0
    for step in range(1, 500):
        _, _, terminated, truncated, info = env.step(1)  # turning on the spot soon shows nothing new
        if info["completeness"] >= completeness + 0.001:
            completeness = info["completeness"]
            gains.append(step)
        if terminated or truncated:
            break
    assert truncated and not terminated
    assert step == gains[-1] + 20


@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), "long"])
def test_absurd_patience_is_refused(value: object) -> None:
    with pytest.raises(ConfigError, match="patience"):
        gym.make("lidarena/Env1-v0", patience=value)


def test_the_compass_shows_the_same_hits_as_the_sectors_and_its_needle_turns_with_the_robot() -> None:
    observed = {}
    for kind in ("sectors", "frontier_histogram"):
        env = gym.make("lidarena/Env3-v0", observation=kind)
        env.reset(seed=5)
        observed[kind] = [env.step(action)[0] for action in (0, 1, 1, 1, 2, 0)]
    for sectors, compass in zip(observed["sectors"], observed["frontier_histogram"], strict=True):
        assert compass.shape == (76,)
        near = np.minimum(0.12 / np.maximum(3.5 * sectors[:36], 1e-6), 1.0)
        np.testing.assert_allclose(compass[:36], near, rtol=1e-5)
        np.testing.assert_array_equal(compass[74:], sectors[36:])
        way = np.exp(2j * np.pi / 36 * np.arange(36)) @ compass[36:72] / compass[36:72].sum()
        np.testing.assert_allclose(compass[72:74], [0.5 + 0.5 * way.real, 0.5 + 0.5 * way.imag], atol=1e-5)
