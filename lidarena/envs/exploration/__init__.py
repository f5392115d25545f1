"""Active SLAM: the exploration family."""

from typing import TYPE_CHECKING

from lidarena.base.lazy_names import lazy_names
from lidarena.envs.registration import Family, Registration

if TYPE_CHECKING:
    from lidarena.envs.exploration.env import BatchedExploration, ExplorationEnv
    from lidarena.envs.exploration.goal_choice.env import BatchedGoalChoice, GoalChoiceEnv

__all__ = ["FAMILY", "BatchedExploration", "BatchedGoalChoice", "ExplorationEnv", "GoalChoiceEnv"]

EPISODE_STEPS = 1000
"""DA-SLAM's cap in training."""
_MAPS = {f"lidarena/Env{k}-v0": f"env{k}" for k in (1, 2, 3, 4)} | {"lidarena/Exploration-v0": "willow_lobby"}

FAMILY = Family(
    "exploration",
    ids={
        name: Registration(
            "lidarena.envs.exploration.env:make_single",
            "lidarena.envs.exploration.env:BatchedExploration",
            EPISODE_STEPS,
            {"map": plan},
        )
        for name, plan in _MAPS.items()
    }
    | {
        "lidarena/GoalChoice-v0": Registration(
            "lidarena.envs.exploration.goal_choice.env:make_choice",
            "lidarena.envs.exploration.goal_choice.env:BatchedGoalChoice",
            agent="lidarena.agents.exploration.goal_choice_agent:GoalChoiceAgent",
        )
    },
    measures="lidarena.evaluation.measures.exploration:MEASURES",
    baselines="lidarena.baselines.exploration",
    agent_options=("observation", "action", "lidar.max_range", "lidar.field_of_view"),
    keywords_of_0_1="lidarena.envs.exploration.options:keywords_of_0_1",
)

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "BatchedExploration": "lidarena.envs.exploration.env",
        "BatchedGoalChoice": "lidarena.envs.exploration.goal_choice.env",
        "ExplorationEnv": "lidarena.envs.exploration.env",
        "GoalChoiceEnv": "lidarena.envs.exploration.goal_choice.env",
    },
)
