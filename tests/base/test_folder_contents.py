"""What a file or folder holds, there and back."""

from pathlib import Path

from lidarena.base.folder_contents import read_contents, write_contents


def test_a_folder_and_a_file_come_back(tmp_path: Path) -> None:
    (tmp_path / "a" / "b").mkdir(parents=True)
    (tmp_path / "a" / "b" / "c.bin").write_bytes(b"\x00\xff")
    (tmp_path / "a" / "d").write_text("d")
    contents = read_contents(tmp_path / "a")
    assert contents == {"b/c.bin": b"\x00\xff", "d": b"d"}
    write_contents(tmp_path / "new" / "a", contents)
    assert read_contents(tmp_path / "new" / "a") == contents
    write_contents(tmp_path / "one", read_contents(tmp_path / "a" / "d"))
    assert (tmp_path / "one").read_text() == "d"


def test_nothing_there_is_nothing(tmp_path: Path) -> None:
    assert read_contents(tmp_path / "nothing") == {}
