"""Many worlds of choices at once, each in a process of its own."""

from functools import partial
from typing import Any

import numpy as np
from gymnasium.vector import AsyncVectorEnv, AutoresetMode
from numpy.typing import NDArray

from lidarena.agents.exploration.goal_choice_env import GoalChoiceEnv


class GoalChoiceBatch(AsyncVectorEnv):
    """Worlds of ``lidarena/GoalChoice-v0`` in processes, since their steps take different times.

    Its state is how every world's episode came about; to continue from it, the worlds live through their episodes
    again, which takes seconds and leaves nothing out: policies, planners, drivers.
    """

    def __init__(self, num_envs: int = 1, **keywords: Any) -> None:
        """Start the processes.

        Args:
            num_envs: Number of worlds.
            **keywords: Of ``GoalChoiceEnv``.

        Raises:
            ConfigError: A keyword that is unknown or out of range.
        """
        _compile(keywords)
        makers = [partial(GoalChoiceEnv, **keywords)] * num_envs
        super().__init__(makers, context="spawn", autoreset_mode=AutoresetMode.SAME_STEP)

    def get_state(self) -> dict[str, NDArray[Any]]:
        """The generators at the beginning of the episodes (worlds, 6), and the choices since, -1 after the last."""
        memories = self.get_attr("memory")
        choices = np.full((self.num_envs, max(len(own) for _, own in memories)), -1, dtype=np.int64)
        for row, (_, own) in zip(choices, memories, strict=True):
            row[: len(own)] = own
        return {"generators": np.stack([words for words, _ in memories]), "choices": choices}

    def set_state(self, state: dict[str, NDArray[Any]]) -> None:
        """Live through the episodes again, up to where `get_state` was called."""
        worlds = zip(state["generators"], state["choices"], strict=True)
        self.set_attr("memory", [(words, choices[choices >= 0]) for words, choices in worlds])

    def action_masks(self) -> NDArray[np.bool_]:
        """Which candidates are there in every world, (worlds, CANDIDATES)."""
        return np.stack(self.call("action_masks"))


def _compile(keywords: dict[str, Any]) -> None:
    """Take a step in this process, so that what is compiled at first use is compiled once, not by every process."""
    world = GoalChoiceEnv(**keywords)
    world.reset(seed=0)
    world.step(0)
    world.close()
