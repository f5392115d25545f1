"""Records of an MCAP file from the front, as far as it goes (mcap.dev/spec)."""

import struct
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any

from lz4.frame import LZ4FrameDecompressor  # type: ignore[import-untyped]

if sys.version_info >= (3, 14):  # pragma: no cover
    from compression import zstd
else:
    from backports import zstd

_MAGIC = 8
_SCHEMA, _CHANNEL, _MESSAGE, _CHUNK = 3, 4, 5, 6
_ZSTD = b"\x28\xb5\x2f\xfd"


def mcap_records(file: Path) -> Iterator[tuple[str, str, str, int | None, bytes]]:
    """Topics and messages, see ``cut_bags.Record``; a chunk that was cut is read as far as it can be unpacked."""
    schemas: dict[int, tuple[str, str]] = {}
    channels: dict[int, tuple[str, str, str]] = {}
    for kind, body in _unchunked(file.read_bytes()[_MAGIC:]):
        try:
            if kind == _SCHEMA:
                name, rest = _text(body, 2)
                _, rest = _text(body, rest)
                schemas[_number(body)] = (name, _text(body, rest)[0])
            elif kind == _CHANNEL:
                schema = schemas.get(struct.unpack_from("<H", body, 2)[0])
                if schema is not None:
                    channels[_number(body)] = (_text(body, 4)[0], *schema)
                    yield (*channels[_number(body)], None, b"")
            elif kind == _MESSAGE and _number(body) in channels:
                stamp = struct.unpack_from("<Q", body, 6)[0]
                yield (*channels[_number(body)], int(stamp), unzstd(body[22:]))
        except (struct.error, UnicodeDecodeError):
            continue


def unzstd(data: bytes) -> bytes:
    """What was packed, if it was; bags may pack each message."""
    try:
        return bytes(zstd.decompress(data)) if data.startswith(_ZSTD) else data
    except zstd.ZstdError:
        return data


def _unchunked(data: bytes) -> Iterator[tuple[int, bytes]]:
    """Kinds and bodies of the records, those in chunks unpacked."""
    for kind, body, whole in _records(data):
        if kind == _CHUNK:
            try:
                compression, at = _text(body, 28)
            except (struct.error, UnicodeDecodeError):
                continue
            inside = _records(_unpacked(body[at + 8 :], compression))
            yield from ((each, content) for each, content, complete in inside if complete)
        elif whole:
            yield kind, body


def _records(data: bytes) -> Iterator[tuple[int, bytes, bool]]:
    """Kind, body and whether it is whole."""
    at = 0
    while at + 9 <= len(data):
        kind, size = struct.unpack_from("<BQ", data, at)
        yield kind, data[at + 9 : at + 9 + size], at + 9 + size <= len(data)
        at += 9 + size


def _unpacked(data: bytes, compression: str) -> bytes:
    """As much as can be unpacked."""
    makers: dict[str, Any] = {"lz4": LZ4FrameDecompressor, "zstd": zstd.ZstdDecompressor}
    if compression not in makers:
        return data if not compression else b""
    try:
        return bytes(makers[compression]().decompress(data))
    except (RuntimeError, EOFError, zstd.ZstdError):
        return b""


def _number(body: bytes) -> int:
    return int(struct.unpack_from("<H", body)[0])


def _text(body: bytes, at: int) -> tuple[str, int]:
    """A text with its length before it, and where it ends."""
    size = struct.unpack_from("<I", body, at)[0]
    if at + 4 + size > len(body):
        raise struct.error("too short")
    return body[at + 4 : at + 4 + size].decode(), at + 4 + size
