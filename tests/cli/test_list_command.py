"""``lidarena list`` names what can be typed elsewhere."""

import gymnasium as gym
import pytest

from lidarena import agents, baselines
from lidarena.cli import main
from lidarena.world.load import load_floorplan


def listed(what: str, capsys: pytest.CaptureFixture[str]) -> list[str]:
    assert main(["list", what, "--names"]) == 0
    return capsys.readouterr().out.splitlines()


def test_every_name_that_is_listed_can_be_used(capsys: pytest.CaptureFixture[str]) -> None:
    for name in listed("environments", capsys):
        assert gym.spec(name).id == name
    assert listed("policies", capsys) == baselines.names()
    assert listed("agents", capsys) == [f"pretrained:{name}" for name in agents.pretrained()]
    for name in listed("maps", capsys):
        if ":" not in name:
            assert load_floorplan(name).bounds
    assert "train quick" in listed("configs", capsys) and "evaluate quick" in listed("configs", capsys)


def test_all_kinds_at_once_with_what_is_known_of_each(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list"]) == 0
    text = capsys.readouterr().out
    for kind in ("configs", "environments", "policies", "agents", "maps"):
        assert f"{kind}\n  " in text
    assert "env1 " in text and "5.0 x 5.6 m" in text and "any environment" in text


def test_a_kind_that_there_is_not(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as end:
        main(["list", "robots"])
    assert end.value.code == 2 and "environments" in capsys.readouterr().err
