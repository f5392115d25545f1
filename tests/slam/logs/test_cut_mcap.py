"""MCAP records from the front: chunks of every compression, and chunks that were cut."""

import struct
from pathlib import Path

import pytest
from backports import zstd
from lz4.frame import compress

from lidarena.slam.logs.cut_mcap import mcap_records, unzstd


def text(value: str) -> bytes:
    return struct.pack("<I", len(value.encode())) + value.encode()


def record(kind: int, body: bytes) -> bytes:
    return struct.pack("<BQ", kind, len(body)) + body


def content(messages: int) -> bytes:
    schema = record(3, struct.pack("<H", 7) + text("std_msgs/msg/String") + text("ros2msg") + text("string data"))
    channel = record(4, struct.pack("<HH", 2, 7) + text("/chat") + text("cdr") + struct.pack("<I", 0))
    said = [record(5, struct.pack("<HIQQ", 2, k, 1000 + k, 0) + b"message %d" % k) for k in range(messages)]
    return schema + channel + b"".join(said)


def chunk(inside: bytes, compression: str) -> bytes:
    packed = {"": lambda data: data, "lz4": compress, "zstd": zstd.compress}[compression](inside)
    head = struct.pack("<QQQI", 0, 0, len(inside), 0) + text(compression) + struct.pack("<Q", len(packed))
    return record(6, head + packed)


@pytest.mark.parametrize("compression", ["", "lz4", "zstd"])
@pytest.mark.parametrize("missing", [0, 5])
def test_messages_come_in_order_as_far_as_the_file_goes(tmp_path: Path, compression: str, missing: int) -> None:
    data = b"\x89MCAP0\r\n" + record(1, text("") * 2) + chunk(content(40), compression)
    (tmp_path / "a.mcap").write_bytes(data[: len(data) - missing])
    found = list(mcap_records(tmp_path / "a.mcap"))
    if missing and not found:  # a compressed block that was cut gives nothing
        assert compression
        return
    assert found[0] == ("/chat", "std_msgs/msg/String", "string data", None, b"")
    stamps = [stamp for _, _, _, stamp, _ in found[1:]]
    assert stamps == list(range(1000, 1000 + len(stamps))) and len(stamps) >= (39 if not compression else 0)
    assert found[1][4] == b"message 0"


def test_messages_that_are_packed_one_by_one_are_unpacked() -> None:
    assert unzstd(zstd.compress(b"abc")) == b"abc" and unzstd(b"abc") == b"abc"
    torn = zstd.compress(b"abc")[:6]
    assert unzstd(torn) == torn


def test_rubbish_has_no_records(tmp_path: Path) -> None:
    (tmp_path / "a.mcap").write_bytes(b"\x89MCAP0\r\n" + bytes(range(256)) * 4)
    assert list(mcap_records(tmp_path / "a.mcap")) == []
