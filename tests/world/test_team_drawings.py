import numpy as np
import pytest

from lidarena.world.floorplan import Floorplan
from lidarena.world.load import load_floorplan
from lidarena.world.team_drawings import team_places
from tests.world.corridors import count_parts, free_space

SIZES = {"office": (19.0, 15.0), "unstructured": (14.0, 12.0), "passing": (10.4, 3.4), "blocked": (16.2, 6.4)}


@pytest.fixture(params=SIZES)
def plan(request: pytest.FixtureRequest) -> Floorplan:
    return load_floorplan(request.param)


def test_plans_have_their_size_and_are_closed(plan: Floorplan) -> None:
    assert plan.bounds[2:] == SIZES[plan.name]
    _, _, width, height = plan.bounds
    t = np.linspace(0.01, 0.99, 100)
    for x, y in ((t * width, 0 * t + 0.1), (t * width, 0 * t + height - 0.1), (0 * t + 0.1, t * height)):
        assert (plan.clearance(np.column_stack([x, y])) < 0).all()
    assert count_parts(free_space(plan).free) == 1


def test_robots_stand_free_and_apart(plan: Floorplan) -> None:
    places = team_places(plan.name)
    assert places is not None
    for points in (places.starts, places.goals):
        assert (plan.clearance(points) >= 0.25).all()
        gaps = np.linalg.norm(points[:, None] - points[None], axis=-1) + 9 * np.eye(len(points))
        assert gaps.min() > 0.45
    assert places.starts.shape == places.goals.shape
    assert places.drawn == (plan.name in ("office", "unstructured"))


def test_other_floor_plans_have_no_places() -> None:
    assert team_places("env1") is None


def test_the_office_has_nine_rooms_along_its_corridor() -> None:
    """Closing the corridor leaves seven parts: the rooms, of which two pairs are connected."""
    space = free_space(load_floorplan("office"))
    free = space.free.copy()
    rows = np.arange(free.shape[0]) * 15.0 / free.shape[0]
    free[(rows > 6.2) & (rows < 8.8)] = False
    sizes = count_parts(free)
    assert sizes == 7


def test_the_dead_end_and_the_corridor_are_too_narrow_for_two() -> None:
    for name, point in (("passing", (2.5, 0.6)), ("blocked", (10.0, 3.2))):
        assert load_floorplan(name).clearance(np.array([point]))[0] == pytest.approx(0.4)
