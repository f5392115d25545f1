"""Stereo odometry of an underwater vehicle over the seabed: the seabed family."""

from lidarena.envs.base_env import entry_point
from lidarena.envs.registration import Family, Registration
from lidarena.envs.seabed.env import BatchedSeabed, SeabedEnv

__all__ = ["FAMILY", "BatchedSeabed", "SeabedEnv"]

EPISODE_STEPS = 5000
"""A position for every frame of the longer scene needs 4,500."""

make_single = entry_point(SeabedEnv)

FAMILY = Family(
    "seabed",
    ids={
        "lidarena/Seabed-v0": Registration(
            "lidarena.envs.seabed:make_single", "lidarena.envs.seabed.env:BatchedSeabed", EPISODE_STEPS
        )
    },
    measures="lidarena.evaluation.measures.seabed:MEASURES",
    baselines="lidarena.baselines.seabed",
    agent_options=("observation", "skips"),
)
