"""A position every so many frames, whatever the ground: what Bobkov et al. compare with."""

from typing import Any

from lidarena.base.keyword_checks import check_choice, check_range
from lidarena.baselines.registry import register
from lidarena.envs.seabed.actions import action_of, skips_to_choose
from lidarena.envs.seabed.options import MODES


@register("fixed_step", family="seabed")
class FixedStep:
    """Skips always the same number of frames, or the next smaller one that the environment offers."""

    def __init__(self, env: Any, *, frames: int = 4, mode: str = MODES[0]) -> None:
        """Make it for a seabed environment.

        Args:
            env: The environment.
            frames: That are skipped; Bobkov et al. do not print theirs.
            mode: ``"plain"``, ``"six_clouds"`` or ``"six_clouds_to_middle"``.

        Raises:
            ConfigError: An option out of range, or an environment whose actions are overlaps.
        """
        check_range("frames", frames, 1, 10_000, whole=True)
        check_choice("mode", mode, MODES)
        self._skips, self._frames, self._mode = skips_to_choose(env), frames, mode
        self.reset()

    def reset(self, seed: int | None = None) -> None:
        """Begin a new flight; nothing here is random."""
        self._now = self._frames

    def act(self, observation: Any, info: dict[str, Any]) -> Any:
        """Return the next action: half as far after each refusal, as there is no other way on."""
        self._now = max(1, int(info["skip"]) // 2) if info["refused"] else self._frames
        return action_of(self._skips, self._now, self._mode)
