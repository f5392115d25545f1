"""Episodes in a batch of arenas: rewards, endings, observations, infos; the single environment's too."""

from collections.abc import Callable, Iterable
from contextlib import nullcontext
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.arena.actions import heading_space, turns_of
from lidarena.envs.arena.kernels import observe
from lidarena.envs.arena.options import OBSERVATIONS, ArenaOptions
from lidarena.envs.arena.rendering import ArenaRecorder, draw_arena
from lidarena.envs.arena.rewards import REWARDS, weigh_terms
from lidarena.envs.arena.state import ArenaCore
from lidarena.envs.compilation import announced_compilation
from lidarena.envs.episodes import Generators, Seeds
from lidarena.envs.infos import Info, of_world
from lidarena.envs.observers import OneByOne, choose_observer
from lidarena.envs.rewards import StepRewards, choose_reward

_FAR = 1.5
"""Distances to the goal are observed over this many sides of the room to which everything is to scale."""


class ArenaEpisodes:
    """Runs episodes in ``worlds`` arenas, of checked ``options``; see ``lidarena.envs.episodes.Episodes``.

    Args:
        worlds: How many.
        options: The checked keywords.

    Attributes:
        core: The arenas.
        recorder: Paths for the picture, None unless the worlds are drawn.
    """

    def __init__(self, worlds: int, options: ArenaOptions) -> None:
        self.core, self.worlds, self.envs = ArenaCore(worlds, options), worlds, worlds
        self.options = self.core.options
        self.single_action_space: gym.Space[Any] = heading_space(options.action)
        low = np.concatenate([np.zeros(self.core.beam.beams + 1), np.full(2, -1.0)]).astype(np.float32)
        self.single_observation_space: gym.Space[Any] = gym.spaces.Box(low, np.ones_like(low), dtype=np.float32)
        observer = choose_observer(options.observation, OBSERVATIONS)
        self._own = None if isinstance(observer, str) else OneByOne(observer, (worlds,))
        if not isinstance(observer, str):
            self.single_observation_space = observer.space
        self.recorder = ArenaRecorder(worlds) if options.render_mode is not None else None
        self._rewards = StepRewards(choose_reward(options.reward, REWARDS), (worlds,), self._snapshot)
        self._steps = np.zeros(worlds, np.int64)
        self._success = np.zeros(worlds, np.bool_)
        self._compiled = False

    def reset(self, worlds: Iterable[int], generators: Generators, seeds: Seeds = None) -> None:
        """Begin a new episode in each of ``worlds``.

        Args:
            worlds: Which ones.
            generators: Of all worlds; each draws from its own.
            seeds: That all worlds were reset with, if they were.
        """
        begun = list(worlds)
        with nullcontext() if self._compiled else announced_compilation():
            for world in begun:
                self.core.reset_world(world, generators[world], seeds[world] if seeds is not None else None)
                self._steps[world] = 0
                self._success[world] = False
                self._rewards.begin(world)
                if self.recorder is not None:
                    self.recorder.begin(world, self.core)
        self._rewards.look(begun)

    def step(self, actions: Any) -> tuple[NDArray[np.float64], NDArray[np.bool_], NDArray[np.bool_]]:
        """Act in every world; returns rewards, terminated and truncated, each (worlds,).

        Raises:
            ActionError: See ``heading_actions.turns_of``.
        """
        core = self.core
        turns = turns_of(self.options.action, actions, core.worlds)
        before = core.measurements.distance.copy()
        with nullcontext() if self._compiled else announced_compilation():
            core.step(turns)
        self._compiled = True
        self._steps += 1
        collision = core.physics.touched
        self._success = (core.measurements.distance <= core.goal_radius) & ~collision
        weighed = weigh_terms(core, self._rewards.chosen.weights, before, self._success)
        rewards = self._rewards.add_up(weighed, actions)
        if self.recorder is not None:
            self.recorder.driven.record(core.physics.poses)
        truncated = np.zeros(core.worlds, np.bool_)
        if self.options.max_episode_steps != -1:
            truncated |= self._steps >= self.options.max_episode_steps
        return rewards, collision | self._success, truncated

    def observe(self) -> Any:
        """Fresh observations (worlds, beams + 3), or what an observer of one's own makes of the worlds."""
        if self._own is not None:
            return self._own.observe(self._snapshot())
        core = self.core
        out = np.empty((core.worlds, core.beam.beams + 3), np.float32)
        proximity = self.options.observation == "proximity"
        far = _FAR * core.side
        observe(core.physics.poses, core.goals, core.beam.max_range, far, core.radii, proximity, core.measurements, out)
        return out

    def infos(self) -> Info:
        """What every step tells, as arrays over worlds."""
        return self._rewards.tell(self._facts())

    def _snapshot(self) -> Callable[[tuple[int, ...]], Info]:
        """What every step tells, as it is now; one world's part by its number."""
        facts = self._facts()
        return lambda index: of_world(facts, index[0])

    def _facts(self) -> Info:
        """All but what the step was worth."""
        core = self.core
        info = Info(
            {
                "pose": core.physics.poses[:, 0].copy(),
                "goal": core.goals.copy(),
                "distance": core.measurements.distance.copy(),
                "scan": core.measurements.scans[:, 0].copy(),
                "path_length": core.measurements.path_length.copy(),
                "clearance": core.measurements.gap.copy(),
                "time": self._steps * core.period,
                "collision": core.physics.touched.copy(),
                "success": self._success.copy(),
                "radius": core.radii.copy(),
            }
        )
        known = {"circles": core.circles.copy(), "bounds": core.bounds.copy()}
        if self.options.knowledge == "map":
            info |= known
        if core.moving.number:
            moving = np.stack([core.moving.discs(world) for world in range(core.worlds)])
            known["moving"] = moving
            if self.options.knowledge == "map":
                info["moving"] = moving.copy()
        if self.options.expose_truth:
            own = {name: info[name].copy() for name in ("pose", "path_length")}
            info["truth"] = known | own | {"optimal_time": core.optimal_time.copy()}
        return info

    def last_infos(self) -> Info:
        """The same as ``infos``, whose arrays are copies."""
        return self.infos()

    def picture(self, world: int) -> NDArray[np.uint8] | None:
        """The arena of one world, its potential, plan and path; None unless the worlds are drawn."""
        return None if self.recorder is None else draw_arena(self.core, self.recorder, world)

    def close(self) -> None:
        """Nothing is held."""

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""
        return {"steps": self._steps, "success": self._success} | self.core.arrays()

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        self._steps[:], self._success = saved["steps"], saved["success"].copy()
        self.core.load_arrays(saved)
        self._rewards.look()
