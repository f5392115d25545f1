"""Which arena an episode takes place in, and what is made of it."""

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ConfigError, MapError
from lidarena.envs.arena.options import ArenaOptions
from lidarena.envs.arena.scenarios import FIRST_DRAWN, ScenarioGenerator, vicinity
from lidarena.planning.potential_field.circle_grid import astar_path
from lidarena.world.arenas import Arena, load_arena
from lidarena.world.barn import load_barn
from lidarena.world.floorplan import Floorplan
from lidarena.world.load import load_floorplan
from tests.planning.potential_field.test_potential_field import BARN, needs_barn


def generator(**keywords: Any) -> ScenarioGenerator:
    return ScenarioGenerator(ArenaOptions.checked(keywords))


def draws(found: ScenarioGenerator, count: int = 40, seed: int | None = None) -> list[tuple[int, int]]:
    rng = np.random.default_rng(0)
    return [found.draw(rng, seed) for _ in range(count)]


def test_a_single_arena_is_always_the_same() -> None:
    found = generator(arena="yang")
    assert set(draws(found)) == {(0, 0)}
    assert found.scenario(0, 0) is found.scenario(0, 0)  # it is not made again


def test_lists_are_drawn_from_evenly() -> None:
    counts = np.bincount([entry for entry, _ in draws(generator(arena=["yang", "yang:u", "random:3"]), 600)])
    assert counts.min() > 150 and len(counts) == 3


def test_every_density_is_an_entry_of_its_own() -> None:
    found = generator(arena="random", density=[0.05, 0.2])
    assert {entry for entry, _ in draws(found)} == {0, 1}
    areas = [float((math.pi * found.scenario(entry, 7).arena.circles[:, 2] ** 2).sum()) for entry in (0, 1)]
    assert areas == pytest.approx([500, 2000], abs=80)


def test_families_draw_so_many_numbers_beyond_those_of_seeds() -> None:
    numbers = {number for _, number in draws(generator(arena="u_trap", arenas=6), 200)}
    assert numbers == {FIRST_DRAWN + k for k in range(6)}
    assert min(numbers) >= 2**31


def test_a_seed_counts_through_a_list_and_then_through_its_families() -> None:
    found = generator(arena=["yang", "random", "u_trap"], pick="by_seed")
    rng = np.random.default_rng(0)
    assert [found.draw(rng, seed) for seed in range(7)] == [(0, 0), (1, 0), (2, 0), (0, 0), (1, 1), (2, 1), (0, 0)]
    assert found.scenario(2, 1).arena.name == "u_trap:1"


def test_by_seed_draws_where_no_seed_is_given() -> None:
    assert {number for _, number in draws(generator(arena="random", pick="by_seed"))} != {0}


def test_without_by_seed_a_seed_changes_nothing() -> None:
    found = generator(arena="random")
    assert draws(found, seed=3) == draws(found, seed=4)


def test_unsolvable_arenas_are_passed_over() -> None:
    found = generator(arena="random", density=0.3, solvable=True)
    arena = found.scenario(0, 66).arena
    assert arena.name == f"random:{66 + 2**32}"
    assert len(astar_path(arena.circles, arena.start, arena.goal, arena.robot_radius, arena.bounds))
    assert found.scenario(0, 65).arena.name == "random:65"


def test_points_and_point_robots_get_an_extent_to_scale() -> None:
    scenario = generator(arena="gnron").scenario(0, 0)
    assert scenario.arena.circles[0, 2] == pytest.approx(0.05) and scenario.arena.robot_radius == pytest.approx(0.01)
    yang = generator(arena="yang").scenario(0, 0).arena
    assert yang.circles[:, 2].tolist() == [0.8] * 4 and yang.robot_radius == pytest.approx(0.1)


def test_the_room_is_four_walls_that_face_inwards() -> None:
    plan = generator(arena="yang").scenario(0, 0).plan
    assert plan.edges.shape == (4, 4)
    inside, outside = np.array([[10.0, 10.0], [94.0, 0.0]]), np.array([[-6.0, 10.0], [10.0, 96.0]])
    assert (plan.clearance(inside) > 0).all() and (plan.clearance(outside) < 0).all()


def test_a_floor_plan_keeps_its_own_walls_and_gets_the_start() -> None:
    found = generator(arena="env2", goal=(1.0, 6.5), start=(2.0, 0.8))
    scenario = found.scenario(0, 0)
    assert np.array_equal(scenario.plan.edges, load_floorplan("env2").edges)
    assert scenario.plan.start[:2] == (2.0, 0.8)
    assert scenario.plan.start[2] == pytest.approx(math.atan2(5.7, -1.0))
    assert found.scale == 0.1


def test_own_arenas_and_floor_plans_are_taken_as_they_are() -> None:
    own = Arena("mine", np.array([[5.0, 5.0, 1.0]]), (1.0, 1.0), (9.0, 9.0), (0.0, 0.0, 10.0, 10.0), 0.2)
    assert generator(arena=own).scenario(0, 0).arena.name == "mine"
    assert generator(arena=own, goal=(1.0, 9.0)).scenario(0, 0).arena.goal == (1.0, 9.0)
    plan = load_floorplan("env1")
    assert isinstance(plan, Floorplan) and generator(arena=plan, goal=(2.0, 2.0)).scale == 0.1


@needs_barn
def test_barn_worlds_know_their_optimal_time() -> None:
    found = generator(arena="barn", path=str(BARN), pick="by_seed")
    assert found.draw(np.random.default_rng(0), 4) == (0, 8)
    reference = load_barn(8, str(BARN)).reference
    length = np.hypot(*np.diff(reference, axis=0).T).sum()
    assert found.scenario(0, 8).optimal_time == pytest.approx(length / 2.0)
    assert math.isinf(generator(arena="yang").scenario(0, 0).optimal_time)


@needs_barn
def test_barn_worlds_are_drawn_from_those_of_the_file() -> None:
    numbers = {number for _, number in draws(generator(arena="barn", path=str(BARN)), 300)}
    assert numbers <= set(range(0, 300, 2)) and len(numbers) > 80


@pytest.mark.parametrize(
    ("keywords", "kind", "message"),
    [
        ({"arena": ["yang", "env1"], "goal": (2.0, 2.0)}, ConfigError, r"scales \[0.1, 1.0\]"),
        ({"arena": "barn"}, ConfigError, "give its path"),
        ({"arena": "u_trap", "start": (50.0, -3.0)}, MapError, "start"),
        ({"arena": "random:1", "goal": (0.2, 50.0)}, MapError, "wall of the room"),
    ],
)
def test_what_cannot_be_used_is_refused_when_the_environment_is_made(
    keywords: dict[str, Any], kind: type[Exception], message: str
) -> None:
    with pytest.raises(kind, match=message):
        generator(**keywords)


@pytest.mark.parametrize("circles", [[[50, 50, 3]], np.array([[50, 50, 3]]), np.array([[50.0], [50.0], [3.0]]).T])
def test_an_arena_of_ones_own_has_circles_in_any_form(circles: Any) -> None:
    own = Arena("own", circles, (1.0, 1.0), (80.0, 80.0), (0.0, 0.0, 100.0, 100.0))
    found = generator(arena=own).scenario(0, 0).arena.circles
    assert found.tolist() == [[50.0, 50.0, 3.0]] and found.dtype == np.float64 and found.flags.c_contiguous


@pytest.mark.parametrize("circles", [[[50, 50]], [50, 50, 3], None, [[50, np.nan, 3]], [[50, 50, -3]]])
def test_an_arena_of_ones_own_with_circles_that_are_none_is_refused(circles: Any) -> None:
    own = Arena("own", circles, (1.0, 1.0), (80.0, 80.0), (0.0, 0.0, 100.0, 100.0))
    with pytest.raises(MapError, match=r"circle.* needed"):
        generator(arena=own)


def test_a_torn_barn_file_is_refused(tmp_path: Any) -> None:
    torn = tmp_path / "torn.npz"
    torn.write_bytes(b"PK\x03\x04 and no more")
    for arena in ("barn", "barn:4"):
        with pytest.raises(MapError, match="torn"):
            generator(arena=arena, path=str(torn))


def test_the_vicinity_is_what_lies_within_reach() -> None:
    plan = generator(arena="yang:u").scenario(0, 0).plan
    near = vicinity(plan, 40.0, 40.0, 5.0)
    assert near.circles.tolist() == [[40.0, 45.0, 0.8]] and not len(near.edges)
    corner = vicinity(plan, -4.0, -4.0, 2.0)
    assert len(corner.edges) == 2 and not len(corner.circles)
    assert len(vicinity(plan, 40.0, 40.0, 500.0).circles) == len(plan.circles)


def test_scales_are_powers_of_ten() -> None:
    yang = load_arena("yang")
    assert yang.scale == 1.0 and load_arena("gnron").scale == pytest.approx(0.1)
    assert replace(yang, bounds=(0.0, 0.0, 1000.0, 20.0)).scale == 10.0
    assert load_arena("env3", goal=(1.0, 1.0)).scale == 0.1
