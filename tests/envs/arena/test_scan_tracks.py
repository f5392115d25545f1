"""What is made out of moving discs, against what they do."""

import math

import numpy as np
import pytest

from lidarena.envs.arena.scan_tracks import MOST_TRACKS, no_tracks, track
from lidarena.world.lidar import LidarSpec

LIDAR = LidarSpec(beams=36, max_range=30.0, noise=0.0)
Discs = list[tuple[float, float, float]]


def scan_of(pose: np.ndarray, discs: Discs, wall: float = math.inf) -> np.ndarray:
    """Ranges among discs x, y, radius and before a wall at x = ``wall``."""
    angles = pose[2] + LIDAR.angles
    ranges = np.full(36, LIDAR.max_range)
    for x, y, radius in discs:
        along = (x - pose[0]) * np.cos(angles) + (y - pose[1]) * np.sin(angles)
        aside = (y - pose[1]) * np.cos(angles) - (x - pose[0]) * np.sin(angles)
        inside = radius**2 - aside**2
        met = (inside > 0.0) & (along > 0.0)
        ranges = np.where(met, np.minimum(ranges, along - np.sqrt(np.maximum(inside, 0.0))), ranges)
    if math.isfinite(wall):
        with np.errstate(divide="ignore"):
            away = np.where(np.cos(angles) > 1e-9, (wall - pose[0]) / np.cos(angles), np.inf)
        ranges = np.minimum(ranges, away)
    return np.minimum(ranges, LIDAR.max_range).astype(np.float32)


def motion_after(scans: list[tuple[np.ndarray, Discs, float]]) -> tuple[np.ndarray, np.ndarray]:
    """What the beams of the last of some scans are taken to have met: velocities and groups."""
    tracks = no_tracks(1, 36)
    for pose, discs, wall in scans:
        track(0, pose, scan_of(pose, discs, wall), 1.0, LIDAR.directions, LIDAR, tracks)
    return tracks.motion[0], tracks.group[0]


@pytest.mark.parametrize("velocity", [(0.5, 0.0), (-0.3, 0.4), (0.0, -1.2), (0.0, 0.0)])
@pytest.mark.parametrize("turn", [0.0, 1.3, 3.1])
def test_the_velocity_of_a_disc_is_told_while_the_robot_drives(velocity: tuple[float, float], turn: float) -> None:
    vx, vy = velocity
    scans = [
        (np.array([0.3 * k, 0.1 * k, turn + 0.2 * k]), [(8.0 + vx * k, 2.0 + vy * k, 3.0)], math.inf) for k in range(4)
    ]
    motion, group = motion_after(scans)
    assert (group >= 0).sum() >= 3 and len(set(group[group >= 0].tolist())) == 1
    assert np.abs(motion[group >= 0] - velocity).max() < 1e-3
    assert not motion[group < 0].any()


def test_two_discs_and_a_wall_are_told_apart() -> None:
    scans = [(np.array([0.0, 0.0, 0.0]), [(-7.0, 0.3 * k, 3.0), (0.0, 8.0, 3.0)], 6.0) for k in range(4)]
    motion, group = motion_after(scans)
    assert len(set(group[group >= 0].tolist())) >= 3
    behind, left, ahead = slice(17, 20), slice(8, 11), [35, 0, 1]
    assert motion[behind] == pytest.approx(np.tile([0.0, 0.3], (3, 1)), abs=1e-3)
    assert not motion[left].any() and not motion[ahead].any()


def test_a_wall_stands_however_the_robot_drives_along_it() -> None:
    scans = [(np.array([0.0, 0.7 * k, 0.1 * k]), [], 4.0) for k in range(8)]
    assert not motion_after(scans)[0].any()


def test_a_disc_that_is_half_hidden_is_taken_to_drive_on() -> None:
    drives = [(np.zeros(3), [(9.0, 0.5 * k, 3.0)], math.inf) for k in range(5)]
    hidden = (np.zeros(3), [(9.0, 2.5, 3.0), (5.0, 0.3, 0.9)], math.inf)
    motion, group = motion_after([*drives, hidden])
    seen = (group >= 0) & (np.hypot(*motion.T) > 0.0)
    assert seen.any() and motion[seen] == pytest.approx(np.tile([0.0, 0.5], (int(seen.sum()), 1)), abs=1e-3)


def test_more_discs_than_there_is_room_for_do_no_harm() -> None:
    lidar = LidarSpec(beams=720, max_range=30.0, noise=0.0)
    tracks = no_tracks(1, 720)
    ranges = np.where(np.arange(720) % 8 < 5, 10.0, 30.0).astype(np.float32)
    for _ in range(3):
        track(0, np.zeros(3), ranges, 1.0, lidar.directions, lidar, tracks)
    assert (tracks.discs[0, :, 5] > 0.0).sum() <= MOST_TRACKS
    assert np.isfinite(tracks.motion).all()
