from lidarena.baselines.workshop.greedy import SoonestDone
from lidarena.envs.workshop.env import WorkshopEnv
from tests.envs.workshop.workshops import Sleeper, action, play, task_of


def test_it_takes_what_ends_soonest_ways_included() -> None:
    task = task_of({"far": action("a", robot=(5, 6)), "near": action("d", robot=(7, 8)),
                    "long": action("d", robot=(20, 21))})  # fmt: skip
    env = WorkshopEnv(task=task, human=Sleeper)
    policy = SoonestDone(env)
    policy.reset()
    infos = play(env, lambda info: policy.act(None, info))
    assert infos[-1]["begun"].argsort().tolist() == [1, 0, 2]


def test_with_nothing_to_begin_it_waits() -> None:
    task = task_of({"x": action("a", robot=None)})
    env = WorkshopEnv(task=task, human="free")
    _, info = env.reset(seed=0)
    assert SoonestDone(env).act(None, info) == 1
