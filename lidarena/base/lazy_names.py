"""Names of a package that are imported when they are first used, so that importing the package stays quick."""

import sys
from collections.abc import Callable, Mapping
from importlib import import_module
from typing import Any


def lazy_names(package: str, homes: Mapping[str, str]) -> tuple[Callable[[str], Any], Callable[[], list[str]]]:
    """Return what a package takes as its ``__getattr__`` and ``__dir__``.

    Args:
        package: Its ``__name__``.
        homes: The module of each name; ``"module:other"`` where it is called otherwise there.
    """

    def get(name: str) -> Any:
        if name not in homes:
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        module, _, inner = homes[name].partition(":")
        found = getattr(import_module(module), inner or name)
        setattr(sys.modules[package], name, found)  # the next time it is there
        return found

    def list_all() -> list[str]:
        return sorted({*vars(sys.modules[package]), *homes})

    return get, list_all
