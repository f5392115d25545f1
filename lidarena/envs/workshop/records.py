"""The state of workshops: as records for kernels, and as arrays for everything else.

A compiled function takes a dozen machine words for every array that it is given, and again whenever it hands them on:
with some forty arrays, compiling took longer than a training. The records are six, and their fields have names.
"""

from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.envs.workshop.humans import Traits

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

PICTURE_TICKS = 5
"""Ticks between two moments of a film."""

_WORLD = [
    ("ticks", np.int64), ("backing", np.float64), ("together", np.float64), ("least_gap", np.float64),
    ("contacts", np.int64), ("verdict", np.int64), ("logged", np.int64), ("origin", np.float64, (2,)),
]  # fmt: skip
_AGENT = [
    ("phase", np.int64), ("action", np.int64), ("stop", np.int64), ("left", np.float64), ("asleep", np.bool_),
    ("wake", np.float64), ("deaf", np.bool_), ("side", np.int64), ("stuck", np.float64), ("idle", np.float64),
    ("path", np.float64), ("due", np.bool_), ("changed", np.float64),
]  # fmt: skip
_ACTION = [
    ("status", np.int64), ("agent", np.int64), ("begun", np.float64), ("placed", np.float64), ("ended", np.float64),
    ("worked", np.float64), ("unplanned", np.bool_), ("likes", np.float64), ("refuses", np.bool_),
    ("passed_over", np.int64), ("declined", np.int64),
]  # fmt: skip


class Records(NamedTuple):
    """The state as kernels take it; the fields of the records are described at ``Workers``."""

    world: NDArray[np.void]
    """(W,)"""
    agents: NDArray[np.void]
    """(W, 2)"""
    actions: NDArray[np.void]
    """(W, n)"""
    human: NDArray[np.void]
    """(W,) see ``humans.Traits``"""
    poses: Floats
    """(W, 2, 3)"""
    commands: Floats
    """(W, 2, 2)"""
    log: Floats
    """(W, M, 4)"""
    streams: NDArray[np.uint64]
    """(W, 4)"""
    trace: Floats
    """(W, K, 2, 3)"""


class Workers(NamedTuple):
    """The state of ``W`` worlds with ``n`` actions as arrays, views of the records; agents are human and robot."""

    ticks: Ints
    """(W,) since the episode began"""
    poses: Floats
    """(W, 2, 3) [m, m, rad]"""
    phase: Ints
    """(W, 2)"""
    action: Ints
    """(W, 2) under way, ``NOTHING`` or ``LEAVING``"""
    stop: Ints
    """(W, 2) at which of its locations"""
    left: Floats
    """(W, 2) of the work there [s]; of an absence"""
    asleep: Bools
    """(W, 2) whether it waits instead of deciding"""
    wake: Floats
    """(W, 2) until when at most [s]"""
    deaf: Bools
    """(W, 2) whether nothing else wakes it"""
    side: Ints
    """(W, 2) on which it passes the other"""
    stuck: Floats
    """(W, 2) for how long it has been blocked [s]"""
    backing: Floats
    """(W,) until when the robot backs off [s]"""
    status: Ints
    """(W, n)"""
    agent: Ints
    """(W, n) who does it or did it, -1 nobody"""
    begun: Floats
    """(W, n) when it was chosen [s]; NaN before"""
    placed: Floats
    """(W, n) when the work at the last location began [s]; NaN before"""
    ended: Floats
    """(W, n) [s]; NaN before"""
    worked: Floats
    """(W, n) time of the work alone [s]; NaN before it was chosen"""
    origin: Floats
    """(W, 2) where the human was when it chose what it does [m]"""
    unplanned: Bools
    """(W, n) whether it was done against the task"""
    idle: Floats
    """(W, 2) time spent neither walking nor working nor away [s]"""
    together: Floats
    """(W,) time in which both were busy [s]"""
    path: Floats
    """(W, 2) walked [m]"""
    least_gap: Floats
    """(W,) least distance between the two bodies [m]"""
    contacts: Ints
    """(W,) ticks in which they touched"""
    traits: Floats
    """(W, 10) of the human, see ``humans.Traits``"""
    likes: Floats
    """(W, n)"""
    refuses: Bools
    """(W, n)"""
    passed_over: Ints
    """(W, n) how often the human has begun something else while it was allowed this"""
    declined: Ints
    """(W, n) how often the human has rested while it was allowed this"""
    streams: NDArray[np.uint64]
    """(W, 4)"""
    changed: Floats
    """(W, 2) when it began what it does [s]"""
    due: Bools
    """(W, 2) who has to decide"""
    verdict: Ints
    """(W,)"""
    commands: Floats
    """(W, 2, 2) speed and turn rate for pymunk [m/s], [rad/s]"""
    log: Floats
    """(W, M, 4) agent, phase, action and time of every change [s]"""
    trace: Floats
    """(W, K, 2, 3) poses every ``PICTURE_TICKS``; K is 0 where nothing is drawn"""
    logged: Ints
    """(W,) how many there are"""


def make_records(worlds: int, actions: int, changes: int, poses: Floats, pictures: int = 0) -> Records:
    """Records of worlds in which nothing has happened, all numbers 0 but those that mean "not yet".

    Args:
        worlds: Number of worlds.
        actions: Of the task.
        changes: Of what somebody does that are noted, at most.
        poses: (worlds, 2, 3) that is used as it is.
        pictures: For which poses are noted, at most.
    """
    records = Records(
        np.zeros(worlds, np.dtype(_WORLD, align=True)),
        np.zeros((worlds, 2), np.dtype(_AGENT, align=True)),
        np.zeros((worlds, actions), np.dtype(_ACTION, align=True)),
        np.zeros(worlds, np.dtype([(name, np.float64) for name in Traits._fields])),
        poses,
        np.zeros((worlds, 2, 2)),
        np.zeros((worlds, changes, 4)),
        np.zeros((worlds, 4), np.uint64),
        np.zeros((worlds, pictures, 2, 3)),
    )
    records.world["least_gap"] = np.inf
    records.actions["agent"] = -1
    for name in ("begun", "placed", "ended", "worked"):
        records.actions[name] = np.nan
    return records


def views_of(records: Records) -> Workers:
    """The same memory as arrays."""
    found: dict[str, Any] = {}
    for array in (records.world, records.agents, records.actions):
        assert array.dtype.names is not None
        found |= {name: array[name] for name in array.dtype.names}
    found["traits"] = records.human.view(np.float64).reshape(len(records.human), -1)
    whole = {name: getattr(records, name) for name in ("poses", "commands", "log", "streams", "trace")}
    return Workers(**found, **whole)
