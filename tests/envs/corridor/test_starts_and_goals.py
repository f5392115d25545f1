"""Where teams start and go: apart, off the walls, and so that a planner gets everybody there."""

import math
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, MapError, ScenarioError, TeamError
from lidarena.envs.corridor.options import CorridorOptions
from lidarena.envs.corridor.starts_and_goals import CELL, StartGoalSampler
from lidarena.planning import plan_team, validate_plan
from lidarena.world.load import load_floorplan
from lidarena.world.team_drawings import team_places
from tests.envs.corridor.corridor_worlds import gaps

Floats = NDArray[np.float64]


def places(**keywords: object) -> StartGoalSampler:
    options = CorridorOptions.checked(keywords)
    return StartGoalSampler(options, load_floorplan(options.map))


def draw(made: StartGoalSampler, seed: int) -> tuple[Floats, Floats]:
    return made.draw(np.random.default_rng(seed))


@pytest.mark.parametrize(
    ("name", "robots", "radius"),
    [("office", 6, 0.105), ("unstructured", 10, 0.25), ("passing", 2, 0.105), ("blocked", 8, 0.105), ("env1", 3, 0.15)],
)
def test_random_places_are_apart_off_the_walls_and_solvable(name: str, robots: int, radius: float) -> None:
    made, plan = places(map=name, robots=robots, robot={"radius": radius}, places="random"), load_floorplan(name)
    for seed in range(2):
        starts, goals = draw(made, seed)
        assert starts.shape == goals.shape == (robots, 2)
        for points in (starts, goals):
            assert gaps(points).min() >= 2 * max(0.2, radius + 0.05) - 1e-6
            assert plan.clearance(points).min() >= radius
        assert np.hypot(*(starts - goals).T).min() >= CELL - 1e-9
        cells = made.grid.cells(starts), made.grid.cells(goals)
        disc = made.grid.in_cells(max(0.2, radius + 0.05))
        found = plan_team(made.grid.blocked, *cells, radius=disc, time_limit=math.inf, iterations=60)
        assert found.solved and validate_plan(found, made.grid.blocked, *cells, radius=disc) == []


@pytest.mark.parametrize("name", ["office", "unstructured"])
def test_predefined_places_are_the_maps_own_and_every_one_is_used(name: str) -> None:
    made, known = places(map=name, robots=6), team_places(name)
    assert known is not None
    used = np.zeros((2, len(known.starts)), np.bool_)
    for seed in range(40):
        for side, points in enumerate(draw(made, seed)):
            away = np.hypot(*(points[:, None] - known.starts[None]).transpose(2, 0, 1))
            assert away.min(axis=1).max() < CELL  # on the cell that it lies in
            assert len(set(away.argmin(axis=1))) == 6
            used[side, away.argmin(axis=1)] = True
    assert used.all()


def test_where_the_map_says_who_goes_where_every_episode_is_the_same() -> None:
    made, known = places(map="blocked", robots=4), team_places("blocked")
    assert known is not None
    for seed in range(3):
        starts, goals = draw(made, seed)
        assert np.array_equal(starts, known.starts[:4]) and np.array_equal(goals, known.goals[:4])


def test_given_places_are_taken_as_they_are() -> None:
    made = places(robots=2, starts=[(5.013, 7.5), (9, 7.1)], goals=[(6, 7), (2.2, 7.77)])
    starts, goals = draw(made, 0)
    assert starts.tolist() == [[5.013, 7.5], [9.0, 7.1]] and goals.tolist() == [[6.0, 7.0], [2.2, 7.77]]


def test_equal_generators_draw_equal_places_whatever_was_drawn_before() -> None:
    one, other = places(places="random", robots=5), places(places="random", robots=5)
    for seed in range(4):
        draw(one, seed)
    for mine, yours in zip(draw(one, 9), draw(other, 9), strict=True):
        assert np.array_equal(mine, yours)


def test_random_places_keep_to_the_largest_part_of_the_map(tmp_path: Path) -> None:
    rows = ["....@" + 12 * "."] * 6
    (tmp_path / "parts.map").write_text("type octile\nheight 6\nwidth 17\nmap\n" + "\n".join(rows) + "\n")
    made = places(map=str(tmp_path / "parts.map"), robots=3, places="random")
    for seed in range(10):
        for points in draw(made, seed):
            assert points[:, 0].min() > 5.0


def test_a_scenarios_places_are_in_metres_of_its_map(tmp_path: Path) -> None:
    (tmp_path / "hall.map").write_text("type octile\nheight 3\nwidth 4\nmap\n....\n....\n@...\n")
    (tmp_path / "hall.scen").write_text("version 1\n0\thall.map\t4\t3\t0\t0\t3\t2\t4.2\n")
    made = places(map=f"{tmp_path / 'hall.map'}?cell=0.5", robots=1, places=str(tmp_path / "hall.scen"))
    starts, goals = draw(made, 0)
    assert starts.tolist() == [[0.25, 1.25]] and goals.tolist() == [[1.75, 0.25]]
    with pytest.raises(MapError, match="cel"):
        places(map=f"{tmp_path / 'hall.map'}?cel=0.5", robots=1, places=str(tmp_path / "hall.scen"))
    with pytest.raises(ScenarioError, match="missing"):
        places(map=str(tmp_path / "hall.map"), robots=1, places=str(tmp_path / "missing.scen"))


@pytest.mark.parametrize(
    ("keywords", "error", "sentence"),
    [
        ({"starts": [(5, 7.5)] * 2, "goals": [(5, 7.5), (8, 7.5)]}, TeamError, "robots 0 and 1 share the start"),
        ({"starts": [(5, 7.5), (5.2, 7.5)], "goals": [(9, 7.5), (8, 7.5)]}, TeamError, "starts .* 0.20 m .* 0.21 m"),
        (
            {"starts": [(5, 7.5), (5, 8.55)], "goals": [(9, 7.5), (8, 7.5)]},
            TeamError,
            "start .* of robot 1 is 0",
        ),
        ({"starts": [(5, 7.5), (5, 8.7)], "goals": [(9, 7.5), (8, 7.5)]}, TeamError, "robot 1 is in a wall"),
        ({"starts": [(5, 7.5), (50, 7)], "goals": [(9, 7.5), (8, 7.5)]}, TeamError, "robot 1 cannot reach its goal"),
        ({"starts": [(5, 7.5), "ab"], "goals": [(9, 7.5), (8, 7.5)]}, ConfigError, "starts = .* must be 2 points"),
        ({"starts": [(5, 7.5), (5, math.nan)], "goals": [(9, 7.5), (8, 7.5)]}, ConfigError, "must be 2 points"),
        ({"starts": [(5, 7)] * 2, "goals": [(9, 7)] * 2, "places": "random"}, ConfigError, "in place of places"),
        ({"map": "blocked", "robots": 7}, ConfigError, "has starts for 6; at most 6 robots"),
        ({"map": "unstructured", "robot": {"radius": 0.5}}, TeamError, "radius 0.5 m does not fit at the place"),
        ({"places": "randon"}, ConfigError, "did you mean 'random'"),
    ],
)
def test_places_that_no_team_can_have_are_refused(keywords: dict[str, object], error: type, sentence: str) -> None:
    with pytest.raises(error, match=sentence) as refusal:
        places(**{"robots": 2} | keywords)
    assert "\n" not in str(refusal.value)


def test_a_team_for_which_no_problem_can_be_solved_is_refused_in_the_end(tmp_path: Path) -> None:
    """In a corridor that is one robot wide two robots can change places nowhere; only some draws need no passing."""
    (tmp_path / "tube.map").write_text("type octile\nheight 1\nwidth 3\nmap\n...\n")
    made = places(map=str(tmp_path / "tube.map"), robots=2, places="random", robot={"radius": 0.4})
    starts, goals = draw(made, 0)
    assert (starts[0, 0] < starts[1, 0]) == (goals[0, 0] < goals[1, 0])
    with pytest.raises(TeamError, match="4 robots"):
        draw(places(map=str(tmp_path / "tube.map"), robots=4, places="random", robot={"radius": 0.4}), 0)
