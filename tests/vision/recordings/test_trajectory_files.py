"""Trajectories are written as KITTI and TUM have them."""

import json
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from lidarena.vision.recordings.kitti import read_poses
from lidarena.vision.recordings.reading import read_stereo
from lidarena.vision.recordings.sequence_odometry import SequenceResult
from lidarena.vision.recordings.trajectory_errors import trajectory_errors
from lidarena.vision.recordings.trajectory_files import FILES, kitti_text, save_sequence, tum_text
from tests.vision.recordings.sequences import TRUTH, write_kitti


def test_what_is_written_for_kitti_is_read_again(tmp_path: Path) -> None:
    (tmp_path / "poses.txt").write_text(kitti_text(TRUTH))
    assert np.allclose(read_poses(tmp_path / "poses.txt"), TRUTH, atol=1e-7)


def test_tums_rows_are_time_place_and_quaternion() -> None:
    rows = np.array([line.split() for line in tum_text(0.1 * np.arange(5), TRUTH).splitlines()], float)
    assert rows.shape == (5, 8) and np.allclose(rows[:, 0], 0.1 * np.arange(5))
    assert np.allclose(rows[:, 1:4], TRUTH[:, :3, 3], atol=1e-6)
    assert np.allclose(Rotation.from_quat(rows[:, 4:]).as_matrix(), TRUTH[:, :3, :3], atol=1e-6)
    assert tum_text(np.zeros(1), np.eye(4)[None]) == "0.000000 0 0 0 0 0 0 1\n"


def test_a_folder_holds_everything_and_an_earlier_one_is_kept(tmp_path: Path) -> None:
    recording = read_stereo(write_kitti(tmp_path / "run"))
    result = SequenceResult(TRUTH, dropped=[2], unread={2: "torn"}, seconds=0.5, tracked=[9] * 5)
    errors = trajectory_errors(TRUTH, TRUTH)
    assert save_sequence(tmp_path / "out", recording, result, errors) is None
    assert all((tmp_path / "out" / name).stat().st_size > 50 for name in FILES)
    told = json.loads((tmp_path / "out" / "errors.json").read_text())
    assert told["frames_per_second"] == 10.0 and told["dropped"] == [2] and told["ate"] < 1e-6
    earlier = save_sequence(tmp_path / "out", recording, result, None)
    assert earlier is not None and (earlier / "errors.json").exists()
