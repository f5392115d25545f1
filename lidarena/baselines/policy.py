"""What every policy is, learned or classical."""

from typing import Any, Protocol, runtime_checkable


@runtime_checkable
class Policy(Protocol):
    """Something that drives a robot.

    A policy that can tell that its work is done has an attribute ``finished: bool``, False after :meth:`reset`; an
    evaluation ends the episode when it becomes True.
    """

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode.

        Args:
            seed: Of the policy's own randomness, if it has any; None draws one.
        """

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the action for the environment's last observation and info."""
