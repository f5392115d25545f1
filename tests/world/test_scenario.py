from pathlib import Path

import numpy as np
import pytest

from lidarena.base.errors import ScenarioError
from lidarena.world.movingai import load_movingai
from lidarena.world.scenario import load_scenario
from tests.world.shared_data import DATA, needs_data

FREE = np.array([[True, True, True], [True, False, True]])  # row 0 is the file's last line
LINE = "0\tgrid.map\t3\t2\t0\t0\t2\t1\t3.41\n"


def write(folder: Path, text: str | bytes) -> Path:
    path = folder / "teams.scen"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_rows_count_from_the_smallest_y(tmp_path: Path) -> None:
    starts, goals = load_scenario(write(tmp_path, "version 1\n" + LINE), FREE)
    assert starts.tolist() == [[1, 0]] and goals.tolist() == [[0, 2]]


def test_the_first_robots_are_taken(tmp_path: Path) -> None:
    other = LINE.replace("\t0\t0\t2\t1\t", "\t2\t0\t1\t1\t")
    path = write(tmp_path, "version 1.0\r\n" + LINE + "\n" + other + "\n")
    assert len(load_scenario(path, FREE).starts) == 2
    assert load_scenario(path, FREE, 1, "grid.map").goals.tolist() == [[0, 2]]


@pytest.mark.parametrize(
    ("text", "options", "named"),
    [
        ("", {}, "first line must be 'version 1'"),
        (LINE, {}, "first line must be 'version 1'"),
        ("version 1\n" + LINE[:12], {}, "torn in line 2"),
        ("version 1\n" + LINE + LINE.replace("3.41", ""), {}, "torn in line 3"),
        ("version 1\n" + LINE.replace("\t2\t1\t", "\ttwo\t1\t"), {}, "torn in line 2"),
        ("version 1\n\n" + LINE + "\n" + LINE[:12], {}, "torn in line 5"),
        ("version 1\n" + LINE, {"robots": 2}, "starts for 1 robots; 2 are asked for"),
        ("version 1\n" + LINE + LINE, {"robots": -1}, "starts for 2 robots; -1 are asked for"),
        ("version 1\n" + LINE, {"robots": 0}, "starts for 1 robots; 0 are asked for"),
        ("version 1\n" + LINE, {"map_name": "other.map"}, "for the map 'grid.map'; the map given is 'other.map'"),
        ("version 1\n" + LINE.replace("\t3\t2\t", "\t9\t2\t"), {}, "a map of 9 x 2 cells"),
        (
            "version 1\n" + LINE.replace("\t2\t1\t", "\t1\t0\t"),
            {},
            "the goal of robot 0 at x = 1, y = 0, which is a wall",
        ),
        ("version 1\n" + LINE.replace("\t0\t0\t2", "\t0\t-1\t2"), {}, "outside of 3 x 2 cells"),
        (b"version 1\n\xff\xfe", {}, "not ASCII"),
    ],
)
def test_bad_files_are_refused(tmp_path: Path, text: str | bytes, options: dict[str, object], named: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(ScenarioError) as caught:
        load_scenario(path, FREE, **options)  # type: ignore[arg-type]
    assert named in str(caught.value) and str(path) in str(caught.value) and "\n" not in str(caught.value)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(ScenarioError, match="No such file"):
        load_scenario(tmp_path / "none.scen", FREE)


@needs_data
def test_every_shipped_scenario_fits_its_map() -> None:
    paths = sorted((DATA / "mapf" / "scen-random").glob("*.scen"))
    assert len(paths) == 40
    for path in paths:
        name = path.name.split("-random-")[0] if path.name.startswith(("empty", "room", "ware")) else "random-32-32-20"
        free = load_movingai(DATA / "mapf" / "map" / f"{name}.map")
        assert len(load_scenario(path, free, map_name=f"{name}.map").starts) > 30
