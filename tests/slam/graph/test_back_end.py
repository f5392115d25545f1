"""Loops are found while the robot drives, and close the map."""

import numpy as np

from lidarena.slam.graph.back_end import BackEnd
from lidarena.slam.graph.mapper import MapParameters, Mapper
from lidarena.slam.planar import between
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

TRUTH = way([*LAP, (7.35, 0.65), (7.35, 7.35), (0.65, 7.35)])
LOG = record(ring(), TRUTH, drift=1.0)
MAPPER = Mapper(LOG.angles, LOG.max_range)
ON_THE_WAY = [MAPPER.add(LOG.times[at], LOG.odometry[at], LOG.ranges[n]) for n, at in enumerate(LOG.scan_readings)]
TRUTH_OF_KEYFRAMES = TRUTH[LOG.scan_readings][MAPPER.front.keyframes]


def test_loops_agree_with_the_truth() -> None:
    back, truth = MAPPER.back, TRUTH_OF_KEYFRAMES
    assert back.loops and len(back.loop_edges().pairs) == len(back.loops)
    for loop in back.loops:
        error = between(loop.motion, between(truth[loop.earlier], truth[loop.later]))
        assert np.hypot(error[0], error[1]) < 0.1 and abs(error[2]) < 0.03


def test_a_loop_is_closed_as_soon_as_it_is_found() -> None:
    truth = TRUTH[LOG.scan_readings]
    error = between(between(truth[0], truth), between(ON_THE_WAY[0], np.array(ON_THE_WAY)))
    assert np.hypot(error[-20:, 0], error[-20:, 1]).max() < 0.1
    fitted = MAPPER.back.fitted()
    error = between(between(TRUTH_OF_KEYFRAMES[0], TRUTH_OF_KEYFRAMES), between(fitted[0], fitted))
    assert np.hypot(error[:, 0], error[:, 1]).max() < 0.1


def test_without_keyframes_nothing_is_corrected() -> None:
    back = BackEnd(MAPPER.front)
    np.testing.assert_array_equal(back.corrected(np.array([1.0, 2.0, 0.5])), [1.0, 2.0, 0.5])
    assert back.poses.shape == (0, 3) and len(back.loop_edges().pairs) == 0
    assert not back.extend() and len(back.poses) == 1


def test_a_step_is_known_as_well_as_what_was_seen_holds_it() -> None:
    back = MAPPER.back
    deviations = np.array([np.sqrt(np.diag(np.linalg.inv(each))) for each in back.way_edges().information])
    assert (deviations[:, :2] > 0.005).all() and np.median(deviations[:, :2]) < 0.03


def test_the_graph_of_a_known_building_stops_growing() -> None:
    truth = way([*LAP[:4]] * 5)
    log = record(ring(), truth, seed=3, drift=1.0)
    mapper, nodes = Mapper(log.angles, log.max_range, parameters=MapParameters(visits=1)), []
    for n, at in enumerate(log.scan_readings):
        mapper.add(log.times[at], log.odometry[at], log.ranges[n])
        nodes.append(mapper.back.nodes.count)
    fifth = len(nodes) // 5
    assert nodes[-1] - nodes[3 * fifth] < 0.2 * nodes[fifth]
    assert mapper.front.store.points.shape[0] == 256 < len(mapper.front.keyframes)
    truth, poses = truth[log.scan_readings], mapper.finish().poses
    error = between(between(truth[0], truth), between(poses[0], poses))
    assert np.hypot(error[:, 0], error[:, 1]).max() < 0.06
