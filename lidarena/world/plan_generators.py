"""Floor plans that are drawn: ``map=`` takes a generator of one's own, which draws a new plan for every episode."""

import math
import re
from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np

from lidarena.base.errors import MapError
from lidarena.base.import_names import import_named
from lidarena.world.floorplan import Floorplan
from lidarena.world.random_plans import random_plans

PlanGenerator = Callable[[np.random.Generator], Floorplan]
"""Draws a floor plan, with nothing random but from the generator that it is given: same numbers, same plan.

Where its plans are of different sizes it says the largest, ``size`` = (width, height) [m], since the maps that robots
make have one shape for all episodes: ``generator.size = (12.0, 9.0)``, or an attribute of its class.
"""

_NAMED = re.compile(r"[A-Za-z_][\w.]*:[A-Za-z_]\w*")
_LARGEST_SIDE = 1000.0
_PROBES = 8


def plan_generator(spec: object) -> PlanGenerator | None:
    """Return the generator that ``map=`` names; None if it names something else.

    Args:
        spec: A callable, or ``"module:callable"``; a class is made once, without arguments. Or ``"random:KIND"``, see
            ``random_plans``.

    Raises:
        ConfigError: There is no such module, or no such name in it.
        MapError: What is named cannot be called.
    """
    found: Any = spec
    if isinstance(spec, str) and spec.startswith("random:"):
        return random_plans(spec)
    if isinstance(spec, str):
        if not _NAMED.fullmatch(spec):
            return None
        found = import_named(spec, f"map {spec!r}")
        if not callable(found):
            raise MapError(f"map {spec!r} is of type {type(found).__name__}; a function that draws a plan is needed")
    elif isinstance(spec, Floorplan) or not callable(spec):
        return None
    generator: PlanGenerator = found() if isinstance(found, type) else found
    return generator


def generator_name(generator: Callable[..., Any]) -> str:
    """Return what messages call a generator."""
    return str(getattr(generator, "__name__", type(generator).__name__))


def draw_plan(generator: PlanGenerator, number: int) -> Floorplan:
    """Draw the plan of a number, always the same one.

    Raises:
        MapError: What is drawn is no floor plan, or has its start outside of its bounds.
    """
    plan = generator(np.random.default_rng(number))
    if not isinstance(plan, Floorplan):
        raise MapError(
            f"map generator {generator_name(generator)!r} returned an object of type "
            f"{type(plan).__name__}; a Floorplan is needed"
        )
    x, y, _ = plan.start
    if not (plan.bounds[0] <= x <= plan.bounds[2] and plan.bounds[1] <= y <= plan.bounds[3]):
        raise MapError(
            f"map generator {generator_name(generator)!r} drew plan {plan.name!r} whose start ({x:g}, {y:g}) lies "
            f"outside of its bounds {plan.bounds}"
        )
    return plan


def largest_size(generator: PlanGenerator) -> tuple[float, float]:
    """Return (width, height) of the largest plan that a generator draws [m].

    It is the generator's ``size``; without it that of its plans, if the first ones are all as large.

    Raises:
        MapError: The plans differ in size and none is said, or it is no size.
    """
    said: Any = getattr(generator, "size", None)
    if said is not None:
        return _checked_size(generator, said)
    return _size_of_all(generator) if getattr(generator, "__hash__", None) else _common_size(generator)


def size_of(plan: Floorplan) -> tuple[float, float]:
    """Return (width, height) of a plan [m]."""
    return plan.bounds[2] - plan.bounds[0], plan.bounds[3] - plan.bounds[1]


def _checked_size(generator: PlanGenerator, said: Any) -> tuple[float, float]:
    try:
        width, height = (float(side) for side in said)
    except (TypeError, ValueError):
        width = height = math.nan
    if not (0.0 < width <= _LARGEST_SIDE and 0.0 < height <= _LARGEST_SIDE):
        raise MapError(
            f"map generator {generator_name(generator)!r} has size {said!r}; width and height of the largest plan that "
            f"it draws are needed, in metres up to {_LARGEST_SIDE:g}"
        )
    return width, height


def _common_size(generator: PlanGenerator) -> tuple[float, float]:
    sizes = [size_of(draw_plan(generator, number)) for number in range(_PROBES)]
    width, height = max(size[0] for size in sizes), max(size[1] for size in sizes)
    for one in sizes:
        if abs(one[0] - width) > 1e-6 or abs(one[1] - height) > 1e-6:
            raise MapError(
                f"map generator {generator_name(generator)!r} draws plans of different sizes, such as "
                f"{one[0]:g} × {one[1]:g} m and up to {width:g} × {height:g} m; say the largest as its attribute "
                "size = (width, height)"
            )
    return width, height


_size_of_all = lru_cache(maxsize=64)(_common_size)
