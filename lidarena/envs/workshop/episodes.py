"""Episodes in a batch of workshops: decisions, rewards, endings, observations, infos; for every interface to them."""

from typing import Any

import gymnasium as gym
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError
from lidarena.envs.base_episodes import OneAgentEpisodes
from lidarena.envs.episodes import Outcome
from lidarena.envs.infos import Info
from lidarena.envs.rewards import choose_reward
from lidarena.envs.workshop.actions import action_space, allowed, decisions_of, with_waiting
from lidarena.envs.workshop.facts import describe, measure
from lidarena.envs.workshop.humans import Human
from lidarena.envs.workshop.kernels import DECIDES, DONE, ENDS, RUNS
from lidarena.envs.workshop.observations import LARGEST, OBSERVATIONS, OF_ALL, PER_ACTION, observe
from lidarena.envs.workshop.options import WorkshopOptions
from lidarena.envs.workshop.recognition import Recognizer
from lidarena.envs.workshop.records import PICTURE_TICKS
from lidarena.envs.workshop.rendering import draw_workshop
from lidarena.envs.workshop.rewards import REWARDS, weigh_terms
from lidarena.envs.workshop.state import WorkshopCore
from lidarena.envs.workshop.task import HUMAN, ROBOT
from lidarena.envs.workshop.walking import TICK


class WorkshopEpisodes(OneAgentEpisodes):
    """Runs episodes in ``worlds`` workshops, of checked ``options``; see ``lidarena.envs.episodes.Episodes``.

    Attributes:
        core: The workshops.
        names: Of the actions of the space.
        recognizer: What guesses the human's action, if it is not told.
    """

    options: WorkshopOptions

    def __init__(self, worlds: int, options: WorkshopOptions) -> None:
        self.core = WorkshopCore(worlds, options)
        task = self.core.task
        reward = choose_reward(options.reward, REWARDS)
        super().__init__(worlds, options, reward, action_space(len(task.actions)))
        self.names = (*task.actions, "wait")
        self._numbers = len(task.actions) * PER_ACTION + OF_ALL
        shape = (self._numbers,)
        self._choose_observation(OBSERVATIONS, lambda _: gym.spaces.Box(-LARGEST, LARGEST, shape, np.float32))
        self.recognizer = Recognizer(self.core) if options.recognition == "position" else None
        self._refused, self._before = np.zeros(worlds, np.int64), np.zeros(worlds, np.int64)

    def _begin(self, world: int, rng: np.random.Generator, seed: int | None) -> None:
        self.core.reset_world(world, rng)
        self._refused[world] = 0
        if self.recognizer is not None:
            self.recognizer.begin(world)

    def _complete_reset(self, worlds: list[int]) -> None:
        """Run up to the first decision."""
        fresh = np.zeros(self.worlds, np.bool_)
        fresh[worlds] = True
        self._run(fresh)
        self._before[worlds] = self.core.workers.ticks[worlds]

    def step(self, actions: Any) -> Outcome:
        """Let the robot decide in every world, and run until its next decision is due.

        Raises:
            ActionError: Something else than a number of an action, or of waiting.
            ConfigError: A human of one's own chose what there is not.
        """
        choices = decisions_of(actions, self.worlds, len(self.core.task.actions))
        return self.step_both(None, choices, actions)

    def step_both(self, human: NDArray[np.int64] | None, robot: NDArray[np.int64], actions: Any) -> Outcome:
        """The same for both agents; ``human`` is None where the human is simulated."""
        s, task = self.core.workers, self.core.task
        idle, everywhere = s.idle.copy(), np.ones(self.worlds, np.bool_)
        self._before[:] = s.ticks
        with self._compilation():
            if human is not None:
                self.core.decide(HUMAN, human, everywhere, forced=True)
            self._refused += self.core.decide(ROBOT, robot, everywhere)
            s.verdict[s.verdict == DECIDES] = RUNS
            self._run(s.verdict != ENDS)
        self._note_step()
        undone = (s.status != DONE).mean(axis=1)
        over = s.verdict == ENDS
        terminated = over & (undone == 0.0)
        truncated = ~terminated & (over | self._out_of_steps())
        spent = (self.core.time - self._before * TICK) / task.deadline
        weighed = weigh_terms(
            self._rewards.chosen.weights, spent, (s.idle - idle) / task.deadline, over, undone,
            self.core.time / task.deadline,
        )  # fmt: skip
        rewards = self._rewards.add_up(weighed, np.asarray(actions))
        return rewards, terminated, truncated

    @property
    def over(self) -> NDArray[np.bool_]:
        """(worlds,) whether the episodes have ended."""
        ended: NDArray[np.bool_] = self.core.workers.verdict == ENDS
        return ended | self._out_of_steps()

    def _run(self, active: NDArray[np.bool_]) -> None:
        """Run until the robot, or where both decide anybody, has to; a human of one's own is asked here."""
        going = active.copy()
        human = self.core.human
        while going.any():
            self.core.run(going)
            if self.recognizer is not None:
                self.recognizer.look(going)
            if isinstance(human, str):
                return
            asked = going & self.core.workers.due[:, HUMAN] & (self.core.workers.verdict == DECIDES)
            if not asked.any():
                return
            self._ask(human, asked)
            robot_waits = asked & self.core.workers.due[:, ROBOT]
            going = asked & ~robot_waits

    def _ask(self, human: Human, asked: NDArray[np.bool_]) -> None:
        """Let a human of one's own choose."""
        facts, count = self._snapshot(), len(self.core.task.actions)
        choices = np.full(self.worlds, count, np.int64)
        for world in np.flatnonzero(asked).tolist():
            rng = self.core.rngs[world]
            assert rng is not None
            choice = human.choose(facts((world,)), rng)
            if choice is not None and not (isinstance(choice, int | np.integer) and 0 <= choice < count):
                raise ConfigError(f"the human chose {choice!r}, where a number from 0 to {count - 1} or None is needed")
            choices[world] = count if choice is None else choice
        self.core.decide(HUMAN, choices, asked, forced=True)

    def _look(self) -> NDArray[np.float32]:
        return self.seen_by(ROBOT)

    def seen_by(self, agent: int) -> NDArray[np.float32]:
        """What an agent observes, (worlds, numbers)."""
        core = self.core
        out = np.empty((self.worlds, self._numbers), np.float32)
        observe(core.task.arrays, core.task.grid, core.records, core.task.deadline, agent, out)
        return out

    def masks(self, agent: int) -> NDArray[np.bool_]:
        """What an agent may decide, (worlds, n + 1)."""
        s = self.core.workers
        free = allowed(self.core.task.arrays, s.status)[:, agent]
        return with_waiting(free, s.action[:, 1 - agent] >= 0, s.due[:, agent])

    def action_masks(self) -> NDArray[np.bool_]:
        """What the robot may decide, (worlds, n + 1)."""
        return self.masks(ROBOT)

    def _facts(self) -> Info:
        facts = describe(self.core, self.recognizer)
        facts |= measure(self.core)
        facts["duration"] = (self.core.workers.ticks - self._before) * TICK
        facts["action_mask"] = self.action_masks()
        facts["refused"] = self._refused.copy()
        if self.options.expose_truth:
            s = self.core.workers
            facts["truth"] = {
                "pose": s.poses.copy(), "action": s.action.copy(), "traits": s.traits.copy(),
                "log": s.log.copy(), "logged": s.logged.copy(),
            }  # fmt: skip
        return facts

    def picture(self, world: int) -> NDArray[np.uint8] | None:
        """The floor and the schedule of one world; None unless the worlds are drawn."""
        return None if self.options.render_mode is None else draw_workshop(self.core, world)

    def moments(self, world: int) -> list[float]:
        """Times within the last step at which poses of one world were noted [s]; none unless the worlds are drawn."""
        first = self._before[world] // PICTURE_TICKS + 1 if self._before[world] else 0
        last = min(int(self.core.workers.ticks[world]) // PICTURE_TICKS, self.core.records.trace.shape[1] - 1)
        return [moment * PICTURE_TICKS * TICK for moment in range(first, last + 1)]

    @property
    def restorable(self) -> bool:
        """Whether ``arrays`` are to be had; not with a human of one's own, who may remember things."""
        return isinstance(self.core.human, str)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generators."""
        own: dict[str, NDArray[Any]] = {"steps": self._steps, "refused": self._refused, "before": self._before}
        return own | self.core.arrays() | (self.recognizer.arrays() if self.recognizer is not None else {})

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of other episodes with the same options."""
        self.core.load_arrays(saved)
        for name, array in self.arrays().items():
            array[...] = saved[name]
        self._rewards.look()
