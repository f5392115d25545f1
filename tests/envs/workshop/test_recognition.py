import numpy as np

from lidarena.envs.workshop.env import WorkshopEnv
from tests.envs.workshop.workshops import loose


def guesses(seeds: int) -> tuple[list[bool], list[bool]]:
    """Whether the human's action is guessed right at its choice, and some seconds later."""
    env = WorkshopEnv(task=loose(4), human="free", recognition="position", expose_truth=True, wait_period=2.0)
    early, late = [], []
    for seed in range(seeds):
        _, info = env.reset(seed=seed)
        early.append(info["doing"][0] == info["truth"]["action"][0])
        env.step(4)
        _, _, _, _, info = env.step(4)
        late.append(info["doing"][0] == info["truth"]["action"][0])
    return early, late


def test_where_the_human_walks_tells_what_it_does() -> None:
    early, late = guesses(40)
    assert np.mean(late) > max(0.7, np.mean(early) + 0.2)


def test_beliefs_are_probabilities() -> None:
    env = WorkshopEnv(task="gearbox", human="free", recognition="position")
    env.reset(seed=0)
    for _ in range(10):
        _, _, terminated, _, info = env.step(int(np.flatnonzero(env.action_masks())[0]))
        if terminated:
            break
        belief = env.episodes.recognizer.belief[0]
        assert (belief >= 0).all() and (np.isclose(belief.sum(), 1.0) or info["doing"][0] == -1)


def test_exactly_told_is_the_truth() -> None:
    env = WorkshopEnv(task=loose(4), human="free", expose_truth=True)
    _, info = env.reset(seed=0)
    assert (info["doing"] == info["truth"]["action"]).all()
