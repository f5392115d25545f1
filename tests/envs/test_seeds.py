"""Seeds of every kind that Gymnasium's users give are taken, all else is refused in one sentence."""

from typing import Any

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.envs.seeds import checked_seed, seeds_of


@pytest.mark.parametrize("seed", [7, np.int32(7), np.uint64(7), np.int64(7)])
def test_a_seed_is_any_whole_number(seed: Any) -> None:
    assert checked_seed(seed) == 7 and type(checked_seed(seed)) is int


@pytest.mark.parametrize("seed", [-1, 1.0, "7", True, np.float64(3), np.array([1]), [1]])
def test_what_is_no_seed_is_refused(seed: Any) -> None:
    with pytest.raises(ConfigError, match=r"^seed = .* must be a whole number of at least 0, or None$"):
        checked_seed(seed)


def test_none_leaves_it_to_chance() -> None:
    assert checked_seed(None) is None and seeds_of(None, 3) == [None, None, None]


@pytest.mark.parametrize(
    "seeds", [[4, 0, 9], (4, 0, 9), range(4, 7), np.array([4, 0, 9]), np.array([4, 0, 9], np.uint8)]
)
def test_one_seed_a_world(seeds: Any) -> None:
    assert seeds_of(seeds, 3) == [int(seed) for seed in seeds]


def test_one_seed_counts_up_and_none_may_stand_among_others() -> None:
    assert seeds_of(np.int64(5), 3) == [5, 6, 7]
    assert seeds_of([1, None, np.int16(2)], 3) == [1, None, 2]


@pytest.mark.parametrize("seeds", [[1, 2], (), np.arange(4)])
def test_there_must_be_one_for_every_world(seeds: Any) -> None:
    with pytest.raises(ConfigError, match=f"{len(seeds)} seeds were given for 3 worlds"):
        seeds_of(seeds, 3)


@pytest.mark.parametrize(
    "seeds", [[1, 2, -3], ["a", 2, 3], np.array([1.0, 2.0, 3.0]), np.zeros((3, 1), int), {1, 2, 3}]
)
def test_no_other_seeds_are_taken(seeds: Any) -> None:
    with pytest.raises(ConfigError, match="must be a whole number"):
        seeds_of(seeds, 3)


@pytest.mark.parametrize("seeds", ["123", {1, 2, 3}, 1.5, np.zeros((1, 3), int)])
def test_what_are_no_seeds_is_refused_and_says_that_there_may_be_several(seeds: Any) -> None:
    with pytest.raises(ConfigError, match=r"^seed = .* or one of them for each of the 3 worlds$"):
        seeds_of(seeds, 3)
