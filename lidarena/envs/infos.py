"""Infos and observations of batches: one world's part, and Gymnasium's masks."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

Info = dict[str, Any]


def of_world(info: Info, world: int, copy: bool = False) -> Info:
    """One world's info out of a batch's; scalars become Python numbers.

    Args:
        info: Of the batch.
        world: Which one.
        copy: Whether its arrays share no memory with the batch's.
    """
    single: Info = {}
    for name, value in info.items():
        if isinstance(value, dict):
            single[name] = of_world(value, world, copy)
        else:
            item = value[world]
            single[name] = item.item() if item.ndim == 0 else item.copy() if copy else item
    return single


def masked(info: Info, mask: NDArray[np.bool_]) -> Info:
    """Gymnasium's form of a batch's infos: beside every array one that says for which worlds it holds."""
    out: Info = {}
    for name, value in info.items():
        out[name] = masked(value, mask) if isinstance(value, dict) else value
        out[f"_{name}"] = mask
    return out


def row_of(batch: Any, row: int, copy: bool = False) -> Any:
    """One environment's observation out of a batch of arrays or dictionaries of arrays."""
    if isinstance(batch, dict):
        return {name: row_of(array, row, copy) for name, array in batch.items()}
    return batch[row].copy() if copy else batch[row]


def overwrite(observations: Any, fresh: Any, rows: NDArray[np.bool_]) -> None:
    """Put the fresh observations of some environments into those of a batch."""
    if isinstance(observations, dict):
        for name, array in observations.items():
            array[rows] = fresh[name][rows]
    else:
        observations[rows] = fresh[rows]
