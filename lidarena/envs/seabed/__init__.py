"""Stereo odometry of an underwater vehicle over the seabed: the seabed family."""

from typing import TYPE_CHECKING

from lidarena.base.lazy_names import lazy_names
from lidarena.envs.registration import Family, Registration

if TYPE_CHECKING:
    from lidarena.envs.seabed.env import BatchedSeabed, SeabedEnv

__all__ = ["FAMILY", "BatchedSeabed", "SeabedEnv"]

EPISODE_STEPS = 5000
"""A position for every frame of the longer scene needs 4,500."""

FAMILY = Family(
    "seabed",
    ids={
        "lidarena/Seabed-v0": Registration(
            "lidarena.envs.seabed.env:make_single", "lidarena.envs.seabed.env:BatchedSeabed", EPISODE_STEPS
        )
    },
    measures="lidarena.evaluation.measures.seabed:MEASURES",
    baselines="lidarena.baselines.seabed",
    agent_options=("observation", "skips", "overlaps"),
)

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "BatchedSeabed": "lidarena.envs.seabed.env",
        "SeabedEnv": "lidarena.envs.seabed.env",
    },
)
