"""A folder is opened in the layout that it has."""

from pathlib import Path

import pytest

from lidarena.base.errors import VisionError
from lidarena.vision.recordings.reading import read_stereo
from tests.vision.recordings.sequences import write_euroc, write_kitti


def test_both_layouts_are_told_apart(tmp_path: Path) -> None:
    assert read_stereo(write_kitti(tmp_path / "a", truth=False)).rectify is None
    assert read_stereo(str(write_euroc(tmp_path / "b"))).rectify is not None


def test_a_single_pair_is_no_sequence(tmp_path: Path) -> None:
    folder = write_kitti(tmp_path / "a", truth=False)
    for path in folder.rglob("*.png"):
        if path.stem != "000000":
            path.unlink()
    with pytest.raises(VisionError, match="a has 1 pair of images; 2 at least are needed"):
        read_stereo(folder)
