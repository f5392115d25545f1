"""Furniture."""

import numpy as np

from lidarena.world.random_plans.furniture import random_furnished


def test_clutter_is_how_much_stands_there() -> None:
    things = []
    for clutter in (0.0, 0.3, 1.0):
        plans = [random_furnished(np.random.default_rng(k), {"area": 100.0, "clutter": clutter}, "x") for k in range(6)]
        things.append(sum(len(plan.circles) for plan in plans))
    assert things[0] == 0 < things[1] < things[2]


def test_nothing_stands_at_the_start() -> None:
    for seed in range(30):
        plan = random_furnished(np.random.default_rng(seed), {"clutter": 1.0}, "x")
        assert plan.clearance(np.array([plan.start[:2]]))[0] > 0.2
