import numpy as np
import pytest

from tests.baselines.arena.arena_drives import drive


@pytest.mark.parametrize("arena", ["yang:arc", "yang:u"])
@pytest.mark.parametrize("policy", ["apf", "apf_lidar"])
def test_the_traditional_field_is_trapped_and_says_so(policy: str, arena: str) -> None:
    end, info = drive(policy, arena=arena)
    assert end == "finished"
    assert np.hypot(*(info["pose"][:2] - 12.0)) < 7.0  # inside of the trap


def test_the_traditional_field_stops_short_of_a_goal_beside_an_obstacle() -> None:
    end, info = drive("apf", arena="gnron", goal_radius=0.01)
    assert end == "finished" and info["distance"] < 1.0
    assert drive("apf_improved", arena="gnron")[0] == "success"
