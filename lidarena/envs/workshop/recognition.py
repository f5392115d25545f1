"""Recognizing what the human does from where it is: a hidden Markov model, its position the observation.

The action is the hidden state, as Strassmair and Taylor propose (after Bennewitz et al. 2005): whoever walks towards a
location shortens the way to it.
"""

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import leaf
from lidarena.base.random_streams import normal, seed_stream
from lidarena.envs.workshop.kernels import WALKING, is_allowed
from lidarena.envs.workshop.records import Records
from lidarena.envs.workshop.task import HUMAN, TaskArrays
from lidarena.envs.workshop.walking import WalkGrid, way_length

if TYPE_CHECKING:
    from lidarena.envs.workshop.state import WorkshopCore

NOISE = 0.15
"""Standard deviation of the observed position [m]."""
_SURE = 0.75
"""Detour by which an action becomes e times less likely [m]."""
_UNLIKELY = 1e-4
"""No observation makes an action less likely than by this factor."""


class Recognizer:
    """Believes in every world how likely it is that the human does each action.

    Args:
        core: The worlds.

    Attributes:
        belief: (worlds, n) probabilities; they add up to 1, or to 0 where the human does nothing.
    """

    def __init__(self, core: "WorkshopCore") -> None:
        self._core = core
        self.belief = np.zeros((core.worlds, len(core.task.actions)))
        self._begun = np.full(core.worlds, np.nan)
        self._streams = np.zeros((core.worlds, 4), np.uint64)

    def begin(self, world: int) -> None:
        """Forget the last episode."""
        rng = self._core.rngs[world]
        assert rng is not None
        self.belief[world] = 0.0
        self._streams[world] = seed_stream(rng)
        self._begun[world] = np.nan

    def look(self, active: NDArray[np.bool_]) -> None:
        """Take in where the humans of the active worlds are."""
        core = self._core
        estimate(core.task.arrays, core.task.grid, core.records, active, self._streams, self._begun, self.belief)

    def guess(self) -> NDArray[np.int64]:
        """(worlds,) the most likely action, -1 where the human does none."""
        none = self.belief.sum(axis=1) <= 0.0
        return np.where(none, -1, self.belief.argmax(axis=1))

    def arrays(self) -> dict[str, NDArray[Any]]:
        """What it remembers, by name."""
        return {"belief": self.belief, "belief_begun": self._begun, "belief_streams": self._streams}


@leaf
def estimate(
    task: TaskArrays,
    grid: WalkGrid,
    s: Records,
    active: NDArray[np.bool_],
    streams: NDArray[np.uint64],
    begun: NDArray[np.float64],
    belief: NDArray[np.float64],
) -> None:
    """Update ``belief`` (worlds, n) by where the humans are now; ``begun`` (worlds,) is when each was seen to choose.

    On the way to an action's first location, what is behind and what is ahead add up to the whole way; the more they
    exceed it, the less likely is the action. That somebody chooses, walks or works is seen; what it chose is not.
    """
    for w in range(belief.shape[0]):
        if not active[w]:
            continue
        action = s.agents[w, HUMAN].action
        if action < 0:
            belief[w] = 0.0
            begun[w] = np.nan
            continue
        if begun[w] != s.actions[w, action].begun:
            begun[w] = s.actions[w, action].begun
            possible = 0.0
            for k in range(belief.shape[1]):
                belief[w, k] = 1.0 if k == action or is_allowed(task, s, w, HUMAN, k) else 0.0
                possible += belief[w, k]
            for k in range(belief.shape[1]):
                belief[w, k] /= possible
        if s.agents[w, HUMAN].stop > 0:
            continue  # what it fetched is known: the belief stays
        x = s.poses[w, HUMAN, 0] + NOISE * normal(streams[w])
        y = s.poses[w, HUMAN, 1] + NOISE * normal(streams[w])
        total = 0.0
        for k in range(belief.shape[1]):
            belief[w, k] *= _likelihood(task, grid, s, w, k, x, y)
            total += belief[w, k]
        for k in range(belief.shape[1]):
            belief[w, k] /= total


@leaf
def _likelihood(task: TaskArrays, grid: WalkGrid, s: Records, w: int, action: int, x: float, y: float) -> float:
    """How well being at a place goes with being on the way to an action's first location, or there."""
    field = task.field[task.stops[action, 0], HUMAN]
    detour = way_length(grid, field, x, y)
    if s.agents[w, HUMAN].phase == WALKING:
        behind = np.hypot(x - s.world[w].origin[0], y - s.world[w].origin[1])
        detour = max(detour + behind - way_length(grid, field, s.world[w].origin[0], s.world[w].origin[1]), 0.0)
    return float(max(np.exp(-detour / _SURE), _UNLIKELY))
