from lidarena.envs.exploration.goal_choice.explorers import discrete_driver, explorer_settings
from lidarena.envs.exploration.options import ExplorationOptions


def test_a_larger_robot_keeps_farther_off() -> None:
    small = discrete_driver(ExplorationOptions.checked({}), 0.05)
    large = discrete_driver(ExplorationOptions.checked({"robot": {"collision_distance": 0.2}}), 0.05)
    assert small.extra == 0.0 and abs(large.extra - 0.08) < 1e-12
    assert (large.margins - small.margins > 0.079).all() and abs(large.keep - small.keep - 0.08) < 1e-12


def test_seconds_become_steps() -> None:
    settings = explorer_settings(0.2, 1.0, 0.3, 4)
    assert (settings.every, settings.timeout, settings.patience, settings.fruitless) == (5, 150, 10, 600)
    assert (settings.least, settings.places, settings.period) == (0.3, 4, 0.2)
