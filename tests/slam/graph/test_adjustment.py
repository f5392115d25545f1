"""Neighbours of all visits are compared and brought together; where they do not fit, the map is torn."""

import numpy as np

from lidarena.slam.graph.adjustment import adjusted, agreement, neighbours, torn_places
from lidarena.slam.planar import between, compose
from tests.slam.graph.test_back_end import MAPPER, TRUTH_OF_KEYFRAMES


def bent(by: float) -> np.ndarray:
    bend = np.linspace(0.0, by, len(TRUTH_OF_KEYFRAMES))[:, None] * np.array([0.2, -0.15, 0.02])
    return compose(TRUTH_OF_KEYFRAMES, np.zeros(3)) + bend


def test_a_bent_way_is_straightened() -> None:
    poses, edges = adjusted(MAPPER.front, bent(1.0))
    truth = TRUTH_OF_KEYFRAMES
    error = between(between(truth[0], truth), between(poses[0], poses))
    assert np.hypot(error[:, 0], error[:, 1]).max() < 0.05
    assert len(edges.pairs) > len(poses)


def test_neighbours_are_of_the_last_keyframes_and_of_other_visits() -> None:
    line = np.stack([0.3 * np.arange(50.0), np.zeros(50), np.zeros(50)], axis=1)
    poses = np.concatenate([line, line])
    pairs = neighbours(poses, poses[:, :2])
    assert (pairs[:, 0] < pairs[:, 1]).all()
    assert {tuple(pair) for pair in pairs} >= {(10, 11), (9, 11), (11, 61)}


def test_a_true_map_agrees_with_itself_and_a_torn_one_is_noticed() -> None:
    pairs, shares = agreement(MAPPER.front, TRUTH_OF_KEYFRAMES)
    assert len(pairs) > 5 and (pairs[:, 1] - pairs[:, 0] >= 30).all() and np.median(shares) > 0.8
    assert len(torn_places(MAPPER.front, TRUTH_OF_KEYFRAMES)) == 0
    torn = torn_places(MAPPER.front, bent(3.0))
    assert len(torn) > 0 and (torn[:, 0] < torn[:, 1]).all()


def test_who_comes_back_the_other_way_is_compared_by_what_was_seen() -> None:
    there = np.stack([0.3 * np.arange(50.0), np.zeros(50), np.zeros(50)], axis=1)
    back = np.stack([there[::-1, 0], np.zeros(50), np.full(50, np.pi)], axis=1)
    views = np.concatenate([there[:, :2] + (3.0, 0.0), back[:, :2] - (3.0, 0.0)])
    pairs = neighbours(np.concatenate([there, back]), views)
    other = pairs[(pairs[:, 0] < 50) & (pairs[:, 1] >= 50)]
    assert len(other) > 20
    assert np.hypot(*(views[other[:, 0]] - views[other[:, 1]]).T).max() <= 1.5
