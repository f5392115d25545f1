import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.base.errors import MapError
from lidarena.world.floorplan import Floorplan
from lidarena.world.maze import generate_maze
from tests.world.corridors import count_parts, free_space, share_swept_by_disc


def dead_ends(plan: Floorplan, columns: int, rows: int) -> int:
    """How many places of a maze have three walls, found by probing the middles of their sides."""
    _, _, width, height = plan.bounds
    pitch_x, pitch_y = (width - 0.1) / columns, (height - 0.1) / rows
    places = [(0.05 + (c + 0.5) * pitch_x, 0.05 + (r + 0.5) * pitch_y) for r in range(rows) for c in range(columns)]
    steps = np.array([[pitch_x, 0], [-pitch_x, 0], [0, pitch_y], [0, -pitch_y]]) / 2
    probes = np.array(places)[:, None, :] + steps[None]
    solid = plan.clearance(probes.reshape(-1, 2)).reshape(-1, 4) < 0
    return int((solid.sum(axis=1) == 3).sum())


@settings(max_examples=25, deadline=None)
@given(
    seed=st.integers(0, 2**63 - 1),
    width=st.floats(3.0, 9.0),
    height=st.floats(3.0, 9.0),
    corridor=st.floats(0.8, 1.2),
    loops=st.floats(0.0, 1.0),
    keep=st.floats(0.0, 1.0),
    thickness=st.floats(0.05, 0.2),
)
def test_every_maze_is_connected_and_wide_enough(
    seed: int, width: float, height: float, corridor: float, loops: float, keep: float, thickness: float
) -> None:
    plan = generate_maze(seed, width, height, corridor, loops, keep, thickness)
    space = free_space(plan)
    assert plan.bounds == (0.0, 0.0, width, height)
    assert count_parts(space.free) == 1
    fits = space.distance >= corridor / 2 - 0.02
    assert count_parts(fits) == 1
    assert fits[space.cell(*plan.start[:2])]
    assert share_swept_by_disc(space, corridor / 2 - 0.02) > 0.9


@given(seed=st.integers(0, 10_000))
def test_the_start_faces_an_opening(seed: int) -> None:
    plan = generate_maze(seed)
    x, y, theta = plan.start
    ahead = np.array([[x + d * math.cos(theta), y + d * math.sin(theta)] for d in np.linspace(0, 1.1, 12)])
    assert (plan.clearance(ahead) > 0.4).all()


def test_the_same_seed_gives_the_same_maze_and_another_seed_another() -> None:
    first, again, other = generate_maze(5), generate_maze(5), generate_maze(6)
    assert np.array_equal(first.edges, again.edges)
    assert first.start == again.start
    assert not np.array_equal(first.edges, other.edges)


def test_the_default_has_seven_by_five_corridors_of_a_metre() -> None:
    plan = generate_maze(0)
    assert plan.bounds == (0.0, 0.0, 8.0, 6.0)
    assert plan.name == "maze:0"
    outer = plan.clearance(np.array([[0.05, 3.0], [7.95, 3.0], [4.0, 0.05], [4.0, 5.95]]))
    assert np.allclose(outer, -0.05)


@pytest.mark.parametrize("seed", range(5))
def test_without_loops_a_maze_is_a_tree(seed: int) -> None:
    plan = generate_maze(seed, loops=0.0, dead_ends=1.0)
    walls = count_parts(~free_space(plan).free[25:-25, 25:-25])  # all walls hang on the outer one
    assert walls == 1
    assert dead_ends(plan, 7, 5) >= 2


@pytest.mark.parametrize("seed", range(5))
def test_dead_ends_are_kept_in_the_share_that_was_asked_for(seed: int) -> None:
    every, half, none = (dead_ends(generate_maze(seed, 12, 9, dead_ends=keep), 10, 8) for keep in (1.0, 0.5, 0.0))
    assert every > 2
    assert half == round(every / 2)
    assert none == 0


def test_all_loops_leave_an_empty_hall() -> None:
    plan = generate_maze(3, loops=1.0)
    assert len(plan.edges) == 4 * 4
    assert plan.clearance(np.array([[4.0, 3.0]])) == pytest.approx(2.9)


def test_walls_in_line_are_merged() -> None:
    lengths = np.hypot(*(generate_maze(1, loops=0.0).edges @ np.array([[-1, 0], [0, -1], [1, 0], [0, 1]])).T)
    assert lengths.max() == pytest.approx(8.0)
    assert len(lengths) < 4 * 40


@pytest.mark.parametrize(
    ("arguments", "named"),
    [
        ({"seed": -1}, "seed -1"),
        ({"seed": 2**63}, "seed"),
        ({"seed": 1.5}, "seed 1.5"),
        ({"seed": True}, "seed True"),
        ({"width_m": 2.2}, "too small; at least 2.3 m"),
        ({"height_m": 1.0}, "too small"),
        ({"width_m": float("nan")}, "width nan"),
        ({"height_m": 101.0}, "height 101 m; 0 to 100 m"),
        ({"width_m": -8.0}, "width -8"),
        ({"corridor": 0.79}, "corridor 0.79 m; 0.8 to 5 m"),
        ({"corridor": 6.0}, "corridor 6 m"),
        ({"loops": 1.1}, "loops 1.1; 0 to 1"),
        ({"loops": -0.1}, "loops -0.1"),
        ({"dead_ends": 2.0}, "dead_ends 2"),
        ({"thickness": 0.01}, "thickness 0.01 m; 0.05 to 0.5 m"),
        ({"thickness": 1.0}, "thickness 1 m"),
    ],
)
def test_bad_arguments_are_refused(arguments: dict[str, float], named: str) -> None:
    with pytest.raises(MapError) as caught:
        generate_maze(**{"seed": 0, **arguments})  # type: ignore[arg-type]
    assert named in str(caught.value)


def test_the_smallest_maze_of_two_by_two() -> None:
    plan = generate_maze(0, 2.3, 2.3)
    assert count_parts(free_space(plan).free) == 1
