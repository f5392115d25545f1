"""Reactive drivers for arenas in which obstacles move: velocity obstacles, and the dynamic window that knows none."""

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.baselines.arena.moving_tracks import MovingTracks, times_to_collision
from lidarena.baselines.arena.robot_interface import HeadingController
from lidarena.baselines.registry import register
from lidarena.envs.registration import owner_of

_HEADINGS = 72
_SPARE = 0.15
"""Room that is kept beside obstacles, as a share of a step."""
_HORIZON = 8.0
"""Collisions later than in so many steps do not matter."""
_FEAR, _CHANGE = 2.0, 0.15


class _ReactiveDriver:
    """Compares headings: how far they lead away from the goal's, and how soon they lead to a collision."""

    knows_motion = True

    def __init__(self, env: Any) -> None:
        self._heading = HeadingController(env)
        period = float(owner_of(env, "step_length").options.decision_period)
        self._tracks = MovingTracks(self._heading.lidar, self._heading.step, period)
        self.reset()

    def reset(self, seed: int | None = None) -> None:
        """Begin a new episode; nothing here is random."""
        self._tracks.forget()

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action.

        Args:
            observation: Not read.
            info: The environment's; ``scan``, ``pose``, ``goal`` and ``radius`` are used, and ``moving`` if it is told.
        """
        pose, step = np.asarray(info["pose"], np.float64), self._heading.step
        obstacles = self._tracks.read(info)
        if not self.knows_motion:
            obstacles[:, 2:4] = 0.0
        goal = np.asarray(info["goal"], np.float64) - pose[:2]
        bearing, away = math.atan2(goal[1], goal[0]), float(np.hypot(*goal))
        headings = np.asarray(bearing + np.arange(_HEADINGS) * (2.0 * math.pi / _HEADINGS), np.float64)
        velocities = step * np.column_stack([np.cos(headings), np.sin(headings)])
        times = times_to_collision(pose[:2], velocities, float(info["radius"]) + _SPARE * step, obstacles)
        times = np.where(times > away / step + 1.0, np.inf, times)  # behind the goal
        costs = self._costs(headings, bearing, float(pose[2]), times)
        best = int(np.argmin(costs))
        self._heading.show(np.stack([pose[:2], pose[:2] + 3.0 * velocities[best]]))
        return self._heading.towards(float(headings[best]), pose)

    @staticmethod
    def _costs(
        headings: NDArray[np.float64], bearing: float, theta: float, times: NDArray[np.float64]
    ) -> NDArray[np.float64]:
        """What each heading costs: the turn away from the goal, the change of heading, and fear of collisions."""
        off = np.abs((headings - bearing + math.pi) % (2.0 * math.pi) - math.pi)
        change = np.abs((headings - theta + math.pi) % (2.0 * math.pi) - math.pi)
        fear = np.where(times < _HORIZON, _FEAR * (_HORIZON / np.maximum(times, 0.2) - 1.0) / _HORIZON, 0.0)
        fear += np.where(times < 1.0, 100.0 * (1.0 - times), 0.0)
        costs: NDArray[np.float64] = off + _CHANGE * change + _FEAR * fear
        return costs


@register("velocity_obstacles", family="arena")
class VelocityObstacles(_ReactiveDriver):
    """Velocity obstacles (Fiorini & Shiller 1998) at constant speed: headings that lead to a collision soon are dear.

    Where obstacles are and how they move it takes from ``info["moving"]`` or, where that is not told, from what the
    lidar saw now and before. As all reactive methods it knows no way out of a dead end.
    """

    def __init__(self, env: Any) -> None:
        """Make it for an arena environment."""
        super().__init__(env)


@register("dwa", family="arena")
class DynamicWindow(_ReactiveDriver):
    """The dynamic window approach (Fox, Burgard & Thrun 1997) at constant speed: it takes all obstacles to stand.

    The robot turns on the spot before each step, so that all headings are in the window.
    """

    knows_motion = False

    def __init__(self, env: Any) -> None:
        """Make it for an arena environment."""
        super().__init__(env)
