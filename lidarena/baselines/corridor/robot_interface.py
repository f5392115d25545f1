"""A team as its policies see it: PettingZoo's dictionaries, or the arrays of the world for one controller."""

from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.corridor.actions import action_for
from lidarena.envs.corridor.parallel_env import agent_name
from lidarena.envs.corridor.rendering import TeamSketch
from lidarena.planning.team.floor_grid import FloorGrid

_COARSE = 0.199
"""Cells smaller than these are for robots to which those of 0.2 m show no way: clearance counts there [m]."""


@dataclass(frozen=True)
class FleetState:
    """What a team knows now; arrays over its robots.

    Attributes:
        poses: (k, 3) as localisation gives them; of a finished robot the last one.
        goals: (k, 2) [m].
        active: (k,) whether a robot is still on its way.
        arrived: (k,).
        time: Since the episode began [s].
    """

    poses: NDArray[np.float64]
    goals: NDArray[np.float64]
    active: NDArray[np.bool_]
    arrived: NDArray[np.bool_]
    time: float


class Fleet:
    """Translates between an environment of the corridor family and what planners of teams work with.

    Args:
        env: A ``corridor_v0.parallel_env`` or a ``lidarena/CorridorCentral-v0``.

    Attributes:
        robots: How many.
        robot: What each is like.
        radius: Of each [m].
        period: Seconds between two actions.
        action: ``"continuous"`` or ``"discrete"``.
        lidar: Of each.
        tolerance: Distance from its goal at which a robot has arrived [m].
    """

    def __init__(self, env: Any) -> None:
        self._env = env.unwrapped
        options = self._env.options
        self.robots, self.robot, self.period = options.robots, options.robot, options.decision_period
        self.radius = self.robot.radius
        self.action, self.tolerance = options.action, options.goal_tolerance
        self.lidar = options.lidar
        self._central = isinstance(self._env, gym.Env)
        self._last: FleetState | None = None

    def begin(self) -> None:
        """Forget the last episode."""
        self._last = None

    def read(self, info: dict[str, Any]) -> FleetState:
        """Return what the environment's last info tells, a dictionary by agent or that of the one controller."""
        if self._central:
            active = ~np.asarray(info["finished"])
            poses, goals, arrived = (np.array(info[name]) for name in ("pose", "goal", "success"))
            return FleetState(poses, goals, active, arrived, info["time"])
        if self._last is None:
            nothing = np.zeros(self.robots, np.bool_)
            self._last = FleetState(np.zeros((self.robots, 3)), np.zeros((self.robots, 2)), nothing, nothing, 0.0)
        poses, goals, arrived = self._last.poses.copy(), self._last.goals.copy(), self._last.arrived.copy()
        time = self._last.time
        for robot in range(self.robots):
            own = info.get(agent_name(robot))
            if own is not None:
                poses[robot], goals[robot], arrived[robot] = own["pose"], own["goal"], own["success"]
                time = own["time"]
        active = np.array([agent_name(robot) in self._env.agents for robot in range(self.robots)])
        self._last = FleetState(poses, goals, active, arrived, time)
        return self._last

    def scan(self, robot: int, info: dict[str, Any]) -> NDArray[np.float64] | None:
        """A robot's newest scan (beams,) [m]; None if nothing was told of it."""
        own = info if self._central else info.get(agent_name(robot))
        if own is None:
            return None
        return np.asarray(own["scan"][robot] if self._central else own["scan"], np.float64)

    def actions(self, commands: NDArray[np.float64], state: FleetState) -> Any:
        """Return the environment's actions for commands (k, 2) of speed [m/s] and turn rate [rad/s]."""
        single = [action_for(self.action, float(speed), float(rate), self.robot) for speed, rate in commands]
        if self._central:
            return np.stack(single)
        return {agent_name(robot): single[robot] for robot in np.flatnonzero(state.active).tolist()}

    def grid(self, info: dict[str, Any]) -> FloorGrid:
        """Return the map that the infos hold."""
        own: dict[str, Any] = info if self._central else next(iter(info.values()))
        x, y = np.asarray(own["origin"]).tolist()
        side = float(own["resolution"])
        by_blocked, clearance = side >= _COARSE, np.asarray(own["clearance"])
        distances = (None, clearance) if by_blocked else (clearance, None)
        return FloorGrid(np.asarray(own["map"]) > 50, (x, y), side, *distances)

    @property
    def drawn(self) -> bool:
        """Whether the environment draws pictures, so that a sketch is worth making."""
        return self._env.render_mode is not None

    def show(self, sketch: TeamSketch) -> None:
        """Let a sketch be seen in the environment's picture."""
        self._env.show(sketch)
