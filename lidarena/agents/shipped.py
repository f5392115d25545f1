"""The trained agents that come with the package."""

from pathlib import Path

from lidarena.base.errors import PolicyFileError, suggest

PREFIX = "pretrained:"
"""What a path to one of them begins with, wherever a run folder may stand."""
_FOLDER = Path(__file__).parent / "weights"


def pretrained() -> list[str]:
    """Return the names of the shipped agents, sorted; ``lidarena.agents.load("pretrained:NAME")`` loads one.

    How each was trained is in ``configs/train`` and in its ``policy.json``.
    """
    return sorted(folder.name for folder in _FOLDER.iterdir() if (folder / "policy.json").is_file())


def resolve(path: str | Path) -> Path:
    """Return the folder that ``"pretrained:NAME"`` stands for, or the path itself.

    Raises:
        PolicyFileError: No such agent is shipped.
    """
    text = str(path)
    if not text.startswith(PREFIX):
        return Path(path)
    name = text.removeprefix(PREFIX)
    if name not in pretrained():
        raise PolicyFileError(f"no agent {name!r} is shipped{suggest(name, pretrained())}")
    return _FOLDER / name
