"""Sectors and single beams of any lidar against a slow oracle."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import ConfigError
from lidarena.envs.exploration.scan_sectors import SECTORS, ScanSectors, front_beams, sector_angles
from lidarena.world.lidar import FULL_CIRCLE, LidarSpec


@settings(max_examples=60, deadline=None)
@given(st.integers(36, 1100), st.sampled_from([1.0, math.pi, math.radians(270.0), FULL_CIRCLE]), st.integers(0, 10**6))
def test_a_sector_holds_the_nearest_of_its_beams_and_the_longest_range_out_of_view(
    beams: int, view: float, seed: int
) -> None:
    spec = LidarSpec(beams=beams, field_of_view=view)
    scans = np.random.default_rng(seed).uniform(0.0, 3.4, (3, beams)).astype(np.float32)
    hits = ScanSectors(spec).nearest_hits(scans)
    assert hits.shape == (3, SECTORS) and hits.dtype == np.float32
    for sector, middle in enumerate(sector_angles()):
        off = (np.round(np.degrees(spec.angles - middle), 9) + 180.0) % 360.0 - 180.0
        inside = (off >= -180.0 / SECTORS - 1e-9) & (off < 180.0 / SECTORS - 1e-9)
        expected = scans[:, inside].min(axis=1) if inside.any() else np.full(3, 3.5)
        np.testing.assert_array_equal(hits[:, sector], expected.astype(np.float32))


def test_beams_too_far_apart_for_sectors_are_refused() -> None:
    for spec in (LidarSpec(beams=35), LidarSpec(beams=18, field_of_view=math.pi)):
        with pytest.raises(ConfigError, match="take more beams"):
            ScanSectors(spec)


def test_front_beams_point_ahead_and_aside() -> None:
    assert front_beams(LidarSpec()) == (0, 45, 90, 315, 270)
    assert front_beams(LidarSpec(beams=181, field_of_view=math.pi)) == (90, 135, 180, 45, 0)
    assert front_beams(LidarSpec(beams=8)) == (0, 1, 2, 7, 6)


@pytest.mark.parametrize("spec", [LidarSpec(beams=90, field_of_view=2.0), LidarSpec(beams=4)])
def test_a_lidar_without_such_beams_is_refused(spec: LidarSpec) -> None:
    with pytest.raises(ConfigError, match="da_slam"):
        front_beams(spec)
