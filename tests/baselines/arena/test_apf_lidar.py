import pytest

from tests.baselines.arena.arena_drives import LIDAR, drive


@pytest.mark.parametrize("policy", LIDAR)
def test_lidar_policies_read_nothing_but_the_lidar(policy: str) -> None:
    ends = [drive(policy, arena="random:4", knowledge=knowledge)[1]["path_length"] for knowledge in ("map", "lidar")]
    assert ends[0] == ends[1]


@pytest.mark.parametrize("policy", LIDAR)
def test_noise_stops_no_lidar_policy(policy: str) -> None:
    ending = drive(policy, arena="random:0", density=0.08, lidar={"noise": 0.2})[0]
    assert ending in ("success", "collision", "finished")
