import math

import numpy as np

from lidarena.envs.exploration.goal_choice.rewards import GoalChoiceTerms
from lidarena.envs.exploration.options import ExplorationOptions
from lidarena.envs.exploration.state import ExplorationCore


def test_terms_add_up_to_what_was_driven_and_mapped() -> None:
    options = ExplorationOptions.checked({"map": "env1", "slam": "truth"})
    core = ExplorationCore(2, options)
    for world in range(2):
        core.reset_world(world, np.random.default_rng(world))
    terms = GoalChoiceTerms(core)
    terms.begin(0)
    terms.begin(1)
    begun = core.completeness
    sums = dict.fromkeys(("explored", "path", "time", "uncertainty", "collision"), 0.0)
    preference = np.array([1.0, 0.0])
    only = np.array([True, False])
    for _ in range(20):
        core.step(np.array([(0.2, 0.1), (0.2, 0.1)]), only)
        for name, term in terms.weigh(preference, 0.2, only).items():
            assert term[1] == 0.0
            sums[name] += term[0]
    usual = 0.55 * core.floors.areas[0]
    assert math.isclose(sums["explored"], (core.completeness - begun)[0])
    assert math.isclose(sums["path"], -core.sensors.path_length[0] / usual)
    assert math.isclose(sums["time"], -0.03 * 4.0 / usual)
    log_d = math.log(core.d_optimality[0] / 1e-4)
    assert math.isclose(sums["uncertainty"], -2.55 * sums["explored"] * log_d, abs_tol=1e-12)
    assert core.sensors.path_length[1] == 0.0
