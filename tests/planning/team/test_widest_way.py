import numpy as np
import pytest

from lidarena.planning.team.widest_way import narrowest_place
from lidarena.world.floorplan import Floorplan


def two_rooms(door: float) -> Floorplan:
    """Rooms of 4 x 4 m beside each other, a door in the middle of the wall at x = 4; edges are solid on their left."""
    wall = [(0, 0, 0, 4), (0, 4, 8, 4), (8, 4, 8, 0), (8, 0, 0, 0)]
    for low, high in ((0.0, 2.0 - door / 2), (2.0 + door / 2, 4.0)):
        wall += [(4.1, low, 3.9, low), (3.9, low, 3.9, high), (3.9, high, 4.1, high), (4.1, high, 4.1, low)]
    return Floorplan("rooms", np.array(wall, float), np.empty((0, 3)), (0.0, 0.0, 8.0, 4.0), (1.0, 2.0, 0.0))


@pytest.mark.parametrize("door", [0.3, 0.8])
def test_the_door_is_the_narrowest_place_between_two_rooms(door: float) -> None:
    found = narrowest_place(two_rooms(door), 0.05, (1.0, 1.0), (7.0, 3.0))
    assert found is not None
    place, width = found
    assert np.hypot(*(place - (4.0, 2.0))) < 0.2
    assert width == pytest.approx(door, abs=0.06)


def test_there_is_no_narrowest_place_without_a_way() -> None:
    assert narrowest_place(two_rooms(0.0), 0.05, (1.0, 1.0), (7.0, 3.0)) is None


def test_the_ends_themselves_may_be_the_narrowest_places() -> None:
    found = narrowest_place(two_rooms(1.0), 0.05, (0.25, 2.0), (2.0, 2.0))
    assert found is not None and found[1] == pytest.approx(0.5, abs=0.06)
