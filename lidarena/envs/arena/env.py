"""Goal reaching: a robot at constant speed among obstacles, which it sees with a lidar or knows beforehand."""

from typing import Any, ClassVar, Unpack

import numpy as np
from gymnasium.error import ResetNeeded
from numpy.typing import NDArray

from lidarena.base.keyword_checks import takes_keywords_of
from lidarena.envs.arena.episodes import ArenaEpisodes
from lidarena.envs.arena.options import ArenaKeywords, ArenaOptions
from lidarena.envs.base_env import SingleWorld, entry_point
from lidarena.envs.base_vector_env import SAME_STEP, BatchedWorlds, Mode, whole_number_of_worlds
from lidarena.world.floorplan import Floorplan


class ArenaEnv(SingleWorld):
    """Reach a goal among obstacles at constant speed.

    ## Description

    The world of Yang et al., "A New Method for Robot Path Planning Based Artificial Potential Field": a room of 100 m
    with circular obstacles, a start and a goal. The robot is a disc that moves at constant speed in a heading that it
    chooses anew in every decision period; rigid bodies are pymunk's. The BARN worlds and floor plans keep their own
    size: what is not given as a keyword is to scale, a power of ten.

    ## Action space

    The turn to the left before the next step, by which the robot then drives straight on for one decision period.

    - ``action="continuous"``, ``Box(-1, 1, (1,), float32)``: the turn over π.
    - ``action="discrete"``, ``Discrete(16)``: number k turns by k · 22.5 degrees.

    With ``guard=True`` a heading that leads to contact within a step, as far as the lidar has shown, gives way to the
    nearest one that stays free (see ``lidarena.envs.arena.guard``).

    ## Observation space

    ``Box(float32, (beams + 3,))``, in the robot's frame:

    | Num | Observation | Min | Max |
    |-----|-------------|-----|-----|
    | 0 … beams - 1 | lidar, the first beam straight ahead, counter-clockwise; see below | 0 | 1 |
    | beams | distance to the goal over 150 m (to scale), at most 1 | 0 | 1 |
    | beams + 1, + 2 | cosine and sine of the goal's bearing | -1 | 1 |

    ``observation="ranges"`` gives beams over the longest range, ``"proximity"`` the robot's radius over the beam;
    or an observer of one's own, see ``lidarena.envs.observers``. ``"way"`` is ``"proximity"`` with 19 numbers more, for
    which the robot keeps a map of what its beams have met since the episode began (unknown is free; what beams have
    passed since is forgotten) and finds its way through it anew where something has come in between:

    | Num | Observation | Min | Max |
    |-----|-------------|-----|-----|
    | beams + 3 | length of the way to the goal over 150 m (to scale), at most 1 | 0 | 1 |
    | beams + 4, + 5 | cosine and sine of the bearing of a point on the way up to 7 steps ahead | -1 | 1 |
    | beams + 6 … + 21 | how soon each of 16 headings leads to contact: 0 not in 8 steps, 1 at once | 0 | 1 |

    The headings begin straight ahead, counter-clockwise; what the beams meet is taken to move on as it did from scan to
    scan, and what the map has stands.

    ## Rewards

    The sum of these terms, each times its weight; ``info["reward_terms"]`` holds them by name. ``reward`` takes
    ``"default"``, weights by term (``{"preset": "default", "turn": 1.0}`` changes some), or a function of one's own,
    see ``lidarena.envs.rewards``.

    | Term | Value | `default` |
    |------|-------|------|
    | progress | approach to the goal over the length of a step | 1 |
    | success | 1 where the goal is reached | 10 |
    | collision | -1 where something is touched | 10 |
    | time | -1 | 0.1 |
    | clearance | from 0 at two steps' length from the nearest surface to -1 at contact | 0 |
    | turn | -1 for half a turn | 0 |
    | way | approach to the point that ``"way"`` showed before the step, over the length of a step | 0 |

    ## Starting state

    The arena's own start, or ``start=(x, y)``, heading for the goal. Families (``"random"``, ``"u_trap"``,
    ``"barn"``) give another arena in every episode, see ``ArenaOptions.pick``.

    ## Episode end

    - Termination: the robot touches something (``collision``), or is within ``goal_radius`` of the goal (``success``).
    - Truncation: after ``max_episode_steps`` (500) steps.

    ## Info

    ``pose`` (3,), ``goal`` (2,), ``distance`` to it [m], ``scan`` (beams,) ranges [m], ``path_length`` [m],
    ``clearance`` [m], the least distance between the robot and anything on the last step, ``time`` [s], ``collision``,
    ``success``, ``radius`` of the robot [m], ``reward_terms``. With ``knowledge="map"``, for planners that know the
    world: ``circles`` (K, 3) x, y, radius, which cover the edges of a floor plan, and ``bounds`` (4,) x_min, y_min,
    x_max, y_max [m], and where obstacles move ``moving`` (M, 5) x, y, velocity, radius. Where the robot keeps a map
    (``observation="way"``, a weight of ``way``, or ``guard``) ``lookahead_point`` (2,) and ``way_length`` [m].
    With ``expose_truth=True`` ``truth``: ``circles``, ``bounds``, ``pose``, ``path_length`` and ``optimal_time``
    (BARN's, [s]; infinite elsewhere), for evaluation.

    Gymnasium's own ``SyncVectorEnv`` and ``AsyncVectorEnv`` stack the infos of their worlds, which cannot be done with
    ``circles`` where arenas have different numbers of them: take ``make_vec``'s ``vector_entry_point``, or
    ``knowledge="lidar"``.

    ## Arguments

    In full: ``ArenaOptions``.

    | Name | Type | Default | Meaning |
    |------|------|---------|---------|
    | `arena` | str, arena, plan, generator or list | `"random"` | where: one, a family, or a list of these |
    | `density` | float or list | `0.15` | share of the room that circles of `"random"` arenas cover |
    | `path` | str or None | `None` | the BARN file, for `"barn"` arenas |
    | `moving` | int, dict or spec | `None` | obstacles that move: number, speed, radius, kind; see ``MovingSpec`` |
    | `start` | (x, y) or None | `None` | instead of the arena's own [m] |
    | `goal` | (x, y) or None | `None` | instead of the arena's own [m]; a floor plan has none |
    | `arenas` | int | `4096` | how many different arenas of a family episodes draw from |
    | `pick` | str | `"random"` | which arena a reset takes; `"by_seed"` the one of its seed |
    | `solvable` | bool | `False` | pass over `"random"` arenas in which A* finds no path |
    | `action` | str | `"continuous"` | or `"discrete"` |
    | `observation` | str or observer | `"ranges"` | what is seen, see above |
    | `robot` | str, dict or spec | `None` | a preset, changes to one, or a ``RobotSpec``; None: the arena's own |
    | `lidar` | str, dict or spec | `None` | the same with a ``LidarSpec``; None: 36 beams of 30 m, to scale |
    | `guard` | bool | `False` | it turns aside before what its lidar has shown, see above |
    | `knowledge` | str | `"map"` | obstacles in the info; `"lidar"` only what the lidar sees |
    | `decision_period` | float or None | `None` | time between decisions [s]; None: 1 s, to scale |
    | `goal_radius` | float or None | `None` | distance at which the goal is reached [m]; None: 1 m, to scale |
    | `max_episode_steps` | int | `500` | truncates; -1 never |
    | `reward` | str, dict or function | `"default"` | what a step is worth, see above |
    | `expose_truth` | bool | `False` | give ``info["truth"]``, for evaluation |
    | `field` | str | `"robust"` | whose potential the picture shows |
    | `render_mode` | str or None | `None` | or `"rgb_array"` |

    ## References

    Yang, Yang, Zhang, Chang, Chen, Zhang, A New Method for Robot Path Planning Based Artificial Potential Field, ICIEA
    2016. Perille, Truong, Xiao, Stone, Benchmarking Metric Ground Navigation, SSRR 2020.

    ## Version History

    - v0: since Lidarena 0.1. Since 0.2 weights of the reward are given in ``reward``, and the info's ``robot_radius``
      is called ``radius``.
    """

    metadata: dict[str, Any] = {"render_modes": ["rgb_array"], "render_fps": 10}  # noqa: RUF012 - as gym.Env has it
    family = "arena"

    @takes_keywords_of(ArenaOptions)
    def __init__(self, **keywords: Unpack[ArenaKeywords]) -> None:
        """Make one world; the keywords are those of ``ArenaOptions``.

        Raises:
            ConfigError: A keyword that is unknown or out of range.
            MapError: An arena that cannot be used, or whose start or goal is in an obstacle.
        """
        super().__init__(ArenaEpisodes(1, ArenaOptions.checked(keywords)))

    @property
    def floorplan(self) -> Floorplan:
        """The arena as it is drawn, for pictures."""
        scenario = self.episodes.core.scenarios[0]
        if scenario is None:
            raise ResetNeeded("there is no arena before reset()")
        plan: Floorplan = scenario.plan
        return plan

    @property
    def step_length(self) -> float:
        """What the robot drives in a decision period [m]."""
        return float(self.episodes.core.step_length)

    def show(self, plan: NDArray[np.float64], before: NDArray[np.float64] | None = None) -> None:
        """Let a policy's plan be seen in the picture until its next one, in place of the field's own.

        Args:
            plan: (S, 2) [m].
            before: (M, 2) the plan before it was smoothed, along which the picture shows forces [m].
        """
        if self.episodes.recorder is not None:
            self.episodes.recorder.show(0, plan, before)


class BatchedArena(BatchedWorlds):
    """``num_envs`` arenas in one step; world ``i`` is ``ArenaEnv`` with seed ``seed + i`` to the bit.

    See ``BatchedWorlds``; spaces, rewards and keywords: ``ArenaEnv``.

    Args:
        num_envs: Number of worlds.
        autoreset_mode: What happens where an episode has ended, see ``BatchedWorlds``.
        keywords: Those of ``ArenaOptions``.
    """

    metadata: ClassVar[dict[str, Any]] = BatchedWorlds.metadata | {"render_fps": 10}  # type: ignore[misc]
    family = "arena"

    @takes_keywords_of(ArenaOptions)
    def __init__(self, num_envs: int = 1, autoreset_mode: Mode = SAME_STEP, **keywords: Unpack[ArenaKeywords]) -> None:
        """Make the worlds; raises like ``ArenaEnv``."""
        worlds = whole_number_of_worlds(num_envs)
        super().__init__(ArenaEpisodes(worlds, ArenaOptions.checked(keywords)), autoreset_mode)

    @property
    def step_length(self) -> float:
        """What a robot drives in a decision period [m]."""
        return float(self.episodes.core.step_length)


make_single = entry_point(ArenaEnv)
