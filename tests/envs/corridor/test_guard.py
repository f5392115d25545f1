"""The guard against a slow oracle, and what it promises: whoever drives by chance touches nothing, nor stands still."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.envs.corridor.guard import MARGIN, SLACK, guard_speeds
from lidarena.envs.corridor.options import CorridorOptions
from tests.envs.corridor.corridor_worlds import begin

BEAMS, REACH, RADIUS, PERIOD, TURN = 36, 3.5, 0.105, 0.2, 1.0
ANGLES = np.arange(BEAMS) * 2 * np.pi / BEAMS
DIRECTIONS = np.stack([np.cos(ANGLES), np.sin(ANGLES)])
SHARES = np.linspace(0.0, 1.0, 2001)


def guarded(scan: NDArray[np.float32], speed: float, rate: float) -> tuple[float, float]:
    commands = np.array([[[speed, rate]]])
    guard_speeds(scan[None, None], DIRECTIONS, REACH, RADIUS, PERIOD, TURN, commands)
    return float(commands[0, 0, 0]), float(commands[0, 0, 1])


def slow_guard(scan: NDArray[np.float32], speed: float, rate: float) -> float:
    """Tries one speed after the other, from 0 up."""
    points = (scan * DIRECTIONS).T[scan < REACH].astype(np.float64)
    heading = 0.5 * rate * PERIOD
    ahead = np.array([np.cos(heading), np.sin(heading)])
    gaps = np.hypot(*points.T) - RADIUS
    least = np.where(gaps > MARGIN, MARGIN + 0.5 * (gaps - MARGIN), gaps)
    allowed = 0.0
    for share in SHARES:
        after = np.hypot(*(points - SLACK * share * speed * PERIOD * ahead).T) - RADIUS
        if (after < np.minimum(least, gaps) - 1e-9).any():
            break
        allowed = share * speed
    return allowed


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.floats(-0.5, 0.5), st.floats(-2.0, 2.0))
def test_it_allows_what_trying_one_speed_after_the_other_allows(seed: int, speed: float, rate: float) -> None:
    rng = np.random.default_rng(seed)
    scan = np.where(rng.random(BEAMS) < 0.7, rng.uniform(RADIUS + 0.01, 1.0, BEAMS), REACH).astype(np.float32)
    slower, turned = guarded(scan, speed, rate)
    assert turned == rate or (abs(turned) == TURN and abs(slower) <= 0.5 * abs(speed) + 1e-9)
    assert slower == pytest.approx(slow_guard(scan, speed, rate), abs=abs(speed) / 1000 + 1e-6)


def test_who_drives_along_a_wall_or_away_from_it_is_hardly_held_up() -> None:
    across = np.maximum(-DIRECTIONS[1], 1e-9)  # a wall on the right

    def beside(gap: float) -> NDArray[np.float32]:
        return np.asarray(np.minimum((RADIUS + gap) / across, REACH), np.float32)

    assert guarded(beside(0.1), 0.5, 0.0)[0] == pytest.approx(0.5)
    assert guarded(beside(0.06), 0.5, 0.0)[0] > 0.25
    assert guarded(beside(0.06), 0.5, 1.0)[0] > 0.35  # to the left
    assert guarded(beside(0.06), 0.5, -1.0)[0] < 0.25
    assert guarded(beside(0.06), -0.5, -1.0)[0] < -0.35  # its way back leads to the left


def test_who_is_held_up_turns_away_from_what_is_in_the_way() -> None:
    def before(number: int) -> NDArray[np.float32]:
        scan = np.full(BEAMS, REACH, np.float32)
        scan[number] = RADIUS + 0.05
        return scan

    assert guarded(before(1), 0.5, 0.0)[1] == -TURN  # it is on the left
    assert guarded(before(BEAMS - 1), 0.5, 0.0)[1] == TURN
    assert guarded(before(BEAMS // 2 + 1), -0.5, 0.0)[1] == -TURN  # behind it, on the left of its way back
    assert guarded(before(9), 0.5, 0.3)[1] == 0.3  # beside it


def test_what_is_nearer_than_the_lidar_measures_is_not_driven_at() -> None:
    scan = np.full(BEAMS, REACH, np.float32)
    scan[0] = 0.0
    assert guarded(scan, 0.5, 0.0)[0] == 0.0
    assert guarded(scan, -0.5, 0.0)[0] == -0.5


@pytest.mark.parametrize(("plan", "robots"), [("maze:31", 6), ("office", 12)])
def test_a_team_that_drives_by_chance_touches_nothing(plan: str, robots: int) -> None:
    def touched(guard: bool) -> int:
        teams = begin(2, seed=4, map=plan, robots=robots, places="random", guard=guard)
        rng = np.random.default_rng(1)
        for _ in range(60):
            way = rng.uniform([0.0, -1.0], 1.0, (2, robots, 2)).astype(np.float32)
            for _ in range(5):
                teams.step(way)
        return int((teams.touches > 0).sum())

    assert touched(True) == 0
    assert touched(False) > robots


def test_a_lidar_with_a_blind_side_cannot_guard() -> None:
    with pytest.raises(ConfigError, match="guard=True needs a lidar that sees all around"):
        CorridorOptions.checked({"guard": True, "lidar": {"field_of_view": 3.0}})
