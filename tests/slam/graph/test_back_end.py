"""Loops are found and close the map; neighbours of all visits are compared."""

import numpy as np

from lidarena.slam.graph.back_end import BackEnd, adjusted, neighbours
from lidarena.slam.graph.mapper import Mapper
from lidarena.slam.planar import between, compose
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

TRUTH = way([*LAP, (7.35, 0.65), (7.35, 7.35), (0.65, 7.35)])
LOG = record(ring(), TRUTH, drift=1.0)
MAPPER = Mapper(LOG.angles, LOG.max_range)
for number, at in enumerate(LOG.scan_readings):
    MAPPER.add(LOG.times[at], LOG.odometry[at], LOG.ranges[number])


def test_loops_agree_with_the_truth() -> None:
    back = BackEnd(MAPPER.front)
    back.close_loops()
    assert back.loops
    truth = TRUTH[LOG.scan_readings][back.scans]
    for loop in back.loops:
        error = between(loop.motion, between(truth[loop.earlier], truth[loop.later]))
        assert np.hypot(error[0], error[1]) < 0.1 and abs(error[2]) < 0.03


def test_a_bent_way_is_straightened() -> None:
    back = BackEnd(MAPPER.front)
    truth = TRUTH[LOG.scan_readings][back.scans]
    bend = np.linspace(0.0, 1.0, len(truth))[:, None] * np.array([0.2, -0.15, 0.02])
    poses, edges = adjusted(MAPPER.front, back.scans, compose(truth, np.zeros(3)) + bend)
    error = between(between(truth[0], truth), between(poses[0], poses))
    assert np.hypot(error[:, 0], error[:, 1]).max() < 0.05
    assert len(edges.pairs) > len(poses)


def test_neighbours_are_of_the_last_keyframes_and_of_other_visits() -> None:
    line = np.stack([0.3 * np.arange(50.0), np.zeros(50), np.zeros(50)], axis=1)
    pairs = neighbours(np.concatenate([line, line]))
    assert (pairs[:, 0] < pairs[:, 1]).all()
    assert {tuple(pair) for pair in pairs} >= {(10, 11), (9, 11), (11, 61)}
