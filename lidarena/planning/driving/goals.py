"""Keeping account of the goals of many worlds: which is pursued, since when it comes no nearer, which are given up."""

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, merged_kernel

SAME_GOAL = 0.25
"""Goals nearer to each other than this, in x and in y, are one [m]: explore_lite's five cells."""
TRIES = 3
"""A goal for which no commands are found at so many planning instants is given up."""
_PROGRESS = 0.05  # what counts as having come nearer [m]
_MOST = 256  # goals that are remembered; the oldest are forgotten
PARDONS = 3
"""Goals that were given up from afar are tried again so often, and anew once the map has grown."""
REGROWN = 1.01
"""By so much it must grow for that."""


class GoalAccounts(NamedTuple):
    """The accounts of W episodes.

    Attributes:
        pursued: (W, 2) the goal that is being driven to [m].
        has_pursued: (W,) bool.
        given_up: (W, goals, 2) that are not tried again, in turn.
        given_up_count: (W,) how many there were.
        from_afar: (W, goals) bool, for which of these no commands were found from where the robot was, far from them.
        pardons: (W,) how often such goals were pardoned since the map has grown.
        pardoned: (W,) cells known at the last time.
        retreats: (W,) how often the robot went back to where it came from since the map has grown.
        retreated: (W,) cells known at the last time.
        failures: (W, goals, 2) for which no commands were found, in turn.
        failure_count: (W,) how many there were.
        arrived_at: (W,) step of the arrival, -1 before it.
        progress_at: (W,) step at which it last came nearer.
        shortest: (W,) remaining way then [m].
    """

    pursued: NDArray[np.float64]
    has_pursued: NDArray[np.bool_]
    given_up: NDArray[np.float64]
    given_up_count: NDArray[np.int64]
    from_afar: NDArray[np.bool_]
    pardons: NDArray[np.int64]
    pardoned: NDArray[np.int64]
    retreats: NDArray[np.int64]
    retreated: NDArray[np.int64]
    failures: NDArray[np.float64]
    failure_count: NDArray[np.int64]
    arrived_at: NDArray[np.int64]
    progress_at: NDArray[np.int64]
    shortest: NDArray[np.float64]


def empty_accounts(worlds: int) -> GoalAccounts:
    """Allocate the accounts."""
    return GoalAccounts(
        np.zeros((worlds, 2)),
        np.zeros(worlds, np.bool_),
        np.zeros((worlds, _MOST, 2)),
        np.zeros(worlds, np.int64),
        np.zeros((worlds, _MOST), np.bool_),
        np.zeros(worlds, np.int64),
        np.zeros(worlds, np.int64),
        np.zeros(worlds, np.int64),
        np.zeros(worlds, np.int64),
        np.zeros((worlds, _MOST, 2)),
        np.zeros(worlds, np.int64),
        np.full(worlds, -1, np.int64),
        np.zeros(worlds, np.int64),
        np.full(worlds, np.inf),
    )


def open_accounts(accounts: GoalAccounts, world: int) -> None:
    """Begin an episode in one world."""
    accounts.has_pursued[world] = False
    accounts.given_up_count[world] = accounts.failure_count[world] = accounts.progress_at[world] = 0
    accounts.pardons[world] = accounts.pardoned[world] = 0
    accounts.retreats[world] = accounts.retreated[world] = 0
    accounts.arrived_at[world], accounts.shortest[world] = -1, np.inf


@merged_kernel
def _is_same(x: float, y: float, goal: NDArray[np.float64]) -> bool:
    return bool(abs(x - goal[0]) < SAME_GOAL and abs(y - goal[1]) < SAME_GOAL)


@kernel
def is_given_up(w: int, x: float, y: float, accounts: GoalAccounts) -> bool:
    """Whether a goal has been given up."""
    for i in range(min(accounts.given_up_count[w], _MOST)):  # noqa: SIM110 - numba compiles no generators
        if _is_same(x, y, accounts.given_up[w, i]):
            return True
    return False


@merged_kernel
def give_up(w: int, x: float, y: float, accounts: GoalAccounts) -> None:
    """Never try a goal again."""
    slot = accounts.given_up_count[w] % _MOST
    accounts.given_up[w, slot, 0], accounts.given_up[w, slot, 1] = x, y
    accounts.from_afar[w, slot] = False
    accounts.given_up_count[w] += 1


@kernel
def pursue(w: int, x: float, y: float, step: int, accounts: GoalAccounts) -> None:
    """Note that a goal is being driven to; one that is the same as before keeps its account."""
    if not accounts.has_pursued[w] or not _is_same(x, y, accounts.pursued[w]):
        accounts.pursued[w, 0], accounts.pursued[w, 1], accounts.has_pursued[w] = x, y, True
        accounts.arrived_at[w], accounts.progress_at[w], accounts.shortest[w] = -1, step, np.inf


@merged_kernel
def watch(
    w: int, remaining: float, arrived: bool, step: int, timeout: int, patience: int, accounts: GoalAccounts
) -> None:
    """Note how the pursued goal comes nearer, and give it up if it does not, or was reached without effect.

    Args:
        w: World.
        remaining: Length of the path that remains [m].
        arrived: Whether the robot is there.
        step: Now.
        timeout: Steps without coming nearer.
        patience: Steps after arrival.
        accounts: Of all worlds.
    """
    if not accounts.has_pursued[w]:
        return
    if remaining < accounts.shortest[w] - _PROGRESS:
        accounts.shortest[w], accounts.progress_at[w] = remaining, step
    if arrived and accounts.arrived_at[w] < 0:
        accounts.arrived_at[w] = step
    in_vain = accounts.arrived_at[w] >= 0 and step - accounts.arrived_at[w] >= patience
    if in_vain or step - accounts.progress_at[w] >= timeout:
        give_up(w, accounts.pursued[w, 0], accounts.pursued[w, 1], accounts)


@kernel
def fail(w: int, x: float, y: float, for_good: bool, accounts: GoalAccounts) -> bool:
    """Note that no commands were found for a goal; whether it is given up now."""
    slot = accounts.failure_count[w] % _MOST
    accounts.failures[w, slot, 0], accounts.failures[w, slot, 1] = x, y
    accounts.failure_count[w] += 1
    tries = 0
    for i in range(min(accounts.failure_count[w], _MOST)):
        tries += _is_same(x, y, accounts.failures[w, i])
    if for_good or tries >= TRIES:
        slot = accounts.given_up_count[w] % _MOST
        give_up(w, x, y, accounts)
        accounts.from_afar[w, slot] = not for_good
        return True
    return False


@merged_kernel
def pardon(w: int, known: int, accounts: GoalAccounts) -> bool:
    """Let goals be tried again that were given up from afar; whether there are any.

    That no commands were found says as much of where the robot was as of the goal. It is done ``PARDONS`` times, and
    anew once the map has grown by ``REGROWN``, so that it ends.

    Args:
        w: World.
        known: Cells that are known.
        accounts: Of all worlds.
    """
    if known > REGROWN * accounts.pardoned[w]:
        accounts.pardons[w] = 0
    if accounts.pardons[w] >= PARDONS:
        return False
    kept, count = 0, min(accounts.given_up_count[w], _MOST)
    for i in range(count):
        if not accounts.from_afar[w, i]:
            accounts.given_up[w, kept] = accounts.given_up[w, i]
            accounts.from_afar[w, kept] = False
            kept += 1
    if kept == count:
        return False
    accounts.given_up_count[w], accounts.failure_count[w] = kept, 0
    accounts.pardons[w] += 1
    accounts.pardoned[w] = known
    return True


@merged_kernel
def may_retreat(w: int, known: int, accounts: GoalAccounts) -> bool:
    """Whether the robot may still go back to where it came from: ``PARDONS`` times, anew once the map has grown."""
    return bool(accounts.retreats[w] < PARDONS or known > REGROWN * accounts.retreated[w])


@merged_kernel
def note_retreat(w: int, known: int, accounts: GoalAccounts) -> None:
    """Note that it goes back, and give up the goal that it pursued."""
    if known > REGROWN * accounts.retreated[w]:
        accounts.retreats[w] = 0
    accounts.retreats[w] += 1
    accounts.retreated[w] = known
    if accounts.has_pursued[w]:
        give_up(w, accounts.pursued[w, 0], accounts.pursued[w, 1], accounts)
