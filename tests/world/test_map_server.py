import zlib
from pathlib import Path

import cv2
import numpy as np
import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from lidarena.base.errors import MapError
from lidarena.world.map_server import load_map, save_map
from tests.world.shared_data import DATA, needs_data

PIXELS = np.array([[0, 205, 254], [254, 254, 100]], dtype=np.uint8)
ENTRIES = {
    "image": "map.pgm",
    "resolution": 0.05,
    "origin": [-1.0, 2.0, 0.0],
    "negate": 0,
    "occupied_thresh": 0.65,
    "free_thresh": 0.196,
}


def pgm(pixels: np.ndarray) -> bytes:
    return f"P5\n{pixels.shape[1]} {pixels.shape[0]}\n255\n".encode() + pixels.astype(np.uint8).tobytes()


def png(pixels: np.ndarray) -> bytes:
    return cv2.imencode(".png", pixels)[1].tobytes()


def write(folder: Path, picture: bytes | None = None, /, **changes: object) -> Path:
    """Write a good map with changed entries; None leaves an entry out."""
    entries = {key: value for key, value in {**ENTRIES, **changes}.items() if value is not None}
    (folder / "map.pgm").write_bytes(pgm(PIXELS) if picture is None else picture)
    path = folder / "map.yaml"
    path.write_text(yaml.safe_dump(entries), encoding="utf-8")
    return path


def refusal(path: Path) -> str:
    with pytest.raises(MapError) as caught:
        load_map(path)
    message = str(caught.value)
    assert "\n" not in message
    assert str(path) in message
    return message


def test_the_top_row_of_the_picture_is_the_last_row_of_the_grid(tmp_path: Path) -> None:
    grid = load_map(write(tmp_path))
    assert grid.occupancy.tolist() == [[0, 0, -1], [100, -1, 0]]
    assert grid.occupancy.dtype == np.int8
    assert (grid.resolution, grid.origin) == (0.05, (-1.0, 2.0, 0.0))


def test_unknown_counts_as_solid(tmp_path: Path) -> None:
    assert load_map(write(tmp_path)).solid.tolist() == [[False, False, True], [True, True, False]]


def test_negate_swaps_black_and_white(tmp_path: Path) -> None:
    grid = load_map(write(tmp_path, negate=1))
    assert grid.occupancy.tolist() == [[100, 100, -1], [0, 100, 100]]


@pytest.mark.parametrize("value", [True, 1, 1.0])
def test_negate_may_be_a_truth_value(tmp_path: Path, value: object) -> None:
    assert load_map(write(tmp_path, negate=value)).occupancy[0, 0] == 100


def test_thresholds_are_strict(tmp_path: Path) -> None:
    pixels = np.array([[204, 51, 50, 205]])  # p = 0.2, 0.8, 0.804, 0.196
    grid = load_map(write(tmp_path, pgm(pixels), free_thresh=0.2, occupied_thresh=0.8))
    assert grid.occupancy.tolist() == [[-1, -1, 100, 0]]


def test_the_savers_grey_is_unknown_even_below_a_free_thresh_of_a_quarter(tmp_path: Path) -> None:
    saved = pgm(np.array([[0, 205, 254]]))
    assert load_map(write(tmp_path, saved, free_thresh=0.25)).occupancy.tolist() == [[100, -1, 0]]
    retouched = pgm(np.array([[0, 205, 254, 230]]))
    assert load_map(write(tmp_path, retouched, free_thresh=0.25)).occupancy.tolist() == [[100, -1, 0, 0]]
    white = np.full((10, 20), 205)
    white[2:6, 2:9], white[1, 2:9], white[4, 4] = 255, 0, 230
    grid = load_map(write(tmp_path, pgm(white), free_thresh=0.25)).occupancy[::-1]
    assert (grid == -1).sum() == 10 * 20 - 5 * 7 and grid[4, 4] == 0 and grid[3, 3] == 0
    shades = np.tile(np.arange(196, 256), (60, 1))
    assert (load_map(write(tmp_path, pgm(shades), free_thresh=0.25)).occupancy == 0).mean() > 0.9
    continuous = pgm(np.array([[0, 205, 240]]))
    assert load_map(write(tmp_path, continuous, free_thresh=0.25)).occupancy.tolist() == [[100, 0, 0]]


def test_thresholds_negate_and_mode_have_the_savers_defaults(tmp_path: Path) -> None:
    lean = write(tmp_path, negate=None, occupied_thresh=None, free_thresh=None)
    assert np.array_equal(load_map(lean).occupancy, load_map(write(tmp_path, mode="trinary")).occupancy)


def test_yaw_and_numbers_that_yaml_takes_for_text(tmp_path: Path) -> None:
    grid = load_map(write(tmp_path, resolution="5e-2", origin=[1, 2, "5e-1"]))
    assert (grid.resolution, grid.origin) == (0.05, (1.0, 2.0, 0.5))


def test_foreign_keys_are_left_alone(tmp_path: Path) -> None:
    assert load_map(write(tmp_path, floor="ground", building=7)).occupancy.shape == (2, 3)


def test_png_in_colour_with_transparency_and_in_sixteen_bits(tmp_path: Path) -> None:
    expected = load_map(write(tmp_path)).occupancy
    assert np.array_equal(load_map(write(tmp_path, png(PIXELS))).occupancy, expected)
    assert np.array_equal(load_map(write(tmp_path, png(PIXELS.astype(np.uint16) * 257))).occupancy, expected)
    colour = np.repeat(PIXELS[:, :, None], 4, axis=2)
    colour[:, :, 3] = 255
    assert np.array_equal(load_map(write(tmp_path, png(colour))).occupancy, expected)
    colour[1, 0, 3] = 0
    assert load_map(write(tmp_path, png(colour))).occupancy[0, 0] == -1


def test_text_pgm_with_comments(tmp_path: Path) -> None:
    text = b"P2\n# made by hand\n3 2\n# white\n255\n0 205 254\n254 254 100\n"
    assert load_map(write(tmp_path, text)).occupancy.tolist() == [[0, 0, -1], [100, -1, 0]]


def test_picture_in_another_folder(tmp_path: Path) -> None:
    (tmp_path / "pictures").mkdir()
    (tmp_path / "pictures" / "floor.pgm").write_bytes(pgm(PIXELS))
    path = tmp_path / "map.yaml"
    for image in ("pictures/floor.pgm", str(tmp_path / "pictures" / "floor.pgm")):
        path.write_text(yaml.safe_dump({**ENTRIES, "image": image}), encoding="utf-8")
        assert load_map(path).occupancy.shape == (2, 3)


@pytest.mark.parametrize(
    ("changes", "named"),
    [
        ({"resolution": 0.0}, "0 m; 0.005 to 2 m"),
        ({"resolution": -0.05}, "-0.05 m; 0.005 to 2 m"),
        ({"resolution": float("nan")}, "nan m; 0.005 to 2 m"),
        ({"resolution": 50}, "50 m; 0.005 to 2 m"),
        ({"resolution": "fine"}, "resolution 'fine'; a number"),
        ({"resolution": [0.05]}, "resolution [0.05]; a number"),
        ({"resolution": True}, "resolution True; a number"),
        ({"resolution": None}, "no key 'resolution'"),
        ({"image": None}, "no key 'image'"),
        ({"origin": None}, "no key 'origin'"),
        ({"image": 7}, "image 7; the name"),
        ({"image": "a\0b"}, "the name of a PGM or PNG file"),
        ({"image": "gone.pgm"}, "gone.pgm"),
        ({"image": "."}, "cannot be read"),
        ({"origin": [0, 0]}, "origin [0, 0]; a list of x, y"),
        ({"origin": "0 0 0"}, "a list of x, y"),
        ({"origin": [0, float("inf"), 0]}, "finite numbers"),
        ({"origin": [0, "left", 0]}, "'left'; a number"),
        ({"negate": 2}, "negate 2; 0 or 1"),
        ({"negate": "no"}, "negate 'no'; 0 or 1"),
        ({"mode": "scale"}, "mode 'scale'; only 'trinary'"),
        ({"mode": "raw"}, "mode 'raw'; only 'trinary'"),
        ({"free_thresh": 0.7}, "free_thresh 0.7 and occupied_thresh 0.65"),
        ({"occupied_thresh": 65}, "occupied_thresh 65"),
        ({"free_thresh": float("nan")}, "free_thresh nan"),
        ({"resolution": None, "resoluton": 0.05}, "'resoluton'; did you mean 'resolution'?"),
        ({"occupied_thresh": None, "occupied_tresh": 0.5}, "'occupied_tresh'; did you mean 'occupied_thresh'?"),
    ],
)
def test_bad_entries_are_refused(tmp_path: Path, changes: dict[str, object], named: str) -> None:
    assert named in refusal(write(tmp_path, **changes))


@pytest.mark.parametrize(
    ("image", "named"),
    [
        (b"", "is empty"),
        (pgm(PIXELS)[:-1], "is cut short"),
        (pgm(PIXELS)[:6], "torn header"),
        (b"P5\nwide high\n255\n", "torn header"),
        (png(PIXELS)[:-3], "is cut short"),
        (png(PIXELS)[:20], "is cut short"),
        (png(np.random.default_rng(0).integers(0, 255, (64, 64), dtype=np.uint8))[:2000], "is cut short"),
        (b"P2\n3 2\n255\n0 205", "is damaged"),
        (b"P5\n3 2\n100\n" + bytes(6), "100 as its white"),
        (b"P5\n0 2\n255\n", "0 x 2 cells"),
        (b"GIF89a-------------------", "neither a PGM"),
        (b"P5\n50000 50000\n255\n" + bytes(9), "is cut short"),
        (b"P2\n50000 50000\n255\n0 0 0", "at most 20 million cells"),
        (b"P2\n999999999999 1\n255\n0 0 0", "at most 20 million cells"),
        (b"P2\n30000 10\n255\n0 0 0", "at most 1000 m"),
    ],
)
def test_bad_pictures_are_refused(tmp_path: Path, image: bytes, named: str) -> None:
    assert named in refusal(write(tmp_path, image))


@given(which=st.sampled_from(["pgm", "png"]), position=st.integers(0, 70), byte=st.integers(0, 255))
def test_a_damaged_picture_is_read_or_refused(
    tmp_path_factory: pytest.TempPathFactory, which: str, position: int, byte: int
) -> None:
    data = bytearray(pgm(PIXELS) if which == "pgm" else png(PIXELS))
    data[position % len(data)] = byte
    path = write(tmp_path_factory.mktemp("damaged"), bytes(data))
    try:
        assert set(np.unique(load_map(path).occupancy)) <= {-1, 0, 100}
    except MapError as error:
        assert "\n" not in str(error)


def test_a_png_that_unpacks_to_a_huge_area_is_refused_before_it_is_decoded(tmp_path: Path) -> None:
    header = b"IHDR" + (60000).to_bytes(4, "big") * 2 + bytes([8, 0, 0, 0, 0])
    chunks = [header, b"IDAT" + zlib.compress(b""), b"IEND"]
    data = b"\x89PNG\r\n\x1a\n" + b"".join(
        (len(chunk) - 4).to_bytes(4, "big") + chunk + zlib.crc32(chunk).to_bytes(4, "big") for chunk in chunks
    )
    assert "at most 20 million cells" in refusal(write(tmp_path, data))


@pytest.mark.parametrize(
    "text",
    [
        b"image: [unclosed",
        b"\xff\xfe\x00\x01",
        b"- a\n- list\n",
        b"just words",
        b"",
        b"[" * 5000,
        b"resolution: 2020-99-99",
        b"image: !!python/object:os.system x",
    ],
)
def test_malformed_yaml_is_refused(tmp_path: Path, text: bytes) -> None:
    path = tmp_path / "map.yaml"
    path.write_bytes(text)
    refusal(path)


def test_a_missing_file_and_a_folder_are_refused(tmp_path: Path) -> None:
    assert "No such file" in refusal(tmp_path / "none.yaml")
    assert "cannot be read" in refusal(tmp_path)


@given(
    grid=hnp.arrays(
        np.int8, hnp.array_shapes(min_dims=2, max_dims=2, max_side=12), elements=st.sampled_from([-1, 0, 100])
    ),
    resolution=st.floats(0.005, 2.0),
    origin=st.tuples(*[st.floats(-1e3, 1e3)] * 3),
)
def test_what_is_saved_is_loaded_to_the_bit(
    tmp_path_factory: pytest.TempPathFactory,
    grid: np.ndarray,
    resolution: float,
    origin: tuple[float, float, float],
) -> None:
    loaded = load_map(save_map(tmp_path_factory.mktemp("maps") / "a: floor.yaml", grid, resolution, origin))
    assert np.array_equal(loaded.occupancy, grid)
    assert (loaded.resolution, loaded.origin) == (resolution, origin)


def test_the_saved_files_are_those_of_a_map_saver(tmp_path: Path) -> None:
    path = save_map(tmp_path / "floor.2", np.array([[-1, 0, 100], [10, 50, 70]], dtype=np.int8), 0.05, (1.0, -2.0))
    assert sorted(file.name for file in tmp_path.iterdir()) == ["floor.2.pgm", "floor.2.yaml"]
    assert (tmp_path / "floor.2.pgm").read_bytes() == b"P5\n3 2\n255\n" + bytes([254, 205, 0, 205, 254, 0])
    assert yaml.safe_load(path.read_text()) == {
        "image": "floor.2.pgm",
        "mode": "trinary",
        "resolution": 0.05,
        "origin": [1.0, -2.0, 0.0],
        "negate": 0,
        "occupied_thresh": 0.65,
        "free_thresh": 0.196,
    }


@pytest.mark.parametrize(
    ("grid", "resolution", "origin", "named"),
    [
        (np.zeros(4, dtype=np.int8), 0.05, (0, 0), "shape (4,)"),
        (np.zeros((0, 3), dtype=np.int8), 0.05, (0, 0), "shape (0, 3)"),
        (np.zeros((2, 2)), 0.05, (0, 0), "float64"),
        (np.full((2, 2), 101), 0.05, (0, 0), "101"),
        (np.full((2, 2), -2), 0.05, (0, 0), "-2"),
        (np.zeros((2, 2), dtype=np.int8), 0.0, (0, 0), "0 m"),
        (np.zeros((2, 2), dtype=np.int8), 0.05, (0, float("nan")), "origin"),
    ],
)
def test_grids_that_are_no_maps_are_not_saved(
    tmp_path: Path, grid: np.ndarray, resolution: float, origin: tuple[float, float], named: str
) -> None:
    with pytest.raises(MapError) as caught:
        save_map(tmp_path / "map.yaml", grid, resolution, origin)
    assert named in str(caught.value)
    assert not list(tmp_path.iterdir())


def test_a_failed_write_leaves_the_old_map(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = save_map(tmp_path / "map", np.zeros((2, 2), dtype=np.int8), 0.05)

    def full_disk(source: str, target: str) -> None:
        raise OSError("disk full")

    monkeypatch.setattr("lidarena.world.map_server.os.replace", full_disk)
    with pytest.raises(OSError, match="disk full"):
        save_map(tmp_path / "map", np.full((3, 3), 100, dtype=np.int8), 0.05)
    assert load_map(path).occupancy.tolist() == [[0, 0], [0, 0]]
    assert len(list(tmp_path.iterdir())) == 2


@needs_data
@pytest.mark.parametrize("name", ["intel", "freiburg-079", "willow_0.10", "aws_small_warehouse_005"])
def test_recorded_maps_load(name: str) -> None:
    grid = load_map(DATA / "maps" / f"{name}.yaml")
    shares = [(grid.occupancy == value).mean() for value in (-1, 0, 100)]
    assert shares[1] > 0.1
    assert 0.0005 < shares[2] < 0.2
    assert sum(shares) == pytest.approx(1.0)


def test_a_key_that_stands_there_twice_is_refused(tmp_path: Path) -> None:
    file = write(tmp_path, pgm(PIXELS))
    file.write_text(file.read_text() + "resolution: 0.1\n")
    with pytest.raises(MapError, match="has the key 'resolution' twice"):
        load_map(file)
