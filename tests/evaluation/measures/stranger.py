"""A family of somebody else, with measures and a picture of its own, and a gym.Env of no family."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np

from lidarena.envs.registration import Family, Registration, register_family
from lidarena.evaluation import FamilyMeasures, Measure, ProgressCurve, Recording

HERE = "tests.evaluation.measures.stranger"
DEPTH = Measure("depth", "Depth", "m", stored_unit="m", better="high", main=True)


class Diving(gym.Env[Any, Any]):
    """Action 1 goes a metre down; at six metres there is a wreck."""

    family = "diving"

    def __init__(self, wreck: float = 6.0) -> None:
        self.observation_space, self.action_space = gym.spaces.Box(-100.0, 0.0, (1,)), gym.spaces.Discrete(2)
        self.wreck = wreck

    def reset(self, *, seed: int | None = None, options: dict[str, Any] | None = None) -> tuple[Any, dict[str, Any]]:
        super().reset(seed=seed)
        self.depth = self.deepest = 0.0
        return self._observation(), self._info()

    def step(self, action: int) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        self.depth += float(action)
        return self._observation(), float(action), self.depth >= self.wreck, False, self._info()

    def _observation(self) -> Any:
        return np.array([-self.depth], np.float32)

    def _info(self) -> dict[str, Any]:
        return {"time": self.depth, "place": {"depth": self.depth}, "air": 5.0, "success": self.depth >= self.wreck}


@dataclass(frozen=True)
class DivingPicture:
    """A line downwards."""

    depths: Any

    def bounds(self) -> tuple[float, float, float, float]:
        return 0.0, float(len(self.depths)), -10.0, 0.0

    def draw(self, axes: Any) -> None:
        axes.plot(np.arange(len(self.depths)), -self.depths, label="the dive")


class DivingMeasures(FamilyMeasures):
    """How deep, and how much air is left."""

    columns = (DEPTH, Measure("air", "Air", "l", needs="success"))
    kept = ("place.depth", "time")

    def measure(self, recording: Recording) -> Mapping[str, float]:
        return {"depth": float(recording.series("place.depth").max())}

    def picture(self, recording: Recording) -> DivingPicture:
        return DivingPicture(recording.series("place.depth"))

    def progress(self, recording: Recording) -> ProgressCurve | None:
        return ProgressCurve.of(DEPTH, recording.series("time"), recording.series("place.depth"))

    def describe(self, values: Mapping[str, float]) -> str:
        return f"dived to {values['depth']:.0f} m"


MEASURES = DivingMeasures()


class Loner(Diving):
    """The same, of no family."""

    family = None  # type: ignore[assignment]


def register() -> None:
    """What the stranger's package does when it is imported."""
    entry = Registration(f"{HERE}:Diving", max_episode_steps=40)
    register_family(Family("diving", {"stranger/Diving-v0": entry}, f"{HERE}:MEASURES"))
    if "stranger/Loner-v0" not in gym.registry:
        gym.register("stranger/Loner-v0", f"{HERE}:Loner", max_episode_steps=40)


register()
