"""Who must have passed where before whom: a team's plan as an order of events instead of a timetable.

Robots are late; a plan that is free of conflicts in time need not stay so. What makes it safe is the order in which
robots pass each place, and that order can be kept at any speed: before a robot begins a step of its path, everybody who
passes near that step earlier in the plan must have completed the step with which he does (action dependencies: Ma,
Kumar & Koenig 2017; Hönig et al. 2019). Dependencies point to earlier steps of the plan, or from a robot to the one
whose room it takes in the same step, so the robot farthest behind may go on, unless robots follow each other in a
ring: the order itself brings no other deadlock.
"""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf
from lidarena.planning.team.team_plan import TeamPlan


@inlined
def _point_to_segment(px: float, py: float, ax: float, ay: float, bx: float, by: float) -> float:
    """Squared distance of a point p from the segment a b."""
    dx, dy = bx - ax, by - ay
    square = dx * dx + dy * dy
    share = min(max(((px - ax) * dx + (py - ay) * dy) / square, 0.0), 1.0) if square > 0.0 else 0.0
    ex, ey = px - ax - share * dx, py - ay - share * dy
    return ex * ex + ey * ey


@leaf
def _segments_apart(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64], d: NDArray[np.float64]
) -> float:
    """Distance between the segments a b and c d."""
    least = min(
        min(
            _point_to_segment(a[0], a[1], c[0], c[1], d[0], d[1]), _point_to_segment(b[0], b[1], c[0], c[1], d[0], d[1])
        ),
        min(
            _point_to_segment(c[0], c[1], a[0], a[1], b[0], b[1]), _point_to_segment(d[0], d[1], a[0], a[1], b[0], b[1])
        ),
    )
    one = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    two = (b[0] - a[0]) * (d[1] - a[1]) - (b[1] - a[1]) * (d[0] - a[0])
    three = (d[0] - c[0]) * (a[1] - c[1]) - (d[1] - c[1]) * (a[0] - c[0])
    four = (d[0] - c[0]) * (b[1] - c[1]) - (d[1] - c[1]) * (b[0] - c[0])
    if one * two < 0.0 and three * four < 0.0:
        return 0.0
    return math.sqrt(least)


@leaf
def _follows(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64], d: NDArray[np.float64], apart: float
) -> bool:
    """Whether who goes from a to b needs room that another makes by going from c to d at the same time."""
    close = (apart - 1e-6) ** 2
    return (
        _point_to_segment(c[0], c[1], a[0], a[1], b[0], b[1]) < close
        or _point_to_segment(b[0], b[1], c[0], c[1], d[0], d[1]) < close
    )


@leaf
def _same_step(
    a: NDArray[np.float64], b: NDArray[np.float64], c: NDArray[np.float64], d: NDArray[np.float64], apart: float
) -> int:
    """Steps that the second must be ahead of the first, in a step that both do near each other.

    One, if the first needs the second's room; none (they begin together) if both need each other's, or neither does.
    """
    return 1 if _follows(a, b, c, d, apart) and not _follows(c, d, a, b, apart) else 0


@leaf
def _fill(paths: NDArray[np.float64], lengths: NDArray[np.int64], apart: float, needed: NDArray[np.int64]) -> None:
    team = len(lengths)
    for i in range(team):
        for a in range(lengths[i]):
            for j in range(team):
                needed[i, a, j] = -1
                if j == i:
                    continue
                for b in range(min(a, lengths[j] - 1), -1, -1):
                    if _segments_apart(paths[i, a], paths[i, a + 1], paths[j, b], paths[j, b + 1]) < apart - 1e-6:
                        needed[i, a, j] = b + 1
                        if b == a:
                            first, then = paths[i], paths[j]
                            needed[i, a, j] = b + _same_step(first[a], first[a + 1], then[a], then[a + 1], apart)
                        break


class Precedence:
    """The order of events in a plan.

    Args:
        plan: One that is solved.
        apart: Two robots are in each other's way where their steps come nearer than this [cells].

    Attributes:
        paths: (k, longest + 1, 2) float cells, the last one over and over.
        lengths: (k,) steps of each path.
    """

    def __init__(self, plan: TeamPlan, apart: float) -> None:
        self.lengths = np.array([len(path) - 1 for path in plan.paths], np.int64)
        longest = int(self.lengths.max())
        self.paths = np.stack([np.pad(path, ((0, longest + 1 - len(path)), (0, 0)), "edge") for path in plan.paths])
        self.paths = self.paths.astype(np.float64)
        self._needed = np.full((len(self.lengths), max(longest, 1), len(self.lengths)), -1, np.int64)
        _fill(self.paths, self.lengths, float(apart), self._needed)

    def blocking_agents(self, robot: int, step: int, completed: NDArray[np.int64]) -> NDArray[np.int64]:
        """The robots that must go on before ``robot`` may begin a step.

        Args:
            robot: Which.
            step: Of its path, from 0 on.
            completed: (k,) how many steps each robot has completed.
        """
        return np.flatnonzero(self._needed[robot, step] > completed)
