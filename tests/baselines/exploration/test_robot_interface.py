import math

import gymnasium as gym
import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.baselines.exploration.robot_interface import Robot
from lidarena.envs.exploration.options import ExplorationOptions


class Env:
    spec = None

    def __init__(self, space, **attributes):
        self.action_space = space
        for name, value in attributes.items():
            setattr(self, name, value)


DISCRETE = gym.spaces.Discrete(3)
BOX = gym.spaces.Box(-1.0, 1.0, (2,), np.float32)


def beams(front=1.0, left45=1.0, left=1.0, right45=1.0, right=1.0):
    return np.array([front, left45, left, right45, right, 0.0, 0.0], np.float32)


def test_discrete_actions_are_the_commands():
    robot = Robot(Env(DISCRETE))
    np.testing.assert_allclose(robot.commands.velocities, [[0.5, 0.0], [0.05, 0.3], [0.05, -0.3]])
    assert [robot.action(k) for k in range(3)] == [0, 1, 2]


def test_continuous_actions_stand_for_the_velocities():
    robot = Robot(Env(BOX))
    for k, (v, w) in enumerate(robot.commands.velocities):
        action = robot.action(k)
        assert BOX.contains(action)
        assert (0.25 * (action[0] + 1.0), action[1]) == pytest.approx((v, w), abs=1e-6)


def test_period_is_the_environments():
    quick = Env(DISCRETE, options=ExplorationOptions.checked({"decision_period": 0.1}))
    assert Robot(Env(DISCRETE)).period == 0.2
    assert Robot(quick).period == 0.1
    np.testing.assert_allclose(Robot(quick).commands.moves[0], [0.05, 0.0, 0.0])


@pytest.mark.parametrize(
    "space", [gym.spaces.Discrete(4), gym.spaces.Box(-1, 1, (3,)), gym.spaces.MultiDiscrete([3, 3])]
)
def test_other_action_spaces_are_refused(space):
    with pytest.raises(ConfigError, match=r"Discrete\(3\) and a Box"):
        Robot(Env(space))


def test_hits_are_where_the_beams_end() -> None:
    observation = np.array([0.1, 1.0, 0.05, 0.5, 0.0, 0.0, 0.0], np.float32)  # over 3.5 m; the last two are no beams
    hits = Robot(Env(DISCRETE)).hits(observation, np.array([1.0, 2.0, math.pi / 2]), reach=0.6)
    assert hits == pytest.approx(np.array([[1.0, 2.35], [1.0 - 0.175, 2.0]]), abs=1e-6)
    scan, options = {"scan": np.full(4, 0.1)}, ExplorationOptions.checked({"lidar": {"beams": 4}})
    assert Robot(Env(DISCRETE, options=options)).hits(scan, np.zeros(3), reach=0.6) == pytest.approx(
        np.array([[0.35, 0.0], [0.0, 0.35], [-0.35, 0.0], [0.0, -0.35]]), abs=1e-9
    )


def test_what_is_near_is_seen_by_whole_scans_of_many_beams_only() -> None:
    scan, few = {"scan": np.ones(360)}, ExplorationOptions.checked({"lidar": {"beams": 8}})
    behind = ExplorationOptions.checked({"lidar": {"field_of_view": 3.0}})
    assert Robot(Env(DISCRETE)).sees_what_is_near(scan) and not Robot(Env(DISCRETE)).sees_what_is_near(beams())
    assert not Robot(Env(DISCRETE, options=few)).sees_what_is_near({"scan": np.ones(8)})
    assert not Robot(Env(DISCRETE, options=behind)).sees_what_is_near(scan)


def test_a_noisier_lidar_is_kept_farther_away_from_what_it_hits() -> None:
    noisy = ExplorationOptions.checked({"lidar": {"noise": 0.05}})
    assert Robot(Env(DISCRETE)).least_distance == pytest.approx(0.135)
    assert Robot(Env(DISCRETE, options=noisy)).least_distance == pytest.approx(0.195)
