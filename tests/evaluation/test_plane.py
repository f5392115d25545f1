"""Points, fronts and verdicts on the plane of two measures."""

import json
import math
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidarena.evaluation.comparison_config import PolicyEntry
from lidarena.evaluation.plane import beyond, front_document, plane_of, planes_of, pooled, write_front
from lidarena.evaluation.results import Row
from tests.evaluation.rows import row_of

POLICIES = [
    *(PolicyEntry(name=name) for name in ("frontier", "nearest_frontier", "idle")),
    *PolicyEntry(name="pretrained:combined", sweep={"preference": [0, 1]}).swept(),
]
MEANS = {
    "frontier": (50, 5),
    "nearest_frontier": (30, 9),
    "idle": (5, 1),
    "combined @ 0": (28, 7),
    "combined @ 1": (45, 4),
}
EPISODES = 12


def rows_in(env: str, size: float = 1.0, means: dict[str, tuple[float, float]] = MEANS) -> list[Row]:
    """Rows in which every episode is as hard for one policy as for another."""
    hard = np.exp(np.random.default_rng(0).normal(0, 0.2, EPISODES))
    return [row(policy.title, env, *means[policy.title], size * hard) for policy in POLICIES]


def row(policy: str, env: str, path: float, uncertainty: float, hard: np.ndarray) -> Row:
    explored = [0.2 if policy == "idle" else 0.99] * len(hard)
    up = list(1e-4 * uncertainty * hard)
    return row_of(policy, env, completeness=explored, path_length=list(path * hard), d_optimality_per_metre=up)


def logs(*points: Sequence[float]) -> np.ndarray:
    return np.log(np.array(points, dtype=float))


LINE = logs((10, 8), (20, 4), (40, 2))


@pytest.mark.parametrize(
    ("point", "factor"),
    [
        ((20, 4), 1.0),  # on the line
        ((10 * math.sqrt(2), 8 / math.sqrt(2)), 1.0),  # between two of its points
        ((10, 4), math.sqrt(2)),  # shorter and surer
        ((40, 4), 1 / math.sqrt(2)),  # longer and less sure
        ((9, 80), 10 / 9),  # shorter than all of the line, at whatever price
        ((400, 1), 2.0),  # surer than all of it
        ((400, 80), 1 / 20),  # (20, 4) is twenty times better in both
    ],
)
def test_how_far_a_point_lies_beyond_a_line(point: tuple[float, float], factor: float) -> None:
    assert float(np.exp(beyond(logs(point)[0], LINE))) == pytest.approx(factor)


@given(
    st.lists(st.tuples(st.floats(-3, 3), st.floats(-3, 3)), min_size=1, max_size=5), st.floats(-3, 3), st.floats(-3, 3)
)
def test_beyond_is_what_a_dense_sampling_of_the_line_says(line: list[tuple[float, float]], x: float, y: float) -> None:
    corners = np.array(line)
    shares = np.linspace(0, 1, 401)[:, None]
    dense = np.vstack([corners, *(a + shares * (b - a) for a, b in pairwise(corners))])
    expected = (dense - [x, y]).max(axis=1).min()
    assert float(beyond(np.array([x, y]), corners)) == pytest.approx(expected, abs=0.02)


def test_many_points_and_lines_at_once() -> None:
    points, lines = np.random.default_rng(0).normal(size=(7, 2)), np.random.default_rng(1).normal(size=(7, 3, 2))
    together = beyond(points, lines)
    assert together == pytest.approx([float(beyond(p, line)) for p, line in zip(points, lines, strict=True)])


def test_a_plane_has_points_lines_and_a_front() -> None:
    plane = plane_of(rows_in("Env-2"), POLICIES)
    assert plane is not None and plane.episodes == EPISODES
    assert [point.policy for point in plane.front] == ["nearest_frontier", "frontier"]  # idling is no merit
    assert {name: [p.policy for p in line] for name, line in plane.lines.items()} == {
        "combined": ["combined @ 0", "combined @ 1"]
    }
    mean, low, high = plane.points[0].values
    assert (low < mean).all() and (mean < high).all()


def test_the_front_leaves_out_what_a_mixture_beats() -> None:
    means = MEANS | {"idle": (40, 8.0)}
    rows = [row(p.title, "Env", *means[p.title], np.ones(6)) for p in POLICIES]
    rows[2] = row("explorer", "Env", 40, 8.0, np.ones(6))
    plane = plane_of(rows, POLICIES)
    assert plane is not None
    assert [point.policy for point in plane.front] == ["nearest_frontier", "frontier"]
    assert len(plane.rules) == 3


def test_without_a_trade_there_is_no_plane() -> None:
    rows = rows_in("Env-2")
    assert plane_of(rows[:1], POLICIES[:1]) is None
    assert plane_of([row_of("frontier", time=[1.0]), row_of("random", time=[2.0])], POLICIES[:2]) is None
    known = [row(p.title, "Env", MEANS[p.title][0], 1.0, np.ones(6)) for p in POLICIES]  # the true pose
    assert plane_of(known, POLICIES) is None


def test_an_episode_that_one_policy_lacks_counts_for_none() -> None:
    rows = rows_in("Env-2")
    paths = list(rows[0].metrics["path_length"].values)
    paths[3] = math.nan
    up = list(rows[0].metrics["d_optimality_per_metre"].values)
    rows[0] = row_of("frontier", "Env-2", completeness=[0.99] * EPISODES, path_length=paths, d_optimality_per_metre=up)
    plane = plane_of(rows, POLICIES)
    assert plane is not None and plane.episodes == EPISODES - 1


def test_all_environments_count_alike_when_they_are_pooled() -> None:
    twice = MEANS | {"nearest_frontier": (60, 9)}
    planes = planes_of([*rows_in("small"), *rows_in("large", 10.0, twice)], POLICIES)
    whole = pooled(planes, "frontier")
    assert whole is not None and whole.relative_to == "frontier"
    by_name = {point.policy: point.values[0] for point in whole.points}
    assert by_name["frontier"] == pytest.approx([1.0, 1.0])
    assert by_name["nearest_frontier"] == pytest.approx([math.sqrt(0.6 * 1.2), 1.8])
    assert pooled(planes[:1], "frontier") is None and pooled(planes, "nobody") is None


def test_the_document_says_who_is_beyond_whom(tmp_path: Path) -> None:
    better = MEANS | {"nearest_frontier": (25, 6.5)}
    planes = planes_of([*rows_in("one"), *rows_in("other", 1.0, better)], POLICIES)
    write_front(tmp_path / "front.json", planes, pooled(planes, "frontier"))
    document = json.loads((tmp_path / "front.json").read_text())
    assert document["beyond"] == {"combined": {"frontier": [], "nearest_frontier": ["other"]}}
    one, other, whole = document["planes"]
    assert whole["relative_to"] == "frontier" and one["relative_to"] is None
    rules = {verdict["rule"]: verdict for verdict in other["rules"]}
    assert rules["nearest_frontier"]["factor"] > 1 > rules["frontier"]["factor"]
    assert (
        rules["nearest_frontier"]["ci_low"]
        <= rules["nearest_frontier"]["factor"]
        <= rules["nearest_frontier"]["ci_high"]
    )
    assert all(verdict["beyond"] for verdict in one["agents"])
    assert set(one["points"][0]["path_length"]) == {"mean", "ci_low", "ci_high"}
    assert document == front_document(planes, pooled(planes, "frontier"))


def test_an_agent_that_explores_less_holds_no_line() -> None:
    rows = [row(p.title, "Env", *MEANS[p.title], np.ones(6)) for p in POLICIES[:2]]
    for policy, path in ((POLICIES[3], 10.0), (POLICIES[4], 12.0)):
        worse = {"path_length": [path] * 6, "d_optimality_per_metre": [1e-5] * 6}
        rows.append(row_of(policy.title, "Env", completeness=[0.5] * 6, **worse))
    document = front_document(planes_of(rows, [*POLICIES[:2], *POLICIES[3:]]), None)
    assert all(verdict["beyond"] and verdict["factor"] is None for verdict in document["planes"][0]["rules"])
    assert not any(point["level"] for point in document["planes"][0]["points"][2:])


def test_few_episodes_have_no_intervals() -> None:
    rows = [row(p.title, "Env", *MEANS[p.title], np.ones(2)) for p in POLICIES]
    document = front_document(planes_of(rows, POLICIES), None)
    assert document["planes"][0]["points"][0]["path_length"] == {
        "mean": pytest.approx(50.0),
        "ci_low": None,
        "ci_high": None,
    }
    json.dumps(document, allow_nan=False)
