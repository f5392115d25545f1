"""The tables of a comparison: CSV for programs, Markdown and LaTeX for manuscripts, rich text for the terminal."""

import csv
import io
import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import groupby

from rich.box import SIMPLE_HEAD
from rich.console import Console, Group
from rich.table import Table
from rich.text import Text

from lidarena.evaluation.measures.table_columns import Measure, merged
from lidarena.evaluation.results import Row, best, contenders, difference
from lidarena.evaluation.statistics import LEAST_SAMPLES, Interval

ABSENT = "–"
PRINTED = 6
"""So many measures are printed; all others are in the files."""
LATEX_SIGNS = {
    "\\": r"\textbackslash{}",
    **{sign: f"\\{sign}" for sign in "&%$#_{}"},
    "~": r"\textasciitilde{}",
    "^": r"\textasciicircum{}",
    "⁻": "$^{-}$",
    "³": "$^{3}$",
    "↑": r"$\uparrow$",
    "↓": r"$\downarrow$",
    "–": "--",
    "−": "$-$",
}


def by_env(rows: Sequence[Row]) -> list[list[Row]]:
    """Return the rows of each environment, in the order of the comparison."""
    return [list(group) for _, group in groupby(rows, key=lambda row: row.env)]


def note(rows: Sequence[Row]) -> str:
    """Return what has to be said beneath the tables: what the intervals are, and what is compared with what."""
    sentences = [
        f"Mean over episodes and its 95% interval (BCa bootstrap, from {LEAST_SAMPLES} episodes on; Wilson's and "
        "Newcombe's for shares). Policies met the same seeds. Bold: the best, and what cannot be told from it by "
        "paired differences."
    ]
    measures = _measured(rows)
    for needed in measures:
        titles = [measure.title for measure in measures if measure.needs == needed.name]
        if titles:
            verb = "are" if titles[1:] else "is"
            sentences.append(
                f"{_listed(titles)} {verb} compared only among policies whose {needed.title!r} cannot be told from the "
                "best, and counted in every episode that has a value."
            )
    return " ".join(sentences)


def short_note(rows: Sequence[Row]) -> str:
    """Return the sentence beneath the printed table; `note` says it all."""
    known = any(row.episodes >= LEAST_SAMPLES for row in rows)
    means = (
        "Means over the same seeds, with their 95% intervals (± is half of one)"
        if known
        else "Means over the same seeds"
    )
    return f"{means}; bold is the best, and what cannot be told from it."


def interval_text(interval: Interval, measure: Measure, signed: bool = False) -> tuple[str, str]:
    """Return a mean and its interval as text, rounded to two digits of half the interval's width.

    Args:
        interval: In stored units.
        measure: Whose scale applies.
        signed: Show the plus sign too, for differences.

    Returns:
        Such as ``("25.0", "[23.9, 26.2]")``; the second is empty where there is no interval.
    """
    mean, low, high = (value * measure.scale for value in interval)
    if math.isnan(mean):
        return ABSENT, ""
    half = (high - low) / 2
    decimals = 0 if measure.share and not signed else _decimals(half, mean)
    shown = [_rounded(value, decimals, signed) for value in (mean, low, high)]
    return shown[0], "" if math.isnan(half) else f"[{shown[1]}, {shown[2]}]"


def csv_text(rows: Sequence[Row]) -> str:
    """Return `table.csv`: one line per environment, policy and measure, unrounded, in SI units and fractions."""
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow(["env", "policy", "episodes", "measure", "unit", "mean", "ci_low", "ci_high"])
    for row in rows:
        for measure in row.measured:
            numbers = ["" if math.isnan(number) else number for number in row.metrics[measure.name].interval]
            writer.writerow([row.env, row.policy, row.episodes, measure.name, measure.stored_unit, *numbers])
    return stream.getvalue()


def markdown_text(rows: Sequence[Row]) -> str:
    """Return `table.md`: every measure, a section per environment, and paired differences from the first policy."""
    sections = []
    for group in by_env(rows):
        measures = _measured(group)
        sections.append(f"## {_cell(group[0].env)} ({counted_episodes(group)})\n")
        winners = {measure.name: best(group, measure) for measure in measures}

        def absolute(row: Row, measure: Measure, winners: dict[str, set[str]] = winners) -> str:
            return _markdown_cell(_interval(row, measure), measure, row.policy in winners[measure.name])

        sections.append(_markdown_table(group, measures, absolute))
        if len(group) > 1:
            sections.append(f"Difference from {_cell(group[0].policy)}, seed by seed:\n")
            sections.append(_markdown_differences(group))
    return "\n".join([*sections, note(rows)]) + "\n"


def latex_text(rows: Sequence[Row]) -> str:
    """Return `table.tex`: the main measures as a booktabs table."""
    measures = [measure for measure in _measured(rows) if measure.main]
    lines = [
        r"% needs \usepackage{booktabs}",
        rf"\begin{{tabular}}{{ll{'r' * len(measures)}}}",
        r"\toprule",
        " & ".join(["Environment", "Policy", *(_latex(measure.heading) for measure in measures)]) + r" \\",
    ]
    for group in by_env(rows):
        lines.append(r"\midrule")
        for place, row in enumerate(group):
            cells = [_latex_cell(row, measure, group) for measure in measures]
            env = _latex(f"{row.env} ({counted_episodes(group)})") if place == 0 else ""
            lines.append(" & ".join([env, _latex(row.policy), *cells]) + r" \\")
    return (
        "\n".join([*lines, r"\bottomrule", r"\end{tabular}", *(f"% {line}" for line in _latex(note(rows)).split(". "))])
        + "\n"
    )


def terminal_table(rows: Sequence[Row], width: int = 80) -> Group:
    """Return the main measures for `rich.print`, at most `PRINTED`: a table per environment, a line per policy.

    Args:
        rows: Of the comparison.
        width: Of the terminal: intervals stand behind their means, or below them where it is short, or as half their
            width where it is shorter still.
    """
    return Group(*(part for group in by_env(rows) for part in (_terminal_table(group, width), Text(""))))


def _terminal_table(group: Sequence[Row], width: int) -> Table:
    measuring = Console(width=1000, file=io.StringIO())
    for form in _FORMS:
        table = _drawn(group, form)
        if measuring.measure(table).maximum <= width:
            break
    return table


def _drawn(group: Sequence[Row], form: "_Form") -> Table:
    measures = [measure for measure in _measured(group) if measure.main][:PRINTED]
    table = Table(title=Text(f"{group[0].env} · {counted_episodes(group)} each"), title_justify="left", box=SIMPLE_HEAD)
    table.pad_edge, table.show_edge, table.collapse_padding = False, False, True
    table.add_column("", overflow="fold")
    for measure in measures:
        table.add_column(Text(_two_lines(measure)), justify="right", overflow="fold")
    for row in group:
        cells = [
            _terminal_cell(_interval(row, measure), measure, row.policy in best(group, measure), form)
            for measure in measures
        ]
        table.add_row(Text(row.policy), *cells)
    return table


def _measured(rows: Sequence[Row]) -> list[Measure]:
    return merged(row.measured for row in rows)


def _listed(names: Sequence[str]) -> str:
    """Such as ``"Path, Time and Map IoU"``."""
    return f"{', '.join(names[:-1])} and {names[-1]}" if len(names) > 1 else names[0]


def counted_episodes(group: Sequence[Row]) -> str:
    """Such as ``"20 episodes"``, or ``"149 of 150 maps"`` where one could not be used by somebody."""
    row = group[0]
    count, what = row.episodes, "map" if row.maps else "episode"
    used = count - len({name for one in group for name in one.failures})
    return f"{f'{used} of ' if used < count else ''}{count} {what}{'s' if count > 1 else ''}"


def _interval(row: Row, measure: Measure) -> Interval:
    metric = row.metrics.get(measure.name)
    return metric.interval if metric and measure in row.columns else Interval(math.nan, math.nan, math.nan)


def _decimals(half: float, mean: float) -> int:
    """Digits after the point: two of half the interval's width, or else three of the mean; at most three."""
    spread = half if half > 0 else 0.0
    digits = 1 if spread else 2
    size = spread or abs(mean)
    return min(3, max(0, digits - math.floor(math.log10(size)))) if size > 0 else 0


def _rounded(value: float, decimals: int, signed: bool) -> str:
    text = f"{value:+.{decimals}f}" if signed else f"{value:.{decimals}f}"
    if not any(sign in "123456789" for sign in text):
        text = text.lstrip("+-")  # no sign on a zero
    return text.replace("-", "−")


def _markdown_table(group: Sequence[Row], measures: Sequence[Measure], cell: Callable[[Row, Measure], str]) -> str:
    lines = [
        ["Policy", *(measure.heading for measure in measures)],
        ["---", *("---:" for _ in measures)],
        *([_cell(row.policy), *(cell(row, measure) for measure in measures)] for row in group),
    ]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def _markdown_differences(group: Sequence[Row]) -> str:
    first, others = group[0], group[1:]
    measures = [measure for measure in _measured(group) if measure.main]
    comparable = {measure.name: {row.policy for row in contenders(group, measure)} for measure in measures}

    def cell(row: Row, measure: Measure) -> str:
        if not {row.policy, first.policy} <= comparable[measure.name]:
            return ABSENT
        return _markdown_cell(difference(row, first, measure), measure, bold=False, signed=True)

    return _markdown_table(others, [replace(measure, better=None) for measure in measures], cell)


def _markdown_cell(interval: Interval, measure: Measure, bold: bool, signed: bool = False) -> str:
    mean, bounds = interval_text(interval, measure, signed)
    return f"{f'**{mean}**' if bold else mean} {bounds}".strip()


def _cell(text: str) -> str:
    """A name as Markdown's tables take it."""
    return text.replace("\\", "\\\\").replace("|", "\\|").replace("_", "\\_").replace("*", "\\*")


def _latex(text: str) -> str:
    return "".join(LATEX_SIGNS.get(sign, sign) for sign in text)


def _latex_cell(row: Row, measure: Measure, group: Sequence[Row]) -> str:
    mean, bounds = (_latex(text) for text in interval_text(_interval(row, measure), measure))
    if row.policy in best(group, measure):
        mean = rf"\textbf{{{mean}}}"
    return f"{mean} {bounds}".strip()


def _two_lines(measure: Measure) -> str:
    """The heading with unit and direction below the title, which may itself take two lines."""
    title = measure.title.replace(" per ", "\nper ")
    unit = f"({measure.unit})" if measure.unit else ""
    return f"{title}\n{unit} {measure.arrow}".strip()


def _terminal_cell(interval: Interval, measure: Measure, bold: bool, form: "_Form") -> Text:
    mean, bounds = interval_text(interval, measure)
    text = Text(mean, style="bold" if bold else "")
    return text.append(form(bounds, interval, measure), style="not bold dim") if bounds else text


def _beside(bounds: str, interval: Interval, measure: Measure) -> str:
    return f" {bounds}"


def _below(bounds: str, interval: Interval, measure: Measure) -> str:
    return f"\n{bounds}"


def _half_below(bounds: str, interval: Interval, measure: Measure) -> str:
    half = measure.scale * (interval.high - interval.low) / 2
    return f"\n±{_rounded(half, 0 if measure.share else _decimals(half, half), signed=False)}"


_Form = Callable[[str, Interval, Measure], str]
_FORMS: tuple[_Form, ...] = (_beside, _below, _half_below)
