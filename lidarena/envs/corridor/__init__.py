"""Teams of robots on a floor plan: the corridor family."""

from typing import TYPE_CHECKING, Any

from lidarena.base.errors import ConfigError
from lidarena.base.lazy_names import lazy_names
from lidarena.envs.registration import Family, Registration

if TYPE_CHECKING:
    from lidarena.envs.corridor.central_env import BatchedCorridor, CorridorCentralEnv
    from lidarena.envs.corridor.shared_env import SharedCorridor

__all__ = ["FAMILY", "BatchedCorridor", "CorridorCentralEnv", "SharedCorridor"]

EPISODE_STEPS = 1000
"""Enough to cross the office some ten times."""
SHARED_ID = "lidarena/CorridorShared-v0"
"""Of the batch of robots that share a policy; there is no single environment of them."""


def refuse_single(**keywords: Any) -> "CorridorCentralEnv":
    """Say that robots that share a policy come in batches only.

    Raises:
        ConfigError: Always.
    """
    raise ConfigError(
        f"{SHARED_ID!r} is a batch of robots: make it with gym.make_vec(..., vectorization_mode='vector_entry_point'), "
        "or 'lidarena/CorridorCentral-v0' for a single team"
    )


FAMILY = Family(
    "corridor",
    ids={
        "lidarena/CorridorCentral-v0": Registration(
            "lidarena.envs.corridor.central_env:make_single",
            "lidarena.envs.corridor.central_env:BatchedCorridor",
            EPISODE_STEPS,
        ),
        SHARED_ID: Registration(
            "lidarena.envs.corridor:refuse_single",
            "lidarena.envs.corridor.shared_env:SharedCorridor",
            EPISODE_STEPS,
            agent="lidarena.agents.corridor.shared_fleet_agent:SharedFleetAgent",
        ),
    },
    measures="lidarena.evaluation.measures.corridor:MEASURES",
    baselines="lidarena.baselines.corridor",
    agent_options=(
        *("observation", "action", "neighbours", "guard"),
        *("lidar.beams", "lidar.max_range", "lidar.field_of_view"),
    ),
    keywords_of_0_1="lidarena.envs.corridor.options:modern_keywords",
)

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "BatchedCorridor": "lidarena.envs.corridor.central_env",
        "CorridorCentralEnv": "lidarena.envs.corridor.central_env",
        "SharedCorridor": "lidarena.envs.corridor.shared_env",
    },
)
