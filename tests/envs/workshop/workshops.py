"""Tasks and episodes that the tests of the workshop share."""

from collections.abc import Callable
from typing import Any

import numpy as np

from lidarena.envs.workshop.env import WorkshopEnv

ROOM = {"bounds": [0, 0, 8, 6]}
AGENTS = {"human": {"home": [1, 1], "speed": 1.0}, "robot": {"home": [7, 1], "speed": 0.5}}


def task_of(actions: dict[str, Any], **more: Any) -> dict[str, Any]:
    """A task in an empty room, with shelves a to d and a table."""
    places: dict[str, Any] = {"a": [1, 5], "b": [3, 5], "c": [5, 5], "d": [7, 5]}
    places["table"] = {"human": [3, 3], "robot": [5, 3]}
    whole = {"floor": ROOM, "agents": AGENTS, "locations": places, "actions": actions, "deadline": 100.0}
    return whole | more


def action(at: str | list[str], human: Any = (4, 6), robot: Any = (5, 7), after: list[str] | None = None) -> Any:
    """An action; None for who cannot do it."""
    bounds = {name: list(one) for name, one in (("human", human), ("robot", robot)) if one is not None}
    return {"at": [at] if isinstance(at, str) else at, "duration": bounds, "after": after or []}


def chain(count: int) -> dict[str, Any]:
    """Actions one after the other, fetched from the shelves and put onto the table."""
    names = [f"part_{k}" for k in range(count)]
    return task_of({
        name: action(["abcd"[k % 4], "table"], after=names[k - 1 : k] if k else [])
        for k, name in enumerate(names)
    })  # fmt: skip


def loose(count: int) -> dict[str, Any]:
    """Actions that do not wait for each other."""
    return task_of({f"part_{k}": action("abcd"[k % 4]) for k in range(count)})


def first_allowed(info: dict[str, Any]) -> int:
    """The first action of the mask, waiting last."""
    return int(np.flatnonzero(info["action_mask"])[0])


def play(env: WorkshopEnv, act: Callable[[dict[str, Any]], int] = first_allowed, seed: int = 0) -> list[dict[str, Any]]:
    """An episode; the infos of the reset and of every step."""
    _, info = env.reset(seed=seed)
    infos, over = [info], False
    while not over:
        _, _, terminated, truncated, info = env.step(act(info))
        infos.append(info)
        over = terminated or truncated
    return infos


class Sleeper:
    """A human who does nothing."""

    def choose(self, info: dict[str, Any], rng: np.random.Generator) -> int | None:
        return None


class Rebel:
    """A human who does whatever comes last in the task, allowed or not."""

    def choose(self, info: dict[str, Any], rng: np.random.Generator) -> int | None:
        open_ = np.flatnonzero(info["status"] == 0)
        return int(open_[-1]) if len(open_) else None
