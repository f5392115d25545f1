"""Where the laser sits: by what the scans tell on the circle, by what the file tells, or at the centre."""

import math

import numpy as np
import pytest

from lidarena.slam.logs.assembly import Assembly, RawScan
from lidarena.slam.logs.beams import BeamLayout
from lidarena.slam.logs.recorded_log import LogOptions, RecordedLog


def log(mounts: list[tuple[float, float, float] | None], told: float | None = None) -> RecordedLog:
    assembly = Assembly(mount_told=None if told is None else np.array([told, 0.0, 0.0]))
    for k, mount in enumerate(mounts):
        where = None if mount is None else np.array(mount)
        assembly.add(1e9 + k, (0.1 * k, 0.0, 0.0), RawScan(np.ones(4), BeamLayout(4, 0.0, 0.1), 80.0, where))
    return assembly.log("a", "log 'a'", LogOptions())


def test_a_laser_turned_by_half_a_turn_keeps_its_mount() -> None:
    flips = [(0.1, 0.0, math.pi - 1e-6), (0.1, 0.0, -math.pi + 1e-6)] * 4
    mount = log(list(flips)).mount
    np.testing.assert_allclose([mount[0], abs(mount[2])], [0.1, math.pi], atol=1e-5)


@pytest.mark.parametrize(
    ("mounts", "told", "expected"),
    [
        ([(0.3, 0.0, math.pi / 2)] * 3, None, (0.3, 0.0, math.pi / 2)),
        ([(0.3, 0.0, 0.0)] * 3, 0.1, (0.3, 0.0, 0.0)),
        ([(0.0, 0.0, 0.0)] * 3, 0.3, (0.3, 0.0, 0.0)),
        ([(0.0, 0.0, 0.0), (0.5, 0.1, 0.3), (1.0, 0.0, 0.0)], 0.3, (0.3, 0.0, 0.0)),
        ([(0.0, 0.0, 0.0), (0.5, 0.1, 0.3), (1.0, 0.0, 0.0)], None, (0.0, 0.0, 0.0)),
        ([None, None], None, (0.0, 0.0, 0.0)),
    ],
)
def test_what_the_scans_always_tell_counts_then_what_the_file_tells(
    mounts: list[tuple[float, float, float] | None], told: float | None, expected: tuple[float, float, float]
) -> None:
    np.testing.assert_allclose(log(mounts, told).mount, expected, atol=1e-9)
