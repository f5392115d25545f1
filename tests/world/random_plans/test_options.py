"""Floor plans drawn afresh: reproducible, of the size asked for, in one piece, and refused where they cannot be."""

import cv2
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan
from lidarena.world.plan_generators import size_of
from lidarena.world.random_plans import KINDS, MIXED, RandomPlans, options_of, random_plan, random_plans

CLEARANCE = 0.12
CELL = 0.05


def places(plan: Floorplan) -> np.ndarray:
    """Cells where a robot of 0.12 m radius can stand, inside the drawing."""
    raster = plan.raster(CELL)
    y, x = (raster.origin[axis] + (np.arange(raster.solid.shape[1 - axis]) + 0.5) * CELL for axis in (1, 0))
    inside_x = (x > plan.bounds[0]) & (x < plan.bounds[2])
    inside_y = (y > plan.bounds[1]) & (y < plan.bounds[3])
    return ~raster.solid & (raster.clearance >= CLEARANCE) & inside_y[:, None] & inside_x[None, :]


def same(one: Floorplan, other: Floorplan) -> bool:
    equal = one.edges.tobytes() == other.edges.tobytes() and one.circles.tobytes() == other.circles.tobytes()
    return equal and one.start == other.start and one.bounds == other.bounds


@settings(max_examples=50, deadline=None)
@given(st.sampled_from([*KINDS]), st.integers(0, 2**32 - 1))
def test_every_place_can_be_reached_from_the_start(kind: str, seed: int) -> None:
    plan = random_plan(kind, np.random.default_rng(seed), area_min=20, area_max=400)
    free = places(plan)
    _, labels, stats, _ = cv2.connectedComponentsWithStats(free.astype(np.uint8), connectivity=8)
    raster = plan.raster(CELL)
    column, row = np.floor((np.array(plan.start[:2]) - raster.origin) / CELL).astype(int)
    reached = stats[labels[row, column], cv2.CC_STAT_AREA]
    assert labels[row, column] > 0
    assert free.sum() - reached <= 4  # single cells in corners, as the raster has them
    assert plan.clearance(np.array([plan.start[:2]]))[0] >= 0.3


@settings(max_examples=30, deadline=None)
@given(st.sampled_from([*KINDS]), st.integers(0, 2**32 - 1))
def test_whoever_keeps_17_cm_from_walls_reaches_next_to_all_places(kind: str, seed: int) -> None:
    """So that careful drivers, too, come to know what completeness counts; under tables they may only look."""
    plan = random_plan(kind, np.random.default_rng(seed), area_min=20, area_max=120)
    raster, free = plan.raster(CELL), places(plan)
    _, labels = cv2.connectedComponents((free & (raster.clearance >= 0.17)).astype(np.uint8), connectivity=4)
    column, row = np.floor((np.array(plan.start[:2]) - raster.origin) / CELL).astype(int)
    careful = (labels == labels[row, column]).astype(np.uint8)
    assert labels[row, column] > 0
    away = cv2.distanceTransform(1 - careful, cv2.DIST_L2, cv2.DIST_MASK_PRECISE) * CELL
    assert (free & (away > 0.3)).sum() <= 0.03 * free.sum() and away[free].max() <= 0.8


@settings(max_examples=40, deadline=None)
@given(st.sampled_from([*KINDS]), st.floats(20.0, 400.0), st.floats(0.0, 1.0), st.integers(0, 2**32 - 1))
def test_sizes_lie_within_those_asked_for(kind: str, low: float, share: float, seed: int) -> None:
    high = low + share * (400.0 - low)
    plans = RandomPlans(kind, {"area_min": low, "area_max": high})
    width, height = size_of(plans(np.random.default_rng(seed)))
    assert 0.97 * low <= width * height <= 1.03 * high
    assert width <= plans.size[0] and height <= plans.size[1]


@pytest.mark.parametrize("kind", [*KINDS, MIXED])
def test_the_same_generator_draws_the_same_plan_and_the_next_another(kind: str) -> None:
    rng = np.random.default_rng(5)
    first, second = random_plan(kind, rng), random_plan(kind, rng)
    again = np.random.default_rng(5)
    assert same(first, random_plan(kind, again)) and same(second, random_plan(kind, again))
    assert not same(first, second)


@pytest.mark.parametrize("kind", [*KINDS])
@pytest.mark.parametrize("area", [20.0, 100.0, 400.0])
def test_sizes_are_those_that_were_asked_for(kind: str, area: float) -> None:
    plan = random_plan(kind, np.random.default_rng(1), area=area)
    width, height = plan.bounds[2] - plan.bounds[0], plan.bounds[3] - plan.bounds[1]
    assert width * height == pytest.approx(area, rel=0.05)
    for sides in ((9.0, 7.0), (3.0, 7.0), (10.0, 40.0)):
        plan = random_plan(kind, np.random.default_rng(2), width=sides[0], height=sides[1])
        assert plan.bounds == pytest.approx((0.0, 0.0, *sides))


def test_areas_are_drawn_from_the_whole_range() -> None:
    rng, areas = np.random.default_rng(3), []
    for _ in range(200):
        x0, y0, x1, y1 = random_plan("warehouse", rng, area_min=30, area_max=300).bounds
        areas.append((x1 - x0) * (y1 - y0))
    assert 29 < min(areas) < 40 and 220 < max(areas) < 310
    assert np.median(areas) == pytest.approx(95, rel=0.2)  # evenly on a logarithmic scale


def test_furnished_rooms_hold_thin_legs_round_and_slanted_things() -> None:
    rng = np.random.default_rng(0)
    plans = [random_plan("furnished", rng, area=100) for _ in range(20)]
    radii = np.concatenate([plan.circles[:, 2] for plan in plans])
    legs = radii[radii <= 0.03]
    assert len(legs) > 100 and legs.min() >= 0.015
    assert (radii > 0.08).sum() > 10
    slants = sum(int((plan.edges[:, :2] != plan.edges[:, 2:]).all(axis=1).sum()) for plan in plans)
    assert slants > 40
    assert len(random_plan("furnished", np.random.default_rng(1), clutter=0.0).circles) == 0


def test_mixed_draws_every_kind() -> None:
    rng = np.random.default_rng(4)
    assert {random_plan(MIXED, rng).name for _ in range(60)} == {f"random:{kind}" for kind in KINDS}


@pytest.mark.parametrize(
    ("kind", "options", "sentence"),
    [
        ("mase", {}, "no kind of random plans 'mase'; did you mean 'maze'"),
        ("rooms", {"dor": 1.0}, "no option 'dor'; did you mean 'door'"),
        ("rooms", {"door": 9.0}, "door 9; 0.6 to 2 are allowed"),
        ("cave", {"area": float("nan")}, "area nan; 20 to 400 are allowed"),
        ("maze", {"width": 8.0}, "width and height together"),
        ("maze", {"width": 8.0, "height": 8.0, "area": 64.0}, "one way to say its size"),
        ("maze", {"width": 4.0, "height": 4.0}, "20 to 400 m² are allowed"),
        ("maze", {"area_min": 90.0, "area_max": 40.0}, "area_min 90 above area_max 40"),
        ("maze", {"width": 5.0, "height": 4.0, "corridor": 4.0}, "too small"),
        ("rooms", {"width": 5.0, "height": 4.0, "room": 4.0}, "no room for two rooms of 4 m"),
        ("warehouse", {"width": 5.0, "height": 4.0, "aisle": 2.0}, "no room for a rack"),
        ("cave", {"area": 20.0, "passage": 3.0, "rock": 0.55}, "no cave of"),
        ("mixed", {"door": 1.0}, "no option 'door'"),
    ],
)
def test_what_cannot_be_is_refused_in_one_sentence(kind: str, options: dict[str, float], sentence: str) -> None:
    with pytest.raises(MapError, match=sentence) as refusal:
        RandomPlans(kind, options)
    assert "\n" not in str(refusal.value)


def test_what_seldom_fits_is_refused_before_it_is_drawn() -> None:
    """In the middle of a training it would come too late."""
    random_plan("warehouse", np.random.default_rng(0), width=7.0, height=7.0, aisle=2.5)
    with pytest.raises(MapError, match="no room for a rack"):
        random_plans("random:warehouse?area_min=49&area_max=400&aisle=2.5")


def test_options_are_told_with_their_ranges() -> None:
    assert options_of("maze")["corridor"] == (0.8, 5.0)
    assert "door" not in options_of("mixed") and options_of("mixed")["area"] == (20.0, 400.0)
