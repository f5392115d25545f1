"""Pictures of maps: PGM or PNG, read into grey values after a look at the header."""

import re
from pathlib import Path
from typing import Any

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import MapError
from lidarena.world.extent import check_extent

_PNG = b"\x89PNG\r\n\x1a\n"
_PNM_FIELDS = re.compile(rb"P[25](?:\s+|\s*#[^\n]*\n)+(\d+)(?:\s+|\s*#[^\n]*\n)+(\d+)(?:\s+|\s*#[^\n]*\n)+(\d+)\s")

_COMMENTS = re.compile(rb"\s*#[^\n]*\n")
"""What may stand after the maximum, besides one byte of white space."""
_TRAILING = 2
"""Bytes that editors leave at the end of a file."""


def read_picture(path: Path, where: str, resolution: float) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    """Read a PGM (P2, P5) or PNG picture.

    Args:
        path: The file.
        where: What messages call the map that it belongs to.
        resolution: Side of a pixel [m], to refuse an absurd area before it is decoded.

    Returns:
        Grey values 0…255, colours averaged, and which pixels are wholly transparent; both ``[row, column]`` with the
        picture's top row first.

    Raises:
        MapError: The file is missing, empty, torn, of another kind or too large.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise MapError(f"{where} names the picture {str(path)!r}, which cannot be read: {error.strerror}") from error
    picture = f"the picture {str(path)!r} of {where}"
    width, height = _checked_size(data, picture)
    data = _plain_header(data, width, height)
    check_extent(where, height, width, resolution)
    try:
        pixels = cv2.imdecode(np.frombuffer(data, dtype=np.uint8), cv2.IMREAD_UNCHANGED)
    except cv2.error:
        pixels = None
    if pixels is None or pixels.shape[:2] != (height, width):
        raise MapError(f"{picture} is damaged; a whole PGM or PNG file is needed")
    return _grey(pixels)


def _grey(pixels: NDArray[Any]) -> tuple[NDArray[np.float64], NDArray[np.bool_]]:
    scale = 255 / np.iinfo(pixels.dtype).max
    channels = pixels.reshape(*pixels.shape[:2], -1)
    transparent = np.zeros(pixels.shape[:2], dtype=np.bool_)
    if channels.shape[2] in (2, 4):
        transparent = channels[:, :, -1] == 0
        channels = channels[:, :, :-1]
    return channels.mean(axis=2, dtype=np.float64) * scale, transparent


def _checked_size(data: bytes, picture: str) -> tuple[int, int]:
    """Width and height from the header, if the file is as long as the header says."""
    if not data:
        raise MapError(f"{picture} is empty; a PGM or PNG file is needed")
    if data.startswith(_PNG):
        whole, (width, height) = _png_is_whole(data), _png_size(data)
    elif match := _PNM_FIELDS.match(data):
        width, height, deepest = (int(text) for text in match.groups())
        if deepest != 255:
            raise MapError(f"{picture} has {deepest} as its white; a PGM with 255 is needed")
        whole = data[:2] == b"P2" or len(data) - match.end() >= width * height
    elif data[:2] in (b"P2", b"P5"):
        raise MapError(f"{picture} has a torn header; width, height and 255 are needed after {data[:2].decode()}")
    else:
        raise MapError(f"{picture} is neither a PGM (P2, P5) nor a PNG file; only these are read")
    if not whole:
        raise MapError(f"{picture} is cut short after {len(data)} bytes; a whole PGM or PNG file is needed")
    return width, height


def _plain_header(data: bytes, width: int, height: int) -> bytes:
    """A binary PGM with the plainest header; other pictures as they are.

    A header may end in CRLF, or in a comment after the maximum. One byte of white space alone belongs to it by the
    format, so that readers take the rest for pixels; that the file is longer than declared gives it away.
    """
    match = _PNM_FIELDS.match(data)
    if data[:2] != b"P5" or match is None:
        return data
    first, size = match.end(), width * height
    for longer in _COMMENTS.finditer(data, match.end() - 1):
        if longer.start() > first or len(data) - first <= size + _TRAILING:
            break
        first = longer.end()
    if len(data) - first > size and data[first - 1 : first + 1] == b"\r\n":
        first += 1
    return b"P5\n%d %d\n255\n" % (width, height) + data[first : first + size]


def _png_size(data: bytes) -> tuple[int, int]:
    return int.from_bytes(data[16:20], "big"), int.from_bytes(data[20:24], "big")


def _png_is_whole(data: bytes) -> bool:
    """Whether the chunks follow each other up to the closing one."""
    position = len(_PNG)
    while position + 12 <= len(data):
        kind = data[position + 4 : position + 8]
        position += 12 + int.from_bytes(data[position : position + 4], "big")
        if kind == b"IEND":
            return position <= len(data)
    return False
