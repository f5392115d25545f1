"""Planned fleets: what they plan is valid and off the walls, and by the clock they drive what they have planned."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

import lidarena
from lidarena.base.errors import ConfigError
from lidarena.baselines.corridor.deviation_model import DeviationModel
from lidarena.baselines.corridor.team_planners import PlannedFleet, wall_costs
from lidarena.envs import corridor_v0
from lidarena.envs.corridor.parallel_env import CorridorEnv
from lidarena.planning import validate_plan
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.planning.team.team_plan import TeamPlan
from lidarena.world.load import load_floorplan
from tests.envs.corridor.corridor_worlds import EXACT

CHEAP: dict[str, Any] = {**EXACT, "lidar": {"beams": 4, "noise": 0.0}}
HEAD_ON: dict[str, Any] = {"robots": 2, "starts": [(5.1, 7.5), (9.1, 7.5)], "goals": [(9.1, 7.5), (5.1, 7.5)]}
SAME_WAY: dict[str, Any] = {"robots": 2, "starts": [(5.1, 7.5), (7.1, 7.1)], "goals": [(9.1, 7.5), (11.1, 7.1)]}


def make(name: str, keywords: dict[str, Any], seed: int = 0, **options: Any) -> tuple[CorridorEnv, PlannedFleet, Any]:
    env = corridor_v0.parallel_env(**keywords | CHEAP)
    policy = lidarena.baselines.make(name, env, **options)
    infos = env.reset(seed=seed)[1]
    policy.reset(seed)
    return env, policy, infos


def run(env: CorridorEnv, policy: PlannedFleet, infos: Any, steps: int = 300) -> None:
    for _ in range(steps):
        if env.agents and not policy.finished:
            infos = env.step(policy.act({}, infos))[4]


def test_cells_cost_more_the_nearer_they_are_to_a_wall() -> None:
    grid = FloorGrid.of(load_floorplan("passing"))
    costs, solid = wall_costs(grid), np.argwhere(grid.blocked)
    for cell in np.argwhere(~grid.blocked)[::7]:
        away = 0.2 * np.hypot(*(np.maximum(np.abs(solid - cell) - 0.5, 0.0)).T).min()
        assert costs[tuple(cell)] == pytest.approx(np.clip(1.0 - away / 0.5, 0.0, 1.0), abs=0.21)
    assert costs.min() == 0.0 and costs.max() <= 1.0
    assert not wall_costs(FloorGrid(np.zeros((5, 5), bool), (0.0, 0.0), 0.2)).any()


@pytest.mark.parametrize("name", ["prioritized_astar", "coordination", "prioritized_search"])
def test_what_is_planned_is_valid_for_discs_with_room_around_the_robots(name: str) -> None:
    env, policy, infos = make(name, {"robots": 4, "robot": {"radius": 0.18}}, seed=4)
    policy.act({}, infos)
    assert policy.radius == pytest.approx(0.23) and policy.plan is not None and policy.plan.solved, policy.message
    grid = policy.fleet.grid(infos)
    core = env.episodes.core
    ends = grid.cells(core.starts[0]), grid.cells(core.goals[0])
    assert validate_plan(policy.plan, grid.blocked, *ends, radius=grid.in_cells(0.23)) == []


SHELVES: dict[str, Any] = {"map": "random:warehouse?area_min=60&area_max=100", "places": "random", "robots": 4}


@pytest.mark.parametrize("seed", [12, 14, 21])
def test_where_shelves_reach_into_free_cells_there_is_room_beside_the_robots(seed: int) -> None:
    """A cell is free if its inner circle is: a disc of 0.2 m in free cells of 0.2 m may be 0.1 m from a wall."""
    env, policy, infos = make("prioritized_search", SHELVES, seed=seed, iterations=20)
    policy.act({}, infos)
    plan, grid = policy.plan, policy.fleet.grid(infos)
    assert plan is not None and plan.solved and grid.away is not None
    least = policy.fleet.radius + min(0.045, policy.radius - policy.fleet.radius)
    for path in plan.paths:
        ends = {tuple(cell) for other in plan.paths for cell in (other[0].tolist(), other[-1].tolist())}
        assert all(grid.away[cell] >= least for cell in map(tuple, path.tolist()) if cell not in ends)
    for _ in range(600):
        if env.agents:
            infos = env.step(policy.act({}, infos))[4]
            assert not any(info["collision"] for info in infos.values())
    assert not env.agents


@pytest.mark.parametrize("name", ["prioritized_astar", "prioritized_search", "independent_astar"])
def test_where_no_way_has_room_in_truth_the_free_cells_are_planned_through(name: str) -> None:
    _, policy, infos = make(name, {"map": "office", **SAME_WAY})
    grid = policy.fleet.grid(infos)
    policy.fleet.grid = lambda infos: replace(grid, away=np.full_like(grid.away, 0.1))  # type: ignore[method-assign]
    policy.act({}, infos)
    assert policy.plan is not None and policy.plan.solved and not policy.finished
    assert policy.radius == 0.2


def test_a_team_that_is_not_solved_in_time_is_planned_without_costs_beside_walls() -> None:
    """Which search safe intervals, many times faster than places at times."""
    _, policy, infos = make("prioritized_search", {"map": "office", **SAME_WAY}, iterations=5)
    plan_from, told = policy.plan_from, []

    def unsolved_with_costs(state: Any, grid: FloorGrid) -> TeamPlan:
        told.append(policy.extras(grid))
        plan = plan_from(state, grid)
        return plan if "cell_costs" not in told[-1] else replace(plan, solved=False)

    policy.plan_from = unsolved_with_costs  # type: ignore[method-assign]
    policy.act({}, infos)
    assert policy.plan is not None and policy.plan.solved and not policy.finished
    assert ["cell_costs" in extras for extras in told] == [True, False]


@pytest.mark.parametrize("name", ["prioritized_astar", "coordination", "joint_astar"])
def test_without_noise_by_the_clock_nobody_collides(name: str) -> None:
    env, policy, infos = make(name, SAME_WAY | {"goals": [(11.1, 7.1), (9.1, 7.7)]})
    run(env, policy, infos)
    assert env.episodes.arrived.all() and not env.episodes.touches.any()
    assert policy.plan is not None and env.episodes.measures()["makespan"][0] < 0.8 * policy.plan.cost


def test_a_longer_step_drives_the_same_plan_more_slowly() -> None:
    times = []
    for step in (0.8, 1.6):
        env, policy, infos = make("independent_astar", SAME_WAY, step=step)
        run(env, policy, infos)
        assert env.episodes.arrived.all()
        times.append(env.episodes.measures()["makespan"][0])
    assert times[1] == pytest.approx(2.0 * times[0], rel=0.1)


def test_the_picture_shows_where_independent_plans_meet_and_coordinated_ones_do_not() -> None:
    for name, meets in (("independent_astar", True), ("joint_astar", False)):
        env, policy, infos = make(name, HEAD_ON | {"render_mode": "rgb_array"})
        infos = env.step(policy.act({}, infos))[4]
        sketch = env.episodes.sketches[0]
        assert sorted(sketch.curves) == [0, 1] and sketch.note == policy.message
        assert bool(len(sketch.conflicts)) == meets
        if meets:
            assert np.hypot(*(sketch.conflicts - (7.1, 7.5)).T).min() < 0.11
            run(env, policy, infos, 60)
            assert (env.episodes.touches > 0).all()


def test_who_has_no_plan_stands_still_and_says_why() -> None:
    _, policy, infos = make("coordination", {"map": "passing", "robots": 2})
    actions = policy.act({}, infos)
    assert policy.finished and policy.message and not any(action.any() for action in actions.values())
    policy.reset(1)
    assert not policy.finished and policy.plan is None and policy.message == ""


@pytest.mark.parametrize("name", ["independent_astar", "prioritized_astar", "coordination", "prioritized_search"])
def test_who_has_no_room_for_a_plan_stands_still_and_says_why(name: str) -> None:
    near = {"map": "office", "robots": 2, "starts": [(1, 1), (1.25, 1)], "goals": [(5, 1.5), (3, 1)]}
    env, policy, infos = make(name, near | {"render_mode": "rgb_array"})
    actions = policy.act({}, infos)
    assert policy.finished and not any(action.any() for action in actions.values())
    assert "radius 0.2 m" in policy.message and "starts of robots 0 and 1 overlap" in policy.message
    assert env.episodes.sketches[0].note == policy.message


def test_the_model_of_straying_keeps_planned_robots_further_apart() -> None:
    model = DeviationModel.fitted(np.random.default_rng(0).uniform(0.0, 0.8, 5000), 28)
    least = []
    for options in ({"deviation": False}, {"model": model}):
        _, policy, infos = make("prioritized_astar", HEAD_ON, **options)
        policy.act({}, infos)
        assert policy.plan is not None and policy.plan.solved
        longest = max(map(len, policy.plan.paths))
        one, other = (np.pad(path, ((0, longest - len(path)), (0, 0)), "edge") for path in policy.plan.paths)
        least.append(np.hypot(*(one - other).T).min())
    assert least[0] >= 2.0 - 1e-9 and least[1] > least[0]


@pytest.mark.parametrize(
    ("name", "options", "sentence"),
    [
        ("coordination", {"planning_radius": 2.1}, r"planning_radius = 2\.1 m .* own 0\.105 to 2 m"),
        ("independent_astar", {"step": 11.0}, r"step = 11\.0 s .* from 0\.1 to 10"),
        ("prioritized_search", {"time_limit": 4000.0}, r"time_limit = 4000\.0 s .* at most 3600"),
        ("prioritized_search", {"time_limit": float("nan")}, "time_limit = nan s"),
        ("prioritized_astar", {"step": float("nan")}, "step = nan s"),
        ("coordination", {"planning_radius": float("nan")}, "planning_radius = nan m"),
    ],
)
def test_options_out_of_range_are_refused_in_one_sentence(name: str, options: dict[str, Any], sentence: str) -> None:
    with pytest.raises(ConfigError, match=sentence) as refusal:
        make(name, HEAD_ON, **options)
    assert "\n" not in str(refusal.value)
