"""Names like "module:callable"."""

import math

import pytest

from lidarena.base.errors import ConfigError
from lidarena.base.import_names import import_for, import_named


def test_a_name_in_a_module_is_found() -> None:
    assert import_named("math:hypot", "reward 'math:hypot'") is math.hypot
    assert import_for("math", "reward") is math


@pytest.mark.parametrize(
    ("name", "told"),
    [
        ("mathh:hypot", "there is no module 'mathh'"),
        ("math:hypott", "'math' has no 'hypott'; did you mean 'hypot'?"),
        ("math.deep:hypot", "there is no module 'math.deep'"),
        (":hypot", "'' is no name of a module"),
        (".near:hypot", "'.near' is no name of a module"),
    ],
)
def test_what_cannot_be_found_is_told_with_who_wanted_it(name: str, told: str) -> None:
    with pytest.raises(ConfigError) as refused:
        import_named(name, f"reward {name!r}")
    assert str(refused.value).startswith(f"reward {name!r}: ") and told in str(refused.value)
