"""Keywords of the seabed are checked at the border."""

from typing import Any

import pytest

from lidarena.base.errors import ConfigError
from lidarena.envs.seabed.options import SeabedOptions


def test_a_scene_may_be_changed() -> None:
    options = SeabedOptions.checked({"scene": "scene2", "clearance": (2, 8), "speed": 1.0, "compass_noise": 0.5})
    (kind,) = options.kinds
    assert kind.clearance == (2.0, 8.0) and kind.duration == 134.0 and kind.speed == 1.0
    assert options.odometry.angle_sigma == pytest.approx(0.0087266, rel=1e-4)
    assert SeabedOptions.checked({"resolution": "800x600"}).camera.width == 800
    assert SeabedOptions.checked({"max_episode_steps": None}).max_episode_steps == 5000


def test_both_scenes_may_be_flown_over() -> None:
    kinds = SeabedOptions.checked({"scene": "both", "duration": 4.0}).kinds
    assert [kind.clearance for kind in kinds] == [(3.5, 7.0), (1.0, 10.0)] and {kind.duration for kind in kinds} == {
        4.0
    }


@pytest.mark.parametrize(
    ("keywords", "words"),
    [
        ({"scen": "scene1"}, "did you mean 'scene'"),
        ({"scene": "scene3"}, "scene = 'scene3' is not known"),
        ({"resolution": "640x480"}, "resolution = '640x480'"),
        ({"clearance": 3.0}, "must be two numbers"),
        ({"clearance": (0.1, 3.0)}, r"clearance\[0\] = 0.1"),
        ({"clearance": (4.0, 3.0)}, r"clearance\[1\] = 3.0"),
        ({"skips": 5}, "must be a list of whole numbers"),
        ({"skips": [5, 3]}, "must rise"),
        ({"skips": []}, "must be a list"),
        ({"overlaps": 0.7}, "must be a list of shares"),
        ({"overlaps": [0.7, 1.5]}, r"overlaps\[1\] = 1.5"),
        ({"angles": "fused"}, "angles = 'fused'"),
        ({"compass_noise": 0.0}, "compass_noise = 0.0"),
        ({"count": 5}, "count = 5"),
        ({"reward": {"drfit": 1.0}}, "did you mean 'drift'"),
        ({"observation": "all"}, "observation = 'all'"),
        ({"duration": 0.5}, "duration = 0.5"),
    ],
)
def test_what_cannot_be_is_refused(keywords: dict[str, Any], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        SeabedOptions.checked(keywords)
