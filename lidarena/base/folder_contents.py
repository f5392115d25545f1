"""A file or folder as bytes, for machines that share no disk."""

from pathlib import Path

Contents = dict[str, bytes]
"""Of files, by their paths below the folder; of a single file under an empty name."""


def read_contents(path: Path) -> Contents:
    """Return what a file or folder holds; nothing of what there is not."""
    if path.is_file():
        return {"": path.read_bytes()}
    return {one.relative_to(path).as_posix(): one.read_bytes() for one in sorted(path.rglob("*")) if one.is_file()}


def write_contents(path: Path, contents: Contents) -> None:
    """Write a file or folder again; folders above it are made."""
    for name, content in contents.items():
        place = path / name if name else path
        place.parent.mkdir(parents=True, exist_ok=True)
        place.write_bytes(content)
