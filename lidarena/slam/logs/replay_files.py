"""The folder of a replay: map, trajectory, picture and results, all of them at once or none."""

import json
import os
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.files import write_figure, write_text
from lidarena.slam.logs.carmen import RecordedLog
from lidarena.slam.logs.relations import RelationErrors
from lidarena.slam.logs.replay import Replay
from lidarena.slam.logs.replay_picture import draw_replay
from lidarena.slam.logs.results_folder import replace_results
from lidarena.slam.logs.trajectory import save_tum
from lidarena.world.map_server import save_map

FILES = ("map.yaml", "map.pgm", "trajectory.tum", "picture.png", "results.json")


def save_replay(
    folder: str | os.PathLike[str], log: RecordedLog, result: Replay, errors: RelationErrors | None = None
) -> Path | None:
    """Write ``FILES`` as `replace_results` does, which says what is returned and raised.

    Args:
        folder: Where to; the one of an earlier replay is kept under another name.
        log: What was replayed.
        result: What the filter made of it.
        errors: Of the trajectory against relations, if there are any.
    """
    picture = draw_replay(log, result)

    def fill(there: Path) -> None:
        save_map(there / "map.yaml", result.map.occupancy, result.map.resolution, result.map.origin)
        save_tum(there / "trajectory.tum", result.trajectory)
        write_figure(there / "picture.png", picture)
        write_text(there / "results.json", json.dumps(results(result, errors), indent=2) + "\n")

    return replace_results(folder, FILES, fill)


def results(result: Replay, errors: RelationErrors | None = None) -> dict[str, Any]:
    """What ``results.json`` holds; the two errors are None without relations."""
    return {
        "translation_m": _moments(errors.translation) if errors else None,
        "rotation_deg": _moments(np.degrees(errors.rotation)) if errors else None,
        "relations": len(errors.translation) if errors else 0,
        "scan_updates": len(result.readings),
        "updates_per_second": round(result.updates_per_second, 1),
        "evidence_of_attempts": [round(each, 1) for each in result.evidence],
        "spread_of_attempts_m": {"nearest": result.spread.nearest, "farthest": result.spread.farthest},
    }


def _moments(values: NDArray[np.float64]) -> dict[str, float]:
    return {"mean": float(values.mean()), "std": float(values.std())}
