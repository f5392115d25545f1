"""Active SLAM: the exploration family."""

from lidarena.envs.base_env import entry_point
from lidarena.envs.exploration.env import BatchedExploration, ExplorationEnv
from lidarena.envs.exploration.goal_choice.env import BatchedGoalChoice, GoalChoiceEnv
from lidarena.envs.registration import Family, Registration

__all__ = ["FAMILY", "BatchedExploration", "BatchedGoalChoice", "ExplorationEnv", "GoalChoiceEnv"]

EPISODE_STEPS = 1000
"""DA-SLAM's cap in training."""
_MAPS = {f"lidarena/Env{k}-v0": f"env{k}" for k in (1, 2, 3, 4)} | {"lidarena/Exploration-v0": "willow_lobby"}


make_single = entry_point(ExplorationEnv)
make_choice = entry_point(GoalChoiceEnv)

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
            "lidarena.envs.exploration:make_choice",
            "lidarena.envs.exploration.goal_choice.env:BatchedGoalChoice",
            agent="lidarena.agents.exploration.goal_choice_agent:GoalChoiceAgent",
        )
    },
    measures="lidarena.evaluation.measures.exploration:MEASURES",
    baselines="lidarena.baselines.exploration",
    agent_options=("observation", "action", "lidar.max_range", "lidar.field_of_view"),
    keywords_of_0_1="lidarena.envs.exploration.options:keywords_of_0_1",
)
