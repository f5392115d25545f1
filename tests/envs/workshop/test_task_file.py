"""What a task file may hold, and what is refused in one sentence."""

import copy
from pathlib import Path
from typing import Any

import pytest
import yaml

from lidarena.base.errors import ConfigError
from lidarena.envs.workshop.task_file import built_in, middle, read_task
from tests.envs.workshop.workshops import chain


def changed(**more: Any) -> dict[str, Any]:
    return copy.deepcopy(chain(3)) | more


def test_the_package_brings_the_pile_and_two_larger_tasks() -> None:
    assert built_in() == ("cabinet", "gearbox", "pile")
    pile = read_task("pile")
    assert list(pile.actions) == ["cube_1", "cube_2", "cube_3", "cube_4", "triangle"]
    assert len([name for name in pile.locations if name.startswith("storage")]) == 5
    for name in ("gearbox", "cabinet"):
        task = read_task(name)
        assert 8 <= len(task.actions) <= 12
        assert max(len(action.after) for action in task.actions.values()) >= 2


def test_a_file_of_ones_own_is_read(tmp_path: Path) -> None:
    file = tmp_path / "mine.yaml"
    file.write_text(yaml.safe_dump(chain(3)))
    assert read_task(str(file)) == read_task(chain(3))
    assert read_task(read_task("pile")) is not None


def with_action(name: str, **more: Any) -> dict[str, Any]:
    task = changed()
    task["actions"][name] |= more
    return task


@pytest.mark.parametrize(
    ("task", "message"),
    [
        (with_action("part_0", after=["part_2"]), "cycle: part_0 → part_1 → part_2 → part_0|cycle: .*part_1 → part_2"),
        (with_action("part_1", after=["part_1"]), "cycle: part_1 → part_1"),
        (with_action("part_1", at=["shelf"]), "'part_1' is at 'shelf', which is no location"),
        (with_action("part_1", at=[]), "at"),
        (with_action("part_1", after=["prat_0"]), "did you mean 'part_0'"),
        (with_action("part_1", duration={"human": [9, 4]}), r"\[9, 4\], where 0 < lower <= upper"),
        (with_action("part_1", duration={"robto": [4, 9]}), "no agent 'robto'; did you mean 'robot'"),
        (with_action("part_1", duration={}), "duration"),
        (with_action("part_1", shares=[0.5]), "one for each location"),
        (changed(deadline=-1), "deadline"),
        (changed(deadlien=3), "deadline"),
        (changed(agents={"human": {"home": [1, 1], "speed": 1}}), "robot"),
        (changed(floor={"bounds": [0, 0, 1, 1], "map": "env1"}), "either"),
        (changed(constraints=[{"from": "part_9.end", "to": "part_1.end", "upper": 3}]), "part_9.end"),
        (changed(constraints=[{"from": "part_0.middle", "to": "part_1.end", "upper": 3}]), "'part_0.start' or"),
        (changed(constraints=[{"from": "part_0.end", "to": "part_1.end"}]), "'lower' or 'upper'"),
        (changed(constraints=[{"from": "part_0.end", "to": "part_1.end", "lower": 5, "upper": 3}]), "above the upper"),
        ("plie", "did you mean 'pile'"),
        ("nowhere.yaml", "nowhere.yaml"),
        (7, "task = 7"),
    ],
)
def test_bad_tasks_are_refused_in_one_sentence(task: Any, message: str) -> None:
    with pytest.raises(ConfigError, match=message) as refusal:
        read_task(task)
    assert "\n" not in str(refusal.value)


def test_the_usual_duration_is_the_geometric_mean_of_the_bounds() -> None:
    assert middle([4.0, 9.0]) == pytest.approx(6.0)
