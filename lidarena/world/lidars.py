"""Lidars by name, and the check of those that users describe."""

import math
from typing import Any

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import check_range
from lidarena.world.lidar import FULL_CIRCLE, LidarSpec
from lidarena.world.spec_reading import read_spec

LIDARS: dict[str, dict[str, float]] = {
    "lds_01": {"beams": 360, "min_range": 0.12, "max_range": 3.5, "noise": 0.01, "field_of_view": FULL_CIRCLE},
    "rplidar_a1": {"beams": 360, "min_range": 0.15, "max_range": 12.0, "noise": 0.01, "field_of_view": FULL_CIRCLE},
    "hokuyo_urg_04lx": {
        "beams": 683, "min_range": 0.06, "max_range": 4.095, "noise": 0.01, "field_of_view": math.radians(240.0),
    },
    "hokuyo_ust_10lx": {
        "beams": 1081, "min_range": 0.06, "max_range": 10.0, "noise": 0.01, "field_of_view": math.radians(270.0),
    },
    "hokuyo_utm_30lx": {
        "beams": 1081, "min_range": 0.1, "max_range": 30.0, "noise": 0.01, "field_of_view": math.radians(270.0),
    },
    "sick_lms111": {
        "beams": 541, "min_range": 0.5, "max_range": 20.0, "noise": 0.012, "field_of_view": math.radians(270.0),
    },
    "sick_lms200": {
        "beams": 181, "min_range": 0.0, "max_range": 8.0, "noise": 0.005, "field_of_view": math.radians(180.0),
    },
}  # fmt: skip
"""Lidars by their makers' names: TurtleBot3's LDS-01, RPLIDAR's, Hokuyo's and SICK's, from their data sheets.

All scan once a decision period unless a ``rate`` is given, which none of these devices is too slow for at 5 Hz.
"""

_RANGES = {"max_range": (0.01, 1000.0), "min_range": (0.0, 1000.0), "noise": (0.0, 10.0)}


def make_lidar(value: Any, default: LidarSpec, period: float) -> LidarSpec:
    """Make what the keyword ``lidar`` says.

    Args:
        value: See :func:`lidarena.world.spec_reading.read_spec`.
        default: What changes are made to.
        period: Of the decisions [s].

    Raises:
        ConfigError: A value that cannot be, see :func:`check_lidar`.
    """
    found = read_spec("lidar", value, LidarSpec, LidarSpec._fields, LIDARS)
    spec = found if isinstance(found, LidarSpec) else default._replace(**found)
    spec = spec._replace(rate=math.inf) if spec.rate is None else spec
    check_lidar(spec, period)
    return LidarSpec(int(spec.beams), *(float(number) for number in spec[1:]))


def gives_range(value: Any) -> bool:
    """Whether what the keyword ``lidar`` says, see ``make_lidar``, tells how far the lidar sees."""
    found = read_spec("lidar", value, LidarSpec, LidarSpec._fields, LIDARS)
    return isinstance(found, LidarSpec) or "max_range" in found


def check_lidar(spec: LidarSpec, period: float) -> None:
    """Refuse a lidar that cannot be, or that scans more often than there are decisions.

    Args:
        spec: The lidar.
        period: Of the decisions [s].

    Raises:
        ConfigError: It names the value and what is allowed.
    """
    check_range("lidar.beams", spec.beams, 4, 3600, whole=True)
    for name, (low, high) in _RANGES.items():
        check_range(f"lidar.{name}", getattr(spec, name), low, high)
    if spec.min_range >= spec.max_range:
        raise ConfigError(f"lidar.min_range = {spec.min_range} must be less than lidar.max_range = {spec.max_range}")
    if not _is_number(spec.field_of_view) or not 0.0 < spec.field_of_view <= FULL_CIRCLE:
        raise ConfigError(
            f"lidar.field_of_view = {spec.field_of_view!r} is out of range; an angle up to 2 pi in radians is allowed, "
            "and a full circle where it is left out"
        )
    if not _is_number(spec.rate) or not spec.rate > 0.0:
        raise ConfigError(f"lidar.rate = {spec.rate!r} must be a number of scans per second above 0")
    if math.isfinite(spec.rate) and spec.rate * period > 1.0 + 1e-9:
        raise ConfigError(
            f"lidar.rate = {spec.rate} Hz is more than one scan in a decision period of {period} s; at most "
            f"{1.0 / period:g} Hz is allowed, and one scan a decision where it is left out"
        )


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool)
