"""Keeping account of goals: which one is pursued, since when it comes no nearer, which ones are given up."""

import math
from dataclasses import dataclass, field

from lidarena.planning.driving.goals import PARDONS, REGROWN

Goal = tuple[float, float]

SAME_GOAL = 0.25
"""Goals nearer to each other than this, in x and in y, are one (m): explore_lite's five cells."""
_PROGRESS = 0.05  # what counts as having come nearer (m)


def is_same(goal: Goal, other: Goal) -> bool:
    """Return whether two goals are one."""
    return abs(goal[0] - other[0]) < SAME_GOAL and abs(goal[1] - other[1]) < SAME_GOAL


@dataclass
class GoalBlacklist:
    """The account of one episode; steps are counted by the policy.

    Attributes:
        timeout: A goal that comes no nearer for so many steps is given up (explore_lite's ``progress_timeout``).
        patience: A goal is given up so many steps after arrival, if it is still wanted then.
        tries: A goal for which no commands are found at so many planning instants is given up.
        pursued: The goal that is being driven to.
        given_up: Goals that are not tried again.
    """

    timeout: int
    patience: int
    tries: int = 3
    pursued: Goal | None = None
    given_up: list[Goal] = field(default_factory=list)
    arrived_at: int | None = None
    _progress_at: int = 0
    _shortest: float = math.inf
    _failures: list[Goal] = field(default_factory=list)
    _from_afar: list[bool] = field(default_factory=list)  # which of ``given_up`` were given up far from them
    _pardons: int = 0
    _pardoned: int = 0
    _retreats: int = 0
    _retreated: int = 0

    def is_given_up(self, goal: Goal) -> bool:
        """Return whether a goal has been given up."""
        return any(is_same(goal, other) for other in self.given_up)

    def pursue(self, goal: Goal, step: int) -> None:
        """Note that a goal is being driven to; one that is the same as before keeps its account."""
        if self.pursued is None or not is_same(goal, self.pursued):
            self.pursued, self.arrived_at = goal, None
            self._progress_at, self._shortest = step, math.inf

    def watch(self, remaining: float, arrived: bool, step: int) -> None:
        """Note how the pursued goal comes nearer, and give it up if it does not, or was reached without effect.

        Args:
            remaining: Length of the path that remains (m).
            arrived: Whether the robot is there.
            step: Now.
        """
        if self.pursued is None:
            return
        if remaining < self._shortest - _PROGRESS:
            self._shortest, self._progress_at = remaining, step
        if arrived and self.arrived_at is None:
            self.arrived_at = step
        in_vain = self.arrived_at is not None and step - self.arrived_at >= self.patience
        if in_vain or step - self._progress_at >= self.timeout:
            self._give_up(self.pursued, from_afar=False)

    def _give_up(self, goal: Goal, from_afar: bool) -> None:
        self.given_up.append(goal)
        self._from_afar.append(from_afar)

    def fail(self, goal: Goal, for_good: bool = False) -> bool:
        """Note that no commands were found for a goal.

        Args:
            goal: Which.
            for_good: Whether trying again makes no sense.

        Returns:
            Whether it is given up now.
        """
        self._failures.append(goal)
        if for_good or sum(is_same(goal, other) for other in self._failures) >= self.tries:
            self._give_up(goal, from_afar=not for_good)
            return True
        return False

    def pardon(self, known: int) -> bool:
        """Let goals be tried again that were given up from afar, see ``driving.goals.pardon``; whether there are any.

        Args:
            known: Cells of the map that are known.
        """
        if known > REGROWN * self._pardoned:
            self._pardons = 0
        if self._pardons >= PARDONS or not any(self._from_afar):
            return False
        self.given_up = [goal for goal, afar in zip(self.given_up, self._from_afar, strict=True) if not afar]
        self._from_afar, self._failures = [False] * len(self.given_up), []
        self._pardons, self._pardoned = self._pardons + 1, known
        return True

    def may_retreat(self, known: int) -> bool:
        """Return whether the robot may still go back to where it came from, see ``driving.goals.may_retreat``.

        Args:
            known: Cells of the map that are known.
        """
        return self._retreats < PARDONS or known > REGROWN * self._retreated

    def note_retreat(self, known: int) -> None:
        """Note that it goes back, and give up the goal that it pursued.

        Args:
            known: Cells of the map that are known.
        """
        if known > REGROWN * self._retreated:
            self._retreats = 0
        self._retreats, self._retreated = self._retreats + 1, known
        if self.pursued is not None:
            self._give_up(self.pursued, from_afar=False)
