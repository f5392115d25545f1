from typing import Any

import pytest

from lidarena.base.errors import ConfigError
from lidarena.envs.workshop.options import WorkshopOptions
from lidarena.envs.workshop.task import WorkshopTask, load_task
from lidarena.world.robots import RobotSpec
from tests.envs.workshop.workshops import loose


def test_options_hold_the_task_and_the_robot() -> None:
    options = WorkshopOptions.checked({})
    assert isinstance(options.task, WorkshopTask) and options.task.name == "pile"
    assert (options.robot.max_speed, options.robot.radius) == (0.7, 0.25) and options.max_episode_steps == 400
    assert WorkshopOptions.checked({"task": load_task("gearbox")}).task.name == "gearbox"


def test_the_robot_may_be_changed() -> None:
    quick = WorkshopOptions.checked({"robot": {"max_speed": 1.5}, "task": loose(2)})
    assert quick.task.speeds == (1.0, 1.5) and quick.robot.max_speed == 1.5
    small = WorkshopOptions.checked({"robot": RobotSpec(radius=0.1, max_speed=0.4)})
    assert small.task.radii == (0.25, 0.1)
    again = WorkshopOptions.checked({"robot": {"max_speed": 1.5}, "task": load_task(loose(2))})
    assert again.task.speeds == (1.0, 1.5)


@pytest.mark.parametrize(
    ("keywords", "message"),
    [
        ({"taks": "pile"}, "did you mean 'task'"),
        ({"task": "piles"}, "did you mean 'pile'"),
        ({"human": "freee"}, "did you mean 'free'"),
        ({"human": "external"}, "workshop_v0"),
        ({"separation": -1}, "separation = -1"),
        ({"wait_period": 0}, "wait_period = 0"),
        ({"time_limit": 0}, "time_limit = 0"),
        ({"recognition": "guess"}, "recognition"),
        ({"reward": {"tiem": 1}}, "did you mean 'time'"),
        ({"robot": {"max_speed": -1}}, "robot.max_speed"),
        ({"max_episode_steps": 0}, "max_episode_steps"),
        ({"expose_truth": 1}, "expose_truth"),
        ({"observation": "pixels"}, "observation"),
    ],
)
def test_bad_keywords_are_refused_in_one_sentence(keywords: dict[str, Any], message: str) -> None:
    with pytest.raises(ConfigError, match=message) as refusal:
        WorkshopOptions.checked(keywords)
    assert "\n" not in str(refusal.value)
