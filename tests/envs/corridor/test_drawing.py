import numpy as np
import pytest
from gymnasium.error import ResetNeeded

from lidarena.envs.corridor.drawing import draw_world
from lidarena.envs.corridor.episodes import CorridorEpisodes
from lidarena.envs.corridor.options import CorridorOptions


def episodes(render_mode: str | None, begin: bool = True) -> CorridorEpisodes:
    made = CorridorEpisodes(2, CorridorOptions.checked({"robots": 2, "render_mode": render_mode}))
    if begin:
        made.reset(range(2), [np.random.default_rng(k) for k in range(2)])
    return made


def test_each_world_has_a_picture_of_its_own() -> None:
    made = episodes("rgb_array")
    one, other = draw_world(made, 0), draw_world(made, 1)
    assert one is not None and other is not None
    assert one.dtype == np.uint8 and one.shape == other.shape and (one != other).any()


def test_without_a_render_mode_nothing_is_drawn() -> None:
    assert draw_world(episodes(None), 0) is None


def test_nothing_can_be_drawn_before_an_episode() -> None:
    with pytest.raises(ResetNeeded):
        draw_world(episodes("rgb_array", begin=False), 0)
