from pathlib import Path
from typing import Annotated, Any, Literal

import pytest
import yaml
from hypothesis import given, settings
from hypothesis import strategies as st
from pydantic import Field

from lidarena.base.errors import ConfigError
from lidarena.base.yaml_config import ConfigModel, as_config, check_config, dump_config, load_config


class Optimizer(ConfigModel):
    rate: Annotated[float, Field(gt=0)] | None = 3e-4
    steps: int = Field(default=10, ge=1)
    kind: Literal["adam", "sgd"] = "adam"


class Policy(ConfigModel):
    name: str
    options: dict[str, Any] = Field(default_factory=dict)


class Config(ConfigModel):
    seed: int = Field(ge=0)
    verbose: bool = False
    optimizer: Optimizer = Optimizer()
    policies: list[str | Policy] = Field(default_factory=list)
    by_name: dict[str, Optimizer] = Field(default_factory=dict)


@pytest.fixture
def load(tmp_path: Path) -> Any:
    def write_and_load(text: str, *overrides: str) -> Config:
        file = tmp_path / "run.yaml"
        file.write_text(text, encoding="utf-8")
        return load_config(file, Config, overrides)

    return write_and_load


@pytest.mark.parametrize(
    ("text", "rate"), [("3e-4", 3e-4), ("1E-3", 1e-3), ("2.5e-4", 2.5e-4), (".5", 0.5), ("1", 1.0)]
)
def test_numbers_with_an_exponent_are_numbers(load: Any, text: str, rate: float) -> None:
    assert load(f"seed: 1e3\noptimizer: {{rate: {text}}}").optimizer.rate == rate
    assert load("seed: 1e3").seed == 1000


def test_numbers_are_repaired_where_no_type_is_known(load: Any) -> None:
    config = load("seed: 0\npolicies: [{name: a, options: {gain: 3e-4, label: e4}}]")
    assert config.policies[0].options == {"gain": 3e-4, "label": "e4"}


def test_overrides_come_last_and_are_read_as_yaml(load: Any) -> None:
    config = load(
        "seed: 0\npolicies: [a, {name: b}]\nby_name:",
        "by_name={}",
        "seed=7",
        "optimizer.rate=1e-2",
        "optimizer.rate=2e-2",
        "verbose=true",
        "policies.1.name=c",
        "by_name.x.steps=3",
    )
    assert (config.seed, config.optimizer.rate, config.verbose) == (7, 2e-2, True)
    assert config.policies == ["a", Policy(name="c")]
    assert config.by_name == {"x": Optimizer(steps=3)}


def test_an_override_may_contain_equals_signs(load: Any) -> None:
    assert load("seed: 0", "policies=[{name: 'a=b'}]").policies == [Policy(name="a=b")]


def test_overrides_leave_the_mapping_of_the_caller_alone() -> None:
    content = {"seed": 1, "optimizer": {"steps": 2}}
    assert check_config(content, Config, ["optimizer.steps=5"]).optimizer.steps == 5
    assert content["optimizer"] == {"steps": 2}


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ("", ["run.yaml", "is empty"]),
        ("# only a comment\n", ["is empty"]),
        ("- 1\n- 2", ["a list"]),
        ("hello", ["a text"]),
        ("seed: [1, 2", ["not valid YAML", "line 1"]),
        ("seed: 0\n  verbose: 1", ["not valid YAML", "line 2"]),
        ("seed: 0\nseed: 1", ["'seed' is given twice", "line 2"]),
        ("seed: !!python/object/apply:os.system ['true']", ["not valid YAML"]),
        ("seed: 2024-99-99", ["not valid YAML"]),
        ("seed: 0\nsed: 1", ["'sed'", "did you mean 'seed'?", "Allowed: by_name, optimizer, policies, seed, verbose"]),
        ("sed: 0", ["'sed'", "did you mean 'seed'?"]),
        ("seed: 0\noptimizer: {rat: 1}", ["'optimizer.rat'", "'optimizer'", "did you mean 'rate'?"]),
        ("seed: 0\npolicies: [{nam: x}]", ["'policies.0.nam'", "did you mean 'name'?"]),
        ("seed: 0\nby_name: {a: {stps: 1}}", ["'by_name.a.stps'", "did you mean 'steps'?"]),
        ("verbose: true", ["the key 'seed' is missing"]),
        ("seed: -1", ["'seed' is -1", "greater than or equal to 0"]),
        ("seed: 1.5", ["'seed' is 1.5", "integer"]),
        ("seed: abc", ["'seed' is 'abc'", "integer"]),
        ("seed: true", ["'seed' is true", "number"]),
        ("seed:", ["'seed' is empty", "integer"]),
        ("seed: 0\noptimizer:", ["'optimizer' is empty", "section"]),
        ("seed: 0\noptimizer: 3", ["'optimizer' is 3", "section"]),
        ("seed: 0\noptimizer: {rate: .nan}", ["'optimizer.rate' is nan", "finite"]),
        ("seed: 0\noptimizer: {rate: -3e-4}", ["'optimizer.rate' is -0.0003", "greater than 0"]),
        (
            "seed: 0\noptimizer: {kind: adm}",
            ["'optimizer.kind' is 'adm'", "did you mean 'adam'?", "Allowed: adam, sgd"],
        ),
        ("seed: 0\nverbose: 7", ["'verbose' is 7"]),
        ("1: 2", ["run.yaml"]),
        (f"seed: {'x' * 500}", ["…"]),
        (f"seed: {'[' * 1200}", ["nested too deeply"]),
    ],
)
def test_mistakes_become_one_sentence(load: Any, text: str, parts: list[str]) -> None:
    with pytest.raises(ConfigError) as refusal:
        load(text)
    message = str(refusal.value)
    assert all(part in message for part in parts), message
    assert "\n" not in message and len(message) < 400


@pytest.mark.parametrize(
    ("override", "parts"),
    [
        ("seed", ["--set 'seed'", "key=value"]),
        ("=3", ["key=value"]),
        ("optimizer.=3", ["key=value"]),
        ("seed=[1", ["--set 'seed=[1'", "not valid YAML"]),
        ("seed.sub=3", ["'seed' is 0", "no key 'sub'"]),
        ("policies.9=b", ["list of 1", "'9'"]),
        ("policies.first=b", ["list of 1", "'first'"]),
        ("optimzer.rate=1", ["'optimzer'", "did you mean 'optimizer'?"]),
        ("optimizer.rat=1", ["'optimizer.rat'", "did you mean 'rate'?"]),
        ("seed=x", ["'seed' is 'x'"]),
        ("seed=", ["'seed' is empty"]),
    ],
)
def test_wrong_overrides_become_one_sentence(load: Any, override: str, parts: list[str]) -> None:
    with pytest.raises(ConfigError) as refusal:
        load("seed: 0\npolicies: [a]", override)
    assert all(part in str(refusal.value) for part in parts), refusal.value


def test_a_missing_file_is_named_with_its_neighbour(load: Any, tmp_path: Path) -> None:
    load("seed: 0")
    with pytest.raises(ConfigError, match=r"there is no file .*rn.yaml'; did you mean 'run.yaml'"):
        load_config(tmp_path / "rn.yaml", Config)
    with pytest.raises(ConfigError, match="there is no file"):
        load_config(tmp_path / "nowhere" / "run.yaml", Config)


def test_folders_and_binary_files_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match="is a folder"):
        load_config(tmp_path, Config)
    (tmp_path / "binary.yaml").write_bytes(b"\xff\xfe\x00\x80")
    with pytest.raises(ConfigError, match="UTF-8"):
        load_config(tmp_path / "binary.yaml", Config)
    (tmp_path / "zeros.yaml").write_bytes(b"seed: \x00")
    with pytest.raises(ConfigError, match="not valid YAML"):
        load_config(tmp_path / "zeros.yaml", Config)


def test_a_mapping_that_holds_itself_is_refused(load: Any) -> None:
    with pytest.raises(ConfigError, match="nested too deeply"):
        load("seed: 0\npolicies: &p [{name: a, options: {again: *p}}]")


optimizers = st.builds(
    Optimizer,
    rate=st.none() | st.floats(min_value=1e-300, max_value=1e300),
    steps=st.integers(1, 10**15),
    kind=st.sampled_from(["adam", "sgd"]),
)
values = st.none() | st.booleans() | st.integers() | st.floats(allow_nan=False) | st.text(st.characters(codec="utf-8"))


@settings(max_examples=60)
@given(
    st.builds(
        Config,
        seed=st.integers(0, 2**63),
        verbose=st.booleans(),
        optimizer=optimizers,
        policies=st.lists(
            st.text() | st.builds(Policy, name=st.text(), options=st.dictionaries(st.text(), values, max_size=3)),
            max_size=3,
        ),
        by_name=st.dictionaries(st.text(), optimizers, max_size=2),
    )
)
def test_what_is_dumped_is_loaded_again(tmp_path_factory: pytest.TempPathFactory, config: Config) -> None:
    file = dump_config(config, tmp_path_factory.getbasetemp() / "dumped" / "config.yaml")
    assert load_config(file, Config) == config


def test_a_text_that_looks_like_a_number_stays_a_text(tmp_path: Path) -> None:
    config = Config(seed=0, policies=["3e-4", "1e6", "7", "true", ".5E3", "\x85", "\u2028é"])
    assert load_config(dump_config(config, tmp_path / "config.yaml"), Config) == config


def test_dumping_leaves_no_temporary_files(tmp_path: Path) -> None:
    dump_config(Config(seed=1), tmp_path / "config.yaml")
    dump_config(Config(seed=2), tmp_path / "config.yaml")
    assert [file.name for file in tmp_path.iterdir()] == ["config.yaml"]
    assert yaml.safe_load((tmp_path / "config.yaml").read_text())["seed"] == 2


def test_a_configuration_is_given_as_itself_a_dictionary_or_a_file(tmp_path: Path) -> None:
    content = {"seed": 3, "optimizer": {"steps": 7}}
    config = check_config(content, Config)
    dump_config(config, tmp_path / "config.yaml")
    given = (config, content, tmp_path / "config.yaml", str(tmp_path / "config.yaml"))
    assert [as_config(one, Config) for one in given] == [config] * 4
    for wrong in (3, None, [content], b"config.yaml"):
        with pytest.raises(ConfigError, match="is no configuration; a Config, a dictionary or a YAML file is needed"):
            as_config(wrong, Config)
