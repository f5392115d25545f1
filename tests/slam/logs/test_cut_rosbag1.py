"""Records of a rosbag 1 from the front: chunks of every compression, and chunks that were cut."""

import bz2
import struct
from pathlib import Path

import pytest
from lz4.frame import compress

from lidarena.slam.logs.cut_rosbag1 import rosbag1_records


def fields(**values: bytes) -> bytes:
    pairs = [name.encode() + b"=" + value for name, value in values.items()]
    return b"".join(struct.pack("<I", len(pair)) + pair for pair in pairs)


def record(body: bytes, **head: bytes) -> bytes:
    packed = fields(**head)
    return struct.pack("<I", len(packed)) + packed + struct.pack("<I", len(body)) + body


def content(messages: int) -> bytes:
    about = fields(topic=b"/chat", type=b"std_msgs/String", md5sum=b"*", message_definition=b"string data")
    number = struct.pack("<I", 0)
    connection = record(about, op=b"\x07", conn=number, topic=b"/chat")
    said = [record(b"message %d" % k, op=b"\x02", conn=number, time=struct.pack("<II", 1, k)) for k in range(messages)]
    return connection + b"".join(said)


PACK = {b"none": lambda data: data, b"lz4": compress, b"bz2": bz2.compress}


@pytest.mark.parametrize("compression", PACK)
@pytest.mark.parametrize("missing", [0, 5])
def test_messages_come_in_order_as_far_as_the_file_goes(tmp_path: Path, compression: bytes, missing: int) -> None:
    inside = content(40)
    chunk = record(PACK[compression](inside), op=b"\x05", compression=compression, size=struct.pack("<I", len(inside)))
    head = record(b" " * 50, op=b"\x03", index_pos=struct.pack("<Q", 0))
    data = b"#ROSBAG V2.0\n" + head + chunk
    (tmp_path / "a.bag").write_bytes(data[: len(data) - missing])
    found = list(rosbag1_records(tmp_path / "a.bag"))
    if missing and not found:  # a compressed block that was cut gives nothing
        assert compression != b"none"
        return
    assert found[0] == ("/chat", "std_msgs/String", "string data", None, b"")
    stamps = [stamp for _, _, _, stamp, _ in found[1:]]
    assert stamps == [10**9 + k for k in range(len(stamps))]
    assert len(stamps) >= (39 if compression == b"none" else 0) and found[1][4] == b"message 0"


def test_rubbish_has_no_records(tmp_path: Path) -> None:
    (tmp_path / "a.bag").write_bytes(b"#ROSBAG V2.0\n" + bytes(range(256)) * 4)
    assert list(rosbag1_records(tmp_path / "a.bag")) == []
