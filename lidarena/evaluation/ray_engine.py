"""Episodes on a Ray cluster. What a worker writes, such as a video, travels back with its episode."""

import tempfile
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import Any

from lidarena.base.folder_contents import Contents, read_contents, write_contents
from lidarena.base.ray_cluster import ray_results
from lidarena.evaluation.tasks import Task


@dataclass(frozen=True)
class ClusterAnswer:
    """What a worker sends back.

    Attributes:
        outcome: Of the episode.
        files: Their contents, by the place of the file or folder in the task and the path below it.
    """

    outcome: Any
    files: dict[str, Contents]


def cluster_outcomes(
    run: Callable[[Task], Any],
    tasks: Sequence[Task],
    address: str | None,
    cores: int | None,
    environment: dict[str, str],
) -> Iterator[tuple[int, Any]]:
    """Run tasks on a cluster and yield their outcomes as they end, with their files where the tasks want them.

    Args:
        run: Runs one; a function of a module.
        tasks: What to run.
        address: See ``ray_results``.
        cores: Of a cluster of this machine's own.
        environment: Variables of the workers' environment.

    Yields:
        Index of the task, and its outcome.

    Raises:
        ConfigError: See ``ray_results``.
        ClusterError: See ``ray_results``.
    """
    for index, answer in ray_results(partial(_answer, run), tasks, address, cores, environment):
        for place, files in answer.files.items():
            write_contents(Path(place), files)
        yield index, answer.outcome


def _answer(run: Callable[[Task], Any], task: Task) -> ClusterAnswer:
    """Run a task on a node, whose folders may be no one else's: what it writes goes into a folder of its own."""
    with tempfile.TemporaryDirectory() as folder:
        moved: dict[str, Any] = {
            kind: Path(folder) / kind / place.name
            for kind, place in (("video", task.video), ("bag", task.bag))
            if place is not None
        }
        outcome = run(replace(task, **moved))
        return ClusterAnswer(outcome, {str(getattr(task, kind)): read_contents(path) for kind, path in moved.items()})
