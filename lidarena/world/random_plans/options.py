"""What a random floor plan may look like: size, proportions, and the numbers of its kind, checked at the border."""

import math
from collections.abc import Mapping

import numpy as np

from lidarena.base.errors import MapError, suggest

LEAST_AREA, MOST_AREA = 20.0, 400.0
"""Areas that are allowed [m²]."""
_LEAST_SIDE, _MOST_SIDE = 3.0, 40.0
_LONGEST = 1.6
"""The longer side is at most so many times the shorter one, where it is drawn."""

COMMON = {
    "width": (_LEAST_SIDE, _MOST_SIDE),
    "height": (_LEAST_SIDE, _MOST_SIDE),
    "area": (LEAST_AREA, MOST_AREA),
    "area_min": (LEAST_AREA, MOST_AREA),
    "area_max": (LEAST_AREA, MOST_AREA),
}
"""Options of every kind with their ranges: the outer size [m], or the area [m²], or the areas to draw from."""
_USUAL_AREAS = (30.0, 120.0)


def checked_options(kind: str, given: Mapping[str, float], own: Mapping[str, tuple[float, float]]) -> dict[str, float]:
    """Check the options of a kind of random plan.

    Args:
        kind: Such as ``"rooms"``.
        given: By name.
        own: The ranges of the kind's own options.

    Raises:
        MapError: An option that there is not or that is out of range, or sizes that contradict each other.
    """
    ranges = COMMON | dict(own)
    for name, value in given.items():
        if name not in ranges:
            raise MapError(f"a random {kind} plan has no option {name!r}{suggest(name, ranges)}")
        low, high = ranges[name]
        if not low <= value <= high:  # also refuses NaN
            raise MapError(f"a random {kind} plan has {name} {value:g}; {low:g} to {high:g} are allowed")
    _check_sizes(kind, given)
    return dict(given)


def _check_sizes(kind: str, given: Mapping[str, float]) -> None:
    if ("width" in given) != ("height" in given):
        raise MapError(f"a random {kind} plan is given width and height together, or neither of them")
    sized = [name for name in COMMON if name in given]
    if ("width" in given or "area" in given) and len(sized) > (2 if "width" in given else 1):
        raise MapError(f"a random {kind} plan is given {', '.join(sized)}; one way to say its size is allowed")
    if "width" in given and not LEAST_AREA <= given["width"] * given["height"] <= MOST_AREA:
        raise MapError(
            f"a random {kind} plan has {given['width']:g} m x {given['height']:g} m; "
            f"{LEAST_AREA:g} to {MOST_AREA:g} m² are allowed"
        )
    low, high = (given.get(name, value) for name, value in zip(("area_min", "area_max"), _USUAL_AREAS, strict=True))
    if low > high:
        raise MapError(f"a random {kind} plan has area_min {low:g} above area_max {high:g}")


def draw_size(rng: np.random.Generator, given: Mapping[str, float]) -> tuple[float, float]:
    """Return the outer size of a plan, along x and y [m], in whole decimetres: as given, or drawn.

    Areas are drawn evenly on a logarithmic scale, so that small plans are as frequent as large ones.
    """
    if "width" in given:
        return given["width"], given["height"]
    low, high = _areas(given)
    area = math.exp(rng.uniform(math.log(low), math.log(high)))
    ratio = math.exp(rng.uniform(-1.0, 1.0) * math.log(_LONGEST))
    width = round(math.sqrt(area * ratio), 1)
    return width, round(area / width, 1)


def largest_sides(given: Mapping[str, float]) -> tuple[float, float]:
    """Return the largest width and height that ``draw_size`` draws [m]."""
    if "width" in given:
        return given["width"], given["height"]
    side = round(math.sqrt(_areas(given)[1] * _LONGEST), 1) + 0.1  # as sizes are rounded
    return side, side


def tightest_sizes(given: Mapping[str, float]) -> list[tuple[float, float]]:
    """Return the widths and heights that ``draw_size`` draws into which the least fits: the narrowest, and a square."""
    if "width" in given:
        return [(given["width"], given["height"])]
    area, _ = _areas(given)
    widths = (round(math.sqrt(area * ratio), 1) for ratio in (_LONGEST, 1.0))
    return [(width, area / width) for width in widths]


def _areas(given: Mapping[str, float]) -> tuple[float, float]:
    """The smallest and the largest area to draw from [m²]."""
    low = given.get("area", given.get("area_min", min(_USUAL_AREAS[0], given.get("area_max", MOST_AREA))))
    return low, given.get("area", given.get("area_max", max(_USUAL_AREAS[1], low)))
