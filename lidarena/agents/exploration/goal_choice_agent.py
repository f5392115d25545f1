"""A network that was trained to choose where to explore next, as a policy for the exploration environments."""

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.base.errors import PolicyFileError
from lidarena.base.keyword_checks import check_range
from lidarena.baselines.exploration.choosing_explorer import ChoosingExplorer
from lidarena.envs.exploration.goal_choice.episodes import LARGEST
from lidarena.envs.exploration.goal_choice.features import FEATURES
from lidarena.envs.exploration.goal_choice.options import LEAST_FRONTIERS, GoalChoiceOptions

_TOLD = ("candidates", "places", "least_frontier", "choice_period")


class GoalChoiceAgent:
    """Explores where a trained network chooses to; see ``ChoosingExplorer``.

    Attributes:
        learned: The network; of ``lidarena/GoalChoice-v0``.
    """

    def __init__(
        self, env: Any, learned: LearnedPolicy, *, preference: float = 0.5, least_frontier: float | None = None
    ) -> None:
        """Make it for an exploration environment.

        Args:
            env: The environment; any ``observation``, ``reward`` or ``action``.
            learned: What `lidarena.agents.load` gave.
            preference: How much certainty is worth, from 0, the shortest way, to 1, the surest.
            least_frontier: Smaller frontiers are left [m]; None: as in its training.

        Raises:
            ConfigError: A preference or a frontier out of range.
            PolicyFileError: The network was trained on other features of the candidates.
        """
        shape = learned.observation_space.shape
        if shape is None or len(shape) != 2 or shape[1] != FEATURES + shape[0]:
            raise PolicyFileError(
                f"the agent was trained to choose by features of shape {shape}, but this version tells {FEATURES} of "
                "each candidate, and the ways to all: train it anew"
            )
        self.learned = learned
        trained = {name: learned.env_keywords.get(name, getattr(GoalChoiceOptions, name)) for name in _TOLD}
        if least_frontier is not None:
            check_range("least_frontier", least_frontier, *LEAST_FRONTIERS)
            trained["least_frontier"] = float(least_frontier)
        self._explorer = ChoosingExplorer(env, self._choose, preference=preference, **trained)

    def _choose(self, rows: NDArray[np.float32]) -> int:
        return int(self.learned.act(np.clip(rows, -LARGEST, LARGEST), {"action_mask": rows[:, 0] > 0.5}))

    @property
    def finished(self) -> bool:
        """Whether nothing is left to explore."""
        return self._explorer.finished

    @property
    def ending(self) -> str:
        """Why the exploration has ended; see ``ChoosingExplorer``."""
        return self._explorer.ending

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; ``seed`` matters only if the network draws its choices."""
        self.learned.reset(seed)
        self._explorer.reset(seed)

    def act(self, observation: Any, info: Mapping[str, Any]) -> Any:
        """Return the next action of the exploration environment."""
        return self._explorer.act(observation, info)
