"""What a comparison found: one row per environment and policy, `results.json`, and the folder that holds it all."""

import json
import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lidarena.base.errors import ConfigError
from lidarena.base.files import check_writable, replace_folder
from lidarena.base.versions import library_versions
from lidarena.evaluation.comparison_config import ComparisonConfig
from lidarena.evaluation.episodes import Episode
from lidarena.evaluation.measures.table_columns import Measure
from lidarena.evaluation.statistics import (
    Interval,
    bootstrap,
    paired_difference,
    paired_share_difference,
    share_interval,
)

RESULTS_FILE = "results.json"


@dataclass(frozen=True)
class Metric:
    """A measure over the episodes of a row: mean, 95% interval and the values in the order of the seeds."""

    interval: Interval
    values: tuple[float, ...]


@dataclass(frozen=True)
class Row:
    """An environment and a policy.

    Attributes:
        env: What tables call the environment.
        policy: What tables call the policy.
        episodes: Number of them.
        columns: Of the environment's family, in the order of the table.
        metrics: By the columns' names, without those that no episode reported.
        maps: Of a folder of maps, in the order of the values; none otherwise.
        failures: Why a map of a folder could not be used, by its name; its values are NaN.
    """

    env: str
    policy: str
    episodes: int
    columns: tuple[Measure, ...]
    metrics: dict[str, Metric]
    maps: tuple[str, ...] = ()
    failures: Mapping[str, str] = field(default_factory=dict)

    @property
    def measured(self) -> list[Measure]:
        """The columns that hold something."""
        return [measure for measure in self.columns if measure.name in self.metrics]


def summarise(env: str, policy: str, episodes: Sequence[Episode]) -> Row:
    """Return the row of one environment and policy.

    Args:
        env: What tables call the environment.
        policy: What tables call the policy.
        episodes: In the order of the seeds.

    Returns:
        The row, without the measures that no episode reported.
    """
    metrics = {}
    columns = next((episode.columns for episode in episodes if episode.error is None), ())
    for measure in columns:
        values = tuple(episode.measures.get(measure.name, math.nan) for episode in episodes)
        if not all(math.isnan(value) for value in values):
            interval = share_interval(values) if measure.share else bootstrap(values)
            metrics[measure.name] = Metric(interval, values)
    maps = tuple(episode.map for episode in episodes if episode.map is not None)
    failures = {episode.map: episode.error for episode in episodes if episode.map and episode.error is not None}
    return Row(env, policy, len(episodes), columns, metrics, maps, failures)


def contenders(rows: Sequence[Row], measure: Measure) -> list[Row]:
    """Return the rows of one environment among which a measure may be compared.

    Where a measure ``needs`` another, those are the rows whose mean of that one cannot be told from the best: a policy
    that crashes at once drives the shortest path, and that is no merit.
    """
    measured = [row for row in rows if measure.name in row.metrics]
    needed = next((column for row in measured for column in row.columns if column.name == measure.needs), None)
    if needed is None or not all(needed.name in row.metrics for row in measured):
        return measured
    return level_with_best(measured, needed)


def best(rows: Sequence[Row], measure: Measure) -> set[str]:
    """Return the policies of one environment that are best in a measure, for bold type.

    The best mean, and those whose paired difference from it has an interval that contains zero. Empty where no
    direction is better, or where all policies are level or only one was measured.
    """
    if measure.better is None:
        return set()
    level = level_with_best(contenders(rows, measure), measure)
    return {row.policy for row in level} if len(level) < len(rows) else set()


def level_with_best(rows: Sequence[Row], measure: Measure) -> list[Row]:
    """Return the row with the best mean and those that cannot be told from it on the same seeds."""
    if not rows:
        return []
    sign = -1.0 if measure.better == "low" else 1.0
    winner = max(rows, key=lambda row: sign * row.metrics[measure.name].interval.mean)
    return [row for row in rows if row is winner or _is_level(difference(row, winner, measure))]


def difference(row: Row, other: Row, measure: Measure) -> Interval:
    """Return the paired difference of two rows of one environment in a measure."""
    paired = paired_share_difference if measure.share else paired_difference
    return paired(row.metrics[measure.name].values, other.metrics[measure.name].values)


def _is_level(difference: Interval) -> bool:
    return math.isnan(difference.low) or difference.low <= 0 <= difference.high


def results_document(config: ComparisonConfig, rows: Sequence[Row]) -> dict[str, Any]:
    """Return what `results.json` holds: ``config``, ``versions`` and ``rows`` (the schema is in DESIGN.md).

    Rows of a folder of maps have ``maps`` as well, their names in the order of the values, and ``failures``, why some
    could not be used.
    """
    return {
        "config": config.model_dump(mode="json"),
        "versions": library_versions(),
        "rows": [_row_document(row) for row in rows],
    }


def _row_document(row: Row) -> dict[str, Any]:
    metrics = {name: _metric_document(metric) for name, metric in row.metrics.items()}
    document = {"env": row.env, "policy": row.policy, "episodes": row.episodes, "metrics": metrics}
    return document | ({"maps": list(row.maps), "failures": dict(row.failures)} if row.maps else {})


def write_results(path: Path, config: ComparisonConfig, rows: Sequence[Row]) -> None:
    """Write `results.json`; a number that does not exist is null, since JSON knows no NaN."""
    text = json.dumps(results_document(config, rows), indent=1, allow_nan=False, ensure_ascii=False)
    path.write_text(text + "\n", encoding="utf-8")


def check_folder(folder: Path) -> None:
    """Refuse a folder that holds something else than results, before hours of work go towards it.

    Raises:
        ConfigError: It is a file, or a folder with other things in it.
        WriteError: Nothing can be written there.
    """
    check_writable(folder)
    if folder.is_dir() and ((folder / RESULTS_FILE).is_file() or not any(folder.iterdir())):
        return
    if folder.exists():
        what = f"a folder without {RESULTS_FILE}" if folder.is_dir() else "a file"
        raise ConfigError(f"{str(folder)!r} is {what}; choose another place for the results with --out DIR")


def write_results_folder(folder: Path, fill: Callable[[Path], None]) -> Path | None:
    """Make the folder of a comparison whole or not at all, and keep earlier results.

    Args:
        folder: Where the results go.
        fill: Called with an empty temporary folder; writes everything into it.

    Returns:
        Where earlier results of that name were moved (``NAME.1``, ``NAME.2``, …); None if there were none.

    Raises:
        ConfigError: See `check_folder`.
        WriteError: The place is not writable or full.
    """
    check_folder(folder)
    earlier = replace_folder(folder, fill)
    return folder.with_name(earlier.name) if earlier and folder.name else earlier


def _metric_document(metric: Metric) -> dict[str, Any]:
    mean, low, high = (_or_null(value) for value in metric.interval)
    return {"mean": mean, "ci_low": low, "ci_high": high, "values": [_or_null(value) for value in metric.values]}


def _or_null(value: float) -> float | None:
    return float(value) if math.isfinite(value) else None
