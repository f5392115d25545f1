"""A family tells its measures, columns and picture itself; what belongs to none is measured by what it tells."""

import csv
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import yaml

import evaluate
from lidarena.base.errors import ConfigError
from lidarena.envs import registration
from lidarena.envs.registration import Family
from lidarena.evaluation import FamilyMeasures, Measure, run_episode
from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.episodes import Episode
from lidarena.evaluation.measures.family_measures import measures_of
from lidarena.evaluation.participants import make_env, make_participants
from tests.evaluation.measures import stranger

OF_ALL = ["success", "collision", "return", "steps", "decision_time"]


def episode(env_id: str, seed: int = 0, **keywords: Any) -> Episode:
    env, policy = make_participants(EnvEntry(id=env_id, keywords=keywords), PolicyEntry(name="random"))
    return run_episode(env, policy, seed, keep_picture=True)


def test_a_strangers_family_is_measured_and_drawn_by_itself() -> None:
    found = episode("stranger/Diving-v0")
    assert [column.name for column in found.columns] == ["success", "collision", "depth", "air", *OF_ALL[2:]]
    assert found.measures["depth"] == found.measures["return"] == 6.0 and found.measures["air"] == 5.0
    assert found.measures["success"] == 1.0 and found.ending == "success"
    assert found.caption == "dived to 6 m: success"
    assert isinstance(found.picture, stranger.DivingPicture) and found.picture.depths[-1] == 6.0
    assert found.progress is not None and found.progress.points[-1].tolist() == [6.0, 6.0]


@pytest.mark.parametrize("workers", [1, 2])
def test_a_strangers_family_is_compared_from_a_file(workers: int, tmp_path: Path) -> None:
    out = tmp_path / "results"
    envs = [{"id": f"{stranger.HERE}:stranger/Diving-v0", "name": "dives"}, "lidarena/Arena-v0", "CartPole-v1"]
    content = {"envs": envs, "policies": ["random"], "episodes": 2, "workers": workers, "out": str(out)}
    (tmp_path / "dives.yaml").write_text(yaml.safe_dump(content))
    assert evaluate.main(["--config", str(tmp_path / "dives.yaml")]) == 0
    lines = list(csv.DictReader((out / "table.csv").read_text(encoding="utf-8").splitlines()))
    measured = {env: {line["measure"] for line in lines if line["env"] == env} for env in ("dives", "CartPole-v1")}
    assert measured["dives"] == {"success", "depth", "air", *OF_ALL[2:]}
    assert measured["CartPole-v1"] == set(OF_ALL[2:])
    assert "| Policy | Success (%) ↑ | Depth (m) ↑ | Air (l) |" in (out / "table.md").read_text(encoding="utf-8")
    drawn = {path.relative_to(out / "pictures").as_posix() for path in (out / "pictures").rglob("*.png")}
    assert drawn == {"overview.png", "progress.png", "dives/random.png", "Arena-v0/random.png"}


def test_an_environment_of_no_family_is_measured_by_what_it_tells() -> None:
    silent, telling = episode("CartPole-v1"), episode("stranger/Loner-v0")
    assert list(silent.measures) == list(telling.measures) == OF_ALL
    assert silent.ending == "terminated" and silent.measures["success"] != silent.measures["success"]
    assert silent.measures["return"] == silent.measures["steps"] > 0
    assert telling.ending == "success" and telling.measures["success"] == 1.0
    assert silent.picture is silent.progress is telling.picture is None
    cut_off = episode("stranger/Loner-v0", wreck=99.0)
    assert cut_off.ending == cut_off.caption == "out of time" and cut_off.measures["success"] == 0.0


@pytest.mark.parametrize(
    ("path", "sentence"),
    [
        ("no_such_module:MEASURES", "there is no module 'no_such_module'"),
        (f"{stranger.HERE}:MEASURSE", "did you mean 'MEASURES'"),
        (f"{stranger.HERE}:DEPTH", "are a Measure, where a FamilyMeasures is needed"),
        ("tests.evaluation.measures.torn:MEASURES", "cannot be imported"),
    ],
)
def test_measures_that_cannot_be_had_are_refused_in_one_sentence(
    path: str, sentence: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(registration._families, "diving", Family("diving", measures=path))
    with pytest.raises(ConfigError) as caught:
        episode("stranger/Diving-v0")
    assert sentence in str(caught.value) and "'diving'" in str(caught.value) and "\n" not in str(caught.value)


def test_a_family_that_nobody_registered_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stranger.Diving, "family", "arenas")
    with pytest.raises(ConfigError, match="no family of environments is named 'arenas'; did you mean 'arena'"):
        episode("stranger/Diving-v0")


def test_a_family_without_measures_is_one_of_none(monkeypatch: pytest.MonkeyPatch) -> None:
    plain = replace(registration.family_named("diving"), measures=None)
    monkeypatch.setitem(registration._families, "diving", plain)
    assert list(episode("stranger/Diving-v0").measures) == OF_ALL


def test_columns_that_no_table_can_have_are_refused() -> None:
    with pytest.raises(ConfigError, match="two columns are named 'air'"):
        _ = FamilyMeasures([Measure("air", "Air"), Measure("air", "More air")]).table
    with pytest.raises(ConfigError, match="column 'air' needs 'succes'; did you mean 'success'"):
        _ = FamilyMeasures([Measure("air", "Air", needs="succes")]).table


def test_a_value_without_a_column_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(stranger.DivingMeasures, "measure", lambda self, recording: {"dept": 1.0})
    with pytest.raises(ConfigError, match="a measure is named 'dept', which is no column; did you mean 'depth'"):
        episode("stranger/Diving-v0")


@pytest.mark.parametrize("family", ["exploration", "arena", "corridor", "seabed"])
def test_every_family_of_the_package_has_a_table(family: str) -> None:
    ids = {"exploration": "Env1-v0", "arena": "Arena-v0", "corridor": "CorridorCentral-v0", "seabed": "Seabed-v0"}
    table = measures_of(make_env(f"lidarena/{ids[family]}", {})).table
    names = [column.name for column in table]
    assert set(OF_ALL) < set(names) and len(set(names)) == len(names)
    assert names[-3:] == OF_ALL[2:]
