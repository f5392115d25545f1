"""One episode: drive a policy through an environment and measure it against the truth."""

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from time import perf_counter
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines import Policy
from lidarena.envs.infos import Info
from lidarena.envs.registration import family_of
from lidarena.evaluation.measures.arena import measure_drive
from lidarena.evaluation.measures.exploration import map_iou
from lidarena.evaluation.measures.table_columns import names_for
from lidarena.evaluation.participants import Env
from lidarena.evaluation.statistics import geometric_mean

Floats = NDArray[np.float64]

EXPLORED = 0.99
"""Completeness that counts as success of an exploration, however its episode ended but by a collision."""
UNTIMED_DECISIONS = 5
"""Decisions at the start of an episode whose time is not counted: they load compiled code."""


@dataclass(frozen=True)
class Trace:
    """Where the robot went and what it believed, for pictures.

    Attributes:
        true: Positions, shape (T + 1, 2) [m]; empty (0, 2) if the environment does not expose the truth.
        estimated: Positions that SLAM believed, shape (T + 1, 2) [m].
        grid: Believed occupancy at the end, shape (rows, columns), -1 / 0 / 100; None if there is no map.
        resolution: Side of a cell [m].
        origin: Lower-left corner of cell [0, 0], shape (2,) [m].
        edges: Walls of the floor plan as x1, y1, x2, y2, shape (E, 4) [m].
        circles: Pillars of the floor plan as x, y, radius, shape (C, 3) [m].
        nodes: Nodes of the policy's own graph of the world, shape (V, 2) [m]; empty if it keeps none.
        links: Which of them it has joined, shape (L, 2).
        goal: Where the robot is to go, shape (1, 2) [m], or each of a team, (robots, 2); empty if it has no goal.
        team: Positions of a team's robots, shape (T + 1, robots, 2) [m]; empty for a single robot.
        collided: Which of them touched something, shape (robots,).
    """

    true: Floats
    estimated: Floats
    grid: NDArray[np.int8] | None
    resolution: float
    origin: Floats
    edges: Floats
    circles: Floats
    nodes: Floats = field(default_factory=lambda: np.empty((0, 2)))
    links: NDArray[np.int64] = field(default_factory=lambda: np.empty((0, 2), np.int64))
    goal: Floats = field(default_factory=lambda: np.empty((0, 2)))
    team: Floats = field(default_factory=lambda: np.empty((0, 0, 2)))
    collided: NDArray[np.bool_] = field(default_factory=lambda: np.empty(0, np.bool_))


@dataclass(frozen=True)
class Episode:
    """What came of one episode.

    Attributes:
        seed: Of the environment.
        measures: Values by `measures.MEASURES`' names, those of the environment's family, in SI units and fractions;
            NaN where the environment does not report what a measure needs.
        ending: Why it ended: ``success``, ``collision``, ``out of time``, ``out of patience`` (nothing new for too
            long) or ``policy finished``.
        progress: Time [s] and completeness after each step, shape (T + 1, 2).
        trace: For pictures, if it was asked for.
    """

    seed: int
    measures: dict[str, float]
    ending: str
    progress: NDArray[np.float32]
    trace: Trace | None = None


def policy_seed(seed: int) -> int:
    """Return the policy's seed for an environment's seed: another stream, so that their noises are independent."""
    return int(np.random.SeedSequence((seed, 1)).generate_state(1)[0])


def without_truth(info: Mapping[str, Any]) -> Info:
    """Return what a policy may see of an ``info``."""
    return Info({key: value for key, value in info.items() if key != "truth"})


def run_episode(
    env: Env,
    policy: Policy,
    seed: int,
    *,
    max_steps: int | None = None,
    keep_trace: bool = False,
    film: Callable[[Env], None] | None = None,
) -> Episode:
    """Run one episode and measure it.

    Args:
        env: Made with ``expose_truth=True``; the truth is kept from the policy.
        policy: Who drives.
        seed: Of the environment; the policy gets `policy_seed` of it.
        max_steps: Stop here, if the environment does not end the episode before.
        keep_trace: Keep the trajectory and the final map for pictures.
        film: Called with the environment after the reset and after every step.

    Returns:
        The measured episode.
    """
    observation, info = env.reset(seed=seed)
    policy.reset(seed=policy_seed(seed))
    log = _Log()
    log.note(info)
    terminated = truncated = False
    while not (terminated or truncated):
        if film:
            film(env)
        begin = perf_counter()
        action = policy.act(observation, without_truth(info))
        log.decisions.append(perf_counter() - begin)
        if getattr(policy, "finished", False):
            break
        observation, reward, terminated, truncated, info = env.step(action)
        truncated = truncated or len(log.decisions) == max_steps
        log.rewards.append(float(reward))
        log.note(info)
    if film and (terminated or truncated):
        film(env)
    ending = _ending(terminated, truncated, info)
    if ending == "out of time" and _is_early(env, len(log.decisions), max_steps):
        ending = "out of patience"
    trace = _trace(env, policy, info, log) if keep_trace else None
    return Episode(seed, _measures(env, log, info, ending), ending, log.progress(), trace)


def _measures(env: Env, log: "_Log", info: Mapping[str, Any], ending: str) -> dict[str, float]:
    """The measures of the environment's family."""
    family = family_of(env)
    values = log.measures(info, ending)
    if family == "exploration" and not info.get("collision", False):  # also where no completeness ends an episode
        values["success"] = float(ending == "success" or values["completeness"] >= EXPLORED)
    values |= dict(info.get("measures") or _map_quality(env, info))
    if family == "arena":
        values |= measure_drive(info, np.array(log.poses["true"]), log.scalars["clearance"], log.decisions)
    return {name: value for name, value in values.items() if name in names_for(family)}


def _ending(terminated: bool, truncated: bool, info: Mapping[str, Any]) -> str:
    if np.any(info.get("collision", False)):
        return "collision"
    if terminated:
        return "success"
    return "out of time" if truncated else "policy finished"


def _is_early(env: Env, steps: int, max_steps: int | None) -> bool:
    """Whether an episode that was cut off had steps left: the environment's ``patience`` ended it."""
    if env.spec is None or env.spec.kwargs.get("patience") is None:
        return False
    return steps < min(env.spec.max_episode_steps or math.inf, math.inf if max_steps is None else max_steps)


@dataclass
class _Log:
    """Everything noted during an episode; one entry for the reset, one for each step."""

    decisions: list[float] = field(default_factory=list)
    rewards: list[float] = field(default_factory=list)
    scalars: dict[str, list[float]] = field(default_factory=dict)
    poses: dict[str, list[Floats]] = field(default_factory=dict)
    team: list[Floats] = field(default_factory=list)

    def note(self, info: Mapping[str, Any]) -> None:
        """Copy what changes from step to step; the environment may reuse its arrays."""
        for key in ("completeness", "time", "d_optimality", "entropy", "entropy_gmapping", "clearance"):
            self.scalars.setdefault(key, []).append(float(info.get(key, np.nan)))
        for key, pose in (
            ("true", info.get("truth", {}).get("pose")),
            ("estimated", info.get("pose")),
            ("odometry", info.get("odometry_pose")),
        ):
            single = np.full(3, np.nan) if pose is None or np.ndim(pose) != 1 else pose
            self.poses.setdefault(key, []).append(np.array(single[:2], np.float64))
        if np.ndim(info.get("pose", 0.0)) == 2:
            self.team.append(np.array(info["pose"], dtype=np.float64)[:, :2])

    def measures(self, info: Mapping[str, Any], ending: str) -> dict[str, float]:
        """Return every measure of the finished episode."""
        values = {
            "completeness": self.scalars["completeness"][-1],
            "success": float(ending == "success"),
            "collision": float(ending == "collision"),
            "path_length": float(np.sum(info.get("truth", {}).get("path_length", np.nan))),
            "time": self.scalars["time"][-1],
            "d_optimality": float(geometric_mean(self._after_reset("d_optimality"))),
            "trajectory_error": self._position_error("estimated"),
            "odometry_error": self._position_error("odometry"),
            "return": float(np.sum(self.rewards)),
            "steps": float(len(self.rewards)),
            "decision_time": float(np.mean(self.decisions[UNTIMED_DECISIONS:] or self.decisions)),
        }
        return values | {key: float(np.mean(self._after_reset(key))) for key in ("entropy", "entropy_gmapping")}

    def progress(self) -> NDArray[np.float32]:
        """Return time and completeness, shape (T + 1, 2)."""
        return np.column_stack([self.scalars["time"], self.scalars["completeness"]]).astype(np.float32)

    def _after_reset(self, key: str) -> Floats:
        """A scalar after every step; the one of the reset only if no step was taken."""
        return np.array(self.scalars[key][1:] or self.scalars[key])

    def _position_error(self, key: str) -> float:
        """Mean distance to the true position over the episode [m]."""
        away = np.array(self.poses[key]) - np.array(self.poses["true"])
        return float(np.mean(np.hypot(away[:, 0], away[:, 1])))


def _map_quality(env: Env, info: Mapping[str, Any]) -> dict[str, float]:
    plan = getattr(env.unwrapped, "floorplan", None)
    if plan is None or "map" not in info:
        return {"map_iou": np.nan}
    return {"map_iou": map_iou(plan, info["map"], info["origin"], info["resolution"])}


def _trace(env: Env, policy: Policy, info: Mapping[str, Any], log: _Log) -> Trace:
    graph = getattr(policy, "graph", None)
    plan = getattr(env.unwrapped, "floorplan", None)
    true, estimated = (np.array(log.poses[key]) for key in ("true", "estimated"))
    if np.array_equal(true, estimated):  # the pose is known: there is no belief to draw beside it
        estimated = np.empty((0, 2))
    return Trace(
        true=true[~np.isnan(true).any(axis=1)],
        estimated=estimated[~np.isnan(estimated).any(axis=1)],
        grid=np.array(info["map"], dtype=np.int8) if "map" in info and not log.team else None,
        goal=np.array(info.get("goal", []), np.float64).reshape(-1, 2),
        team=np.array(log.team) if log.team else np.empty((0, 0, 2)),
        collided=np.array(info["collision"] if log.team else [], np.bool_),
        resolution=float(info.get("resolution", 0.05)),
        origin=np.array(info.get("origin", (0.0, 0.0)), dtype=np.float64),
        edges=np.array(plan.edges) if plan is not None else np.empty((0, 4)),
        circles=np.array(plan.circles) if plan is not None else np.empty((0, 3)),
        nodes=np.array(graph.positions, dtype=np.float64).reshape(-1, 2) if graph is not None else np.empty((0, 2)),
        links=np.array(sorted(graph.edges if graph is not None else []), dtype=np.int64).reshape(-1, 2),
    )
