import numpy as np
import pytest
from sb3_contrib import QRDQN, MaskablePPO, RecurrentPPO
from stable_baselines3 import PPO, SAC

from lidarena.agents.acting import has_probabilities, is_recurrent, is_squashed, pick, wants_masks


@pytest.mark.parametrize(
    ("learner", "recurrent", "masks", "probabilities", "squashed"),
    [
        (PPO, False, False, True, False),
        (MaskablePPO, False, True, True, False),
        (RecurrentPPO, True, False, True, False),
        (QRDQN, False, False, False, False),
        (SAC, False, False, True, True),
    ],
)
def test_kinds_of_networks_are_told_apart(
    learner: type, recurrent: bool, masks: bool, probabilities: bool, squashed: bool
) -> None:
    kind = "MlpLstmPolicy" if learner is RecurrentPPO else "MlpPolicy"
    network = learner(kind, "Pendulum-v1" if learner is SAC else "CartPole-v1", device="cpu").policy
    assert is_recurrent(network) == recurrent and wants_masks(network) == masks
    assert has_probabilities(network) == probabilities and is_squashed(network) == squashed


def test_every_choice_takes_the_largest_of_its_own_logits() -> None:
    assert pick(np.array([0.0, 3.0, 1.0, 5.0, 4.0]), [3, 2]).tolist() == [1, 0]
