"""The answer: who is best, by how much, how sure, and when nothing can be said."""

import numpy as np
import pytest

from lidarena.evaluation.report.answer import answers, headline
from lidarena.evaluation.results import Row
from tests.evaluation.rows import row_of

NOISE = np.linspace(-0.02, 0.02, 10)


def explorer(
    policy: str, explored: float, path: float, env: str = "Env-1", crashes: int = 0, episodes: int = 10
) -> Row:
    spread = NOISE[:episodes]
    values = {
        "collision": [float(k < crashes) for k in range(episodes)],
        "completeness": (explored + 0.1 * spread).tolist(),
        "path_length": (path * (1 + spread)).tolist(),
    }
    return row_of(policy, env, **values)


def test_the_shorter_path_decides_where_all_else_is_level() -> None:
    (found,) = answers([explorer("long", 0.99, 30.0), explorer("short", 0.99, 20.0)])
    assert found.leaders == ("short",)
    assert found.sentence.startswith("short is best: path 20.00 m [")
    assert "-10.0" in found.sentence.replace("−", "-") and "m against long" in found.sentence
    assert "95% interval" in found.sentence and "10 episodes on the same seeds" in found.sentence


def test_who_crashes_early_is_not_the_best_by_its_short_path() -> None:
    rows = [explorer("careful", 0.99, 30.0), explorer("wild", 0.40, 3.0, crashes=10)]
    (found,) = answers(rows)
    assert found.leaders == ("careful",) and "explored" in found.sentence
    assert "points against wild" in found.sentence
    assert headline([found], rows) == "careful is best in the environment."


def test_policies_that_are_level_share_the_lead_and_who_fell_behind_is_named() -> None:
    rows = [explorer("a", 0.99, 30.0), explorer("b", 0.99, 30.0), explorer("c", 0.5, 30.0)]
    (found,) = answers(rows)
    assert found.leaders == ("a", "b")
    assert found.sentence.startswith("a and b cannot be told apart in 10 episodes")
    assert "c falls behind in explored" in found.sentence


def test_the_headline_counts_environments() -> None:
    rows = [explorer("a", 0.99, 20.0), explorer("b", 0.99, 30.0)]
    rows += [explorer("a", 0.99, 20.0, "Env-2"), explorer("b", 0.99, 20.0, "Env-2")]
    assert headline(answers(rows), rows) == (
        "a is best in 1 of 2 environments and cannot be told from the best in the others."
    )
    both = [*rows[:2], explorer("a", 0.99, 20.0, "Env-2"), explorer("b", 0.99, 30.0, "Env-2")]
    assert headline(answers(both), both) == "a is best in all 2 environments."
    mixed = [*rows[:2], explorer("a", 0.99, 30.0, "Env-2"), explorer("b", 0.99, 20.0, "Env-2")]
    assert headline(answers(mixed), mixed).startswith("No policy is best everywhere; of 2 environments, ")


@pytest.mark.parametrize("episodes", [1, 4])
def test_too_few_episodes_tell_nothing(episodes: int) -> None:
    rows = [explorer("a", 0.99, 20.0, episodes=episodes), explorer("b", 0.5, 30.0, episodes=episodes)]
    assert headline(answers(rows), rows).startswith("Too few episodes to tell policies apart")
    assert "too few to tell" in answers(rows)[0].sentence


def test_one_policy_or_none() -> None:
    rows = [explorer("a", 0.99, 20.0)]
    assert headline(answers(rows), rows) == "Only a was measured, so there is nothing to compare it with."
    assert "explored" in answers(rows)[0].sentence
    assert headline([], []) == "There are no results."
