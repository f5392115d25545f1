"""How far apart positions are computed: the adaptive step of Bobkov et al., and what two views have in common."""

import math

import numpy as np
from numpy.typing import NDArray

from lidarena.base.keyword_checks import check_range
from lidarena.vision.camera import StereoCamera
from lidarena.vision.features import Region
from lidarena.vision.rigid_motion import moved

Floats = NDArray[np.float64]


def adaptive_step(camera: StereoCamera, height: float, speed: float, rate: float, overlap: float) -> int:
    """The most frames between two positions whose views overlap enough, at least 1: N = ⌊(1 - overlap) L rate / speed⌋.

    L = height · (image height) / f is the footprint along the way (Bobkov et al., Fig. 1).

    Args:
        camera: Its image's height is along the way.
        height: Above the seabed; that of the nearest part of it, to be sure [m].
        speed: Of the vehicle [m/s].
        rate: Frames a second.
        overlap: Share of the view, such as 0.5 or 0.75.
    """
    check_range("overlap", overlap, 0.0, 0.999)
    footprint = height * camera.height / camera.focal
    return max(1, math.floor((1.0 - overlap) * footprint * rate / max(speed, 1e-6)))


def nearest_depth(points: Floats) -> float:
    """The depth that 95% of points (N, 3) exceed [m]; NaN if there are none."""
    depths = points[:, 2][np.isfinite(points[:, 2])]
    return float(np.quantile(depths, 0.05)) if len(depths) else math.nan


def view_overlap(camera: StereoCamera, motion: Floats, depth: float) -> float:
    """Share of the first view that the second shows too, if the ground is level at a depth.

    Args:
        camera: Of both.
        motion: (4, 4) from the first to the second.
        depth: [m].
    """
    columns, rows = np.meshgrid(np.linspace(0, camera.width - 1, 13), np.linspace(0, camera.height - 1, 9))
    across, down = (columns - camera.center_x) / camera.focal, (rows - camera.center_y) / camera.focal
    points = depth * np.stack([across.ravel(), down.ravel(), np.ones(columns.size)], axis=1)
    seen = camera.project(moved(motion, points))
    inside = (seen[:, 0] >= 0) & (seen[:, 0] < camera.width) & (seen[:, 1] >= 0) & (seen[:, 1] < camera.height)
    return float(inside.mean())


def common_view(
    camera: StereoCamera, motion: Floats, depths: tuple[float, float], margin: float = 12.0
) -> tuple[Region, Region] | None:
    """The parts of two left images that show what both see: the clipping of Bobkov et al.

    Args:
        camera: Of both.
        motion: (4, 4) about from the first to the second.
        depths: Of the nearest and the farthest ground [m].
        margin: Around it [pixels].

    Returns:
        The region of the first and of the second image; None if nothing is common.
    """
    flat = np.array([(u, v) for u in (0.0, camera.width - 1.0) for v in (0.0, camera.height - 1.0)])
    regions = []
    for way in (np.linalg.inv(motion), motion):
        shown = []
        for depth in depths:
            rays = np.column_stack([(flat - (camera.center_x, camera.center_y)) / camera.focal, np.ones(len(flat))])
            shown.append(camera.project(moved(np.asarray(way, np.float64), depth * rays))[:, :2])
        every = np.vstack(shown)
        if not np.isfinite(every).all():
            return None
        low, high = np.floor(every.min(axis=0) - margin), np.ceil(every.max(axis=0) + margin)
        left, top = max(int(low[0]), 0), max(int(low[1]), 0)
        right, bottom = min(int(high[0]), camera.width), min(int(high[1]), camera.height)
        if right - left < 16 or bottom - top < 16:
            return None
        regions.append((left, top, right, bottom))
    return regions[0], regions[1]
