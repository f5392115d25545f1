"""The folder of a replay: map, trajectory, picture and results, all of them at once or none."""

import json
import os
from collections.abc import Collection
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.files import check_writable, replace_folder, write_figure, write_text
from lidarena.slam.logs.carmen import LogError, RecordedLog
from lidarena.slam.logs.relations import RelationErrors
from lidarena.slam.logs.replay import Replay
from lidarena.slam.logs.replay_picture import draw_replay
from lidarena.slam.logs.trajectory import save_tum
from lidarena.world.map_server import save_map

FILES = ("map.yaml", "map.pgm", "trajectory.tum", "picture.png", "results.json")


def check_folder(folder: str | os.PathLike[str], files: Collection[str] = FILES) -> None:
    """Refuse, before the work begins, a folder that holds other people's files.

    Args:
        folder: Where results are to go.
        files: What an earlier run may have left there.

    Raises:
        LogError: It is a file, or a folder with anything but an earlier replay in it.
        WriteError: It cannot be written to.
    """
    place = Path(folder)
    check_writable(place)
    if place.exists() and not place.is_dir():
        raise LogError(f"{str(place)!r} is a file; a folder is needed for the results")
    if place.is_dir() and (others := sorted(set(os.listdir(place)) - set(files))):
        raise LogError(
            f"folder {str(place)!r} holds {others[0]!r}; an empty or new one, or an earlier replay's is needed"
        )


def save_replay(
    folder: str | os.PathLike[str], log: RecordedLog, result: Replay, errors: RelationErrors | None = None
) -> Path | None:
    """Write ``map.yaml`` and ``map.pgm``, ``trajectory.tum``, ``picture.png`` and ``results.json``.

    The folder appears whole. An earlier replay's is kept: it moves to ``folder.1``, ``folder.2``, …

    Args:
        folder: Where to.
        log: The log.
        result: What was made of it.
        errors: Against relations, if there are any.

    Returns:
        Where the earlier replay is now, None if there was none.

    Raises:
        LogError: The folder holds something else.
        WriteError: The disk is full or the place is not writable; what was there is left as it was.
    """
    check_folder(folder)
    picture = draw_replay(log, result)

    def fill(there: Path) -> None:
        save_map(there / "map.yaml", result.map.occupancy, result.map.resolution, result.map.origin)
        save_tum(there / "trajectory.tum", result.trajectory)
        write_figure(there / "picture.png", picture)
        write_text(there / "results.json", json.dumps(results(result, errors), indent=2) + "\n")

    return replace_folder(os.fspath(folder), fill)


def results(result: Replay, errors: RelationErrors | None = None) -> dict[str, Any]:
    """What ``results.json`` holds; the two errors are None without relations."""
    return {
        "translation_m": _moments(errors.translation) if errors else None,
        "rotation_deg": _moments(np.degrees(errors.rotation)) if errors else None,
        "relations": len(errors.translation) if errors else 0,
        "scan_updates": len(result.readings),
        "updates_per_second": round(result.updates_per_second, 1),
    }


def _moments(values: NDArray[np.float64]) -> dict[str, float]:
    return {"mean": float(values.mean()), "std": float(values.std())}
