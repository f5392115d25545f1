"""How long a search may go on."""

import math
import time


class Budget:
    """Wall-clock time and a number of iterations, whichever ends first.

    Args:
        seconds: Time from now on; infinity allowed.
        iterations: How often ``take`` may succeed; None = any number. With it and infinite time a search gives the same
            result on every machine.
    """

    def __init__(self, seconds: float, iterations: int | None = None) -> None:
        self._end = time.perf_counter() + seconds
        self._whole: Budget | None = None
        self._granted = iterations
        self._iterations = math.inf if iterations is None else iterations

    def take(self) -> bool:
        """Use one iteration; False when none or no time is left."""
        if self._iterations <= 0 or self.spent():
            return False
        self._iterations -= 1
        return self._whole is None or self._whole.take()

    def part(self, share: float, iterations: int | None = None) -> "Budget":
        """A share of the time that is left; its iterations are taken from this budget as well."""
        part = Budget(share * self.left(), iterations)
        part._whole = self
        return part

    def again(self) -> "Budget":
        """A budget with all the iterations that this one had at first, and the time that is left."""
        return Budget(self.left(), self._granted)

    def left(self) -> float:
        """Seconds left, not negative."""
        return max(self._end - time.perf_counter(), 0.0)

    def spent(self) -> bool:
        """Whether the time is over."""
        return time.perf_counter() >= self._end
