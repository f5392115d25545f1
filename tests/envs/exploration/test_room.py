import pytest

from lidarena.envs.exploration.options import ExplorationOptions
from lidarena.envs.exploration.room import least_distance, sees_what_is_near


@pytest.mark.parametrize(("noise", "beside"), [(0.0, 0.015), (0.01, 0.015), (0.05, 0.075)])
def test_a_noisier_lidar_is_kept_farther_away_from_what_it_hits(noise: float, beside: float) -> None:
    options = ExplorationOptions.checked({"lidar": {"noise": noise}})
    assert least_distance(options) == pytest.approx(options.robot.bumper + beside)


@pytest.mark.parametrize(
    ("lidar", "sees"),
    [({}, True), ({"beams": 90}, True), ({"beams": 8}, False), ({"field_of_view": 3.0}, False)],
)
def test_few_beams_or_a_narrow_view_do_not_see_all_that_is_near(lidar: dict[str, float], sees: bool) -> None:
    assert sees_what_is_near(ExplorationOptions.checked({"lidar": lidar})) == sees


def test_what_is_nearer_than_a_lidar_measures_is_not_seen() -> None:
    assert not sees_what_is_near(ExplorationOptions.checked({"lidar": {"min_range": 0.3}}))
