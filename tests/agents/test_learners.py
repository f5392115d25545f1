"""Every algorithm trains, is written, loaded, acts as it was trained, and goes on to the bit."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

from lidarena.agents import TrainingStopped, load, train
from lidarena.agents.batches import make_batch
from lidarena.agents.learners import make_model
from lidarena.base.errors import PolicyFileError
from tests.agents.learner_cases import CASES, CONTINUOUS, small
from tests.agents.training_cases import equal, press_ctrl_c, weights


@pytest.fixture(scope="module", params=CASES)
def trained(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Path]:
    folder = tmp_path_factory.mktemp("run") / "straight"
    return request.param, train(small(folder, request.param), progress=False)


def observations(count: int = 30) -> Any:
    return np.random.default_rng(0).uniform(0, 1, (count, 3)).astype(np.float32)


def test_a_stopped_training_goes_on_to_the_bit(
    trained: tuple[str, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    algorithm, straight = trained
    with monkeypatch.context() as patch:
        press_ctrl_c(patch, at_step=100)
        with pytest.raises(TrainingStopped):
            train(small(tmp_path / "stopped", algorithm), progress=False)
    np.random.seed(99)
    resumed = train(resume=tmp_path / "stopped", progress=False)
    assert equal(weights(resumed), weights(straight))
    assert (resumed / "policy.safetensors").read_bytes() == (straight / "policy.safetensors").read_bytes()


def test_a_loaded_policy_acts_as_the_trained_one(trained: tuple[str, Path]) -> None:
    algorithm, folder = trained
    config = small(folder, algorithm)
    policy = load(folder)
    model: Any = make_model(config, make_batch(config.env, config.num_envs))
    model.policy.load_state_dict(policy.network.state_dict())
    policy.reset(seed=0)
    state, mask = None, np.array([True, True, False])
    more: dict[str, Any] = {"action_masks": mask} if algorithm == "MaskablePPO" else {}
    for observation in observations():
        expected, state = model.predict(observation, state=state, deterministic=True, **more)
        action = policy.act(observation, {"action_mask": mask})
        assert np.array_equal(action, expected) and policy.action_space.contains(action)


def test_what_is_remembered_of_the_training(trained: tuple[str, Path]) -> None:
    algorithm, folder = trained
    policy = load(folder)
    assert policy.training["algorithm"] == algorithm and policy.training["steps"] >= 256
    rows = (folder / "progress.csv").read_text().splitlines()
    assert len(rows) >= 2 and ",," in rows[-1]  # a learner has its own losses, not all of them


def test_draws_follow_the_seed(trained: tuple[str, Path]) -> None:
    algorithm, folder = trained
    if algorithm == "QRDQN":
        with pytest.raises(PolicyFileError, match="no probabilities"):
            load(folder, deterministic=False)
        return
    policy, info = load(folder, deterministic=False), {"action_mask": [True, True, False]}

    def draw(seed: int) -> Any:
        policy.reset(seed)
        return np.array([policy.act(observation, info) for observation in observations()])

    assert np.array_equal(draw(1), draw(1)) and not np.array_equal(draw(1), draw(2))


def test_a_recurrent_policy_remembers_until_it_is_reset(tmp_path: Path) -> None:
    folder = train(small(tmp_path / "run", "RecurrentPPO", CONTINUOUS), progress=False)
    policy = load(folder)
    first, second = observations(2)
    policy.reset()
    alone = policy.act(second)
    policy.reset()
    policy.act(first)
    assert not np.array_equal(policy.act(second), alone)
    policy.reset()
    assert np.array_equal(policy.act(second), alone)


def test_masks_come_from_the_environment_or_the_info(tmp_path: Path) -> None:
    folder = train(small(tmp_path / "run", "MaskablePPO"), progress=False)
    policy = load(folder, deterministic=False)
    observation = observations(1)[0]
    drawn = {policy.act(observation, {"action_mask": [False, True, True]}) for _ in range(60)}
    assert drawn == {1, 2}
    with pytest.raises(PolicyFileError, match="masks: load it with its environment, or give"):
        policy.act(observation, {})
    with pytest.raises(PolicyFileError, match="masks of 3 actions, but this one has 2"):
        policy.act(observation, {"action_mask": [True, True]})
    import gymnasium as gym

    with pytest.raises(PolicyFileError, match=r"this environment has no action_masks\(\)"):
        load(folder, gym.make_vec("fakebatch/Line-v0", 2, "vector_entry_point"))
