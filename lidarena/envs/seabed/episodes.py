"""Episodes over the seabed, in a batch of worlds; the single environment's too."""

from collections.abc import Callable
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.base_episodes import OneAgentEpisodes
from lidarena.envs.episodes import Outcome
from lidarena.envs.infos import Info
from lidarena.envs.rewards import choose_reward
from lidarena.envs.seabed.actions import decision_space, decisions_of
from lidarena.envs.seabed.observations import LARGEST, NAMES, observe
from lidarena.envs.seabed.options import OBSERVATIONS, SeabedOptions
from lidarena.envs.seabed.rendering import draw_vehicle
from lidarena.envs.seabed.rewards import REWARDS, weigh_terms
from lidarena.envs.seabed.scenes import RATE
from lidarena.envs.seabed.state import RADIUS, Vehicle


class SeabedEpisodes(OneAgentEpisodes):
    """Runs flights in ``worlds`` worlds, of checked ``options``; see ``lidarena.envs.episodes.Episodes``.

    Attributes:
        vehicles: One a world.
    """

    options: SeabedOptions

    def __init__(self, worlds: int, options: SeabedOptions) -> None:
        super().__init__(worlds, options, choose_reward(options.reward, REWARDS), decision_space(options.choices))
        self.vehicles = [Vehicle(options) for _ in range(worlds)]
        self._choose_observation(OBSERVATIONS, lambda _: gym.spaces.Box(0.0, LARGEST, (len(NAMES),), np.float32))

    def _begin(self, world: int, rng: np.random.Generator, seed: int | None) -> None:
        self.vehicles[world].begin(rng, seed)

    def step(self, actions: Any) -> Outcome:
        """Compute the next position in every world; returns rewards, terminated and truncated, each (worlds,).

        Raises:
            ActionError: See ``decisions_of``.
        """
        decisions = decisions_of(actions, self.worlds, self.options.choices)
        before = [vehicle.frame for vehicle in self.vehicles]
        with self._compilation():
            for vehicle, (chosen, mode) in zip(self.vehicles, decisions, strict=True):
                vehicle.step(int(chosen) if self.options.overlaps is None else vehicle.skip_for(chosen), mode)
        self._note_step()
        covered = [(v.frame - frame) / v.last_frame for v, frame in zip(self.vehicles, before, strict=True)]
        weighed = weigh_terms(
            self._rewards.chosen.weights,
            self._each(lambda vehicle: vehicle.drift),
            self._each(lambda vehicle: vehicle.spent),
            self._each(lambda vehicle: float(vehicle.refused)),
            np.array(covered),
        )
        rewards = self._rewards.add_up(weighed, actions)
        return rewards, self._success() | self._collision(), self._out_of_steps()

    def _each(self, of: Callable[[Vehicle], Any]) -> NDArray[Any]:
        return np.array([of(vehicle) for vehicle in self.vehicles])

    def _success(self) -> NDArray[np.bool_]:
        return self._each(lambda vehicle: vehicle.frame >= vehicle.last_frame)

    def _collision(self) -> NDArray[np.bool_]:
        return self._each(lambda vehicle: vehicle.scene.clearance(vehicle.frame) < 0.5 * RADIUS)

    def _look(self) -> NDArray[np.float32]:
        return np.stack([observe(vehicle) for vehicle in self.vehicles])

    def _facts(self) -> Info:
        each = self._each
        info = Info(
            {
                "pose": each(lambda vehicle: vehicle.planar),
                "time": each(lambda vehicle: vehicle.frame / RATE),
                "path_length": each(lambda vehicle: vehicle.path_lengths[0]),
                "collision": self._collision(),
                "success": self._success(),
                "radius": np.full(self.worlds, RADIUS),
                "frame": each(lambda vehicle: vehicle.frame),
                "frames_left": each(lambda vehicle: vehicle.last_frame - vehicle.frame),
                "skip": each(lambda vehicle: vehicle.skip),
                "refused": each(lambda vehicle: vehicle.refused),
                "refusals": each(lambda vehicle: vehicle.odometry.refused),
                "positions": each(lambda vehicle: vehicle.odometry.steps),
                "matches": each(lambda vehicle: vehicle.odometry.matches),
                "overlap": each(lambda vehicle: vehicle.overlap),
                "height": each(lambda vehicle: float(np.nan_to_num(vehicle.odometry.depth))),
                "speed": each(lambda vehicle: vehicle.speed),
                "uncertainty": each(lambda vehicle: vehicle.uncertainty[0]),
                "compute": each(lambda vehicle: vehicle.cost),
            }
        )
        if self.options.expose_truth:
            info["truth"] = {
                "pose": each(lambda vehicle: vehicle.scene.flight.planar[vehicle.frame]),
                "path_length": each(lambda vehicle: vehicle.path_lengths[1]),
                "error": each(lambda vehicle: vehicle.error),
                "clearance": each(lambda vehicle: vehicle.scene.clearance(vehicle.frame)),
                "nees": each(lambda vehicle: vehicle.nees),
            }
        return info

    def picture(self, world: int) -> NDArray[np.uint8] | None:
        """The flight of one world and what its camera sees; None unless the worlds are drawn."""
        return None if self.options.render_mode is None else draw_vehicle(self.vehicles[world])

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""
        parts = [vehicle.arrays() for vehicle in self.vehicles]
        return {"steps": self._steps} | {name: np.stack([part[name] for part in parts]) for name in parts[0]}

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        self._steps[:] = saved["steps"]
        for world, vehicle in enumerate(self.vehicles):
            vehicle.load_arrays({name: array[world] for name, array in saved.items()})
        self._rewards.look()
