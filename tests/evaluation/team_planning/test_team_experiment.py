"""The experiments with planners: what is drawn, counted and written; and teams in an ordinary comparison."""

import json
import shutil

import numpy as np
import pytest
from rich.console import Console

import evaluate
from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import load_config
from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.episodes import run_episode
from lidarena.evaluation.participants import make_participants
from lidarena.evaluation.team_planning.team_experiment import (
    SHIPPED,
    Outcome,
    TeamExperimentConfig,
    is_team_experiment,
    run_experiments,
)
from lidarena.evaluation.team_planning.team_problems import Problem, count_conflicts, draw_problem, problem_grid, solve
from lidarena.evaluation.team_planning.team_tables import markdown, movingai_rows, optimum_rows, team_rows
from lidarena.world.movingai import load_movingai
from lidarena.world.scenario import load_scenario

CONFIG = "configs/compare/team_planning.yaml"


def test_problems_start_and_end_apart():
    grid = problem_grid("office", 0.2)
    problem = draw_problem(grid, 6, np.random.default_rng(0))
    for cells in (problem.starts, problem.goals):
        gaps = np.hypot(*(cells[:, None] - cells[None]).transpose(2, 0, 1)) + 99 * np.eye(6)
        assert gaps.min() >= 2.0
    with pytest.raises(ConfigError, match="has no places to draw"):
        problem_grid("passing", 0.2)


def test_conflicts_are_counted_by_pairs():
    grid = np.zeros((5, 7), bool)
    starts, goals = np.array([(2, 0), (2, 6), (0, 0)]), np.array([(2, 6), (2, 0), (0, 6)])
    plan = solve(Problem(grid, starts, goals, 0.0, 4), "independent_astar")
    assert count_conflicts(plan, 0.0) == 1


def test_tables_say_what_the_outcomes_hold():
    costs = {"prioritized_astar": 11.0, "coordination": np.nan, "prioritized_search": 10.0}
    outcomes = [Outcome("office", 2, 1, 10.0, costs), Outcome("office", 2, 1, 10.0, costs | {"coordination": 13.0})]
    rows = team_rows([*outcomes, Outcome("office", 2, 0, 9.0)])
    by = {(row.figure, row.method): row.interval.mean for row in rows}
    assert by["Fig. 12", ""] == 1.0
    assert by["Fig. 15", "prioritized_astar"] == pytest.approx(0.1)
    assert by["Fig. 15", "coordination"] == pytest.approx(0.3)
    assert by["Fig. 16", "coordination"] == 0.5
    text = markdown([*rows, *optimum_rows(outcomes), *movingai_rows(outcomes)])
    assert "| office | 2 | 2 |" in text and "50.0%" in text


def test_the_same_configuration_gives_the_same_outcomes():
    config = TeamExperimentConfig(experiment="team_planning", optimum_runs=2, runs=3, workers=1, iterations=3)
    groups = run_experiments(config, Console(quiet=True))
    assert len(groups["optimum"]) == 2 and len(groups["teams"]) == 30 and groups["movingai"] == []
    again = run_experiments(config, Console(quiet=True))
    assert str([o.costs for o in groups["teams"]]) == str([o.costs for o in again["teams"]])  # equal NaNs too


def test_evaluate_writes_tables_and_figures(tmp_path, capsys):
    overrides = ["optimum_runs=2", "runs=8", "iterations=2", "workers=1"]
    overrides += ["movingai.maps=[room-32-32-4]", "movingai.robots=[6]"]
    assert evaluate.main(["--config", CONFIG, "--set", *overrides, "--out", str(tmp_path / "out")]) == 0
    document = json.loads((tmp_path / "out" / "results.json").read_text())
    assert {"config", "versions", "rows"} <= set(document)
    assert (tmp_path / "out" / "figures.png").stat().st_size > 10_000
    assert "Fig. 16" in (tmp_path / "out" / "table.md").read_text()
    assert "Fig. 10" in capsys.readouterr().out
    solved = document["rows"][-3]
    assert solved["env"] == "room-32-32-4, 6 robots" and solved["episodes"] == 10
    assert solved["metrics"]["MovingAI: solved"]["mean"] == 1.0


def test_every_benchmark_of_the_file_is_shipped_with_its_licence():
    config = load_config(CONFIG, TeamExperimentConfig).movingai
    assert config.folder == "shipped" and len(config.maps) == 3 and max(config.robots) <= 200
    for name in config.maps:
        free = load_movingai(SHIPPED / "map" / f"{name}.map")
        for number in range(1, 11):
            path = SHIPPED / "scen-random" / f"{name}-random-{number}.scen"
            assert len(load_scenario(path, free, 200, f"{name}.map").starts) == 200
    assert "Open Data Commons Attribution" in (SHIPPED / "LICENSE.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("missing", ["map/room-32-32-4.map", "scen-random/room-32-32-4-random-7.scen"])
def test_a_missing_movingai_file_is_refused_at_once(missing, tmp_path, capsys):
    shutil.copytree(SHIPPED, tmp_path / "mapf")
    (tmp_path / "mapf" / missing).unlink()
    folder = f"movingai.folder={tmp_path / 'mapf'}"
    assert evaluate.main(["--config", CONFIG, "--set", folder, "--out", str(tmp_path / "o")]) == 2
    told = capsys.readouterr().err
    assert f"there is no {tmp_path / 'mapf' / missing}; movingai.folder must" in told and told.count("\n") == 1


def test_files_of_comparisons_are_told_from_those_of_experiments(tmp_path):
    assert is_team_experiment(CONFIG) and not is_team_experiment("configs/compare/execution.yaml")
    assert not is_team_experiment(tmp_path / "missing.yaml")
    assert load_config(CONFIG, TeamExperimentConfig).runs == 900


def test_a_team_is_measured_like_any_other_environment():
    env, policy = make_participants(
        EnvEntry(id="lidarena/CorridorCentral-v0", keywords={"robots": 2, "places": "random"}),
        PolicyEntry(name="prioritized_search"),
    )
    episode = run_episode(env, policy, 3)
    assert episode.ending == "success" and episode.measures["all_arrived"] == 1.0
    assert 0 < episode.measures["mean_time"] <= episode.measures["makespan"]
    assert episode.measures["path_length"] > 1.0
