from typing import Any

from lidarena.baselines import Policy


class Own:
    """A policy of one's own that inherits nothing."""

    def reset(self, seed: int | None = None) -> None:
        """Begin."""

    def act(self, observation: Any, info: dict[str, Any]) -> int:
        """Stand still."""
        return 0


class Half:
    """Cannot begin an episode."""

    def act(self, observation: Any, info: dict[str, Any]) -> int:
        """Stand still."""
        return 0


def test_whatever_can_reset_and_act_is_a_policy() -> None:
    assert isinstance(Own(), Policy) and not isinstance(Half(), Policy)
