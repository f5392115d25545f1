"""Keywords of teams that may meet floor plan after floor plan, checked at the border."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import check_names, check_range
from lidarena.envs.corridor.options import CorridorKeywords, CorridorOptions, modern_keywords
from lidarena.world.floorplan import Floorplan
from lidarena.world.load import MapSpec, generator_of, load_floorplan
from lidarena.world.plan_generators import draw_plan

FIRST_DRAWN = 2**31
"""Numbers of drawn plans begin here, beyond those that anybody would write in a ``map=``."""


class DrawnKeywords(CorridorKeywords, total=False):
    """The keywords of ``DrawnOptions`` with their types, for editors and type checkers."""

    plans: MapSpec | Sequence[MapSpec] | None
    episodes_per_plan: int


@dataclass(frozen=True)
class DrawnOptions(CorridorOptions):
    """Those of ``CorridorOptions``, and which floor plans a team meets.

    Keywords of ``lidarena/CorridorShared-v0`` and ``lidarena/CorridorCentral-v0``.

    Attributes:
        plans: In place of ``map``: a floor plan or a generator such as ``"random:maze"``, or a list of these. Every
            team draws one of them, and of a generator another plan than anybody's, by its own generator: at a reset
            with a seed, and after every ``episodes_per_plan`` episodes.
        episodes_per_plan: How many episodes a team stays on a plan: to lay one out takes as long as driving on it for
            some seconds.
    """

    plans: MapSpec | Sequence[MapSpec] | None = None
    episodes_per_plan: int = 4

    @classmethod
    def checked(cls, keywords: Mapping[str, Any]) -> "DrawnOptions":
        """Check keywords and fill in the defaults.

        Raises:
            ConfigError: An unknown keyword, or a value out of range or of the wrong type.
            MapError: A plan that there is not.
        """
        keywords = modern_keywords(keywords)
        check_names("a corridor environment", keywords, [field.name for field in fields(cls)])
        given = {name: value for name, value in keywords.items() if name not in ("plans", "episodes_per_plan")}
        plans, episodes = keywords.get("plans"), keywords.get("episodes_per_plan", cls.episodes_per_plan)
        check_range("episodes_per_plan", episodes, 1, 10**9, whole=True)
        if plans is not None and "map" in keywords:
            raise ConfigError("map and plans are both given; plans takes the place of map")
        team = CorridorOptions.checked(given)
        options = cls(**_fields_of(team), plans=plans, episodes_per_plan=episodes)
        for _ in options.of_plans():  # so that a plan that there is not is refused here
            pass
        return options

    @property
    def specs(self) -> list[MapSpec]:
        """The plans and generators to draw from; () where all teams are on ``map``."""
        if self.plans is None:
            return []
        one = isinstance(self.plans, str) or not isinstance(self.plans, Sequence)
        return [self.plans] if one else list(self.plans)  # type: ignore[list-item, arg-type]

    def of_plans(self) -> Iterator[Floorplan]:
        """The first plan of each entry.

        Raises:
            ConfigError: There is none.
            MapError: One that there is not.
        """
        if self.plans is not None and not self.specs:
            raise ConfigError(f"plans = {self.plans!r} must be a floor plan, a generator, or a list of them")
        for spec in self.specs:
            yield load_floorplan(spec)

    def team_on(self, number: int) -> CorridorOptions:
        """The keywords of a team on the plan of a number from ``draw``."""
        spec = self.specs[number % len(self.specs)]
        generator = generator_of(spec)
        plan = load_floorplan(spec) if generator is None else draw_plan(generator, number)
        return replace(CorridorOptions(**_fields_of(self)), map=plan)

    @staticmethod
    def draw(rng: np.random.Generator) -> int:
        """Number of another plan."""
        return FIRST_DRAWN + int(rng.integers(FIRST_DRAWN))


def _fields_of(options: CorridorOptions) -> dict[str, Any]:
    return {field.name: getattr(options, field.name) for field in fields(CorridorOptions)}
