"""A picture of a replayed log: the map with the robot's way, beside what the wheels alone would have made of it."""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.logs.carmen import RecordedLog
from lidarena.slam.logs.replay import Replay
from lidarena.slam.logs.traced_map import laser_odometry, trace_map
from lidarena.world.map_server import OccupancyMap

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_WALL, _FREE, _UNKNOWN = (34, 34, 34), (255, 255, 255), (222, 225, 230)
_DPI = 130
_MARGIN = 1.0
"""Around the map [m]."""


def draw_replay(log: RecordedLog, result: Replay) -> "Figure":
    """Draw a replay.

    Args:
        log: The log.
        result: What `lidarena.slam.logs.replay.replay` made of it.

    Returns:
        A figure that opens no window: on the left the map with the way of the robot, dark at its beginning
        and bright at its end, on the right the same scans drawn where the wheels' odometry puts them.
    """
    from matplotlib.figure import Figure

    height, width = result.map.occupancy.shape
    figure = Figure(figsize=(13.0, min(max(8.6 * height / width + 1.2, 4.5), 12.0)), dpi=_DPI, layout="constrained")
    left, right = figure.subplots(1, 2, gridspec_kw={"width_ratios": (2, 1)})
    length = float(np.hypot(*np.diff(log.odometry[:, :2], axis=0).T).sum())
    minutes = (result.trajectory.times[-1] - result.trajectory.times[0]) / 60.0
    figure.suptitle(f"{log.name}: {length:,.0f} m in {minutes:,.0f} minutes, {len(log.ranges):,} laser scans")
    way = draw_map(left, result.map, result.trajectory.poses)
    left.set_title("with SLAM: map and way of the robot")
    bar = figure.colorbar(way, ax=left, location="bottom", shrink=0.5, aspect=40, pad=0.02)
    bar.set_ticks([0.0, 1.0], labels=["start", f"{minutes:,.0f} min"])
    by_wheels = laser_odometry(log)[result.readings]
    scans = np.searchsorted(log.scan_readings, result.readings)
    draw_map(right, trace_map(log, scans, by_wheels), log.odometry)
    right.set_title("the same scans by the wheels alone")
    return figure


def draw_map(axes: "Axes", grid: OccupancyMap, poses: NDArray[np.float64]) -> Any:
    """Draw a map, the way (R, 3) coloured by time, its start and its end; returns the coloured way."""
    from matplotlib.collections import LineCollection

    colours = np.array([_UNKNOWN, _FREE, _WALL], np.uint8)[np.digitize(grid.occupancy, (0, 65))]
    rows, columns = grid.occupancy.shape
    x, y = grid.origin[:2]
    box = (x, x + columns * grid.resolution, y, y + rows * grid.resolution)
    axes.set_facecolor("#{:02x}{:02x}{:02x}".format(*_UNKNOWN))
    axes.imshow(colours, origin="lower", extent=box, interpolation="antialiased")
    ends = np.stack([poses[:-1, :2], poses[1:, :2]], axis=1)
    way = LineCollection(list(ends), cmap="plasma", array=np.linspace(0.0, 1.0, len(ends)), linewidths=1.0)
    axes.add_collection(way)
    axes.plot(*poses[0, :2], "o", color="#0072B2", markeredgecolor="white", markersize=9, label="start")
    axes.plot(*poses[-1, :2], "s", color="#D55E00", markeredgecolor="white", markersize=9, label="end")
    walls = np.argwhere(grid.occupancy >= 65) * grid.resolution + (y, x)
    if len(walls):  # stray beams through windows would shrink the building
        low, high = np.percentile(walls, (0.1, 99.9), axis=0)
        low, high = np.minimum(low, poses[:, 1::-1].min(axis=0)), np.maximum(high, poses[:, 1::-1].max(axis=0))
        axes.set_xlim(low[1] - _MARGIN, high[1] + _MARGIN)
        axes.set_ylim(low[0] - _MARGIN, high[0] + _MARGIN)
    axes.set_xlabel("x (m)")
    axes.set_ylabel("y (m)")
    axes.legend(loc="best", framealpha=0.9)
    return way
