"""What the keywords of every family promise."""

from dataclasses import fields
from typing import Any

import pytest

from lidarena.base.errors import LidarenaError

WRONG: list[tuple[dict[str, Any], str]] = [
    ({"actions": "discrete"}, "did you mean 'action'"),
    ({"action": "discret"}, "did you mean 'discrete'"),
    ({"decision_period": 999.0}, "decision_period = 999.0"),
    ({"max_episode_steps": 0}, "or -1 for never"),
    ({"render_mode": "rgb"}, "render_mode = 'rgb' is not known.* Allowed: .*rgb_array"),
    ({"lidar": {"beems": 3}}, "did you mean 'beams'"),
    ({"expose_truth": "yes"}, "must be true or false"),
]
"""Keywords that are wrong in every family, and what is said."""


def check_editors_see_every_keyword(options: Any, keywords: Any) -> None:
    """The typed dictionary that editors complete from has the fields of the options."""
    assert sorted(field.name for field in fields(options)) == sorted(keywords.__annotations__)


def check_defaults(options: Any, steps: int) -> None:
    """Without keywords everything is as declared, and a step limit of None is the usual one."""
    checked, plain = options.checked({"max_episode_steps": None}), options()
    assert checked.max_episode_steps == steps
    for field in fields(options):
        assert getattr(checked, field.name) == getattr(plain, field.name), field.name


def check_a_changed_robot(options: Any) -> None:
    """Changing one number of the robot leaves the others."""
    changed, plain = (options.checked(keywords).robot for keywords in ({"robot": {"max_speed": 0.3}}, {}))
    assert changed.max_speed == 0.3 and changed.radius == plain.radius and changed.substep == plain.substep


def check_refused(options: Any, keywords: dict[str, Any], says: str) -> None:
    """What is wrong is told in one sentence."""
    with pytest.raises(LidarenaError, match=says) as refusal:
        options.checked(keywords)
    assert "\n" not in str(refusal.value)


def check_all(options: Any, keywords: Any, steps: int, wrong: list[tuple[dict[str, Any], str]]) -> None:
    """All of the above, for the keywords that are wrong in every family and for those that are in this one."""
    check_editors_see_every_keyword(options, keywords)
    check_defaults(options, steps)
    check_a_changed_robot(options)
    for given, says in WRONG + wrong:
        check_refused(options, given, says)
