"""Active SLAM: the exploration family."""

from lidarena.envs.base_env import entry_point
from lidarena.envs.exploration.env import BatchedExploration, ExplorationEnv
from lidarena.envs.registration import Family, Registration

__all__ = ["FAMILY", "BatchedExploration", "ExplorationEnv"]

EPISODE_STEPS = 1000
"""DA-SLAM's cap in training."""
_MAPS = {f"lidarena/Env{k}-v0": f"env{k}" for k in (1, 2, 3, 4)} | {"lidarena/Exploration-v0": "willow_lobby"}


make_single = entry_point(ExplorationEnv)

FAMILY = Family(
    "exploration",
    ids={
        name: Registration(
            "lidarena.envs.exploration:make_single",
            "lidarena.envs.exploration.env:BatchedExploration",
            EPISODE_STEPS,
            {"map": plan},
        )
        for name, plan in _MAPS.items()
    }
    | {
        "lidarena/GoalChoice-v0": Registration(
            "lidarena.agents.exploration.goal_choice_env:GoalChoiceEnv",
            "lidarena.agents.exploration.goal_choice_batch:GoalChoiceBatch",
            agent="lidarena.agents.exploration.goal_choice_agent:GoalChoiceAgent",
        )
    },
    measures="lidarena.evaluation.measures.exploration:MEASURES",
    baselines="lidarena.baselines.exploration",
    agent_options=("observation", "action", "lidar.max_range", "lidar.field_of_view"),
    keywords_of_0_1="lidarena.envs.exploration.options:keywords_of_0_1",
)
