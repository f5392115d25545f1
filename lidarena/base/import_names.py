"""What users name as ``"module:callable"``, also in YAML: a policy, an estimator, a reward of their own."""

from importlib import import_module
from typing import Any

from lidarena.base.errors import ConfigError, suggest


def import_named(name: str, wanted_by: str) -> Any:
    """Return what ``"module:attribute"`` names.

    Args:
        name: The module as Python imports it, a colon, and the name in it.
        wanted_by: Start of the message where there is none, such as ``"policy 'a:B'"``.

    Raises:
        ConfigError: There is no such module, or no such name in it; with the nearest right one.
    """
    module_name, _, attribute = name.partition(":")
    module = import_for(module_name, wanted_by)
    if not hasattr(module, attribute):
        public = [known for known in vars(module) if not known.startswith("_")]
        raise ConfigError(f"{wanted_by}: {module_name!r} has no {attribute!r}{suggest(attribute, public)}")
    return getattr(module, attribute)


def import_for(module: str, wanted_by: str) -> Any:
    """Import a module that a user named.

    Raises:
        ConfigError: There is no such module; the message begins with ``wanted_by``.
    """
    try:
        return import_module(module)
    except ModuleNotFoundError as error:
        raise ConfigError(f"{wanted_by}: there is no module {error.name!r}") from error
    except (ValueError, TypeError) as error:  # an empty name, or one that is relative to nothing
        raise ConfigError(f"{wanted_by}: {module!r} is no name of a module") from error
