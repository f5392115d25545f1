"""A fleet that gets new goals whenever it reaches one: rolling-horizon planning, a cell at a time, all in step."""

from typing import Any

import numpy as np

from lidarena.base.errors import ConfigError, TeamError
from lidarena.baselines.corridor.robot_interface import Fleet, FleetState
from lidarena.baselines.corridor.team_driving import Floats, steer_to
from lidarena.baselines.corridor.wall_fitting import WallTracker
from lidarena.baselines.registry import register
from lidarena.envs.corridor.rendering import TeamSketch
from lidarena.planning.team.floor_grid import FloorGrid
from lidarena.planning.team.lifelong import LifelongTeam

_SPARE = (0.1, 0.05, 0.02, 0.0)
"""Room beside the robots that is planned for, where there is so much [m]."""
_THERE = 0.06
"""Nearer than this to its cell a robot has completed the step [m]."""


@register("lifelong", family="corridor")
class LifelongFleet:
    """Plans the next step for everybody when everybody has completed the last one.

    The plan reaches some steps ahead, see ``lidarena.planning.team.lifelong``; that nobody begins a step before all
    others are done makes it safe at any speed. For ``goals="lifelong"``; where goals stay the same,
    the robots drive to them.

    Attributes:
        finished: Whether the team cannot be planned for; ``message`` says why.
        message: What there is to say.
        steps: Steps that were planned in this episode.
    """

    def __init__(self, env: Any, *, futures: int = 1, horizon: int = 16, repairs: int = 200) -> None:
        """Make it for an environment of the corridor family.

        Args:
            env: A ``corridor_v0.parallel_env`` or ``lidarena/CorridorCentral-v0``.
            futures: How many futures are played through for a step.
            horizon: Steps that are planned ahead.
            repairs: Neighbourhoods of robots that are planned anew for a step.

        Raises:
            ConfigError: A number is out of range.
        """
        for name, value, least in (("futures", futures, 0), ("horizon", horizon, 1), ("repairs", repairs, 0)):
            if not least <= value <= 1000:
                raise ConfigError(f"{name} = {value} is out of range; {least} to 1000 is allowed")
        self.fleet, self._sizes = Fleet(env), (futures, horizon, repairs)
        self.reset()

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; ``seed`` is of the ties."""
        self.fleet.begin()
        self._tracker = WallTracker(self.fleet)
        self._seed = seed or 0
        self._team: LifelongTeam | None = None
        self.finished, self.message, self.steps = False, "", 0

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the team's next actions."""
        state = self.fleet.read(info)
        begins = self._team is None and not self.finished
        if begins:
            self._grid = self.fleet.grid(info)
        state = self._tracker.look(state, info, self._grid)
        if begins:
            self._begin(state, self._grid)
        if self._team is None:
            return self.fleet.actions(np.zeros((self.fleet.robots, 2)), state)
        away = np.hypot(*(state.poses[:, :2] - self._targets).T)
        if (away[state.active] < _THERE).all():
            self._next_step(state)
        if self.fleet.drawn:
            curves = {robot: self._targets[robot][None] for robot in np.flatnonzero(state.active).tolist()}
            self.fleet.show(TeamSketch(curves, np.empty((0, 2)), (), f"step {self.steps}"))
        commands = np.array([steer_to(pose, target) for pose, target in zip(state.poses, self._targets, strict=True)])
        commands[~state.active] = 0.0
        self._tracker.drive(commands)
        return self.fleet.actions(commands, state)

    def _begin(self, state: FleetState, grid: FloorGrid) -> None:
        """Lay out the graph for discs as large as the robots' places allow."""
        for spare in _SPARE:
            graph = grid.graph(self.fleet.radius + spare)
            cells = grid.standing(state.poses[:, :2], graph)
            places = graph.index[cells[:, 0], cells[:, 1]].astype(np.int64)
            gaps = np.hypot(*(cells[:, None] - cells[None]).transpose(2, 0, 1)) + 1e9 * np.eye(len(cells))
            if (places >= 0).all() and gaps.min() >= max(graph.apart, 1.0) - 1e-9:
                self._graph = graph
                self._team = LifelongTeam(graph, places, places, *self._sizes, self._seed)
                self._targets: Floats = grid.points(cells)
                return
        self.finished, self.message = True, "The robots stand too near to walls or each other for any plan."

    def _next_step(self, state: FleetState) -> None:
        """Take up new goals and plan a step."""
        team = self._team
        assert team is not None
        goals = self._grid.standing(state.goals, self._graph)
        for robot, place in enumerate(self._graph.index[goals[:, 0], goals[:, 1]].tolist()):
            if place >= 0 and place != team.goals[robot]:
                try:
                    team.set_goal(robot, place)
                except TeamError as error:
                    self.message = str(error)
        team.advance()
        self.steps += 1
        self._targets = self._grid.points(self._graph.cells[team.places])
