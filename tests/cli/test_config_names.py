"""Configurations by name, by file, and as the pages write them."""

from pathlib import Path

import pytest

from lidarena.base.errors import ConfigError
from lidarena.cli.config_names import find_config, purpose, shipped_folder, shipped_names


def test_a_shipped_one_is_found_by_its_name_in_any_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert find_config("train", "quick") == str(shipped_folder() / "train" / "quick.yaml")
    assert find_config("compare", "quick") == str(shipped_folder() / "compare" / "quick.yaml")
    assert find_config("compare", "configs/compare/quick.yaml") == find_config("compare", "quick")


def test_a_file_of_ones_own_comes_first(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    own = Path("configs/train/quick.yaml")
    own.parent.mkdir(parents=True)
    own.write_text("seed: 1\n")
    assert find_config("train", str(own)) == str(own)
    Path("quick").write_text("seed: 2\n")
    assert find_config("train", "quick") == "quick"


@pytest.mark.parametrize("wanted", ["nowhere.yaml", "configs/train/nowhere.yaml", "configs/compare/quick.yaml/x.yaml"])
def test_a_missing_file_is_left_to_its_reader(wanted: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert find_config("train", wanted) == wanted


def test_a_comparison_is_no_training() -> None:
    with pytest.raises(ConfigError, match="'explorers' is neither a file nor a shipped training"):
        find_config("train", "explorers")


@pytest.mark.parametrize("kind", ["train", "compare"])
def test_every_shipped_one_says_in_a_sentence_what_it_is_for(kind: str) -> None:
    for name in shipped_names(kind):  # type: ignore[arg-type]
        said = purpose(kind, name)  # type: ignore[arg-type]
        assert 20 < len(said) < 250 and "python" not in said and not said.endswith("."), name
    assert "quick" in shipped_names(kind)  # type: ignore[arg-type]
