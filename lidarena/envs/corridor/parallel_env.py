"""The multi-robot environment for PettingZoo: ``parallel_env`` and ``env``.

from lidarena.envs import corridor_v0

fleet = corridor_v0.parallel_env(map="office", robots=4)
"""

from dataclasses import fields
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray
from pettingzoo import AECEnv
from pettingzoo.utils import parallel_to_aec, wrappers

from lidarena.base.errors import ActionError
from lidarena.base.keyword_checks import takes_keywords_of
from lidarena.envs.action_bounds import within_bounds
from lidarena.envs.base_parallel_env import Observations, Outcomes, ParallelWorld, check_cycles
from lidarena.envs.corridor.drawing import draw_world
from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.options import CorridorKeywords, CorridorOptions, modern_keywords
from lidarena.envs.corridor.rendering import TeamSketch
from lidarena.envs.infos import Info, of_world
from lidarena.world.floorplan import Floorplan

__all__ = ["CorridorEnv", "agent_name", "env", "parallel_env", "raw_env"]

_KEYWORDS = [field.name for field in fields(CorridorOptions) if field.name != "max_episode_steps"]


def agent_name(robot: int) -> str:
    """What PettingZoo calls a robot."""
    return f"robot_{robot}"


class CorridorEnv(ParallelWorld):
    """Robots share a building; each must reach its goal without touching a wall or another robot.

    ## Description

    Up to 64 discs with a differential drive (0.105 m radius, 0.5 m/s, 2 rad/s) drive in a floor plan, each to a goal of
    its own. They really collide (pymunk). Their wheels do not quite obey (see ``corridor_kernels.apply_motion_noise``);
    each has a lidar that sees walls and the other robots, knows the map, and knows its pose in it to 2 cm. The problem,
    and the floor plans ``office``, ``unstructured``, ``passing`` and ``blocked``, are those of Bennewitz & Burgard
    (2000). The agents are ``robot_0``, ``robot_1``, …

    ## Action space

    ``action="continuous"``, ``Box(-1, 1, (2,), float32)``: speed 0.5 a₀ m/s (negative: backwards) and turn rate 2 a₁
    rad/s, for one decision period of 0.2 s. ``action="discrete"``, ``Discrete(7)``:

    | Num | Action | speed [m/s] | turn rate [rad/s] |
    |-----|------------|------|------|
    | 0   | stop       | 0    | 0    |
    | 1   | forward    | 0.5  | 0    |
    | 2   | left       | 0.4  | 1    |
    | 3   | right      | 0.4  | -1   |
    | 4   | turn left  | 0    | 1.5  |
    | 5   | turn right | 0    | -1.5 |
    | 6   | back       | -0.2 | 0    |

    With ``guard=True`` a robot slows down by itself: in one period it uses up at most half of the room to whatever its
    lidar shows, and where that holds it up it turns aside (see ``lidarena.envs.corridor.guard``).

    ## Observation space

    ``Box(-1, 1, (beams + 8 + 5 · neighbours,), float32)``; n is the number of beams (36):

    | Num | Observation |
    |-----|-------------|
    | 0 … n-1 | the beams over the longest range (3.5 m), the first one straight ahead, counter-clockwise |
    | n, n+1  | the goal's bearing in the robot's frame: cos, sin |
    | n+2     | d / (d + 2 m) of the straight distance d to it |
    | n+3, n+4 | own speed / 0.5 m/s, own turn rate / 2 rad/s |
    | n+5, n+6 | the bearing of a point some 0.8 m ahead on the robot's shortest way through the map: cos, sin |
    | n+7     | l / (l + 2 m) of the length l of that way |
    | n+8 … n+12 | with ``neighbours``, of the nearest robot: bearing cos, sin; d / (d + 2 m); relative velocity |
    | …       | the same of the next ones |

    The relative velocity has two parts, along and across the robot's heading, over 1 m/s.
    The way is that of one robot alone: it knows of no other robot.

    ## Rewards

    The sum of these terms, each times its weight; ``info["reward_terms"]`` holds them by name. ``reward`` takes
    ``"default"``, weights by term (``{"preset": "default", "turning": 1.0}`` changes some), or a function of one's own,
    which is asked about each robot on its way, see ``lidarena.envs.rewards``.

    | Term | Value | `default` |
    |------|-------|------|
    | progress | metres by which the way to the goal became shorter | 1 |
    | arrival | 1 on arrival | 10 |
    | collision | -1 where something is touched | 10 |
    | time | minus the seconds | 0.1 |
    | closeness | minus the seconds times max(0, 1 - gap / 2 radii), of the gap to the nearest thing | 0 |
    | turning | minus the radians turned | 0 |

    ## Starting state

    At rest, at the places that ``places`` names, heading along the shortest way. Places that are drawn can be solved:
    every robot has a way clear of everybody else's start and goal (a well-formed problem) or, where so many robots
    leave no room for that, a planner has found a plan.

    ## Episode end

    - Termination of an agent: it is within ``goal_tolerance`` of its goal, or, with ``collision_ends``, it touched
      something. It stays where it is and is in the others' way.
    - Truncation of all agents: after ``max_cycles`` (1000) steps.

    ## Info

    By agent: ``pose`` (3,) as localisation gives it, ``goal`` (2,), ``remaining`` length of its way [m], ``success``
    (it has arrived), ``collision``, ``path_length`` [m], ``time`` [s]; ``reward_progress`` and so on, the terms one by
    one, which ``info["reward_terms"]`` gathers; ``map`` (rows, columns) int8 with 0 free, 100 occupied,
    ``clearance`` (rows, columns) from the cells' centres to the nearest wall [m], their ``resolution`` [m],
    ``origin`` (2,), ``radius`` of the robots [m], ``scan`` (beams,) measured ranges [m].

    ## Arguments

    In full: ``CorridorOptions``.

    | Name | Type | Default | Meaning |
    |------|------|---------|---------|
    | `max_cycles` | int | `1000` | truncates; -1 never |
    | `map` | str, plan or generator | `"office"` | floor plan |
    | `robots` | int | `4` | size of the team |
    | `places` | str or None | `None` | `"predefined"`, `"random"` or a `.scen` file; None: predefined if it can be |
    | `starts` | (robots, 2) or None | `None` | x, y [m] in place of `places`; with `goals` |
    | `goals` | (robots, 2), str or None | `None` | x, y [m]; `"lifelong"`: new ones on arrival |
    | `action` | str | `"continuous"` | or `"discrete"` |
    | `robot` | str, dict or spec | `None` | a preset, changes to one, or a ``RobotSpec``; None: TurtleBot3 Burger |
    | `lidar` | str, dict or spec | `None` | the same with a ``LidarSpec``; None: 36 beams of 3.5 m, 1 cm of noise |
    | `neighbours` | int | `0` | how many of the nearest robots tell where they are and how they move |
    | `guard` | bool | `False` | robots slow down and turn aside before what their lidar shows |
    | `motion_noise` | float | `1.0` | factor on the noise of the wheels; 0: they obey |
    | `localization_noise` | float | `0.02` | standard deviation of the poses in the info [m], [rad] |
    | `stall_rate` | float | `0.0` | how often a robot is held up for some 3 s [1/s] |
    | `decision_period` | float | `0.2` | time between decisions [s] |
    | `goal_tolerance` | float | `0.15` | distance from the goal at which a robot has arrived [m] |
    | `collision_ends` | bool | `True` | whether a robot that touches something is finished |
    | `observation` | str or observer | `"ranges"` | what each robot sees, see above |
    | `reward` | str, dict or function | `"default"` | what a step of each robot is worth, see above |
    | `expose_truth` | bool | `False` | give ``info["truth"]``, for evaluation |
    | `render_mode` | str or None | `None` | or `"rgb_array"`, `"human"` |

    ## References

    Bennewitz & Burgard, A probabilistic method for planning collision-free trajectories of multiple mobile robots,
    2000.

    ## Version History

    - v0: since Lidarena 0.1. Since 0.2 weights of the reward are given in ``reward``, and the info calls
      ``arrived`` ``success`` and tells the terms of the reward one by one.
    """

    metadata: dict[str, Any] = {  # noqa: RUF012 - as PettingZoo declares it
        "name": "corridor_v0",
        "render_modes": ["rgb_array", "human"],
        "render_fps": 5,
        "is_parallelizable": True,
    }
    family = "corridor"

    @takes_keywords_of(CorridorOptions, without=["max_episode_steps"])
    def __init__(self, max_cycles: int | None = None, **keywords: Unpack[CorridorKeywords]) -> None:
        """Make one world.

        Args:
            max_cycles: Steps after which an episode is truncated; None is 1000, -1 never.
            **keywords: Those of ``CorridorOptions``.

        Raises:
            LidarenaError: A keyword, floor plan, start or goal that cannot be had.
        """
        modern = modern_keywords(keywords)
        check_cycles("corridor_v0", max_cycles, modern, _KEYWORDS)
        options = CorridorOptions.checked({**modern, "max_episode_steps": max_cycles})
        teams = CorridorEpisodes(1, options)
        names = [agent_name(robot) for robot in range(options.robots)]
        super().__init__(teams, names, teams.observation_space, teams.action_space)

    @property
    def floorplan(self) -> Floorplan:
        """The floor plan, for pictures."""
        plan: Floorplan = self.episodes.core.plan
        return plan

    def step(self, actions: dict[str, Any]) -> Outcomes:
        """Act for one decision period.

        Args:
            actions: One for every agent in ``agents``.

        Raises:
            ActionError: An action that is missing, of an unknown or finished agent, NaN, out of range, or of the wrong
                shape or type.
            ResetNeeded: The environment was not reset, or its episode has ended.
        """
        self._check_agents(actions)
        everyone = np.zeros((1, len(self.possible_agents), 2)) if self.options.action == "continuous" else None
        table = np.zeros((1, len(self.possible_agents)), np.int64) if everyone is None else everyone
        for name, action in actions.items():
            table[0, self._numbers[name]] = self._checked(name, action)
        rewards, terminated, truncated = self.episodes.step(table)
        agents = self.agents
        self.agents = [n for n in agents if not (terminated[0, self._numbers[n]] or truncated[0, self._numbers[n]])]
        gains = {name: float(rewards[0, self._numbers[name]]) for name in agents}
        ended = {name: bool(terminated[0, self._numbers[name]]) for name in agents}
        cut_off = {name: bool(truncated[0, self._numbers[name]]) for name in agents}
        return self._observations(agents), gains, ended, cut_off, self._infos(agents)

    def _how_finished(self, name: str) -> str:
        arrived = self.episodes.arrived[0, self._numbers[name]]
        return f", it has {'arrived' if arrived else 'collided'}; actions are needed for {', '.join(self.agents)}"

    def _checked(self, name: str, action: Any) -> NDArray[np.generic]:
        """An agent's action, refused here under its name rather than later among all."""
        space = self._action_spaces[name]
        try:
            value = np.asarray(action)
        except ValueError:  # rows of different lengths
            value = np.empty(0, object)
        if space.shape != value.shape or value.dtype.kind not in ("iu" if space.shape == () else "iuf"):
            raise ActionError(f"the action {action!r} of agent {name!r} is not of its action space {space}")
        inside = (
            bool(space.contains(np.int64(value)))
            if space.shape == ()
            else within_bounds(value.astype(np.float64)) is not None
        )
        if not inside:
            raise ActionError(f"the action {action!r} of agent {name!r} is NaN or outside of its action space {space}")
        return value

    def _observations(self, agents: list[str]) -> Observations:
        rows = self.episodes.observe(hide_finished=False)[0]
        return {name: rows[self._numbers[name]] for name in agents}

    def _infos(self, agents: list[str]) -> dict[str, Info]:
        world, robots = of_world(self.episodes.world_infos(), 0), of_world(self.episodes.robot_infos(), 0)
        terms = robots.pop("reward_terms")  # one by one: libraries that stack infos of agents take no dictionaries
        robots |= {f"reward_{name}": term for name, term in terms.items()}
        return {name: of_world(robots, self._numbers[name]) | world for name in agents}

    def show(self, sketch: TeamSketch) -> None:
        """Let a planner's sketch be seen in the picture until the next one."""
        self.episodes.sketches[0] = sketch

    def _picture(self) -> NDArray[np.uint8] | None:
        return draw_world(self.episodes, 0)

    def close(self) -> None:
        """Close the window, if there is one."""
        self.episodes.window.close()

    def state(self) -> NDArray[np.float32]:
        """What all robots see, (robots, beams + 8)."""
        rows: NDArray[np.float32] = self.episodes.observe()[0]
        return rows

    def _remaining(self) -> list[str]:
        finished, over = self.episodes.finished[0], bool(self.episodes.over[0])
        return [name for name, robot in self._numbers.items() if not (finished[robot] or over)]


@takes_keywords_of(CorridorOptions, without=["max_episode_steps"])
def parallel_env(max_cycles: int | None = None, **keywords: Unpack[CorridorKeywords]) -> CorridorEnv:
    """Make the environment in PettingZoo's parallel form; see ``CorridorEnv``."""
    return CorridorEnv(max_cycles, **keywords)


@takes_keywords_of(CorridorOptions, without=["max_episode_steps"])
def raw_env(
    max_cycles: int | None = None, **keywords: Unpack[CorridorKeywords]
) -> AECEnv[str, NDArray[np.float32], Any]:
    """Make the environment in PettingZoo's agent-by-agent form, without wrappers."""
    return parallel_to_aec(parallel_env(max_cycles, **keywords))


@takes_keywords_of(CorridorOptions, without=["max_episode_steps"])
def env(max_cycles: int | None = None, **keywords: Unpack[CorridorKeywords]) -> AECEnv[str, NDArray[np.float32], Any]:
    """Make the environment in PettingZoo's agent-by-agent form (AEC), by PettingZoo's conversion."""
    return wrappers.OrderEnforcingWrapper(raw_env(max_cycles, **keywords))
