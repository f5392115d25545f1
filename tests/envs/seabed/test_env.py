"""The seabed environment: Gymnasium's rules, flights to the end, refusals, batches to the bit."""

from typing import Any

import gymnasium as gym
import numpy as np
import pytest
from gymnasium.utils.env_checker import check_env
from stable_baselines3.common.env_checker import check_env as check_for_sb3

from lidarena import baselines
from lidarena.base.errors import ActionError, ConfigError
from tests.envs.seabed.short_flights import SHORT, made


def flown(env: gym.Env[Any, Any], number: int, mode: int = 0) -> dict[str, Any]:
    """The last info of a flight with always the same action."""
    _, info = env.reset(seed=0)
    while True:
        _, _, terminated, truncated, info = env.step(np.array([number, mode]))
        if terminated or truncated:
            return info


def test_the_checkers_find_nothing() -> None:
    check_env(made(duration=2.0, render_mode="rgb_array").unwrapped)
    check_for_sb3(made(duration=2.0))


@pytest.mark.parametrize("mode", [0, 1, 2])
@pytest.mark.parametrize("angles", [None, "fuse", "replace"])
def test_a_flight_is_followed_to_its_end(mode: int, angles: str | None) -> None:
    info = flown(made(angles=angles, expose_truth=True), 2, mode)
    assert info["success"] and not info["collision"] and info["frames_left"] == 0
    assert info["time"] == 4.0 and info["refusals"] == 0 and info["truth"]["error"] < 0.02
    assert info["path_length"] == pytest.approx(info["truth"]["path_length"], rel=0.05)
    assert info["positions"] == (5 if mode < 2 else 10) or mode == 2


def test_the_6_cloud_step_costs_more_and_longer_steps_less() -> None:
    computes = [flown(made(), number, mode)["compute"] for number, mode in ((3, 0), (2, 0), (2, 1), (2, 2))]
    assert computes == sorted(computes) and computes[3] > 2.0 * computes[1]


@pytest.mark.parametrize(
    "switch", [{"clip": True}, {"velocity_log": True}, {"objective": "clouds"}, {"features": "orb"}]
)
def test_every_switch_flies(switch: dict[str, Any]) -> None:
    info = flown(made(expose_truth=True, **switch), 2)
    assert info["success"] and info["truth"]["error"] < (0.3 if "features" in switch else 0.1)


def test_too_long_a_step_is_refused_costs_and_changes_nothing_else() -> None:
    env = made(duration=12.0, speed=2.0, skips=[5, 60])
    _, before = env.reset(seed=0)
    _, reward, _, _, info = env.step(np.array([1, 0]))
    assert info["refused"] and info["refusals"] == 1 and info["frame"] == 0 and info["positions"] == 0
    assert np.array_equal(info["pose"], before["pose"]) and info["compute"] > before["compute"] and reward < 0.0
    _, _, _, _, info = env.step(np.array([0, 0]))
    assert not info["refused"] and info["frame"] == 5


def test_the_reward_is_drift_and_compute() -> None:
    env = made(expose_truth=True, reward={"drift": 1.0, "compute": 1.0})
    _, before = env.reset(seed=1)
    _, reward, _, _, info = env.step(np.array([2, 0]))
    moved = (100 * info["truth"]["error"]) ** 2  # from none
    assert reward == pytest.approx(-moved - 10 * (info["compute"] - before["compute"]))
    assert info["reward_terms"].keys() == {"drift", "compute"}


def test_a_batch_is_its_worlds_to_the_bit() -> None:
    batch = gym.make_vec("lidarena/Seabed-v0", 3, "vector_entry_point", **SHORT)
    alone = [made() for _ in range(3)]
    seen, _ = batch.reset(seed=5)
    for world, env in enumerate(alone):
        assert np.array_equal(env.reset(seed=5 + world)[0], seen[world])
    batch.action_space.seed(2)
    for _ in range(3):
        actions = batch.action_space.sample()
        seen, rewards, _, _, infos = batch.step(actions)
        for world, env in enumerate(alone):
            one, reward, _, _, info = env.step(actions[world])
            assert np.array_equal(one, seen[world]) and reward == rewards[world]
            assert info["compute"] == infos["compute"][world]


def test_bad_actions_are_refused() -> None:
    env = made()
    env.reset(seed=0)
    with pytest.raises(ActionError, match="0 to 3 for the skip"):
        env.step(np.array([9, 0]))


def test_seeds_choose_seabeds_only_where_asked_to() -> None:
    drawn, by_seed = made().unwrapped, made(pick="by_seed").unwrapped
    for env in (drawn, by_seed):
        env.reset(seed=0)
    assert drawn.episodes.vehicles[0].number == 2**31 and by_seed.episodes.vehicles[0].number == 0


def test_an_overlap_may_be_chosen_instead_of_a_skip() -> None:
    env, plain = made(overlaps=[0.9, 0.6]), made()
    skips = []
    for number in (0, 1):
        _, info = env.reset(seed=0)
        rule = baselines.make("adaptive_step", plain, overlap=(0.9, 0.6)[number])
        wanted = plain.unwrapped.options.skips[rule.act(None, info)[0]]  # type: ignore[attr-defined]
        info = env.step(np.array([number, 0]))[4]
        assert info["skip"] == wanted
        skips.append(info["skip"])
    assert env.action_space.nvec.tolist() == [2, 3] and skips[0] < skips[1]
    with pytest.raises(ConfigError, match="chooses skips, but the environment's actions are overlaps"):
        baselines.make("fixed_step", env)
