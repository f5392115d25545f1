"""A ready policy for an environment, whatever kind of agent it is."""

from pathlib import Path
from typing import Any, overload

from lidarena.agents.compatibility import check_family, check_options, check_spaces, fits
from lidarena.agents.learned_policy import LearnedPolicy
from lidarena.agents.policy_file import read_policy
from lidarena.base.import_names import import_named
from lidarena.baselines.policy import Policy
from lidarena.envs.registration import registration_of


@overload
def load(path: str | Path, env: None = None, deterministic: bool = True) -> LearnedPolicy: ...


@overload
def load(path: str | Path, env: Any, deterministic: bool = True) -> Policy: ...


def load(path: str | Path, env: Any = None, deterministic: bool = True) -> Policy:
    """Load a trained agent.

    Args:
        path: Run folder (or any folder with ``policy.json``), the ``.json`` or ``.safetensors`` file, or
            ``"pretrained:NAME"``.
        env: Environment in which the agent is to act, single or a batch (whose worlds it drives one by one).
        deterministic: Whether the agent takes its most probable action or draws one.

    Returns:
        With ``env``, a policy that is ready to drive there: the network itself, or what drives by it (a network that
        chooses where to explore, or one that drives each robot of a team). Without, the network as a `LearnedPolicy`.

    Raises:
        PolicyFileError: A file is missing, truncated or of another format (Stable-Baselines3's own ``.zip`` too, since
            opening one can run code), or the agent was trained for other environments; it says which.
    """
    learned = read_policy(path, deterministic)
    return learned if env is None else ready(learned, env, repr(str(path)))


def ready(learned: LearnedPolicy, env: Any, origin: str = "the agent") -> Policy:
    """Return the policy by which a network drives in an environment.

    Args:
        learned: What `load` gave without an environment.
        env: See `load`.
        origin: What a refusal calls the agent.

    Raises:
        PolicyFileError: The agent was trained for other environments; it says which.
    """
    check_family(learned, env, origin)
    registered = registration_of(learned.env_id)
    agent = registered[1].agent if registered is not None else None
    if agent is not None and not fits(learned, env):
        policy: Policy = import_named(agent, f"the agents of {learned.env_id!r}")(env, learned)
        return policy
    check_options(learned, env, origin)
    check_spaces(learned, env, origin)
    learned.ask_for_masks(env)
    return learned
