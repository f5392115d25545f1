"""Scenes of circles, and a validator that shares nothing with the planners: dense samples, plain numpy."""

import itertools

import numpy as np

PRINTED = np.array([(10, 90, 0), (40, 45, 0), (65, 45, 0), (74, 74, 0)], dtype=float)
ROOM = (-5.0, -5.0, 95.0, 95.0)
GOAL = (70.0, 70.0)


def trap(degrees, count, radius=0.0):
    """The printed obstacles and an arc about (12, 12), its back to the goal."""
    angles = np.radians(45 + np.linspace(-degrees / 2, degrees / 2, count))
    arc = np.column_stack([12 + 6 * np.cos(angles), 12 + 6 * np.sin(angles)])
    circles = np.vstack([PRINTED[:, :2], arc])
    return np.column_stack([circles, np.full(len(circles), radius)])


def length(path):
    return float(np.hypot(*np.diff(path, axis=0).T).sum())


def sampled(path, spacing):
    """Points (n, 2) along a polyline, every corner among them."""
    parts = [path[:1]]
    for a, b in itertools.pairwise(path):
        count = int(np.hypot(*(b - a)) / spacing) + 1
        parts.append(a + (b - a) * (np.arange(1, count + 1) / count)[:, None])
    return np.vstack(parts)


def clearance(path, circles, robot_radius=0.0, bounds=None, spacing=0.01):
    """Least distance of a path to any surface, from samples; inf alone."""
    points, least = sampled(np.asarray(path), spacing), np.inf
    for x, y, radius in np.asarray(circles, dtype=float).reshape(-1, 3):
        least = min(least, float(np.hypot(points[:, 0] - x, points[:, 1] - y).min()) - radius)
    if bounds is not None:
        least = min(least, float((points - bounds[:2]).min()), float((bounds[2:] - points).min()))
    return least - robot_radius


def scattered(rng, count=15, room=100.0, apart=3.0):
    """Circles away from both ends of the room's diagonal."""
    circles = np.column_stack([rng.uniform(0, room, (count, 2)), rng.uniform(0.02, 0.05, count) * room])
    start, goal = np.full(2, 0.05 * room), np.full(2, 0.95 * room)
    away = [np.hypot(*(circles[:, :2] - end).T) - circles[:, 2] > apart for end in (start, goal)]
    return circles[away[0] & away[1]], start, goal
