"""The combined reward adds up, over an episode, to what a comparison measures."""

import math

import gymnasium as gym
import numpy as np
import pytest

import lidarena
from lidarena.envs.exploration.rewards import CERTAIN_ENOUGH, REWARDS, USUAL_STEPS

COMBINED_WEIGHTS = REWARDS.presets["combined"]
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


@pytest.mark.parametrize("enough", [CERTAIN_ENOUGH, 1e-9, 1e-3])
def test_the_terms_add_up_to_what_is_measured(enough: float) -> None:
    _, infos = drive(gym.make("lidarena/Exploration-v0", map=MAZE, reward="combined", certain_enough=enough))
    total, weights, first, last = terms(infos), COMBINED_WEIGHTS, infos[0], infos[-1]
    assert total["completeness"] == pytest.approx(
        weights["completeness"] * (last["completeness"] - first["completeness"])
    )
    assert total["path"] == pytest.approx(-weights["path"] * last["path_length"] / (0.55 * AREA))
    usual = [math.log(max(CERTAIN_ENOUGH, enough))]
    mean = np.mean(usual * USUAL_STEPS + [math.log(max(info["d_optimality"], enough)) for info in infos[1:]])
    assert total["uncertainty"] == pytest.approx(-weights["uncertainty"] * (AREA / 56) ** 1.5 * (mean - usual[0]))


def test_weights_scale_their_terms_and_leave_the_drive_alone() -> None:
    _, plain = drive(gym.make("lidarena/Exploration-v0", map=MAZE, reward="combined"))
    weights = {"path": 2 * COMBINED_WEIGHTS["path"], "uncertainty": 0.0}
    _, other = drive(gym.make("lidarena/Exploration-v0", map=MAZE, reward={"preset": "combined", **weights}))
    before, after = terms(plain), terms(other)
    assert after["path"] == pytest.approx(2 * before["path"]) and after["uncertainty"] == 0.0
    assert after["completeness"] == before["completeness"]


def test_a_collision_costs_its_weight_and_takes_nothing_else_away() -> None:
    env = gym.make("lidarena/Env1-v0", reward={"preset": "combined", "collision": 7.0})
    env.reset(seed=0)
    ended, info = False, {}
    while not ended:
        _, reward, ended, _, info = env.step(0)
    assert info["collision"] and info["reward_terms"]["collision"] == -7.0
    assert reward == pytest.approx(sum(info["reward_terms"].values()))


@pytest.mark.parametrize("world", ["env2", "turtlebot3_world"])
def test_exploring_is_worth_more_than_standing_still(world: str) -> None:
    env = gym.make("lidarena/Exploration-v0", map=world, reward="combined", action="continuous", max_episode_steps=900)
    totals = {}
    for name in ("still", "frontier"):
        observation, info = env.reset(seed=1)
        policy = lidarena.baselines.make("frontier", env)
        policy.reset(seed=0)
        total, ended = 0.0, False
        while not ended:
            action = np.array([-1.0, 0.0], np.float32) if name == "still" else policy.act(observation, info)
            observation, reward, terminated, truncated, info = env.step(action)
            total, ended = total + float(reward), terminated or truncated
        totals[name] = total
    assert abs(totals["still"]) < 0.5 and totals["frontier"] > 3.0


def test_no_floor_plan_weighs_more_than_the_largest_that_the_weights_were_chosen_in() -> None:
    costs = []
    for size in ("width=7&height=13", "width=13&height=14"):  # 91 m² and twice as much
        _, infos = drive(gym.make("lidarena/Exploration-v0", map=f"maze:1?{size}", reward="combined", slam="truth",
                                  certain_enough=1e-9))  # fmt: skip
        costs.append(sum(info["reward_terms"]["uncertainty"] for info in infos[1:]) / terms_per_step(infos))
    assert costs[0] == pytest.approx(costs[1])


def terms_per_step(infos: list[dict]) -> float:
    """What the mean of ln D has fallen by, D being what it is with known poses."""
    usual, floor = math.log(CERTAIN_ENOUGH), math.log(infos[-1]["d_optimality"])
    return (usual - floor) * (len(infos) - 1) / (len(infos) - 1 + USUAL_STEPS)
