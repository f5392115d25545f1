"""Episodes in a batch of arenas: rewards, endings, observations, infos; the single environment's too."""

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.arena.actions import heading_space, turns_of
from lidarena.envs.arena.kernels import observe
from lidarena.envs.arena.known_way import EXTRAS, observe_way
from lidarena.envs.arena.options import OBSERVATIONS, ArenaOptions
from lidarena.envs.arena.rendering import ArenaRecorder, draw_arena
from lidarena.envs.arena.rewards import REWARDS, weigh_terms
from lidarena.envs.arena.state import ArenaCore
from lidarena.envs.base_episodes import OneAgentEpisodes
from lidarena.envs.episodes import Outcome
from lidarena.envs.infos import Info
from lidarena.envs.rewards import choose_reward

_FAR = 1.5
"""Distances to the goal are observed over this many sides of the room to which everything is to scale."""


class ArenaEpisodes(OneAgentEpisodes):
    """Runs episodes in ``worlds`` arenas, of checked ``options``; see ``lidarena.envs.episodes.Episodes``.

    Args:
        worlds: How many.
        options: The checked keywords.

    Attributes:
        core: The arenas.
        recorder: Paths for the picture, None unless the worlds are drawn.
    """

    options: ArenaOptions

    def __init__(self, worlds: int, options: ArenaOptions) -> None:
        self.core = ArenaCore(worlds, options)
        reward = choose_reward(options.reward, REWARDS)
        super().__init__(worlds, self.core.options, reward, heading_space(options.action))
        self._choose_observation(OBSERVATIONS, self._space)
        self.recorder = ArenaRecorder(worlds) if options.render_mode is not None else None
        self._success = np.zeros(worlds, np.bool_)

    def _space(self, name: str) -> gym.Space[Any]:
        low = np.zeros(self.core.beam.beams + 3 + (EXTRAS if name == "way" else 0), np.float32)
        signed = self.core.beam.beams + np.array([1, 2, 4, 5])  # cosines and sines of bearings
        low[signed[signed < len(low)]] = -1.0
        return gym.spaces.Box(low, np.ones_like(low), dtype=np.float32)

    def _begin(self, world: int, rng: np.random.Generator, seed: int | None) -> None:
        self.core.reset_world(world, rng, seed)
        self._success[world] = False
        if self.recorder is not None:
            self.recorder.begin(world, self.core)

    def step(self, actions: Any) -> Outcome:
        """Act in every world; returns rewards, terminated and truncated, each (worlds,).

        Raises:
            ActionError: See ``heading_actions.turns_of``.
        """
        core = self.core
        turns = turns_of(self.options.action, actions, core.worlds)
        before = core.measurements.distance.copy()
        with self._compilation():
            core.step(turns)
        self._note_step()
        collision = core.physics.touched
        self._success = (core.measurements.distance <= core.goal_radius) & ~collision
        weighed = weigh_terms(core, self._rewards.chosen.weights, before, self._success)
        rewards = self._rewards.add_up(weighed, actions)
        if self.recorder is not None:
            self.recorder.driven.record(core.physics.poses)
        return rewards, collision | self._success, self._out_of_steps()

    def _look(self) -> NDArray[np.float32]:
        core = self.core
        extras = EXTRAS if self.options.observation == "way" else 0
        out = np.empty((core.worlds, core.beam.beams + 3 + extras), np.float32)
        proximity = self.options.observation in ("proximity", "way")
        far, basic = _FAR * core.side, core.beam.beams + 3
        observe(
            core.physics.poses,
            core.goals,
            core.beam.max_range,
            far,
            core.radii,
            proximity,
            core.measurements,
            out[:, :basic],
        )
        if extras and core.known is not None:
            observe_way(core.physics.poses, far, core.known.ways, out)
        return out

    def _facts(self) -> Info:
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
        if core.known is not None:
            info |= {"lookahead_point": core.known.ways.point.copy(), "way_length": core.known.ways.length.copy()}
        known = {"circles": core.circles.copy(), "bounds": core.bounds.copy()}
        if self.options.knowledge == "map":
            info |= known
        told = self.options.knowledge == "map" or self.options.expose_truth
        if core.moving.number and told:
            known["moving"] = self._moving()
            if self.options.knowledge == "map":
                info["moving"] = self._moving()
        if self.options.expose_truth:
            own = {name: info[name].copy() for name in ("pose", "path_length")}
            info["truth"] = known | own | {"optimal_time": core.optimal_time.copy()}
        return info

    def _moving(self) -> NDArray[Any]:
        """Moving obstacles (worlds, M, 5), or where their number differs an array of arrays (worlds,)."""
        core = self.core
        discs = [core.moving.discs(world) for world in range(core.worlds)]
        least, most = self.options.moving.numbers
        if least == most:
            return np.stack(discs)
        rows = np.empty(core.worlds, object)
        rows[:] = discs
        return rows

    def picture(self, world: int) -> NDArray[np.uint8] | None:
        """The arena of one world, its potential, plan and path; None unless the worlds are drawn."""
        return None if self.recorder is None else draw_arena(self.core, self.recorder, world)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""
        return {"steps": self._steps, "success": self._success} | self.core.arrays()

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        self._steps[:], self._success = saved["steps"], saved["success"].copy()
        self.core.load_arrays(saved)
        self._rewards.look()
