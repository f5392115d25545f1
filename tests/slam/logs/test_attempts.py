"""Of several attempts the one whose scans agree best is kept, and the spread is told."""

import numpy as np
import pytest

from lidarena.slam.logs.attempts import Attempt, choose_attempt
from lidarena.slam.logs.traced_map import traced
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way

TRUTH = way(LAP)
LOG = record(ring(), TRUTH)
SCANS = np.arange(len(LOG.ranges))
POSES = TRUTH[LOG.scan_readings]


def attempt(bend: float, every: int = 1) -> Attempt:
    poses = POSES.copy()
    poses[len(poses) // 2 :, 0] += bend
    return Attempt(SCANS[::every], poses[::every], traced(LOG, SCANS[::every], poses[::every]), poses)


@pytest.mark.parametrize("place", [0, 1, 2])
def test_the_true_attempt_is_kept_wherever_it_stands(place: int) -> None:
    bends = [0.3, -0.5]
    bends.insert(place, 0.0)
    best, spread = choose_attempt([attempt(bend) for bend in bends])
    assert best == place
    assert spread.nearest == pytest.approx(0.3, abs=0.05) and spread.farthest == pytest.approx(0.5, abs=0.05)


def test_fewer_scans_are_no_advantage() -> None:
    assert choose_attempt([attempt(0.4, every=3), attempt(0.0)])[0] == 1


def test_one_attempt_has_no_spread() -> None:
    assert choose_attempt([attempt(0.2)]) == (0, (0.0, 0.0))
