"""Mazes for teams: corridors of a few cells between walls of one."""

import numpy as np
from numpy.typing import NDArray


def maze(rng: np.random.Generator, side: int = 32, wide: int = 2) -> NDArray[np.bool_]:
    """A maze without loops (side, side), True = blocked, by depth-first search."""
    count, pitch = (side + 1) // (wide + 1), wide + 1
    blocked = np.ones((side, side), np.bool_)
    met, stack = {(0, 0)}, [(0, 0)]
    blocked[:wide, :wide] = False
    while stack:
        r, c = stack[-1]
        beside = [(r + 1, c), (r - 1, c), (r, c + 1), (r, c - 1)]
        new = [(y, x) for y, x in beside if 0 <= y < count and 0 <= x < count and (y, x) not in met]
        if not new:
            stack.pop()
            continue
        y, x = new[int(rng.integers(len(new)))]
        rows = slice(min(r, y) * pitch, max(r, y) * pitch + wide)
        blocked[rows, min(c, x) * pitch : max(c, x) * pitch + wide] = False
        met.add((y, x))
        stack.append((y, x))
    return blocked
