"""A sequence is followed; frames that are missing or black are dropped, told of, and gone on from."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from lidarena.base.errors import VisionError
from lidarena.vision.recordings.reading import read_stereo
from lidarena.vision.recordings.sequence_odometry import SequenceOptions, follow
from lidarena.vision.recordings.trajectory_errors import trajectory_errors
from lidarena.vision.rigid_motion import inverse
from tests.vision.recordings.sequences import KITTI, TRUTH, write_euroc, write_kitti

FEW = SequenceOptions(count=250, window=4)


def off_at_the_end(poses: np.ndarray) -> float:
    return float(np.linalg.norm((TRUTH[0] @ poses[-1])[:3, 3] - TRUTH[-1, :3, 3]))


def test_a_flight_over_the_seabed_is_followed_the_same_twice(tmp_path: Path) -> None:
    recording = read_stereo(write_kitti(tmp_path / "run"))
    seen: list[int] = []
    found = follow(recording, FEW, progress=lambda done, total: seen.append(done))
    assert off_at_the_end(found.poses) < 0.01 and found.dropped == [] and seen == [2, 3, 4, 5]
    assert min(found.tracked[1:]) > 100 and found.seconds > 0.0
    assert np.array_equal(follow(recording, FEW).poses, found.poses)


def test_distorted_cameras_are_followed_too(tmp_path: Path) -> None:
    found = follow(read_stereo(write_euroc(tmp_path / "run")), FEW)
    recording = read_stereo(tmp_path / "run")
    assert recording.truth is not None
    assert trajectory_errors(recording.truth, found.poses).final < 0.015


@pytest.mark.parametrize("spoil", ["black", "torn", "small"])
def test_a_frame_that_shows_nothing_is_dropped_and_the_trajectory_goes_on(tmp_path: Path, spoil: str) -> None:
    folder = write_kitti(tmp_path / "run")
    for side in ("image_l", "image_r"):
        path = folder / side / "000002.png"
        if spoil == "torn":
            path.write_bytes(b"torn")
        else:
            cv2.imwrite(str(path), np.zeros((400, 600) if spoil == "black" else (300, 500), np.uint8))
    found = follow(read_stereo(folder), FEW)
    assert len(found.poses) == 5 and 2 in found.dropped and (2 in found.unread) == (spoil != "black")
    assert off_at_the_end(found.poses) < 0.15  # the flight is nearly even
    steps = [inverse(found.poses[n]) @ found.poses[n + 1] for n in (0, 1)]
    assert np.allclose(steps[0], steps[1], atol=0.02)


def test_swapped_sides_are_refused(tmp_path: Path) -> None:
    recording = read_stereo(write_kitti(tmp_path / "run"))
    with pytest.raises(VisionError, match="swapped"):
        follow(replace(recording, files=tuple(pair[::-1] for pair in recording.files)), FEW)


@pytest.mark.skipif(not KITTI.is_dir(), reason="the recorded sequence is not here")
def test_the_recorded_excerpt_is_followed() -> None:
    whole = read_stereo(KITTI)
    assert whole.truth is not None
    part = replace(whole, files=whole.files[:14], times=whole.times[:14], truth=whole.truth[:14])
    found = follow(part, SequenceOptions(count=400))
    assert part.truth is not None and trajectory_errors(part.truth, found.poses).translation < 0.02
