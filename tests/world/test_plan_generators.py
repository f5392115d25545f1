"""Generators of floor plans: what is taken, what is refused in one sentence, and how large their plans are."""

from functools import partial
from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ConfigError, LidarenaError, MapError
from lidarena.world.floorplan import Floorplan
from lidarena.world.load import generator_of, load_floorplan
from lidarena.world.maze import generate_maze
from lidarena.world.plan_generators import draw_plan, largest_size, plan_generator

NOT_CALLABLE = 7


def room(rng: np.random.Generator, side: float = 4.0, name: str = "room") -> Floorplan:
    walls = [(0, 0, side, 0), (side, 0, side, side), (side, side, 0, side), (0, side, 0, 0)]
    pillar = [(*rng.uniform(1.5, side - 0.5, 2), 0.2)]
    return Floorplan.from_shapes(name, (0, 0, side, side), walls, circles=pillar, start=(0.5, 0.5, 0.0))


def growing(rng: np.random.Generator) -> Floorplan:
    return room(rng, float(rng.uniform(3.0, 6.0)))


class Rooms:
    """A generator that is an object, and says how large its plans can be."""

    size = (6.0, 6.5)

    def __call__(self, rng: np.random.Generator) -> Floorplan:
        return growing(rng)


HERE = "tests.world.test_plan_generators"


@pytest.mark.parametrize("spec", [room, partial(room, side=5.0), Rooms(), Rooms, f"{HERE}:room", f"{HERE}:Rooms"])
def test_functions_objects_classes_and_their_names_draw_plans(spec: Any) -> None:
    generator = generator_of(spec)
    assert generator is not None
    one, same, other = draw_plan(generator, 4), draw_plan(generator, 4), draw_plan(generator, 5)
    assert np.array_equal(one.circles, same.circles) and not np.array_equal(one.circles, other.circles)
    assert np.array_equal(load_floorplan(spec).circles, draw_plan(generator, 0).circles)


@pytest.mark.parametrize("spec", ["env1", "maze:7", "maze:7?width=6", "a/b.map?cell=1:2", "willow.yaml", 3, None])
def test_all_else_is_no_generator(spec: Any) -> None:
    assert generator_of(spec) is None
    assert generator_of(room(np.random.default_rng(0))) is None


@pytest.mark.parametrize(
    ("spec", "kind", "message"),
    [
        (f"{HERE}:rooom", ConfigError, "has no 'rooom'; did you mean 'room'"),
        ("no_such_module:room", ConfigError, "map 'no_such_module:room': there is no module 'no_such_module'"),
        (f"{HERE}:NOT_CALLABLE", MapError, "is of type int; a function that draws a plan is needed"),
        ("maze:seven", MapError, "has seed 'seven'"),
    ],
)
def test_a_name_that_there_is_not_is_refused(spec: str, kind: type[LidarenaError], message: str) -> None:
    with pytest.raises(kind, match=message):
        load_floorplan(spec)


@pytest.mark.parametrize("wrong", [None, 3, "env1", np.zeros((3, 3))])
def test_what_is_no_floor_plan_is_refused(wrong: Any) -> None:
    with pytest.raises(MapError, match=r"generator '<lambda>' returned an object of type .*; a Floorplan is needed"):
        draw_plan(lambda rng: wrong, 0)


def test_a_start_outside_is_refused() -> None:
    plan = room(np.random.default_rng(0))
    outside = Floorplan("odd", plan.edges, plan.circles, plan.bounds, (9.0, 1.0, 0.0))
    with pytest.raises(MapError, match=r"'odd' whose start \(9, 1\) lies outside"):
        draw_plan(lambda rng: outside, 0)


def test_what_a_generator_says_of_itself_is_its_size() -> None:
    assert largest_size(Rooms()) == (6.0, 6.5)
    said = partial(growing)
    said.size = (7, 8)  # type: ignore[attr-defined]
    assert largest_size(said) == (7.0, 8.0)


def test_plans_that_are_all_as_large_need_no_size() -> None:
    assert largest_size(room) == (4.0, 4.0)


def test_plans_of_different_sizes_need_one() -> None:
    with pytest.raises(MapError, match=r"'growing' draws plans of different sizes, .* size = \(width, height\)"):
        largest_size(growing)


@pytest.mark.parametrize("size", [3.0, (1.0,), (0.0, 3.0), (np.nan, 1.0), ("a", "b"), (1e6, 2.0), (1, 2, 3)])
def test_what_is_no_size_is_refused(size: Any) -> None:
    said = partial(growing)
    said.size = size  # type: ignore[attr-defined]
    with pytest.raises(MapError, match=r"has size .* width and height of the largest plan"):
        largest_size(said)


def test_a_generator_that_cannot_be_hashed_is_taken() -> None:
    class Unhashable:
        __hash__ = None  # type: ignore[assignment]

        def __call__(self, rng: np.random.Generator) -> Floorplan:
            return room(rng)

    generator = plan_generator(Unhashable())
    assert generator is not None and largest_size(generator) == (4.0, 4.0)


def test_mazes_of_the_package_make_a_generator() -> None:
    def maze(rng: np.random.Generator) -> Floorplan:
        return generate_maze(int(rng.integers(2**31)), width_m=4.8, height_m=4.8)

    assert draw_plan(maze, 1).edges.tobytes() != draw_plan(maze, 2).edges.tobytes()
    assert largest_size(maze) == pytest.approx((4.8, 4.8), abs=0.5)
