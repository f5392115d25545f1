"""A human and a robot that share a task and a floor: the workshop family."""

from typing import TYPE_CHECKING

from lidarena.base.lazy_names import lazy_names
from lidarena.envs.registration import Family, Registration

if TYPE_CHECKING:
    from lidarena.envs.workshop.env import BatchedWorkshop, WorkshopEnv

__all__ = ["FAMILY", "BatchedWorkshop", "WorkshopEnv"]

EPISODE_STEPS = 400
"""Ten times what a task of 24 actions takes."""

FAMILY = Family(
    "workshop",
    ids={
        "lidarena/Workshop-v0": Registration(
            "lidarena.envs.workshop.env:make_single", "lidarena.envs.workshop.env:BatchedWorkshop", EPISODE_STEPS
        )
    },
    measures="lidarena.evaluation.measures.workshop:MEASURES",
    baselines="lidarena.baselines.workshop",
    agent_options=("observation", "task"),
)

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "BatchedWorkshop": "lidarena.envs.workshop.env",
        "WorkshopEnv": "lidarena.envs.workshop.env",
    },
)
