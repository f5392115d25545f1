"""``slam=`` in the environments: every estimator, the package's and one's own, drives the same interfaces."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
import yaml
from numba import config

import lidarena
from lidarena.base.errors import ConfigError
from lidarena.envs import BatchedExploration, ExplorationEnv, set_num_threads
from lidarena.evaluation.participants import make_env
from tests.envs.exploration.test_env_batch import alone, together
from tests.slam.ray_mapper import RayMapper, SavedMapper

OWN = "tests.slam.ray_mapper:RayMapper"
FILTER_ALONE = {"entropy", "n_eff", "entropy_gmapping"}


@pytest.mark.parametrize("slam", [SavedMapper, {"name": OWN, "drift": 0.01}])
def test_an_estimator_of_ones_own_does_in_a_batch_what_it_does_alone(slam: Any) -> None:
    keywords = {"slam": slam, "observation": "map"}
    singles = [alone(seed, keywords) for seed in range(3)]
    try:
        for count, threads in ((1, 1), (3, 1), (3, 2)):
            set_num_threads(threads)
            assert together(count, keywords) == singles[:count]
    finally:
        set_num_threads(config.NUMBA_NUM_THREADS)


def explored(steps: int = 500, **keywords: Any) -> dict[str, Any]:
    """The last info of frontier exploration in a small world."""
    env = gym.make("lidarena/Env1-v0", expose_truth=True, max_episode_steps=steps, **keywords)
    policy = lidarena.baselines.make("frontier", env)
    observation, info = env.reset(seed=0)
    policy.reset(seed=0)
    over = False
    while not (over or policy.finished):
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        over = terminated or truncated
    return info


@pytest.mark.parametrize("slam", [OWN, "odometry"])
def test_frontier_drives_on_its_map(slam: str) -> None:
    info = explored(slam=slam, odometry_noise=0.2)
    assert info["completeness"] > 0.6 and not info["collision"]


def test_dead_reckoning_goes_astray_where_the_filter_does_not() -> None:
    worlds, errors = 6, {}
    for slam in ("odometry", "rbpf"):
        batch = BatchedExploration(worlds, map="env3", slam=slam, expose_truth=True, stop_at=None)
        _, infos = batch.reset(seed=0)
        away = []
        for k in range(80):
            infos = batch.step(np.full(worlds, 0 if k % 8 < 2 else 1))[4]
            away.append(np.hypot(*(infos["pose"] - infos["truth"]["pose"])[:, :2].T))
        errors[slam] = float(np.mean(away))
    assert errors["odometry"] > 3 * errors["rbpf"]


def test_keywords_in_yaml_make_it() -> None:
    text = f'{{map: env1, slam: {{name: "{OWN}", drift: 0.25}}, render_mode: rgb_array}}'
    env = make_env("lidarena/Exploration-v0", yaml.safe_load(text))
    env.reset(seed=0)
    assert env.unwrapped.episodes.core.estimator.each[0].drift == 0.25  # type: ignore[attr-defined]
    batch = gym.make_vec("lidarena/Env1-v0", 2, "vector_entry_point", **yaml.safe_load(f'slam: "{OWN}"'))
    batch.reset(seed=0)
    assert batch.step(np.zeros(2, np.int64))[0].shape == (2, 7)


@pytest.mark.parametrize("slam", ["rbpf", "graph", "odometry", "truth", RayMapper])
def test_it_is_drawn_and_told(slam: Any) -> None:
    env = ExplorationEnv(map="env1", slam=slam, render_mode="rgb_array")
    env.reset(seed=0)
    first = env.render()
    for _ in range(8):
        *_, info = env.step(0)
    picture = env.render()
    assert first is not None and picture is not None and picture.shape == first.shape
    half = picture.shape[1] // 2
    for panel in (slice(0, half), slice(half, None)):  # the truth, and what is believed
        assert (picture[:, panel] != first[:, panel]).mean() > 0.002
    assert FILTER_ALONE & set(info) == (FILTER_ALONE if slam == "rbpf" else set())


@pytest.mark.parametrize("slam", ["odometry", "truth", "rbpf"])
def test_a_saved_state_continues_to_the_bit(slam: str) -> None:
    keywords: dict[str, Any] = {"map": ["env1", "env2"], "slam": slam, "max_episode_steps": 25}
    batches = [BatchedExploration(3, **keywords) for _ in range(2)]
    batches[0].reset(seed=0)
    for k in range(30):
        batches[0].step(np.full(3, k % 3))
    batches[1].set_state(batches[0].get_state())
    for k in range(30):
        results = [batch.step(np.full(3, k % 2)) for batch in batches]
        for name in ("pose", "covariance", "d_optimality", "map", "completeness"):
            assert np.array_equal(results[0][4][name], results[1][4][name]), name


def test_where_there_is_no_entropy_the_map_observation_tells_none() -> None:
    for slam in ("odometry", "truth", RayMapper):
        env = ExplorationEnv(map="env1", slam=slam, observation="map")
        env.reset(seed=0)
        for _ in range(5):
            observation = env.step(0)[0]
        assert env.observation_space.contains(observation) and observation["state"][-1] == 0.0


@pytest.mark.parametrize("slam", ["odometry", RayMapper])
def test_an_observation_of_the_entropy_needs_one(slam: Any) -> None:
    with pytest.raises(ConfigError, match=r"slam = '(odometry|RayMapper)' has no entropy"):
        ExplorationEnv(map="env1", slam=slam, observation="da_slam_entropy")
    assert ExplorationEnv(map="env1", slam="truth", observation="da_slam_entropy").reset(seed=0)[0][-1] == 0.0


def test_ealc_says_which_uncertainty_there_is() -> None:
    env = gym.make("lidarena/Env1-v0", slam="odometry")
    policy = lidarena.baselines.make("ealc", env, uncertainty="entropy")
    with pytest.raises(ConfigError, match="gives no entropy; choose uncertainty='d_optimality'"):
        policy.act(*env.reset(seed=0))


def test_particles_are_the_filters() -> None:
    for slam in ("odometry", RayMapper):
        with pytest.raises(ConfigError, match="particles = 5 are for slam='rbpf', not"):
            ExplorationEnv(slam=slam, particles=5)
    with pytest.warns(DeprecationWarning, match="particles = 5 are for slam='rbpf'"):
        ExplorationEnv(slam="truth", particles=5)
    with pytest.raises(ConfigError, match="particles = 5 contradict slam"):
        ExplorationEnv(slam={"name": "rbpf", "particles": 6}, particles=5)
    for keywords in ({"particles": 4}, {"slam": {"name": "rbpf", "particles": 4}}):
        env = ExplorationEnv(map="env1", **keywords)  # type: ignore[arg-type]
        assert env.episodes.core.estimator.particles.shape == (1, 4, 3)
