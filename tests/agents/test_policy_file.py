import json
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from gymnasium import spaces
from hypothesis import strategies as st
from stable_baselines3 import PPO
from stable_baselines3.common.policies import ActorCriticPolicy
from stable_baselines3.common.torch_layers import FlattenExtractor

from lidarena.agents import load, save_policy
from lidarena.agents.shipped import resolve
from lidarena.agents.vec_env import BatchVecEnv
from lidarena.base.errors import PolicyFileError
from tests.agents.fake_batch import RestorableLineBatch
from tests.agents.policy_cases import make_model

KINDS: list[tuple[str, dict[str, Any], dict[str, Any]]] = [
    ("MlpPolicy", {}, {}),
    ("MlpPolicy", {"action": "continuous"}, {"net_arch": [16], "activation_fn": torch.nn.ReLU}),
    ("MlpPolicy", {}, {"net_arch": {"pi": [8, 8], "vf": []}}),
    ("MultiInputPolicy", {"observation": "map"}, {"net_arch": [16]}),
]


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return save_policy(make_model(), tmp_path_factory.mktemp("run"), "fakebatch/Line-v0", {"noise": 0.1}, {"steps": 64})


@pytest.fixture
def run(saved: Path, tmp_path: Path) -> Path:
    """A run folder that a test may damage."""
    return Path(shutil.copytree(saved.parent, tmp_path / "run"))


def rewrite(run: Path, **changes: Any) -> None:
    card = json.loads((run / "policy.json").read_text())
    (run / "policy.json").write_text(json.dumps({**card, **changes}))


@pytest.mark.parametrize(("kind", "env", "network"), KINDS)
def test_a_loaded_policy_acts_as_the_trained_one(
    tmp_path: Path, kind: str, env: dict[str, Any], network: dict[str, Any]
) -> None:
    model = make_model(kind, env, network)
    policy = load(save_policy(model, tmp_path, "fakebatch/Line-v0", env))
    policy.reset(seed=0)
    assert policy.env_keywords == env
    model.observation_space.seed(0)
    for _ in range(20):
        observation = model.observation_space.sample()
        action = policy.act(observation, {})
        expected, _ = model.predict(observation, deterministic=True)
        assert np.array_equal(action, expected)
        assert policy.action_space.contains(action)
    assert {file.name for file in tmp_path.iterdir()} == {"policy.json", "policy.safetensors"}


def test_the_path_may_be_the_folder_or_either_file(saved: Path) -> None:
    observation = np.full(3, 0.5, dtype=np.float32)
    actions = [load(path).act(observation) for path in (saved, saved.parent, saved.with_suffix(".safetensors"))]
    assert len(set(actions)) == 1 and isinstance(actions[0], int)


def test_files_may_be_renamed_together(run: Path) -> None:
    for suffix in (".json", ".safetensors"):
        (run / f"policy{suffix}").rename(run / f"champion{suffix}")
    assert load(run / "champion.json").env_id == "fakebatch/Line-v0"


def test_what_is_remembered(saved: Path) -> None:
    policy = load(saved)
    assert policy.env_keywords == {"noise": 0.1} and policy.training == {"steps": 64}
    versions = json.loads(saved.read_text())["versions"]
    assert versions["torch"] == torch.__version__ and "stable-baselines3" in versions


def test_loading_leaves_the_random_generators_alone(saved: Path) -> None:
    torch.manual_seed(0)
    expected = torch.rand(1)
    torch.manual_seed(0)
    load(saved).act(np.zeros(3, np.float32))
    assert torch.rand(1) == expected


def test_environments_with_other_spaces(saved: Path) -> None:
    load(saved, env=RestorableLineBatch(5))
    with pytest.raises(PolicyFileError, match="with observations Box"):
        load(saved, env=RestorableLineBatch(5, observation="map"))
    with pytest.raises(PolicyFileError, match="with actions Discrete"):
        load(saved, env=RestorableLineBatch(5, action="continuous"))


def test_missing_files(run: Path, tmp_path: Path) -> None:
    with pytest.raises(PolicyFileError, match="there is no"):
        load(tmp_path / "nowhere")
    with pytest.raises(PolicyFileError, match=r"holds no policy\.json"):
        load(tmp_path)
    (run / "policy.safetensors").unlink()
    for path in (run, run / "policy.json"):
        with pytest.raises(PolicyFileError, match=r"policy\.safetensors' is missing"):
            load(path)


def test_every_truncation_of_the_weights_is_refused(run: Path) -> None:
    data = (run / "policy.safetensors").read_bytes()
    for length in (0, 1, 8, 100, len(data) // 2, len(data) - 1):
        (run / "policy.safetensors").write_bytes(data[:length])
        with pytest.raises(PolicyFileError, match="damaged or of another policy"):
            load(run)


def test_every_truncation_of_the_card_is_refused(run: Path) -> None:
    text = (run / "policy.json").read_text().rstrip()
    for length in (0, 1, 20, len(text) // 2, len(text) - 1):
        (run / "policy.json").write_text(text[:length])
        with pytest.raises(PolicyFileError, match="truncated or no JSON"):
            load(run)


def test_weights_of_another_policy_are_noticed(run: Path, tmp_path: Path) -> None:
    other = save_policy(make_model(network={"net_arch": [8]}), tmp_path / "other", "x")
    shutil.copy(other.with_suffix(".safetensors"), run)
    with pytest.raises(PolicyFileError, match="of another policy"):
        load(run)


def test_weights_that_do_not_fit_the_architecture(run: Path) -> None:
    rewrite(run, architecture={"class": "MlpPolicy", "net_arch": [8], "activation": "tanh"})
    with pytest.raises(PolicyFileError, match=r"does not fit policy\.json: the weight"):
        load(run)


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"format": "something"}, "'format' should be"),
        ({"version": 3}, "format version 3"),
        ({"version": None}, "format version None"),
        ({"surprise": 1}, "'surprise'"),
        ({"weights_sha256": "abc"}, "weights_sha256"),
        ({"env": {}}, "'env.id'"),
        ({"architecture": {"class": "os.system", "net_arch": [], "activation": "tanh"}}, "'architecture.class'"),
        ({"architecture": {"class": "MlpPolicy", "net_arch": [10**9], "activation": "tanh"}}, "net_arch"),
        ({"architecture": {"class": "MultiInputPolicy", "net_arch": [], "activation": "tanh"}}, "cannot be built"),
        ({"architecture": {"class": "CnnPolicy", "net_arch": [], "activation": "tanh"}}, "cannot be built"),
        ({"observation_space": {"type": "Ball"}}, "describes no space"),
        ({"observation_space": {"type": "Discrete"}}, "describes no space"),
        ({"observation_space": {"type": "Box", "shape": [-1], "dtype": "float32", "low": 0, "high": 1}}, "no space"),
        ({"observation_space": {"type": "Box", "shape": [10**6] * 3, "dtype": "u1", "low": 0, "high": 1}}, "no space"),
        ({"observation_space": {"type": "Box", "shape": [3], "dtype": "O", "low": 0, "high": 1}}, "no space"),
        ({"action_space": {"type": "Discrete", "n": -2, "start": 0}}, "no space"),
        ({"action_space": {"type": "Dict", "spaces": {}}}, "cannot be built"),
    ],
)
def test_cards_that_are_wrong(run: Path, changes: dict[str, Any], message: str) -> None:
    rewrite(run, **changes)
    with pytest.raises(PolicyFileError) as refusal:
        load(run)
    assert message in str(refusal.value) and "\n" not in str(refusal.value)


@pytest.mark.parametrize("content", ["[]", "3", "null", '{"a": 1}'])
def test_other_json_is_refused(run: Path, content: str) -> None:
    (run / "policy.json").write_text(content)
    with pytest.raises(PolicyFileError, match="does not describe a policy"):
        load(run)


def test_zips_and_pickles_are_never_opened(tmp_path: Path) -> None:
    class Bomb:
        def __reduce__(self) -> Any:
            return (Path.touch, (tmp_path / "exploded",))

    model = make_model()
    model.save(tmp_path / "model.zip")
    bomb = b"\x80\x04" + b"cpathlib\nPath\n"
    (tmp_path / "bomb.pkl").write_bytes(bomb)
    (tmp_path / "notes.txt").write_text("hello")
    with pytest.raises(PolicyFileError, match="a zip, probably of Stable-Baselines3"):
        load(tmp_path / "model.zip")
    with pytest.raises(PolicyFileError, match="a pickle"):
        load(tmp_path / "bomb.pkl")
    with pytest.raises(PolicyFileError, match="not a policy file"):
        load(tmp_path / "notes.txt")
    assert not (tmp_path / "exploded").exists()


def test_a_pickle_under_our_names_is_refused(run: Path) -> None:
    (run / "policy.safetensors").write_bytes(b"\x80\x04\x95")
    with pytest.raises(PolicyFileError, match="damaged"):
        load(run)
    (run / "policy.json").write_bytes(b"\x80\x04\x95")
    with pytest.raises(PolicyFileError, match="no JSON"):
        load(run)


def test_weights_that_are_not_finite_are_not_written(saved: Path, tmp_path: Path) -> None:
    model = make_model()
    with torch.no_grad():
        model.policy.value_net.weight[0, 0] = float("nan")
    with pytest.raises(PolicyFileError, match="not finite"):
        save_policy(model, tmp_path, "x")
    assert list(tmp_path.iterdir()) == []


def test_networks_of_other_kinds_are_not_written(tmp_path: Path) -> None:
    class Own(ActorCriticPolicy):
        pass

    class Features(FlattenExtractor):
        pass

    batch = BatchVecEnv(RestorableLineBatch(2))
    for model in (
        PPO(Own, batch, n_steps=32, batch_size=32),
        PPO("MlpPolicy", batch, n_steps=32, batch_size=32, policy_kwargs={"share_features_extractor": False}),
        PPO("MlpPolicy", batch, n_steps=32, batch_size=32, policy_kwargs={"activation_fn": torch.nn.Hardtanh}),
        PPO("MlpPolicy", batch, n_steps=32, batch_size=32, policy_kwargs={"features_extractor_class": Features}),
    ):
        with pytest.raises(PolicyFileError, match="cannot be written"):
            save_policy(model, tmp_path, "x")


shapes = st.lists(st.integers(1, 4), max_size=3).map(tuple)
boxes = st.one_of(
    st.builds(lambda shape: spaces.Box(-np.inf, np.inf, shape, np.float32), shapes),
    st.builds(lambda shape: spaces.Box(0, 255, shape, np.uint8), shapes),
    st.builds(lambda shape, seed: _random_box(shape, seed), shapes, st.integers(0, 99)),
)
leaves = st.one_of(
    boxes,
    st.builds(lambda n, start: spaces.Discrete(n, start=start), st.integers(1, 9), st.integers(-3, 3)),
    st.builds(spaces.MultiDiscrete, st.lists(st.integers(1, 5), min_size=1, max_size=3)),
    st.builds(spaces.MultiBinary, st.integers(1, 5)),
)


def _random_box(shape: tuple[int, ...], seed: int) -> spaces.Box:
    low = np.random.default_rng(seed).normal(size=shape).astype(np.float32)
    return spaces.Box(low, low + 1, dtype=np.float32)


def test_a_file_of_version_0_1_means_what_it_meant(tmp_path: Path) -> None:
    shipped = resolve("pretrained:uncertainty")
    for name in ("policy.json", "policy.safetensors"):
        (tmp_path / name).write_bytes((shipped / name).read_bytes())
    card = json.loads((tmp_path / "policy.json").read_text())
    card["env"]["keywords"] = {"start": "random", "reward": "d_optimality", "eta": 1.0}
    (tmp_path / "policy.json").write_text(json.dumps(card | {"version": 1}))
    with pytest.warns(DeprecationWarning, match="observation = 'da_slam_entropy'"):
        assert load(tmp_path).env_keywords["observation"] == "da_slam_entropy"
