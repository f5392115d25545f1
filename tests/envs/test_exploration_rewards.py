"""The combined reward adds up, over an episode, to what a comparison measures."""

import math

import gymnasium as gym
import numpy as np
import pytest

from lidarena.envs.exploration_options import COMBINED_WEIGHTS
from lidarena.envs.exploration_rewards import USUAL_D_OPTIMALITY, USUAL_STEPS

MAZE = "maze:3?width=6&height=7"
AREA = 42.0


def drive(env: gym.Env, steps: int = 120) -> tuple[list[float], list[dict]]:
    """Rewards and infos of some random driving, the first info that of the reset."""
    rng = np.random.default_rng(0)
    rewards, infos = [], [env.reset(seed=2)[1]]
    for _ in range(steps):
        _, reward, terminated, truncated, info = env.step(int(rng.choice(3, p=[0.4, 0.4, 0.2])))
        rewards.append(float(reward))
        infos.append(info)
        if terminated or truncated:
            break
    return rewards, infos


def terms(infos: list[dict]) -> dict[str, float]:
    """Sum of each term."""
    return {name: sum(info["reward_terms"][name] for info in infos[1:]) for name in COMBINED_WEIGHTS}


def test_every_step_is_worth_its_terms() -> None:
    rewards, infos = drive(gym.make("lidarena/Exploration-v0", map=MAZE, reward="combined"))
    for reward, info in zip(rewards, infos[1:], strict=True):
        assert reward == pytest.approx(sum(info["reward_terms"].values()))
    assert all(value == 0.0 for value in infos[0]["reward_terms"].values())


def test_the_terms_add_up_to_what_is_measured() -> None:
    _, infos = drive(gym.make("lidarena/Exploration-v0", map=MAZE, reward="combined"))
    total, weights, first, last = terms(infos), COMBINED_WEIGHTS, infos[0], infos[-1]
    assert total["completeness"] == pytest.approx(
        weights["completeness"] * (last["completeness"] - first["completeness"])
    )
    assert total["path"] == pytest.approx(-weights["path"] * last["path_length"] / (0.55 * AREA))
    usual = [math.log(USUAL_D_OPTIMALITY)]
    mean = np.mean(usual * USUAL_STEPS + [math.log(info["d_optimality"]) for info in infos[1:]])
    assert total["uncertainty"] == pytest.approx(-weights["uncertainty"] * (AREA / 56) ** 2 * (mean - usual[0]))


def test_weights_scale_their_terms_and_leave_the_drive_alone() -> None:
    _, plain = drive(gym.make("lidarena/Exploration-v0", map=MAZE, reward="combined"))
    weights = {"path": 2 * COMBINED_WEIGHTS["path"], "uncertainty": 0.0}
    _, other = drive(gym.make("lidarena/Exploration-v0", map=MAZE, reward="combined", weights=weights))
    before, after = terms(plain), terms(other)
    assert after["path"] == pytest.approx(2 * before["path"]) and after["uncertainty"] == 0.0
    assert after["completeness"] == before["completeness"]


def test_a_collision_costs_its_weight_and_takes_nothing_else_away() -> None:
    env = gym.make("lidarena/Env1-v0", reward="combined", weights={"collision": 7.0})
    env.reset(seed=0)
    ended, info = False, {}
    while not ended:
        _, reward, ended, _, info = env.step(0)
    assert info["collision"] and info["reward_terms"]["collision"] == -7.0
    assert reward == pytest.approx(sum(info["reward_terms"].values()))
