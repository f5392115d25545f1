"""The plane of two measures that are traded for each other: every policy a point, agents lines, and the rules' front.

Less is better in both, and only ratios matter, so that everything is worked out in logarithms. A point lies beyond a
line by the factor by which all of the line would have to be better in both measures at once to go through it (the
additive epsilon indicator of Zitzler et al. 2003 in logarithms): above 1 it is beyond, below 1 some point of the line
is better in both.
"""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.evaluation.comparison_config import PolicyEntry
from lidarena.evaluation.measures.table_columns import Measure, merged
from lidarena.evaluation.results import Row
from lidarena.evaluation.statistics import LEAST_SAMPLES

Floats = NDArray[np.float64]

LEVEL = 0.02
"""A policy that explores less than the best one by more than this is drawn, but is no rival: it saves its way."""
RESAMPLES = 2000
FRONT_FILE = "front.json"
_BOUNDS = (2.5, 97.5)
_SAME = 1e-6


@dataclass(frozen=True)
class PlanePoint:
    """One policy.

    Attributes:
        policy: What tables call it.
        entry: Of the comparison.
        logs: Logarithm of both measures, means over the episodes, (2,).
        resampled: The same of episodes drawn anew, the same ones for all policies (``RESAMPLES``, 2).
        level: Whether it explores as much as the others.
    """

    policy: str
    entry: PolicyEntry
    logs: Floats
    resampled: Floats
    level: bool

    @property
    def line(self) -> str:
        """Points of the same line are joined."""
        return self.entry.line or self.policy

    @property
    def learned(self) -> bool:
        """Whether it is a trained agent, not a rule."""
        return self.entry.path is not None

    @property
    def values(self) -> Floats:
        """Both measures (2,), and the bounds of their 95% intervals below them, (3, 2); NaN for too few episodes."""
        return np.exp(np.vstack([self.logs, np.percentile(self.resampled, _BOUNDS, axis=0)]))


@dataclass(frozen=True)
class Plane:
    """The policies in one kind of world, or in all together.

    Attributes:
        title: What tables call the environment.
        axes: The measures across and up.
        points: As far as both were measured and are positive.
        episodes: Number of paired episodes.
        relative_to: Policy over whose values all values are given; None if they are not.
    """

    title: str
    axes: tuple[Measure, Measure]
    points: tuple[PlanePoint, ...]
    episodes: int
    relative_to: str | None = None

    @property
    def lines(self) -> dict[str, list[PlanePoint]]:
        """The points of the trained agents by line, in the order of the comparison."""
        return _by_line(point for point in self.points if point.learned)

    @property
    def rules(self) -> list[PlanePoint]:
        """The points of the other policies that explore as much as the best."""
        return [point for point in self.points if not point.learned and point.level]

    @property
    def front(self) -> list[PlanePoint]:
        """The rules that no mixture of two others (in logarithms) is better than, the shortest path first."""
        return lower_hull(self.rules)


def planes_of(rows: Sequence[Row], policies: Sequence[PolicyEntry]) -> list[Plane]:
    """Return the planes of all environments that have one.

    Args:
        rows: Of all policies in the first environment, then in the next.
        policies: In the same order.
    """
    groups = [rows[begin : begin + len(policies)] for begin in range(0, len(rows), len(policies))]
    return [plane for group in groups if (plane := plane_of(group, policies)) is not None]


def plane_of(group: Sequence[Row], policies: Sequence[PolicyEntry]) -> Plane | None:
    """Return the plane of one environment; None where its family trades nothing, or there are no two points.

    Args:
        group: Its rows.
        policies: Their policies.
    """
    columns = merged(row.columns for row in group)
    axes = [next((m for m in columns if m.plane == place), None) for place in ("across", "up")]
    across, up = axes
    if across is None or up is None:
        return None
    known = [(row, policy) for row, policy in zip(group, policies, strict=True) if _measured(row, across, up)]
    if len(known) < 2:
        return None
    values = np.array([[row.metrics[m.name].values for m in (across, up)] for row, _ in known])
    paired = values[:, :, np.isfinite(values).all(axis=(0, 1))]  # (policies, 2, episodes)
    count = paired.shape[2]
    if not count or not (paired.mean(axis=2) > 0.0).all() or np.ptp(paired[:, 1]) < _SAME * paired[:, 1].max():
        return None  # with the true pose nothing is uncertain
    level = _level([row for row, _ in known], across.needs)
    points = tuple(
        PlanePoint(row.policy, policy, np.log(own.mean(axis=1)), np.log(_resampled(own)), row.policy in level)
        for (row, policy), own in zip(known, paired, strict=True)
    )
    return Plane(group[0].env, (across, up), points, count)


def pooled(planes: Sequence[Plane], reference: str) -> Plane | None:
    """Return the plane of all environments: ratios to a policy, each environment counting alike (geometric mean).

    Args:
        planes: Of the environments.
        reference: The policy.
    """
    planes = [plane for plane in planes if reference in {point.policy for point in plane.points}]
    if len(planes) < 2 or len({plane.axes for plane in planes}) > 1:
        return None
    ratios: dict[str, list[PlanePoint]] = {}
    for plane in planes:
        base = next(point for point in plane.points if point.policy == reference)
        for point in plane.points:
            apart = PlanePoint(
                point.policy, point.entry, point.logs - base.logs, point.resampled - base.resampled, point.level
            )
            ratios.setdefault(point.policy, []).append(apart)
    everywhere = [own for own in ratios.values() if len(own) == len(planes)]
    points = tuple(
        PlanePoint(
            own[0].policy,
            own[0].entry,
            np.mean([point.logs for point in own], axis=0),
            _shuffled_mean([point.resampled for point in own]),
            sum(point.level for point in own) > len(own) / 2,
        )
        for own in everywhere
    )
    episodes = sum(plane.episodes for plane in planes)
    return Plane(f"all {len(planes)} kinds of world", planes[0].axes, points, episodes, reference)


def lower_hull(points: Sequence[PlanePoint]) -> list[PlanePoint]:
    """Return the points of the lower left convex hull, from the least across to the least up."""
    hull: list[PlanePoint] = []
    for point in sorted(points, key=lambda point: (point.logs[0], point.logs[1])):
        if hull and point.logs[1] >= min(other.logs[1] for other in hull):
            continue
        while len(hull) > 1 and _turn(hull[-2].logs, hull[-1].logs, point.logs) <= 0.0:
            hull.pop()
        hull.append(point)
    return hull


def beyond(points: Floats, line: Floats) -> Floats:
    """Return by how much points lie beyond lines, in logarithms: see the module.

    Args:
        points: (…, 2) logarithms.
        line: (…, k, 2) logarithms of the k points that are joined, one or more.
    """
    away = line - points[..., None, :]
    at_points = away.max(axis=-1).min(axis=-1)
    start, along = away[..., :-1, :], np.diff(away, axis=-2)
    apart, closing = start[..., 0] - start[..., 1], along[..., 1] - along[..., 0]
    with np.errstate(divide="ignore", invalid="ignore"):
        share = np.where(closing != 0.0, apart / closing, 0.0)  # where both measures are off by the same factor
    between = np.where((share > 0.0) & (share < 1.0), start[..., 0] + share * along[..., 0], np.inf)
    nearest: Floats = np.minimum(at_points, between.min(axis=-1, initial=np.inf))
    return nearest


def write_front(path: Path, planes: Sequence[Plane], whole: Plane | None) -> None:
    """Write `front.json`, see `front_document`."""
    text = json.dumps(front_document(planes, whole), indent=1, allow_nan=False, ensure_ascii=False)
    path.write_text(text + "\n", encoding="utf-8")


def front_document(planes: Sequence[Plane], whole: Plane | None) -> dict[str, Any]:
    """Return what `front.json` holds: all points, and for every rule whether it lies beyond each agent's line.

    ``beyond[line][rule]`` lists the environments where it does, so that it can be read at a glance.
    """
    documents = [_document(plane) for plane in (*planes, *([whole] if whole is not None else []))]
    glance: dict[str, dict[str, list[str]]] = {}
    for plane, document in zip(planes, documents, strict=False):
        for verdict in document["rules"]:
            places = glance.setdefault(verdict["line"], {}).setdefault(verdict["rule"], [])
            places.extend([plane.title] if verdict["beyond"] else [])
    return {"beyond": glance, "planes": documents}


def _document(plane: Plane) -> dict[str, Any]:
    names = [measure.name for measure in plane.axes]
    points = []
    for point in plane.points:
        columns = dict(zip(names, point.values.T.tolist(), strict=True))
        told = {
            name: dict(zip(("mean", "ci_low", "ci_high"), map(_or_null, own), strict=True))
            for name, own in columns.items()
        }
        points.append({"policy": point.policy, **told, "level": point.level})
    rules = [
        {"line": name, "rule": rule.policy} | _verdict(rule, line)
        for name, line in plane.lines.items()
        for rule in plane.rules
    ]
    front = plane.front
    agents = [
        {"policy": point.policy} | _verdict(point, front) for line in plane.lines.values() for point in line if front
    ]
    return {
        "env": plane.title,
        "episodes": plane.episodes,
        "relative_to": plane.relative_to,
        "points": points,
        "front": [point.policy for point in front],
        "rules": rules,
        "agents": agents,
    }


def _verdict(point: PlanePoint, line: Sequence[PlanePoint]) -> dict[str, Any]:
    """Whether and by which factor a point is beyond a line, with the 95% interval over episodes drawn anew.

    Points of the line that explore less do not count; beyond a line without others is everything.
    """
    line = [other for other in line if other.level]
    if not line:
        return {"beyond": True, "factor": None, "ci_low": None, "ci_high": None}
    factor = float(np.exp(beyond(point.logs, np.array([other.logs for other in line]))))
    again = beyond(point.resampled, np.stack([other.resampled for other in line], axis=1))
    low, high = map(_or_null, np.exp(np.percentile(again, _BOUNDS)).tolist())
    return {"beyond": factor > 1.0, "factor": factor, "ci_low": low, "ci_high": high}


def _resampled(values: Floats) -> Floats:
    """Means of (2, episodes) over episodes drawn anew, the same for every policy; NaN where they are too few."""
    count = values.shape[1]
    if count < LEAST_SAMPLES:
        return np.full((RESAMPLES, 2), np.nan)
    drawn = np.random.default_rng(0).integers(count, size=(RESAMPLES, count))
    means: Floats = values[:, drawn].mean(axis=2).T
    return means


def _or_null(value: float) -> float | None:
    return value if np.isfinite(value) else None


def _measured(row: Row, *measures: Measure) -> bool:
    return all(measure.name in row.metrics for measure in measures)


def _level(rows: Sequence[Row], needed: str | None) -> set[str]:
    """Policies whose mean of the needed measure is that of the best one, but for ``LEVEL``."""
    means = {row.policy: row.metrics[needed].interval.mean for row in rows if needed in row.metrics} if needed else {}
    return {row.policy for row in rows if means.get(row.policy, 0.0) >= max(means.values(), default=0.0) - LEVEL}


def _by_line(points: Any) -> dict[str, list[PlanePoint]]:
    lines: dict[str, list[PlanePoint]] = {}
    for point in points:
        lines.setdefault(point.line, []).append(point)
    return lines


def _shuffled_mean(samples: Sequence[Floats]) -> Floats:
    """Mean over environments, whose episodes are drawn independently of each other's."""
    rolled = [np.roll(sample, 37 * place, axis=0) for place, sample in enumerate(samples)]
    mean: Floats = np.mean(rolled, axis=0)
    return mean


def _turn(first: Floats, middle: Floats, last: Floats) -> float:
    """Positive where the way from the first over the middle to the last turns left."""
    (a, b), (c, d) = middle - first, last - first
    return float(a * d - b * c)
