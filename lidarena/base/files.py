"""Files and folders that are either whole or not there: written under a temporary name, then renamed."""

import contextlib
import io
import itertools
import os
import platform
import shutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

from lidarena.base.errors import WriteError

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SUFFIX = ".part"
_filling: list[Path] = []


def write_bytes(path: str | Path, data: bytes) -> Path:
    """Write ``data`` to ``path`` so that a reader sees the old file or the new one, never half of it.

    Args:
        path: The file; missing parent folders are made.
        data: Its whole content.

    Returns:
        ``path`` as a `Path`.

    Raises:
        WriteError: The disk is full or the place is not writable; the old file is then untouched.
    """
    target = Path(path)
    temporary = _temporary(target)
    with _telling_of(target, temporary):
        target.parent.mkdir(parents=True, exist_ok=True)
        with temporary.open("wb") as stream:
            stream.write(data)
            stream.flush()
            os.fsync(stream.fileno())
        os.replace(temporary, target)
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
        WriteError: The disk is full or the place is not writable; nothing is left behind then.
    """
    target = Path(folder)
    if target.exists():
        raise FileExistsError(f"{target} is already there")
    temporary = _filled(target, fill)
    with _telling_of(target, temporary):
        os.replace(temporary, target)
    return target


def replace_folder(folder: str | Path, fill: Callable[[Path], None]) -> Path | None:
    """Make a folder whose files appear all at once, and keep the one that stands there.

    Args:
        folder: The folder to make.
        fill: Called with a temporary folder beside it, into which it writes.

    Returns:
        Where the earlier folder is now (see `set_aside`); None if there was none, or an empty one.

    Raises:
        WriteError: The disk is full or the place is not writable; what was there is left as it was.
    """
    target = Path(os.path.abspath(folder))  # "." has no name of its own
    temporary = _filled(target, fill)
    with _telling_of(target, temporary):
        earlier = set_aside(target)
        try:
            os.replace(temporary, target)
        except BaseException:
            if earlier:
                os.replace(earlier, target)
            raise
    return earlier


def write_figure(path: str | Path, figure: "Figure") -> Path:
    """Write a figure as PNG, like `write_bytes`."""
    picture = io.BytesIO()
    figure.savefig(picture, format="png")
    return write_bytes(path, picture.getvalue())


def check_writable(path: str | Path) -> None:
    """Refuse a place that cannot be written to, before hours of work go towards it; nothing is made.

    Raises:
        WriteError: The nearest folder that is there is not writable, or no folder.
    """
    place = Path(os.path.abspath(path))
    nearest = next(folder for folder in place.parents if os.path.lexists(folder))
    if not nearest.is_dir():
        raise WriteError(f"{str(path)!r} cannot be written: {str(nearest)!r} is no folder")
    if not os.access(nearest, os.W_OK | os.X_OK):
        raise WriteError(f"{str(path)!r} cannot be written: the folder {str(nearest)!r} is not writable")


def set_aside(folder: Path) -> Path | None:
    """Rename a folder to ``NAME.1``, or the next number that is free; remove it if it is empty.

    Returns:
        Its new place; None if there was none, or an empty one.

    Raises:
        WriteError: The place is not writable.
    """
    if not folder.exists():
        return None
    if not any(folder.iterdir()):
        folder.rmdir()
        return None
    aside = next_free(folder.with_name(f"{folder.name}."))
    os.replace(folder, aside)
    return aside


def next_free(start: Path) -> Path:
    """The first of ``start`` with 1, 2, … behind its name that does not exist."""
    candidates = (start.with_name(f"{start.name}{number}") for number in itertools.count(1))
    return next(path for path in candidates if not path.exists())


def _filled(target: Path, fill: Callable[[Path], None]) -> Path:
    """A temporary folder beside the target, full; it is gone again if filling it fails."""
    temporary = _temporary(target)
    with _telling_of(target, temporary):
        temporary.mkdir(parents=True)
        _filling.append(temporary)
        try:
            fill(temporary)
        finally:
            _filling.remove(temporary)
    return temporary


def unfinished_folders() -> tuple[Path, ...]:
    """Return the temporary folders that this process is filling, for whoever clears away if it is killed."""
    return tuple(_filling)


@contextlib.contextmanager
def _telling_of(target: Path, temporary: Path) -> Iterator[None]:
    """Remove what is temporary if anything goes wrong, and tell of the target what the system tells of that."""
    try:
        yield
    except BaseException as error:
        if temporary.is_dir():
            shutil.rmtree(temporary, ignore_errors=True)
        else:
            with contextlib.suppress(OSError):
                temporary.unlink(missing_ok=True)
        if isinstance(error, OSError) and _is_about(error, target, temporary):
            refusal = WriteError(f"{str(target)!r} cannot be written: {error.strerror}")
            refusal.errno, refusal.strerror, refusal.filename = error.errno, error.strerror, str(target)
            raise refusal from error
        raise


def _is_about(error: OSError, target: Path, temporary: Path) -> bool:
    """Whether it is writing that failed; a full disk raises without a name."""
    if error.errno is None:
        return False
    name = None if error.filename is None else Path(os.fsdecode(error.filename))
    return name is None or name in (target, *target.parents) or temporary in (name, *name.parents)


def _temporary(target: Path) -> Path:
    """Where something is written before it gets its name; what processes left there that were killed is removed."""
    mark = f".{target.name}.{platform.node()}-"
    with contextlib.suppress(OSError):
        for left in [entry for entry in os.scandir(target.parent) if entry.name.startswith(mark)]:
            owner = left.name[len(mark) :].removesuffix(_SUFFIX)
            if owner.isdecimal() and not _is_running(int(owner)):
                shutil.rmtree(left.path) if left.is_dir(follow_symlinks=False) else os.unlink(left.path)
    return target.with_name(f"{mark}{os.getpid()}{_SUFFIX}")


def _is_running(process: int) -> bool:
    """Whether there is a process of that number on this machine; where one cannot ask, that there is."""
    if os.name != "posix":
        return True
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:
        return True
    return process != os.getpid()  # what stands under one's own number is another's that had it before
