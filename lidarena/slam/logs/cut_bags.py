"""Messages out of a rosbag that was cut off: a robot lost power, a disk was full, a copy broke off.

Such files lack the index, or the end, that proper readers begin with. Here they are read from the front, record by
record, as far as they go (the formats: wiki.ros.org/Bags/Format/2.0, mcap.dev/spec, sqlite.org/fileformat2).
"""

import shutil
import sqlite3
import tempfile
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from lidarena.slam.logs.cut_mcap import mcap_records, unzstd
from lidarena.slam.logs.cut_rosbag1 import rosbag1_records

_FILE_ENDINGS = (".db3", ".mcap")


@dataclass(frozen=True)
class CutConnection:
    """A topic of a cut bag, told as the ``rosbags`` library tells it.

    Attributes:
        topic: Its name.
        msgtype: As in ``"sensor_msgs/msg/LaserScan"``.
        msgcount: Messages that can be read.
    """

    topic: str
    msgtype: str
    msgcount: int


@dataclass
class CutBag:
    """What can be read of a bag.

    Attributes:
        connections: Its topics.
        decode: Makes a message of its bytes and type.
        messages: (topic, stamp [ns], bytes) in the order of the file, of the types that were asked for.
    """

    connections: list[CutConnection]
    decode: Callable[[Any, str], Any]
    messages: list[tuple[str, int, bytes]] = field(default_factory=list)

    def chosen(self, topics: Iterable[str]) -> Iterator[tuple[CutConnection, int, bytes]]:
        """The messages of some topics."""
        known = {each.topic: each for each in self.connections}
        wanted = set(topics)
        for topic, stamp, raw in self.messages:
            if topic in wanted:
                yield known[topic], stamp, raw


def read_cut_bag(path: Path, kinds: Iterable[str]) -> CutBag | None:
    """Read what is left of a bag.

    Args:
        path: The file, or the folder of a rosbag 2.
        kinds: Message types that matter; others, such as pictures, are only counted.

    Returns:
        What there is; None where not even a topic can be made out.
    """
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore
    from rosbags.typesys.msg import normalize_msgtype

    wanted, definitions = set(kinds), {}
    types: dict[str, str] = {}
    counts: dict[str, int] = {}
    messages: list[tuple[str, int, bytes]] = []
    files = _files(path)
    ros1 = any(_begins(file, b"#ROSBAG") for file in files)
    for file in files:
        for topic, kind, definition, stamp, raw in _records(file):
            name = types.setdefault(topic, normalize_msgtype(kind))
            if stamp is None:
                definitions[name] = definition
                continue
            counts[topic] = counts.get(topic, 0) + 1
            if name in wanted:
                messages.append((topic, stamp, raw))
    if not types:
        return None
    store = get_typestore(Stores.ROS1_NOETIC if ros1 else Stores.ROS2_HUMBLE)
    for name in wanted & set(definitions):
        if ros1 and name not in store.types:
            store.register(get_types_from_msg(definitions[name], name))
    connections = [CutConnection(topic, name, counts.get(topic, 0)) for topic, name in types.items()]
    return CutBag(connections, store.deserialize_ros1 if ros1 else store.deserialize_cdr, messages)


def _files(path: Path) -> list[Path]:
    return sorted(one for one in path.iterdir() if one.suffix in _FILE_ENDINGS) if path.is_dir() else [path]


def _begins(file: Path, magic: bytes) -> bool:
    with file.open("rb") as stream:
        return stream.read(len(magic)) == magic


Record = tuple[str, str, str, int | None, bytes]
"""Topic, type, its definition, and stamp [ns] and bytes of a message; stamp None where a topic is introduced."""


def _records(file: Path) -> Iterator[Record]:
    if _begins(file, b"#ROSBAG"):
        yield from rosbag1_records(file)
    elif _begins(file, b"\x89MCAP"):
        yield from mcap_records(file)
    elif _begins(file, b"SQLite format 3"):
        yield from _sqlite_records(file)


def _sqlite_records(file: Path) -> Iterator[Record]:
    """Rows in the order in which they were written, up to the first page that is not there."""
    with tempfile.TemporaryDirectory() as folder:
        copy = Path(shutil.copy(file, Path(folder) / "bag.db3"))
        with copy.open("r+b") as stream:
            size = int.from_bytes(stream.read(18)[16:], "big")
            size = 65536 if size == 1 else max(size, 512)
            stream.truncate(copy.stat().st_size // size * size)  # a page that was cut would read as zeros
            stream.seek(92)
            stream.write(b"\0\0\0\0")  # makes the number of pages in the header invalid, so that the file's size counts
        database = sqlite3.connect(copy)
        try:
            topics = {}
            for number, topic, kind in database.execute("SELECT id, name, type FROM topics"):
                topics[number] = (topic, kind)
                yield topic, kind, "", None, b""
            rows = database.execute("SELECT topic_id, timestamp, data FROM messages ORDER BY rowid")
            for number, stamp, data in rows:
                if number in topics:
                    yield (*topics[number], "", int(stamp), unzstd(bytes(data)))
        except (sqlite3.DatabaseError, OverflowError):
            return
        finally:
            database.close()
