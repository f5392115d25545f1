"""Episodes in a batch of exploration worlds: rewards, endings, observations, infos; the single environment's too."""

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.base_episodes import OneAgentEpisodes
from lidarena.envs.episodes import Outcome
from lidarena.envs.exploration.actions import action_space, commands_of
from lidarena.envs.exploration.observations import ENTROPY, BatchObserver, check_entropy, make_observer
from lidarena.envs.exploration.options import OBSERVATIONS, ExplorationOptions
from lidarena.envs.exploration.rendering import draw_exploration, path_points
from lidarena.envs.exploration.rewards import REWARDS, ExplorationTerms
from lidarena.envs.exploration.state import RESOLUTION, ExplorationCore
from lidarena.envs.infos import Info, of_world
from lidarena.envs.path_recorder import PathRecorder
from lidarena.envs.rewards import choose_reward

_GAIN = 0.001
"""Share of the map that counts as a gain where patience is limited."""


class ExplorationEpisodes(OneAgentEpisodes):
    """Runs episodes in ``worlds`` worlds, of checked ``options``; see ``lidarena.envs.episodes.Episodes``.

    Args:
        worlds: How many.
        options: The checked keywords.

    Attributes:
        core: The worlds.
        recorder: Paths for the picture, None unless the worlds are drawn.
    """

    options: ExplorationOptions

    def __init__(self, worlds: int, options: ExplorationOptions) -> None:
        chosen = choose_reward(options.reward, REWARDS)
        super().__init__(worlds, options, chosen, action_space(options.action))
        self.core = ExplorationCore(worlds, options)
        parts = 1 if options.action == "discrete" else 2
        self._observer: BatchObserver | None = None
        self._choose_observation(OBSERVATIONS, lambda name: self._observe_by(name, parts))
        self.recorder = PathRecorder(worlds) if options.render_mode is not None else None
        self._previous = np.zeros((worlds, parts))
        self._completeness = np.zeros(worlds)
        self._gained, self._gained_at = np.zeros(worlds), np.zeros(worlds, np.int64)
        self._terms = ExplorationTerms(self.core, chosen, options.eta, options.certain_enough)
        self._resolution, self._radius = np.full(worlds, RESOLUTION), np.full(worlds, self.core.robot.radius)
        self._resolution.flags.writeable = self._radius.flags.writeable = False  # every info holds the same ones
        self._map = self.core.maps.occupancy[:]
        self._map.flags.writeable = False

    def _observe_by(self, name: str, parts: int) -> gym.Space[Any]:
        """Observe by one of the family's own kinds; returns its space."""
        if name.endswith(ENTROPY):
            check_entropy(self.core)
        self._observer = make_observer(name, parts, self.options.lidar)
        return self._observer.space

    def _begin(self, world: int, rng: np.random.Generator, seed: int | None) -> None:
        self.core.reset_world(world, rng)
        self._gained_at[world] = 0
        self._gained[world] = 0.0
        self._previous[world] = 0.0
        if self.recorder is not None:
            self.recorder.begin(world, path_points(self.core)[world])
        self._terms.begin(world)

    def _complete_reset(self, worlds: list[int]) -> None:
        self._completeness = self.core.completeness

    def step(self, actions: Any) -> Outcome:
        """Act in every world; returns rewards, terminated and truncated, each (worlds,).

        Raises:
            ActionError: See ``drive_actions.commands_of``.
        """
        commands = commands_of(self.options.action, actions, self.core.worlds, self.core.robot)
        with self._compilation():
            self.core.step(commands)
        self._note_step()
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
        truncated = self._out_of_steps()
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

    def _look(self) -> Any:
        assert self._observer is not None  # or an observer of one's own looks
        return self._observer.observe(self.core, self._previous)

    def _snapshot(self) -> Callable[[tuple[int, ...]], Info]:
        """What every step tells, as it is now; one world's part by its number."""
        facts = self._facts()
        facts["map"] = facts["map"].copy()
        return lambda index: of_world(facts, index[0])

    def _facts(self) -> Info:
        """What every step tells; ``map`` is a read-only view that later steps change."""
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
