import math

import numpy as np
import pytest

from lidarena.baselines.exploration.driving import Terrain
from lidarena.baselines.exploration.frontier_features import (
    CANDIDATES,
    FEATURES,
    NAMES,
    RULE,
    Candidate,
    Certainty,
    describe,
)
from lidarena.planning.grid.surroundings import Surroundings

CERTAINTY = Certainty(1e-3, 1e-4, 50.0)
TRACK = np.array([[0.25, 0.25], [0.5, 0.25]])


def room(known_columns: int = 40) -> tuple[Terrain, np.ndarray]:
    """A free room of 2 x 2 m, known up to a column, and the straight distances from its corner."""
    occupancy = np.zeros((40, 40), np.int8)
    occupancy[:, known_columns:] = -1
    around = Surroundings(np.ones((40, 40), np.float32), np.zeros((40, 40), np.bool_), 0.05, (0.0, 0.0))
    terrain = Terrain(occupancy, np.ones((40, 40)), np.ones((40, 40), np.bool_), around, (5, 5))
    rows, columns = np.mgrid[:40, :40]
    return terrain, np.hypot(rows - 5, columns - 5) * 0.05


def described(
    candidates: list[Candidate], known_columns: int = 40, pursued: int | None = None
) -> dict[str, np.ndarray]:
    terrain, lengths = room(known_columns)
    pose = np.array([0.275, 0.275, 0.0])
    features = describe(candidates, lengths, terrain, pose, pursued, CERTAINTY, TRACK)
    assert features.shape == (CANDIDATES, FEATURES) and np.isfinite(features).all()
    return dict(zip(NAMES, features.T, strict=True))


def test_candidates_that_are_not_there_are_zero() -> None:
    told = described([Candidate((5, 30), 0.6), Candidate((30, 5), 0.9)])
    assert told["there"].tolist() == [1.0] * 2 + [0.0] * (CANDIDATES - 2)
    assert not any(values[2:].any() for values in told.values())


def test_ways_sizes_and_turns_are_those_of_the_place() -> None:
    told = described([Candidate((5, 30), 0.6), Candidate((30, 5), 0.9)], pursued=1)
    assert told["way"][:2] == pytest.approx([1.25 / 3.0] * 2, abs=1e-6)
    assert told["size"][:2] == pytest.approx([0.2, 0.3])
    assert told["turn"][:2] == pytest.approx([0.0, 0.5], abs=0.01)  # ahead, and to the left
    assert told["pursued"][:2].tolist() == [0.0, 1.0] and told["nearest"][:2].tolist() == [1.0, 0.0]
    apart = math.hypot(1.25, 1.25) / 3.0
    assert told["apart"][:2] == pytest.approx([apart] * 2) and told["remote"][:2] == pytest.approx([apart] * 2)


def test_what_is_unknown_around_a_place_counts_and_so_does_what_lies_beyond_the_map() -> None:
    inside, edge = described([Candidate((20, 20))]), described([Candidate((20, 20))], known_columns=21)
    assert edge["unknown"][0] > inside["unknown"][0] + 0.2
    assert described([Candidate((0, 0))])["unknown"][0] > 0.7


def test_where_the_robot_has_been_is_told_by_its_age() -> None:
    told = described([Candidate((5, 5)), Candidate((39, 39))])
    assert told["age"][:2] == pytest.approx([0.02, 0.0])


def test_the_start_and_staying_are_marked_and_all_see_the_certainty() -> None:
    told = described([Candidate((5, 5)), Candidate((5, 5), ends=True)])
    assert told["revisit"][:2].tolist() == [1.0, 0.0] and told["end"][:2].tolist() == [0.0, 1.0]
    assert (
        (told["uncertainty"][:2] == 1.0).all()
        and (told["mean"][:2] == 0.0).all()
        and (told["elapsed"][:2] == 0.5).all()
    )


def test_the_rule_speaks_of_features_that_there_are() -> None:
    assert set(RULE) < set(NAMES)
