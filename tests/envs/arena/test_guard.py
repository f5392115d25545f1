"""The arena's guard against a slow oracle, and what it promises: who drives by chance touches nothing that stands."""

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from lidarena.envs import ArenaEnv, BatchedArena
from lidarena.envs.arena.actions import HEADINGS
from lidarena.envs.arena.guard import SOON, guard_turns
from lidarena.world.arenas import Arena
from lidarena.world.walled_arenas import posts_along

WIDTH = 2 * math.pi / HEADINGS
ROOM = (0.0, 0.0, 100.0, 100.0)
WALL = Arena("wall", posts_along([(50.0, 30.0), (50.0, 80.0)]), (47.5, 50.0), (90.0, 50.0), ROOM, 1.0)


def guarded(free: list[float], turn: float) -> float:
    turns = np.array([turn])
    guard_turns(np.array([free]), turns)
    return float(turns[0])


def slow_guard(free: list[float], turn: float) -> float:
    """Sorts all headings: those that are free for long enough first, and the nearer ones before others."""
    share = turn / WIDTH
    around = {math.floor(share + 1e-6) % HEADINGS, math.ceil(share - 1e-6) % HEADINGS}
    if all(free[k] >= SOON for k in around):
        return turn
    return WIDTH * min(
        range(HEADINGS), key=lambda k: (-min(free[k], SOON), abs(math.remainder(k * WIDTH - turn, 2 * math.pi)))
    )


@settings(deadline=None)
@given(st.lists(st.floats(0.0, 8.0), min_size=HEADINGS, max_size=HEADINGS), st.floats(-math.pi, math.pi))
def test_it_takes_the_heading_that_comes_first_when_all_are_sorted(free: list[float], turn: float) -> None:
    taken = guarded(free, turn)
    assert taken == pytest.approx(slow_guard(free, turn)) or math.isclose(  # two are as near: either will do
        abs(math.remainder(taken - turn, 2 * math.pi)), abs(math.remainder(slow_guard(free, turn) - turn, 2 * math.pi))
    )


@settings(deadline=None)
@given(st.integers(0, HEADINGS - 1), st.integers(-2, 2))
def test_discrete_headings_that_are_free_are_kept_to_the_bit(heading: int, rounds: int) -> None:
    turn = heading * WIDTH + rounds * 2 * math.pi
    only = [8.0 if k == heading else 0.0 for k in range(HEADINGS)]
    assert guarded(only, turn) == turn


def test_a_turn_between_two_headings_needs_both_to_be_free() -> None:
    left_is_blocked = [8.0, 0.5] + [8.0] * (HEADINGS - 2)
    assert guarded(left_is_blocked, 0.2 * WIDTH) == 0.0
    assert guarded(left_is_blocked, 1.2 * WIDTH) == pytest.approx(2 * WIDTH)
    assert guarded(left_is_blocked, -0.2 * WIDTH) == -0.2 * WIDTH


@pytest.mark.parametrize("keywords", [{}, {"observation": "way"}, {"action": "discrete", "observation": "proximity"}])
def test_who_is_told_to_drive_into_a_wall_turns_aside(keywords: dict[str, Any]) -> None:
    ahead = 0 if keywords.get("action") == "discrete" else np.zeros(1, np.float32)

    def ends_in_contact(guard: bool) -> bool:
        env = ArenaEnv(arena=WALL, knowledge="lidar", guard=guard, **keywords)
        env.reset(seed=0)
        return any(env.step(ahead)[2] for _ in range(30))

    assert ends_in_contact(False)
    assert not ends_in_contact(True)


@pytest.mark.parametrize("action", ["discrete", "continuous"])
def test_whoever_drives_by_chance_touches_nothing_that_stands(action: str) -> None:
    envs = BatchedArena(16, arena="random", density=0.25, guard=True, action=action, knowledge="lidar")
    envs.reset(seed=3)
    envs.action_space.seed(3)
    touched = np.zeros(16, np.bool_)
    for _ in range(150):
        touched |= envs.step(envs.action_space.sample())[4]["collision"]
    assert not touched.any()
