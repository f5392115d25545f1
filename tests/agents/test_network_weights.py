import math

import pytest
import torch
from torch import nn

from lidarena.agents.network_weights import all_finite, set_weights, weights_of


def network(seed: int = 0) -> nn.Module:
    torch.manual_seed(seed)
    return nn.Sequential(nn.Linear(3, 4), nn.ReLU(), nn.Linear(4, 2))


def test_weights_of_one_network_make_another_one_the_same() -> None:
    one, other = network(0), network(1)
    set_weights(other, weights_of(one))
    x = torch.rand(5, 3)
    assert torch.equal(one(x), other(x))


def test_weights_that_two_names_share_are_told_once() -> None:
    class Shared(nn.Module):
        def __init__(self) -> None:
            super().__init__()
            self.one = nn.Linear(3, 3)
            self.same = self.one

    assert set(weights_of(Shared())) == {"one.weight", "one.bias"}


@pytest.mark.parametrize("fault", ["missing", "one too many", "not \\(4, 3\\)", "not finite"])
def test_weights_that_do_not_fit_leave_the_network_as_it_was(fault: str) -> None:
    target, weights = network(1), dict(weights_of(network(0)))
    before = {name: tensor.clone() for name, tensor in weights_of(target).items()}
    if fault == "missing":
        del weights["0.bias"]
    elif fault == "one too many":
        weights["9.bias"] = torch.zeros(2)
    elif fault == "not finite":
        weights["2.bias"] = torch.tensor([0.0, math.nan])
    else:
        weights["0.weight"] = torch.zeros(3, 4)
    with pytest.raises(ValueError, match=fault):
        set_weights(target, weights)
    assert all(torch.equal(before[name], tensor) for name, tensor in weights_of(target).items())


def test_infinite_and_missing_numbers_are_noticed() -> None:
    assert all_finite({"a": torch.zeros(3)})
    for odd in (math.nan, math.inf, -math.inf):
        assert not all_finite({"a": torch.zeros(3), "b": torch.tensor([1.0, odd])})
