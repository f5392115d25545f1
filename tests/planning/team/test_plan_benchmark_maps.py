"""The MovingAI benchmarks and the built-in floor plans for teams, each with the bar that it must reach."""

import numpy as np
import pytest

from lidarena.planning import plan_team, validate_plan
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.world.load import load_floorplan
from lidarena.world.movingai import load_movingai
from lidarena.world.scenario import load_scenario
from lidarena.world.team_drawings import team_places
from tests.world.shared_data import DATA, needs_data


@needs_data
@pytest.mark.parametrize(
    ("name", "robots", "numbers", "bar"),
    [
        ("room-32-32-4", 20, (1, 2, 3), 1.03),
        ("room-32-32-4", 50, (7,), 1.2),
        ("random-32-32-20", 50, (7,), 1.1),
        ("warehouse-10-20-10-2-1", 20, (1,), 1.01),
    ],
)
def test_movingai_scenarios_are_solved(name, robots, numbers, bar):
    free = load_movingai(DATA / "mapf" / "map" / f"{name}.map")
    for i in numbers:
        path = DATA / "mapf" / "scen-random" / f"{name}-random-{i}.scen"
        scenario = load_scenario(path, free, robots, f"{name}.map")
        found = plan_team(~free, *scenario, connectivity=4, time_limit=np.inf, iterations=150)
        assert validate_plan(found, ~free, *scenario, connectivity=4) == []
        assert found.cost <= bar * found.lower_bound


def on_floor(name, method, robots=None, **options):
    grid, places = FloorGrid.of(load_floorplan(name)), team_places(name)
    problem = grid.blocked, grid.cells(places.starts)[:robots], grid.cells(places.goals)[:robots]
    found = plan_team(*problem, method, radius=grid.in_cells(0.2), **options)
    assert not found.solved or validate_plan(found, *problem, radius=grid.in_cells(0.2)) == []
    return found


def test_one_robot_dodges_into_the_doorway():
    """Fig. 9: coordination finds no solution, the prioritized planner sends one robot off its path."""
    assert not on_floor("passing", "coordination").solved
    found = on_floor("passing", "prioritized_astar")
    assert found.solved
    middle = FloorGrid.of(load_floorplan("passing")).cells([(5.2, 1.1)])[0]
    assert (found.paths[1][:, 0] >= middle[0] - 1).any()
    assert on_floor("passing", "joint_astar").optimal


@pytest.mark.parametrize("robots", [3, 4, 5, 6])  # 4 drive where nobody says how many
def test_the_paper_s_order_of_priority_fails_and_promotion_helps(robots):
    """Fig. 17: robots 0 and 1 block the way out of robot 2."""
    found = on_floor("blocked", "prioritized_astar", robots)
    assert not found.solved and found.message.startswith("Robot 2") and set(found.order[:2]) == {0, 1}
    promoted = on_floor("blocked", "prioritized_search", robots, time_limit=np.inf, iterations=60)
    assert promoted.solved and promoted.order.index(2) < promoted.order.index(0)
