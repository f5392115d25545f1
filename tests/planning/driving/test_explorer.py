"""The compiled explorer against the baseline in plain Python, whose steps it takes."""

import math
from typing import Any

import numpy as np
import pytest

import lidarena
from lidarena.planning.driving.candidates import FRONTIER, PLACE, Candidates
from lidarena.planning.driving.explorer import CHOOSES, ENDINGS, ENDS, advance, command, set_out
from lidarena.world.floorplan import Floorplan
from tests.baselines.exploration.plain_rules import PlainNearestFrontier
from tests.planning.driving.worlds import hired, make_world, perceived


def nearest(candidates: Candidates) -> int:
    """What ``nearest_frontier`` chooses."""
    count = candidates.number[0]
    costs = candidates.way[0, :count] + candidates.turn[0, :count] / math.pi
    costs -= 0.5 * np.minimum(candidates.size[0, :count], 2.0)
    costs[candidates.kind[0, :count] != FRONTIER] = np.inf
    if candidates.pursued[0] >= 0:
        costs[candidates.pursued[0]] -= 1.0
    return int(np.argmin(costs))


def drive(env: Any, info: dict[str, Any], steps: int, places: int = 0, most: int = 24) -> tuple[list[int], Any, bool]:
    driver, settings, explorers = hired(env, info, places, most)
    actions, ended = [], False
    for _ in range(steps):
        told = perceived(info)
        status = advance(0, math.log(info["d_optimality"]), told, driver, settings, explorers)
        ended = status == ENDS
        if ended:
            break
        if status == CHOOSES:
            set_out(0, nearest(explorers.candidates), told, driver, explorers)
        actions.append(command(0, told, driver, explorers))
        info = env.step(actions[-1])[4]
    return actions, explorers, ended


@pytest.mark.parametrize(("seed", "slam"), [(1, "truth"), (2, "rbpf")])
def test_it_drives_as_the_baseline_does_to_the_bit(seed: int, slam: str) -> None:
    env, info = make_world(seed, slam=slam)
    policy = lidarena.baselines.make("nearest_frontier", env)
    policy.reset()
    observation, expected, told = None, [], info
    while not policy.finished and len(expected) < 500:
        expected.append(int(policy.act(observation, told)))
        observation, _, _, _, told = env.step(expected[-1])
    again = env.reset(seed=seed)[1]
    actions, _, ended = drive(env, again, len(expected))
    assert actions == expected[: len(actions)] and len(actions) >= len(expected) - 2
    assert ended == policy.finished


def test_few_candidates_of_many_are_the_nearest() -> None:
    env, info = make_world(4, map="maze:9?width=8&height=8&loops=0.3")
    _, explorers, _ = drive(env, info, 250, places=6, most=3)
    candidates = explorers.candidates
    assert 0 < candidates.number[0] <= 3
    ways = candidates.way[0, : candidates.number[0]]
    assert (np.diff(ways) >= 0.0).all() and candidates.pursued[0] < 3


def test_places_that_are_known_are_offered_once_the_robot_is_away_from_them() -> None:
    env, info = make_world(5)
    _, explorers, _ = drive(env, info, 200, places=6)
    candidates = explorers.candidates
    count = candidates.number[0]
    places = candidates.kind[0, :count] == PLACE
    assert places.any() and (candidates.way[0, :count][places] > 2.0).all()
    assert (candidates.since[0, :count][places] > 0.0).all()


def two_rooms(door: float) -> Floorplan:
    walls = [(0, 0, 5, 0), (0, 2.5, 5, 2.5), (0, 0, 0, 2.5), (5, 0, 5, 2.5)]
    walls += [(2.5, 0, 2.5, 1.25 - door / 2), (2.5, 1.35 + door / 2, 2.5, 2.5)]
    return Floorplan.from_shapes("two rooms", (-0.1, -0.1, 5.1, 2.6), walls, thickness=0.1, start=(1.2, 1.2, 0.3))


@pytest.mark.parametrize(("door", "ending"), [(0.8, "explored"), (0.45, "out of reach")])
def test_it_says_why_it_ends_as_the_baseline_does(door: float, ending: str) -> None:
    env, info = make_world(map=two_rooms(door), start=None)
    policy = PlainNearestFrontier(env)
    observation, expected, told = None, [], info
    while not policy.finished and len(expected) < 900:
        assert policy.ending == ""
        expected.append(int(policy.act(observation, told)))
        observation, _, _, _, told = env.step(expected[-1])
    assert policy.ending == ending and not told["collision"]
    assert (told["completeness"] > 0.99) == (ending == "explored")
    again = env.reset(seed=1)[1]
    actions, explorers, ended = drive(env, again, len(expected))
    assert ended and actions == expected[: len(actions)]
    assert ENDINGS[explorers.ending[0]] == ending
