"""The picture of a workshop: the floor with the two at work, and beside it who has done what when."""

from typing import TYPE_CHECKING

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.envs.workshop.kernels import AWAY, IDLE, WAITING, WALKING, WORKING
from lidarena.envs.workshop.records import PICTURE_TICKS
from lidarena.envs.workshop.walking import TICK
from lidarena.world.canvas import BLUE, GREY, INK, ORANGE, WHITE, Canvas, Colour, draw_floorplan, write

if TYPE_CHECKING:
    from lidarena.envs.workshop.state import WorkshopCore
    from lidarena.envs.workshop.task import WorkshopTask

_SIDE = 560
"""Width of the floor [pixels]."""
_LANE, _HEADER, _LEFT = 34, 48, 74
_WIDE = 72
"""Characters in a row of the key."""
Segment = tuple[int, int, int, float, float]
"""Agent, phase, action, begin and end [s]."""
AGENT_COLOURS: tuple[Colour, Colour] = (ORANGE, BLUE)
"""Of human and robot."""
PHASES = {IDLE: "idle", WALKING: "walks", WAITING: "waits", WORKING: "works", AWAY: "away"}
"""What an agent does, in a word."""


def segments(log: NDArray[np.float64], logged: int, until: float) -> list[Segment]:
    """What each agent did from when to when.

    Args:
        log: (M, 4) of a world, see ``records.Workers``.
        logged: How many of its rows there are.
        until: Up to when [s].

    Returns:
        Agent, phase, action, begin and end [s], in the order of their beginnings; agents begin idle.
    """
    found = []
    last: list[tuple[int, int, float]] = [(IDLE, -1, 0.0), (IDLE, -1, 0.0)]
    for agent, phase, action, time in log[:logged].tolist():
        if time > until:
            break
        before, doing, since = last[int(agent)]
        if time > since:
            found.append((int(agent), before, doing, since, time))
        last[int(agent)] = (int(phase), int(action), time)
    for agent, (phase, action, since) in enumerate(last):
        if until > since:
            found.append((agent, phase, action, since, until))
    return sorted(found, key=lambda one: (one[3], one[0]))


def draw_workshop(core: "WorkshopCore", world: int, time: float | None = None) -> NDArray[np.uint8]:
    """Draw one world, RGB (height, width, 3).

    Args:
        core: The worlds.
        world: Which one.
        time: As it was then [s]; None draws it as it is now.
    """
    task, s = core.task, core.workers
    now = float(core.time[world]) if time is None else time
    poses = s.poses[world] if time is None else s.trace[world, round(time / (PICTURE_TICKS * TICK))]
    parts = segments(s.log[world], int(s.logged[world]), now)
    scale = _SIDE / (task.plan.bounds[2] - task.plan.bounds[0])
    canvas = Canvas(task.plan.bounds, scale)
    draw_floorplan(canvas, task.plan)
    _draw_locations(core, canvas)
    for agent, name in enumerate(("human", "robot")):
        pose = poses[agent]
        canvas.robot(pose, task.radii[agent], AGENT_COLOURS[agent])
        column = int((pose[0] - canvas.bounds[0]) * scale) - 18
        row = canvas.image.shape[0] - int((pose[1] - canvas.bounds[1]) * scale) - int(task.radii[agent] * scale) - 6
        write(canvas.image, name, column, row, AGENT_COLOURS[agent])
    done = int((s.ended[world] <= now).sum())
    return np.vstack([_headline(task, parts, done, now), canvas.image, _schedule(task, parts, now), _key(task)])


def _draw_locations(core: "WorkshopCore", canvas: Canvas) -> None:
    task = core.task
    for number, name in enumerate(task.locations[:-2]):
        places = task.grid.points[np.unique(task.arrays.field[number])]
        canvas.dots(places, GREY, 6.0)
        canvas.dots(places, WHITE, 4.0)
        x, y = places.mean(axis=0)
        column = int((x - canvas.bounds[0]) * canvas.scale) - 4 * len(name)
        below = 22 if len(places) == 1 else 4  # what both reach, each from a side, is named in its middle
        row = canvas.image.shape[0] - int((y - canvas.bounds[1]) * canvas.scale) + below
        write(canvas.image, name.replace("_", " "), min(max(column, 12), _SIDE - 9 * len(name)), row, INK)


def _headline(task: "WorkshopTask", parts: list[Segment], done: int, now: float) -> NDArray[np.uint8]:
    """What is done, and what both do."""
    band = np.full((_HEADER, _SIDE, 3), 255, np.uint8)
    write(band, f"{task.title}: {done} of {len(task.actions)} done, {now:.0f} s of {task.deadline:.0f} s", 10, 18)
    for agent, (name, left) in enumerate((("human", 10), ("robot", _SIDE // 2))):
        own = [part for part in parts if part[0] == agent]
        phase, action = (own[-1][1], own[-1][2]) if own else (IDLE, -1)
        what = f" ({action + 1} {task.actions[action].replace('_', ' ')})" if action >= 0 else ""
        write(band, f"{name} {PHASES[phase]}{what}", left, 38, AGENT_COLOURS[agent])
    return band


def _schedule(task: "WorkshopTask", parts: list[Segment], now: float) -> NDArray[np.uint8]:
    """Gantt chart of the two: strong colours are work, pale ones walking; nothing is idling."""
    band = np.full((2 * _LANE + 26, _SIDE, 3), 255, np.uint8)
    scale = (_SIDE - _LEFT - 12) / max(1.15 * task.deadline, now)

    def column(time: float) -> int:
        return _LEFT + int(time * scale)

    for agent, phase, action, begin, until in parts:
        top = 8 + agent * _LANE
        cv2.rectangle(
            band, (column(begin), top), (column(until), top + _LANE - 8), shade(AGENT_COLOURS[agent], phase), -1
        )
        if phase == WORKING and action >= 0 and column(until) - column(begin) >= 9 * len(str(action + 1)):
            write(band, str(action + 1), column(begin) + 2, top + 17, WHITE)
    for agent, name in enumerate(("human", "robot")):
        write(band, name, 10, 26 + agent * _LANE, AGENT_COLOURS[agent])
    late = column(task.deadline)
    cv2.line(band, (late, 2), (late, 2 * _LANE + 6), INK, 1)
    write(band, "deadline", late - 58, 2 * _LANE + 20, INK, 0.36)
    cv2.line(band, (_LEFT, 2 * _LANE + 6), (_SIDE - 12, 2 * _LANE + 6), GREY, 1)
    write(band, "0 s", _LEFT - 4, 2 * _LANE + 20, INK, 0.36)
    return band


def _key(task: "WorkshopTask") -> NDArray[np.uint8]:
    """What numbers and colours stand for."""
    names = [f"{number} {name.replace('_', ' ')}" for number, name in enumerate(task.actions, start=1)]
    rows = ["strong: works (number of the action), pale: walks, grey: waits, dark grey: away"]
    for name in names:
        if rows[-1] is rows[0] or len(rows[-1]) + len(name) > _WIDE:
            rows.append(name)
        else:
            rows[-1] += f"   {name}"
    band = np.full((18 * len(rows) + 8, _SIDE, 3), 255, np.uint8)
    for k, row in enumerate(rows):
        write(band, row, 10, 14 + 18 * k, INK, 0.36)
    return band


def shade(colour: Colour, phase: int) -> Colour:
    """Work in the agent's own colour, walking in a pale one, waiting and absence in greys, idling in white."""
    if phase == WORKING:
        return colour
    if phase == WALKING:
        red, green, blue = (int(255 - 0.4 * (255 - part)) for part in colour)
        return red, green, blue
    return {WAITING: (205, 205, 210), AWAY: (120, 120, 125)}.get(phase, WHITE)
