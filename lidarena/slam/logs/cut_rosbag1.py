"""Records of a rosbag 1 from the front, as far as it goes (wiki.ros.org/Bags/Format/2.0)."""

import bz2
import struct
from collections.abc import Iterator
from pathlib import Path

from lz4.frame import LZ4FrameDecompressor  # type: ignore[import-untyped]

_MESSAGE, _CHUNK, _CONNECTION = 2, 5, 7


def rosbag1_records(file: Path) -> Iterator[tuple[str, str, str, int | None, bytes]]:
    """Topics and messages, see ``cut_bags.Record``; a chunk that was cut is read as far as it can be unpacked."""
    connections: dict[int, tuple[str, str, str]] = {}
    data = file.read_bytes()
    for head, body in _unchunked(data[data.find(b"\n") + 1 :]):
        try:
            kind = head["op"][0]
            if kind == _CONNECTION:
                about = _fields(body)
                number = struct.unpack("<I", head["conn"])[0]
                told = (head["topic"], about["type"], about["message_definition"])
                connections[number] = (told[0].decode(), told[1].decode(), told[2].decode())
                yield (*connections[number], None, b"")
            elif kind == _MESSAGE:
                number = struct.unpack("<I", head["conn"])[0]
                seconds, nanoseconds = struct.unpack("<II", head["time"])
                if number in connections:
                    yield (*connections[number], seconds * 10**9 + nanoseconds, body)
        except (KeyError, IndexError, struct.error, UnicodeDecodeError):
            continue


def _unchunked(data: bytes) -> Iterator[tuple[dict[str, bytes], bytes]]:
    """Headers and bodies of the whole records, those in chunks unpacked."""
    for head, body, whole in _records(data):
        if head.get("op") == bytes([_CHUNK]):
            inside = _records(_unpacked(body, head.get("compression", b"none")))
            yield from ((each, content) for each, content, complete in inside if complete)
        elif whole:
            yield head, body


def _records(data: bytes) -> Iterator[tuple[dict[str, bytes], bytes, bool]]:
    """Header, body and whether it is whole."""
    at = 0
    while at + 4 <= len(data):
        (size,) = struct.unpack_from("<I", data, at)
        middle = at + 4 + size
        if middle + 4 > len(data):
            return
        (length,) = struct.unpack_from("<I", data, middle)
        yield _fields(data[at + 4 : middle]), data[middle + 4 : middle + 4 + length], middle + 4 + length <= len(data)
        at = middle + 4 + length


def _fields(data: bytes) -> dict[str, bytes]:
    """``name=value`` pairs, each with its length before it."""
    found, at = {}, 0
    while at + 4 <= len(data):
        (size,) = struct.unpack_from("<I", data, at)
        name, _, value = data[at + 4 : at + 4 + size].partition(b"=")
        found[name.decode("latin-1")] = value
        at += 4 + size
    return found


def _unpacked(data: bytes, compression: bytes) -> bytes:
    """As much as can be unpacked."""
    if compression == b"none":
        return data
    try:
        maker = bz2.BZ2Decompressor if compression == b"bz2" else LZ4FrameDecompressor
        return bytes(maker().decompress(data))
    except (OSError, RuntimeError, EOFError):
        return b""
