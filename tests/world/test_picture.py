from pathlib import Path

import cv2
import numpy as np
import pytest

from lidarena.base.errors import MapError
from lidarena.world.picture import read_picture

GREY = np.arange(48, dtype=np.uint8).reshape(6, 8) * 5


def encoded(ending: str, pixels: np.ndarray) -> bytes:
    done, data = cv2.imencode(ending, pixels)
    assert done
    return data.tobytes()


def saved(path: Path, data: bytes) -> Path:
    path.write_bytes(data)
    return path


@pytest.mark.parametrize("ending", [".png", ".pgm"])
def test_grey_values_come_back_row_by_row(tmp_path: Path, ending: str) -> None:
    grey, transparent = read_picture(saved(tmp_path / f"map{ending}", encoded(ending, GREY)), "the map", 0.05)
    assert np.array_equal(grey, GREY) and not transparent.any()


def test_a_plain_text_picture_with_comments_is_read(tmp_path: Path) -> None:
    data = b"P2\n# drawn by hand\n3 2\n255\n0 128 255\n255 128 0\n"
    grey, _ = read_picture(saved(tmp_path / "map.pgm", data), "the map", 0.05)
    assert grey.tolist() == [[0, 128, 255], [255, 128, 0]]


def test_colours_are_averaged_and_transparency_is_told_apart(tmp_path: Path) -> None:
    pixels = np.zeros((2, 2, 4), np.uint8)
    pixels[0, 0] = (30, 60, 90, 255)
    grey, transparent = read_picture(saved(tmp_path / "map.png", encoded(".png", pixels)), "the map", 0.05)
    assert grey[0, 0] == 60 and transparent.tolist() == [[False, True], [True, True]]


def test_sixteen_bits_are_scaled_to_eight(tmp_path: Path) -> None:
    pixels = np.array([[0, 65535, 32896]], np.uint16)
    grey, _ = read_picture(saved(tmp_path / "map.png", encoded(".png", pixels)), "the map", 0.05)
    assert grey[0] == pytest.approx([0.0, 255.0, 128.0])


@pytest.mark.parametrize(
    ("data", "says"),
    [
        (b"", "is empty"),
        (b"GIF89a", "neither a PGM"),
        (b"P5\n3 x\n255\n", "torn header"),
        (b"P5\n3 2\n65535\n" + bytes(12), "65535 as its white"),
        (b"P5\n30 20\n255\n" + bytes(12), "cut short"),
        (encoded(".png", GREY)[:-20], "cut short"),
        (b"P5\n90000 90000\n255\n" + bytes(12), "cut short"),
    ],
)
def test_what_is_no_whole_picture_is_refused(tmp_path: Path, data: bytes, says: str) -> None:
    with pytest.raises(MapError, match=says) as refusal:
        read_picture(saved(tmp_path / "map.pgm", data), "the map", 0.05)
    assert "\n" not in str(refusal.value)


@pytest.mark.parametrize(
    "header",
    [
        b"P5\r\n8 6\r\n255\r\n",
        b"P5\n8 6\n255\n# made by a saver\n",
        b"P5\n# before\n8 6\n255 # behind\n# and more\n",
        b"P5 8 6 255 ",
        b"P5\n8 6\n255\n",
    ],
)
@pytest.mark.parametrize("first", [0, 10, 13, 35])
@pytest.mark.parametrize("trailing", [b"", b"\n"])
def test_pixels_begin_behind_the_whole_header(tmp_path: Path, header: bytes, first: int, trailing: bytes) -> None:
    grey = GREY.copy()
    grey[0, :2] = first
    data = header + grey.tobytes() + trailing
    found, _ = read_picture(saved(tmp_path / "map.pgm", data), "the map", 0.05)
    np.testing.assert_array_equal(found, grey)


def test_a_picture_that_is_not_there_is_named(tmp_path: Path) -> None:
    with pytest.raises(MapError, match=r"the map names the picture '.*gone.pgm', which cannot be read"):
        read_picture(tmp_path / "gone.pgm", "the map", 0.05)
