"""Seeds as Gymnasium's users give them: Python's and NumPy's whole numbers, lists, tuples and arrays of them."""

from collections.abc import Sequence
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError

Seed = int | np.integer[Any] | None
Seeds = Seed | Sequence[Seed] | NDArray[np.integer[Any]]


def checked_seed(seed: Any) -> int | None:
    """Return a seed as a Python number, or None.

    Raises:
        ConfigError: It is no whole number of at least 0.
    """
    if seed is None:
        return None
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or seed < 0:
        raise ConfigError(f"seed = {seed!r} must be a whole number of at least 0, or None")
    return int(seed)


def seeds_of(seed: Seeds, worlds: int) -> list[int | None]:
    """Return one seed a world; a single seed ``s`` gives world ``i`` the seed ``s + i``.

    Raises:
        ConfigError: The number of seeds is not that of the worlds, or one is no whole number.
    """
    listed = isinstance(seed, Sequence) and not isinstance(seed, str | bytes)
    if listed or (isinstance(seed, np.ndarray) and seed.ndim == 1):
        seeds = [checked_seed(one) for one in cast(Sequence[Seed], seed)]
        if len(seeds) != worlds:
            raise ConfigError(f"{len(seeds)} seeds were given for {worlds} worlds; one for each is needed")
        return seeds
    try:
        first = checked_seed(seed)
    except ConfigError as refusal:
        raise ConfigError(f"{refusal}, or one of them for each of the {worlds} worlds") from None
    return [None if first is None else first + world for world in range(worlds)]
