"""The folder of a mapped log: map, trajectory, pose graph, picture and results, all of them at once or none."""

import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from lidarena.base.files import write_figure, write_text
from lidarena.slam.logs.mapping import LogMap
from lidarena.slam.logs.posegraph_file import save_g2o
from lidarena.slam.logs.recorded_log import RecordedLog
from lidarena.slam.logs.relations import RelationErrors
from lidarena.slam.logs.replay_picture import draw_map
from lidarena.slam.logs.results_folder import replace_results
from lidarena.slam.logs.trajectory import save_kitti, save_tum
from lidarena.world.map_server import save_map

if TYPE_CHECKING:
    from matplotlib.figure import Figure

MAP_FILES = (
    "map.yaml",
    "map.pgm",
    "trajectory.tum",
    "trajectory.kitti",
    "posegraph.g2o",
    "picture.png",
    "results.json",
)


def save_log_map(
    folder: str | os.PathLike[str], log: RecordedLog, result: LogMap, errors: RelationErrors | None = None
) -> Path | None:
    """Write ``MAP_FILES`` as `replace_results` does, which says what is returned and raised.

    Args:
        folder: Where to.
        log: The log.
        result: Its map.
        errors: Against relations, if there are any.
    """
    picture = draw_loops(log, result)

    def fill(there: Path) -> None:
        save_map(there / "map.yaml", result.map.occupancy, result.map.resolution, result.map.origin)
        save_tum(there / "trajectory.tum", result.trajectory)
        save_kitti(there / "trajectory.kitti", result.trajectory)
        save_g2o(there / "posegraph.g2o", result.graph)
        write_figure(there / "picture.png", picture)
        write_text(there / "results.json", json.dumps(map_results(log, result, errors), indent=2) + "\n")

    return replace_results(folder, MAP_FILES, fill)


def draw_loops(log: RecordedLog, result: LogMap) -> "Figure":
    """Draw a map with the robot's way and the loops that were closed, in a figure that opens no window."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(11.0, 9.0), dpi=130, layout="constrained")
    axes = figure.subplots()
    draw_map(axes, result.map, result.trajectory.poses)
    order = {int(scan): node for node, scan in enumerate(result.graph.scans)}
    kept = [loop for loop in result.loops if loop.kept and loop.from_scan in order and loop.to_scan in order]
    for loop in kept:
        ends = result.graph.nodes[[order[loop.from_scan], order[loop.to_scan]], :2]
        axes.plot(*ends.T, color="#009E73", linewidth=1.2)
    axes.set_title(f"{log.name}: {len(log.ranges):,} scans, {len(kept):,} loops closed (green)")
    return figure


def map_results(log: RecordedLog, result: LogMap, errors: RelationErrors | None = None) -> dict[str, Any]:
    """What ``results.json`` holds; the two errors are None without relations."""
    kept = [loop for loop in result.loops if loop.kept]
    return {
        "translation_m": float(errors.translation.mean()) if errors else None,
        "rotation_deg": float(np.degrees(errors.rotation).mean()) if errors else None,
        "relations": len(errors.translation) if errors else 0,
        "readings": len(log.times),
        "scans": len(log.ranges),
        "scans_per_second": round(len(log.ranges) / max(result.seconds, 1e-9), 1),
        "nodes": len(result.readings),
        "loops_closed": len(kept),
        "loops_rejected": len(result.loops) - len(kept),
        "largest_loop_residual_m": max((float(loop.residual) for loop in kept), default=0.0),
        "notes": list(log.notes),
        "warnings": list(result.doubts),
    }
