import gymnasium as gym
import numpy as np
import pytest

import lidarena  # noqa: F401
from lidarena.base.errors import ConfigError
from lidarena.baselines import make
from tests.baselines.exploration.fake_exploration import FakeExploration, drawn, explore

ROOMS = drawn(
    "#################",
    "#    #     #    #",
    "#          #    #",
    "#    #          #",
    "#    #     #    #",
    "### #### #### ###",
    "#               #",
    "#               #",
    "##### ##### #####",
    "#    #     #    #",
    "#    #     #    #",
    "#    #     #    #",
    "#################",
    side=9,
)
CORRIDORS = drawn(  # 0.8 m wide, with dead ends
    "###########",
    "#         #",
    "# ### ### #",
    "# #     # #",
    "# ### # # #",
    "#     #   #",
    "##### #####",
    "#   # #   #",
    "# #     # #",
    "###########",
    side=16,
)
U_SHAPES = drawn(
    "##############",
    "#            #",
    "#  ########  #",
    "#  #      #  #",
    "#  #  ##  #  #",
    "#  #  ##  #  #",
    "#     ##     #",
    "#  ########  #",
    "#            #",
    "##############",
    side=16,
)
PILLARS = drawn(
    "################",
    "#              #",
    "#  #   #   #   #",
    "#              #",
    "#    #   #   # #",
    "#              #",
    "#  #   #   #   #",
    "#              #",
    "################",
    side=8,
)
WORLDS = {
    "rooms": (ROOMS, (1.0, 1.0, 0.0)),
    "corridors": (CORRIDORS, (1.2, 6.8, 0.0)),
    "u": (U_SHAPES, (3.6, 4.1, 1.0)),
    "pillars": (PILLARS, (0.8, 0.8, 0.5)),
}


def assert_explored(env, policy, info, completeness=0.98):
    assert not info["collision"]
    assert env.least > 0.12
    assert policy.finished
    assert info["completeness"] >= completeness


@pytest.mark.parametrize("name", WORLDS)
def test_explores_everything_without_touching(name):
    solid, start = WORLDS[name]
    env = FakeExploration(solid, start)
    policy = make("frontier", env)
    info, _ = explore(env, policy, 4000)
    assert_explored(env, policy, info)


@pytest.mark.parametrize("options", [{"action": "continuous"}, {"observation": "map"}, {"pose_error": 0.03}], ids=str)
@pytest.mark.parametrize("name", ["rooms", "corridors"])
def test_explores_with_other_actions_observations_and_a_swaying_pose(name, options):
    solid, start = WORLDS[name]
    env = FakeExploration(solid, start, **options)
    policy = make("frontier", env)
    info, _ = explore(env, policy, 4000)
    assert_explored(env, policy, info)


@pytest.mark.parametrize("heading", [-2.0, 0.0, 1.5, 3.0])
def test_explores_from_any_heading(heading):
    env = FakeExploration(PILLARS, (2.7, 2.0, heading))
    policy = make("frontier", env)
    info, _ = explore(env, policy, 3000)
    assert_explored(env, policy, info)


def test_as_explore_lite_it_still_explores():
    env = FakeExploration(ROOMS, (1.0, 1.0, 0.0))
    policy = make("frontier", env, last_frontier_size=0.5, persistence=0.0)
    info, _ = explore(env, policy, 5000)
    assert_explored(env, policy, info, 0.95)


def test_is_deterministic():
    traces = []
    for _ in range(2):
        env = FakeExploration(U_SHAPES, (3.6, 4.1, 1.0))
        explore(env, make("frontier", env), 300)
        traces.append(np.array(env.trace))
    np.testing.assert_array_equal(*traces)


def test_reset_forgets_the_last_episode():
    env = FakeExploration(PILLARS, (0.8, 0.8, 0.5))
    policy = make("frontier", env)
    explore(env, policy, 3000)
    first, steps = np.array(env.trace), env.steps
    assert policy.finished
    policy.reset(seed=1)
    assert not policy.finished
    explore(env, policy, 3000)
    assert env.steps == steps
    np.testing.assert_array_equal(np.array(env.trace), first)


def test_turns_where_it_is_once_it_has_finished():
    env = FakeExploration(drawn("####", "#  #", "#  #", "####", side=20), (1.5, 1.5, 0.0))
    policy = make("frontier", env)
    info, _ = explore(env, policy, 200)
    assert policy.finished
    here = env.pose.copy()
    for _ in range(150):
        action = policy.act(env._observation(), info)
        assert action == 1
        *_, info = env.step(action)
    assert policy.finished and not info["collision"]
    assert np.hypot(*(env.pose - here)[:2]) < 0.4


def test_waits_for_a_map():
    env = FakeExploration(PILLARS, (0.8, 0.8, 0.5))
    policy = make("frontier", env)
    observation, info = env.reset()
    policy.reset()
    nothing = dict(info, map=np.full_like(info["map"], -1))
    for _ in range(30):
        assert env.action_space.contains(policy.act(observation, nothing))
    assert not policy.finished
    assert policy.act(observation, info) in (0, 1, 2)


def test_does_not_drive_against_what_only_the_beams_see():
    env = FakeExploration(PILLARS, (1.5, 1.2, 0.0))
    policy = make("frontier", env)
    observation, info = env.reset()
    policy.reset()
    for _ in range(60):
        action = policy.act(observation, info)
        if action == 0:
            break
        observation, *_, info = env.step(action)
    assert action == 0
    policy.reset()
    observation, info = env._observation(), env._info(False)
    observation[0] = 0.2 / 3.5  # the map shows nothing there
    assert policy.act(observation, info) != 0


def test_reads_nothing_but_map_pose_and_beams():
    env = FakeExploration(PILLARS, (0.8, 0.8, 0.5))
    policy = make("frontier", env)
    observation, info = env.reset()
    policy.reset()
    for _ in range(30):
        poor = {key: info[key] for key in ("map", "resolution", "origin", "pose")}
        observation, *_, info = env.step(policy.act(observation, poor))


def test_does_not_enter_a_corridor_in_which_it_could_not_turn_round():
    """0.45 m are wide enough for driving, but a robot that cannot reverse must not find a dead end there."""
    solid = drawn("############", "#   ########", "#          #", "#   ########", "############", side=9)
    env = FakeExploration(solid, (1.0, 1.1, 3.0))
    policy = make("frontier", env)
    info, _ = explore(env, policy, 1000)
    assert policy.finished and not info["collision"]
    assert env.least > 0.12
    assert np.array(env.trace)[:, 0].max() < 2.4


def test_gives_up_what_it_cannot_reach():
    """A room that is only seen through a slit: its frontier stays, and the policy ends all the same."""
    solid = drawn("##########", "#    #   #", "#    #   #", "#    #   #", "##########", side=16)
    solid[30:34, 80:96] = False  # a slit of 0.2 m
    env = FakeExploration(solid, (1.6, 2.0, 0.0))
    policy = make("frontier", env)
    info, _ = explore(env, policy, 2000)
    assert policy.finished and not info["collision"]
    assert policy._blacklist.given_up
    assert policy.ending == "out of reach"


@pytest.mark.parametrize(("options", "ending"), [({}, "explored"), ({"last_pass_timeout": 0.0}, "fruitless")])
def test_says_why_it_has_ended(options, ending):
    env = FakeExploration(ROOMS, (1.0, 1.0, 0.0))
    policy = make("frontier", env, **options)
    assert policy.ending == ""
    explore(env, policy, 4000)
    assert policy.finished and policy.ending == ending
    policy.reset()
    assert policy.ending == ""


def test_escapes_from_a_start_too_near_to_a_wall():
    env = FakeExploration(drawn("####", "#  #", "#  #", "####", side=30), (1.8, 1.66, 0.4))
    policy = make("frontier", env)
    info, _ = explore(env, policy, 400)
    assert not info["collision"]
    assert env.clearance[env._cell(*env.pose[:2])] > 0.14


@pytest.mark.parametrize(
    "option",
    [
        "min_frontier_size",
        "last_frontier_size",
        "potential_scale",
        "gain_scale",
        "planner_period",
        "progress_timeout",
        "arrival_patience",
        "persistence",
        "last_pass_timeout",
    ],
)
@pytest.mark.parametrize("value", [-1.0, float("nan"), float("inf")])
def test_options_out_of_range_are_refused(option, value):
    with pytest.raises(ConfigError, match=option):
        make("frontier", FakeExploration(PILLARS, (0.8, 0.8, 0.5)), **{option: value})


def test_frontier_explores_with_any_observation() -> None:
    known = []
    for observation in ("da_slam", "sectors", "frontier_histogram", "frontier_arcs", "map"):
        env = gym.make("lidarena/Env2-v0", observation=observation, slam="truth", max_episode_steps=300)
        policy = make("frontier", env)
        seen, info = env.reset(seed=0)
        policy.reset(seed=0)
        for _ in range(200):
            seen, _, terminated, _, info = env.step(policy.act(seen, info))
            assert not terminated
        known.append(info["completeness"])
    assert min(known) > 0.4
    assert known[1] == known[2] == known[3], "they show the same hits as the sectors"


NARROW = drawn(*["#" * 13, *["#     #     #"] * 4, "#           #", *["#     #     #"] * 4, "#" * 13], side=7)
"""Two rooms with a door of 0.35 m between them."""


def test_a_door_narrower_than_its_clearance_is_told_as_out_of_reach():
    env = FakeExploration(NARROW, (1.0, 1.75, 0.0))
    policy = make("frontier", env)
    info, _ = explore(env, policy, 1500)
    assert policy.finished and not info["collision"]
    assert policy.ending == "out of reach"
    policy.act(env._observation(), info)
    assert info["ending"] == "out of reach"


def test_a_clearance_at_which_it_collides_is_refused():
    env = FakeExploration(NARROW, (1.0, 1.75, 0.0))
    with pytest.raises(ConfigError, match="clearance"):
        make("frontier", env, clearance=0.1)


def test_the_robots_own_clearance_holds_for_paths_and_the_policys_goes_before():
    env = gym.make("lidarena/Env1-v0", robot={"clearance": 0.3})
    assert make("frontier", env).driver.inflation.lethal_radius == 0.3
    assert make("frontier", env, clearance=0.16).driver.inflation.lethal_radius == 0.16
    env.close()


def test_a_hall_wider_than_the_lidar_sees_is_not_crossed_again_and_again():
    """After 800 steps 40% were seen as long as the middle of a frontier all around was driven to."""
    side = 330  # 16.5 m
    hall = np.ones((side, side), bool)
    hall[6:-6, 6:-6] = False
    env = FakeExploration(hall, (1.0, 1.0, 0.7))
    info, _ = explore(env, make("frontier", env), 800)
    assert info["completeness"] > 0.85 and info["path_length"] < 60.0


def test_where_nothing_new_is_seen_at_one_place_of_a_long_frontier_it_goes_to_another():
    hall = np.ones((280, 280), bool)
    hall[6:-6, 6:-6] = False
    env = FakeExploration(hall, (7.0, 7.0, 0.7))
    policy = make("frontier", env)
    observation, info = env.reset()
    policy.reset()
    map_of_the_start, goals = info["map"].copy(), set()
    for _ in range(400):  # the map of a filter that lays scans elsewhere than where it believes the robot to be
        info["map"] = map_of_the_start
        observation, _, _, _, info = env.step(policy.act(observation, info))
        if policy.driver.goal is not None:
            goals.add(policy.driver.goal)
        assert not policy.finished
    apart = np.array(sorted(goals))
    assert np.hypot(*(apart.max(axis=0) - apart.min(axis=0))) > 2.0
