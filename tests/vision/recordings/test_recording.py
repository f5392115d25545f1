"""Images are read as grey; swapped sides are found out."""

from dataclasses import replace
from pathlib import Path

import cv2
import numpy as np
import pytest

from lidarena.base.errors import VisionError
from lidarena.vision.recordings.reading import read_stereo
from lidarena.vision.recordings.recording import images_in, numbers_of, read_grey
from tests.vision.recordings.sequences import write_kitti


def test_colours_become_grey_and_other_files_are_passed_over(tmp_path: Path) -> None:
    cv2.imwrite(str(tmp_path / "b.png"), np.full((20, 30, 3), 90, np.uint8))
    (tmp_path / "a.txt").write_text("no image")
    assert images_in(tmp_path) == [tmp_path / "b.png"]
    assert read_grey(tmp_path / "b.png").shape == (20, 30)
    for name, words in (("a.txt", "is torn or of a format"), ("c.png", "is missing")):
        with pytest.raises(VisionError, match=words):
            read_grey(tmp_path / name)


def test_rows_of_numbers_may_have_names_and_remarks(tmp_path: Path) -> None:
    (tmp_path / "n.txt").write_text("# remark\nP0: 1 2\nP1: 3, 4 # more\n\n")
    assert numbers_of(tmp_path / "n.txt").tolist() == [[1, 2], [3, 4]]
    (tmp_path / "n.txt").write_text("1 2\n3 nan\n")
    with pytest.raises(VisionError, match="line 2 of"):
        numbers_of(tmp_path / "n.txt")
    with pytest.raises(VisionError, match="cannot be read"):
        numbers_of(tmp_path / "none.txt")


def test_swapped_sides_are_found_out(tmp_path: Path) -> None:
    found = read_stereo(write_kitti(tmp_path / "run"))
    found.check_sides(found.pair(0))
    swapped = replace(found, files=tuple(pair[::-1] for pair in found.files))
    with pytest.raises(VisionError, match="left and right images of run are swapped"):
        swapped.check_sides(swapped.pair(0))
