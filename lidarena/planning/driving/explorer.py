"""Exploring many worlds by choosing among candidates: when a choice is due, what is left, and setting out.

The steps are those of the ``frontier`` baseline. A choice is due once a ``choice_period``, on arrival, and when
something new stands in the way; it is made elsewhere, by a rule or a network.
"""

import math
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import kernel, merged_kernel
from lidarena.planning.driving.candidates import (
    AWAY,
    FRONTIER,
    Candidates,
    add_place,
    empty_candidates,
    find_frontier_candidates,
    lengths_from_robot,
    measure_turns,
    measure_ways_between,
)
from lidarena.planning.driving.driver import (
    go,
    has_arrived,
    is_cornered,
    is_cut_off,
    must_plan,
    remaining_way,
    retreat,
    retreats,
    sense,
    stop,
)
from lidarena.planning.driving.following import next_command
from lidarena.planning.driving.goals import (
    GoalAccounts,
    empty_accounts,
    fail,
    give_up,
    is_given_up,
    may_retreat,
    note_retreat,
    open_accounts,
    pardon,
    pursue,
    watch,
)
from lidarena.planning.driving.state import Drive, DriverSettings, Perceptions, empty_drive, forget
from lidarena.planning.driving.survey import survey
from lidarena.planning.driving.whereabouts import is_caught

DRIVES, CHOOSES, ENDS = 0, 1, 2
"""What an explorer says after a step: it has a command, a choice is due, or nothing is left (and it turns)."""
UNFINISHED, EXPLORED, OUT_OF_REACH, FRUITLESS = 0, 1, 2, 3
"""Why an exploration has ended: it has not; no frontier is left; none that can be reached; the map hardly grows."""
ENDINGS = ("", "explored", "out of reach", "fruitless")
"""Their names."""
_BESIDE = 1.0  # a goal so near that still cannot be driven to is too narrow a place [m]
_GROWTH = 0.001  # growth of the known map that counts as something new
_RENEWAL = 1.03  # so much the map must grow between two visits of known places
_PLACES, _APART = 256, 2.0  # places that are remembered, at least so far apart [m]


class ExplorerSettings(NamedTuple):
    """When an explorer does what.

    Attributes:
        every: Steps between two choices at most.
        timeout: A goal is given up after so many steps without coming nearer.
        patience: A goal is given up so many steps after arrival; so long nothing must be left before the end.
        enclosed: So long instead if frontiers are left, but no way to them: a passage that a pose by some centimetres
            off has closed opens again.
        fruitless: The exploration ends after so many steps without anything new.
        least: Smallest frontier that is a candidate [m].
        places: Known places that are candidates, at most.
        radius: Free space so near to the robot counts for the distance advantage [m].
        period: Of a step [s].
    """

    every: int
    timeout: int
    patience: int
    enclosed: int
    fruitless: int
    least: float
    places: int
    radius: float
    period: float


class Explorers(NamedTuple):
    """Explorers of W worlds.

    Attributes:
        drive: Their drivers.
        accounts: Of their goals.
        candidates: As of the last planning instant.
        step: (W,) steps since the beginning.
        planned_at: (W,) step of the last planning instant.
        wanted_at: (W,) step at which there was last something to drive to.
        known: (W,) cells known when something new came last.
        grown_at: (W,) step of that.
        finished: (W,) bool, whether nothing is left.
        ending: (W,) why, as far as can be said now; an index of ``ENDINGS``.
        mapped: (W,) cells known at the last planning instant.
        sum_log_d: (W,) ln of D-optimality added up over these, each as of when it was seen.
        revisits: (W,) bool, whether the robot is on its way to a known place.
        revisited: (W,) cells known when it last arrived at one.
        places: (W, places, 3) x, y [m] where the robot has been, ln of D-optimality then.
        place_at: (W, places) step of that.
        place_count: (W,) how many.
    """

    drive: Drive
    accounts: GoalAccounts
    candidates: Candidates
    step: NDArray[np.int64]
    planned_at: NDArray[np.int64]
    wanted_at: NDArray[np.int64]
    known: NDArray[np.int64]
    grown_at: NDArray[np.int64]
    finished: NDArray[np.bool_]
    ending: NDArray[np.int64]
    mapped: NDArray[np.int64]
    sum_log_d: NDArray[np.float64]
    revisits: NDArray[np.bool_]
    revisited: NDArray[np.int64]
    places: NDArray[np.float64]
    place_at: NDArray[np.int64]
    place_count: NDArray[np.int64]


def empty_explorers(worlds: int, rows: int, columns: int, most: int, settings: DriverSettings) -> Explorers:
    """Allocate explorers for maps of so many cells and at most so many candidates."""
    return Explorers(
        drive=empty_drive(worlds, rows, columns, settings),
        accounts=empty_accounts(worlds),
        candidates=empty_candidates(worlds, most),
        step=np.zeros(worlds, np.int64),
        planned_at=np.zeros(worlds, np.int64),
        wanted_at=np.zeros(worlds, np.int64),
        known=np.zeros(worlds, np.int64),
        grown_at=np.zeros(worlds, np.int64),
        finished=np.zeros(worlds, np.bool_),
        ending=np.zeros(worlds, np.int64),
        mapped=np.zeros(worlds, np.int64),
        sum_log_d=np.zeros(worlds),
        revisits=np.zeros(worlds, np.bool_),
        revisited=np.zeros(worlds, np.int64),
        places=np.zeros((worlds, _PLACES, 3)),
        place_at=np.zeros((worlds, _PLACES), np.int64),
        place_count=np.zeros(worlds, np.int64),
    )


def begin(explorers: Explorers, world: int) -> None:
    """Begin an episode in one world."""
    forget(explorers.drive, world)
    open_accounts(explorers.accounts, world)
    for array in explorers[3:14]:
        array[world] = 0
    explorers.place_count[world] = explorers.candidates.number[world] = 0


def arrays_of(explorers: Explorers) -> dict[str, NDArray[Any]]:
    """Everything that later steps depend on, by name."""
    return _flat("", explorers)


def _flat(name: str, part: Any) -> dict[str, NDArray[Any]]:
    if isinstance(part, np.ndarray):
        return {name: part}
    inner: dict[str, NDArray[Any]] = {}
    for own, one in part._asdict().items():
        inner |= _flat(f"{name}.{own}" if name else own, one)
    return inner


@kernel
def advance(
    w: int,
    log_d: float,
    senses: Perceptions,
    driver: DriverSettings,
    settings: ExplorerSettings,
    explorers: Explorers,
) -> int:
    """Take in what a world's robot senses after a step; ``DRIVES``, ``CHOOSES`` or ``ENDS``.

    After ``CHOOSES`` the candidates are those of the world, and ``set_out`` comes next; else ``command``.
    """
    drive, step = explorers.drive, explorers.step[w] + 1
    explorers.step[w] = step
    sense(w, senses, driver, drive)
    _remember_place(w, log_d, senses, explorers)
    if explorers.finished[w]:
        return ENDS
    if not _is_due(w, senses, driver, settings, explorers):
        return DRIVES
    explorers.planned_at[w] = step
    if drive.has_goal[w]:
        remaining, arrived = remaining_way(w, senses, drive), has_arrived(w, senses, drive)
        watch(w, remaining, arrived, step, settings.timeout, settings.patience, explorers.accounts)
        if explorers.revisits[w] and remaining <= AWAY + 0.5:
            explorers.revisits[w], explorers.revisited[w] = False, explorers.mapped[w]
    is_known = survey(w, senses, driver, drive)
    if is_known:
        _note_growth(w, log_d, explorers)
        _find_candidates(w, senses, settings, explorers)
        has_choice = _has_choice(w, settings, explorers)
        caught = is_caught(w, settings.period, drive.been) or _is_enclosed(w, has_choice, senses, settings, explorers)
        if caught and _goes_back(w, senses, driver, explorers):
            return DRIVES
        if has_choice:
            return CHOOSES
        if explorers.candidates.found[w] and is_cornered(w, senses, driver, drive):
            explorers.wanted_at[w] = step
            return DRIVES
    stop(w, drive)
    explorers.finished[w] = is_known and _has_ended(w, settings, explorers)
    return ENDS if explorers.finished[w] else DRIVES


@merged_kernel
def _goes_back(w: int, senses: Perceptions, driver: DriverSettings, explorers: Explorers) -> bool:
    """Whether there are frontiers, and the robot drives back to where it came from since it gets nowhere from here."""
    drive, accounts = explorers.drive, explorers.accounts
    if not explorers.candidates.found[w] or explorers.ending[w] == FRUITLESS:
        return False
    known = _count_known(w, drive)
    if not may_retreat(w, known, accounts) or not retreat(w, senses, driver, drive):
        return False
    note_retreat(w, known, accounts)
    explorers.wanted_at[w] = explorers.step[w]
    return True


@merged_kernel
def _is_enclosed(
    w: int, has_choice: bool, senses: Perceptions, settings: ExplorerSettings, explorers: Explorers
) -> bool:
    """Whether nothing can be reached for a while, and the map shows no way to where the robot came from either."""
    if has_choice or explorers.ending[w] != OUT_OF_REACH or not explorers.candidates.apart[w]:
        return False
    since = explorers.step[w] - explorers.wanted_at[w]
    return since >= settings.patience and is_cut_off(w, senses, explorers.drive)


@merged_kernel
def _has_ended(w: int, settings: ExplorerSettings, explorers: Explorers) -> bool:
    """Whether it is the end that nothing is left: not at once, and not while anything may be tried again."""
    out_of_reach = explorers.ending[w] == OUT_OF_REACH
    if out_of_reach and pardon(w, _count_known(w, explorers.drive), explorers.accounts):
        explorers.wanted_at[w] = explorers.step[w]
        return False
    # SLAM may be a scan behind, so that nothing left must stay so for a while
    waits = out_of_reach and explorers.candidates.apart[w]
    patience = settings.enclosed if waits else settings.patience
    return bool(explorers.step[w] - explorers.wanted_at[w] >= patience)


@merged_kernel
def _is_due(
    w: int, senses: Perceptions, driver: DriverSettings, settings: ExplorerSettings, explorers: Explorers
) -> bool:
    step, drive = explorers.step[w], explorers.drive
    if retreats(w, drive):
        return False
    if step - explorers.planned_at[w] >= settings.every or step == 1 or must_plan(w, senses, driver, drive):
        return True
    return has_arrived(w, senses, drive) and explorers.accounts.arrived_at[w] < 0


@merged_kernel
def _remember_place(w: int, log_d: float, senses: Perceptions, explorers: Explorers) -> None:
    """Note where the robot is, unless it has been near before."""
    x, y, count = senses.poses[w, 0], senses.poses[w, 1], explorers.place_count[w]
    if count == explorers.places.shape[1]:
        return
    for i in range(count):
        if math.hypot(explorers.places[w, i, 0] - x, explorers.places[w, i, 1] - y) < _APART:
            return
    explorers.places[w, count, 0], explorers.places[w, count, 1], explorers.places[w, count, 2] = x, y, log_d
    explorers.place_at[w, count] = explorers.step[w]
    explorers.place_count[w] = count + 1


@merged_kernel
def _find_candidates(w: int, senses: Perceptions, settings: ExplorerSettings, explorers: Explorers) -> None:
    """Fill in the frontiers, the start, and the places nearest by way that the robot knows since long ago."""
    drive, candidates = explorers.drive, explorers.candidates
    lengths = lengths_from_robot(w, drive)
    find_frontier_candidates(w, settings.least, lengths, drive, explorers.accounts, candidates)
    # who has been to a place must see something new before the next: certainty is no end in itself
    if candidates.number[w] > 0 and explorers.mapped[w] > _RENEWAL * explorers.revisited[w]:
        for i in range(min(settings.places, explorers.place_count[w])):
            since = (explorers.step[w] - explorers.place_at[w, i]) * settings.period
            place = explorers.places[w, i]
            if not is_given_up(w, place[0], place[1], explorers.accounts):
                add_place(w, place[0], place[1], place[2], since, lengths, drive, candidates)
    measure_turns(w, senses.poses[w], lengths, drive, candidates)
    measure_ways_between(w, settings.radius, drive, candidates)
    _recognise_place(w, explorers)


@merged_kernel
def _recognise_place(w: int, explorers: Explorers) -> None:
    """Note which candidate is driven to where it is a known place."""
    accounts, candidates = explorers.accounts, explorers.candidates
    for k in range(candidates.number[w]):
        goal = candidates.goals[w, k, 0]
        away = math.hypot(goal[0] - accounts.pursued[w, 0], goal[1] - accounts.pursued[w, 1])
        if candidates.kind[w, k] != FRONTIER and accounts.has_pursued[w] and away < 0.5:
            candidates.pursued[w] = k


@merged_kernel
def _count_known(w: int, drive: Drive) -> int:
    """Known cells of the newest survey."""
    extent, known = drive.ground.extent[w], 0
    for k in range(extent[2] * extent[3]):
        known += drive.ground.occupancy[w, k] >= 0
    return known


@merged_kernel
def _note_growth(w: int, log_d: float, explorers: Explorers) -> None:
    """Count what is known, and note how certain the pose was from which the new part was seen."""
    known = _count_known(w, explorers.drive)
    explorers.sum_log_d[w] += log_d * max(known - explorers.mapped[w], 0)
    explorers.mapped[w] = max(known, explorers.mapped[w])
    if known > (1.0 + _GROWTH) * explorers.known[w]:
        explorers.known[w], explorers.grown_at[w] = known, explorers.step[w]


@merged_kernel
def _nearest_frontier(w: int, candidates: Candidates) -> int:
    """The first of the candidates that is a frontier; -1 if none is."""
    for k in range(candidates.number[w]):
        if candidates.kind[w, k] == FRONTIER:
            return k
    return -1


@merged_kernel
def _has_choice(w: int, settings: ExplorerSettings, explorers: Explorers) -> bool:
    """Whether there is a frontier to choose; notes why, if there is not."""
    explorers.ending[w] = OUT_OF_REACH if explorers.candidates.found[w] else EXPLORED
    if _nearest_frontier(w, explorers.candidates) < 0:
        return False
    if _is_exhausted(w, settings, explorers):
        explorers.ending[w] = FRUITLESS
        return False
    explorers.ending[w] = UNFINISHED
    return True


@merged_kernel
def _is_exhausted(w: int, settings: ExplorerSettings, explorers: Explorers) -> bool:
    """Whether the map has hardly grown for too long."""
    return bool(explorers.step[w] - explorers.grown_at[w] >= settings.fruitless)


@kernel
def set_out(w: int, choice: int, senses: Perceptions, driver: DriverSettings, explorers: Explorers) -> None:
    """Set out for the candidate that was chosen, or else for the nearest frontier that can be driven to.

    Args:
        w: World.
        choice: Number of a candidate; one that is not there stands for the nearest frontier.
        senses: As they were given to ``advance``.
        driver: Settings.
        explorers: Of all worlds.
    """
    candidates, count = explorers.candidates, explorers.candidates.number[w]
    explorers.wanted_at[w] = explorers.step[w]
    first = choice if 0 <= choice < count else _nearest_frontier(w, candidates)
    for i in range(count + 1):
        k = first if i == 0 else i - 1
        if i > 0 and (k == first or candidates.kind[w, k] != FRONTIER):
            continue
        if _try(w, k, senses, driver, explorers):
            return
    if not is_cornered(w, senses, driver, explorers.drive):
        stop(w, explorers.drive)


@merged_kernel
def _try(w: int, k: int, senses: Perceptions, driver: DriverSettings, explorers: Explorers) -> bool:
    """Set out for a candidate; whether it is settled what to do next."""
    candidates, accounts, drive = explorers.candidates, explorers.accounts, explorers.drive
    for g in range(2):
        x, y = candidates.goals[w, k, g, 0], candidates.goals[w, k, g, 1]
        if not candidates.usable[w, k, g] or is_given_up(w, x, y, accounts):
            continue
        if go(w, x, y, senses, driver, drive):
            explorers.revisits[w] = candidates.kind[w, k] != FRONTIER
            pursue(w, x, y, explorers.step[w], accounts)
            return True
        if candidates.kind[w, k] != FRONTIER:
            give_up(w, x, y, accounts)
            continue
        if is_cornered(w, senses, driver, drive):
            continue  # nothing can be said of this goal; any other that leads out of here is welcome
        near = math.hypot(x - senses.poses[w, 0], y - senses.poses[w, 1]) < _BESIDE
        if not fail(w, x, y, near, accounts):
            stop(w, drive)
            return True  # turn on the spot and try again, rather than drive elsewhere and come back
    return False


@kernel
def command(w: int, senses: Perceptions, driver: DriverSettings, explorers: Explorers) -> int:
    """The number of the next command."""
    return next_command(w, senses, driver, explorers.drive)
