import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.baselines import make, names
from tests.baselines.exploration.fake_exploration import FakeExploration, drawn, explore

RING = drawn(
    "###########",
    "#         #",
    "# ####### #",
    "# ####### #",
    "# ####### #",
    "#         #",
    "###########",
    side=16,
)


BIG_RING = drawn(
    "###############",
    "#             #",
    *["# ########### #"] * 5,
    "#             #",
    "###############",
    side=16,
)


class Drifting(FakeExploration):
    """Its uncertainty grows with the way, and falls again near the start."""

    near_start = 1.5

    def _info(self, collision):
        info = super()._info(collision)
        home = np.hypot(*(self.pose[:2] - np.array(self.start[:2]))) < self.near_start
        info["d_optimality"] = 1e-5 if home else 1e-4 + 1e-5 * self.path_length
        info["entropy"] = 3.0
        return info


def run(env, steps=3000, **options):
    policy = make("ealc", env, **options)
    info, _ = explore(env, policy, steps)
    return policy, info


def test_is_a_baseline():
    assert "ealc" in names()


def test_explores_and_ends_without_touching():
    env = Drifting(RING, (1.2, 1.2, 0.0))
    policy, info = run(env)
    assert policy.finished and not info["collision"] and env.least > 0.12
    assert info["completeness"] >= 0.98


def test_graph_is_that_of_the_drive():
    env = Drifting(BIG_RING, (1.2, 1.2, 0.0))
    policy, _ = run(env)
    graph = policy.graph
    assert len(graph.positions) == len(graph.uncertainties) >= 6
    trace = np.array(env.trace)[:, :2]
    assert all(np.hypot(*(trace - position).T).min() < 0.01 for position in graph.positions)
    reached = {0}
    for _ in graph.edges:
        reached |= {j for i, j in graph.edges if i in reached} | {i for i, j in graph.edges if j in reached}
    assert reached == set(range(len(graph.positions)))


def test_visits_uncertain_nodes_once_more_at_the_end():
    lengths = {}
    for revisit in (False, True):
        env = Drifting(RING, (1.2, 1.2, 0.0))
        policy, _ = run(env, far=100.0, revisit=revisit)
        assert policy.finished
        lengths[revisit] = env.path_length
        if revisit:
            mean = np.mean(policy.graph.uncertainties)
            trace = np.array(env.trace)[len(env.trace) // 2 :, :2]
            for position, uncertainty in zip(policy.graph.positions, policy.graph.uncertainties, strict=True):
                if uncertainty > mean:
                    assert np.hypot(*(trace - position).T).min() < 0.6
    assert lengths[True] > lengths[False] + 2.0


def interest(policy, terrain, uncertainty):
    policy._uncertainty = uncertainty
    return policy.nodes_of_interest(terrain)


def test_nodes_of_interest_are_near_but_far_along_the_graph():
    env = Drifting(RING, (1.2, 1.2, 0.0))
    policy, _ = run(env, revisit=False, far=100.0)
    terrain = policy.driver.survey()
    graph = policy.graph
    graph.edges = {(i, i + 1) for i in range(len(graph.positions) - 1)}  # the ring, not yet closed
    graph.current = len(graph.positions) - 1
    policy.driver.pose = np.array([1.2, 1.9, 0.0])
    extent = max(terrain.occupancy.shape) * 0.05
    policy._far = 0.6
    nodes = interest(policy, terrain, 1e-2)
    assert 0 in nodes
    travelled = graph.distances()
    for node in nodes:
        assert travelled[node] > 0.6 * extent
        assert np.hypot(*(policy.driver.pose[:2] - graph.positions[node])) < 0.3 * extent
    assert interest(policy, terrain, 1e-9) == []  # the robot is more certain than any
    policy._as_printed = True
    assert interest(policy, terrain, 1e-9) and interest(policy, terrain, 1e-2) == []


def test_drives_to_a_node_of_interest_and_on_until_it_is_certain_again():
    env = Drifting(BIG_RING, (1.2, 1.2, 0.0))
    policy = make("ealc", env, near=0.5, far=0.4, revisit=False)
    observation, info = env.reset()
    policy.reset()
    begun = None
    for _ in range(3000):
        action = policy.act(observation, info)
        if policy.finished:
            break
        if policy._tour and begun is None:
            begun = (policy._tour[0], info["d_optimality"])
        if begun and not policy._tour:
            break
        observation, *_, info = env.step(action)
    assert begun is not None
    assert policy.graph.uncertainties[begun[0]] < begun[1]
    away = np.hypot(*(env.pose[:2] - np.array(policy.graph.positions[begun[0]])))
    assert away < 0.5 or info["d_optimality"] > policy._level


def test_entropy_can_be_compared_instead():
    env = Drifting(RING, (1.2, 1.2, 0.0))
    policy, _ = run(env, 200, uncertainty="entropy")
    assert set(policy.graph.uncertainties) == {3.0}


def test_reset_forgets_the_graph():
    env = Drifting(RING, (1.2, 1.2, 0.0))
    policy, _ = run(env, 300)
    assert policy.graph.positions
    policy.reset()
    assert not policy.graph.positions and not policy.finished


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"near": -1.0}, "near = -1"),
        ({"far": float("nan")}, "far = nan"),
        ({"retrace": float("inf")}, "retrace = inf"),
        ({"node_distance": -0.1}, "node_distance"),
        ({"uncertainty": "entropie"}, "did you mean 'entropy'"),
        ({"persistence": -1.0}, "persistence"),
        ({"farr": 1.0}, "no option 'farr'; did you mean 'far'"),
    ],
)
def test_bad_options_are_refused(options, says):
    with pytest.raises(ConfigError, match=says):
        make("ealc", FakeExploration(RING, (1.2, 1.2, 0.0)), **options)
