"""The answer that a report opens with: who is best, by how much, how sure."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

from lidarena.evaluation.measures.table_columns import Measure, merged
from lidarena.evaluation.results import Row, contenders, difference, level_with_best
from lidarena.evaluation.statistics import LEAST_SAMPLES
from lidarena.evaluation.tables import by_env, interval_text


@dataclass(frozen=True)
class Answer:
    """What can be said of one environment.

    Attributes:
        env: Which.
        leaders: Policies that no other is shown to be better than, in the order of the comparison.
        sentence: Who they are, by how much, and how sure that is.
    """

    env: str
    leaders: tuple[str, ...]
    sentence: str


def answers(rows: Sequence[Row]) -> list[Answer]:
    """Return what can be said of each environment.

    Policies are compared measure by measure, episodes of one seed with each other: first the measures that others
    need (who crashes early drives the shortest path), then outcomes, then the rest of the main columns in their order.
    After each, those go on that cannot be told from the best; the first measure that leaves one alone decides.
    """
    return [_of_env(group) for group in by_env(rows)]


def headline(found: Sequence[Answer], rows: Sequence[Row]) -> str:
    """Return one sentence about all environments."""
    policies = list(dict.fromkeys(row.policy for row in rows))
    if not found:
        return "There are no results."
    if len(policies) == 1:
        return f"Only {policies[0]} was measured, so there is nothing to compare it with."
    if min(row.episodes for row in rows) < LEAST_SAMPLES:
        return f"Too few episodes to tell policies apart: intervals begin at {LEAST_SAMPLES} an environment."
    alone = Counter(answer.leaders[0] for answer in found if len(answer.leaders) == 1)
    first = Counter(name for answer in found for name in answer.leaders)
    worlds = f"{len(found)} environment{'s' if len(found) > 1 else ''}"
    name, wins = max(alone.items(), key=lambda item: item[1], default=("", 0))
    if wins == len(found):
        return f"{name} is best in {'the' if wins == 1 else 'all'} {worlds if wins > 1 else 'environment'}."
    if name and first[name] == len(found):
        return f"{name} is best in {wins} of {worlds} and cannot be told from the best in the others."
    leading = [f"{who} leads or shares the lead in {count}" for who, count in first.most_common(3)]
    return f"No policy is best everywhere; of {worlds}, {'; '.join(leading)}."


def _of_env(group: Sequence[Row]) -> Answer:
    env, left = group[0].env, list(group)
    behind: list[str] = []
    if len(left) == 1:
        return Answer(env, (left[0].policy,), f"{left[0].policy}: {_value(left[0], _main(group)[:1])}")
    if group[0].episodes < LEAST_SAMPLES:
        return Answer(env, tuple(row.policy for row in left), f"{group[0].episodes} episodes are too few to tell.")
    for measure in _main(group):
        measured = [row for row in left if measure.name in row.metrics]
        if len(measured) < len(left) or len(contenders(left, measure)) < len(left):
            continue
        level = level_with_best(left, measure)
        out = [row for row in left if row not in level]
        if not out:
            continue
        if len(level) == 1:
            return Answer(env, (level[0].policy,), _decided(level[0], out, measure, behind))
        behind.append(f"{_listed([row.policy for row in out])} {_fall(out)} behind in {measure.title.lower()}")
        left = level
    names = [row.policy for row in left]
    rest = f" Before, {'; '.join(behind)}." if behind else ""
    return Answer(
        env,
        tuple(names),
        f"{_listed(names)} cannot be told apart in {group[0].episodes} episodes (95% intervals).{rest}",
    )


def _main(group: Sequence[Row]) -> list[Measure]:
    """The main measures with a direction: needed ones first, then outcomes, then the others."""
    columns = [column for column in merged(row.measured for row in group) if column.main and column.better]
    needed = {column.needs for column in columns}
    return sorted(columns, key=lambda column: (column.name not in needed, not column.share))


def _decided(winner: Row, out: Sequence[Row], measure: Measure, behind: Sequence[str]) -> str:
    sign = -1.0 if measure.better == "low" else 1.0
    second = max(out, key=lambda row: sign * row.metrics[measure.name].interval.mean)
    gap = difference(winner, second, measure)
    shown, bounds = interval_text(gap, measure, signed=True)
    unit = " points" if measure.unit == "%" else f" {measure.unit}" if measure.unit else ""
    sure = f"95% interval {bounds}" if bounds and not math.isnan(gap.low) else "no interval"
    sentence = (
        f"{winner.policy} is best: {_value(winner, [measure])}, {shown}{unit} against {second.policy} "
        f"({sure}, {winner.episodes} episodes on the same seeds)."
    )
    return sentence + (f" Before, {'; '.join(behind)}." if behind else "")


def _value(row: Row, measures: Sequence[Measure]) -> str:
    told = []
    for measure in measures:
        if measure.name in row.metrics:
            mean, bounds = interval_text(row.metrics[measure.name].interval, measure)
            told.append(f"{measure.title.lower()} {mean}{f' {measure.unit}' if measure.unit else ''} {bounds}".strip())
    return ", ".join(told) or "nothing was measured"


def _listed(names: Sequence[str]) -> str:
    return f"{', '.join(names[:-1])} and {names[-1]}" if len(names) > 1 else names[0]


def _fall(rows: Sequence[Row]) -> str:
    return "falls" if len(rows) == 1 else "fall"
