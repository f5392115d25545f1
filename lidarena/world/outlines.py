"""Footprints of robots that are no discs: simple polygons about the centre that the robot turns about."""

import numpy as np
import pymunk.autogeometry
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError

LEAST_INSIDE = 0.01
"""The centre lies at least so far inside of an outline [m]."""
_FLAT = 1e-3
"""Corners that a convex part may leave out, where they stand out by less [m]."""

Floats = NDArray[np.float64]


def checked_outline(outline: object) -> Floats:
    """The corners (n, 2) of an outline, counter-clockwise [m].

    Raises:
        ConfigError: Fewer than three corners, numbers that are not finite, a polygon that crosses or touches itself, or
            one without the centre inside.
    """
    try:
        corners = np.asarray(outline, np.float64)
    except (TypeError, ValueError):
        corners = np.empty(0)
    if corners.ndim != 2 or corners.shape[1:] != (2,) or not np.isfinite(corners).all():
        raise ConfigError(f"robot.outline = {outline!r} must be the corners [[x, y], ...] of a polygon in metres")
    if len(corners) < 3:
        raise ConfigError(f"robot.outline has {len(corners)} corners; a polygon has at least 3")
    if not _is_simple(corners):
        raise ConfigError(f"robot.outline = {corners.tolist()} crosses or touches itself; a simple polygon is needed")
    turns = _turns(corners).sum()
    if abs(turns) < np.pi or edge_distances(corners).min() < LEAST_INSIDE:
        raise ConfigError(
            f"robot.outline = {corners.tolist()} must hold (0, 0), the centre that the robot turns about, at least "
            f"{LEAST_INSIDE} m from its edges"
        )
    return corners if turns > 0.0 else corners[::-1].copy()


def edge_distances(corners: Floats) -> Floats:
    """Of the centre from each edge (n,) [m]."""
    along = np.roll(corners, -1, axis=0) - corners
    share = np.clip(-(corners * along).sum(axis=1) / (along**2).sum(axis=1), 0.0, 1.0)
    return np.asarray(np.hypot(*(corners + share[:, None] * along).T))


def extents(corners: Floats, angles: Floats) -> Floats:
    """How far an outline reaches from the centre in directions (m,) [rad], (m,) [m]."""
    following = np.roll(corners, -1, axis=0)
    cos, sin = np.cos(angles)[:, None], np.sin(angles)[:, None]
    before, after = (cos * ends[:, 1] - sin * ends[:, 0] for ends in (corners, following))
    crossing = (before <= 0.0) & (after > 0.0)
    share = before / np.where(crossing, before - after, 1.0)
    x, y = (corners[:, axis] + share * (following - corners)[:, axis] for axis in (0, 1))
    return np.asarray(np.where(crossing, x * cos + y * sin, 0.0).max(axis=1))


def convex_parts(corners: Floats) -> list[list[tuple[float, float]]]:
    """Convex polygons that make up an outline, for rigid bodies: itself, where it is convex."""
    ring = [(float(x), float(y)) for x, y in corners]
    along = np.roll(corners, -1, axis=0) - corners
    before = np.roll(along, 1, axis=0)
    if (before[:, 0] * along[:, 1] - before[:, 1] * along[:, 0] >= 0.0).all():
        return [ring]
    parts = pymunk.autogeometry.convex_decomposition([*ring, ring[0]], _FLAT)
    return [[(float(x), float(y)) for x, y in part[:-1]] for part in parts]  # they come closed


def _turns(corners: Floats) -> Floats:
    """Angles (n,) under which the centre sees the edges, to the left [rad]."""
    headings = np.arctan2(corners[:, 1], corners[:, 0])
    return np.asarray((np.roll(headings, -1) - headings + np.pi) % (2.0 * np.pi) - np.pi)


def _is_simple(corners: Floats) -> bool:
    """Whether no two edges of a polygon meet except neighbours, in their common corner alone."""
    count, ends = len(corners), np.roll(corners, -1, axis=0)
    if (np.hypot(*(ends - corners).T) < 1e-9).any():
        return False
    for i in range(count):
        one, other = corners[i] - ends[i], ends[(i + 1) % count] - ends[i]
        if abs(_cross(one, other)) < 1e-12 and one @ other > 0.0:  # it turns back on itself
            return False
        for j in range(i + 2, count - (i == 0)):
            if _meet(corners[i], ends[i], corners[j], ends[j]):
                return False
    return True


def _cross(a: Floats, b: Floats) -> float:
    return float(a[0] * b[1] - a[1] * b[0])


def _meet(a: Floats, b: Floats, c: Floats, d: Floats) -> bool:
    """Whether two segments have a point in common."""
    c_side, d_side, a_side, b_side = (
        _cross(b - a, c - a), _cross(b - a, d - a), _cross(d - c, a - c), _cross(d - c, b - c)
    )  # fmt: skip
    if c_side * d_side < 0.0 and a_side * b_side < 0.0:
        return True
    touching = ((a, b, c, c_side), (a, b, d, d_side), (c, d, a, a_side), (c, d, b, b_side))
    return any(side == 0.0 and _within(p, q, point) for p, q, point, side in touching)


def _within(p: Floats, q: Floats, point: Floats) -> bool:
    return bool((np.minimum(p, q) <= point).all() and (point <= np.maximum(p, q)).all())
