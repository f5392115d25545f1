"""Environments and policies from the entries of a comparison file; refusals for what cannot be made."""

from collections.abc import Mapping
from functools import partial
from typing import Any

import gymnasium as gym

import lidarena  # noqa: F401  registers the environments, also in a spawned worker
from lidarena import agents, baselines
from lidarena.agents.shipped import resolve
from lidarena.base.errors import ConfigError, LidarenaError, suggest
from lidarena.base.import_names import import_for, import_named
from lidarena.baselines import Policy
from lidarena.envs.registration import Family, registration_of
from lidarena.evaluation.comparison_config import ComparisonConfig, EnvEntry, PolicyEntry
from lidarena.evaluation.recording import Env

TRUTH = "expose_truth"
"""Keyword of environments that tell an evaluation what no policy may see."""


def make_participants(env_entry: EnvEntry, entry: PolicyEntry, render_mode: str | None = None) -> tuple[Env, Policy]:
    """Make an environment, with the truth exposed to the evaluation, and a policy to drive in it.

    A trained agent brings along the keywords that say what an observation or action means to it, defaults included, in
    place of the environment entry's.

    Args:
        env_entry: Which environment.
        entry: Which policy; its ``keywords`` come on top of everybody's.
        render_mode: ``"rgb_array"`` for videos.

    Raises:
        ConfigError: There is no such environment, keyword, baseline, option, module or folder.
        PolicyFileError: The agent's files are torn or of another kind, no such agent is shipped, or it was trained for
            other environments.
    """
    check_policy(entry)
    keywords = dict(env_entry.keywords)
    agent = None
    if entry.path is not None:
        agent = agents.load(entry.path)
        names = _agent_keywords(agent.env_id)
        own = {key: value for key, value in agent.env_keywords.items() if key in names}
        keywords = {key: value for key, value in keywords.items() if key not in names} | own
    env = make_env(env_entry.id, keywords | entry.keywords, render_mode)
    try:
        if agent is None:
            return env, _make_untrained(entry, env)
        return env, agents.ready(agent, env, f"policy {entry.title!r}", entry.options)
    except BaseException:
        env.close()
        raise


def _agent_keywords(env_id: str) -> set[str]:
    """Keywords of an agent's environments that change what an observation or an action means to it."""
    registered = registration_of(env_id)
    options = registered[0].agent_options if registered is not None else Family.agent_options
    return {option.partition(".")[0] for option in options}


def make_env(env_id: str, keywords: Mapping[str, Any], render_mode: str | None = None) -> Env:
    """Make an environment, with the truth exposed to the evaluation if it has any to expose.

    Raises:
        ConfigError: There is no such environment or keyword.
    """
    check_env_id(env_id)
    given = dict(keywords) | ({} if render_mode is None else {"render_mode": render_mode})
    try:
        return _made(env_id, given | {TRUTH: True})
    except ConfigError as refusal:
        if TRUTH not in str(refusal):
            raise
    return _made(env_id, given)


def _made(env_id: str, keywords: Mapping[str, Any]) -> Env:
    try:
        env: Env = gym.make(env_id, disable_env_checker=True, **keywords)
    except LidarenaError:
        raise
    except (TypeError, ValueError, AssertionError, ImportError, gym.error.Error) as error:
        raise ConfigError(f"environment {env_id!r} cannot be made: {_first_line(error)}") from error
    return env


def _make_untrained(entry: PolicyEntry, env: Env) -> Policy:
    make = _own_policy(entry) if ":" in entry.name else partial(baselines.make, entry.name)
    try:
        policy = make(env, **entry.options)
    except TypeError as error:
        raise ConfigError(f"policy {entry.name!r} cannot be made: {_first_line(error)}") from error
    if not isinstance(policy, Policy):
        raise ConfigError(f"policy {entry.name!r} made {type(policy).__name__!r}, which lacks reset(seed) or act(...)")
    return policy


def check(config: ComparisonConfig) -> None:
    """Refuse what can be seen to be wrong before anything is made.

    Raises:
        ConfigError: An environment, baseline, module or folder does not exist, or a folder of maps cannot be used.
    """
    for env in config.worlds:
        check_env_id(env.id)
        config.cases(env)
    for policy in config.participants:
        check_policy(policy)


def check_env_id(env_id: str) -> None:
    """Refuse an id that is not registered, and import the module before its colon.

    Raises:
        ConfigError: With the nearest right id.
    """
    module, _, name = env_id.rpartition(":")
    if module:
        import_for(module, f"environment {env_id!r}")
    try:
        gym.spec(name)
    except gym.error.Error as error:
        known = [known for known in gym.registry if known.partition("/")[0] in ("lidarena", name.partition("/")[0])]
        raise ConfigError(f"there is no environment {env_id!r}{suggest(name, known)}") from error


def check_policy(entry: PolicyEntry) -> None:
    """Refuse a policy whose baseline, module or folder does not exist.

    Raises:
        ConfigError: With the nearest right name.
    """
    if entry.path is not None:
        if not resolve(entry.path).exists():
            raise ConfigError(
                f"policy {entry.title!r}: there is no {entry.path!r}; 'path' is the run folder that train.py wrote"
            )
    elif ":" in entry.name:
        _own_policy(entry)
    elif entry.name not in baselines.names():
        raise ConfigError(f"there is no policy {entry.name!r}{suggest(entry.name, baselines.names())}")


def _own_policy(entry: PolicyEntry) -> Any:
    """Look up ``module:callable``."""
    return import_named(entry.name, f"policy {entry.name!r}")


def _first_line(error: Exception) -> str:
    return (str(error).strip() or type(error).__name__).splitlines()[0]
