"""Beams of a log: what their ranges mean, and scans of changing layout brought onto one set of angles."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from lidarena.slam.logs.recorded_log import RANGE_UNITS, LogError, LogOptions

SICK_CODES = (81.83, 81.87, 81.91)
"""What SICK's lasers report for no return, dazzle and overflow [m]."""
_CODE_WIDTH = 0.006
_NEAR_MAXIMUM = 0.995
"""Ranges from this share of the longest on are no returns: drivers scatter them a little."""
_SAME_SURFACE = 0.3
"""Neighbouring ranges that differ by less are interpolated between [m]."""
_NOT_METRES = 100.0
"""No building has half of its walls farther from a laser than this [m]."""
_USABLE, _MOSTLY = 20.0, 0.5
"""Ranges beyond the first [m] are not used for mapping; where so large a share is, something is odd."""
_FARTHEST = 1e5
"""Larger numbers are no ranges in any unit."""
_MAX_BEAMS = 20_000


@dataclass(frozen=True)
class BeamLayout:
    """How a scan's beams lie: ``count`` of them from ``start`` on, ``step`` apart, counter-clockwise [rad]."""

    count: int
    start: float
    step: float

    def __str__(self) -> str:
        return f"{self.count} beams {math.degrees(self.step):.4g}° apart"

    @property
    def angles(self) -> NDArray[np.float64]:
        """(count,) directions [rad]."""
        return np.asarray(self.start + self.step * np.arange(self.count), np.float64)

    def like(self, other: "BeamLayout") -> bool:
        """Whether both are the same beams, but for rounding."""
        same = self.count == other.count and abs(self.start - other.start) < 1e-3
        return same and abs(self.step - other.step) * self.count < 1e-2


@dataclass(frozen=True)
class Beams:
    """Ranges (S, B) [m] on one set of angles (B,) [rad], and from where on they are no returns [m]."""

    ranges: NDArray[np.float32]
    angles: NDArray[np.float64]
    max_range: float
    notes: tuple[str, ...]


def bring_together(
    scans: Sequence[NDArray[np.float64]],
    layouts: Sequence[BeamLayout],
    longest: float,
    options: LogOptions,
    name: str,
) -> Beams:
    """Make one array of scans whose beams may change from scan to scan.

    Most scans' layout is kept as it is and continued to the widest field of view that occurs; of other scans each beam
    takes what was measured in its direction, interpolated along surfaces.

    Args:
        scans: Ranges as they were stored.
        layouts: Of each scan.
        longest: Range from which on the file says there are no returns [m]; infinite if it does not say.
        options: The user's.
        name: What messages call the log.

    Raises:
        LogError: The ranges are in no metres, or no scan has any return.
    """
    unit = RANGE_UNITS[options.range_unit]
    kinds = Counter(layouts)
    main = max(kinds, key=lambda kind: kinds[kind])
    aim = main if all(kind.like(main) for kind in kinds) else _widened(main, list(kinds))
    together = np.zeros((len(scans), aim.count), np.float32)
    limit = _limit(scans, longest, options, unit, name)
    for row, scan, layout in zip(together, scans, layouts, strict=True):
        sorted_out = _sorted_out(scan * unit, limit, options.max_range is not None)
        row[:] = sorted_out if layout.like(aim) else _resampled(sorted_out, layout, aim, limit)
    if not np.any((together > 0.0) & (together < limit)):
        raise LogError(f"{name} has no scan with a single return below {limit:g} m; nothing can be mapped")
    notes = [] if aim is main else [_told(kinds, aim)]
    measured = together[(together > 0.0) & (together < limit)]
    far = float(np.mean(measured > _USABLE))
    if far > _MOSTLY:
        notes.append(
            f"{far:.0%} of the returns are farther away than {_USABLE:g} m, more than is used for mapping; if the "
            "ranges are in no metres, say so (--range-unit)"
        )
    return Beams(together, aim.angles, limit, tuple(notes))


def _told(kinds: Counter[BeamLayout], aim: BeamLayout) -> str:
    several = ", ".join(f"{count:,} scans of {kind}" for kind, count in kinds.most_common(3))
    return f"the beams change: {several}; all were brought onto {aim}"


def _widened(main: BeamLayout, kinds: list[BeamLayout]) -> BeamLayout:
    """``main``'s beams continued over all directions in which some scan has beams."""
    low = min(kind.start for kind in kinds)
    high = max(kind.start + kind.step * (kind.count - 1) for kind in kinds)
    high = min(high, low + 2.0 * math.pi - main.step)
    before = max(math.floor((main.start - low) / main.step + 1e-2), 0)
    after = max(math.floor((high - main.start) / main.step + 1e-2), main.count - 1)
    return BeamLayout(min(before + after + 1, _MAX_BEAMS), main.start - before * main.step, main.step)


def _limit(scans: Sequence[NDArray[np.float64]], longest: float, options: LogOptions, unit: float, name: str) -> float:
    """Range from which on there are no returns [m], after a look at the unit."""
    every = np.concatenate(scans) * unit
    finite = every[(every > 0.0) & (every < _FARTHEST)]
    if len(finite) and np.median(finite) > _NOT_METRES:
        median = float(np.median(finite))
        guess = "cm" if median < 1500.0 else "mm"
        raise LogError(
            f"{name} has ranges with a median of {median:.4g}, which are no metres in any building; "
            f"if they are {guess}, say so (--range-unit {guess})"
        )
    if options.max_range is not None:
        return options.max_range
    if longest < _FARTHEST:
        return longest
    return max(float(np.float32(finite.max())), 1.0) if len(finite) else 1.0


def _sorted_out(ranges: NDArray[np.float64], limit: float, told: bool) -> NDArray[np.float32]:
    """Ranges (n,) in which no return is ``limit`` and no measurement is 0.

    Args:
        ranges: As they were stored [m]; infinite, NaN or negative too.
        limit: See ``Beams``.
        told: Whether the user told the limit, so that ranges just below it are believed.
    """
    nothing = ranges >= limit * (1.0 if told else _NEAR_MAXIMUM)
    for code in SICK_CODES:
        nothing |= np.abs(ranges - code) < _CODE_WIDTH
    measured = np.where(ranges > 0.0, ranges, 0.0)  # of NaN, too
    return np.where(nothing, limit, measured).astype(np.float32)


def _resampled(ranges: NDArray[np.float32], layout: BeamLayout, aim: BeamLayout, limit: float) -> NDArray[np.float32]:
    """Ranges of one scan in the directions of other beams; 0 where it has none."""
    places = (aim.angles - layout.start) / layout.step
    places = np.where(places < -0.5, places + 2.0 * math.pi / layout.step, places)
    nearest = np.clip(np.rint(places), 0, layout.count - 1).astype(np.int64)
    within = (places > -0.5 - 1e-6) & (places < layout.count - 0.5 + 1e-6)
    low = np.clip(np.floor(places), 0, max(layout.count - 2, 0)).astype(np.int64)
    high = np.minimum(low + 1, layout.count - 1)
    share = np.clip(places - low, 0.0, 1.0)
    between = (1.0 - share) * ranges[low] + share * ranges[high]
    both = (ranges[low] > 0.0) & (ranges[high] > 0.0) & (ranges[low] < limit) & (ranges[high] < limit)
    smooth = both & (np.abs(ranges[low] - ranges[high]) < _SAME_SURFACE)
    exact = np.abs(places - nearest) < 1e-2
    found = np.where(smooth & ~exact, between, ranges[nearest])
    return np.where(within, found, 0.0).astype(np.float32)
