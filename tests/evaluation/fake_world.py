"""A corridor and some drivers, small enough for tests; `tests.evaluation.fake_world:fake/Corridor-v0` registers them.

The robot drives along x, its odometry slips, and SLAM believes something in between; the corridor is 4 m long.
"""

from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces

from lidarena.base.errors import ConfigError, suggest
from lidarena.world.floorplan import Floorplan

LENGTH = 4.0
KEYWORDS = {"slip": 0.02, "stop_at": 0.995, "reward": "completeness", "observation": "da_slam", "truth": True}


class Corridor(gym.Env[Any, Any]):
    """Actions: 0 forward 0.1 m, 1 back 0.1 m, 2 crash."""

    metadata = {"render_modes": ["rgb_array"], "render_fps": 5}  # noqa: RUF012
    family = "exploration"

    def __init__(self, expose_truth: bool = False, render_mode: str | None = None, **keywords: Any) -> None:
        for key in keywords.keys() - KEYWORDS.keys():
            raise ConfigError(f"there is no keyword {key!r}{suggest(key, KEYWORDS)}")
        self.keywords = {**KEYWORDS, **keywords}
        self.expose_truth, self.render_mode = expose_truth and self.keywords["truth"], render_mode
        self.observation_space = spaces.Box(0, 1, (2,), np.float32)
        self.action_space = spaces.Discrete(3)
        self.floorplan = Floorplan.from_shapes(
            "corridor",
            (0, 0, LENGTH, 1),
            [[0, 0, LENGTH, 0], [0, 1, LENGTH, 1]],
            circles=[[3.5, 0.9, 0.2]],
            start=(0.3, 0.5, 0),
        )
        self._pose, self._believed = np.zeros(3), np.zeros(3)

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed, options=options)
        self._pose[:] = self._believed[:] = (0.3, 0.5, 0.0)
        self._grid = np.full((20, 80), -1, dtype=np.int8)
        self._steps, self._path, self._crashed, self._reached = 0, 0.0, False, 0.3
        return self._observation(), self._info()

    def step(self, action: int) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        before = self._completeness()
        move = {0: 0.1, 1: -0.1, 2: 0.0}[int(action)]
        slip = self.keywords["slip"] * self.np_random.standard_normal()
        self._pose[0] = np.clip(self._pose[0] + move + slip, 0.1, LENGTH - 0.1)
        self._believed[0] = self._pose[0] + slip
        self._path += abs(move)
        self._steps += 1
        self._crashed = action == 2
        self._reached = max(self._reached, float(self._pose[0]))
        gained = self._completeness() - before
        done = self._completeness() >= self.keywords["stop_at"]
        return self._observation(), 100 * gained - 100 * self._crashed, done or self._crashed, False, self._info()

    def render(self) -> np.ndarray:
        frame = np.full((41, 160, 3), 255, dtype=np.uint8)
        column = int(self._pose[0] * 40)
        frame[15:25, max(0, column - 4) : column + 4] = (200, 30, 30)
        return frame

    def _completeness(self) -> float:
        return min(1.0, self._reached / (LENGTH - 0.2))

    def _observation(self) -> np.ndarray:
        return np.array([self._believed[0] / LENGTH, self._completeness()], dtype=np.float32)

    def _info(self) -> dict[str, Any]:
        column = int(20 * self._reached)
        self._grid[1:19, :column] = 0
        self._grid[[0, 19], :column] = 100
        view = self._grid.view()
        view.flags.writeable = False
        info: dict[str, Any] = {
            "completeness": self._completeness(),
            "pose": self._believed,  # on purpose the same array every time
            "odometry_pose": self._believed + np.array([0.1 * self._steps, 0, 0]),
            "d_optimality": 1e-4 * (1 + self._steps),
            "entropy": 1.5,
            "path_length": 0.0,
            "time": 0.2 * self._steps,
            "collision": self._crashed,
            "success": not self._crashed and self._completeness() >= self.keywords["stop_at"],
            "map": view,
            "resolution": 0.05,
            "origin": np.zeros(2),
        }
        if self.expose_truth:
            info["truth"] = {"pose": self._pose, "path_length": self._path}
        return info


class Driver:
    """Forward, with a seeded share of steps back; may finish or fail on its own."""

    def __init__(self, env: Any, back: float = 0.1, finish_at: int | None = None, fail_at: int | None = None) -> None:
        self.back, self.finish_at, self.fail_at = back, finish_at, fail_at

    def reset(self, seed: int | None = None) -> None:
        self.rng = np.random.default_rng(seed)
        self.finished = False
        self.decisions = 0
        self.seed = seed

    def act(self, observation: Any, info: dict[str, Any]) -> int:
        self.decisions += 1
        if self.decisions == self.fail_at:
            raise ZeroDivisionError("the driver lost its way\nand this is a second line")
        self.finished = self.decisions == self.finish_at
        return int(self.rng.random() < self.back)


class Crasher(Driver):
    """Crashes in the third step."""

    def act(self, observation: Any, info: dict[str, Any]) -> int:
        self.decisions += 1
        return 2 if self.decisions == 3 else 0


class Dying(Driver):
    """Dies without a word, as a process does that runs out of memory."""

    def act(self, observation: Any, info: dict[str, Any]) -> int:
        import os

        self.decisions += 1
        if self.decisions == 40:  # after the dry run
            os._exit(9)
        return 1


def mute(env: Any) -> object:
    """Makes something that is no policy."""
    return object()


if "fake/Corridor-v0" not in gym.registry:
    gym.register("fake/Corridor-v0", entry_point="tests.evaluation.fake_world:Corridor", max_episode_steps=120)
