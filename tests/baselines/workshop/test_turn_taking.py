from lidarena.baselines.workshop.turn_taking import TurnTaking
from lidarena.envs.workshop.env import WorkshopEnv
from tests.envs.workshop.workshops import Sleeper, loose, play


def test_one_action_for_every_action_of_the_human() -> None:
    env = WorkshopEnv(task=loose(4), human="free", wait_period=1.0)
    policy = TurnTaking(env)
    policy.reset()
    infos = play(env, lambda info: policy.act(None, info))
    for info in infos:
        begun_by_robot = (info["agent"] == 1).sum()
        assert begun_by_robot <= ((info["agent"] == 0) & (info["status"] == 2)).sum() + (info["human_idle"] > 0)
    assert infos[-1]["success"] and infos[-1]["agent"].tolist().count(1) >= 1


def test_a_human_who_does_nothing_has_passed() -> None:
    env = WorkshopEnv(task=loose(2), human=Sleeper)
    policy = TurnTaking(env)
    policy.reset()
    last = play(env, lambda info: policy.act(None, info))[-1]
    assert last["success"] and last["robot_idle"] > 0.0
