"""Exploration with robots and lidars of one's own."""

import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from lidarena.base.errors import ConfigError, MapError
from lidarena.envs import ExplorationEnv
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import LidarSpec
from lidarena.world.robots import RobotSpec

AHEAD = {"beams": 181, "field_of_view": math.radians(270.0), "max_range": 5.0}
HALL = Floorplan.from_shapes(
    "hall", (0, 0, 6, 4), walls=[(0, 0, 6, 0), (6, 0, 6, 4), (6, 4, 0, 4), (0, 4, 0, 0)], start=(3, 2, 0)
)
FOREIGN: list[dict[str, Any]] = [
    {"lidar": AHEAD, "observation": "sectors"},
    {"lidar": "hokuyo_urg_04lx", "robot": "turtlebot3_waffle", "observation": "map", "action": "continuous"},
    {"lidar": {"rate": 2.0, "min_range": 0.3}, "robot": {"radius": 0.15, "reverse": True}, "action": "continuous"},
    {"robot": "jackal", "lidar": {"beams": 90}, "observation": "frontier_histogram"},
    {"robot": "turtlebot3_waffle", "lidar": {"beams": 90, "field_of_view": 4.0}, "observation": "frontier_arcs"},
]


def test_what_is_not_given_is_da_slams() -> None:
    options = ExplorationEnv(map="env1").options
    assert options.robot == RobotSpec() and options.lidar == LidarSpec() and options.robot.bumper == 0.12
    same = ExplorationEnv(map="env1", robot="turtlebot3_burger", lidar={}).options
    assert same.robot == options.robot and same.lidar == options.lidar


@pytest.mark.parametrize("keywords", FOREIGN)
def test_a_world_of_a_batch_is_the_single_one_to_the_bit(keywords: dict[str, Any]) -> None:
    given = {"map": "env3", "particles": 5, "stop_at": None} | keywords
    vector = gym.make_vec("lidarena/Exploration-v0", 2, "vector_entry_point", **given)
    single = ExplorationEnv(**given)
    vector.action_space.seed(1)
    seen, _ = vector.reset(seed=[3, 4])
    alone, _ = single.reset(seed=4)
    for _ in range(25):
        for name, value in seen.items() if isinstance(seen, dict) else [("", seen)]:
            assert value[1].tobytes() == (alone[name] if name else alone).tobytes()
        assert single.observation_space.contains(alone)
        actions = vector.action_space.sample()
        seen, _, ended, _, _ = vector.step(actions)
        if ended[1]:
            break
        alone, *_ = single.step(actions[1])


@pytest.mark.parametrize("robot", [{"max_speed": 1.0, "max_turn_rate": 3.0}, {"max_speed": 0.2}])
def test_actions_go_to_the_limits_of_the_robot(robot: dict[str, float]) -> None:
    limits = {"max_turn_rate": 1.0} | robot
    exact = {"map": HALL, "slam": "truth", "odometry_noise": 0.0, "expose_truth": True, "robot": robot}
    env = ExplorationEnv(**exact)
    _, info = env.reset(seed=0)
    x = info["truth"]["pose"][0]
    assert env.step(0)[4]["truth"]["pose"][0] - x == pytest.approx(0.2 * limits["max_speed"])
    env = ExplorationEnv(**exact, action="continuous")
    env.reset(seed=0)
    assert env.step(np.array([-1.0, 1.0]))[4]["truth"]["pose"][2] == pytest.approx(0.2 * limits["max_turn_rate"])


def test_a_reverse_gear_drives_backwards() -> None:
    env = ExplorationEnv(map=HALL, slam="truth", action="continuous", expose_truth=True, robot={"reverse": True})
    env.reset(seed=0)
    assert env.step(np.array([-1.0, 0.0]))[4]["truth"]["pose"][0] == pytest.approx(2.9)


@pytest.mark.parametrize(
    ("robot", "lidar", "stops"),
    [
        ({}, {}, 5.83),
        ({"radius": 0.3}, {}, 5.635),
        ({"collision_distance": 0.2}, {}, 5.75),
        ({}, {"beams": 4}, 5.83),
        ({}, {"beams": 50, "field_of_view": 0.5}, 5.83),
        ({"outline": [[0.1, 0.25], [-0.1, 0.25], [-0.1, -0.25], [0.1, -0.25]]}, {}, 5.835),
    ],
)
def test_a_robot_collides_where_its_bumper_meets_the_wall(
    robot: dict[str, Any], lidar: dict[str, Any], stops: float
) -> None:
    env = ExplorationEnv(
        map=HALL, slam="truth", expose_truth=True, robot=robot, lidar=lidar, observation="map", stop_at=None
    )
    _, info = env.reset(seed=0)
    ended, before = False, 0.0
    while not ended:
        before = info["truth"]["pose"][0]
        _, _, ended, cut_off, info = env.step(0)
        assert not cut_off
    assert info["collision"] and before < stops + 1e-6 and info["truth"]["pose"][0] > stops - 0.01


def test_nobody_collides_backwards_with_what_a_lidar_ahead_does_not_see() -> None:
    """The bumper tells of what is behind the robot."""
    env = ExplorationEnv(
        map=HALL, slam="truth", action="continuous", observation="sectors", robot={"reverse": True},
        lidar={"beams": 60, "field_of_view": 2.0},
    )  # fmt: skip
    env.reset(seed=0)
    ended = False
    for _ in range(40):
        _, _, ended, _, info = env.step(np.array([-1.0, 0.0]))
        if ended:
            break
    assert ended and info["collision"]


@pytest.mark.parametrize("slam", ["rbpf", "truth", "odometry"])
def test_between_two_scans_of_a_slow_lidar_the_map_stays(slam: str) -> None:
    env = ExplorationEnv(map="env1", slam=slam, observation="map", lidar={"rate": 1.0})
    seen, info = env.reset(seed=0)
    scans = maps = 0
    for _ in range(20):
        before, known = seen["scan"].copy(), info["map"].copy()
        seen, _, _, _, info = env.step(0)
        scans += not np.array_equal(seen["scan"], before)
        maps += not np.array_equal(info["map"], known)
    assert scans == 4 and 1 <= maps <= 4


def test_ranges_below_the_least_are_zero_and_out_of_view_they_are_the_longest() -> None:
    env = ExplorationEnv(map=HALL, observation="sectors", lidar=AHEAD | {"min_range": 2.5, "noise": 0.0})
    seen, _ = env.reset(seed=0)
    assert seen[0] == pytest.approx(2.95 / 5.0, abs=1e-3) and seen[18] == 1.0 and seen[9] == 0.0


@pytest.mark.parametrize(
    ("keywords", "kind", "says"),
    [
        ({"lidar": {"field_of_view": 2.0}}, ConfigError, "observation 'da_slam'"),
        ({"lidar": {"beams": 20}, "observation": "frontier_histogram"}, ConfigError, "take more beams"),
        ({"lidar": {"max_range": 0.2}}, ConfigError, "lidar.max_range = 0.2"),
        ({"lidar": {"rate": 10.0}}, ConfigError, "at most 5 Hz"),
        ({"robot": {"radius": 2.5}}, MapError, "does not fit at the start"),
        ({"robot": {"radius": 2.5}, "start": "random"}, MapError, "does not fit at the start"),
        ({"robot": "jackl"}, ConfigError, "did you mean 'jackal'"),
        ({"lidar": {}, "lidar_noise": 0.1}, ConfigError, "earlier form"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(keywords: dict[str, Any], kind: type, says: str) -> None:
    with pytest.raises(kind, match=says) as caught:
        ExplorationEnv(**{"map": HALL, **keywords})
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("earlier", "now"),
    [
        ({"lidar_noise": 0.05}, {"lidar": {"noise": 0.05}}),
        ({"collision_distance": 0.2}, {"robot": {"collision_distance": 0.2}}),
    ],
)
def test_earlier_keywords_mean_the_same_and_warn(earlier: dict[str, Any], now: dict[str, Any]) -> None:
    with pytest.warns(DeprecationWarning, match=next(iter(earlier))):
        old = ExplorationEnv(map="env1", **earlier)
    new = ExplorationEnv(map="env1", **now)
    assert old.options == new.options
