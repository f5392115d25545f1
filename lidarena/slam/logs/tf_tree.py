"""ROS's transforms between frames, ``/tf`` and ``/tf_static``, as far as a planar robot needs them."""

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.planar import compose, wrapped

_FIXED = 1e-4
"""A transform that changes by less than this [m, rad] is a fixed one."""
_DEEPEST = 50
_Planar = tuple[float, float, float]
ODOMETRY_FRAMES = ("odom", "odom_combined", "odometry")


class TransformTree:
    """Transforms that were heard, each child frame with its parent and its poses over time."""

    def __init__(self) -> None:
        self._heard: dict[str, tuple[str, list[float], list[_Planar]]] = {}

    def add(self, parent: str, child: str, time: float, pose: _Planar) -> None:
        """Enter where ``child`` is in the frame ``parent`` at a time [s], as x, y, theta."""
        parent, child = parent.lstrip("/"), child.lstrip("/")
        before = self._heard.setdefault(child, (parent, [], []))
        if before[0] == parent:
            before[1].append(time)
            before[2].append(pose)

    def fixed(self, base: str, frame: str) -> NDArray[np.float64] | None:
        """Pose (3,) of ``frame`` on ``base``, None if the transforms do not lead there or move."""
        pose, here = np.zeros(3), frame
        for _ in range(_DEEPEST):
            if here == base:
                return pose
            if here not in self._heard:
                return None
            here, _, poses = self._heard[here]
            table = np.array(poses)
            if _moves(table):
                return None
            pose = compose(table[0], pose)
        return None

    def moving(self, frame: str) -> tuple[NDArray[np.float64], NDArray[np.float64], str] | None:
        """The robot's way by the transforms that lead to ``frame``, the laser's.

        It is the transform out of an odometry frame or, if there is none with such a name, the moving one that is
        nearest to the laser.

        Returns:
            Times (n,), poses (n, 3) and the name of the robot's frame; None if nothing moves.
        """
        here, found = frame, None
        for _ in range(_DEEPEST):
            if here not in self._heard:
                break
            parent, times, poses = self._heard[here]
            if len(times) > 1 and (parent in ODOMETRY_FRAMES or (found is None and _moves(np.array(poses)))):
                found = here
                if parent in ODOMETRY_FRAMES:
                    break
            here = parent
        if found is None:
            return None
        _, times, poses = self._heard[found]
        return np.array(times), np.array(poses, np.float64), found


def _moves(poses: NDArray[np.float64]) -> bool:
    """Whether poses (n, 3) are not all the same."""
    off = poses - poses[0]
    off[:, 2] = wrapped(off[:, 2])
    return bool(np.abs(off).max() > _FIXED)
