"""The adaptive step of Bobkov et al., by itself and with the 6-cloud fit."""

from typing import Any

from lidarena.base.errors import ConfigError
from lidarena.base.keyword_checks import check_choice, check_range
from lidarena.baselines.registry import register
from lidarena.envs.seabed.actions import action_of, skips_to_choose
from lidarena.envs.seabed.options import MODES
from lidarena.envs.seabed.scenes import RATE
from lidarena.vision.step_size import adaptive_step


@register("adaptive_step", family="seabed")
class AdaptiveStep:
    """The longest step that keeps the overlap; half of it after a refusal, and doubled again up to it."""

    mode = MODES[0]

    def __init__(self, env: Any, *, overlap: float = 0.75, threshold: int = 60) -> None:
        """Make it for a seabed environment.

        Args:
            env: The environment.
            overlap: Share of the view that two positions have in common; Bobkov et al. have 0.5 and 0.75.
            threshold: Matches below which the step is halved, 30 to 100 in Bobkov et al.

        Raises:
            ConfigError: An option out of range, or an environment whose actions are overlaps.
        """
        check_range("overlap", overlap, 0.1, 0.99)
        check_range("threshold", threshold, 6, 5000, whole=True)
        if threshold < env.unwrapped.options.least_matches:
            raise ConfigError(
                f"threshold = {threshold!r} is below the environment's least_matches, "
                f"{env.unwrapped.options.least_matches}, under which a step is refused anyway"
            )
        self._skips = skips_to_choose(env)
        self._options, self._overlap, self._threshold = env.unwrapped.options, overlap, threshold
        self.reset()

    def reset(self, seed: int | None = None) -> None:
        """Begin a new flight; nothing here is random."""
        self._now: float | None = None

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action.

        Args:
            observation: Not read.
            info: The environment's; ``height``, ``speed``, ``refused``, ``skip`` and ``matches`` are used.
        """
        most = self.most(float(info["height"]), float(info["speed"]))
        if info["refused"] or (self._now is not None and int(info["matches"]) < self._threshold):
            self._now = max(1, int(info["skip"]) // 2)
        elif self._now is None:
            self._now = most
        else:
            self._now = min(2 * self._now, most)
        return action_of(self._skips, min(self._now, most), self.mode)

    def most(self, height: float, speed: float) -> int:
        """The longest step that keeps the overlap [frames]."""
        return adaptive_step(self._options.camera, max(height, 0.1), max(speed, 0.02), RATE, self._overlap)


@register("adaptive_6cloud", family="seabed")
class AdaptiveSixClouds(AdaptiveStep):
    """The adaptive step with the 6-cloud fit."""

    def __init__(self, env: Any, *, overlap: float = 0.75, threshold: int = 60, way: int = 1) -> None:
        """Make it for a seabed environment.

        Args:
            env: The environment.
            overlap: See ``AdaptiveStep``.
            threshold: See ``AdaptiveStep``.
            way: 1 goes on from the position in the middle (more accurate, slower), 2 from the one beyond.

        Raises:
            ConfigError: An option out of range, or an environment whose actions are overlaps.
        """
        check_choice("way", str(way), ("1", "2"))
        self.mode = MODES[2] if int(way) == 1 else MODES[1]
        super().__init__(env, overlap=overlap, threshold=threshold)
