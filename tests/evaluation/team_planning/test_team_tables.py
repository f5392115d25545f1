"""The tables and figures of the team experiments have the numbers of a tiny artificial result, and no others."""

import csv as csv_format
import io
import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from rich.console import Console

from lidarena.base.errors import LidarenaError
from lidarena.evaluation.statistics import bootstrap, share_interval
from lidarena.evaluation.team_planning import team_tables
from lidarena.evaluation.team_planning.team_experiment import METHODS, Outcome, TeamExperimentConfig
from lidarena.evaluation.team_planning.team_tables import (
    compare_planners,
    csv,
    draw,
    markdown,
    movingai_rows,
    optimum_rows,
    print_rows,
    team_rows,
)

NAN = float("nan")


def costs(prioritized: float, coordination: float, search: float) -> dict[str, float]:
    return dict(zip(METHODS, (prioritized, coordination, search), strict=True))


OPTIMUM = [Outcome("office, 60 cm", 2, 1, 10.0, costs(11.0 + k, 10.0, 10.0)) for k in range(6)]
OFFICE_2 = [
    *[Outcome("office", 2, 1, 20.0, costs(22.0, 24.0 + k, 20.0)) for k in range(6)],
    Outcome("office", 2, 0, 20.0),
    Outcome("office", 2, 1, 20.0, costs(22.0, NAN, 20.0)),
    Outcome("office", 2, 1, 20.0, costs(NAN, NAN, 21.0)),
]
OFFICE_3 = [Outcome("office", 3, 1 + k % 3, 30.0, costs(33.0, 36.0, 30.0)) for k in range(6)]
HALL_2 = [Outcome("unstructured", 2, 1, 10.0, costs(15.0, 12.0, 11.0)) for _ in range(6)]
TEAMS = [*OFFICE_2, *OFFICE_3, *HALL_2, Outcome("unstructured", 3, 0, 9.0)]
MOVINGAI = [
    Outcome("maze", 6, 1, 50.0, {"prioritized_search": 50.0 + k if k else NAN}, 0.1 * k) for k in range(6)
]  # fmt: skip


def found(rows: list[team_tables.FigureRow]) -> dict[tuple[str, str, int, str], list[float]]:
    return {(row.figure, row.env, row.robots, row.method): row.values.tolist() for row in rows}


def test_figure_10_is_the_cost_over_the_optimum() -> None:
    values = found(optimum_rows(OPTIMUM))
    assert values["Fig. 10", "office, 60 cm", 2, "prioritized_astar"] == pytest.approx([1.1, 1.2, 1.3, 1.4, 1.5, 1.6])
    assert values["Fig. 10", "office, 60 cm", 2, "coordination"] == [1.0] * 6
    assert len(values) == 3


def test_figure_12_counts_the_conflicts_of_a_robot_of_the_teams_that_have_any() -> None:
    values = found(team_rows(TEAMS))
    assert values["Fig. 12", "office", 2, ""] == [1.0] * 8  # one pair of two robots; the team without is left out
    assert values["Fig. 12", "office", 3, ""] == pytest.approx([2 / 3, 4 / 3, 2.0] * 2)
    assert not any(robots == 3 and env == "unstructured" for _, env, robots, _ in values)


def test_figure_15_compares_only_what_both_methods_of_the_paper_have_solved() -> None:
    values = found(team_rows(TEAMS))
    assert values["Fig. 15", "office", 2, "prioritized_astar"] == pytest.approx([0.1] * 6)
    assert values["Fig. 15", "office", 2, "coordination"] == pytest.approx([0.2, 0.25, 0.3, 0.35, 0.4, 0.45])
    assert values["Fig. 15", "office", 2, "prioritized_search"] == [0.0] * 6
    assert values["Fig. 15", "unstructured", 2, "prioritized_search"] == pytest.approx([0.1] * 6)


def test_figure_16_is_the_share_of_the_teams_with_a_conflict_that_were_solved() -> None:
    rows = [row for row in team_rows(TEAMS) if row.figure == "Fig. 16" and (row.env, row.robots) == ("office", 2)]
    assert [row.interval.mean for row in rows] == pytest.approx([7 / 8, 6 / 8, 1.0])
    assert [row.interval for row in rows] == [share_interval(row.values) for row in rows]


def test_benchmarks_tell_what_was_solved_at_which_cost_and_how_fast() -> None:
    solved, over, seconds = movingai_rows(MOVINGAI)
    assert solved.interval.mean == pytest.approx(5 / 6) and len(over.values) == 6
    assert over.interval.mean == pytest.approx(np.mean([1.02, 1.04, 1.06, 1.08, 1.1]))
    assert seconds.interval.mean == pytest.approx(0.25) and seconds.interval == bootstrap(seconds.values)


def test_the_csv_file_has_every_row_with_its_interval() -> None:
    rows = [*optimum_rows(OPTIMUM), *team_rows(TEAMS), *movingai_rows(MOVINGAI)]
    read = list(csv_format.DictReader(io.StringIO(csv(rows))))
    assert len(read) == len(rows)
    for line, row in zip(read, rows, strict=True):
        assert (line["figure"], line["env"], line["method"]) == (row.figure, row.env, row.method)
        assert (int(line["robots"]), int(line["problems"])) == (row.robots, len(row.values))
        numbers = [float(line[name]) for name in ("mean", "ci_low", "ci_high")]
        assert numbers == pytest.approx(list(row.interval), rel=1e-5, nan_ok=True)
        assert not numbers[1] > numbers[0] and not numbers[2] < numbers[0]


def test_the_markdown_tables_have_a_line_for_each_team_and_a_column_for_each_method() -> None:
    text = markdown([*optimum_rows(OPTIMUM), *team_rows(TEAMS), *movingai_rows(MOVINGAI)])
    sections = {part.splitlines()[0]: part.splitlines()[1:] for part in text.split("## ")[1:]}
    assert list(sections) == [
        "Fig. 10: cost / joint optimum", "Fig. 12: conflicts of a robot", "Fig. 15: increase of the cost",
        "Fig. 16: solved", "MovingAI: solved", "MovingAI: cost / bound", "MovingAI: seconds",
    ]  # fmt: skip
    solved = [line for line in sections["Fig. 16: solved"] if line.startswith("| ")]
    assert solved[0] == "| map | robots | problems | prioritized | coordination | search |"
    assert [line.split(" | ")[:3] for line in solved[1:]] == [
        ["| office", "2", "8"], ["| office", "3", "6"], ["| unstructured", "2", "6"],
    ]  # fmt: skip
    assert "| 87.5% [" in solved[1] and "| 75.0% [" in solved[1]
    assert "| 10.0% [10.0, 10.0] |" in next(line for line in sections["Fig. 15: increase of the cost"] if "2" in line)
    assert "| 1.350 [" in next(line for line in sections["Fig. 10: cost / joint optimum"] if "60 cm" in line)
    assert all(line.count("|") in (5, 7) for lines in sections.values() for line in lines if line.startswith("| "))


def test_the_terminal_shows_what_the_files_say() -> None:
    console = Console(record=True, width=160, quiet=False, file=io.StringIO())
    print_rows(team_rows(OFFICE_2), console)
    text = console.export_text()
    assert "Fig. 15: increase of the cost" in text and "87.5%" in text and "unstructured" not in text


def test_the_figure_shows_the_means_of_the_rows_and_their_intervals(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    kept: list[Any] = []
    monkeypatch.setattr(Figure, "savefig", lambda self, path, **_: kept.append(self))
    rows = [*optimum_rows(OPTIMUM), *team_rows(TEAMS)]
    draw(rows, tmp_path / "figures.png")
    bars, involved, increase, solved = kept[0].axes
    assert [bar.get_height() for bar in bars.patches] == pytest.approx([1.35, 1.0, 1.0])
    assert [label.get_text() for label in bars.get_xticklabels()] == ["prioritized", "coordination", "search"]
    assert bars.get_ylim()[1] >= max(row.interval.high for row in rows[:3])
    curves = {label: container for container, label in zip(increase.containers, labels(increase), strict=True)}
    assert set(curves) == {
        f"{m}, {e}" for m in ("prioritized", "coordination", "search") for e in ("office", "unstructured")
    }
    line = curves["coordination, office"].lines[0]
    assert line.get_xdata().tolist() == [2, 3] and line.get_ydata() == pytest.approx([32.5, 20.0])
    row = next(r for r in rows if (r.figure, r.robots, r.method) == ("Fig. 15", 2, "coordination"))
    segment = curves["coordination, office"].lines[2][0].get_segments()[0]
    assert segment[:, 1] == pytest.approx([100 * row.interval.low, 100 * row.interval.high])
    shares = [container.lines[0].get_ydata().tolist() for container in solved.containers[:3]]
    assert shares == [pytest.approx([87.5, 100.0]), pytest.approx([75.0, 100.0]), pytest.approx([100.0, 100.0])]
    assert labels(involved) == ["office", "unstructured"]


def labels(axes: Any) -> list[str]:
    return [container.get_label() for container in axes.containers]


def test_a_folder_of_results_holds_everything_and_nan_as_null(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> None:
    groups = {"optimum": OPTIMUM[:3], "teams": OFFICE_2, "movingai": MOVINGAI}
    monkeypatch.setattr(team_tables, "run_experiments", lambda config, console: groups)
    config = TeamExperimentConfig(experiment="team_planning", out=str(tmp_path / "out"))
    rows, folder = compare_planners(config)
    assert sorted(path.name for path in folder.iterdir()) == ["figures.png", "results.json", "table.csv", "table.md"]
    document = json.loads((folder / "results.json").read_text(), parse_constant=pytest.fail)
    assert document["config"]["experiment"] == "team_planning" and len(document["rows"]) == len(rows)
    row = next(row for row in document["rows"] if row["env"] == "maze, 6 robots" and len(row["metrics"]) == 1
               and "MovingAI: cost / bound" in row["metrics"])  # fmt: skip
    metric = row["metrics"]["MovingAI: cost / bound"]
    assert metric["values"][0] is None and metric["values"][1:] == pytest.approx([1.02, 1.04, 1.06, 1.08, 1.1])
    few = next(row for row in document["rows"] if row["policy"] == "coordination" and "60 cm" in row["env"])
    assert few["metrics"]["Fig. 10: cost / joint optimum"]["ci_low"] is None  # three are too few for an interval
    (tmp_path / "full").mkdir()
    (tmp_path / "full" / "letter.txt").write_text("mine")
    with pytest.raises(LidarenaError, match="full"):
        compare_planners(config.model_copy(update={"out": str(tmp_path / "full")}))
    assert (tmp_path / "full" / "letter.txt").read_text() == "mine"
