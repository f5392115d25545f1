"""What is to be run: paired seeds, places of files, and what is kept of the first episode."""

from pathlib import Path

from lidarena.evaluation.runner import run_tasks
from lidarena.evaluation.tasks import Task, list_tasks, place_of
from tests.evaluation.fake_comparison import HERE, TWO, config_of


def test_every_policy_meets_the_same_seeds() -> None:
    tasks = list_tasks(config_of(*TWO), Path("videos"))
    assert [(task.policy.title, task.seed) for task in tasks] == [
        ("driver", 10),
        ("driver", 11),
        ("driver", 12),
        ("hesitant", 10),
        ("hesitant", 11),
        ("hesitant", 12),
    ]
    assert [episode.seed for episode in run_tasks(tasks, workers=1)] == [10, 11, 12] * 2


def test_an_environment_may_have_a_number_of_episodes_and_worlds_of_its_own() -> None:
    world = f"{HERE}:fake/Corridor-v0"
    many, one = {"id": world, "name": "many"}, {"id": world, "name": "one", "episodes": 1}
    config = config_of(TWO[0], envs=[many, one | {"keywords": {"reward": "of {seed}"}}])
    tasks = list_tasks(config, Path("videos"))
    assert [(task.env.label, task.seed) for task in tasks] == [("many", 10), ("many", 11), ("many", 12), ("one", 10)]
    assert tasks[-1].env.of_episode(10).keywords == {"reward": "of 10"}
    assert len(run_tasks(tasks, workers=1)) == 4


def test_only_the_first_episode_is_drawn_played_and_recorded() -> None:
    tasks = list_tasks(config_of(*TWO, videos="mp4", record=True), Path("out"))
    assert [task.keep_replay for task in tasks] == [True, False, False] * 2
    bags = [task.bag for task in tasks if task.policy.title == "driver"]
    assert bags == [Path("out/bags/Corridor/driver.mcap"), None, None]
    assert [task.keep_picture for task in tasks] == [True, False, False] * 2
    videos = {task.seed: task.video for task in tasks if task.policy.title == "hesitant"}
    assert videos == {10: Path("out/videos/Corridor/hesitant.mp4"), 11: None, 12: None}
    plain = list_tasks(config_of(*TWO, pictures=False, report=False), Path("out"))
    assert not any(task.keep_picture or task.video or task.keep_replay or task.bag for task in plain)


def test_names() -> None:
    config = config_of({"name": f"{HERE}:Driver", "label": "a/b c:d"})
    assert place_of(config.envs[0], config.policies[0], "png") == Path("Corridor/a-b-c-d.png")
    assert str(Task(config.envs[0], config.policies[0], 4)) == "environment 'Corridor', policy 'a/b c:d', seed 4"
