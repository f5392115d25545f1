"""Episodes in a batch of multi-robot worlds: rewards, endings, observations, infos; for every interface to them."""

from collections.abc import Callable, Iterable, Sequence
from contextlib import nullcontext
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.compilation import announced_compilation
from lidarena.envs.corridor.actions import action_space, commands_of
from lidarena.envs.corridor.kernels import write_observations
from lidarena.envs.corridor.options import OBSERVATIONS, CorridorOptions
from lidarena.envs.corridor.rendering import TeamSketch
from lidarena.envs.corridor.rewards import REWARDS, weigh_terms
from lidarena.envs.corridor.state import CorridorCore, lengths
from lidarena.envs.infos import Info, of_world
from lidarena.envs.observers import OneByOne, choose_observer
from lidarena.envs.path_recorder import PathRecorder
from lidarena.envs.rewards import StepRewards, choose_reward
from lidarena.envs.window import Window
from lidarena.planning.team.floor_grid import FloorGrid

_EXTRA = 8
"""Numbers of an observation besides the beams."""
NEIGHBOUR = 5
"""Numbers of an observation for each neighbour."""


class CorridorEpisodes:
    """Runs episodes in ``worlds`` worlds; whoever owns it decides when a world is reset.

    Args:
        worlds: Number of worlds.
        options: Checked keywords.

    Attributes:
        core: The worlds.
        observation_space: Of one robot.
        action_space: Of one robot.
        finished: (worlds, robots) whether a robot has arrived, or collided where that ends it.
        arrived: (worlds, robots); in lifelong episodes, whether it has reached a goal at all.
        reached: (worlds, robots) goals that each has reached.
        touches: (worlds, robots) decision periods in which a robot on its way touched something.
        steps: (worlds,) decisions so far.
        trails: For the picture, None unless the worlds are drawn.
        sketches: What a planner wants to be seen in each world's picture.
        window: Shows the picture with ``render_mode="human"``.
    """

    def __init__(self, worlds: int, options: CorridorOptions) -> None:
        self.options, self.core = options, CorridorCore(worlds, options)
        self._numbers = options.lidar.beams + _EXTRA + NEIGHBOUR * options.neighbours
        self.observation_space = gym.spaces.Box(-1.0, 1.0, (self._numbers,), np.float32)
        observer = choose_observer(options.observation, OBSERVATIONS, boxes_only=True)
        self._own = None if isinstance(observer, str) else OneByOne(observer, (worlds, options.robots))
        if not isinstance(observer, str):
            assert isinstance(observer.space, gym.spaces.Box)
            self.observation_space = observer.space
        self.action_space: gym.Space[Any] = action_space(options.action, options.robot)
        self.trails = PathRecorder(worlds) if options.render_mode is not None else None
        self.sketches, self.window = [TeamSketch() for _ in range(worlds)], Window()
        shape = (worlds, options.robots)
        self.finished, self.arrived = np.zeros(shape, np.bool_), np.zeros(shape, np.bool_)
        self.reached = np.zeros(shape, np.int64)
        self.touches, self.steps = np.zeros(shape, np.int64), np.zeros(worlds, np.int64)
        self._arrival_time = np.full(shape, np.nan)
        self._top = np.array([options.robot.max_speed, options.robot.max_turn_rate])
        self._rewards = StepRewards(choose_reward(options.reward, REWARDS), shape, self._snapshot)
        self._fixed = self._fixed_infos(worlds)
        self._compiled = False

    def _fixed_infos(self, worlds: int) -> dict[str, NDArray[Any]]:
        """What a world tells that never changes, as read-only arrays over worlds, which every info holds."""
        grid = self.core.places.grid
        cells = np.where(grid.blocked, 100, 0).astype(np.int8)
        exact = FloorGrid.of(self.core.plan, grid.resolution, exact=True).clearance
        assert exact is not None
        fixed: dict[str, NDArray[Any]] = {
            "map": np.broadcast_to(cells, (worlds, *cells.shape)),
            "clearance": np.broadcast_to(exact, (worlds, *cells.shape)),
            "resolution": np.full(worlds, grid.resolution),
            "origin": np.tile(np.array(grid.origin), (worlds, 1)),
            "radius": np.full(worlds, self.options.robot.radius),
        }
        for array in fixed.values():
            array.flags.writeable = False
        return fixed

    def reset(self, worlds: Iterable[int], generators: Sequence[np.random.Generator]) -> None:
        """Begin a new episode in each of ``worlds``, drawing from ``generators[world]``."""
        begun = list(worlds)
        with nullcontext() if self._compiled else announced_compilation():
            for world in begun:
                self.core.reset_world(world, generators[world])
                self.finished[world] = self.arrived[world] = False
                self.touches[world] = self.steps[world] = self.reached[world] = 0
                self._arrival_time[world] = np.nan
                self.sketches[world] = TeamSketch()
                self._rewards.begin(world)
                if self.trails is not None:
                    self.trails.begin(world, self.core.physics.poses[world])
        self._rewards.look(begun)

    def step(self, actions: Any) -> tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_]]:
        """Act in every world; actions (worlds, robots, …), those of finished robots are not looked at.

        Returns:
            Rewards, terminated and truncated, each (worlds, robots); robots that were finished before have zeros.

        Raises:
            ActionError: See ``team_actions.commands_of``.
        """
        shape = self.finished.shape
        array = np.asarray(actions)
        flat = array.reshape(shape[0] * shape[1], *array.shape[2:]) if array.shape[:2] == shape else actions
        commands = commands_of(self.options.action, flat, shape[0] * shape[1], self.options.robot).reshape(*shape, 2)
        commands[self.finished] = 0.0
        before = self.core.measurements.remaining.copy()
        with nullcontext() if self._compiled else announced_compilation():
            self.core.step(commands)
        self._compiled = True
        self.steps += 1
        active = ~self.finished
        touching = active & self.core.touching
        near = lengths(self.core.physics.poses[..., :2] - self.core.goals) <= self.options.goal_tolerance
        arriving = active & near & ~(touching & self.options.collision_ends)
        self._note(touching, arriving)
        weighed = weigh_terms(self.core, self._rewards.chosen.weights, before, active, touching, arriving)
        rewards = self._rewards.add_up(weighed, array, active)
        terminated = active & self.finished
        truncated = active & ~self.finished & self._out_of_time[:, None]
        if self.options.lifelong:
            for world, robot in np.argwhere(arriving).tolist():
                self.core.renew_goal(world, robot)
        return rewards, terminated, truncated

    def _note(self, touching: NDArray[np.bool_], arriving: NDArray[np.bool_]) -> None:
        self.touches += touching
        self.arrived |= arriving
        self.reached += arriving
        if not self.options.lifelong:
            self.finished |= arriving
        if self.options.collision_ends:
            self.finished |= touching
        if arriving.any():
            self._arrival_time[arriving] = np.repeat(self.time, arriving.sum(axis=1))
        if self.trails is not None:
            self.trails.record(self.core.physics.poses)

    @property
    def _out_of_time(self) -> NDArray[np.bool_]:
        most = self.options.max_episode_steps
        return np.zeros(len(self.steps), np.bool_) if most == -1 else self.steps >= most

    @property
    def time(self) -> NDArray[np.float64]:
        """(worlds,) since the episodes began [s]."""
        return self.steps.astype(np.float64) * self.options.decision_period

    @property
    def over(self) -> NDArray[np.bool_]:
        """(worlds,) whether nobody is on the way any more, or time is up."""
        return self.finished.all(axis=1) | self._out_of_time

    def observe(self, hide_finished: bool = True) -> NDArray[np.float32]:
        """Fresh observations (worlds, robots, …); of robots that are finished zeros, if wanted."""
        hidden = self.finished if hide_finished else np.zeros_like(self.finished)
        if self._own is not None:
            seen: NDArray[np.float32] = self._own.observe(self._snapshot(), hidden)
            return seen.reshape(*self.finished.shape, *self.observation_space.shape)
        out = np.empty((*self.finished.shape, self._numbers), np.float32)
        reach, neighbours = self.core.beam.max_range, self.options.neighbours
        write_observations(self.core.measurements, self.core.goals, hidden, reach, self._top, neighbours, out)
        return out

    def robot_infos(self) -> Info:
        """What every step tells each robot, as arrays over (worlds, robots)."""
        return self._rewards.tell(self._robot_facts())

    def _snapshot(self) -> Callable[[tuple[int, ...]], Info]:
        """What every step tells, as it is now; one robot's part by the numbers of its world and its own."""
        robots, worlds = self._robot_facts(), self.world_infos()
        return lambda index: of_world(of_world(robots, index[0]), index[1]) | of_world(worlds, index[0])

    def _robot_facts(self) -> Info:
        """All but what the step was worth."""
        core = self.core
        counted = {"goals_reached": self.reached.copy()} if self.options.lifelong else {}
        return Info(
            counted
            | {
                "pose": core.measurements.measured.copy(),
                "goal": core.goals.copy(),
                "remaining": core.measurements.remaining.copy(),
                "success": self.arrived.copy(),
                "collision": self.touches > 0,
                "path_length": core.travelled.copy(),
                "scan": core.measurements.scans.copy(),
            }
        )

    def world_infos(self) -> Info:
        """What every step tells about a world, as arrays over worlds; ``map`` is one read-only array for all."""
        info = Info(time=self.time, **self._fixed)
        if self.options.expose_truth:
            info["truth"] = {"pose": self.core.physics.poses.copy(), "path_length": self.core.travelled.copy()}
        return info

    def measures(self) -> dict[str, NDArray[np.float64]]:
        """How the teams have done so far, by name, (worlds,) each; times of robots not there yet go on."""
        robots = self.options.robots
        times = np.where(np.isnan(self._arrival_time), self.time[:, None], self._arrival_time)
        seconds = np.maximum(self.time, self.options.decision_period)
        lifelong = {"throughput": self.reached.sum(axis=1) / seconds} if self.options.lifelong else {}
        return lifelong | {
            "arrival": self.arrived.sum(axis=1) / robots,
            "all_arrived": self.arrived.all(axis=1).astype(np.float64),
            "collided": (self.touches > 0).sum(axis=1) / robots,
            "makespan": times.max(axis=1),
            "mean_time": times.sum(axis=1) / robots,
        }

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""
        own = {"steps": self.steps, "finished": self.finished, "arrived": self.arrived, "touches": self.touches}
        own["reached"] = self.reached
        return own | {"arrival_time": self._arrival_time} | self.core.arrays()

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        for name in ("steps", "finished", "arrived", "touches", "reached"):
            getattr(self, name)[...] = saved[name]
        self._arrival_time[...] = saved["arrival_time"]
        self.core.load_arrays(saved)
        self._rewards.look()
        if self.trails is not None:  # what was driven before is not saved
            for world, poses in enumerate(self.core.physics.poses):
                self.trails.begin(world, poses)
