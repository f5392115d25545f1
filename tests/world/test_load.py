import os
from pathlib import Path

import numpy as np
import pytest

from lidarena.base.errors import MapError
from lidarena.world.builtin import MAPS
from lidarena.world.floorplan import Floorplan
from lidarena.world.load import load_floorplan, names
from lidarena.world.map_server import save_map
from lidarena.world.maze import generate_maze

ROOM = np.zeros((20, 30), dtype=np.int8)


def save_room(folder: Path, name: str = "room", grid: np.ndarray = ROOM) -> Path:
    return save_map(folder / name, grid, 0.1, (-1.0, -1.0))


def save_grid(folder: Path, rows: str = "....\n..@.\n") -> Path:
    path = folder / "grid.map"
    path.write_text(f"type octile\nheight 2\nwidth 4\nmap\n{rows}")
    return path


def same(a: Floorplan, b: Floorplan) -> bool:
    return np.array_equal(a.edges, b.edges) and np.array_equal(a.circles, b.circles) and a.start == b.start


@pytest.mark.parametrize("name", names())
def test_every_name_loads_and_is_kept(name: str) -> None:
    plan = load_floorplan(name)
    assert plan.name == name
    assert load_floorplan(name) is plan


def test_ros_maps_by_text_and_by_path(tmp_path: Path) -> None:
    path = save_room(tmp_path)
    plan = load_floorplan(path)
    assert plan.name == "room"
    assert plan.bounds == pytest.approx((-1.0, -1.0, 2.0, 1.0))
    assert load_floorplan(str(path)) is plan
    path.rename(tmp_path / "other.yml")
    assert same(load_floorplan(tmp_path / "other.yml"), plan)


def test_unknown_cells_are_solid(tmp_path: Path) -> None:
    grid = ROOM.copy()
    grid[:, 15:] = -1
    assert load_floorplan(save_room(tmp_path, grid=grid)).bounds == pytest.approx((-1.0, -1.0, 0.5, 1.0))


def test_the_yaw_of_the_origin_turns_the_map(tmp_path: Path) -> None:
    plan = load_floorplan(save_map(tmp_path / "turned", ROOM, 0.1, (0.0, 0.0, np.pi / 2)))
    assert plan.bounds == pytest.approx((-2.0, 0.0, 0.0, 3.0))


def test_movingai_maps_with_and_without_a_cell(tmp_path: Path) -> None:
    path = save_grid(tmp_path)
    assert load_floorplan(path).bounds == (0.0, 0.0, 4.0, 2.0)
    assert load_floorplan(f"{path}?cell=0.5").bounds == (0.0, 0.0, 2.0, 1.0)
    assert load_floorplan(path).name == "grid"


def test_mazes_with_and_without_options() -> None:
    assert same(load_floorplan("maze:7"), generate_maze(7))
    options = "width=10&height=8&corridor=1.2&loops=0.2&dead_ends=0.5&thickness=0.2"
    plan = load_floorplan(f"maze:7?{options}")
    assert plan.name == f"maze:7?{options}"
    assert same(plan, generate_maze(7, 10.0, 8.0, 1.2, 0.2, 0.5, 0.2))
    assert load_floorplan(f"maze:7?{options}") is plan


def test_a_floor_plan_passes_through() -> None:
    plan = generate_maze(1)
    assert load_floorplan(plan) is plan


def test_another_start() -> None:
    plan = load_floorplan("env1", start=(2.0, 0.8, 0.5))
    assert plan.start == (2.0, 0.8, 0.5)
    assert load_floorplan("env1").start != plan.start
    with pytest.raises(MapError, match="wall"):
        load_floorplan("env1", start=(1.25, 3.0, 0.0))


def test_a_file_that_changed_is_read_again(tmp_path: Path) -> None:
    path = save_room(tmp_path)
    first = load_floorplan(path)
    save_room(tmp_path, grid=ROOM[:10])
    os.utime(tmp_path / "room.pgm", ns=(1, 1))
    assert load_floorplan(path).bounds != first.bounds
    grid = save_grid(tmp_path)
    edges = len(load_floorplan(grid).edges)
    save_grid(tmp_path, "....\n....\n")
    os.utime(grid, ns=(1, 1))
    assert len(load_floorplan(grid).edges) < edges


@pytest.mark.parametrize(
    ("spec", "named"),
    [
        ("env5", "'env5' is not known; did you mean 'env"),
        ("Willow", "did you mean 'willow'?"),
        ("turtlebot_world", "did you mean 'turtlebot3_world'?"),
        ("", "is no name"),
        (None, "None is no name"),
        (7, "7 is no name"),
        (b"env1", "is no name"),
        ("env1\0", "is no name"),
        ("no/such/place", "is not known"),
        ("none.yaml", "'none.yaml' cannot be read: No such file"),
        ("none.yml", "No such file"),
        ("none.map", "No such file"),
        ("office.pgm", "give the .yaml file beside it"),
        ("office.png", "give the .yaml file beside it"),
        ("maze", "is not known"),
        ("maze:", "seed ''"),
        ("maze:x", "seed 'x'"),
        ("maze:-1", "seed '-1'"),
        ("maze:1.5", "seed '1.5'"),
        ("maze:99999999999999999999999", "whole number"),
        ("maze:9999999999999999999", "2^63"),
        ("maze:7?", None),
        ("maze:7?widht=9", "no option 'widht'; did you mean 'width'?"),
        ("maze:7?width", "options 'width'"),
        ("maze:7?width=", "width ''; a number"),
        ("maze:7?width=wide", "width 'wide'; a number"),
        ("maze:7?width=nan", "width nan"),
        ("maze:7?width=9&width=8", "'width' twice"),
        ("maze:7?corridor=0.5", "corridor 0.5 m; 0.8 to 5 m"),
        ("maze:7?loops=2", "loops 2; 0 to 1"),
        ("maze:7?dead_ends=-1", "dead_ends -1"),
        ("maze:7?width=2", "too small"),
        ("none.map?cel=0.5", "no option 'cel'; did you mean 'cell'?"),
        ("none.map?cell=big", "cell 'big'; a number"),
    ],
)
def test_bad_names_are_refused_in_one_sentence(spec: object, named: str | None) -> None:
    if named is None:
        assert load_floorplan(spec)  # type: ignore[arg-type]
        return
    with pytest.raises(MapError) as caught:
        load_floorplan(spec)  # type: ignore[arg-type]
    assert named in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("value", [-1, 100])
def test_a_map_without_free_space_is_refused(tmp_path: Path, value: int) -> None:
    path = save_room(tmp_path, grid=np.full((5, 5), value, dtype=np.int8))
    with pytest.raises(MapError, match="no free space"):
        load_floorplan(path)


def test_a_map_whose_picture_is_gone_is_refused(tmp_path: Path) -> None:
    path = save_room(tmp_path)
    load_floorplan(path)
    (tmp_path / "room.pgm").unlink()
    with pytest.raises(MapError, match=r"room\.pgm.*No such file"):
        load_floorplan(path)


def test_shipped_files_are_readable_by_path_too() -> None:
    with pytest.warns(UserWarning, match="parts between which there is no way"):
        by_path = load_floorplan(MAPS / "willow_lobby.yaml")
    assert np.array_equal(by_path.edges, load_floorplan("willow_lobby").edges)
