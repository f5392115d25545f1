"""What an environment's docstring says of its keywords and rewards is what the code takes."""

import inspect
import re
from dataclasses import fields
from typing import Any

import pytest

from lidarena.envs import ArenaEnv, CorridorCentralEnv, ExplorationEnv, SeabedEnv, WorkshopEnv
from lidarena.envs.arena.options import ArenaOptions
from lidarena.envs.arena.rewards import REWARDS as ARENA
from lidarena.envs.corridor.drawn_options import DrawnOptions
from lidarena.envs.corridor.options import CorridorOptions
from lidarena.envs.corridor.rewards import REWARDS as CORRIDOR
from lidarena.envs.corridor_v0 import CorridorEnv
from lidarena.envs.exploration.options import OBSERVATIONS, ExplorationOptions
from lidarena.envs.exploration.rewards import REWARDS as EXPLORATION
from lidarena.envs.rewards import RewardTerms
from lidarena.envs.seabed.options import SeabedOptions
from lidarena.envs.seabed.rewards import REWARDS as SEABED
from lidarena.envs.workshop.options import WorkshopOptions
from lidarena.envs.workshop.rewards import REWARDS as WORKSHOP

DOCUMENTED: list[tuple[type[Any], type[Any], RewardTerms]] = [
    (ExplorationEnv, ExplorationOptions, EXPLORATION),
    (ArenaEnv, ArenaOptions, ARENA),
    (CorridorEnv, CorridorOptions, CORRIDOR),
    (SeabedEnv, SeabedOptions, SEABED),
    (WorkshopEnv, WorkshopOptions, WORKSHOP),
]
SECTIONS = ["Description", "Action space", "Observation space", "Rewards", "Starting state", "Episode end", "Info"]
SECTIONS += ["Arguments", "References", "Version History"]


def section(environment: type[Any], title: str) -> str:
    return inspect.getdoc(environment).split(f"## {title}\n")[1].split("\n## ")[0]  # type: ignore[union-attr]


def rows(environment: type[Any], title: str) -> list[list[str]]:
    """Cells of the lines of a section's table, without its head."""
    lines = [line for line in section(environment, title).splitlines() if line.startswith("| ")][1:]
    return [[cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]] for line in lines]


@pytest.mark.parametrize(("environment", "options", "_"), DOCUMENTED)
def test_the_table_of_arguments_names_every_keyword_and_its_default(
    environment: type[Any], options: type[Any], _: RewardTerms
) -> None:
    table = {cells[0].strip("`"): cells for cells in rows(environment, "Arguments")}
    expected = {field.name: repr(field.default).replace("'", '"') for field in fields(options)}
    expected |= {name: "None" for name in ("robot", "lidar", "moving") if name in expected}  # the own, or nothing
    if environment is CorridorEnv:  # as PettingZoo calls it
        expected = {"max_cycles": expected.pop("max_episode_steps")} | expected
    assert {name: cells[2].strip("`") for name, cells in table.items()} == expected
    assert list(table) == list(expected)
    assert all(len(cells) == 4 and all(cells) for cells in table.values())


@pytest.mark.parametrize(("environment", "_", "terms"), DOCUMENTED)
def test_the_table_of_rewards_names_every_term_and_its_weights(
    environment: type[Any], _: type[Any], terms: RewardTerms
) -> None:
    table = {cells[0].strip("`"): cells[2:] for cells in rows(environment, "Rewards")}
    assert tuple(table) == terms.names
    head = next(line for line in section(environment, "Rewards").splitlines() if line.startswith("| Term"))
    assert [cell.strip().strip("`") for cell in head.split("|")[3:-1]] == list(terms.presets)
    for name, weights in table.items():
        for weight, preset in zip(weights, terms.presets.values(), strict=True):
            assert (float(weight) if weight else None) == preset.get(name), (name, preset)


def test_the_central_environment_tells_where_it_differs_from_corridor_v0() -> None:
    told = section(CorridorCentralEnv, "Arguments")
    assert "``corridor_v0``" in told and "``corridor_v0``" in section(CorridorCentralEnv, "Rewards")
    own = {cells[0].strip("`"): cells[2].strip("`") for cells in rows(CorridorCentralEnv, "Arguments")}
    shared = {cells[0].strip("`") for cells in rows(CorridorEnv, "Arguments")}
    defaults = {field.name: str(field.default) for field in fields(DrawnOptions)}
    assert own == {name: default for name, default in defaults.items() if name not in shared}


@pytest.mark.parametrize("environment", [ExplorationEnv, ArenaEnv, CorridorCentralEnv, CorridorEnv, WorkshopEnv])
def test_sections_stand_in_gymnasiums_order(environment: type[Any]) -> None:
    assert re.findall(r"^## (.*)$", inspect.getdoc(environment) or "", re.M) == SECTIONS


def test_every_observation_is_described() -> None:
    said = section(ExplorationEnv, "Observation space")
    assert all(f'"{name}"' in said for name in OBSERVATIONS)
