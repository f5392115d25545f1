"""Keywords of the workshop, checked at the border."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import Limits, check_range, options_of, plain
from lidarena.envs.common_keywords import CommonKeywords
from lidarena.envs.observers import ObservationSpec, choose_observer
from lidarena.envs.rewards import RewardSpec, choose_reward
from lidarena.envs.workshop.humans import EXTERNAL, HumanSpec, choose_human
from lidarena.envs.workshop.observations import OBSERVATIONS
from lidarena.envs.workshop.rewards import REWARDS
from lidarena.envs.workshop.task import WorkshopTask, load_task
from lidarena.envs.workshop.task_file import TaskConfig
from lidarena.world.robots import RobotSpec, gives_size, make_robot

TaskSpec = str | Mapping[str, Any] | TaskConfig | WorkshopTask
_LIMITS = Limits(
    choices={"render_mode": (None, "rgb_array"), "recognition": ("exact", "position")},
    ranges={"separation": (0.0, 3.0), "wait_period": (0.5, 600.0)},
    switches=("expose_truth",),
)
PATIENCE = 6.0
"""Deadlines after which an episode is cut off."""


class WorkshopKeywords(CommonKeywords, total=False):
    """The keywords of ``WorkshopOptions`` with their types, for editors and type checkers."""

    task: TaskSpec
    human: HumanSpec
    robot: RobotSpec | Mapping[str, Any] | str | None
    separation: float
    wait_period: float
    time_limit: float | None
    recognition: str


@dataclass(frozen=True)
class WorkshopOptions:
    """Keywords of ``lidarena/Workshop-v0``.

    Attributes:
        task: ``"pile"``, ``"gearbox"``, ``"cabinet"``, a YAML file of one's own, or what such a file holds, as a
            dictionary.
        human: ``"free"`` (any allowed action), ``"helpful"``, ``"stubborn"``, ``"slow"``, ``"absent"`` for a while,
            ``"mixture"`` (one of these, drawn for every episode), or one's own, see ``lidarena.envs.workshop.humans``.
        robot: A preset of :data:`lidarena.world.robots.ROBOTS`, changes to one such as ``{"max_speed": 1.0}``, or a
            ``RobotSpec``; None: the task's. It walks as a disc at ``max_speed``. Of an environment that was made: the
            ``RobotSpec``.
        separation: Distance between the surfaces of the two that is kept on the floor [m]. Where two block each other
            in a passage for 20 s it is given up, and ``info["separation"]`` tells.
        wait_period: Who waits is asked again when something happens, and after this time at the latest [s].
        time_limit: Truncates [s]; None: six deadlines or longest chains.
        recognition: ``"exact"`` tells what the human does; ``"position"`` what a hidden Markov model makes of the
            human's noisy position.
        observation: ``"features"``, or one's own, see ``lidarena.envs.observers``.
        reward: ``"default"``, ``"makespan"``, ``{term: weight}`` or a function; see ``lidarena.envs.rewards``.
        max_episode_steps: Decisions after which an episode is truncated; -1 never, None the usual 400.
        expose_truth: Give ``info["truth"]``, for evaluation.
        render_mode: None or ``"rgb_array"``.
    """

    task: TaskSpec = "pile"
    human: HumanSpec = "free"
    robot: RobotSpec = RobotSpec()  # noqa: RUF009 - frozen
    separation: float = 0.4
    wait_period: float = 5.0
    time_limit: float | None = None
    recognition: str = "exact"
    observation: ObservationSpec = "features"
    reward: RewardSpec = "default"
    max_episode_steps: int = 400
    expose_truth: bool = False
    render_mode: str | None = None

    @classmethod
    def checked(cls, keywords: Mapping[str, Any], external: bool = False) -> "WorkshopOptions":
        """Check keywords and fill in the defaults.

        Args:
            keywords: As given.
            external: Whether the human is an agent of PettingZoo.

        Raises:
            ConfigError: An unknown keyword, or a value out of range or of the wrong type; or a task that cannot be.
            MapError: A floor that cannot be used.
        """
        given = plain(keywords)
        options = options_of(cls, "a workshop environment", keywords, _LIMITS)
        choose_reward(options.reward, REWARDS)
        choose_observer(options.observation, OBSERVATIONS)
        if options.time_limit is not None:
            check_range("time_limit", options.time_limit, 1.0, 1e6)
        human = EXTERNAL if external else options.human
        if choose_human(human) == EXTERNAL and not external:
            raise ConfigError(f"human = {EXTERNAL!r} is for lidarena.envs.workshop_v0, where both decide")
        spec = options.task if isinstance(options.task, WorkshopTask) else _spec(options.task)
        task, robot = _with_robot(spec, given.get("robot"))
        return replace(options, task=task, robot=robot, human=human)


def _spec(value: Any) -> Any:
    return dict(value) if isinstance(value, Mapping) else value


def _with_robot(spec: Any, value: Any) -> tuple[WorkshopTask, RobotSpec]:
    """The task and its robot, which the keyword may change."""
    task = load_task(spec)
    default = RobotSpec(radius=task.radii[1], max_speed=task.speeds[1])
    robot = make_robot(value, default)
    if (robot.max_speed, robot.radius) != (task.speeds[1], task.radii[1]):
        radius = robot.radius if gives_size(value) else None
        source = task.config if isinstance(spec, WorkshopTask) else spec
        task = load_task(source, robot.max_speed, radius)
    return task, replace(robot, radius=task.radii[1], outline=())
