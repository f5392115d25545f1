from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra import numpy as hnp

from lidarena.base.errors import MapError
from lidarena.world.movingai import load_movingai, movingai_floorplan
from tests.world.shared_data import DATA, needs_data

HEADER = "type octile\nheight 2\nwidth 4\nmap\n"


def write(folder: Path, text: str | bytes) -> Path:
    path = folder / "grid.map"
    path.write_bytes(text if isinstance(text, bytes) else text.encode())
    return path


def test_every_character_of_the_format(tmp_path: Path) -> None:
    free = load_movingai(write(tmp_path, "type octile\nheight 1\nwidth 7\nmap\n.GS@OTW\n"))
    assert free.tolist() == [[True, True, True, False, False, False, False]]


def test_the_first_line_is_the_top(tmp_path: Path) -> None:
    free = load_movingai(write(tmp_path, HEADER + "....\n@@@.\n"))
    assert free.tolist() == [[False, False, False, True], [True] * 4]


@pytest.mark.parametrize(
    "text",
    [
        "type octile\nwidth 4\nheight 2\nmap\n....\n@@@.",
        (HEADER + "....\n@@@.\n\n\n").replace("\n", "\r\n"),
        HEADER + "....  \n@@@.\n",
    ],
)
def test_order_of_the_header_and_ends_of_lines_do_not_matter(tmp_path: Path, text: str) -> None:
    assert load_movingai(write(tmp_path, text)).sum() == 5


@pytest.mark.parametrize(
    ("text", "named"),
    [
        ("", "header"),
        ("....\n....\n", "header"),
        ("type octile\nheight 2\nmap\n....\n....\n", "header"),
        ("type octile\nheight 2\nwidth 4\n....\n....\n", "header"),
        ("height 2\nwidth 4\nmap\n\n....\n....\n", "header"),
        (HEADER.replace("height 2", "height two") + "....\n....\n", "height 'two'"),
        (HEADER.replace("width 4", "width -4") + "....\n....\n", "width '-4'"),
        (HEADER.replace("width 4", "width 0") + "....\n....\n", "width '0'"),
        (HEADER.replace("height 2", "height 99999 9") + "....\n", "height"),
        (HEADER.replace("height 2", "height 100000").replace("width 4", "width 100000"), "at most 20 million cells"),
        (HEADER + "....\n", "1 rows of cells; its header says 2"),
        (HEADER + "....\n....\n....\n", "3 rows of cells"),
        (HEADER + "....\n...\n", "3 cells in row 1; its header says 4"),
        (HEADER + ".....\n....\n", "5 cells in row 0"),
        (HEADER + "....\n..x.\n", "'x' in row 1, column 2; . G S @ O T W are allowed"),
        (HEADER + "....\n.. .\n", "' ' in row 1, column 2"),
        (HEADER.encode() + b"....\n..\xff.\n", "not ASCII"),
    ],
)
def test_torn_files_are_refused(tmp_path: Path, text: str | bytes, named: str) -> None:
    path = write(tmp_path, text)
    with pytest.raises(MapError) as caught:
        load_movingai(path)
    assert named in str(caught.value)
    assert str(path) in str(caught.value)
    assert "\n" not in str(caught.value)


def test_a_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="No such file"):
        load_movingai(tmp_path / "none.map")


@given(free=hnp.arrays(np.bool_, hnp.array_shapes(min_dims=2, max_dims=2, max_side=15)), data=st.data())
def test_any_grid_is_read_back(tmp_path_factory: pytest.TempPathFactory, free: np.ndarray, data: st.DataObject) -> None:
    passable, blocked = data.draw(st.sampled_from(".GS")), data.draw(st.sampled_from("@OTW"))
    rows = ["".join(passable if cell else blocked for cell in row) for row in free[::-1]]
    text = f"type octile\nheight {free.shape[0]}\nwidth {free.shape[1]}\nmap\n" + "\n".join(rows)
    assert np.array_equal(load_movingai(write(tmp_path_factory.mktemp("maps"), text)), free)


def test_the_floor_plan_has_cells_of_a_metre_unless_told(tmp_path: Path) -> None:
    path = write(tmp_path, HEADER + "....\n....\n")
    assert movingai_floorplan(path).bounds == (0.0, 0.0, 4.0, 2.0)
    plan = movingai_floorplan(path, cell=0.5, start=(0.3, 0.3, 0.0))
    assert (plan.bounds, plan.name, plan.start) == ((0.0, 0.0, 2.0, 1.0), "grid", (0.3, 0.3, 0.0))


def test_blocked_cells_are_solid_in_the_floor_plan(tmp_path: Path) -> None:
    plan = movingai_floorplan(write(tmp_path, HEADER + "....\n@@@.\n"))
    centres = np.array([[0.5, 1.5], [3.5, 0.5], [1.5, 0.5]])
    assert np.allclose(plan.clearance(centres), [0.5, 0.5, -0.5])


@pytest.mark.parametrize("cell", [0.0, -1.0, 5.0, float("nan")])
def test_absurd_cells_are_refused(tmp_path: Path, cell: float) -> None:
    with pytest.raises(MapError, match=r"0\.005 to 2 m"):
        movingai_floorplan(write(tmp_path, HEADER + "....\n....\n"), cell=cell)


def test_a_map_of_more_than_a_kilometre_is_refused_with_a_hint(tmp_path: Path) -> None:
    path = write(tmp_path, "type octile\nheight 1\nwidth 1024\nmap\n" + "." * 1024)
    with pytest.raises(MapError, match="at most 1000 m are allowed, so its cells may be smaller"):
        movingai_floorplan(path)
    assert movingai_floorplan(path, cell=0.5).bounds[2] == 512


def test_a_map_without_free_cells_is_no_floor_plan(tmp_path: Path) -> None:
    with pytest.raises(MapError, match="no free space"):
        movingai_floorplan(write(tmp_path, HEADER + "@@@@\n@@@@\n"))


@needs_data
@pytest.mark.parametrize(
    ("file", "shape", "free"),
    [
        ("mapf/map/empty-8-8.map", (8, 8), 64),
        ("mapf/map/random-32-32-20.map", (32, 32), 819),
        ("mapf/map/room-32-32-4.map", (32, 32), 682),
        ("mapf/map/warehouse-10-20-10-2-1.map", (63, 161), 5699),
    ],
)
def test_benchmark_maps(file: str, shape: tuple[int, int], free: int) -> None:
    grid = load_movingai(DATA / file)
    assert (grid.shape, int(grid.sum())) == (shape, free)
    assert movingai_floorplan(DATA / file).bounds[2:] <= (shape[1], shape[0])
