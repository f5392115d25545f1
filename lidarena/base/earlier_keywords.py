"""Earlier names of keywords, which go on working for one version with a warning that tells the new form."""

import sys
import warnings
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from lidarena.base.errors import ConfigError

_PACKAGE = str(Path(__file__).resolve().parents[1])


def warn_earlier(message: str) -> None:
    """Warn of an earlier name, at the line outside of the package that used it."""
    depth, frame = 2, sys._getframe(1)
    while frame.f_back is not None and (
        frame.f_code.co_filename.startswith(_PACKAGE) or "gymnasium" in Path(frame.f_code.co_filename).parts
    ):
        depth, frame = depth + 1, frame.f_back
    warnings.warn(message, DeprecationWarning, stacklevel=depth)


def nest_earlier(what: str, keywords: Mapping[str, Any], earlier: Mapping[str, tuple[str, str]]) -> dict[str, Any]:
    """Replace keywords that have become part of another one, as ``lidar_noise`` has of ``lidar={"noise": …}``.

    Args:
        what: Takes the keywords, such as ``"an arena environment"``.
        keywords: As they were given.
        earlier: New keyword and name in it, by earlier keyword.

    Returns:
        The keywords in their new form.

    Raises:
        ConfigError: A keyword was given in both forms.
    """
    given = {name: value for name, value in keywords.items() if name not in earlier}
    found: dict[str, dict[str, Any]] = {}
    for name, value in keywords.items():
        if name not in earlier:
            continue
        new, part = earlier[name]
        if given.get(new) is not None:
            raise ConfigError(f"{what} got {new!r} and {name!r}, the earlier form of {new}={{{part!r}: …}}; give one")
        warn_earlier(f"keyword {name!r} is now part of {new!r}: give {new}={{{part!r}: {value!r}}}")
        if value is not None:
            found.setdefault(new, {})[part] = value
    return given | found
