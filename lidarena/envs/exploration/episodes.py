"""Episodes in a batch of exploration worlds: rewards, endings, observations, infos; the single environment's too."""

from collections.abc import Callable, Iterable
from contextlib import nullcontext
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.compilation import announced_compilation
from lidarena.envs.episodes import Generators, Seeds
from lidarena.envs.exploration.actions import action_space, commands_of
from lidarena.envs.exploration.observations import ENTROPY, check_entropy, make_observer
from lidarena.envs.exploration.options import OBSERVATIONS, ExplorationOptions
from lidarena.envs.exploration.rendering import draw_exploration, path_points
from lidarena.envs.exploration.rewards import REWARDS, ExplorationTerms
from lidarena.envs.exploration.state import RESOLUTION, ExplorationCore
from lidarena.envs.infos import Info, of_world
from lidarena.envs.observers import OneByOne, choose_observer
from lidarena.envs.path_recorder import PathRecorder
from lidarena.envs.rewards import StepRewards, choose_reward

_GAIN = 0.001
"""Share of the map that counts as a gain where patience is limited."""


class ExplorationEpisodes:
    """Runs episodes in ``worlds`` worlds, of checked ``options``; see ``lidarena.envs.episodes.Episodes``.

    Args:
        worlds: How many.
        options: The checked keywords.

    Attributes:
        core: The worlds.
        recorder: Paths for the picture, None unless the worlds are drawn.
    """

    def __init__(self, worlds: int, options: ExplorationOptions) -> None:
        self.options, self.worlds, self.envs = options, worlds, worlds
        self.core = ExplorationCore(worlds, options)
        self.single_action_space: gym.Space[Any] = action_space(options.action)
        parts = 1 if options.action == "discrete" else 2
        look = choose_observer(options.observation, OBSERVATIONS)
        own = None if isinstance(look, str) else look
        self._own = None if own is None else OneByOne(own, (worlds,))
        if isinstance(look, str) and look.endswith(ENTROPY):
            check_entropy(self.core)
        self.observer = make_observer(look if isinstance(look, str) else "da_slam", parts, options.lidar)
        self.single_observation_space = self.observer.space if own is None else own.space
        self.recorder = PathRecorder(worlds) if options.render_mode is not None else None
        self._steps = np.zeros(worlds, np.int64)
        self._previous = np.zeros((worlds, parts))
        self._completeness = np.zeros(worlds)
        self._gained, self._gained_at = np.zeros(worlds), np.zeros(worlds, np.int64)
        chosen = choose_reward(options.reward, REWARDS)
        self._terms = ExplorationTerms(self.core, chosen, options.eta, options.certain_enough)
        self._rewards = StepRewards(chosen, (worlds,), self._snapshot)
        self._resolution, self._radius = np.full(worlds, RESOLUTION), np.full(worlds, self.core.robot.radius)
        self._resolution.flags.writeable = self._radius.flags.writeable = False  # every info holds the same ones
        self._map = self.core.maps.occupancy[:]
        self._map.flags.writeable = False
        self._compiled = False

    def reset(self, worlds: Iterable[int], generators: Generators, seeds: Seeds = None) -> None:
        """Begin a new episode in each of ``worlds``, drawing from ``generators[world]``."""
        begun = list(worlds)
        with nullcontext() if self._compiled else announced_compilation():
            for world in begun:
                self.core.reset_world(world, generators[world])
                self._steps[world] = self._gained_at[world] = 0
                self._gained[world] = 0.0
                self._previous[world] = 0.0
                if self.recorder is not None:
                    self.recorder.begin(world, path_points(self.core)[world])
                self._terms.begin(world)
                self._rewards.begin(world)
        self._completeness = self.core.completeness
        self._rewards.look(begun)

    def step(self, actions: Any) -> tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_]]:
        """Act in every world; returns rewards, terminated and truncated, each (worlds,).

        Raises:
            ActionError: See ``drive_actions.commands_of``.
        """
        commands = commands_of(self.options.action, actions, self.core.worlds, self.core.robot)
        with nullcontext() if self._compiled else announced_compilation():
            self.core.step(commands)
        self._compiled = True
        self._steps += 1
        self._remember(np.asarray(actions, dtype=np.float64))
        before, self._completeness = self._completeness, self.core.completeness
        rewards = self._rewards.add_up(self._terms.weigh(self._completeness - before), actions)
        terminated = self.core.sensors.collision.copy()
        terminated |= self._explored()
        if self.recorder is not None:
            self.recorder.record(path_points(self.core))
        return rewards, terminated, self._truncated()

    def _explored(self) -> NDArray[np.bool_]:
        """In which worlds completeness has reached ``stop_at``."""
        if self.options.stop_at is None:
            return np.zeros(self.worlds, np.bool_)
        return self._completeness >= self.options.stop_at

    def _truncated(self) -> NDArray[np.bool_]:
        """Which worlds have run out of steps, or of patience."""
        truncated = np.zeros(self.core.worlds, np.bool_)
        if self.options.max_episode_steps != -1:
            truncated |= self._steps >= self.options.max_episode_steps
        if self.options.patience is not None:
            gain = self._completeness >= self._gained + _GAIN
            self._gained[gain], self._gained_at[gain] = self._completeness[gain], self._steps[gain]
            truncated |= (self._steps - self._gained_at) * self.options.decision_period >= self.options.patience
        return truncated

    def _remember(self, actions: NDArray[np.float64]) -> None:
        if self.options.action == "discrete":
            self._previous[:, 0] = actions / 2.0
        else:
            self._previous[:] = 0.5 * (actions.clip(-1.0, 1.0) + 1.0)

    def observe(self) -> Any:
        """Fresh observations of all worlds."""
        if self._own is not None:
            return self._own.observe(self._snapshot())
        return self.observer.observe(self.core, self._previous)

    def infos(self) -> Info:
        """What every step tells, as arrays over worlds; ``map`` is a read-only view that later steps change."""
        return self._rewards.tell(self._facts())

    def _snapshot(self) -> Callable[[tuple[int, ...]], Info]:
        """What every step tells, as it is now; one world's part by its number."""
        facts = self._facts()
        facts["map"] = facts["map"].copy()
        return lambda index: of_world(facts, index[0])

    def _facts(self) -> Info:
        """All but what the step was worth."""
        core = self.core
        info = Info(
            {
                "completeness": self._completeness.copy(),
                "pose": core.estimate.copy(),
                "covariance": core.covariance.copy(),
                "d_optimality": core.d_optimality.copy(),
                **core.estimator.infos(),
                "path_length": core.sensors.path_length.copy(),
                "time": self._steps * self.options.decision_period,
                "collision": core.sensors.collision.copy(),
                "success": self._explored() & ~core.sensors.collision,
                "scan": core.sensors.scans[:, 0].copy(),
                "odometry_pose": core.sensors.dead_reckoning[:, 0].copy(),
                "map": self._map,
                "resolution": self._resolution,
                "origin": core.maps.origin.copy(),
                "radius": self._radius,
            }
        )
        if self.options.expose_truth:
            truth = {"pose": core.physics.poses[:, 0].copy(), "path_length": core.sensors.true_path_length.copy()}
            info["truth"] = truth
        return info

    def last_infos(self) -> Info:
        """The infos without the map, a view on maps that are about to be forgotten."""
        last = self.infos()
        del last["map"]
        return last

    def picture(self, world: int) -> NDArray[np.uint8] | None:
        """The truth beside the belief of one world; None unless the worlds are drawn."""
        return None if self.recorder is None else draw_exploration(self.core, self.recorder, world)

    def close(self) -> None:
        """Nothing is held."""

    @property
    def restorable(self) -> bool:
        """Whether ``arrays`` are to be had; the estimator says so."""
        return self.core.estimator.restorable

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""
        own = {"steps": self._steps, "previous": self._previous, "completeness": self._completeness}
        own |= {"gained": self._gained, "gained_at": self._gained_at}
        return own | self._terms.arrays() | self.core.arrays()

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        self._steps[:], self._previous[:] = saved["steps"], saved["previous"]
        self._completeness = saved["completeness"].copy()
        self._gained[:], self._gained_at[:] = saved["gained"], saved["gained_at"]
        for name, array in self._terms.arrays().items():
            array[:] = saved[name]
        self.core.load_arrays(saved)
        self._rewards.look()
