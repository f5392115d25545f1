"""Terms of the reward, weighed."""

import numpy as np

from lidarena.envs.seabed.rewards import REWARDS, weigh_terms


def test_terms_have_their_units() -> None:
    one = np.ones(2)
    found = weigh_terms(dict.fromkeys(REWARDS.names, 1.0), 0.02 * one, 0.3 * one, one, 0.1 * one)
    assert {name: term.tolist() for name, term in found.items()} == {
        "drift": [-4.0, -4.0], "compute": [-3.0, -3.0], "refused": [-1.0, -1.0], "progress": [0.1, 0.1]
    }  # fmt: skip
    weighed = weigh_terms({"drift": 0.5, "refused": 0.0}, 0.02 * one, one, one, one)
    assert weighed["drift"].tolist() == [-2.0, -2.0] and weighed["refused"].tolist() == [0.0, 0.0]
