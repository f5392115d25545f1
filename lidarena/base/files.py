"""Files and folders that are either whole or not there: written under a temporary name, then renamed."""

import contextlib
import itertools
import os
import shutil
from collections.abc import Callable, Iterator
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
    temporary = _temporary(target)
    with _naming(target):
        target.parent.mkdir(parents=True, exist_ok=True)
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
    _fill_folder(target, fill)
    return target


def replace_folder(folder: str | Path, fill: Callable[[Path], None]) -> Path | None:
    """Make a folder whose files appear all at once, and keep the one that stands there.

    Args:
        folder: The folder to make.
        fill: Called with a temporary folder beside it, into which it writes.

    Returns:
        Where the earlier folder is now (see `set_aside`); None if there was none, or an empty one.

    Raises:
        OSError: The disk is full or the place is not writable; what was there is left as it was.
    """
    target = Path(os.path.abspath(folder))  # "." has no name of its own
    whole = target.with_name(f".{target.name}.{os.getpid()}.new")
    _fill_folder(whole, fill)
    earlier = set_aside(target)
    try:
        os.replace(whole, target)
    except BaseException:
        if earlier:
            os.replace(earlier, target)
        shutil.rmtree(whole, ignore_errors=True)
        raise
    return earlier


def set_aside(folder: Path) -> Path | None:
    """Rename a folder to ``NAME.1``, or the next number that is free; remove it if it is empty.

    Returns:
        Its new place; None if there was none, or an empty one.

    Raises:
        OSError: The place is not writable.
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


def _fill_folder(target: Path, fill: Callable[[Path], None]) -> None:
    temporary = _temporary(target)
    shutil.rmtree(temporary, ignore_errors=True)
    with _naming(target):
        temporary.mkdir(parents=True)
        try:
            fill(temporary)
            os.replace(temporary, target)
        except BaseException:
            shutil.rmtree(temporary, ignore_errors=True)
            raise


@contextlib.contextmanager
def _naming(target: Path) -> Iterator[None]:
    """Let an error of the operating system, which a full disk raises without a name, tell what was written."""
    try:
        yield
    except OSError as error:
        if error.errno is not None and error.filename is None:
            error.filename = str(target)
        raise


def _temporary(target: Path) -> Path:
    return target.with_name(f".{target.name}.{os.getpid()}.part")
