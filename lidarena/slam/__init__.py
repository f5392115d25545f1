"""SLAM: occupancy mapping, scan matching, the Rao-Blackwellised particle filter, the graph of poses, recorded logs.

    from lidarena import slam

    mapped = slam.map_log("intel.log.gz")  # or a log that read_log gave
    mapped.trajectory.poses, mapped.map.occupancy, mapped.doubts

    mapper = slam.Mapper(angles, max_range)  # scan by scan, in a robot's own program
    pose = mapper.add(time, odometry_pose, ranges)

They are imported when they are used for the first time.
"""

from typing import TYPE_CHECKING

from lidarena.base.lazy_names import lazy_names

if TYPE_CHECKING:
    from lidarena.slam.graph.mapper import MapParameters, Mapper
    from lidarena.slam.logs.map_files import save_log_map
    from lidarena.slam.logs.mapping import map_log
    from lidarena.slam.logs.reading import read_recording as read_log
    from lidarena.slam.logs.recorded_log import LogOptions

__all__ = ["LogOptions", "MapParameters", "Mapper", "map_log", "read_log", "save_log_map"]

__getattr__, __dir__ = lazy_names(
    __name__,
    {
        "LogOptions": "lidarena.slam.logs.recorded_log",
        "MapParameters": "lidarena.slam.graph.mapper",
        "Mapper": "lidarena.slam.graph.mapper",
        "map_log": "lidarena.slam.logs.mapping",
        "read_log": "lidarena.slam.logs.reading:read_recording",
        "save_log_map": "lidarena.slam.logs.map_files",
    },
)
