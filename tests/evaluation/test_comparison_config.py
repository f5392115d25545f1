"""What a comparison file may say, and the sentence for each thing that it may not."""

from pathlib import Path

import pytest

from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import check_config, dump_config, load_config
from lidarena.evaluation.comparison_config import ComparisonConfig, file_name

MINIMAL = {"envs": ["lidarena/Env1-v0"], "policies": ["random"]}


def test_plain_names_stand_for_entries() -> None:
    config = check_config(MINIMAL, ComparisonConfig)
    assert config.envs[0].id == "lidarena/Env1-v0" and config.envs[0].label == "Env1-v0"
    assert config.policies[0].name == config.policies[0].title == "random"
    assert list(config.seeds(config.envs[0])) == list(range(20))
    assert config.videos is False and config.workers is None


def test_overrides_reach_into_lists() -> None:
    config = check_config(MINIMAL, ComparisonConfig, ["episodes=3", "seed=5", "policies.0=frontier", "videos=gif"])
    assert list(config.seeds(config.envs[0])) == [5, 6, 7]
    assert config.policies[0].name == "frontier" and config.videos == "gif"


def test_an_environment_may_have_its_own_number_of_episodes() -> None:
    envs = ["lidarena/Env1-v0", {"id": "lidarena/Env2-v0", "episodes": 2}]
    config = check_config({**MINIMAL, "envs": envs, "episodes": 4, "seed": 7}, ComparisonConfig)
    assert [list(config.seeds(env)) for env in config.envs] == [[7, 8, 9, 10], [7, 8]]


def test_a_sweep_makes_a_policy_of_each_value() -> None:
    agent = {"name": "pretrained:combined", "sweep": {"preference": [0, 0.5]}, "keywords": {"patience": 9}}
    rule = {"name": "nearest_frontier", "label": "nearest", "options": {"c": 3}, "sweep": {"a": [1, 2], "b": [5, 6]}}
    config = check_config({**MINIMAL, "policies": ["frontier", agent, rule]}, ComparisonConfig)
    titles = [policy.title for policy in config.participants]
    combined = ["combined @ 0", "combined @ 0.5"]
    assert titles == ["frontier", *combined, *(f"nearest @ {a}, {b}" for a in (1, 2) for b in (5, 6))]
    assert [policy.options for policy in config.participants[1:3]] == [{"preference": 0}, {"preference": 0.5}]
    assert {policy.path for policy in config.participants[1:3]} == {"pretrained:combined"}
    assert {policy.line for policy in config.participants[1:3]} == {"combined"} and config.participants[0].line is None
    assert config.participants[-1].options == {"a": 2, "b": 6, "c": 3}
    assert all(policy.keywords == {"patience": 9} for policy in config.participants[1:3])


def test_keywords_of_all_environments_stand_under_their_own() -> None:
    envs = ["lidarena/Env1-v0", {"id": "lidarena/Env2-v0", "keywords": {"slam": "truth"}}]
    content = {**MINIMAL, "envs": envs, "keywords": {"slam": "rbpf", "stop_at": None}}
    config = check_config(content, ComparisonConfig, ["keywords.patience=9"])
    assert [env.keywords for env in config.worlds] == [
        {"slam": "rbpf", "stop_at": None, "patience": 9},
        {"slam": "truth", "stop_at": None, "patience": 9},
    ]
    with pytest.raises(ConfigError, match="'expose_truth' is set by the evaluation itself"):
        check_config({**MINIMAL, "keywords": {"expose_truth": True}}, ComparisonConfig)


def test_a_written_config_reads_back_equal(tmp_path: Path) -> None:
    config = check_config({**MINIMAL, "out": "results/mine", "videos": "mp4"}, ComparisonConfig)
    assert load_config(dump_config(config, tmp_path / "c.yaml"), ComparisonConfig) == config


@pytest.mark.parametrize(
    ("label", "file"), [("Env-2", "Env-2"), ("a/b c:d", "a-b-c-d"), ("../..", "-.."), ("..", "-"), ("größer", "größer")]
)
def test_labels_become_file_names(label: str, file: str) -> None:
    assert file_name(label) == file


@pytest.mark.parametrize("name", ["quick", "exploration", "da_slam", "unseen", "explorers", "dungeons"])
def test_the_shipped_files_are_right(name: str) -> None:
    config = load_config(Path(__file__).parents[2] / f"configs/compare/{name}.yaml", ComparisonConfig)
    assert config.folder == Path("results") / name
    assert "frontier" in {policy.name for policy in config.policies}


@pytest.mark.parametrize(
    ("change", "sentence"),
    [
        ({"episodes": 0}, "'episodes' is 0, but it should be greater than or equal to 1"),
        ({"envs": [{"id": "e", "episodes": 0}]}, "'envs.0.episodes' is 0"),
        ({"episodes": 2.5}, "'episodes' is 2.5"),
        ({"episodes": True}, "should be a number, not true or false"),
        ({"episdoes": 3}, "'episdoes' is not a key; did you mean 'episodes'"),
        ({"envs": []}, "'envs'"),
        ({"policies": []}, "'policies'"),
        ({"seed": -1}, "'seed' is -1"),
        ({"workers": 0}, "'workers' is 0"),
        ({"videos": "avi"}, "gif, mp4"),
        ({"out": ""}, "'out'"),
        ({"policies": ["random", "random"]}, "are called 'random' or nearly so; give each its own 'label'"),
        ({"envs": ["a/Env1-v0", "b/Env1-v0"]}, "two environments are called 'Env1-v0'"),
        ({"policies": ["random", {"name": "x", "label": "Random"}]}, "two policies are called 'random' or nearly so"),
        ({"envs": [{"id": "lidarena/Env1-v0", "keyword": {}}]}, "did you mean 'keywords'"),
        ({"envs": [{"id": "e", "keywords": {"expose_truth": True}}]}, "'expose_truth' of 'e' is set by the evaluation"),
        ({"policies": [{"name": "p", "keywords": {"render_mode": "human"}}]}, "'render_mode' of policy 'p'"),
        ({"policies": [{"name": "p", "sweep": {"a": []}}]}, "the sweep of 'a' of policy 'p' needs values, each"),
        ({"policies": [{"name": "p", "sweep": {"a": [1, 1]}}]}, "the sweep of 'a' of policy 'p' needs values, each"),
        ({"policies": [{"name": "p", "sweep": {"a": 1}}]}, "'policies.0.sweep.a' is 1"),
        (
            {"policies": [{"name": "p", "options": {"a": 1}, "sweep": {"a": [2]}}]},
            "'a' in its options and in",
        ),
        ({"policies": ["p @ 1", {"name": "p", "sweep": {"a": [1]}}]}, "two policies are called 'p @ 1'"),
        ({"policies": [{"path": "runs/p"}]}, "'policies.0.name' is missing"),
        ({"envs": [3]}, "'envs.0' is 3"),
    ],
)
def test_refusals(change: dict, sentence: str) -> None:
    with pytest.raises(ConfigError) as caught:
        check_config({**MINIMAL, **change}, ComparisonConfig, origin="file.yaml")
    assert sentence in str(caught.value)
    assert "\n" not in str(caught.value)
