"""Folders of maps: one episode a map, and one sentence for whatever does not fit."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import evaluate
from lidarena.base.errors import ConfigError, LidarenaError
from lidarena.base.yaml_config import check_config
from lidarena.evaluation.comparison import compare
from lidarena.evaluation.comparison_config import ComparisonConfig
from lidarena.evaluation.map_folders import MapFolder
from lidarena.world.map_server import save_map

NAMES = ("a", "b", "c", "d", "e")


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """Five rooms of 3 m, and the starts in their middles."""
    room = np.full((60, 60), 100, np.int8)
    room[2:-2, 2:-2] = 0
    for name in NAMES:
        save_map(tmp_path / f"{name}.yaml", room, 0.05)
    (tmp_path / "starts.json").write_text(json.dumps({name: [1.5, 1.5, 0] for name in NAMES}))
    (tmp_path / "README.txt").write_text("not a map")
    return tmp_path


def test_maps_come_in_the_order_of_their_names_with_their_starts(folder: Path) -> None:
    cases = MapFolder(path=str(folder), starts="starts.json").cases()
    assert [case.name for case in cases] == list(NAMES)
    assert cases[1].keywords == {"map": str(folder / "b.yaml"), "start": (1.5, 1.5, 0.0)}
    elsewhere = MapFolder(path=str(folder), starts=str(folder / "starts.json")).cases()
    assert elsewhere == cases
    assert MapFolder(path=str(folder)).cases()[0].keywords == {"map": str(folder / "a.yaml")}


def test_some_of_the_maps_are_spread_over_their_names(folder: Path) -> None:
    names = [[case.name for case in MapFolder(path=str(folder)).cases(count)] for count in (1, 2, 5)]
    assert names == [["a"], ["a", "c"], list(NAMES)]


@pytest.mark.parametrize(
    ("starts", "sentence"),
    [
        ("{", "are not valid JSON"),
        ("[]", r'must look like {"NAME": \[x, y, theta\], …}'),
        ('{"a": [1, 1, 0]}', "say nothing of map 'b'"),
        ('{"a": [1, 1]}', r"have \[1, 1\] for map 'a'; \[x, y, theta\] is needed"),
        ('{"a": [1, NaN, 0]}', r"have \[1, nan, 0\] for map 'a'"),
        ('{"a": 3}', "have 3 for map 'a'"),
    ],
)
def test_starts_that_do_not_fit(folder: Path, starts: str, sentence: str) -> None:
    (folder / "starts.json").write_text(starts)
    with pytest.raises(ConfigError, match=sentence):
        MapFolder(path=str(folder), starts="starts.json").cases()


def test_refusals(folder: Path, tmp_path_factory: pytest.TempPathFactory) -> None:
    empty = tmp_path_factory.mktemp("empty")
    with pytest.raises(ConfigError, match=r"holds no map; files \*.yaml, \*.yml, \*.map are maps"):
        MapFolder(path=str(empty)).cases()
    with pytest.raises(ConfigError, match="there is no folder of maps 'gone'"):
        MapFolder(path="gone").cases()
    with pytest.raises(ConfigError, match="holds 5 maps, so episodes = 6 are too many"):
        MapFolder(path=str(folder)).cases(6)
    with pytest.raises(ConfigError, match=r"starts 'gone.json' of .* cannot be read"):
        MapFolder(path=str(folder), starts="gone.json").cases()


def config_of(folder: Path, **entry: Any) -> ComparisonConfig:
    env = {"id": "lidarena/Exploration-v0", "name": "rooms", "maps": {"path": str(folder), "starts": "starts.json"}}
    content = {
        "envs": [env | entry],
        "keywords": {"slam": "truth", "max_episode_steps": 40},
        "policies": ["random", "frontier"],
        "workers": 1,
        "pictures": False,
        "out": str(folder / "results"),
    }
    return check_config(content, ComparisonConfig)


def test_a_broken_map_costs_nothing_but_itself(folder: Path) -> None:
    (folder / "a.yaml").write_text("image: gone.pgm")  # the first one, which the dry run tries
    starts = {name: [1.5, 1.5, 0] for name in NAMES} | {"d": [0.0, 0.0, 0.0]}
    (folder / "starts.json").write_text(json.dumps(starts))
    comparison = compare(config_of(folder))
    assert [row.episodes for row in comparison.rows] == [5, 5]
    document = json.loads((folder / "results/results.json").read_text())
    for row in document["rows"]:
        assert row["maps"] == list(NAMES) and list(row["failures"]) == ["a", "d"]
        assert [value is None for value in row["metrics"]["completeness"]["values"]] == [
            True,
            False,
            False,
            True,
            False,
        ]
    first, second = comparison.failures
    assert first.startswith("environment 'rooms', map 'a': ") and "has no key" in first
    assert second.startswith("environment 'rooms', map 'd': start (0, 0) stands in a wall of map 'd'")
    assert "3 of 5 maps" in (folder / "results/table.md").read_text()


def test_the_program_names_broken_maps_and_ends_with_1(
    folder: Path, tmp_path_factory: pytest.TempPathFactory, capsys: pytest.CaptureFixture[str]
) -> None:
    (folder / "c.yaml").write_text("")
    file = tmp_path_factory.mktemp("config") / "comparison.yaml"
    file.write_text(json.dumps(config_of(folder, episodes=2).model_dump(mode="json")))
    assert evaluate.main(["--config", str(file), "--set", "policies=[random]"]) == 1
    printed = capsys.readouterr()
    assert "rooms · 1 of 2 maps each" in printed.out
    assert "map 'c': " in printed.err and "all other maps were driven in" in printed.err


def test_a_folder_of_nothing_but_broken_maps_is_refused(folder: Path) -> None:
    for name in NAMES:
        (folder / f"{name}.yaml").write_text("")
    with pytest.raises(LidarenaError, match="environment 'rooms', policy 'random', map 'a': "):
        compare(config_of(folder))
    assert not (folder / "results").exists()


def test_what_is_wrong_with_every_map_is_told_at_once(folder: Path) -> None:
    with pytest.raises(LidarenaError, match="did you mean 'observation'"):
        compare(config_of(folder, keywords={"observatoin": "map"}))


@pytest.mark.parametrize(("key", "value"), [("map", "env1"), ("start", [1, 1, 0])])
def test_the_folder_says_map_and_start(folder: Path, key: str, value: Any) -> None:
    with pytest.raises(ConfigError, match=f"has a folder of maps and the keyword '{key}'; leave one out"):
        config_of(folder, keywords={key: value})
