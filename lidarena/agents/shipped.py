"""The trained agents that come with the package."""

import os
import warnings
from pathlib import Path

from lidarena.base.errors import PolicyFileError, suggest

PREFIX = "pretrained:"
"""What a path to one of them begins with, wherever a run folder may stand."""
_FOLDER = Path(__file__).parent / "weights"
_SUCCEEDED = {"compass": "low_level"}
"""Agents that still load, and which is better by now."""


def pretrained() -> list[str]:
    """Return the names of the shipped agents, sorted; ``lidarena.agents.load("pretrained:NAME")`` loads one.

    How each was trained is in ``configs/train`` and in its ``policy.json``.
    """
    shipped = {folder.name for folder in _FOLDER.iterdir() if (folder / "policy.json").is_file()}
    return sorted(shipped - _SUCCEEDED.keys())


def resolve(path: str | Path) -> Path:
    """Return the folder that ``"pretrained:NAME"`` stands for, or the path itself.

    Raises:
        PolicyFileError: No such agent is shipped, or it is no path at all.
    """
    if not isinstance(path, str | os.PathLike):
        raise PolicyFileError(f"{path!r} is no policy; a run folder, its policy.json or 'pretrained:NAME' is needed")
    text = str(path)
    if not text.startswith(PREFIX):
        return Path(path)
    name = text.removeprefix(PREFIX)
    if name in _SUCCEEDED:
        successor = PREFIX + _SUCCEEDED[name]
        warnings.warn(
            f"{text!r} is succeeded by {successor!r}, which has another observation; it goes with the next version",
            DeprecationWarning,
            stacklevel=2,
        )
    elif name not in pretrained():
        raise PolicyFileError(f"no agent {name!r} is shipped{suggest(name, pretrained())}")
    return _FOLDER / name
