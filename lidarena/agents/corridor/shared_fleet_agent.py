"""A network that was trained to drive one robot of a team, as a policy for the whole team."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

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
        self.learned, self._fleet = learned, Fleet(env)
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

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return every robot's next action."""
        if self._central:
            finished: NDArray[np.bool_] = np.asarray(info["finished"])
            return np.stack([self._act(row, bool(done)) for row, done in zip(observation, finished, strict=True)])
        active = self._fleet.read(info).active
        names = [agent_name(robot) for robot in np.flatnonzero(active).tolist()]
        return {name: self.learned.act(observation[name]) for name in names}

    def _act(self, row: NDArray[np.float32], finished: bool) -> Any:
        if not finished:
            return self.learned.act(row)
        space = self.learned.action_space
        return np.zeros(space.shape or (), space.dtype)
