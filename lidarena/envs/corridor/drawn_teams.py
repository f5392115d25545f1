"""One team that meets floor plan after floor plan."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import TeamError
from lidarena.envs.corridor.drawn_options import DrawnOptions
from lidarena.envs.corridor.episodes import CorridorEpisodes

_TRIES = 50
"""So many plans in a row may be too small for the team."""


class DrawnTeam:
    """One team on plans that its own generator draws.

    Args:
        options: Checked keywords with ``plans``.

    Attributes:
        teams: Its episodes on the present plan.
    """

    def __init__(self, options: DrawnOptions) -> None:
        self._options = options
        self._number, self._left = 0, 0
        self.teams = CorridorEpisodes(1, options.team_on(self._number))

    def begin(self, rng: np.random.Generator, anew: bool) -> None:
        """Begin an episode: on another plan if ``anew``, if it is time for one, or if the present one is too small.

        Raises:
            TeamError: No plan has room for the team.
        """
        if anew:
            self._left = 0
        for _ in range(_TRIES):
            try:
                if self._left == 0:
                    self._lay_out(self._options.draw(rng))
                    self._left = self._options.episodes_per_plan
                self.teams.reset([0], [rng])
                self._left -= 1
                return
            except TeamError as error:
                self._left, refusal = 0, error
        raise TeamError(
            f"{_TRIES} plans in a row have no room for {self._options.robots} robots; of the last one: {refusal}"
        )

    def _lay_out(self, number: int) -> None:
        window = self.teams.window
        self.teams, self._number = CorridorEpisodes(1, self._options.team_on(number)), number
        self.teams.window = window

    def arrays(self) -> dict[str, NDArray[Any]]:
        """Everything that later steps depend on, by name, except the generator; each leads with (1,)."""
        return self.teams.arrays() | {"plan": np.array([self._number]), "left": np.array([self._left])}

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of another team with the same options."""
        self._lay_out(int(saved["plan"][0]))
        self._left = int(saved["left"][0])
        self.teams.load_arrays({name: array for name, array in saved.items() if name not in ("plan", "left")})
