"""Episodes in a batch of worlds in which a step is a choice and the driving to it."""

from collections.abc import Iterable
from contextlib import nullcontext
from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.action_parsing import choices_of
from lidarena.envs.compilation import announced_compilation
from lidarena.envs.episodes import Generators, Outcome, Seeds
from lidarena.envs.exploration.actions import discrete_commands
from lidarena.envs.exploration.goal_choice.explorers import (
    Crew,
    advance_all,
    discrete_driver,
    explorer_settings,
    set_out_all,
)
from lidarena.envs.exploration.goal_choice.features import FEATURES, Circumstances
from lidarena.envs.exploration.goal_choice.options import GoalChoiceOptions
from lidarena.envs.exploration.goal_choice.rendering import draw_choices
from lidarena.envs.exploration.goal_choice.rewards import REWARDS, GoalChoiceTerms
from lidarena.envs.exploration.rendering import path_points
from lidarena.envs.exploration.state import RESOLUTION, ExplorationCore
from lidarena.envs.infos import Info, of_world
from lidarena.envs.path_recorder import PathRecorder
from lidarena.envs.rewards import StepRewards, choose_reward
from lidarena.envs.worker_threads import on_threads
from lidarena.planning.driving import explorer
from lidarena.planning.driving.explorer import CHOOSES, DRIVES, ENDINGS, ENDS, empty_explorers
from lidarena.planning.driving.state import Perceptions
from lidarena.planning.driving.survey import look_around, survey
from lidarena.slam.readings import Share

LARGEST = 60.0
"""No feature is larger."""
_TRIES = 5
"""Episodes that end before the first choice are begun anew, so often; the last then ends in its first step."""


class GoalChoiceEpisodes:
    """Runs episodes of choices in ``worlds`` worlds, of checked ``options``; see ``lidarena.envs.episodes.Episodes``.

    Args:
        worlds: How many.
        options: The checked keywords.

    Attributes:
        core: The exploration worlds.
        preference: (worlds,) how much certainty is worth.
    """

    def __init__(self, worlds: int, options: GoalChoiceOptions) -> None:
        self.options, self.worlds, self.envs = options, worlds, worlds
        self.core = ExplorationCore(worlds, options.world)
        most = options.candidates
        self.single_observation_space: gym.Space[Any] = gym.spaces.Box(
            -LARGEST, LARGEST, (most, FEATURES + most), np.float32
        )
        self.single_action_space: gym.Space[Any] = gym.spaces.Discrete(most)
        self._crew = self._hire(most)
        self._velocities = discrete_commands(options.world.robot)
        self._terms = GoalChoiceTerms(self.core)
        self._chosen = choose_reward(options.reward, REWARDS)
        self._rewards = StepRewards(self._chosen, (worlds,), self._snapshot)
        self.preference = np.zeros(worlds)
        self._steps, self._choices = np.zeros(worlds, np.int64), np.zeros(worlds, np.int64)
        self.recorder = PathRecorder(worlds) if options.render_mode is not None else None
        self._compiled = False

    def _hire(self, most: int) -> Crew:
        options = self.options
        driver = discrete_driver(options.world, RESOLUTION)
        rows, columns = self.core.maps.occupancy.shape[1:]
        return Crew(
            driver,
            explorer_settings(
                options.world.decision_period, options.choice_period, options.least_frontier, options.places
            ),
            empty_explorers(self.worlds, rows, columns, most, driver),
            np.full(self.worlds, DRIVES),
            np.zeros(self.worlds, np.int64),
            np.zeros((self.worlds, most, FEATURES + most), np.float32),
        )

    def reset(self, worlds: Iterable[int], generators: Generators, seeds: Seeds = None) -> None:
        """Begin a new episode in each of ``worlds``, up to its first choice."""
        begun = list(worlds)
        with nullcontext() if self._compiled else announced_compilation():
            for _ in range(_TRIES):
                self._begin(begun, generators)
                active = np.zeros(self.worlds, np.bool_)
                active[begun] = True
                self._drive(active.copy(), None)
                # an episode without a single choice teaches nothing; but a room may be seen at a glance from everywhere
                begun = np.flatnonzero(active & (self._crew.status != CHOOSES)).tolist()
                if not begun:
                    break

    def _begin(self, worlds: list[int], generators: Generators) -> None:
        for world in worlds:
            self.core.reset_world(world, generators[world])
            wanted = self.options.preference
            self.preference[world] = generators[world].random() if isinstance(wanted, str) else wanted
            self._steps[world] = self._choices[world] = 0
            explorer.begin(self._crew.explorers, world)
            self._terms.begin(world)
            self._rewards.begin(world)
            if self.recorder is not None:
                self.recorder.begin(world, path_points(self.core)[world])
        fresh = np.zeros(self.worlds, np.bool_)
        fresh[worlds] = True
        self._advance(fresh)

    def step(self, actions: Any) -> Outcome:
        """Choose in every world, and drive until the next choice is due.

        Raises:
            ActionError: An action that is no whole number of a candidate.
        """
        choices = choices_of(actions, self.worlds, self.options.candidates)
        senses, counter, active = self._senses(), np.zeros(1, np.int64), self._crew.status == CHOOSES
        with nullcontext() if self._compiled else announced_compilation():
            on_threads(
                self.worlds,
                lambda thread: set_out_all(Share(counter, self.worlds, thread, active), choices, senses, self._crew),
            )
            terms = {name: np.zeros(self.worlds) for name in REWARDS.names}
            self._drive(active.copy(), terms)
        self._compiled = True
        self._choices += active
        weighed = {name: weight * terms[name] for name, weight in self._chosen.weights.items()}
        rewards = self._rewards.add_up(weighed, actions)
        collided, ended = self.core.sensors.collision, self._crew.status == ENDS
        return rewards, collided | ended, self._has_timed_out() & ~(collided | ended)

    def _drive(self, active: NDArray[np.bool_], terms: dict[str, NDArray[np.float64]] | None) -> None:
        """Drive the active worlds until a choice is due in each, or its episode ends."""
        period, status = self.options.world.decision_period, self._crew.status
        active &= status == DRIVES
        while active.any():
            self.core.step(self._velocities[self._crew.commands], active)
            self._steps += active
            if self.recorder is not None:
                self.recorder.record(path_points(self.core))
            weighed = self._terms.weigh(self.preference, period, active)
            if terms is not None:
                for name, term in weighed.items():
                    terms[name] += term
            active &= ~(self.core.sensors.collision | self._has_timed_out())
            self._advance(active)
            active &= status == DRIVES

    def _has_timed_out(self) -> NDArray[np.bool_]:
        limit, most = self.options.time_limit, self.options.max_episode_steps
        late = np.zeros(self.worlds, np.bool_)
        if limit is not None:
            late |= self._steps * self.options.world.decision_period >= limit
        return late | (self._choices >= most) if most != -1 else late

    def _advance(self, active: NDArray[np.bool_]) -> None:
        senses, around, counter = self._senses(), self._circumstances(), np.zeros(1, np.int64)
        on_threads(
            self.worlds,
            lambda thread: advance_all(Share(counter, self.worlds, thread, active), around, senses, self._crew),
        )

    def _senses(self) -> Perceptions:
        core = self.core
        return Perceptions(core.maps.occupancy, core.maps.origin, core.estimate, core.sensors.scans[:, 0])

    def _circumstances(self) -> Circumstances:
        return Circumstances(self._terms.log_d(), self.preference, self.options.world.decision_period)

    def observe(self) -> NDArray[np.float32]:
        """What is told of the candidates, (worlds, K, FEATURES + K); zeros where none is left."""
        rows = np.clip(self._crew.rows, -LARGEST, LARGEST)
        rows[self._crew.status != CHOOSES] = 0.0
        return rows

    def action_masks(self) -> NDArray[np.bool_]:
        """Which candidates are there, (worlds, K)."""
        return np.asarray((self._crew.rows[:, :, 0] > 0.5) & (self._crew.status == CHOOSES)[:, None])

    def infos(self) -> Info:
        """What every step tells, as arrays over worlds."""
        facts = self._facts()
        facts["reward_terms"] = {name: term.copy() for name, term in self._rewards.terms.items()}
        return facts

    def _snapshot(self) -> Any:
        facts = self._facts()
        return lambda index: of_world(facts, index[0])

    def _facts(self) -> Info:
        core = self.core
        facts = Info(
            {
                "completeness": core.completeness,
                "pose": core.estimate.copy(),
                "d_optimality": core.d_optimality.copy(),
                "path_length": core.sensors.path_length.copy(),
                "time": self._steps * self.options.world.decision_period,
                "collision": core.sensors.collision.copy(),
                "ending": np.array(ENDINGS)[np.where(self._crew.status == ENDS, self._crew.explorers.ending, 0)],
                "success": (self._crew.status == ENDS) & ~core.sensors.collision,
                "radius": np.full(self.worlds, core.robot.radius),
                "preference": self.preference.copy(),
                "action_mask": self.action_masks(),
            }
        )
        if self.options.world.expose_truth:
            truth = {"pose": core.physics.poses[:, 0].copy(), "path_length": core.sensors.true_path_length.copy()}
            facts["truth"] = truth
        return facts

    def last_infos(self) -> Info:
        """The infos, which later steps leave alone."""
        return self.infos()

    def picture(self, world: int) -> NDArray[np.uint8] | None:
        """The truth beside the belief of one world, with what to choose from; None unless the worlds are drawn."""
        return None if self.recorder is None else draw_choices(self.core, self.recorder, self._crew.explorers, world)

    def close(self) -> None:
        """Nothing is held."""

    @property
    def restorable(self) -> bool:
        """Whether ``arrays`` are to be had; the estimator says so."""
        return self.core.estimator.restorable

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""
        own: dict[str, NDArray[Any]] = {"steps": self._steps, "choices": self._choices, "preference": self.preference}
        own |= {"status": self._crew.status, "commands": self._crew.commands, "rows": self._crew.rows}
        crew = {f"explorers.{name}": array for name, array in explorer.arrays_of(self._crew.explorers).items()}
        # what was surveyed is surveyed again
        crew = {name: array for name, array in crew.items() if ".ground." not in name and ".near." not in name}
        return own | crew | self._terms.arrays() | self.core.arrays()

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        self.core.load_arrays(saved)
        mine = self.arrays()
        for name in mine.keys() - self.core.arrays().keys():
            mine[name][...] = saved[name]
        senses = self._senses()
        for world in range(self.worlds):
            look_around(world, senses, self._crew.driver, self._crew.explorers.drive)
            survey(world, senses, self._crew.driver, self._crew.explorers.drive)
        self._rewards.look()
