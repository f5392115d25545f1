"""From a task to the plans by which two can do it: orders, motion durations in the shared workspace, STNUs."""

from lidarena.envs.workshop.compiler.compiled import CompiledTask, compile_task
from lidarena.envs.workshop.compiler.motion import WorkspaceMotion, acquire_motion
from lidarena.envs.workshop.compiler.networks import (
    CATEGORIES,
    CONSISTENT,
    CONTROLLABLE,
    INCONSISTENT,
    categorize,
    plan_network,
)
from lidarena.envs.workshop.compiler.plans import enumerate_plans
from lidarena.envs.workshop.compiler.schedule import PlanProblem, Snapshot, predict, search_plans

__all__ = [
    "CATEGORIES",
    "CONSISTENT",
    "CONTROLLABLE",
    "INCONSISTENT",
    "CompiledTask",
    "PlanProblem",
    "Snapshot",
    "WorkspaceMotion",
    "acquire_motion",
    "categorize",
    "compile_task",
    "enumerate_plans",
    "plan_network",
    "predict",
    "search_plans",
]
