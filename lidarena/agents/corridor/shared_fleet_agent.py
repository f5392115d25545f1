"""A network that was trained to drive one robot of a team, as a policy for the whole team."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.agents.compatibility import check_options
from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.base.errors import PolicyFileError
from lidarena.baselines.corridor.robot_interface import Fleet
from lidarena.envs.corridor.parallel_env import agent_name


class SharedFleetAgent:
    """Drives every robot by the same network, each by what it sees itself.

    Attributes:
        learned: The network; of ``lidarena/CorridorShared-v0``.
    """

    def __init__(self, env: Any, learned: LearnedPolicy) -> None:
        """Make it for an environment of the corridor family.

        Args:
            env: A ``corridor_v0.parallel_env`` or ``lidarena/CorridorCentral-v0``.
            learned: What `lidarena.agents.load` gave.

        Raises:
            PolicyFileError: The robots see or do something else than those that the network was trained with.
        """
        check_options(learned, env, "the agent")
        self.learned, self._fleet = learned, Fleet(env)
        self._memories: dict[int, Any] = {}
        self._central = not hasattr(env.unwrapped, "possible_agents")
        episodes = getattr(env.unwrapped.episodes, "teams", env.unwrapped.episodes)
        for what in ("observation_space", "action_space"):
            if getattr(episodes, what) != getattr(learned, what):
                raise PolicyFileError(
                    f"the policy was trained on robots with {what} {getattr(learned, what)}, "
                    f"but those of this environment have {getattr(episodes, what)}"
                )

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; ``seed`` matters only if the network draws its actions."""
        self.learned.reset(seed)
        self._memories = {}

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return every robot's next action."""
        if self._central:
            finished: NDArray[np.bool_] = np.asarray(info["finished"])
            rows = enumerate(zip(observation, finished.tolist(), strict=True))
            return np.stack([self._nothing() if done else self._act(robot, row) for robot, (row, done) in rows])
        active = np.flatnonzero(self._fleet.read(info).active).tolist()
        return {agent_name(robot): self._act(robot, observation[agent_name(robot)]) for robot in active}

    def _act(self, robot: int, observation: NDArray[np.float32]) -> Any:
        """One robot's action, by what it sees and remembers itself."""
        self.learned.memory = self._memories.get(robot)
        action = self.learned.act(observation)
        self._memories[robot] = self.learned.memory
        return action

    def _nothing(self) -> Any:
        space = self.learned.action_space
        return np.zeros(space.shape or (), space.dtype)
