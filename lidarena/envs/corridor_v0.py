"""Teams of robots as a PettingZoo environment; see ``CorridorEnv``."""

from lidarena.envs.corridor.parallel_env import CorridorEnv, agent_name, env, parallel_env, raw_env

__all__ = ["CorridorEnv", "agent_name", "env", "parallel_env", "raw_env"]
