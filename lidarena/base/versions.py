"""Versions of Python and of the libraries that a result depends on."""

import importlib.metadata
import platform
from collections.abc import Iterable

LIBRARIES = (
    "lidarena",
    "gymnasium",
    "numba",
    "numpy",
    "pettingzoo",
    "pymunk",
    "sb3-contrib",
    "scipy",
    "stable-baselines3",
    "torch",
)
"""Those whose version can change a result."""


def library_versions(libraries: Iterable[str] = LIBRARIES) -> dict[str, str | None]:
    """The version of Python and of each library; None where one is not installed."""
    return {"python": platform.python_version()} | {name: _version(name) for name in libraries}


def _version(library: str) -> str | None:
    try:
        return importlib.metadata.version(library)
    except importlib.metadata.PackageNotFoundError:  # run from a checkout that is not installed
        return None
