"""Rules that rank frontiers by the way to them."""

import gymnasium as gym
import numpy as np
import pytest

import lidarena
from lidarena.base.errors import ConfigError
from lidarena.baselines.exploration.rules import visible_unknown
from tests.baselines.exploration.plain_rules import (
    PlainDistanceAdvantage,
    PlainInformationGain,
    PlainNearestFrontier,
)

RULES = ["nearest_frontier", "information_gain", "distance_advantage"]


def explore(name: str, steps: int = 900) -> tuple[float, float, bool]:
    """Completeness, true path and collision of a drive through a maze with a known pose."""
    env = gym.make("lidarena/Exploration-v0", map="maze:77", slam="truth", stop_at=None, expose_truth=True)
    policy = lidarena.baselines.make(name, env)
    observation, info = env.reset(seed=3)
    policy.reset(seed=3)
    for _ in range(steps):
        observation, _, ended, _, info = env.step(policy.act(observation, info))
        if ended or policy.finished:
            break
    return info["completeness"], info["truth"]["path_length"], info["collision"]


@pytest.mark.parametrize(
    ("name", "plain"),
    [
        ("nearest_frontier", PlainNearestFrontier),
        ("information_gain", PlainInformationGain),
        ("distance_advantage", PlainDistanceAdvantage),
    ],
)
def test_a_rule_drives_as_its_plain_version_does(name: str, plain: type) -> None:
    env = gym.make("lidarena/Exploration-v0", map="maze:3?width=6&height=5.5", slam="truth", stop_at=None)
    actions = []
    for policy in (lidarena.baselines.make(name, env), plain(env)):
        observation, info = env.reset(seed=1)
        policy.reset(seed=1)
        actions.append([])
        for _ in range(350):
            actions[-1].append(int(policy.act(observation, info)))
            observation, _, ended, _, info = env.step(actions[-1][-1])
            if ended or policy.finished:
                break
    assert actions[0] == actions[1]


@pytest.mark.parametrize("name", RULES)
def test_a_rule_explores_everything_without_a_collision(name: str) -> None:
    completeness, _, collision = explore(name)
    assert completeness > 0.98 and not collision


def test_the_nearest_frontier_is_a_shorter_way_than_the_largest() -> None:
    assert explore("nearest_frontier")[1] < 0.95 * explore("frontier")[1]


def test_a_wall_hides_what_is_behind_it() -> None:
    occupancy = np.full((21, 21), -1, np.int8)
    occupancy[8:13, 8:13] = 0
    open_view = visible_unknown(occupancy, (10, 10), 8.0)
    assert open_view == pytest.approx(np.pi * 8.5**2 - 25, rel=0.05)
    occupancy[7:14, 13] = 100
    assert 0.6 * open_view < visible_unknown(occupancy, (10, 10), 8.0) < 0.85 * open_view


@pytest.mark.parametrize(
    ("name", "options"),
    [
        ("nearest_frontier", {"turn_cost": -1.0}),
        ("information_gain", {"gain": np.inf}),
        ("distance_advantage", {"radius": np.nan}),
        ("distance_advantage", {"persistence": -1.0}),
    ],
)
def test_options_that_mean_nothing_are_refused(name: str, options: dict[str, float]) -> None:
    with pytest.raises(ConfigError, match=f"{next(iter(options))} = .*, allowed are finite numbers >= 0"):
        lidarena.baselines.make(name, gym.make("lidarena/Env1-v0"), **options)
