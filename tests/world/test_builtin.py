import math

import cv2
import numpy as np
import pytest
import yaml

from lidarena.world.builtin import MAPS, builtin_floorplan, names
from lidarena.world.floorplan import Floorplan
from lidarena.world.map_server import load_map
from lidarena.world.picture import read_picture
from tests.world.corridors import CELL, count_parts, free_space, share_swept_by_disc
from tests.world.shared_data import DATA, needs_data

CIRCUITS = {"env1": (5.0, 5.6), "env2": (7.5, 7.5), "env3": (8.9, 10.2), "env4": (5.8, 8.8)}
FOR_TEAMS = ["office", "unstructured", "passing", "blocked"]
SHIPPED = ["turtlebot3_world", "aws_small_house", "willow", "willow_lobby"]


@pytest.fixture(scope="module")
def plans() -> dict[str, Floorplan]:
    return {name: builtin_floorplan(name) for name in names()}


def test_the_names() -> None:
    assert names() == [*CIRCUITS, *FOR_TEAMS, *SHIPPED]


@pytest.mark.parametrize(("name", "size"), CIRCUITS.items())
def test_circuits_have_the_size_that_the_paper_prints(
    plans: dict[str, Floorplan], name: str, size: tuple[float, float]
) -> None:
    plan = plans[name]
    assert plan.bounds == (0.0, 0.0, *size)
    corners = plan.edges.reshape(-1, 2)
    assert np.allclose(corners.min(axis=0), 0.0)
    assert np.allclose(corners.max(axis=0), size)


@pytest.mark.parametrize("name", CIRCUITS)
def test_circuits_are_closed(plans: dict[str, Floorplan], name: str) -> None:
    _, _, width, height = plans[name].bounds
    t = np.linspace(0.01, 0.99, 200)
    sides = [(t * width, 0.05 + 0 * t), (t * width, height - 0.05 + 0 * t)]
    sides += [(0.05 + 0 * t, t * height), (width - 0.05 + 0 * t, t * height)]
    for x, y in sides:
        assert (plans[name].clearance(np.column_stack([x, y])) < 0).all()


@pytest.mark.parametrize("name", CIRCUITS)
def test_a_disc_of_eighty_centimetres_reaches_every_place_of_a_circuit(plans: dict[str, Floorplan], name: str) -> None:
    space = free_space(plans[name])
    assert count_parts(space.free) == 1
    fits = space.distance >= 0.4 - CELL / 2
    assert count_parts(fits) == 1
    assert share_swept_by_disc(space, 0.4) > 0.96


@pytest.mark.parametrize(
    ("name", "axes"), [("env1", "xy"), ("env3", "x"), ("env4", "xy")], ids=["env1", "env3", "env4"]
)
def test_circuits_are_symmetrical_where_the_paper_says_so(plans: dict[str, Floorplan], name: str, axes: str) -> None:
    plan = plans[name]
    points = np.random.default_rng(0).uniform(plan.bounds[:2], plan.bounds[2:], (500, 2))
    for axis in axes:
        mirrored = points.copy()
        k = "xy".index(axis)
        mirrored[:, k] = plan.bounds[2 + k] - mirrored[:, k]
        assert np.allclose(plan.clearance(points), plan.clearance(mirrored))


def test_the_first_circuit_has_round_and_slanted_obstacles(plans: dict[str, Floorplan]) -> None:
    plan = plans["env1"]
    assert len(plan.circles) == 6
    slanted = (plan.edges[:, 0] != plan.edges[:, 2]) & (plan.edges[:, 1] != plan.edges[:, 3])
    assert slanted.sum() == 8


@pytest.mark.parametrize(("name", "islands"), [("env1", 1), ("env2", 3), ("env3", 4), ("env4", 4)])
def test_circuits_have_loops_to_close(plans: dict[str, Floorplan], name: str, islands: int) -> None:
    """Every wall that does not hang on the outer one is a loop around it."""
    walls = ~free_space(plans[name]).free
    assert count_parts(walls) == 1 + islands


@pytest.mark.parametrize("name", [*CIRCUITS, *FOR_TEAMS, *SHIPPED])
def test_starts_are_roomy_and_face_open_space(plans: dict[str, Floorplan], name: str) -> None:
    plan = plans[name]
    x, y, theta = plan.start
    assert plan.clearance(np.array([[x, y]]))[0] >= 0.3
    ahead = np.array([[x + d * math.cos(theta), y + d * math.sin(theta)] for d in np.linspace(0, 0.8, 9)])
    assert (plan.clearance(ahead) > 0.25).all()


@pytest.mark.parametrize("name", SHIPPED)
def test_shipped_maps_start_in_their_largest_reachable_part(plans: dict[str, Floorplan], name: str) -> None:
    raster = plans[name].raster(0.05)
    reachable = (~raster.solid & (raster.clearance > 0.12)).astype(np.uint8)
    _, parts, stats, _ = cv2.connectedComponentsWithStats(reachable, connectivity=4)
    column, row = np.floor((np.array(plans[name].start[:2]) - raster.origin) / 0.05).astype(int)
    areas = stats[1:, cv2.CC_STAT_AREA]
    assert parts[row, column] == 1 + int(np.argmax(areas))
    assert areas.max() > 0.7 * (~raster.solid).sum()


def test_the_lobby_is_a_crop_of_the_building_in_the_same_coordinates() -> None:
    building, lobby = load_map(MAPS / "willow.yaml"), load_map(MAPS / "willow_lobby.yaml")
    rows, columns = lobby.occupancy.shape
    assert (rows, columns) == (135, 140)
    column, row = (round((a - b) / 0.1) for a, b in zip(lobby.origin[:2], building.origin[:2], strict=True))
    assert np.array_equal(building.occupancy[row : row + rows, column : column + columns], lobby.occupancy)


def test_every_shipped_map_has_its_source_and_licence() -> None:
    text = (MAPS / "LICENSES.md").read_text(encoding="utf-8")
    described = {line.split("`")[1] for line in text.splitlines() if line.startswith("| `")}
    assert described == {path.stem for path in MAPS.glob("*.yaml")} == {path.stem for path in MAPS.glob("*.png")}
    assert described == set(SHIPPED)
    for words in (
        "Willow Garage, Inc. nor the names",
        "MIT No Attribution",
        "TERMS AND CONDITIONS FOR USE, REPRODUCTION",
    ):
        assert words in text
    assert {path.suffix for path in MAPS.iterdir()} == {".yaml", ".png", ".md"}


@needs_data
@pytest.mark.parametrize(
    ("name", "original"),
    [("turtlebot3_world", "turtlebot3_world"), ("aws_small_house", "aws_small_house"), ("willow", "willow_0.10")],
)
def test_shipped_pixels_are_those_of_the_originals(name: str, original: str) -> None:
    ours, _ = read_picture(MAPS / f"{name}.png", name, 0.1)
    theirs, _ = read_picture(DATA / "maps" / f"{original}.pgm", original, 0.1)
    assert np.array_equal(ours, theirs)
    entries, original_entries = (
        yaml.safe_load(path.read_text()) for path in (MAPS / f"{name}.yaml", DATA / "maps" / f"{original}.yaml")
    )
    assert {**original_entries, "image": f"{name}.png", "mode": "trinary"} == entries
