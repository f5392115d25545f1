"""Tables and plots of the team experiments: Bennewitz & Burgard's Fig. 10, 12, 15 and 16, and MovingAI."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray
from rich.console import Console
from rich.table import Table

from lidarena.base.files import write_figure
from lidarena.base.versions import library_versions
from lidarena.evaluation.results import RESULTS_FILE, check_folder, write_results_folder
from lidarena.evaluation.statistics import Interval, bootstrap, share_interval
from lidarena.evaluation.team_planning.team_experiment import METHODS, Outcome, TeamExperimentConfig, run_experiments

if TYPE_CHECKING:
    from matplotlib.axes import Axes

TITLES = {"prioritized_astar": "prioritized", "coordination": "coordination", "prioritized_search": "search"}
_COLOURS = {"prioritized_astar": "#0072B2", "coordination": "#D55E00", "prioritized_search": "#009E73"}
_ENVS = {"office": "-", "unstructured": "--"}


@dataclass(frozen=True)
class FigureRow:
    """One line of a table: a figure's value for one method and team.

    Attributes:
        figure: Such as ``"Fig. 15"``.
        env: Floor plan or map.
        robots: Size of the team.
        method: Planner; empty where the value is of no planner.
        quantity: What is measured.
        values: One an experiment.
        interval: Mean and 95% interval.
    """

    figure: str
    env: str
    robots: int
    method: str
    quantity: str
    values: NDArray[np.float64]
    interval: Interval


def compare_planners(config: TeamExperimentConfig, console: Console | None = None) -> tuple[list[FigureRow], Path]:
    """Run the team experiments and write tables and plots.

    Returns:
        The rows, and the folder they were written to.

    Raises:
        LidarenaError: A file is missing, or the folder holds something else.
    """
    folder = Path(config.out)
    check_folder(folder)
    groups = run_experiments(config, console or Console(quiet=True))
    rows = [*optimum_rows(groups["optimum"]), *team_rows(groups["teams"]), *movingai_rows(groups["movingai"])]

    def fill(place: Path) -> None:
        (place / RESULTS_FILE).write_text(json.dumps(_document(config, rows), indent=1) + "\n", encoding="utf-8")
        (place / "table.md").write_text(markdown(rows), encoding="utf-8")
        (place / "table.csv").write_text(csv(rows), encoding="utf-8")
        draw(rows, place / "figures.png")

    write_results_folder(folder, fill)
    return rows, folder


def optimum_rows(outcomes: Sequence[Outcome]) -> list[FigureRow]:
    """Fig. 10: cost over the joint optimum."""
    rows = []
    for method in METHODS:
        ratios = np.array([outcome.costs[method] / outcome.bound for outcome in outcomes])
        rows.append(_row("Fig. 10", outcomes[0], method, "cost / joint optimum", ratios))
    return rows


def team_rows(outcomes: Sequence[Outcome]) -> list[FigureRow]:
    """Fig. 12, 15 and 16, of the teams with a conflict."""
    rows: list[FigureRow] = []
    for _, group in groupby(outcomes, key=lambda outcome: (outcome.env, outcome.robots)):
        conflicting = [outcome for outcome in group if outcome.conflicts]
        if not conflicting:
            continue
        first = conflicting[0]
        involved = np.array([2.0 * outcome.conflicts / outcome.robots for outcome in conflicting])
        rows.append(_row("Fig. 12", first, "", "conflicts of a robot", involved))
        both = [o for o in conflicting if np.isfinite([o.costs[method] for method in METHODS[:2]]).all()]
        for method in METHODS:
            increase = np.array([outcome.costs[method] / outcome.bound - 1.0 for outcome in both])
            rows.append(_row("Fig. 15", first, method, "increase of the cost", increase))
        for method in METHODS:
            solved = np.isfinite([outcome.costs[method] for outcome in conflicting]).astype(float)
            rows.append(_row("Fig. 16", first, method, "solved", solved, share_interval))
    return rows


def movingai_rows(outcomes: Sequence[Outcome]) -> list[FigureRow]:
    """Solved, cost over the bound, and time, of each map and team size."""
    rows: list[FigureRow] = []
    for _, group in groupby(outcomes, key=lambda outcome: (outcome.env, outcome.robots)):
        all_of = list(group)
        costs = np.array([outcome.costs["prioritized_search"] for outcome in all_of])
        bounds = np.array([outcome.bound for outcome in all_of])
        seconds = np.array([outcome.seconds for outcome in all_of])
        name = "prioritized_search"
        rows.append(_row("MovingAI", all_of[0], name, "solved", np.isfinite(costs).astype(float), share_interval))
        rows.append(_row("MovingAI", all_of[0], name, "cost / bound", costs / bounds))
        rows.append(_row("MovingAI", all_of[0], name, "seconds", seconds))
    return rows


def _row(
    figure: str,
    outcome: Outcome,
    method: str,
    quantity: str,
    values: NDArray[np.float64],
    interval: Callable[[NDArray[np.float64]], Interval] = bootstrap,
) -> FigureRow:
    return FigureRow(figure, outcome.env, outcome.robots, method, quantity, values, interval(values))


def markdown(rows: Sequence[FigureRow]) -> str:
    """Return the tables as Markdown: one a figure and quantity, a line a team, a column a method."""
    parts = []
    for (figure, quantity), group in groupby(_sorted(rows), key=lambda row: (row.figure, row.quantity)):
        own = list(group)
        methods = list(dict.fromkeys(row.method for row in own))
        lines = [f"## {figure}: {quantity}\n"]
        lines.append("| map | robots | problems | " + " | ".join(TITLES.get(m, "mean") for m in methods) + " |")
        lines.append("|---" * (3 + len(methods)) + "|")
        for (env, robots), team in groupby(own, key=lambda row: (row.env, row.robots)):
            cells = list(team)
            texts = " | ".join(_text(row) for row in cells)
            lines.append(f"| {env} | {robots} | {len(cells[0].values)} | {texts} |")
        parts.append("\n".join(lines) + "\n")
    return "\n".join(
        [*parts, "Mean and 95% interval (BCa bootstrap; Wilson's for shares). Every plan was validated.\n"]
    )


def csv(rows: Sequence[FigureRow]) -> str:
    """Return one line for each row."""
    lines = ["figure,env,robots,method,quantity,problems,mean,ci_low,ci_high"]
    for row in rows:
        numbers = ",".join(f"{number:.6g}" for number in row.interval)
        lines.append(f'{row.figure},"{row.env}",{row.robots},{row.method},{row.quantity},{len(row.values)},{numbers}')
    return "\n".join(lines) + "\n"


def print_rows(rows: Sequence[FigureRow], console: Console) -> None:
    """Print the tables to a terminal."""
    for (figure, quantity), group in groupby(_sorted(rows), key=lambda row: (row.figure, row.quantity)):
        own = list(group)
        methods = list(dict.fromkeys(row.method for row in own))
        table = Table("map", "robots", "problems", *(TITLES.get(method, "mean") for method in methods))
        table.title, table.title_justify = f"{figure}: {quantity}", "left"
        for (env, robots), team in groupby(own, key=lambda row: (row.env, row.robots)):
            cells = list(team)
            table.add_row(env, str(robots), str(len(cells[0].values)), *(_text(row) for row in cells))
        console.print(table)


def draw(rows: Sequence[FigureRow], path: Path) -> None:
    """Draw Fig. 10, 12, 15 and 16 in one picture."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(10.0, 7.2), dpi=120, layout="constrained")
    panels = figure.subplots(2, 2).ravel()
    _draw_optimum(panels[0], [row for row in rows if row.figure == "Fig. 10"])
    for axes, name, title, scale in (
        (panels[1], "Fig. 12", "Conflicts of each robot (Fig. 12)", 1.0),
        (panels[2], "Fig. 15", "Increase of the move cost, % (Fig. 15)", 100.0),
        (panels[3], "Fig. 16", "Problems solved, % (Fig. 16)", 100.0),
    ):
        _draw_teams(axes, [row for row in rows if row.figure == name], scale)
        axes.set_title(title, fontsize=10)
        axes.set_xlabel("robots")
    panels[2].legend(fontsize=8, frameon=False)
    write_figure(path, figure)


def _draw_optimum(axes: "Axes", rows: Sequence[FigureRow]) -> None:
    for place, row in enumerate(rows):
        mean, low, high = row.interval
        axes.bar(place, mean, color=_COLOURS[row.method])
        axes.errorbar(place, mean, [[mean - low], [high - mean]], color="black", capsize=4)
        axes.annotate(f"{mean:.3f}", (place, high), ha="center", xytext=(0, 3), textcoords="offset points", fontsize=9)
    axes.set_xticks(range(len(rows)), [TITLES[row.method] for row in rows])
    axes.set_ylim(0.98, max([1.1, *(row.interval.high + 0.02 for row in rows)]))
    axes.axhline(1.0, color="grey", linewidth=0.8)
    axes.set_title("Move cost over the joint optimum, two robots (Fig. 10)", fontsize=10)


def _draw_teams(axes: "Axes", rows: Sequence[FigureRow], scale: float) -> None:
    for (env, method), group in groupby(
        sorted(rows, key=lambda row: (row.env, METHODS.index(row.method) if row.method else 0)),
        key=lambda row: (row.env, row.method),
    ):
        own = list(group)
        means = scale * np.array([row.interval.mean for row in own])
        bounds = scale * np.array([row.interval[1:] for row in own]).T
        label = f"{TITLES[method]}, {env}" if method else env
        style: dict[str, Any] = {"color": _COLOURS.get(method, "#555555"), "linestyle": _ENVS.get(env, "-")}
        axes.errorbar([row.robots for row in own], means, np.abs(bounds - means), marker="o", markersize=4, capsize=3,
                      label=label, **style)  # fmt: skip
    axes.set_xticks(sorted({row.robots for row in rows}))
    axes.grid(alpha=0.3)
    if rows and not rows[0].method:
        axes.legend(fontsize=8, frameon=False)


def _sorted(rows: Sequence[FigureRow]) -> list[FigureRow]:
    """By figure and quantity, the rest as it came."""
    order = {key: place for place, key in enumerate(dict.fromkeys((row.figure, row.quantity) for row in rows))}
    return sorted(rows, key=lambda row: order[row.figure, row.quantity])


def _text(row: FigureRow) -> str:
    mean, low, high = row.interval
    if row.quantity in ("solved", "increase of the cost"):
        return f"{100 * mean:.1f}% [{100 * low:.1f}, {100 * high:.1f}]"
    return f"{mean:.3f} [{low:.3f}, {high:.3f}]"


def _document(config: TeamExperimentConfig, rows: Sequence[FigureRow]) -> dict[str, Any]:
    """The same form as a comparison's ``results.json``: a row an environment and policy."""
    return {
        "config": config.model_dump(mode="json"),
        "versions": library_versions(),
        "rows": [
            {
                "env": f"{row.env}, {row.robots} robots",
                "policy": row.method or "independent_astar",
                "episodes": len(row.values),
                "metrics": {
                    f"{row.figure}: {row.quantity}": {
                        "mean": _number(row.interval.mean),
                        "ci_low": _number(row.interval.low),
                        "ci_high": _number(row.interval.high),
                        "values": [_number(value) for value in row.values],
                    }
                },
            }
            for row in rows
        ],
    }


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None
