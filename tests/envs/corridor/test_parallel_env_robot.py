"""Teams of robots and lidars of one's own."""

import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from lidarena.base.errors import ConfigError, TeamError
from lidarena.envs import corridor_v0
from lidarena.envs.corridor.options import LIDAR, ROBOT
from tests.envs.corridor.corridor_worlds import EXACT

BOX = [[0.25, 0.1], [-0.25, 0.1], [-0.25, -0.1], [0.25, -0.1]]
AHEAD = {"lidar": {"beams": 45, "field_of_view": math.radians(270.0), "max_range": 6.0, "rate": 2.5}}
HEAD_ON: dict[str, Any] = {"robots": 2, "starts": [(5.0, 7.5), (7.0, 7.5)], "goals": [(9.0, 7.5), (1.0, 7.5)]}


def test_what_is_not_given_is_as_ever() -> None:
    options = corridor_v0.parallel_env().options
    assert options.robot == ROBOT and options.lidar == LIDAR and options.robot.reverse
    assert corridor_v0.parallel_env(robot="turtlebot3_burger").options.robot == ROBOT


@pytest.mark.parametrize(
    "keywords", [AHEAD, {"robot": {"outline": BOX, "max_speed": 1.0}}, {"robot": "turtlebot3_waffle", **AHEAD}]
)
def test_a_team_of_a_batch_is_the_single_one_to_the_bit(keywords: dict[str, Any]) -> None:
    given = {"robots": 3, "map": "unstructured", "places": "random", **keywords}
    vector = gym.make_vec("lidarena/CorridorCentral-v0", 2, "vector_entry_point", **given)
    single = gym.make("lidarena/CorridorCentral-v0", **given)
    vector.action_space.seed(1)
    seen, _ = vector.reset(seed=[3, 4])
    alone, _ = single.reset(seed=4)
    for _ in range(30):
        assert seen[1].tobytes() == alone.tobytes()
        actions = vector.action_space.sample()
        seen, _, ended, _, _ = vector.step(actions)
        if ended[1]:
            break
        alone, *_ = single.step(actions[1])


def test_two_boxes_head_on_collide_with_their_fronts() -> None:
    env = corridor_v0.parallel_env(**HEAD_ON, **EXACT, robot={"outline": BOX}, expose_truth=True)
    env.reset(seed=0)
    gap = 2.0
    while len(env.agents) == 2:
        _, _, _, _, infos = env.step({name: np.array([1.0, 0.0], np.float32) for name in env.agents})
        poses = infos["robot_0"]["truth"]["pose"]
        gap = float(np.hypot(*(poses[0, :2] - poses[1, :2])))
    assert all(info["collision"] for info in infos.values()) and gap == pytest.approx(0.5, abs=0.06)


def test_a_collision_distance_is_a_collision_before_contact() -> None:
    env = corridor_v0.parallel_env(**HEAD_ON, **EXACT, robot={"collision_distance": 0.5}, expose_truth=True)
    env.reset(seed=0)
    while len(env.agents) == 2:
        _, _, _, _, infos = env.step({name: np.array([1.0, 0.0], np.float32) for name in env.agents})
    poses = infos["robot_0"]["truth"]["pose"]
    assert 0.35 < np.hypot(*(poses[0, :2] - poses[1, :2])) < 0.605


def test_a_robot_without_a_reverse_gear_has_six_actions_and_stands_at_the_lowest_speed() -> None:
    env = corridor_v0.parallel_env(robot={"reverse": False}, action="discrete", robots=1)
    assert env.action_space("robot_0") == gym.spaces.Discrete(6)
    env = corridor_v0.parallel_env(robot={"reverse": False}, robots=1, **EXACT)
    _, infos = env.reset(seed=0)
    before = infos["robot_0"]["pose"].copy()
    *_, infos = env.step({"robot_0": np.array([-1.0, 0.0], np.float32)})
    assert infos["robot_0"]["pose"] == pytest.approx(before)


@pytest.mark.parametrize(
    ("keywords", "kind", "says"),
    [
        ({"robot": {"radius": 0.6}}, TeamError, "does not fit"),
        ({"robot": {"radius": 1.5}}, ConfigError, "robot.radius = 1.5"),
        ({"robot": "wafle"}, ConfigError, "Allowed: jackal"),
        ({"lidar": {"beams": 0}}, ConfigError, "lidar.beams = 0"),
        ({"lidar": {"max_range": 0.1}}, ConfigError, "lidar.max_range = 0.1"),
        ({"robot": {}, "radius": 0.2}, ConfigError, "earlier form"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(keywords: dict[str, Any], kind: type, says: str) -> None:
    with pytest.raises(kind, match=says):
        corridor_v0.parallel_env(**keywords)


def test_earlier_keywords_mean_the_same_and_warn() -> None:
    with pytest.warns(DeprecationWarning) as caught:
        old = corridor_v0.parallel_env(radius=0.2, beams=20, lidar_range=5.0, lidar_noise=0.0)
    new = corridor_v0.parallel_env(robot={"radius": 0.2}, lidar={"beams": 20, "max_range": 5.0, "noise": 0.0})
    assert old.options == new.options and len(caught) == 4
