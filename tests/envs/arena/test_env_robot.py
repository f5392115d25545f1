"""Arenas with robots and lidars of one's own."""

import math
from typing import Any

import gymnasium as gym
import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.envs import ArenaEnv
from lidarena.world.arenas import Arena

ROOM = Arena("room", np.array([[60.0, 50.0, 5.0]]), (40.0, 50.0), (90.0, 50.0), (0.0, 0.0, 100.0, 100.0), 1.0)
AHEAD = {"beams": 45, "field_of_view": math.pi, "rate": 0.5}


def test_what_is_not_given_is_to_scale_and_the_arenas_own() -> None:
    options = ArenaEnv(arena=ROOM).options
    assert (options.robot.radius, options.robot.max_speed) == (1.0, 1.0)
    assert (options.lidar.beams, options.lidar.max_range, options.lidar.noise) == (36, 30.0, 0.0)
    assert (options.decision_period, options.goal_radius) == (1.0, 1.0)
    small = ArenaEnv(arena="env2", start=(1.0, 1.0), goal=(5.0, 6.0)).options
    assert small.lidar.max_range == pytest.approx(3.0) and small.decision_period == 0.1


@pytest.mark.parametrize(
    "keywords",
    [
        {"lidar": AHEAD},
        {"robot": {"outline": [[1.0, 0.4], [-1.0, 0.4], [-1.0, -0.4], [1.0, -0.4]]}},
        {"robot": "jackal"},
    ],
)
def test_a_world_of_a_batch_is_the_single_one_to_the_bit(keywords: dict[str, Any]) -> None:
    given = {"arena": ["u_trap", "random"], **keywords}
    vector = gym.make_vec("lidarena/Arena-v0", 2, "vector_entry_point", **given)
    single = ArenaEnv(**given)
    vector.action_space.seed(1)
    seen, _ = vector.reset(seed=[3, 4])
    alone, _ = single.reset(seed=4)
    for _ in range(40):
        assert seen[1].tobytes() == alone.tobytes()
        actions = vector.action_space.sample() * np.float32(0.1)
        seen, _, ended, _, _ = vector.step(actions)
        if ended[1]:
            break
        alone, *_ = single.step(actions[1])


@pytest.mark.parametrize(
    ("robot", "at"),
    [
        ({}, 54.0),
        ({"radius": 3.0}, 52.0),
        ({"radius": 3.0, "collision_distance": 3.9}, 52.0),
        ({"outline": [[2.0, 0.5], [-1.0, 0.5], [-1.0, -0.5], [2.0, -0.5]]}, 53.0),
    ],
)
def test_a_robot_collides_where_it_meets_the_pillar(robot: dict[str, Any], at: float) -> None:
    env = ArenaEnv(arena=ROOM, robot=robot)
    _, info = env.reset(seed=0)
    ended, before = False, 0.0
    while not ended:
        before = info["pose"][0]
        _, _, ended, _, info = env.step(np.zeros(1, np.float32))
    nearer = robot.get("collision_distance", 3.0) - 3.0
    assert info["collision"] and before < at - nearer + 1e-6 and info["pose"][0] > at - nearer - 0.1


def test_the_speed_is_the_robots() -> None:
    env = ArenaEnv(arena=ROOM, robot={"max_speed": 0.5})
    env.reset(seed=0)
    assert env.step_length == 0.5
    assert env.step(np.zeros(1, np.float32))[4]["pose"][0] == pytest.approx(40.5)


@pytest.mark.parametrize(
    ("keywords", "says"),
    [
        ({"robot": {"max_turn_rate": 2.0}}, "robot.max_turn_rate = 2.0 has no meaning"),
        ({"robot": {"reverse": True}}, "robot.reverse"),
        ({"robot": {"radius": -1}}, "robot.radius = -1"),
        ({"lidar": {"rate": 2.0}}, "at most 1 Hz"),
        ({"lidar": "sick"}, "lidar = 'sick' is not known"),
        ({"robot": {}, "speed": 2.0}, "earlier form"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(keywords: dict[str, Any], says: str) -> None:
    with pytest.raises(ConfigError, match=says):
        ArenaEnv(arena=ROOM, **keywords)


def test_earlier_keywords_mean_the_same_and_warn() -> None:
    with pytest.warns(DeprecationWarning) as caught:
        old = ArenaEnv(arena="yang", beams=20, max_range=9.0, lidar_noise=0.1, speed=2.0)
    new = ArenaEnv(arena="yang", lidar={"beams": 20, "max_range": 9.0, "noise": 0.1}, robot={"max_speed": 2.0})
    assert old.options == new.options and len(caught) == 4
