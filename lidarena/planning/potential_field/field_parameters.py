"""Parameters of the potential field, its two presets, and the bound on k/η (Yang et al., eqs. 11-13)."""

import math
import warnings
from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import Any, ClassVar, Literal, get_args

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import ConfigError, suggest
from lidarena.planning.potential_field.field_descent import Motion
from lidarena.planning.potential_field.field_kernels import BUMP, RECIPROCAL, SHIFTED, Field

Preset = Literal["paper", "robust"]
TrapTest = Literal["equal", "window", "none"]
FillShape = Literal["reciprocal", "shifted", "bump", "none"]

_SHAPES = {"reciprocal": RECIPROCAL, "shifted": SHIFTED, "bump": BUMP, "none": BUMP}
_MOST_WAYS = 3
_CHOICES = {"trap_test": get_args(TrapTest), "fill_shape": get_args(FillShape)}


class FieldWarning(UserWarning):
    """Parameters with which the field has a minimum beside the goal: the bound on k/η, eq. 13, is broken."""


@dataclass(frozen=True)
class FieldParameters:
    """Every number and switch of the planner; the defaults are what Yang et al. print (its preset ``paper``).

    Lengths are metres of Yang et al.'s 100 m room; ``fitted`` fits them to another.

    Attributes:
        k: Gain of the attraction (eq. 1).
        eta: Gain of the repulsion (eq. 3). None: such that a single obstacle balances the attraction at 1.4 ``h_0``.
        n: Exponent of the distance to the goal in the repulsion (eq. 8).
        rho_0: Reach of an obstacle.
        d_0: Distance to the goal beyond which the attraction is constant (eq. 7). Not printed; ``rho_0`` is the least
            for which the bound on k/η holds.
        gamma: Length of a step (eq. 14).
        arrival_radius: At this distance the goal is reached (Yang et al.'s D, not printed); at least ``gamma`` / 2.
        max_steps: Step limit (Yang et al.'s N, not printed) of each attempt.
        max_fills: Most fills of an attempt.
        s: Strength of a fill (eq. 15). None: such that a bump is 1.5 times as steep as the attraction.
        rho_1: Reach of a fill.
        h_0: Clearance that a chord of the regression search keeps, and a guarded step.
        seed: Of the noise on a fill's place.
        bounded_attraction: Eq. 7 instead of eq. 1.
        goal_aware: Eq. 8 instead of eq. 3.
        saturate: Let the weight of eq. 8 end at 1, from ``rho_0`` on.
        trap_test: ``"equal"``: X_k = X_{k-2}, as printed; ``"window"``: nearer than γ/2, or less than 5 γ of net motion
            in 20 steps; ``"none"``.
        fill_shape: ``"reciprocal"``: eq. 15; ``"shifted"``: less its value at the rim; ``"bump"``: a Gaussian with
            σ = ``rho_1`` / 3; ``"none"``: a trap ends the walk.
        fill_fades: Let fills fade towards the goal, so that it stays the minimum.
        guard: Turn a step aside that would come nearer to an obstacle than ``h_0``.
        regression: Run the regression search.
        repeat_regression: Repeat it, from both ends, while the path gets shorter.
        fit_scale: Multiply all lengths by the scene's longer side over 100 m, or by 10 radii of the robot over 1 m if
            that is less.
        ways: 1 to 3 ways are tried in an attempt, the shortest counts: from the start; from the goal (from its back, a
            trap is none); from the start by the mirror image of the farthest corner, on an obstacle's other side.
        attempts: Walks, at most. Of several, ``rho_0`` and ``h_0`` are halved until no further halving opens gaps
            through which the way is 5% shorter; the next ones have half and twice as much, and so on.
    """

    LENGTHS: ClassVar[tuple[str, ...]] = ("rho_0", "d_0", "gamma", "arrival_radius", "rho_1", "h_0")

    k: float = 1.0
    eta: float | None = 1.0
    n: float = 2.0
    rho_0: float = 8.0
    d_0: float = 8.0
    gamma: float = 0.1
    arrival_radius: float = 0.1
    max_steps: int = 20_000
    max_fills: int = 200
    s: float | None = 0.5
    rho_1: float = 8.0
    h_0: float = 1.5
    seed: int = 0
    bounded_attraction: bool = True
    goal_aware: bool = True
    saturate: bool = False
    trap_test: TrapTest = "equal"
    fill_shape: FillShape = "reciprocal"
    fill_fades: bool = False
    guard: bool = False
    regression: bool = True
    repeat_regression: bool = False
    fit_scale: bool = False
    ways: int = 1
    attempts: int = 1

    def __post_init__(self) -> None:
        """Refuse what has no meaning."""
        for item in fields(self):
            _check_value(item.name, getattr(self, item.name), item.default)
        if self.arrival_radius < self.gamma / 2:
            raise ConfigError(
                f"arrival_radius = {self.arrival_radius} is less than gamma / 2 = {self.gamma / 2}; "
                "steps of gamma could then pass over the goal for ever"
            )

    def fitted(self, scale: float, given: Mapping[str, Any]) -> "FieldParameters":
        """Return the same parameters with every length multiplied by ``scale``, except those that were ``given``."""
        if not self.fit_scale or scale == 1.0:
            return self
        lengths: dict[str, Any] = {name: getattr(self, name) * scale for name in self.LENGTHS if name not in given}
        return replace(self, **lengths)

    def tightened(self, factor: float) -> "FieldParameters":
        """Return the same parameters for gaps narrower by ``factor`` < 1: obstacles and the goal reach less far."""
        if factor == 1.0:
            return self
        h_0, gamma = self.h_0 * factor, min(self.gamma, self.h_0 * factor / 2)
        arrival = max(gamma / 2, min(self.arrival_radius, h_0, gamma))
        rho_0, d_0 = self.rho_0 * factor, self.d_0 * factor
        return replace(self, rho_0=rho_0, d_0=d_0, h_0=h_0, gamma=gamma, arrival_radius=arrival)

    def field(self) -> Field:
        """Return what the kernels need to know of the field."""
        reach = self.rho_0 if self.saturate else math.inf
        return Field(
            k=float(self.k),
            d_0=float(self.d_0) if self.bounded_attraction else math.inf,
            eta=self.repulsion_gain(),
            rho_0=float(self.rho_0),
            n=float(self.n) if self.goal_aware else 0.0,
            cap=float(reach),
            unit=float(self.rho_0) if self.saturate else 1.0,
            fill_shape=_SHAPES[self.fill_shape],
            rho_1=float(self.rho_1),
            fill_cap=float(self.rho_1) if self.fill_fades else 0.0,
        )

    def motion(self) -> Motion:
        """Return what the kernels need to know of the walk."""
        windowed = self.trap_test == "window"
        return Motion(
            gamma=float(self.gamma),
            arrival=float(self.arrival_radius),
            same=0.5 * self.gamma if windowed else (0.0 if self.trap_test == "equal" else -1.0),
            window=20.0 if windowed else 0.0,
            net=5.0 * self.gamma,
            fill=0.0 if self.fill_shape == "none" else self.fill_strength(),
            jitter=float(self.gamma),
            guarded=float(self.guard),
        )

    def repulsion_gain(self) -> float:
        """Return η; see the attribute ``eta``."""
        if self.eta is not None:
            return float(self.eta)
        balance = min(1.4 * self.h_0, 0.5 * self.rho_0)
        return self.k * self.d_0 * balance**2 / (1.0 / balance - 1.0 / self.rho_0)

    def fill_strength(self) -> float:
        """Return s; see the attribute."""
        if self.s is not None:
            return float(self.s)
        return 1.5 * self.k * self.d_0 * self.rho_1 / 3.0 * math.sqrt(math.e)


def _check_value(name: str, value: Any, default: Any) -> None:
    if name in _CHOICES:
        if value not in _CHOICES[name]:
            raise ConfigError(f"{name} = {value!r} is not known{suggest(str(value), _CHOICES[name])}")
    elif isinstance(default, bool):
        if not isinstance(value, bool | np.bool_):
            raise ConfigError(f"{name} = {value!r}; True or False is needed")
    elif isinstance(default, int):
        least, most = 0 if name in ("seed", "max_fills") else 1, _MOST_WAYS if name == "ways" else 2**63 - 1
        if isinstance(value, bool) or not isinstance(value, int | np.integer) or not least <= value <= most:
            allowed = f"from {least} to {most}" if name == "ways" else f"from {least} on"
            raise ConfigError(f"{name} = {value!r}; a whole number {allowed} is needed")
    elif value is None and name in ("eta", "s"):
        return
    elif (
        isinstance(value, bool)
        or not isinstance(value, int | float | np.number)
        or not (value > 0 and math.isfinite(value))
    ):
        raise ConfigError(f"{name} = {value!r}; a finite number above 0 is needed")


PRESETS: dict[str, FieldParameters] = {
    "paper": FieldParameters(),
    "robust": FieldParameters(
        eta=None,
        s=None,
        arrival_radius=0.05,
        saturate=True,
        trap_test="window",
        fill_shape="bump",
        fill_fades=True,
        guard=True,
        repeat_regression=True,
        fit_scale=True,
        ways=3,
        attempts=6,
    ),
    "traditional": FieldParameters(
        bounded_attraction=False, goal_aware=False, trap_test="window", fill_shape="none", regression=False
    ),
}
"""``paper``: as printed, misprints corrected. ``robust``: the choices that were measured to work. ``traditional``:
Khatib's field, which stays where it is trapped."""


def field_parameters(preset: str = "robust", **overrides: Any) -> FieldParameters:
    """Return a preset with some of its parameters replaced.

    Args:
        preset: A key of ``PRESETS``.
        **overrides: Attributes of :class:`FieldParameters`.

    Raises:
        ConfigError: The preset or a parameter is not known, or a value is out of range.
    """
    if not isinstance(preset, str) or preset not in PRESETS:
        raise ConfigError(f"preset {preset!r} is not known{suggest(str(preset), PRESETS)}")
    known = [item.name for item in fields(FieldParameters)]
    for name in overrides:
        if name not in known:
            raise ConfigError(f"the potential field has no parameter {name!r}{suggest(name, known)}")
    return replace(PRESETS[preset], **overrides)


def least_gain_ratio(rho_0: float, r: float) -> float:
    """Return the bound of eq. 13: k/η must be larger, or the field has a minimum beside the goal (n = 2).

    Args:
        rho_0: Reach of an obstacle (m).
        r: Distance from the goal to the nearest obstacle (m); from ``rho_0`` on there is no bound, the result is 0.
    """
    if r >= rho_0:
        return 0.0
    root = math.sqrt(1.0 + 3.0 * rho_0 / r)
    third = 2.0 * r / (27.0 * rho_0**3)
    return (2.0 / (9.0 * rho_0**2) + third) * root - 2.0 / (3.0 * rho_0**2) + third


def largest_gain_ratio(rho_0: float, r: float, n: float) -> float:
    """Return the largest value of eq. 12's right side, which is eq. 13 for any n, searched on the line through both.

    Args:
        rho_0: Reach of an obstacle (m).
        r: Distance from the goal to the nearest obstacle (m).
        n: Exponent of the distance to the goal.
    """
    if r >= rho_0:
        return 0.0
    rho_g = np.linspace(0.0, rho_0 - r, 4001)[1:]
    rho_o = r + rho_g
    q: NDArray[np.float64] = 1.0 / rho_o - 1.0 / rho_0
    return float(np.max(q * rho_g ** (n - 1.0) / rho_o**2 - 0.5 * n * q**2 * rho_g ** (n - 2.0)))


def check_gain_ratio(parameters: FieldParameters, r: float) -> None:
    """Warn if k/η breaks the bound (eq. 13), for the obstacle nearest to the goal.

    Args:
        parameters: The field; only a goal-aware one is bound.
        r: Distance from the goal to the nearest obstacle (m).

    Warns:
        FieldWarning: It names both numbers.
    """
    if not parameters.goal_aware:
        return
    unit = parameters.rho_0 if parameters.saturate else 1.0
    ratio = parameters.k / parameters.repulsion_gain() * unit**parameters.n
    least = (least_gain_ratio if parameters.n == 2.0 else largest_gain_ratio)(
        *(parameters.rho_0, r) if parameters.n == 2.0 else (parameters.rho_0, r, parameters.n)
    )
    if ratio <= least:
        saturated = f" (times rho_0^n, since the weight is saturated: {ratio:.3g})" if parameters.saturate else ""
        warnings.warn(
            f"k/eta = {parameters.k / parameters.repulsion_gain():.3g}{saturated} breaks the bound of eq. 13, which is "
            f"{least:.3g} with an obstacle {r:.3g} m from the goal: there may be a minimum beside the goal",
            FieldWarning,
            stacklevel=3,
        )
