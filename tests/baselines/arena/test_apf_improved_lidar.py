import gymnasium as gym
import numpy as np
import pytest

import lidarena
from lidarena.world.floorplan import Floorplan
from tests.baselines.arena.arena_drives import EMPTY, drive, over_astar


def test_nothing_seen_is_planned_once() -> None:
    env = gym.make("lidarena/Arena-v0", arena=EMPTY, knowledge="lidar")
    policy = lidarena.baselines.make("apf_improved_lidar", env)
    observation, info = env.reset(seed=0)
    policy.reset(seed=0)
    for _ in range(10):
        observation, _, _, _, info = env.step(policy.act(observation, info))
    assert policy.plans == 1


def test_what_comes_into_sight_is_planned_around() -> None:
    env = gym.make("lidarena/Arena-v0", arena="u_trap:3", knowledge="lidar")
    policy = lidarena.baselines.make("apf_improved_lidar", env)
    observation, info = env.reset(seed=0)
    policy.reset(seed=0)
    ended, least = False, np.inf
    while not ended:
        observation, _, terminated, truncated, info = env.step(policy.act(observation, info))
        ended, least = terminated or truncated, min(least, float(np.min(info["scan"])))
    assert info["success"] and policy.plans > 1 and least > info["radius"]


def test_a_new_episode_forgets_what_was_seen() -> None:
    first, second = (drive("apf_improved_lidar", arena="u_trap:1", knowledge="lidar") for _ in range(2))
    assert first[0] == second[0] and first[1]["decisions"] == second[1]["decisions"]


def walls(seed: int) -> tuple[Floorplan, tuple[float, float]]:
    """A room of 10 m with 14 thin walls, from 1 to 3 m long, at any angle, and the goal on its other side."""
    rng, drawn, ends = np.random.default_rng(seed), [], np.array([[1.0, 5.0], [9.0, 5.0]])
    while len(drawn) < 14:
        middle, angle, half = rng.uniform(1.5, 8.5, 2), rng.uniform(0.0, np.pi), rng.uniform(0.5, 1.5)
        wall = middle + half * np.linspace(-1, 1, 50)[:, None] * np.array([np.cos(angle), np.sin(angle)])
        far = np.hypot(*(wall - ends[:, None]).transpose(2, 0, 1)).min() >= 0.6
        if far and wall.min() >= 0.2 and wall.max() <= 9.8:
            drawn.append((*wall[0], *wall[-1]))
    room = [(0, 0, 10, 0), (10, 0, 10, 10), (10, 10, 0, 10), (0, 10, 0, 0)]
    plan = Floorplan.from_shapes("walls", (0, 0, 10, 10), [*drawn, *room], thickness=0.1, start=(*ends[0], 0.0))
    return plan, (9.0, 5.0)


@pytest.mark.parametrize("seed", [900009, 900013, 900035, 900039, 900040, 900048, 900055, 900057])
def test_ends_of_walls_between_two_beams_are_not_cut(seed: int) -> None:
    plan, goal = walls(seed)
    end, info = drive("apf_improved_lidar", arena=plan, goal=goal, knowledge="lidar")
    assert end == "success" and info["least"] > 0.0


def test_dense_arenas_are_crossed_and_not_gone_around() -> None:
    ratios = []
    for seed in (70001, 70003, 70004, 70007, 70008, 70011):
        keywords = {"arena": f"random:{seed}", "density": 0.27, "knowledge": "lidar"}
        env = gym.make("lidarena/Arena-v0", **keywords)
        start = tuple(env.reset(seed=0)[1]["pose"][:2])
        end, info = drive("apf_improved_lidar", **keywords)
        assert end == "success"
        ratios.append(over_astar(info, start))
    assert np.mean(ratios) < 1.35
