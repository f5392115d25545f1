"""Errors: bad input is turned away at the border with one sentence (rule 3 of the house)."""

from collections.abc import Iterable
from difflib import get_close_matches


class LidarenaError(ValueError):
    """Input that is refused; its message is one sentence that names the value and what is allowed.

    The command-line programs print the message and end with exit code 2.
    """


class MapError(LidarenaError):
    """A floor plan that is missing, torn, absurdly scaled, or has no room for the robot."""


class ActionError(LidarenaError):
    """An action that is NaN, out of range, or of the wrong shape or type."""


class ConfigError(LidarenaError):
    """A configuration with an unknown key or a value out of range."""


class EstimatorError(LidarenaError):
    """A SLAM estimator of one's own that does not keep what its protocol asks for."""


class KeywordError(ConfigError, TypeError):
    """A keyword that there is not: a ``TypeError`` too, as programs expect that probe what a function takes."""


class RewardError(LidarenaError):
    """What a reward function gave is no finite number."""


class ObservationError(LidarenaError):
    """What an observer of one's own gave is not in the space that it told."""


class PolicyFileError(LidarenaError):
    """A policy file that is torn, of another environment, or not of this format."""


class ScenarioError(LidarenaError):
    """A scenario file that is torn, of another map, or has too few robots."""


class TeamError(LidarenaError):
    """Starts and goals that no team can have, or options of a team's planner that do not exist."""


class TemporalError(LidarenaError):
    """A temporal network that cannot be: an unknown point, crossed bounds, a torn file, or no way to execute it."""


class VisionError(LidarenaError):
    """Images, a calibration or a sequence that no odometry can use, or a camera where it cannot be."""


class WriteError(LidarenaError, OSError):
    """A file or folder that cannot be written: its place is not writable, full, or something else; an OSError too."""

    def __str__(self) -> str:
        return str(self.args[0])


def suggest(word: str, allowed: Iterable[str]) -> str:
    """Return the end of a refusal: what is allowed, and the nearest right spelling of ``word``.

    Args:
        word: What was typed.
        allowed: Every accepted spelling.

    Returns:
        Such as ``"; did you mean 'reward'? Allowed: action, map, reward"``.
    """
    names = sorted(allowed)
    by_lower = {name.lower(): name for name in names}
    near = get_close_matches(word, names, n=1, cutoff=0.6)
    near = near or [by_lower[name] for name in get_close_matches(word.lower(), by_lower, n=1, cutoff=0.6)]
    hint = f"; did you mean {near[0]!r}?" if near else ";"
    return f"{hint} Allowed: {', '.join(names)}"
