"""A human and a robot that share a task and a floor: the workshop family."""

from lidarena.envs.base_env import entry_point
from lidarena.envs.registration import Family, Registration
from lidarena.envs.workshop.env import BatchedWorkshop, WorkshopEnv

__all__ = ["FAMILY", "BatchedWorkshop", "WorkshopEnv"]

EPISODE_STEPS = 400
"""Ten times what a task of 24 actions takes."""


make_single = entry_point(WorkshopEnv)

FAMILY = Family(
    "workshop",
    ids={
        "lidarena/Workshop-v0": Registration(
            "lidarena.envs.workshop:make_single", "lidarena.envs.workshop.env:BatchedWorkshop", EPISODE_STEPS
        )
    },
    measures="lidarena.evaluation.measures.workshop:MEASURES",
    baselines="lidarena.baselines.workshop",
    agent_options=("observation", "task"),
)
