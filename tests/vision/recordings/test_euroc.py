"""EuRoC's layout is read and rectified, its truth is the camera's."""

from pathlib import Path

import numpy as np
import pytest

from lidarena.base.errors import VisionError
from lidarena.vision.features import FeatureOptions, detect
from lidarena.vision.recordings.reading import read_stereo
from lidarena.vision.rigid_motion import inverse
from tests.vision.recordings.sequences import TRUTH, write_euroc


def test_a_sequence_is_rectified_and_its_truth_is_the_left_cameras(tmp_path: Path) -> None:
    found = read_stereo(write_euroc(tmp_path / "run"))
    assert found.camera.baseline == pytest.approx(0.4) and len(found.files) == 5
    assert np.allclose(found.times, 0.05 * np.arange(5)) and found.truth is not None
    assert np.allclose(inverse(found.truth[0]) @ found.truth[4], inverse(TRUTH[0]) @ TRUTH[4], atol=1e-6)
    pixels = detect(found.pair(0), found.camera, FeatureOptions(kind="tracks", count=150)).pixels
    assert len(pixels) > 80 and np.median(found.camera.epipolar_errors(pixels)) < 0.15


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("cam0/sensor.yaml", "intrinsics: [1, 2]\n", "no calibration of a camera"),
        ("cam1/sensor.yaml", "{", "no calibration of a camera"),
        ("state_groundtruth_estimate0/data.csv", "1,2,3\n", "3 columns; time, position and quaternion"),
    ],
)
def test_files_that_do_not_fit_are_refused(tmp_path: Path, name: str, text: str, words: str) -> None:
    folder = write_euroc(tmp_path / "run")
    (folder / "mav0" / name).write_text(text)
    with pytest.raises(VisionError, match=words):
        read_stereo(folder)


def test_cameras_without_times_in_common_are_refused(tmp_path: Path) -> None:
    folder = write_euroc(tmp_path / "run")
    for path in (folder / "mav0" / "cam1" / "data").iterdir():
        path.rename(path.with_name(f"{int(path.stem) + 7}.png"))
    with pytest.raises(VisionError, match="have 0 times in common"):
        read_stereo(folder)


def test_a_truth_of_other_times_is_left_out(tmp_path: Path) -> None:
    folder = write_euroc(tmp_path / "run")
    (folder / "mav0" / "state_groundtruth_estimate0" / "data.csv").write_text("5,0,0,0,1,0,0,0\n")
    assert read_stereo(folder).truth is None
