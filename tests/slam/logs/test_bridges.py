"""Where the wheels fail, scan matching bridges; where it cannot, it is told."""

from dataclasses import replace

import numpy as np
import pytest

from lidarena.slam.logs.bridges import unbridged, unsure_scans
from lidarena.slam.logs.mapping import map_log
from lidarena.slam.logs.odometry_checks import checked_odometry
from lidarena.slam.logs.recorded_log import RecordedLog
from lidarena.slam.logs.relations import relation_errors
from lidarena.slam.planar import between, compose
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, relations_of, way

TRUTH = way(LAP)
LOG = record(ring(), TRUTH)
RELATIONS = relations_of(LOG, TRUTH)
MIDDLE = len(TRUTH) // 2


def with_wheels(odometry: np.ndarray) -> RecordedLog:
    """The same log with other odometry, looked through as a reader does."""
    checked = checked_odometry(LOG.times, odometry)
    return replace(LOG, odometry=checked.poses, unsure=checked.unsure, notes=checked.notes)


def reset() -> np.ndarray:
    odometry = LOG.odometry.copy()
    odometry[MIDDLE:] = between(np.broadcast_to(odometry[MIDDLE], odometry[MIDDLE:].shape), odometry[MIDDLE:])
    return odometry


def turned() -> np.ndarray:
    """From the middle on in a frame that is turned by two radians: the way goes on, the heading jumps."""
    odometry = LOG.odometry.copy()
    here = np.broadcast_to(odometry[MIDDLE], odometry[MIDDLE:].shape)
    odometry[MIDDLE:] = compose(compose(odometry[MIDDLE], np.array([0.0, 0.0, 2.0])), between(here, odometry[MIDDLE:]))
    return odometry


WHEELS = {
    "all zero": lambda: np.zeros_like(LOG.odometry),
    "a line of zeros": lambda: np.where(np.arange(len(TRUTH))[:, None] == MIDDLE, 0.0, LOG.odometry),
    "reset": reset,
    "jump of 5 m": lambda: LOG.odometry + np.where(np.arange(len(TRUTH)) > MIDDLE, 1.0, 0.0)[:, None] * (3.0, 4.0, 0.0),
    "turned": turned,
}


@pytest.mark.parametrize("kind", WHEELS)
def test_matching_bridges_what_the_wheels_do_not_tell(kind: str) -> None:
    log = with_wheels(WHEELS[kind]())
    assert log.notes, "it is told"
    result = map_log(log)
    errors = relation_errors(result.trajectory.times, result.trajectory.poses, RELATIONS)
    assert errors.translation.mean() < 0.06


def test_a_robot_that_was_carried_into_another_room_is_told() -> None:
    elsewhere = np.random.default_rng(0).uniform(0.5, 9.0, LOG.ranges.shape).astype(np.float32)
    late = LOG.scan_readings > MIDDLE
    log = replace(with_wheels(WHEELS["jump of 5 m"]()), ranges=np.where(late[:, None], elsewhere, LOG.ranges))
    assert any("the map is likely torn there" in doubt for doubt in map_log(log).doubts)


def test_scans_are_unsure_if_any_reading_since_the_one_before_is() -> None:
    unsure = np.zeros(len(LOG.times), bool)
    unsure[[0, 3, 10]] = True
    found = unsure_scans(replace(LOG, unsure=unsure))
    assert np.flatnonzero(found).tolist() == [2, 5], "scans come with readings 0, 2, 4, …"
    assert not unsure_scans(LOG).any()


def test_few_bad_matches_without_odometry_are_no_doubt() -> None:
    unsure = np.ones(len(LOG.ranges), bool)
    unsure[0] = False
    scores = np.ones(len(LOG.ranges))
    assert unbridged(LOG, unsure, scores.tolist()) == []
    scores[5] = 0.2
    assert unbridged(LOG, unsure, scores.tolist()) == []
    scores[5:20] = 0.2
    assert "without odometry 15 of" in unbridged(LOG, unsure, scores.tolist())[0]
