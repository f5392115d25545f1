import numpy as np
import pytest

from lidarena.base.errors import MapError
from lidarena.world.arenas import PRINTED, Arena, edge_circles, load_arena
from lidarena.world.floorplan import Floorplan
from lidarena.world.lidar import Lidar

SPECS = ["yang", "yang:arc", "yang:u", "gnron", "u_trap:3", "random:3", "random:3?density=0.25"]


def gap(arena, point):
    inside = min(point[0] - arena.bounds[0], point[1] - arena.bounds[1])
    inside = min(inside, arena.bounds[2] - point[0], arena.bounds[3] - point[1])
    away = np.hypot(*(arena.circles[:, :2] - point).T) - arena.circles[:, 2]
    return min(away.min(initial=np.inf), inside) - arena.robot_radius


@pytest.mark.parametrize("spec", SPECS)
def test_start_and_goal_are_free_and_the_circles_fit(spec):
    arena = load_arena(spec)
    assert arena.name == spec
    assert gap(arena, arena.start) > 0 and gap(arena, arena.goal) > 0
    assert arena.circles.shape[1] == 3 and (arena.circles[:, 2] >= 0).all()
    again = load_arena(spec)
    np.testing.assert_array_equal(arena.circles, again.circles)
    assert (arena.start, arena.goal) == (again.start, again.goal)


def test_yang_has_the_printed_obstacles_in_a_room_of_100_m():
    arena = load_arena("yang")
    assert [tuple(c) for c in arena.circles[:, :2]] == list(PRINTED)
    assert arena.start == (0.0, 0.0) and arena.goal == (70.0, 70.0)
    assert arena.bounds[2] - arena.bounds[0] == arena.bounds[3] - arena.bounds[1] == 100.0


@pytest.mark.parametrize(("spec", "points", "degrees"), [("yang:arc", 9, 120), ("yang:u", 15, 200)])
def test_the_traps_are_arcs_about_12_12_with_their_back_to_the_goal(spec, points, degrees):
    trap = load_arena(spec).circles[4:, :2] - 12.0
    assert len(trap) == points
    np.testing.assert_allclose(np.hypot(*trap.T), 6.0)
    angles = np.degrees(np.unwrap(np.arctan2(trap[:, 1], trap[:, 0])))
    assert angles[-1] - angles[0] == pytest.approx(degrees) and angles.mean() % 360 == pytest.approx(45)
    spacing = np.hypot(*np.diff(trap, axis=0).T)
    assert (spacing < 2 * load_arena(spec).circles[4, 2]).all()  # nothing slips through


def test_u_traps_are_closed_and_lie_across_the_way():
    for seed in range(30):
        arena = load_arena(f"u_trap:{seed}")
        wall = arena.circles[arena.circles[:, 2] == 0.8]
        assert (np.hypot(*np.diff(wall[:, :2], axis=0).T) < 1.6).all()
        start, ahead = np.array(arena.start), np.subtract(arena.goal, arena.start)
        aside = (wall[:, 0] - start[0]) * ahead[1] - (wall[:, 1] - start[1]) * ahead[0]
        assert aside.min() < 0 < aside.max()


def test_seeds_differ():
    for family in ("u_trap", "random"):
        assert load_arena(f"{family}:1").goal != load_arena(f"{family}:2").goal


@pytest.mark.parametrize("density", [0.0, 0.08, 0.15, 0.3])
def test_density_is_the_covered_share(density):
    arena = load_arena("random:5", density=density)
    covered = np.pi * (arena.circles[:, 2] ** 2).sum() / 1e4
    assert density <= covered < density + 0.009
    assert np.hypot(*np.subtract(arena.goal, arena.start)) >= 60


def test_density_in_the_name_or_as_a_keyword():
    named, keyword = load_arena("random:5?density=0.2"), load_arena("random:5", density=0.2)
    np.testing.assert_array_equal(named.circles, keyword.circles)
    assert len(load_arena("random:5").circles) < len(named.circles)


def test_other_ends():
    arena = load_arena("yang", start=(1, 2), goal=[60, 61.5])
    assert arena.start == (1.0, 2.0) and arena.goal == (60.0, 61.5)
    assert load_arena(arena, start=(3, 3)).start == (3.0, 3.0)


@pytest.mark.parametrize("spec", SPECS)
def test_floor_plans_of_arenas_have_walls_and_circles(spec):
    arena = load_arena(spec)
    plan = arena.floorplan(least_radius=0.2)
    assert len(plan.circles) == len(arena.circles) and (plan.circles[:, 2] >= 0.2).all()
    middle = [(arena.bounds[0] + arena.bounds[2]) / 2, arena.bounds[3]]
    assert plan.clearance(np.array([middle]))[0] == pytest.approx(0.0, abs=1e-9)
    assert plan.start[:2] == arena.start
    assert np.arctan2(*np.subtract(arena.goal, arena.start)[::-1]) == pytest.approx(plan.start[2])
    ranges = Lidar([plan]).cast(np.array([[plan.start]]), np.zeros(1, np.int64))
    assert np.isfinite(ranges).all()


def test_any_floor_plan_becomes_an_arena_with_a_goal():
    arena = load_arena("env1", goal=(1.0, 1.0))
    assert isinstance(arena, Arena) and arena.goal == (1.0, 1.0) and len(arena.circles) > 100
    drawn = Floorplan.from_shapes("hall", (0, 0, 9, 9), [(1, 1, 8, 1)], circles=[(4, 5, 1)], start=(2, 3, 0))
    arena = load_arena(drawn, goal=(8, 8))
    assert arena.circles[0].tolist() == [4, 5, 1] and arena.start == (2, 3)


def test_the_circles_of_an_edge_overlap():
    drawn = Floorplan.from_shapes("hall", (0, 0, 9, 9), [(1, 1, 8, 1)], start=(2, 3, 0))
    circles = edge_circles(drawn, 0.1)
    points = np.column_stack([np.linspace(1, 8, 1000), np.full(1000, 1.05)])
    away = np.hypot(points[:, None, 0] - circles[:, 0], points[:, None, 1] - circles[:, 1])
    assert away.min(axis=1).max() < 0.1


@pytest.mark.parametrize(
    ("spec", "keywords", "says"),
    [
        ("yang:v", {}, "'yang:v' is not known; did you mean 'yang:u'"),
        ("u_trap", {}, "did you mean 'u_trap:SEED'"),
        ("u_trap:x", {}, "seed 'x'; a whole number is needed, as in 'u_trap:7'"),
        ("random:-1", {}, "a whole number"),
        ("random:1?density=0.5", {}, "density 0.5; 0 to 0.3 are allowed"),
        ("random:1", {"density": float("nan")}, "density nan"),
        ("random:1?dens=0.5", {}, "did you mean 'density'"),
        ("random:1?density=0.1", {"density": 0.1}, "gives its density twice"),
        ("yang", {"density": 0.1}, "only 'random:SEED'"),
        ("yang", {"path": "x.npz"}, "only 'barn:INDEX'"),
        ("barn:4", {}, "give its path"),
        ("gnrom", {}, "did you mean 'gnron'"),
        ("env1", {}, "no goal of its own"),
        ("yang", {"goal": (np.nan, 1)}, "goal is .*finite x, y"),
        ("yang", {"start": (1, 2, 3)}, "start is"),
        ("yang", {"start": "here"}, "start is 'here'"),
    ],
)
def test_bad_arenas_are_refused_in_a_sentence(spec, keywords, says):
    with pytest.raises(MapError, match=says) as refusal:
        load_arena(spec, **keywords)
    assert "\n" not in str(refusal.value)
