"""The configurations that come with the package, found by name: ``lidarena train quick``.

They are the files of ``configs/`` in the repository; a wheel holds a copy of them inside the package.
"""

import re
from pathlib import Path
from typing import Literal

from lidarena.base.errors import ConfigError, suggest

Kind = Literal["train", "compare"]
_PACKAGE = Path(__file__).parents[1]
_SENTENCE_END = re.compile(r"(?<!al)(?<!Fig)\. ")


def shipped_folder() -> Path:
    """Return the folder that holds ``train/`` and ``compare/``: the package's copy, or that of a checkout."""
    inside = _PACKAGE / "configs"
    return inside if inside.is_dir() else _PACKAGE.parent / "configs"


def shipped_names(kind: Kind) -> list[str]:
    """Return the names of the shipped configurations of a kind, sorted."""
    return sorted(file.stem for file in (shipped_folder() / kind).glob("*.yaml"))


def find_config(kind: Kind, wanted: str) -> str:
    """Return the path of a configuration.

    Args:
        kind: For a training or for a comparison.
        wanted: A file, or the name of a shipped one. ``configs/KIND/NAME.yaml`` is the shipped one, too, where there is
            no such file, so that commands copied from a page work in any folder.

    Returns:
        The path; of a file that is not there as it was given, since whoever reads it says so.

    Raises:
        ConfigError: A name, without folder and suffix, that no shipped configuration has.
    """
    path = Path(wanted)
    if path.is_file():
        return wanted
    if path.parts[:-1] == ("configs", kind) and path.stem in shipped_names(kind) and path.suffix == ".yaml":
        return str(shipped_folder() / kind / path.name)
    if len(path.parts) != 1 or path.suffix:
        return wanted
    if path.name in shipped_names(kind):
        return str(shipped_folder() / kind / f"{path.name}.yaml")
    what = {"train": "training", "compare": "comparison"}[kind]
    raise ConfigError(f"{wanted!r} is neither a file nor a shipped {what}{suggest(wanted, shipped_names(kind))}")


def purpose(kind: Kind, name: str) -> str:
    """Return the first sentence of the comment that a shipped configuration begins with."""
    words = []
    for line in (shipped_folder() / kind / f"{name}.yaml").read_text(encoding="utf-8").splitlines():
        if not line.startswith("#"):
            break
        if not line.startswith("#   "):  # a command
            words.append(line.lstrip("# ").strip())
    return _SENTENCE_END.split(" ".join(words), maxsplit=1)[0].rstrip(".")
