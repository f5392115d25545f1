"""What is remembered of scans, against a map that is counted anew."""

import math

import numpy as np
import pytest

from lidarena.envs.arena.seen_map import BLOCKED, SeenMap, empty_maps, forget, is_clear, note_free, note_hit

ROOM = np.array([-5.0, 0.0, 95.0, 60.0])


def begun(radius: float = 1.0) -> SeenMap:
    seen = empty_maps(2)
    for world in range(2):
        forget(world, ROOM, radius, seen)
    return seen


def counted(seen: SeenMap, world: int) -> np.ndarray:
    """What each cell costs, from the hits alone."""
    rows, columns = np.nonzero(seen.trust[world])
    side, (x0, y0) = float(seen.cell[world]), seen.origin[world]
    count = seen.cost.shape[1]
    x, y = x0 + (np.arange(count) + 0.5) * side, y0 + (np.arange(count) + 0.5) * side
    cost = np.ones((count, count), int)
    for r, c in zip(rows, columns, strict=True):
        px, py = seen.points[world, r, c].astype(float)
        away = np.hypot(x[None, :] - px, y[:, None] - py)
        for reach, dear in zip(seen.reach[world], (3, BLOCKED, 255), strict=True):
            cost = np.where(away < reach, np.maximum(cost, dear), cost)
        cost[r, c] = 255
    return cost


@pytest.mark.parametrize("radius", [0.05, 1.0, 2.15])
def test_cells_cost_what_the_hits_about_them_make_of_them(radius: float) -> None:
    seen, rng = begun(radius), np.random.default_rng(0)
    for _ in range(300):
        x, y = rng.uniform((-6.0, -1.0), (40.0, 40.0))
        note_hit(0, x, y, seen)
        angle = rng.uniform(-math.pi, math.pi)
        for _ in range(2):
            note_free(0, 20.0, 20.0, math.cos(angle), math.sin(angle), 25.0, seen)
    assert (seen.trust[0] > 0).sum() > 50
    assert np.array_equal(seen.cost[0], counted(seen, 0))
    assert (seen.cost[1] == 1).all()  # of the other world nothing was seen


def test_a_hit_is_forgotten_when_two_beams_have_passed_it_and_not_before() -> None:
    seen = begun()
    note_hit(0, 30.0, 30.0, seen)
    note_free(0, 20.0, 30.1, 1.0, 0.0, 25.0, seen)
    assert (seen.trust[0] > 0).any()
    note_hit(0, 30.0, 30.0, seen)  # seen again in between
    note_free(0, 20.0, 30.1, 1.0, 0.0, 25.0, seen)
    assert (seen.trust[0] > 0).any()
    note_free(0, 20.0, 30.1, 1.0, 0.0, 25.0, seen)
    assert not (seen.trust[0] > 0).any() and (seen.cost[0] == 1).all()


@pytest.mark.parametrize(
    ("y", "length"),
    [(30.0, 10.0), (30.0, 10.5), (30.4, 25.0), (33.0, 25.0)],
    ids=["met again", "ends behind it", "passes beside it", "passes far off"],
)
def test_a_beam_that_does_not_pass_a_hit_leaves_it(y: float, length: float) -> None:
    seen = begun()
    note_hit(0, 30.0, 30.0, seen)
    for _ in range(5):
        note_free(0, 20.0, y, 1.0, 0.0, length, seen)
    assert (seen.trust[0] > 0).sum() == 1


def test_what_lies_off_the_grid_is_not_remembered() -> None:
    seen = begun()
    for x, y in ((-6.0, 10.0), (200.0, 10.0), (10.0, -1.0), (10.0, 101.0)):
        note_hit(0, x, y, seen)
        note_free(0, x, y, 1.0, 0.0, 30.0, seen)
    assert (seen.cost == 1).all()


def test_a_line_is_clear_that_no_hit_comes_near_to() -> None:
    seen = begun()
    note_hit(0, 30.0, 30.0, seen)
    assert is_clear(0, 20.0, 33.0, 40.0, 33.0, 1, seen)
    assert not is_clear(0, 20.0, 30.0, 40.0, 30.0, 3, seen)
    assert is_clear(0, 20.0, 30.0, 40.0, 30.0, 255, seen)
    assert is_clear(0, 30.0, 30.0, 30.0, 30.0, 1, seen)  # where the robot stands does not matter
