"""The keywords that every family has, for editors and type checkers."""

from typing import TypedDict

from lidarena.envs.observers import ObservationSpec
from lidarena.envs.rewards import RewardSpec


class CommonKeywords(TypedDict, total=False):
    """What is observed, what it is worth, how long it lasts, what is told and drawn."""

    observation: ObservationSpec
    reward: RewardSpec
    max_episode_steps: int | None
    expose_truth: bool
    render_mode: str | None
