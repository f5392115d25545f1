"""The workshop: a robot that decides what to do next beside a human who does as it likes."""

from typing import Any, ClassVar, Unpack

import numpy as np
from numpy.typing import NDArray

from lidarena.base.keyword_checks import takes_keywords_of
from lidarena.envs.base_env import SingleWorld, entry_point
from lidarena.envs.base_vector_env import SAME_STEP, BatchedWorlds, Mode, whole_number_of_worlds
from lidarena.envs.workshop.episodes import WorkshopEpisodes
from lidarena.envs.workshop.options import WorkshopKeywords, WorkshopOptions
from lidarena.envs.workshop.rendering import draw_workshop
from lidarena.envs.workshop.task import WorkshopTask
from lidarena.world.floorplan import Floorplan


class WorkshopEnv(SingleWorld):
    """Do a task together with a human who chooses freely.

    ## Description

    The problem of Strassmair and Taylor, "Human Robot Collaboration in production environments": actions with a
    precedence graph, locations and bounds on their durations are to be done by a deadline. A human and a robot share
    the floor; both really walk on it, and keep a distance from each other, so that one in the other's way costs time.
    An action may be begun once all that must come before it is done or under way; the work at its last location waits
    until that is done. What is begun is carried out to its end. The human is simulated and chooses for itself; its
    durations are log-normal and may break the bounds. A step lasts until the robot's next decision is due: when its
    action has ended or, while it waits, when something happens.

    ## Action space

    ``Discrete(n + 1)`` for a task of n actions: number k begins action k, number n waits. ``action_masks()`` and
    ``info["action_mask"]`` tell what is allowed; anything else stands for waiting, and ``info["refused"]`` counts it.

    ## Observation space

    ``Box(-10, 10, (15 n + 14,), float32)``. For each action: whether it is open, under way by the robot, under way by
    the human, allowed for the robot, allowed for the human; the time until all that hangs on it is done over the
    deadline; of the robot and then of the human the time of the ways / 20 s and the usual time of the work / 30 s,
    zeros for who cannot do it; since when it is under way / 30 s, whether the work at its last location has begun, how
    many actions it waits for / 3, how often the human has begun something else / 3 and rested / 3 while it was allowed
    to do this. Of the whole: time over deadline; whether the human is idle, walks, waits, works,
    is away; its pace (time over the usual) and how many actions it has shown it in / 5; the share of the actions that
    is left, the longest chain of work that is left over the deadline, the distance between the two / 10 m, whether the
    robot is idle, the human's idle time over the deadline, whether the robot waits at a location. Or an observer of
    one's own, see ``lidarena.envs.observers``.

    ## Rewards

    The sum of these terms, each times its weight; ``info["reward_terms"]`` holds them by name. ``reward`` takes a
    preset, weights by term, or a function of one's own, see ``lidarena.envs.rewards``.

    | Term | Value | `default` | `makespan` |
    |------|-------|------|------|
    | time | minus the seconds of the step over the deadline | 10 | 10 |
    | completion | 1 when everything is done | 1 | |
    | deadline | 1 when everything is done in time | 1 | |
    | robot_idle | minus the robot's idle seconds over the deadline | 0 | |
    | human_idle | minus the human's idle seconds over the deadline | 0 | |
    | unfinished | minus the share of the actions that is left when the time is up | 10 | 10 |

    ## Starting state

    Both stand at their homes; the human has chosen its first action.

    ## Episode end

    - Termination: everything is done (``success``), however late.
    - Truncation: after ``time_limit`` seconds, or ``max_episode_steps`` (400) decisions.

    ## Info

    Arrays of two are of human and robot. ``time`` [s], ``duration`` of the step [s], ``action_mask`` (n + 1,),
    ``pose`` (2, 3), ``path_length`` (2,) [m], ``radius`` of the robot [m], ``collision`` (they have touched),
    ``success``; ``doing`` (2,) number of an action or -1, ``phase`` (2,) 0 idle, 1 walking, 2 waiting at a location, 3
    working, 4 away, ``since`` (2,) for how long [s], ``stop`` (2,) at which of the action's locations,
    ``human_present``; of the actions ``status`` (n,) 0 open, 1 under way, 2 done, ``agent`` (n,) 0 human, 1 robot, -1
    nobody, ``begun``, ``placed`` (the work at the last location), ``ended`` (n,) [s], ``worked`` (n,) time of the work
    once it is done [s], all -1 before that, ``allowed_human`` and ``allowed_robot`` (n,); ``unplanned``, how many
    actions were done against the task, ``refused``. Measures so far: ``completion``, ``makespan`` [s],
    ``deadline_met``, ``human_idle``, ``robot_idle`` and ``concurrent`` as shares of the time (walking is not idling),
    ``functional_delay`` over the time, ``bounds_broken``, the share of the human's actions, ``separation``, the least
    distance between the two [m]. ``reward_terms``. With ``expose_truth=True`` ``truth``, for evaluation.

    ## Arguments

    In full: ``WorkshopOptions``.

    | Name | Type | Default | Meaning |
    |------|------|---------|---------|
    | `task` | str, dict or task | `"pile"` | `"gearbox"`, `"cabinet"`, or a YAML file of one's own |
    | `human` | str or human | `"free"` | `"helpful"`, `"stubborn"`, `"slow"`, `"absent"`, `"mixture"`; one's own |
    | `robot` | str, dict or spec | `None` | a preset, changes to one, or a ``RobotSpec``; None: the task's |
    | `separation` | float | `0.4` | distance between the two that is kept [m] |
    | `wait_period` | float | `5.0` | who waits is asked again after this time at the latest [s] |
    | `time_limit` | float or None | `None` | truncates [s]; None: six deadlines or longest chains |
    | `recognition` | str | `"exact"` | `"position"`: the human's action is guessed from its position |
    | `observation` | str or observer | `"features"` | what is seen, see above |
    | `reward` | str, dict or function | `"default"` | what a step is worth, see above |
    | `max_episode_steps` | int | `400` | decisions after which it truncates; -1 never |
    | `expose_truth` | bool | `False` | give ``info["truth"]``, for evaluation |
    | `render_mode` | str or None | `None` | or `"rgb_array"` |

    ## References

    Strassmair and Taylor, Human Robot Collaboration in production environments, 2014. Hoffman, Evaluating Fluency in
    Human-Robot Collaboration, 2019.

    ## Version History

    - v0: since Lidarena 0.2.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 2}  # noqa: RUF012 - as gym.Env has it
    family = "workshop"

    @takes_keywords_of(WorkshopOptions)
    def __init__(self, **keywords: Unpack[WorkshopKeywords]) -> None:
        """Make one world; the keywords are those of ``WorkshopOptions``.

        Raises:
            ConfigError: A keyword that is unknown or out of range, or a task that cannot be.
            MapError: A floor that cannot be used.
        """
        super().__init__(WorkshopEpisodes(1, WorkshopOptions.checked(keywords)))

    @property
    def task(self) -> WorkshopTask:
        """What is to be done."""
        task: WorkshopTask = self.episodes.core.task
        return task

    @property
    def floorplan(self) -> Floorplan:
        """The floor, for pictures."""
        return self.task.plan

    @property
    def moments(self) -> list[float]:
        """Times within the last step of which there are pictures, for a film [s]."""
        times: list[float] = self.episodes.moments(0)
        return times

    def render_at(self, time: float) -> NDArray[np.uint8]:
        """The picture of one of the ``moments``."""
        return draw_workshop(self.episodes.core, 0, time)

    def action_masks(self) -> NDArray[np.bool_]:
        """What is allowed (n + 1,), as sb3-contrib's MaskablePPO asks for it."""
        return np.asarray(self.episodes.action_masks()[0])


class BatchedWorkshop(BatchedWorlds):
    """``num_envs`` workshops in one step; world ``i`` is ``WorkshopEnv`` with seed ``seed + i`` to the bit.

    All worlds run at once until each needs its next decision. See ``BatchedWorlds``; spaces, rewards and keywords:
    ``WorkshopEnv``.

    Args:
        num_envs: Number of worlds.
        autoreset_mode: What happens where an episode has ended, see ``BatchedWorlds``.
        keywords: Those of ``WorkshopOptions``.
    """

    metadata: ClassVar[dict[str, Any]] = BatchedWorlds.metadata | {"render_fps": 2}  # type: ignore[misc]
    family = "workshop"

    @takes_keywords_of(WorkshopOptions)
    def __init__(
        self, num_envs: int = 1, autoreset_mode: Mode = SAME_STEP, **keywords: Unpack[WorkshopKeywords]
    ) -> None:
        """Make the worlds; raises like ``WorkshopEnv``."""
        worlds = whole_number_of_worlds(num_envs)
        super().__init__(WorkshopEpisodes(worlds, WorkshopOptions.checked(keywords)), autoreset_mode)

    @property
    def task(self) -> WorkshopTask:
        """What is to be done."""
        task: WorkshopTask = self.episodes.core.task
        return task

    def action_masks(self) -> NDArray[np.bool_]:
        """What is allowed in every world (num_envs, n + 1)."""
        return np.asarray(self.episodes.action_masks())


make_single = entry_point(WorkshopEnv)
