"""A whole comparison: from its file to the folder with tables, pictures and videos."""

from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from rich.console import Console

from lidarena.base.yaml_config import as_config
from lidarena.evaluation.comparison_config import ComparisonConfig, PolicyEntry
from lidarena.evaluation.participants import check
from lidarena.evaluation.pictures import Cell, draw_pictures
from lidarena.evaluation.plane import FRONT_FILE, planes_of, pooled, write_front
from lidarena.evaluation.plane_picture import draw_planes
from lidarena.evaluation.progress_report import report_progress
from lidarena.evaluation.report.folder_report import write_comparison_report
from lidarena.evaluation.report.sources import replay_place
from lidarena.evaluation.results import (
    RESULTS_FILE,
    Row,
    check_folder,
    summarise,
    write_results,
    write_results_folder,
)
from lidarena.evaluation.runner import dry_run, run_tasks
from lidarena.evaluation.tables import csv_text, latex_text, markdown_text
from lidarena.evaluation.tasks import list_tasks


@dataclass(frozen=True)
class Comparison:
    """What came of a comparison.

    Attributes:
        rows: One per environment and policy, in the order of the file.
        folder: Where everything was written.
        pictures: The PNG files.
        videos: The video files.
        earlier: Where earlier results of the same name were moved, if there were any.
    """

    rows: list[Row]
    folder: Path
    pictures: list[Path]
    videos: list[Path]
    earlier: Path | None

    @property
    def failures(self) -> list[str]:
        """A sentence for each map of a folder that could not be used."""
        found: dict[tuple[str, str, str], list[str]] = {}
        for row in self.rows:
            for name, sentence in row.failures.items():
                found.setdefault((row.env, name, sentence), []).append(row.policy)
        policies = Counter(row.env for row in self.rows)
        told = []
        for (env, name, sentence), who in found.items():
            whose = "" if len(who) == policies[env] else f", policies {', '.join(who)}"
            told.append(f"environment {env!r}, map {name!r}{whose}: {sentence}")
        return told


def compare(config: ComparisonConfig | Mapping[str, Any] | str | Path, console: Console | None = None) -> Comparison:
    """Run every policy in every environment on the same seeds, and write what came of it.

    The folder appears when everything is in it; earlier results of the same name are kept under another one.

    Args:
        config: What to compare: a YAML file, a dictionary of what one would hold, or what `load_config` made of one.
        console: Where progress is reported; nowhere if None.

    Returns:
        The rows of the tables, and where the files are.

    Raises:
        LidarenaError: Something in the configuration cannot be had; mostly within seconds.
        EpisodeError: An environment or a policy raised.
        WriteError: The place of the results is not writable or full.
    """
    config = as_config(config, ComparisonConfig)
    console = console or Console(quiet=True)
    check_folder(config.folder)
    check(config)
    count = len(config.worlds) * len(config.participants)
    console.print(f"trying {count} pairs of environment and policy", highlight=False)
    dry_run(config)
    found: list[list[Cell]] = []
    rows: list[Row] = []
    drawn: list[Path] = []

    def fill(folder: Path) -> None:
        found.extend(_run(config, folder, console))
        rows.extend(summarise(cell.env.label, cell.policy.title, cell.episodes) for line in found for cell in line)
        write_tables(folder, config, rows)
        planes = planes_of(rows, config.participants)
        whole = pooled(planes, _reference(config.participants))
        if planes:
            write_front(folder / FRONT_FILE, planes, whole)
        if config.pictures:
            files = draw_planes(planes, whole, folder / "pictures") + draw_pictures(found, folder / "pictures")
            drawn.extend(path.relative_to(folder) for path in files)
        if config.report:
            _write_replays(folder, found)
            write_comparison_report(folder, config.folder.name)

    earlier = write_results_folder(config.folder, fill)
    videos = sorted((config.folder / "videos").rglob("*.*"))
    return Comparison(rows, config.folder, [config.folder / path for path in drawn], videos, earlier)


def write_tables(folder: Path, config: ComparisonConfig, rows: Sequence[Row]) -> None:
    """Write `results.json` and the tables into an existing folder."""
    write_results(folder / RESULTS_FILE, config, rows)
    for name, text in (
        ("table.csv", csv_text(rows)),
        ("table.md", markdown_text(rows)),
        ("table.tex", latex_text(rows)),
    ):
        (folder / name).write_text(text, encoding="utf-8")


def _write_replays(folder: Path, cells: Sequence[Sequence[Cell]]) -> None:
    for cell in (cell for line in cells for cell in line):
        if cell.episodes[0].replay is not None:
            cell.episodes[0].replay.write(folder / replay_place(cell.env.label, cell.policy.title))


def _reference(policies: Sequence[PolicyEntry]) -> str:
    """The policy over which the values of all environments are pooled: `frontier`, or else the first."""
    return next((policy.title for policy in policies if policy.name == "frontier"), policies[0].title)


def _run(config: ComparisonConfig, folder: Path, console: Console) -> list[list[Cell]]:
    tasks = list_tasks(config, folder)
    with report_progress(len(tasks), console) as advance:
        told = run_tasks(tasks, config.workers, lambda task: advance(str(task)), config.engine, config.ray_address)
    episodes = iter(told)
    counts = Counter((task.env.label, task.policy.title) for task in tasks)
    return [
        [
            Cell(env, policy, [next(episodes) for _ in range(counts[env.label, policy.title])])
            for policy in config.participants
        ]
        for env in config.worlds
    ]
