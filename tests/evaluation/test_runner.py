"""Many episodes: paired seeds, the same results on any number of processes, and failures in one sentence."""

import os
from pathlib import Path

import numpy as np
import pytest

from lidarena.base.errors import LidarenaError
from lidarena.base.worker_processes import available_cores
from lidarena.evaluation.episodes import Episode
from lidarena.evaluation.runner import EpisodeError, dry_run, run_tasks
from lidarena.evaluation.tasks import list_tasks
from tests.evaluation.fake_comparison import HERE, TWO, config_of


def measured(episodes: list[Episode]) -> list[dict[str, float]]:
    """All measures but the clock's."""
    return [
        {name: value for name, value in episode.measures.items() if name != "decision_time" and not np.isnan(value)}
        for episode in episodes
    ]


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


def test_cores() -> None:
    assert 1 <= available_cores() <= (os.cpu_count() or 1)
