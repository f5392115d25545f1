"""A human and a robot in a workshop as a PettingZoo environment, in which both decide; see ``WorkshopTeamEnv``."""

from lidarena.envs.workshop.parallel_env import WorkshopTeamEnv, env, parallel_env, raw_env

__all__ = ["WorkshopTeamEnv", "env", "parallel_env", "raw_env"]
