"""The default start is the roomiest place, uncapped, of the largest connected part."""

import warnings
from pathlib import Path

import numpy as np
import pytest

from lidarena.world.default_start import find_start
from lidarena.world.floorplan import START_CLEARANCE, Floorplan
from lidarena.world.load import load_floorplan
from lidarena.world.map_server import save_map


def hall_and_closet() -> Floorplan:
    """A closet of 6 m², in the first rows, beside a hall of 400 m², without a door between them."""
    free = np.zeros((260, 220), bool)
    free[5:55, 10:58] = True
    free[60:260, 10:210] = True
    return Floorplan.from_grid("hall", ~free, 0.1)


def test_the_start_is_in_the_middle_of_the_hall_and_the_closet_is_told(tmp_path: Path) -> None:
    plan = hall_and_closet()
    assert plan.start == pytest.approx((11.0, 16.0, 0.0), abs=0.2)
    assert plan.clearance(np.array([plan.start[:2]]))[0] == pytest.approx(10.0, abs=0.15)
    cells = np.where(hall_and_closet().raster(0.1).solid, 100, 0).astype(np.int8)
    file = save_map(tmp_path / "hall", cells, 0.1)
    with pytest.warns(UserWarning, match=r"2 parts .* largest, of 39\d m² \(the others: 2\d m²\)"):
        load_floorplan(file)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        load_floorplan(file, (4.0, 3.0, 0.0))


def test_one_part_is_not_told() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plan = Floorplan.from_shapes(
            "box", (0, 0, 9, 5), walls=[(0, 0, 9, 0), (9, 0, 9, 5), (9, 5, 0, 5), (0, 5, 0, 0)]
        )
    assert plan.start[1] == pytest.approx(2.5, abs=0.1)


def test_a_passage_narrower_than_a_robot_parts_two_rooms() -> None:
    free = np.zeros((60, 120), bool)
    free[2:58, 2:50], free[2:58, 60:118] = True, True
    free[30:32, 50:60] = True
    plan = Floorplan.from_grid("two", ~free, 0.05, start=(4.5, 1.5, 0.0))
    raster = plan.raster(0.05)
    everywhere = np.ones(raster.solid.shape, bool)
    assert len(find_start(raster, everywhere, START_CLEARANCE).parts) == 2
    assert len(find_start(raster, everywhere, 0.02).parts) == 1


@pytest.mark.parametrize("seed", range(4))
def test_no_other_place_of_the_largest_part_is_roomier(seed: int) -> None:
    rng = np.random.default_rng(seed)
    free = np.ones((80, 100), bool)
    free[rng.integers(0, 80, 12), rng.integers(0, 100, 12)] = False
    plan = Floorplan.from_grid("points", ~free, 0.1, start=None)
    cells = np.argwhere(free)[:, ::-1] * 0.1 + 0.05
    assert plan.clearance(np.array([plan.start[:2]]))[0] >= plan.clearance(cells).max() - 0.08
