"""The table of a report: a row a policy, sortable, each mean with its interval as a bar on the column's scale."""

import math
from collections.abc import Sequence
from html import escape

from lidarena.evaluation.measures.table_columns import Measure, merged
from lidarena.evaluation.results import Row, best
from lidarena.evaluation.statistics import Interval
from lidarena.evaluation.tables import interval_text

_HINT = {"high": "higher is better", "low": "lower is better", None: "neither direction is better"}


def interval_table(group: Sequence[Row], main: bool = True) -> str:
    """Return one environment's table as HTML.

    Args:
        group: Its rows.
        main: The main measures alone, or all.
    """
    columns = [column for column in merged(row.measured for row in group) if column.main or not main]
    heads = ["<th data-sort='text'>Policy</th>"]
    for column in columns:
        hint = escape(f"{column.hint}. {_HINT[column.better]}".lstrip(". "), quote=True)
        heads.append(f"<th data-sort='number' data-better='{column.better or ''}' title='{hint}'>{_head(column)}</th>")
    scales = {column.name: _scale(group, column) for column in columns}
    winners = {column.name: best(group, column) for column in columns}
    lines = []
    for row in group:
        cells = [_cell(row, column, scales[column.name], row.policy in winners[column.name]) for column in columns]
        lines.append(f"<tr><th scope='row'>{escape(row.policy)}</th>{''.join(cells)}</tr>")
    return f"<table class='results'><thead><tr>{''.join(heads)}</tr></thead><tbody>{''.join(lines)}</tbody></table>"


def _head(column: Measure) -> str:
    arrow = f" <span class='arrow'>{column.arrow}</span>" if column.arrow else ""
    return f"{escape(column.label)}{arrow}"


def _scale(group: Sequence[Row], column: Measure) -> tuple[float, float]:
    """Lowest and highest bound of a column."""
    found = [row.metrics[column.name].interval for row in group if column.name in row.metrics]
    ends = [value for interval in found for value in interval if math.isfinite(value)]
    low, high = min(ends, default=0.0), max(ends, default=1.0)
    if column.unit == "%":
        low, high = min(low, 0.0), max(high, 1.0)
    return (low, high) if high > low else (low - 0.5, high + 0.5)


def _cell(row: Row, column: Measure, scale: tuple[float, float], bold: bool) -> str:
    metric = row.metrics.get(column.name)
    if metric is None or math.isnan(metric.interval.mean):
        return "<td class='absent' data-value=''>–</td>"
    mean, bounds = interval_text(metric.interval, column)
    shown = f"<b>{mean}</b>" if bold else mean
    value = f"<span class='value'>{shown} <small>{bounds}</small></span>"
    return f"<td data-value='{metric.interval.mean!r}'>{value}{_bar(metric.interval, scale)}</td>"


def _bar(interval: Interval, scale: tuple[float, float]) -> str:
    """The interval as a line, the mean as a dot, in percent of the column's scale."""
    low, high = scale
    places = [100 * (value - low) / (high - low) for value in interval]
    line = ""
    if not math.isnan(places[1]):
        line = f"<i class='range' style='left:{places[1]:.1f}%;width:{max(places[2] - places[1], 0.5):.1f}%'></i>"
    return f"<span class='bar'>{line}<i class='mean' style='left:{places[0]:.1f}%'></i></span>"
