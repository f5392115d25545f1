"""A network that was trained to choose where to explore next, as a policy for the exploration environments."""

from typing import Any

from numpy.typing import NDArray

from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.base.errors import PolicyFileError
from lidarena.baselines.exploration.frontier_features import CANDIDATES, FEATURES
from lidarena.baselines.exploration.goal_choice import GoalChoicePolicy


class GoalChoiceAgent:
    """Explores where a trained network chooses to, driving as ``GoalChoicePolicy`` does.

    Attributes:
        learned: The network; of ``lidarena/GoalChoice-v0``.
    """

    def __init__(self, env: Any, learned: LearnedPolicy) -> None:
        """Make it for an exploration environment.

        Args:
            env: The environment; any ``observation``, ``reward`` or ``action``.
            learned: What `lidarena.agents.load` gave.

        Raises:
            PolicyFileError: The network was trained on other features of the candidates.
        """
        shape = learned.observation_space.shape
        if shape != (CANDIDATES, FEATURES):
            raise PolicyFileError(
                f"the agent was trained to choose by features of shape {shape}, this version tells it "
                f"{(CANDIDATES, FEATURES)}: train it anew"
            )
        self.learned = learned
        self._policy = GoalChoicePolicy(env, self._choose)

    def _choose(self, features: NDArray[Any]) -> int:
        return int(self.learned.act(features, {"action_mask": features[:, 0] > 0.5}))

    @property
    def finished(self) -> bool:
        """Whether nothing is left to explore, and the robot is where it wants to end."""
        return self._policy.finished

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; ``seed`` matters only if the network draws its choices."""
        self.learned.reset(seed)
        self._policy.reset(seed)

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action of the exploration environment."""
        return self._policy.act(observation, info)
