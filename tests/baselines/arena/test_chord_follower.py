import itertools
import math

import numpy as np
import pytest

from lidarena.baselines.arena.chord_follower import ChordFollower

NOTHING = np.empty((0, 3))


def follow(path: np.ndarray, step: float, discs: np.ndarray = NOTHING, most: int = 600) -> np.ndarray:
    """The places that a follower steps to, until it is at the end."""
    follower, place, places = ChordFollower(path, step, discs), path[0].astype(float), [path[0].astype(float)]
    while not follower.at_end(place) and len(places) < most:
        heading = follower.heading(place)
        place = place + step * np.array([math.cos(heading), math.sin(heading)])
        places.append(place)
    return np.array(places)


def distance_to(path: np.ndarray, point: np.ndarray) -> float:
    """From a point to a polyline."""
    a, b = path[:-1], path[1:]
    edges = b - a
    share = np.clip(((point - a) * edges).sum(axis=1) / (edges**2).sum(axis=1), 0, 1)
    return float(np.hypot(*(a + share[:, None] * edges - point).T).min())


@pytest.mark.parametrize("step", [0.1, 0.5, 1.0])
def test_every_step_ends_on_the_path(step: float) -> None:
    path = np.array([[0, 0], [10, 0], [14, 6], [4, 9], [4, 20]], float)
    places = follow(path, step)
    assert max(distance_to(path, place) for place in places[:-1]) < 0.07 * step  # the last one may pass the end
    assert np.hypot(*(places[-1] - path[-1])) <= step
    driven = step * (len(places) - 1)
    assert driven == pytest.approx(np.hypot(*np.diff(path, axis=0).T).sum(), rel=0.03, abs=step)


def test_a_chord_that_would_cut_into_an_obstacle_is_turned_aside() -> None:
    path = np.array([[0, 0], [10, 0], [10, 10]], float)
    corner = np.array([[9.0, 1.0, 0.98]])  # the path passes it at 0.02
    places = follow(path, 1.0, corner)
    for a, b in itertools.pairwise(places):
        line = np.linspace(a, b, 200)
        assert np.hypot(line[:, 0] - 9.0, line[:, 1] - 1.0).min() > 0.98
    assert np.hypot(*(places[-1] - path[-1])) <= 1.0


def test_walls_are_kept_off() -> None:
    path = np.array([[1.0, 1.0], [9.0, 1.0], [9.0, 9.0]])
    follower = ChordFollower(path, 1.0, NOTHING, np.array([0.0, 0.0, 9.2, 9.2]))
    place = np.array([8.6, 1.0])
    heading = follower.heading(place)
    assert place[0] + math.cos(heading) < 9.2


def test_a_robot_that_nothing_lets_pass_drives_on_as_wanted() -> None:
    ring = np.linspace(0, 2 * np.pi, 40)
    discs = np.column_stack([0.6 * np.cos(ring), 0.6 * np.sin(ring), np.full(40, 0.2)])
    follower = ChordFollower(np.array([[0.0, 0.0], [9.0, 0.0]]), 1.0, discs)
    assert follower.heading(np.zeros(2)) == pytest.approx(0.0)


def test_a_path_of_one_point_is_at_its_end() -> None:
    follower = ChordFollower(np.array([[3.0, 4.0]]), 1.0, NOTHING)
    follower.heading(np.array([3.0, 4.0]))
    assert follower.at_end(np.array([3.0, 4.0]))


def test_only_what_lies_ahead_blocks_the_path() -> None:
    follower = ChordFollower(np.array([[0.0, 0.0], [5.0, 0.0], [5.0, 5.0]]), 1.0, NOTHING)
    disc = np.array([[0.2, 0.1, 0.15]])
    assert follower.is_blocked(disc)
    assert not follower.is_blocked(np.array([[2.0, 1.0, 0.9]]))
    follower.heading(np.zeros(2))
    assert not follower.is_blocked(disc)
    assert follower.is_blocked(np.array([[5.2, 3.0, 0.3]]))


def test_the_widest_berth_that_lets_on_is_given() -> None:
    follower = ChordFollower(np.array([[0.0, 0.0], [9.0, 0.0]]), 1.0, NOTHING)
    post = np.array([[1.0, 0.6, 0.0]])
    wide, narrow, none = (post + np.array([0.0, 0.0, radius]) for radius in (0.9, 0.5, 0.1))
    heading, free = follower.careful_heading(np.zeros(2), [wide, narrow, none])
    assert free and math.radians(-75) <= heading < math.radians(-10)
    gate = np.array([[0.8, 0.6, 0.0], [0.8, -0.6, 0.0]])
    heading, free = follower.careful_heading(np.zeros(2), [gate + np.array([0, 0, 0.9]), gate + np.array([0, 0, 0.5])])
    assert free and heading == pytest.approx(0.0)


def test_a_robot_that_nothing_lets_pass_is_told_so() -> None:
    ring = np.linspace(0, 2 * np.pi, 40)
    discs = np.column_stack([0.6 * np.cos(ring), 0.6 * np.sin(ring), np.full(40, 0.2)])
    follower = ChordFollower(np.array([[0.0, 0.0], [9.0, 0.0]]), 1.0, NOTHING)
    assert not follower.careful_heading(np.zeros(2), [discs])[1]
