"""Logs, trajectories and relations that are damaged or unusual: read, or refused in one sentence, never half."""

import math
import tempfile
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.slam.logs.carmen import LogError, read_log
from lidarena.slam.logs.relations import _nearest
from lidarena.slam.logs.traced_map import beam_directions, informative_ranges, laser_odometry, trace_map
from lidarena.slam.logs.trajectory import Trajectory, load_tum, save_tum
from lidarena.slam.planar import wrapped
from tests.slam.drive import ring
from tests.slam.logs.recorded import LAP, record, way
from tests.slam.logs.test_carmen import FLASER, ODOM, ROBOT

ODD = [
    "",
    "nan",
    "-inf",
    "1e999",
    "1e39",
    "-1",
    "0",
    "1",
    "2",
    "x",
    "1_0",
    "٣",
    "9" * 25,
    "1e-320",
    "\x00",
    "#",
    "ODOM",
]
LINES = [FLASER, ODOM, ROBOT, "PARAM robot_front_laser_max 81.83"]


@settings(max_examples=150, deadline=None)
@given(st.sampled_from(LINES), st.integers(0, 40), st.sampled_from(ODD), st.booleans(), st.booleans())
def test_a_line_with_one_odd_word_is_read_or_refused(line: str, at: int, odd: str, skip: bool, first: bool) -> None:
    words = line.split()
    words[at % len(words)] = odd
    lines = [" ".join(words), FLASER] if first else [FLASER, " ".join(words)]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "a.log"
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
        try:
            log = read_log(file, skip_torn=skip)
        except LogError as refusal:
            assert "\n" not in str(refusal)
            return
    for array in (log.times, log.odometry, log.ranges, log.angles, log.mount):
        assert np.isfinite(array).all()
    assert 0.0 < log.max_range < math.inf
    assert len(log.ranges) == len(log.scan_readings) >= 1 and len(log.times) == len(log.odometry)
    assert (np.diff(log.scan_readings) > 0).all() and log.scan_readings[-1] < len(log.times)


@settings(max_examples=60, deadline=None)
@given(st.lists(st.tuples(*[st.floats(-1e4, 1e4)] * 2, st.floats(-3.14, 3.14)), min_size=1, max_size=20))
def test_any_trajectory_reads_back_to_a_micrometre(poses: list[tuple[float, float, float]]) -> None:
    trajectory = Trajectory(1e9 + 0.1 * np.arange(len(poses)), np.array(poses))
    with tempfile.TemporaryDirectory() as folder:
        again = load_tum(save_tum(Path(folder) / "a.tum", trajectory))
    np.testing.assert_allclose(again.times, trajectory.times, atol=1e-6)
    np.testing.assert_allclose(again.poses[:, :2], trajectory.poses[:, :2], atol=1e-6)
    np.testing.assert_allclose(wrapped(again.poses[:, 2] - trajectory.poses[:, 2]), 0.0, atol=1e-8)


def test_a_trajectory_is_written_as_unit_quaternions_about_the_vertical(tmp_path: Path) -> None:
    poses = np.array([[1.0, 2.0, 0.0], [0.0, 0.0, math.pi / 2], [0.0, 0.0, -3.0]])
    lines = save_tum(tmp_path / "a.tum", Trajectory(np.arange(3.0), poses)).read_text().splitlines()
    assert lines[0].startswith("#") and lines[1] == "0.000000 1.000000 2.000000 0 0 0 0.000000000 1.000000000"
    for line in lines[1:]:
        _, _, _, z, qx, qy, qz, qw = map(float, line.split())
        assert z == qx == qy == 0.0 and math.hypot(qz, qw) == pytest.approx(1.0)


TIMES = st.lists(st.integers(0, 40), min_size=1, max_size=12).map(lambda numbers: np.sort(np.array(numbers, float)))


@settings(max_examples=80, deadline=None)
@given(TIMES, st.lists(st.floats(-5, 45), min_size=1, max_size=8))
def test_the_nearest_time_is_found_as_by_looking_at_all(times: np.ndarray, wanted: list[float]) -> None:
    found = _nearest(times, np.array(wanted))
    for k, time in zip(found, wanted, strict=True):
        assert abs(times[k] - time) == np.abs(times - time).min()


LOG = record(ring(), way(LAP, stride=0.5))


def test_a_beam_without_return_says_nothing() -> None:
    ranges = informative_ranges(LOG)
    missing = LOG.ranges >= LOG.max_range * (1 - 1e-4)
    assert (ranges[missing] == 0.0).all()
    np.testing.assert_array_equal(ranges[~missing], LOG.ranges[~missing])


def test_beams_point_where_their_angles_say_and_the_laser_sits_on_its_mount() -> None:
    from dataclasses import replace

    np.testing.assert_allclose(np.arctan2(*beam_directions(LOG)[::-1]), LOG.angles)
    mounted = replace(LOG, mount=np.array([0.3, -0.1, 0.2]))
    turn = LOG.odometry[:, 2]
    x = LOG.odometry[:, 0] + 0.3 * np.cos(turn) + 0.1 * np.sin(turn)
    y = LOG.odometry[:, 1] + 0.3 * np.sin(turn) - 0.1 * np.cos(turn)
    np.testing.assert_allclose(laser_odometry(mounted)[:, :2], np.column_stack([x, y]), atol=1e-12)


def test_a_traced_map_is_cut_to_what_is_known_and_shows_each_end_point() -> None:
    scans = np.array([0, 5, 9])
    poses = way(LAP, stride=0.5)[LOG.scan_readings[scans]]
    grid = trace_map(LOG, scans, poses)
    known = grid.occupancy >= 0
    for border in (known[0], known[-1], known[:, 0], known[:, -1]):
        assert not border.any()
    for border in (known[1], known[-2], known[:, 1], known[:, -2]):
        assert border.any()
    shown = 0
    for pose, scan in zip(poses, informative_ranges(LOG)[scans], strict=True):
        heard = np.flatnonzero((scan > 0) & (scan < 20.0))
        angles = pose[2] + LOG.angles[heard]
        ends = pose[:2] + scan[heard, None] * np.column_stack([np.cos(angles), np.sin(angles)])
        cells = np.floor((ends - grid.origin[:2]) / grid.resolution + 1e-6).astype(int)
        shown += (grid.occupancy[cells[:, 1], cells[:, 0]] == 100).sum() / len(heard)
    assert shown / len(scans) > 0.95
