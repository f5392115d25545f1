"""The workshop in time: who walks, works, waits and chooses, tick by tick, until somebody has to decide."""

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from lidarena.base.jit import inlined, leaf, take_next
from lidarena.base.random_streams import normal, uniform
from lidarena.envs.workshop.humans import TRUNCATION, WITHIN_BOUNDS
from lidarena.envs.workshop.records import PICTURE_TICKS, Records
from lidarena.envs.workshop.task import HUMAN, ROBOT, TaskArrays
from lidarena.envs.workshop.walking import TICK, WalkGrid, direction, flee, sidestep, way_length

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Bools = NDArray[np.bool_]

IDLE, WALKING, WAITING, WORKING, AWAY = range(5)
"""What an agent does: nothing; on its way; at a location that it may not work at yet; at work; gone for a while."""
OPEN, RUNNING, DONE = range(3)
"""What is the matter with an action."""
NOTHING, LEAVING = -1, -2
"""In place of an action: none, and the way out."""
RUNS, DECIDES, NEAR, ENDS = range(4)
"""What a world stands at: it goes on, somebody decides, pymunk is asked about the next tick, the episode is over."""
PATIENCE, BACKING, SQUEEZE = 3.0, 4.0, 20.0
"""Blocked for so long, the robot backs off, for so long; and both pass each other as near as they must [s]."""
_MARGIN = 0.02
"""Gap below which pymunk moves the bodies [m]."""


class Rules(NamedTuple):
    """What holds in all worlds."""

    keep: float
    """Distance of the two centres that is kept [m]"""
    touch: float
    """Distance at which they touch [m]"""
    wait: float
    """After which who waits is asked again [s]"""
    limit: float
    """At which an episode is cut off [s]"""
    external: bool
    """Whether the human is asked, too"""


@inlined
def is_allowed(task: TaskArrays, s: Records, w: int, agent: int, action: int) -> bool:
    """Whether an agent may choose an action: it can do it, and what must come before is done or under way."""
    if s.actions[w, action].status != OPEN or not task.capable[agent, action]:
        return False
    clear = True
    for i in range(s.actions.shape[1]):
        clear = clear and not (task.before[i, action] and s.actions[w, i].status == OPEN)
    return clear


@inlined
def _note(s: Records, w: int, agent: int, phase: int) -> None:
    """An agent does something else from now on."""
    s.agents[w, agent].phase, s.agents[w, agent].changed = phase, s.world[w].ticks * TICK
    k = s.world[w].logged
    if k < s.log.shape[1]:
        s.log[w, k, 0], s.log[w, k, 1] = agent, phase
        s.log[w, k, 2], s.log[w, k, 3] = s.agents[w, agent].action, s.world[w].ticks * TICK
        s.world[w].logged = k + 1


@inlined
def _wake(s: Records, w: int) -> None:
    """Something has happened: who waits looks up."""
    for agent in range(2):
        if not s.agents[w, agent].deaf:
            s.agents[w, agent].asleep = False


@leaf
def _remember(task: TaskArrays, s: Records, w: int, chosen: int) -> None:
    """What the human has shown of its preferences by choosing an action, or ``NOTHING``, among what it may."""
    for k in range(s.actions.shape[1]):
        if k != chosen and is_allowed(task, s, w, HUMAN, k):
            if chosen == NOTHING:
                s.actions[w, k].declined += 1
            else:
                s.actions[w, k].passed_over += 1


@leaf
def rest(task: TaskArrays, s: Records, w: int, agent: int, duration: float, deaf: bool) -> None:
    """An agent does nothing for a while; unless it is ``deaf``, until something happens."""
    if agent == HUMAN:
        _remember(task, s, w, NOTHING)
    s.agents[w, agent].asleep, s.agents[w, agent].deaf = True, deaf
    s.agents[w, agent].wake = s.world[w].ticks * TICK + duration


@leaf
def begin(task: TaskArrays, s: Records, w: int, agent: int, action: int) -> None:
    """An agent sets out for an action; how long the work takes is drawn now."""
    if agent == HUMAN:
        _remember(task, s, w, action)
    s.actions[w, action].unplanned = not is_allowed(task, s, w, agent, action)
    s.actions[w, action].status, s.actions[w, action].agent = RUNNING, agent
    s.actions[w, action].begun = s.world[w].ticks * TICK
    who = agent if task.capable[agent, action] else 1 - agent
    low, high = task.lower[who, action], task.upper[who, action]
    duration = low
    if agent == HUMAN:
        s.world[w].origin[0], s.world[w].origin[1] = s.poses[w, HUMAN, 0], s.poses[w, HUMAN, 1]
        spread = max(math.log(high / low) / (2.0 * WITHIN_BOUNDS), 0.02) * s.human[w].spread
        z = min(max(normal(s.streams[w]), -TRUNCATION), TRUNCATION)
        duration = s.human[w].pace * math.sqrt(low * high) * math.exp(spread * z)
    s.actions[w, action].worked = duration
    s.agents[w, agent].action, s.agents[w, agent].stop, s.agents[w, agent].asleep = action, 0, False
    _note(s, w, agent, WALKING)
    _wake(s, w)


@leaf
def choose_as_human(task: TaskArrays, grid: WalkGrid, s: Records, rules: Rules, w: int) -> None:
    """Let the simulated human choose its next action, rest, or leave."""
    time = s.world[w].ticks * TICK
    if time >= s.human[w].leaves_at:
        s.human[w].leaves_at = np.inf
        s.agents[w, HUMAN].action = LEAVING
        _note(s, w, HUMAN, WALKING)
        _wake(s, w)
        return
    if s.human[w].rest_chance > 0.0 and not s.agents[w, HUMAN].deaf and uniform(s.streams[w]) < s.human[w].rest_chance:
        rest(task, s, w, HUMAN, -s.human[w].rest_time * math.log(1.0 - uniform(s.streams[w])), True)
        return
    s.agents[w, HUMAN].deaf = False
    best, chosen = -np.inf, NOTHING
    longest = 1e-9
    for k in range(task.tail.shape[0]):
        longest = max(longest, task.tail[k])
    for k in range(s.actions.shape[1]):
        if s.actions[w, k].refuses or not is_allowed(task, s, w, HUMAN, k):
            continue
        way = way_length(grid, task.field[task.stops[k, 0], HUMAN], s.poses[w, HUMAN, 0], s.poses[w, HUMAN, 1])
        value = s.human[w].urgency * (task.tail[k] / longest + (0.0 if task.capable[ROBOT, k] else 0.5))
        value += s.human[w].liking * s.actions[w, k].likes - s.human[w].nearness * way * TICK / task.step[HUMAN] / 10.0
        value -= s.human[w].randomness * math.log(-math.log(max(uniform(s.streams[w]), 1e-300)))
        if value > best:
            best, chosen = value, k
    if chosen == NOTHING:
        rest(task, s, w, HUMAN, rules.wait, False)
    else:
        begin(task, s, w, HUMAN, chosen)


@leaf
def _arrive(task: TaskArrays, s: Records, w: int, agent: int) -> None:
    """An agent stands at its location: it begins to work, or waits for what must come before."""
    action, stop = s.agents[w, agent].action, s.agents[w, agent].stop
    if action == LEAVING:
        s.agents[w, agent].left = s.human[w].away_time
        _note(s, w, agent, AWAY)
        return
    last = stop == task.stop_count[action] - 1
    if last and not s.actions[w, action].unplanned:
        for i in range(s.actions.shape[1]):
            if task.before[i, action] and s.actions[w, i].status != DONE:
                if s.agents[w, agent].phase != WAITING:
                    _note(s, w, agent, WAITING)
                return
    if last:
        s.actions[w, action].placed = s.world[w].ticks * TICK
    s.agents[w, agent].left = s.actions[w, action].worked * task.share[action, stop]
    _note(s, w, agent, WORKING)


@leaf
def _finish(task: TaskArrays, s: Records, w: int, agent: int) -> None:
    """The work at a location is done: on to the next one, or the action has ended; or somebody is back."""
    action = s.agents[w, agent].action
    if s.agents[w, agent].phase == AWAY:
        s.agents[w, agent].action = NOTHING
        _note(s, w, agent, IDLE)
        _wake(s, w)
        return
    s.agents[w, agent].stop += 1
    if s.agents[w, agent].stop < task.stop_count[action]:
        _note(s, w, agent, WALKING)
        return
    s.actions[w, action].status, s.actions[w, action].ended = DONE, s.world[w].ticks * TICK
    s.agents[w, agent].action = NOTHING
    _note(s, w, agent, IDLE)
    _wake(s, w)


@inlined
def _target(task: TaskArrays, s: Records, w: int, agent: int) -> int:
    """Number of the point that an agent walks to."""
    action = s.agents[w, agent].action
    place = task.home[agent] if action == LEAVING else task.stops[action, s.agents[w, agent].stop]
    return int(task.field[place, agent])


@leaf
def _back_off(task: TaskArrays, grid: WalkGrid, place: Floats, other: Floats) -> tuple[float, float]:
    """The direction of that way to any location which leads away from the other most."""
    ax, ay = place[0] - other[0], place[1] - other[1]
    best, bx, by = 0.0, 0.0, 0.0
    for field in range(grid.points.shape[0]):
        dx, dy = direction(grid, field, place[0], place[1])
        far = math.hypot(grid.points[field, 0] - place[0], grid.points[field, 1] - place[1])
        if far > 0.5 and dx * ax + dy * ay > best:
            best, bx, by = dx * ax + dy * ay, dx, dy
    return bx, by


@leaf
def _steer(task: TaskArrays, grid: WalkGrid, s: Records, rules: Rules, w: int, agent: int, wanted: Floats) -> float:
    """Where an agent goes in the next tick, a unit vector in ``wanted`` (2,); returns how far [m], 0 if it stands."""
    place, other = s.poses[w, agent], s.poses[w, 1 - agent]
    step = task.step[agent]
    apart = math.hypot(place[0] - other[0], place[1] - other[1])
    keep = rules.keep if max(s.agents[w, 0].stuck, s.agents[w, 1].stuck) < SQUEEZE else rules.touch
    if s.agents[w, agent].phase != WALKING:
        gives_way = s.agents[w, agent].phase in (IDLE, WAITING) and s.agents[w, 1 - agent].phase == WALKING
        if gives_way and s.agents[w, 1 - agent].stuck > 0.5 and apart < keep + 0.3:
            dx, dy = flee(grid, place, other, step)
            wanted[0], wanted[1] = dx, dy
            return step if dx != 0.0 or dy != 0.0 else 0.0
        return 0.0
    field = _target(task, s, w, agent)
    away = math.hypot(grid.points[field, 0] - place[0], grid.points[field, 1] - place[1])
    dx, dy = direction(grid, field, place[0], place[1])
    if agent == ROBOT and s.world[w].ticks * TICK < s.world[w].backing:
        dx, dy = _back_off(task, grid, place, other)
        away = step
    taken = math.hypot(grid.points[field, 0] - other[0], grid.points[field, 1] - other[1]) < keep
    if taken and apart < keep + 2.0 * step and away < 2.0 * keep and s.agents[w, 1 - agent].phase != WALKING:
        s.agents[w, agent].stuck += TICK  # somebody stands there: it waits for its turn rather than circles
        if s.agents[w, 1 - agent].phase in (WORKING, AWAY):
            s.agents[w, agent].stuck = min(s.agents[w, agent].stuck, 0.6)
        return 0.0
    wanted[0], wanted[1] = dx, dy
    step = min(step, away)
    dx, dy, s.agents[w, agent].side = sidestep(grid, place, other, wanted, step, keep, s.agents[w, agent].side)
    if dx == 0.0 and dy == 0.0:
        s.agents[w, agent].stuck += TICK
        if agent == ROBOT and s.agents[w, agent].stuck > PATIENCE and s.world[w].ticks * TICK >= s.world[w].backing:
            s.world[w].backing = s.world[w].ticks * TICK + BACKING
        return 0.0
    turned = dx != wanted[0] or dy != wanted[1]
    s.agents[w, agent].stuck = max(0.0, s.agents[w, agent].stuck - 0.5 * TICK) if turned else 0.0
    wanted[0], wanted[1] = dx, dy
    return float(step)


@leaf
def _advance_tick(task: TaskArrays, grid: WalkGrid, s: Records, rules: Rules, w: int, wanted: Floats) -> bool:
    """Move both by a tick; False if pymunk has to, then the commands say how."""
    lengths = (_steer(task, grid, s, rules, w, HUMAN, wanted[0]), _steer(task, grid, s, rules, w, ROBOT, wanted[1]))
    hx = s.poses[w, 0, 0] + lengths[0] * wanted[0, 0] - s.poses[w, 1, 0] - lengths[1] * wanted[1, 0]
    hy = s.poses[w, 0, 1] + lengths[0] * wanted[0, 1] - s.poses[w, 1, 1] - lengths[1] * wanted[1, 1]
    gap = math.hypot(hx, hy)
    if gap < rules.keep and lengths[0] > 0.0 and lengths[1] > 0.0 and gap > rules.touch + _MARGIN:
        lengths = (lengths[0], 0.0)  # what each may do alone both may not do at once: the robot lets the human go
    for agent in range(2):
        if lengths[agent] > 0.0:
            s.poses[w, agent, 2] = math.atan2(wanted[agent, 1], wanted[agent, 0])
        s.commands[w, agent, 0] = lengths[agent] / TICK
    if gap <= rules.touch + _MARGIN and lengths[0] + lengths[1] > 0.0:
        return False
    for agent in range(2):
        s.poses[w, agent, 0] += lengths[agent] * wanted[agent, 0]
        s.poses[w, agent, 1] += lengths[agent] * wanted[agent, 1]
        s.agents[w, agent].path += lengths[agent]
    return True


@leaf
def _measure(s: Records, rules: Rules, w: int, ticks: int) -> None:
    """Note who is idle, whether both are busy, and how near they are, for some ticks."""
    busy = 0
    for agent in range(2):
        phase = s.agents[w, agent].phase
        if phase in (IDLE, WAITING):
            s.agents[w, agent].idle += ticks * TICK
        elif phase != AWAY and s.agents[w, agent].action >= 0:
            busy += 1
    if busy == 2:
        s.world[w].together += ticks * TICK
    apart = math.hypot(s.poses[w, 0, 0] - s.poses[w, 1, 0], s.poses[w, 0, 1] - s.poses[w, 1, 1])
    s.world[w].least_gap = min(s.world[w].least_gap, apart - rules.touch)


@leaf
def _trace(s: Records, w: int, ticks: int) -> None:
    """Note where both are in the next ticks, for pictures."""
    begin = s.world[w].ticks
    first = begin // PICTURE_TICKS + 1 if begin > 0 else 0
    last = min((begin + ticks) // PICTURE_TICKS, s.trace.shape[1] - 1)
    for moment in range(first, last + 1):
        for agent in range(2):
            for k in range(3):
                s.trace[w, moment, agent, k] = s.poses[w, agent, k]


@leaf
def account(task: TaskArrays, grid: WalkGrid, s: Records, rules: Rules, w: int, ticks: int) -> None:
    """Let time pass in which everybody does what they do: work goes on, and who has arrived begins."""
    _measure(s, rules, w, ticks)
    _trace(s, w, ticks)
    s.world[w].ticks += ticks
    for agent in range(2):
        phase = s.agents[w, agent].phase
        if phase in (WORKING, AWAY):
            s.agents[w, agent].left -= ticks * TICK
            if s.agents[w, agent].left <= 1e-9:
                _finish(task, s, w, agent)
        elif phase in (WALKING, WAITING):
            field = _target(task, s, w, agent)
            dx, dy = grid.points[field, 0] - s.poses[w, agent, 0], grid.points[field, 1] - s.poses[w, agent, 1]
            if math.hypot(dx, dy) < 1e-6:
                _arrive(task, s, w, agent)
            elif phase == WAITING and _may_return(task, s, w, agent):
                _note(s, w, agent, WALKING)
        elif s.agents[w, agent].asleep and s.world[w].ticks * TICK >= s.agents[w, agent].wake - 1e-9:
            s.agents[w, agent].asleep = False


@inlined
def _may_return(task: TaskArrays, s: Records, w: int, agent: int) -> bool:
    """Whether who gave way while waiting goes back, since the other has gone on or the wait is over."""
    return bool(s.agents[w, 1 - agent].phase != WALKING or s.agents[w, 1 - agent].stuck == 0.0)


@leaf
def _still(s: Records, rules: Rules, w: int) -> int:
    """Ticks for which nobody will move or decide: 1 where somebody walks."""
    soonest = rules.limit - s.world[w].ticks * TICK
    for agent in range(2):
        phase = s.agents[w, agent].phase
        if phase == WALKING:
            return 1
        if phase in (WORKING, AWAY):
            soonest = min(soonest, s.agents[w, agent].left)
        elif phase == IDLE:
            soonest = min(soonest, s.agents[w, agent].wake - s.world[w].ticks * TICK)
        else:
            soonest = min(soonest, TICK if s.agents[w, 1 - agent].phase == WAITING else rules.limit)
    return int(max(1, math.ceil(soonest / TICK - 1e-6)))


@leaf
def _look(task: TaskArrays, grid: WalkGrid, s: Records, rules: Rules, w: int) -> int:
    """See who has to decide, the human first; a simulated one does so at once."""
    done = True
    for k in range(s.actions.shape[1]):
        done = done and s.actions[w, k].status == DONE
    if done or s.world[w].ticks * TICK >= rules.limit - 1e-9:
        s.agents[w, 0].due = s.agents[w, 1].due = False
        return ENDS
    if s.agents[w, HUMAN].phase == IDLE and not s.agents[w, HUMAN].asleep and not rules.external:
        choose_as_human(task, grid, s, rules, w)
    for agent in range(2):
        s.agents[w, agent].due = s.agents[w, agent].phase == IDLE and not s.agents[w, agent].asleep
    return DECIDES if s.agents[w, 0].due or s.agents[w, 1].due else RUNS


@leaf
def advance(
    task: TaskArrays, grid: WalkGrid, s: Records, rules: Rules, active: Bools, counter: Ints, scratch: Floats
) -> None:
    """Let the active worlds run until somebody has to decide, pymunk is needed, or the episode is over.

    Args:
        task: What is to be done.
        grid: Where.
        s: The worlds.
        rules: What holds in all of them.
        active: (W,) which ones run.
        counter: (1,) the next world; threads share it.
        scratch: (2, 2) of this thread's own.
    """
    w = take_next(counter)
    while w < active.shape[0]:
        if active[w]:
            s.world[w].verdict = _look(task, grid, s, rules, w)
            while s.world[w].verdict == RUNS:
                ticks = _still(s, rules, w)
                if not _advance_tick(task, grid, s, rules, w, scratch):
                    s.world[w].verdict = NEAR
                    break
                account(task, grid, s, rules, w, ticks)
                s.world[w].verdict = _look(task, grid, s, rules, w)
        w = take_next(counter)


@leaf
def settle(task: TaskArrays, grid: WalkGrid, s: Records, rules: Rules, near: NDArray[np.bool_]) -> None:
    """Account for the tick by which pymunk has moved the two of some worlds."""
    for w in range(near.shape[0]):
        if near[w]:
            account(task, grid, s, rules, w, 1)


@leaf
def take_decisions(
    task: TaskArrays,
    s: Records,
    rules: Rules,
    agent: int,
    choices: NDArray[np.int64],
    asked: NDArray[np.bool_],
    forced: bool,
    refused: NDArray[np.bool_],
) -> None:
    """Begin what an agent chose, or let it wait; ``refused`` (worlds,) says where it has to; see ``decide``."""
    count = s.actions.shape[1]
    for w in range(choices.shape[0]):
        if not (asked[w] and s.agents[w, agent].due):
            continue
        choice = choices[w]
        if choice < count and s.actions[w, choice].status == OPEN and (forced or is_allowed(task, s, w, agent, choice)):
            begin(task, s, w, agent, choice)
        else:
            refused[w] = choice < count
            rest(task, s, w, agent, rules.wait, False)
