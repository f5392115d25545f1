"""``lidarena odometry`` writes the trajectory and tells its errors; it refuses in one sentence."""

from pathlib import Path

import numpy as np
import pytest

from lidarena.cli import main
from lidarena.vision.recordings.kitti import read_poses
from tests.vision.recordings.sequences import TRUTH, write_kitti


def test_a_sequence_is_followed_and_written(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    folder, out = write_kitti(tmp_path / "run"), tmp_path / "out"
    (folder / "image_l" / "000003.png").write_bytes(b"torn")
    assert main(["odometry", str(folder), "--out", str(out), "--corners", "250"]) == 0
    told = capsys.readouterr()
    assert "5 pairs of 600 x 400 pixels, baseline 0.400 m" in told.out and "absolute:   ATE" in told.out
    assert "frame 3 is left out" in told.err and "1 frames without a motion (3)" in told.err
    poses = read_poses(out / "trajectory_kitti.txt")
    assert len(poses) == 5 and np.linalg.norm((TRUTH[0] @ poses[2])[:3, 3] - TRUTH[2, :3, 3]) < 0.01
    assert (out / "picture.png").stat().st_size > 5000


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["nowhere"], "there is no folder nowhere"),
        (["nowhere", "--corners", "3"], "corners = 3 is out of range"),
        (["nowhere", "--window", "1"], "window = 1 is out of range"),
    ],
)
def test_what_cannot_be_followed_is_refused(
    arguments: list[str],
    words: str,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["odometry", *arguments]) == 2
    told = capsys.readouterr().err
    assert words in told and told.count("\n") == 1
