"""KITTI's layout is read, and what is missing, torn or does not fit is told of in one sentence."""

from pathlib import Path

import cv2
import numpy as np
import pytest

from lidarena.base.errors import VisionError
from lidarena.vision.recordings.kitti import read_kitti
from lidarena.vision.recordings.reading import read_stereo
from tests.vision.recordings.sequences import KITTI, TRUTH, projections, write_kitti
from tests.vision.scenes import CAMERA, pair_at


def test_a_sequence_is_read_as_it_was_written(tmp_path: Path) -> None:
    found = read_stereo(write_kitti(tmp_path / "run"))
    assert found.camera == CAMERA and found.name == "run" and len(found.files) == 5
    assert found.truth is not None and np.allclose(found.truth, TRUTH, atol=1e-6)
    assert np.array_equal(found.pair(0)[1], pair_at(8.0)[1]) and np.allclose(found.times, np.arange(5) / 10)


def test_the_benchmarks_own_names_and_times_are_known(tmp_path: Path) -> None:
    folder = write_kitti(tmp_path / "00", ("image_2", "image_3"), truth=False)
    lines = projections().splitlines()
    far = [line.replace("519", "718") for line in lines]
    (folder / "calib.txt").write_text("".join(f"P{n}: {line}\n" for n, line in enumerate([*far, *lines])))
    (folder / "times.txt").write_text("0.0\n0.1\n0.2\n0.35\n0.4\n")
    found = read_kitti(folder)
    assert found.camera == CAMERA and found.truth is None and found.times[3] == 0.35


@pytest.mark.parametrize(
    ("name", "text", "words"),
    [
        ("calib.txt", "1 2 3\n", "12 finite ones are needed"),
        ("calib.txt", "\n", "0 projection matrices"),
        ("calib.txt", "a b c\n", "line 1 of .*calib.txt is no row of numbers"),
        ("calib.txt", "\n".join(reversed(projections().splitlines())), "no calibration of a rectified pair"),
        ("calib.txt", projections().replace("299.5", "1299.5"), "principal point at 1300, 200, outside of the images"),
        ("poses.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n", "has 1 rows for 5 pairs"),
        ("poses.txt", "2 0 0 0 0 1 0 0 0 0 1 0\n" * 5, "row 1 of .* is no pose"),
        ("times.txt", "0\n1\n1\n2\n3\n", "must rise"),
    ],
)
def test_files_that_do_not_fit_are_refused(tmp_path: Path, name: str, text: str, words: str) -> None:
    folder = write_kitti(tmp_path / "run")
    (folder / name).write_text(text)
    with pytest.raises(VisionError, match=words):
        read_stereo(folder)


def test_missing_and_torn_images_are_told_of(tmp_path: Path) -> None:
    folder = write_kitti(tmp_path / "run")
    torn = folder / "image_r" / "000002.png"
    torn.write_bytes(torn.read_bytes()[:40])
    with pytest.raises(VisionError, match=r"000002.png is torn"):
        read_kitti(folder).pair(2)
    torn.unlink()
    with pytest.raises(VisionError, match=r"frame 000002 of .* has no image in one of both folders"):
        read_kitti(folder)
    cv2.imwrite(str(torn), np.zeros((200, 300), np.uint8))
    with pytest.raises(VisionError, match="images of frame 2 are of two sizes, 600 x 400 and 300 x 200"):
        read_kitti(folder).pair(2)


def test_folders_that_are_no_sequence_are_refused(tmp_path: Path) -> None:
    with pytest.raises(VisionError, match="is no stereo sequence: allowed are calib"):
        read_stereo(tmp_path)
    with pytest.raises(VisionError, match="there is no folder"):
        read_stereo(tmp_path / "nowhere")
    (tmp_path / "calib.txt").write_text(projections())
    with pytest.raises(VisionError, match="has no left images"):
        read_stereo(tmp_path)
    (tmp_path / "left").mkdir()
    with pytest.raises(VisionError, match="there is no image in"):
        read_stereo(tmp_path)


@pytest.mark.skipif(not KITTI.is_dir(), reason="the recorded sequence is not here")
def test_the_recorded_excerpt_is_read() -> None:
    found = read_stereo(KITTI)
    assert len(found.files) == 51 and found.camera.baseline == pytest.approx(0.537, abs=1e-3)
    assert found.pair(50)[0].shape == (370, 1226)
