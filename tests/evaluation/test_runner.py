"""Many episodes: paired seeds, the same results on any number of processes, and failures in one sentence."""

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import LidarenaError
from lidarena.base.yaml_config import check_config
from lidarena.evaluation.comparison_config import ComparisonConfig
from lidarena.evaluation.episodes import Episode
from lidarena.evaluation.runner import EpisodeError, Task, available_cores, dry_run, list_tasks, place_of, run_tasks

HERE = "tests.evaluation.fake_world"


def config_of(*policies: dict[str, Any], **keys: Any) -> ComparisonConfig:
    envs = [{"id": f"{HERE}:fake/Corridor-v0", "name": "Corridor", "keywords": keys.pop("keywords", {})}]
    content = {"envs": envs, "policies": list(policies), "episodes": 3, "seed": 10, **keys}
    return check_config(content, ComparisonConfig)


TWO = (
    {"name": f"{HERE}:Driver", "label": "driver"},
    {"name": f"{HERE}:Driver", "label": "hesitant", "options": {"back": 0.3}},
)


def measured(episodes: list[Episode]) -> list[dict[str, float]]:
    """All measures but the clock's."""
    return [
        {name: value for name, value in episode.measures.items() if name != "decision_time" and not np.isnan(value)}
        for episode in episodes
    ]


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


def test_results_do_not_depend_on_the_number_of_processes() -> None:
    tasks = list_tasks(config_of(*TWO), Path("videos"))
    alone, done = run_tasks(tasks, workers=1), []
    together = run_tasks(tasks, workers=2, advance=done.append)
    assert measured(alone) == measured(together)
    assert {str(task) for task in done} == {str(task) for task in tasks}
    for one, other in zip(alone, together, strict=True):
        np.testing.assert_array_equal(one.progress.points, other.progress.points)  # type: ignore[union-attr]
    np.testing.assert_array_equal(alone[0].picture.true, together[0].picture.true)  # type: ignore[union-attr]


def test_results_do_not_depend_on_the_company() -> None:
    tasks = list_tasks(config_of(*TWO), Path("videos"))
    assert measured(run_tasks(tasks[4:5], workers=1)) == measured(run_tasks(tasks, workers=1))[4:5]


@pytest.mark.parametrize("workers", [1, 2])
def test_an_exception_becomes_a_sentence(workers: int) -> None:
    lost = {"name": f"{HERE}:Driver", "options": {"fail_at": 5}, "label": "lost"}
    tasks = list_tasks(config_of(TWO[0], lost), Path())
    with pytest.raises(EpisodeError) as caught:
        run_tasks(tasks, workers)
    sentence, report = str(caught.value), caught.value.report
    assert sentence.startswith("environment 'Corridor', policy 'lost', seed 1")
    assert sentence.endswith(": ZeroDivisionError: the driver lost its way")
    assert "fake_world.py" in report and "second line" in report


def test_a_process_that_dies_becomes_a_sentence() -> None:
    tasks = list_tasks(config_of({"name": f"{HERE}:Dying"}, episodes=2), Path())
    with pytest.raises(EpisodeError, match=r"too little memory; run fewer at once with --set workers=1"):
        run_tasks(tasks, workers=2)


def test_the_dry_run_finds_refusals_and_failures() -> None:
    dry_run(config_of(*TWO))
    with pytest.raises(
        LidarenaError, match="'Corridor', policy 'driver': there is no keyword 'slipp'; did you mean 'slip'"
    ):
        dry_run(config_of(*TWO, keywords={"slipp": 1}))
    with pytest.raises(EpisodeError, match="policy 'lost', seed 10: ZeroDivisionError"):
        dry_run(config_of({"name": f"{HERE}:Driver", "options": {"fail_at": 30}, "label": "lost"}))


def test_the_dry_run_is_short() -> None:
    dry_run(config_of({"name": f"{HERE}:Driver", "options": {"fail_at": 31}}))


def test_threads_are_given_back(monkeypatch: pytest.MonkeyPatch) -> None:
    torch = pytest.importorskip("torch")
    before = torch.get_num_threads()
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("MKL_NUM_THREADS", raising=False)
    torch.set_num_threads(2)
    try:
        run_tasks(list_tasks(config_of(TWO[0], episodes=1), Path()), workers=1)
        assert torch.get_num_threads() == 2
    finally:
        torch.set_num_threads(before)
    assert os.environ["OMP_NUM_THREADS"] == "7" and "MKL_NUM_THREADS" not in os.environ


def test_no_tasks_no_episodes() -> None:
    assert run_tasks([]) == []


def test_cores_and_names() -> None:
    assert 1 <= available_cores() <= (os.cpu_count() or 1)
    config = config_of({"name": f"{HERE}:Driver", "label": "a/b c:d"})
    assert place_of(config.envs[0], config.policies[0], "png") == Path("Corridor/a-b-c-d.png")
    assert str(Task(config.envs[0], config.policies[0], 4)) == "environment 'Corridor', policy 'a/b c:d', seed 4"
