"""The adaptive step is Bobkov et al.'s, halves and doubles, and is faster than a fixed one at no larger error."""

from typing import Any

import pytest

from lidarena import baselines
from lidarena.base.errors import ConfigError
from tests.envs.seabed.short_flights import made

FINE = [1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 24, 32, 40, 48, 64]


def info(height: float = 5.0, **more: Any) -> dict[str, Any]:
    return {"height": height, "speed": 0.5, "refused": False, "skip": 0, "matches": 200} | more


def test_it_takes_the_longest_step_that_keeps_the_overlap_then_halves_and_doubles() -> None:
    policy = baselines.make("adaptive_step", made(skips=FINE))
    policy.reset()
    taken = [
        policy.act(None, one).tolist()[0]
        for one in (
            info(), info(skip=48), info(skip=48, refused=True), info(skip=24, refused=True), info(skip=12),
            info(skip=24), info(height=2.5, skip=48), info(skip=24, matches=50),
        )
    ]  # fmt: skip
    assert [FINE[number] for number in taken] == [48, 48, 24, 12, 24, 48, 24, 12]


def test_less_overlap_makes_longer_steps() -> None:
    half, most = (baselines.make("adaptive_step", made(skips=FINE), overlap=share) for share in (0.5, 0.75))
    assert half.most(5.0, 0.5) == 96 and most.most(5.0, 0.5) == 48 and most.most(0.0, 0.0) >= 1


@pytest.mark.parametrize(("way", "mode"), [(1, 2), (2, 1)])
def test_the_6_cloud_fit_has_two_ways(way: int, mode: int) -> None:
    policy = baselines.make("adaptive_6cloud", made(skips=FINE), way=way)
    assert policy.act(None, info()).tolist() == [14, mode]


def test_it_costs_less_than_a_fixed_step_at_no_larger_error() -> None:
    found = {}
    for name in ("adaptive_step", "fixed_step"):
        env = made(expose_truth=True, skips=[4, 8, 16, 24, 32, 40, 48, 64])
        policy = baselines.make(name, env)
        observation, told = env.reset(seed=0)
        while not told["success"]:
            observation, _, _, _, told = env.step(policy.act(observation, told))
        found[name] = told["compute"], told["truth"]["error"]
    assert found["adaptive_step"][0] < 0.35 * found["fixed_step"][0]
    assert found["adaptive_step"][1] < found["fixed_step"][1] + 0.01


@pytest.mark.parametrize(
    ("name", "options", "words"),
    [
        ("adaptive_step", {"overlap": 1.0}, "overlap = 1.0"),
        ("adaptive_step", {"threshold": 10}, "is below the environment's least_matches"),
        ("adaptive_6cloud", {"way": 3}, "way = '3'"),
    ],
)
def test_options_are_checked(name: str, options: dict[str, Any], words: str) -> None:
    with pytest.raises(ConfigError, match=words):
        baselines.make(name, made(), **options)
