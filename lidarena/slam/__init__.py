"""SLAM: occupancy mapping, scan matching, the Rao-Blackwellised particle filter, the graph of poses, recorded logs.

    from lidarena import slam

    mapped = slam.map_log("intel.log.gz")  # or a log that read_log gave
    mapped.trajectory.poses, mapped.map.occupancy, mapped.doubts

    mapper = slam.Mapper(angles, max_range)  # scan by scan, in a robot's own program
    pose = mapper.add(time, odometry_pose, ranges)

They are imported when they are used for the first time.
"""

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from lidarena.slam.graph.mapper import MapParameters, Mapper
    from lidarena.slam.logs.map_files import save_log_map
    from lidarena.slam.logs.mapping import map_log
    from lidarena.slam.logs.reading import read_recording as read_log
    from lidarena.slam.logs.recorded_log import LogOptions

__all__ = ["LogOptions", "MapParameters", "Mapper", "map_log", "read_log", "save_log_map"]

_HOMES = {
    "LogOptions": ("lidarena.slam.logs.recorded_log", "LogOptions"),
    "MapParameters": ("lidarena.slam.graph.mapper", "MapParameters"),
    "Mapper": ("lidarena.slam.graph.mapper", "Mapper"),
    "map_log": ("lidarena.slam.logs.mapping", "map_log"),
    "read_log": ("lidarena.slam.logs.reading", "read_recording"),
    "save_log_map": ("lidarena.slam.logs.map_files", "save_log_map"),
}


def __getattr__(name: str) -> Any:
    if name not in _HOMES:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    module, inner = _HOMES[name]
    return getattr(import_module(module), inner)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
