"""Keywords of a seabed whose flights are short and whose pictures hold few features, for quick tests."""

from typing import Any

SEABED: dict[str, Any] = {
    "duration": 2.0,
    "seabeds": 1,
    "count": 100,
    "least_matches": 20,
    "skips": [6, 12, 25],
    "max_episode_steps": 5,
}
