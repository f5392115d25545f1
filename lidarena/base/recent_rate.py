"""How fast a long run is at present: the rate of the last minute, not of a beginning that only compiled."""

from collections import deque

WINDOW = 60.0
"""The rate is that of so many seconds …"""
_LEAST_MARKS = 8
"""… or of so many reports, if they took longer."""


class RecentRate:
    """Rate and remaining time of something that is counted now and then.

    Args:
        total: What is counted up to.
        least: Seconds that have to be known before a rate is told.
    """

    def __init__(self, total: float, least: float = 0.0) -> None:
        self.total, self.least = total, least
        self._marks: deque[tuple[float, float]] = deque()

    def note(self, count: float, now: float) -> None:
        """Take down how far it is.

        Args:
            count: Of what is done by now.
            now: Time of a clock [s].
        """
        marks = self._marks
        marks.append((now, count))
        while len(marks) > _LEAST_MARKS and now - marks[1][0] >= WINDOW:
            marks.popleft()

    @property
    def rate(self) -> float | None:
        """Per second; None where too little is known."""
        if len(self._marks) < 2:
            return None
        (begin, first), (now, last) = self._marks[0], self._marks[-1]
        if now - begin <= self.least or last <= first:
            return None
        return (last - first) / (now - begin)

    @property
    def left(self) -> float | None:
        """Seconds that are left at this rate; None where it is not known."""
        rate = self.rate
        return None if rate is None else max(self.total - self._marks[-1][1], 0.0) / rate


def clock(seconds: float | None) -> str:
    """Write a time as ``1:05`` or ``2:01:05``; ``?`` where it is not known."""
    if seconds is None:
        return "?"
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
