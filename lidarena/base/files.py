"""Files and folders that are either whole or not there: written under a temporary name, then renamed."""

import os
import shutil
from collections.abc import Callable
from pathlib import Path


def write_bytes(path: str | Path, data: bytes) -> Path:
    """Write ``data`` to ``path`` so that a reader sees the old file or the new one, never half of it.

    Args:
        path: The file; missing parent folders are made.
        data: Its whole content.

    Returns:
        ``path`` as a `Path`.

    Raises:
        OSError: The disk is full or the place is not writable; the old file is then untouched.
    """
    target = Path(path)
    target.parent.mkdir(parents=True, exist_ok=True)
    temporary = target.with_name(f".{target.name}.{os.getpid()}.part")
    try:
        with temporary.open("wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(temporary, target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise
    return target


def write_text(path: str | Path, text: str) -> Path:
    """Write ``text`` as UTF-8, like `write_bytes`."""
    return write_bytes(path, text.encode("utf-8"))


def write_folder(folder: str | Path, fill: Callable[[Path], None]) -> Path:
    """Make a folder whose files appear all at once.

    Args:
        folder: The folder to make; it must not exist yet.
        fill: Called with a temporary folder beside it, into which it writes.

    Returns:
        ``folder`` as a `Path`.

    Raises:
        FileExistsError: ``folder`` is already there.
        OSError: The disk is full or the place is not writable; nothing is left behind then.
    """
    target = Path(folder)
    if target.exists():
        raise FileExistsError(f"{target} is already there")
    temporary = target.with_name(f".{target.name}.{os.getpid()}.part")
    shutil.rmtree(temporary, ignore_errors=True)
    temporary.mkdir(parents=True)
    try:
        fill(temporary)
        os.replace(temporary, target)
    except BaseException:
        shutil.rmtree(temporary, ignore_errors=True)
        raise
    return target
