"""The episodes of a comparison, before they are run."""

from dataclasses import dataclass, replace
from pathlib import Path

from lidarena.evaluation.comparison_config import ComparisonConfig, EnvEntry, PolicyEntry, file_name
from lidarena.evaluation.map_folders import MapCase


@dataclass(frozen=True)
class Task:
    """One episode to run.

    Attributes:
        env: The environment.
        policy: The policy.
        seed: Of the environment.
        keep_picture: Keep what pictures need.
        video: File of the video, if one is wanted.
        max_steps: Stop here; None leaves it to the environment.
        case: The map, of a folder of them.
        keep_replay: Keep what the report's player needs.
        bag: Folder of the rosbag, if one is wanted.
    """

    env: EnvEntry
    policy: PolicyEntry
    seed: int
    keep_picture: bool = False
    video: Path | None = None
    max_steps: int | None = None
    case: MapCase | None = None
    keep_replay: bool = False
    bag: Path | None = None

    def __str__(self) -> str:
        which = f"seed {self.seed}" if self.case is None else f"map {self.case.name!r}"
        return f"environment {self.env.label!r}, policy {self.policy.title!r}, {which}"


def list_tasks(config: ComparisonConfig, folder: Path) -> list[Task]:
    """Return every episode of a comparison; the first of each environment and policy is drawn and recorded.

    The first is fixed before anything is known about it: a picture of the best one would be advertising.

    Args:
        config: The comparison.
        folder: Of the results, for ``videos`` and ``bags``.
    """
    tasks = []
    for env in config.worlds:
        cases = config.cases(env)
        for policy in config.participants:
            for number, case in enumerate(cases):
                task = Task(env, policy, config.seed + number, case=case)
                tasks.append(_documented(task, config, folder) if number == 0 else task)
    return tasks


def _documented(task: Task, config: ComparisonConfig, folder: Path) -> Task:
    """The task with everything that is kept of a first episode."""
    video = folder / "videos" / place_of(task.env, task.policy, str(config.videos)) if config.videos else None
    bag = folder / "bags" / place_of(task.env, task.policy, "mcap") if config.record else None
    return replace(task, keep_picture=config.pictures, video=video, keep_replay=config.report, bag=bag)


def place_of(env: EnvEntry, policy: PolicyEntry, suffix: str) -> Path:
    """Return where a picture or video of an environment and a policy lies in its folder."""
    return Path(file_name(env.label)) / f"{file_name(policy.title)}.{suffix}"
