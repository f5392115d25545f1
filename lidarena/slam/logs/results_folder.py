"""A folder of results of a log: all of its files appear at once or none does, and earlier ones are kept."""

import os
from collections.abc import Callable, Collection
from pathlib import Path

from lidarena.base.files import check_writable, replace_folder
from lidarena.slam.logs.recorded_log import LogError


def check_folder(folder: str | os.PathLike[str], files: Collection[str]) -> None:
    """Refuse, before the work begins, a folder that holds other people's files.

    Args:
        folder: Where results are to go.
        files: What an earlier run may have left there.

    Raises:
        LogError: It is a file, or a folder with anything but earlier results in it.
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


def replace_results(
    folder: str | os.PathLike[str], files: Collection[str], fill: Callable[[Path], None]
) -> Path | None:
    """Write a folder of results; earlier ones of the same name move to ``folder.1``, ``folder.2`` and so on.

    Args:
        folder: Where to.
        files: What it is going to hold.
        fill: Writes the files into the folder that it is given.

    Returns:
        Where the earlier results are now, None if there were none.

    Raises:
        LogError: The folder holds something else.
        WriteError: The disk is full or the place is not writable; what was there is left as it was.
    """
    check_folder(folder, files)
    return replace_folder(os.fspath(folder), fill)
