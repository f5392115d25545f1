"""Golden episodes: every family driven for a while, and a digest of all bits that came out."""

import hashlib
import json
import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import gymnasium as gym
import llvmlite.binding
import numpy as np
from numba import njit

import lidarena
from lidarena.base.versions import library_versions
from lidarena.envs import corridor_v0
from lidarena.planning import plan_team
from lidarena.planning.potential_field import plan_path


class Digest:
    """Bits of arrays, numbers and dictionaries of them, in the order in which they are added."""

    def __init__(self) -> None:
        self._hash = hashlib.sha256()

    def add(self, value: Any) -> None:
        if isinstance(value, dict):
            for key in sorted(value):
                self.add(value[key])
            return
        array = np.asarray(value)
        array = array.astype(np.float64) if array.dtype.kind in "biu" else array
        self._hash.update(f"{array.dtype.str}{array.shape}".encode())
        self._hash.update(np.ascontiguousarray(array).tobytes())

    def text(self) -> str:
        return self._hash.hexdigest()[:24]


def _random_drive(env: Any, steps: int, seed: int, keys: tuple[str, ...]) -> str:
    digest = Digest()
    env.action_space.seed(seed)
    observation, info = env.reset(seed=seed)
    digest.add(observation)
    for _ in range(steps):
        observation, reward, terminated, truncated, info = env.step(env.action_space.sample())
        for value in (observation, reward, terminated, truncated, *(info[key] for key in keys)):
            digest.add(value)
        if isinstance(terminated, bool) and (terminated or truncated):
            observation, info = env.reset()
            digest.add(observation)
    env.close()
    return digest.text()


def _policy_drive(env: Any, name: str, steps: int, seed: int, keys: tuple[str, ...], picture: bool = False) -> str:
    digest = Digest()
    policy = lidarena.baselines.make(name, env)
    observation, info = env.reset(seed=seed)
    policy.reset(seed=seed)
    for _ in range(steps):
        observation, reward, terminated, truncated, info = env.step(policy.act(observation, info))
        for value in (observation, reward, terminated, truncated, *(info[key] for key in keys)):
            digest.add(value)
        if terminated or truncated or getattr(policy, "finished", False):
            break
    if picture:
        digest.add(env.render())
    env.close()
    return digest.text()


_EXPLORING = ("pose", "path_length", "covariance", "d_optimality", "map")


def _exploration(id_: str, steps: int, seed: int, **keywords: Any) -> Callable[[], str]:
    return lambda: _random_drive(gym.make(f"lidarena/{id_}", **keywords), steps, seed, _EXPLORING)


def _batch(id_: str, worlds: int, steps: int, keys: tuple[str, ...], **keywords: Any) -> Callable[[], str]:
    def drive() -> str:
        vector = gym.make_vec(f"lidarena/{id_}", worlds, vectorization_mode="vector_entry_point", **keywords)
        return _random_drive(vector, steps, 5, keys)

    return drive


def _team(steps: int, policy: str | None, **keywords: Any) -> Callable[[], str]:
    def drive() -> str:
        digest, fleet = Digest(), corridor_v0.parallel_env(**keywords)
        driver = lidarena.baselines.make(policy, fleet) if policy else None
        observations, infos = fleet.reset(seed=3)
        if driver:
            driver.reset(seed=3)
        rng = np.random.default_rng(4)
        for _ in range(steps):
            if not fleet.agents:
                break
            if driver:
                actions = driver.act(observations, infos)
            else:
                actions = {name: rng.uniform(-1, 1, 2).astype(np.float32) for name in fleet.agents}
            observations, rewards, terminations, truncations, infos = fleet.step(actions)
            poses = {name: info["pose"] for name, info in infos.items()}
            for value in (observations, rewards, terminations, truncations, poses):
                digest.add(value)
        fleet.close()
        return digest.text()

    return drive


def _choices() -> str:
    digest, env = Digest(), gym.make("lidarena/GoalChoice-v0", map="env2", max_episode_steps=4000)
    observation, _ = env.reset(seed=2)
    for choice in (0, 1, 0, 2, 0, 0):
        observation, reward, terminated, truncated, info = env.step(choice)
        for value in (observation, reward, terminated, truncated, info["path_length"], info["time"]):
            digest.add(value)
        if terminated or truncated:
            break
    env.close()
    return digest.text()


def _plans() -> str:
    digest, rng = Digest(), np.random.default_rng(7)
    for number in range(6):
        grid = rng.random((16, 16)) < 0.15
        free = np.argwhere(~grid)
        places = free[rng.choice(len(free), 10, replace=False)]
        for method in ("independent_astar", "prioritized_astar", "coordination", "prioritized_search"):
            ends = {"starts": places[:5], "goals": places[5:]}
            plan = plan_team(grid, **ends, radius=0.3, method=method, seed=number, time_limit=60.0)
            digest.add(float(plan.cost) if plan.solved else -1.0)
            digest.add(np.concatenate([np.asarray(path, np.float64) for path in plan.paths]) if plan.solved else 0.0)
    return digest.text()


def _field_plan() -> str:
    digest = Digest()
    circles = [[50, 48, 6], [60, 60, 4], [30, 35, 8]]
    plan = plan_path(circles, start=(0, 0), goal=(90, 90), robot_radius=1.0, bounds=(-5, -5, 100, 100))
    digest.add(plan.smoothed)
    return digest.text()


def _arena(policy: str, steps: int, **keywords: Any) -> Callable[[], str]:
    def drive() -> str:
        env = gym.make("lidarena/Arena-v0", **keywords)
        return _policy_drive(env, policy, steps, 1, ("pose", "path_length", "scan", "clearance"))

    return drive


def _explorer(policy: str, id_: str, steps: int, **keywords: Any) -> Callable[[], str]:
    return lambda: _policy_drive(gym.make(f"lidarena/{id_}", **keywords), policy, steps, 1, _EXPLORING)


_SMALL = {"max_episode_steps": 40}
CASES: dict[str, Callable[[], str]] = {
    "exploration, da_slam": _exploration("Env1-v0", 60, 1),
    "exploration, d_optimality": _exploration(
        "Env2-v0", 60, 2, reward="d_optimality", action="continuous", observation="da_slam_entropy"
    ),
    "exploration, combined, map": _exploration("Env3-v0", 60, 3, reward="combined", observation="map"),
    "exploration, compass, truth": _exploration("Env4-v0", 80, 4, observation="frontier_histogram", slam="truth"),
    "exploration, sectors, maze": _exploration(
        "Exploration-v0", 60, 5, map="maze:7", observation="sectors", start="random", particles=10
    ),
    "exploration, batch": _batch(
        "Exploration-v0", 3, 90, _EXPLORING[:4], map=["willow_lobby", "env1", "maze:3"], observation="map", **_SMALL
    ),
    "exploration, batch, truth": _batch("Env3-v0", 3, 90, _EXPLORING[:4], slam="truth", patience=4.0, **_SMALL),
    "frontier": _explorer("frontier", "Env2-v0", 200),
    "ealc": _explorer("ealc", "Env3-v0", 200, observation="map", action="continuous"),
    "goal choice": _choices,
    "arena, random": _batch("Arena-v0", 3, 60, ("pose", "scan"), action="discrete", arena="random", **_SMALL),
    "arena, proximity": _batch("Arena-v0", 2, 60, ("pose", "scan"), arena="u_trap", observation="proximity", **_SMALL),
    "apf_improved": _arena("apf_improved", 80, arena="yang:u"),
    "apf": _arena("apf", 80, arena="random:4"),
    "apf_lidar": _arena("apf_lidar", 80, arena="u_trap:2", knowledge="lidar"),
    "apf_improved_lidar": _arena("apf_improved_lidar", 80, arena="random:5", knowledge="lidar"),
    "astar": _arena("astar", 80, arena="env2", goal=(5.0, 6.0), start=(1.0, 1.0)),
    "corridor, parallel": _team(60, None, map="office", robots=4),
    "corridor, central": _batch("CorridorCentral-v0", 2, 60, (), robots=3, map="unstructured", action="discrete"),
    "corridor, shared": _batch("CorridorShared-v0", 8, 60, (), robots=4, map="office", **_SMALL),
    "prioritized_search": _team(150, "prioritized_search", map="office", robots=4),
    "prioritized_astar": _team(100, "prioritized_astar", map="unstructured", robots=3, motion_noise=0.5),
    "plan_team": _plans,
    "plan_path": _field_plan,
}


RECORDED = Path(__file__).with_name("golden.json")
"""The digests of ``CASES``, and the arithmetic that they were recorded with."""


@njit
def _compiled(x: Any) -> Any:
    out = np.empty((6, len(x)))
    for k in range(len(x)):
        out[0, k], out[1, k], out[2, k] = math.sin(x[k]), math.cos(x[k]), math.atan2(x[k], 0.3)
        out[3, k], out[4, k], out[5, k] = math.exp(x[k]), math.log(abs(x[k]) + 1e-9), math.hypot(x[k], 0.7)
    return out


def arithmetic() -> dict[str, str]:
    """What the bits of an episode depend on beside the source: the processor, its mathematics and the libraries."""
    x, digest = np.random.default_rng(0).uniform(-9.0, 9.0, 4096), Digest()
    digest.add(_compiled(x))
    for values in (x, x.astype(np.float32)):
        for function in (np.sin, np.cos, np.exp, np.tanh, np.arctan, np.sqrt):
            digest.add(function(values))
        digest.add(np.hypot(values, values[::-1]))
        digest.add(values.sum())
        digest.add(values.reshape(64, 64) @ values.reshape(64, 64).T)
    digest.add(np.linalg.eigvalsh(np.cov(x[:4095].reshape(3, -1))))
    versions = {name: str(version) for name, version in library_versions(("numpy", "numba", "pymunk", "scipy")).items()}
    del versions["python"]
    return {"processor": llvmlite.binding.get_host_cpu_name(), "mathematics": digest.text(), **versions}


def record() -> None:
    """Write ``golden.json`` anew."""
    content = {"arithmetic": arithmetic(), "digests": {name: case() for name, case in CASES.items()}}
    RECORDED.write_text(json.dumps(content, indent=1, ensure_ascii=False) + "\n", encoding="utf-8")


if __name__ == "__main__":  # python -m tests.golden: after a fault was mended that changes bits
    record()
