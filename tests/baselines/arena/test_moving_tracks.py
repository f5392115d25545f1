import math

import gymnasium as gym
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.baselines.arena.moving_tracks import MovingTracks, times_to_collision
from lidarena.world.lidar import LidarSpec

NUMBERS = st.floats(-5.0, 5.0, allow_nan=False)


@settings(max_examples=60, deadline=None)
@given(st.tuples(NUMBERS, NUMBERS, NUMBERS, NUMBERS), st.floats(0.0, 1.0), st.tuples(NUMBERS, NUMBERS))
def test_times_are_those_at_which_discs_first_touch(obstacle, radius, velocity) -> None:
    other = np.array([[*obstacle, radius]])
    times = np.arange(0.0, 30.0, 0.002)
    place = np.array([0.3, -0.2])
    gaps = np.hypot(*(other[0, :2] - place + times[:, None] * (other[0, 2:4] - np.array(velocity))).T) - radius - 0.25
    found = float(times_to_collision(place, np.array([velocity]), 0.25, other)[0])
    if gaps[0] < 0.0:
        assert found in (0.0, math.inf)
        return
    touching = np.flatnonzero(gaps < 0.0)
    if len(touching):
        assert found == pytest.approx(times[touching[0]], abs=0.003)
    elif found < 29.0:  # they touch between two moments
        assert gaps.min() < 0.01


def test_nothing_is_never_met() -> None:
    assert np.isinf(times_to_collision(np.zeros(2), np.ones((3, 2)), 1.0, np.empty((0, 5)))).all()


def test_an_obstacle_that_moves_is_made_out_from_two_scans() -> None:
    keywords = {"arena": "random", "density": 0.0, "knowledge": "lidar", "expose_truth": True, "lidar": {"beams": 180}}
    env = gym.make("lidarena/Arena-v0", moving={"number": 1, "speed": 0.8}, **keywords).unwrapped
    _, info = env.reset(seed=1)
    arenas = env.episodes.core
    x, y, theta = arenas.physics.poses[0, 0]
    ahead, left = np.array([math.cos(theta), math.sin(theta)]), np.array([-math.sin(theta), math.cos(theta)])
    arenas.moving.states[0, 0, :2] = (x, y) + 12.0 * ahead + 4.0 * left
    arenas.moving.states[0, 0, 2:] = -0.8 * left
    tracks = MovingTracks(env.options.lidar, env.step_length, 1.0)
    moving = np.empty((0, 5))
    for _ in range(3):
        _, _, _, _, info = env.step(np.zeros(1, np.float32))
        seen = tracks.read(info)
        moving = seen[seen[:, 4] > 0.0]
    true = info["truth"]["moving"][0]
    nearest = moving[np.hypot(*(moving[:, :2] - true[:2]).T).argmin()]
    assert np.hypot(*(nearest[:2] - true[:2])) < 1.0
    assert np.hypot(*(nearest[2:4] - true[2:4])) < 0.35
    assert nearest[4] == pytest.approx(true[4], rel=0.4)


def test_what_is_told_is_taken_as_it_is_in_steps() -> None:
    info = {"scan": np.full(8, 5.0), "pose": np.zeros(3), "moving": np.array([[3.0, 0.0, 0.5, 0.0, 0.4]])}
    tracks = MovingTracks(LidarSpec(beams=8, max_range=5.0), 0.2, 0.1)
    assert tracks.read(info).tolist() == [[3.0, 0.0, 0.05, 0.0, 0.4]]


def test_walls_come_as_points_that_stand() -> None:
    tracks = MovingTracks(LidarSpec(beams=8, max_range=5.0), 1.0, 1.0)
    for _ in range(2):
        seen = tracks.read({"scan": np.full(8, 2.0), "pose": np.zeros(3)})
    assert seen.shape == (8, 5) and not seen[:, 2:].any()
    tracks.forget()
    assert tracks.read({"scan": np.full(8, 5.0), "pose": np.zeros(3)}).shape == (0, 5)
