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
        self._iterations = math.inf if iterations is None else iterations

    def take(self) -> bool:
        """Use one iteration; False when none or no time is left."""
        if self._iterations <= 0 or self.spent():
            return False
        self._iterations -= 1
        return True

    def left(self) -> float:
        """Seconds left, not negative."""
        return max(self._end - time.perf_counter(), 0.0)

    def spent(self) -> bool:
        """Whether the time is over."""
        return time.perf_counter() >= self._end
