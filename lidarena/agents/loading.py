"""A ready policy for an environment, whatever kind of agent it is."""

import inspect
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any, overload

from lidarena.agents.compatibility import check_family, check_options, check_spaces, fits
from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.agents.policy_file import read_policy
from lidarena.base.errors import ConfigError, suggest
from lidarena.base.import_names import import_named
from lidarena.baselines.policy import Policy
from lidarena.envs.registration import registration_of

Options = Mapping[str, Any]


@overload
def load(path: str | Path, env: None = None, deterministic: bool = True, options: None = None) -> LearnedPolicy: ...


@overload
def load(path: str | Path, env: Any, deterministic: bool = True, options: Options | None = None) -> Policy: ...


def load(path: str | Path, env: Any = None, deterministic: bool = True, options: Options | None = None) -> Policy:
    """Load a trained agent.

    Args:
        path: Run folder (or any folder with ``policy.json``), the ``.json`` or ``.safetensors`` file, or
            ``"pretrained:NAME"``.
        env: Environment in which the agent is to act, single or a batch (whose worlds it drives one by one).
        deterministic: Whether the agent takes its most probable action or draws one.
        options: Keyword arguments of what drives by the network, such as an agent's ``preference``; only with ``env``.

    Returns:
        With ``env``, a policy that is ready to drive there: the network itself, or what drives by it (a network that
        chooses where to explore, or one that drives each robot of a team). Without, the network as a `LearnedPolicy`.

    Raises:
        PolicyFileError: A file is missing, truncated or of another format (Stable-Baselines3's own ``.zip`` too, since
            opening one can run code), or the agent was trained for other environments; it says which.
        ConfigError: The agent has no such option.
    """
    learned = read_policy(path, deterministic)
    return learned if env is None else ready(learned, env, repr(str(path)), options)


def ready(learned: LearnedPolicy, env: Any, origin: str = "the agent", options: Options | None = None) -> Policy:
    """Return the policy by which a network drives in an environment.

    Args:
        learned: What `load` gave without an environment.
        env: See `load`.
        origin: What a refusal calls the agent.
        options: See `load`.

    Raises:
        PolicyFileError: The agent was trained for other environments; it says which.
        ConfigError: The agent has no such option.
    """
    check_family(learned, env, origin)
    registered = registration_of(learned.env_id)
    agent = registered[1].agent if registered is not None else None
    if agent is not None and not fits(learned, env):
        drive = import_named(agent, f"the agents of {learned.env_id!r}")
        _refuse_unknown(options, drive, origin)
        policy: Policy = drive(env, learned, **options or {})
        return policy
    _refuse_unknown(options, None, origin)
    check_options(learned, env, origin)
    check_spaces(learned, env, origin)
    learned.ask_for_masks(env)
    return learned


def _refuse_unknown(options: Options | None, drive: Callable[..., Policy] | None, origin: str) -> None:
    parameters = inspect.signature(drive).parameters.values() if drive is not None else ()
    allowed = [one.name for one in parameters if one.kind == one.KEYWORD_ONLY]
    for key in options or {}:
        if key not in allowed:
            hint = suggest(key, allowed) if allowed else "; it has no options"
            raise ConfigError(f"{origin}: the agent has no option {key!r}{hint}")
