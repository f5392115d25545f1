"""A network's weights as tensors by name: read, written back, and checked to be finite."""

from collections.abc import Mapping

import torch
from torch import nn


def weights_of(network: nn.Module) -> dict[str, torch.Tensor]:
    """Return the weights by name, each once, even if the network knows it under several names."""
    seen: set[tuple[int, torch.Size]] = set()
    unique = {}
    for name, tensor in network.state_dict().items():
        place = (tensor.data_ptr(), tensor.shape)
        if place not in seen or tensor.numel() == 0:
            seen.add(place)
            unique[name] = tensor.detach()
    return unique


def set_weights(network: nn.Module, weights: Mapping[str, torch.Tensor]) -> None:
    """Copy weights into a network.

    Raises:
        ValueError: A name, shape or type differs, or a weight is not finite; the network is unchanged then.
    """
    targets = weights_of(network)
    if targets.keys() != weights.keys():
        odd = sorted(targets.keys() ^ weights.keys())[0]
        raise ValueError(f"the weight {odd!r} is {'missing' if odd in targets else 'one too many'}")
    for name, target in targets.items():
        if target.shape != weights[name].shape or target.dtype != weights[name].dtype:
            raise ValueError(
                f"the weight {name!r} is {tuple(weights[name].shape)} of {weights[name].dtype}, "
                f"not {tuple(target.shape)} of {target.dtype}"
            )
    if not all_finite(weights):
        raise ValueError("some weights are not finite numbers")
    for name, target in targets.items():
        target.copy_(weights[name])


def all_finite(weights: Mapping[str, torch.Tensor]) -> bool:
    """Whether no weight is NaN or infinite."""
    return all(bool(torch.isfinite(tensor).all()) for tensor in weights.values())
