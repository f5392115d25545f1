"""The artificial potential and its force at a point (Yang et al., eqs. 1-15, misprints corrected).

Obstacles are discs and the room's walls; both are given to the kernels *grown by the robot's radius*, so that the robot
is a point. ρ_o is the distance to an obstacle's surface, ρ_g the distance to the goal.

One formula serves every variant of the repulsion (eqs. 3 and 8): ``½ η (1/ρ_o - 1/ρ_0)² w(ρ_g)`` with the weight
``w = (min(ρ_g, cap) / unit)^n``. n = 0 is Khatib's; cap = ∞ and unit = 1 is Yang et al.'s; cap = unit = ρ_0 saturates,
since the printed weight multiplies the repulsion far from the goal by thousands.
"""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf

NEAREST = 1e-9
"""Distances to a surface below this count as this, so that forces stay finite (m)."""
_BUMP_ENDS = 6.0
"""A bump is left out beyond so many σ, where it is 1.5e-8 of its height."""

RECIPROCAL, SHIFTED, BUMP = 0.0, 1.0, 2.0
"""Shapes of a fill: eq. 15 as printed; the same less its value at the rim; a Gaussian."""


Rows = NDArray[np.float64]


class Obstacles(NamedTuple):
    """What a robot must not touch."""

    discs: NDArray[np.float64]
    """(K, 3) x, y, radius [m]."""
    walls: NDArray[np.float64]
    """(4,) x_min, y_min, x_max, y_max of the room [m]; infinite: no walls."""


class Field(NamedTuple):
    """The numbers of a field, all of them floats (one type for the compiler); lengths in metres."""

    k: float
    """Gain of the attraction."""
    d_0: float
    """Distance beyond which the attraction is constant (eq. 7); inf: eq. 1."""
    eta: float
    """Gain of the repulsion."""
    rho_0: float
    """Reach of an obstacle."""
    n: float
    """Exponent of ρ_g in the repulsion (eq. 8); 0: eq. 3."""
    cap: float
    """Distance to the goal at which the weight stops growing; inf: never."""
    unit: float
    """Distance to the goal at which the weight is 1."""
    fill_shape: float
    """``RECIPROCAL``, ``SHIFTED`` or ``BUMP``."""
    rho_1: float
    """Reach of a fill (eq. 15); a bump's σ is a third of it."""
    fill_cap: float
    """Fills nearer to the goal than this fade with ρ_g, so that the goal stays the minimum; 0: they do not."""


@inlined
def _weight(distance: float, n: float, cap: float, unit: float) -> float:
    if n == 0.0:
        return 1.0
    return float((min(distance, cap) / unit) ** n)


@inlined
def _weight_slope(distance: float, n: float, cap: float, unit: float) -> float:
    """Derivative of the weight by ρ_g; at the goal itself 0, as long as n > 1."""
    if n == 0.0 or distance >= cap or distance == 0.0:
        return 0.0
    return float(n * (distance / unit) ** (n - 1.0) / unit)


@inlined
def _fill_height(distance: float, s: float, shape: float, rho_1: float) -> float:
    if shape == BUMP:
        sigma = rho_1 / 3.0
        return s * math.exp(-0.5 * (distance / sigma) ** 2) if distance < _BUMP_ENDS * sigma else 0.0
    if distance > rho_1:
        return 0.0
    height = s / max(distance, NEAREST) ** 2
    return height - s / rho_1**2 if shape == SHIFTED else height


@inlined
def _fill_push(distance: float, s: float, shape: float, rho_1: float) -> float:
    """Force of a fill away from its middle."""
    if shape == BUMP:
        sigma = rho_1 / 3.0
        if distance >= _BUMP_ENDS * sigma:
            return 0.0
        return s * distance / sigma**2 * math.exp(-0.5 * (distance / sigma) ** 2)
    return 2.0 * s / max(distance, NEAREST) ** 3 if distance <= rho_1 else 0.0


@inlined
def wall_gap(x: float, y: float, walls: NDArray[np.float64], side: int) -> float:
    """Distance from a point to one of the room's four walls, negative behind it.

    Args:
        x: The point's x (m).
        y: The point's y (m).
        walls: (4,) x_min, y_min, x_max, y_max (m); ±inf where there is none.
        side: Which of them.
    """
    at = x if side % 2 == 0 else y
    return float(at - walls[side] if side < 2 else walls[side] - at)


@leaf
def potential_at(
    x: float, y: float, goal: Rows, discs: Rows, walls: Rows, field: Field, fills: Rows, count: int
) -> float:
    """Total potential (eq. 5 plus the fills, eq. 15) at a point; inf inside an obstacle.

    Args:
        x: The point's x (m).
        y: The point's y (m).
        goal: (2,) x, y (m).
        discs: (K, 3) x, y, radius grown by the robot's (m).
        walls: (4,) x_min, y_min, x_max, y_max, drawn in by the robot's radius (m).
        field: The parameters.
        fills: (F, 3) x, y, s of each fill; the first ``count`` are in use.
        count: How many fills there are.
    """
    rho_g = math.hypot(x - goal[0], y - goal[1])
    bounded = min(rho_g, field.d_0)
    total = field.k * bounded * (rho_g - 0.5 * bounded)
    squares = 0.0
    for i in range(discs.shape[0] + 4):
        if i < 4:
            gap = wall_gap(x, y, walls, i)
        else:
            dx, dy, reach = x - discs[i - 4, 0], y - discs[i - 4, 1], discs[i - 4, 2] + field.rho_0
            if dx * dx + dy * dy >= reach * reach:
                continue  # which most are, and what a square root is too dear for
            gap = math.hypot(dx, dy) - discs[i - 4, 2]
        if gap <= 0.0:
            return math.inf
        if gap < field.rho_0:
            squares += (1.0 / gap - 1.0 / field.rho_0) ** 2
    if squares > 0.0:
        total += 0.5 * field.eta * squares * _weight(rho_g, field.n, field.cap, field.unit)
    added = 0.0
    for i in range(count):
        away = math.hypot(x - fills[i, 0], y - fills[i, 1])
        added += _fill_height(away, fills[i, 2], field.fill_shape, field.rho_1)
    if field.fill_cap > 0.0:
        added *= _weight(rho_g, 2.0, field.fill_cap, field.fill_cap)
    return total + added


@leaf
def _repulsion(
    x: float, y: float, discs: NDArray[np.float64], walls: NDArray[np.float64], rho_0: float
) -> tuple[float, float, float]:
    """Sum over the obstacles of q/ρ_o² ∇ρ_o (x and y) and of q², with q = 1/ρ_o - 1/ρ_0."""
    fx, fy, squares = 0.0, 0.0, 0.0
    for i in range(discs.shape[0]):
        dx, dy = x - discs[i, 0], y - discs[i, 1]
        reach = discs[i, 2] + rho_0
        if dx * dx + dy * dy >= reach * reach:
            continue
        centre = math.sqrt(dx * dx + dy * dy)
        gap = max(centre - discs[i, 2], NEAREST)
        q = 1.0 / gap - 1.0 / rho_0
        push = q / (gap * gap * max(centre, NEAREST))
        fx += push * dx
        fy += push * dy
        squares += q * q
    for side in range(4):
        gap = wall_gap(x, y, walls, side)
        if gap < rho_0:
            gap = max(gap, NEAREST)
            q = 1.0 / gap - 1.0 / rho_0
            push = q / (gap * gap) * (1.0 if side < 2 else -1.0)
            squares += q * q
            if side % 2 == 0:
                fx += push
            else:
                fy += push
    return fx, fy, squares


@leaf
def force_at(
    x: float, y: float, goal: Rows, discs: Rows, walls: Rows, field: Field, fills: Rows, count: int
) -> tuple[float, float]:
    """Total force -∇U (eqs. 2, 4, 6, 9 and 10, the last with its sign put right) at a point; arguments as above."""
    gx, gy = x - goal[0], y - goal[1]
    rho_g = math.sqrt(gx * gx + gy * gy)
    if rho_g > 0.0:
        gx, gy = gx / rho_g, gy / rho_g
    fx, fy, squares = _repulsion(x, y, discs, walls, field.rho_0)
    weight = field.eta * _weight(rho_g, field.n, field.cap, field.unit)
    fx, fy = weight * fx, weight * fy  # F₁ N₁
    inwards = field.k * min(rho_g, field.d_0)
    inwards += 0.5 * field.eta * squares * _weight_slope(rho_g, field.n, field.cap, field.unit)  # F₂ N₂
    px, py, height = 0.0, 0.0, 0.0
    for i in range(count):
        dx, dy = x - fills[i, 0], y - fills[i, 1]
        away = math.sqrt(dx * dx + dy * dy)
        push = _fill_push(away, fills[i, 2], field.fill_shape, field.rho_1) / max(away, NEAREST)
        px += push * dx
        py += push * dy
        if field.fill_cap > 0.0:
            height += _fill_height(away, fills[i, 2], field.fill_shape, field.rho_1)
    if field.fill_cap > 0.0:
        fade = _weight(rho_g, 2.0, field.fill_cap, field.fill_cap)
        px, py = fade * px, fade * py
        inwards += height * _weight_slope(rho_g, 2.0, field.fill_cap, field.fill_cap)
    return fx + px - inwards * gx, fy + py - inwards * gy


@leaf
def potentials(points: Rows, goal: Rows, obstacles: Obstacles, field: Field, fills: Rows, values: Rows) -> None:
    """Write the potential at ``points`` (M, 2) into ``values`` (M,)."""
    for i in range(points.shape[0]):
        x, y = points[i, 0], points[i, 1]
        values[i] = potential_at(x, y, goal, obstacles.discs, obstacles.walls, field, fills, fills.shape[0])


@leaf
def forces(points: Rows, goal: Rows, obstacles: Obstacles, field: Field, fills: Rows, values: Rows) -> None:
    """Write the force at ``points`` (M, 2) into ``values`` (M, 2)."""
    for i in range(points.shape[0]):
        x, y = points[i, 0], points[i, 1]
        fx, fy = force_at(x, y, goal, obstacles.discs, obstacles.walls, field, fills, fills.shape[0])
        values[i, 0], values[i, 1] = fx, fy
