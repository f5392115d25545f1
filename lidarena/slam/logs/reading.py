"""Any recorded log, whatever its format: told by its first bytes, not by its name."""

import os
from pathlib import Path

from lidarena.slam.logs.carmen import read_log
from lidarena.slam.logs.recorded_log import LogOptions, RecordedLog
from lidarena.slam.logs.rosbag import read_bag

_BAG_BEGINNINGS = (b"#ROSBAG", b"SQLite format 3", b"\x89MCAP")
_BAG_ENDINGS = (".bag", ".db3", ".mcap")


def read_recording(path: str | os.PathLike[str], options: LogOptions | None = None) -> RecordedLog:
    """Read a CARMEN log, a rosbag 1, a rosbag 2 (sqlite3 or MCAP; the file or its folder).

    Args:
        path: The file or folder.
        options: What it does not tell.

    Raises:
        LogError: It is missing, damaged, or holds no scans that make sense.
    """
    return read_bag(path, options) if _is_bag(Path(path)) else read_log(path, options=options)


def _is_bag(path: Path) -> bool:
    if path.is_dir():
        # a recorder that was killed leaves none of the metadata
        return (path / "metadata.yaml").exists() or any(one.suffix in _BAG_ENDINGS for one in path.iterdir())
    try:
        with path.open("rb") as stream:
            beginning = stream.read(16)
    except OSError:
        return False
    return beginning.startswith(_BAG_BEGINNINGS) or path.suffix in _BAG_ENDINGS
