"""The files that the arenas' tables come from say what the tables promise."""

from pathlib import Path

import pytest

from lidarena.agents.training_config import TrainingConfig
from lidarena.base.yaml_config import load_config
from lidarena.envs.arena.options import ArenaOptions
from lidarena.envs.arena.scenarios import FIRST_DRAWN
from lidarena.evaluation.comparison_config import ComparisonConfig, EnvEntry
from lidarena.evaluation.participants import make_participants

ROOT = Path(__file__).parents[2]
TABLE, ABLATION = (ROOT / "configs" / "compare" / name for name in ("arena.yaml", "arena_ablation.yaml"))
YANG = EnvEntry(id="lidarena/Arena-v0", keywords={"arena": "yang"})


def test_the_table_has_a_thousand_random_arenas_three_hundred_traps_and_every_barn_world() -> None:
    config = load_config(TABLE, ComparisonConfig)
    counts = {env.label: len(config.seeds(env)) for env in config.envs}
    random = [count for label, count in counts.items() if "density" in label]
    assert len(random) == 3 and sum(random) >= 1000
    assert counts["U traps"] == 300 and counts["BARN"] == 150
    densities = [env.keywords["density"] for env in config.envs if "density" in env.keywords]
    assert densities == [0.08, 0.15, 0.22]
    assert all(env.keywords["pick"] == "by_seed" for env in config.envs)


def test_the_file_of_the_barn_worlds_is_given_on_the_command_line() -> None:
    config = load_config(TABLE, ComparisonConfig, ["envs.4.keywords.path=/data/worlds.npz"])
    assert config.envs[4].keywords["path"] == "/data/worlds.npz"


@pytest.mark.parametrize("path", [TABLE, ABLATION], ids=["table", "ablation"])
def test_every_policy_of_a_file_can_be_made(path: Path) -> None:
    for policy in load_config(path, ComparisonConfig).policies:
        if policy.path is None:
            env, _ = make_participants(YANG, policy)
            env.close()


@pytest.mark.parametrize("path", [TABLE, ABLATION], ids=["table", "ablation"])
def test_every_environment_of_a_file_has_keywords_that_exist(path: Path) -> None:
    for env in load_config(path, ComparisonConfig).envs:
        ArenaOptions.checked(env.keywords)


def test_the_ablation_begins_with_what_the_others_are_compared_with() -> None:
    config = load_config(ABLATION, ComparisonConfig)
    assert config.policies[0].title == "robust" and not config.policies[0].options
    assert all(policy.options["field"] for policy in config.policies[1:])
    assert len({str(policy.options) for policy in config.policies}) == len(config.policies)


def test_no_arena_of_the_training_is_in_the_table() -> None:
    training = load_config(ROOT / "configs" / "train" / "arena.yaml", TrainingConfig)
    assert ArenaOptions.checked(training.env.keywords).pick == "random"  # so its numbers begin at FIRST_DRAWN
    table = load_config(TABLE, ComparisonConfig)
    assert max(max(table.seeds(env)) for env in table.envs) < FIRST_DRAWN
    assert training.env.keywords["knowledge"] == "lidar"
