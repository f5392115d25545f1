"""What a trained policy does with an observation."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch

from lidarena.agents import load, save_policy
from lidarena.base.errors import PolicyFileError
from tests.agents.policy_cases import make_model


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return save_policy(make_model(), tmp_path_factory.mktemp("run"), "fakebatch/Line-v0")


def test_drawn_actions_follow_the_seed_and_the_probabilities(saved: Path) -> None:
    policy = load(saved, deterministic=False)
    observation = np.full(3, 0.5, dtype=np.float32)

    def draw(seed: int, count: int = 600) -> list[int]:
        policy.reset(seed)
        return [policy.act(observation) for _ in range(count)]

    torch.manual_seed(1)
    first = draw(3)
    torch.manual_seed(2)
    assert draw(3, 50) == first[:50] and draw(4, 50) != first[:50]
    with torch.no_grad():
        distribution: Any = policy.network.get_distribution(torch.as_tensor(observation[None])).distribution
    shares = np.bincount(first, minlength=3) / len(first)
    assert shares == pytest.approx(distribution.probs.numpy()[0], abs=0.07)


def test_drawn_continuous_actions_stay_in_bounds(tmp_path: Path) -> None:
    policy = load(save_policy(make_model(env={"action": "continuous"}), tmp_path, "x"), deterministic=False)
    policy.reset(0)
    actions = np.array([policy.act(np.zeros(3, np.float32)) for _ in range(200)])
    assert actions.shape == (200, 1) and actions.dtype == np.float32
    assert np.abs(actions).max() == 1 and actions.std() > 0.3


@pytest.mark.parametrize(
    ("observation", "message"),
    [
        (np.zeros(7, np.float32), r"shape \(3,\), but the observation is of shape \(7,\)"),
        (np.zeros((1, 3), np.float32), r"of shape \(1, 3\)"),
        (0.5, r"of shape \(\)"),
        ({"map": np.zeros(3)}, r"a dict with keys \['map'\]"),
    ],
)
def test_observations_of_another_environment(saved: Path, observation: Any, message: str) -> None:
    with pytest.raises(PolicyFileError, match=message):
        load(saved).act(observation, {})


def test_dict_observations_of_another_environment(tmp_path: Path) -> None:
    policy = load(save_policy(make_model("MultiInputPolicy", {"observation": "map"}), tmp_path, "x"))
    state, picture = np.zeros(3, np.float32), np.zeros((1, 36, 36), np.uint8)
    policy.act({"map": picture, "state": state})
    for wrong, message in [
        ({"map": picture}, "has keys"),
        (state, "is no dict"),
        ({"map": picture[0], "state": state}, r"observation\['map'\] is of shape \(36, 36\)"),
    ]:
        with pytest.raises(PolicyFileError, match=message):
            policy.act(wrong)
