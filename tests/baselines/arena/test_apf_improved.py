import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from tests.baselines.arena.arena_drives import planner, world

TRAP = [(60.0, y, 2.0) for y in range(40, 61, 2)] + [(x, y, 2.0) for x in range(50, 60, 2) for y in (40.0, 60.0)]
"""A U that is open towards the robot."""


def test_traps_are_filled_and_the_detour_is_short_cut() -> None:
    policy = planner("apf_improved")
    path = policy.plan(world(TRAP))
    assert path[-1].tolist() == [90.0, 50.0]
    assert len(path) < len(policy.before)
    for x, y, radius in TRAP:
        assert (np.hypot(*(path - (x, y)).T) > radius + 1.0 - 1e-6).all()


def test_without_a_trap_nothing_is_filled() -> None:
    policy = planner("apf_improved")
    policy.plan(world([(50.0, 70.0, 4.0)]))
    assert policy.fills == 0


def test_a_field_of_ones_own_reaches_the_planner() -> None:
    with pytest.raises(ConfigError, match="did you mean 'gamma'"):
        planner("apf_improved", field={"gama": 0.1})
    path = planner("apf_improved", field={"regression": False, "ways": 1, "attempts": 1}).plan(world([]))
    assert len(path) > 100  # every step of the walk
