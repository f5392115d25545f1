"""The multi-robot environment: PettingZoo's own tests, its spaces, rewards, endings, and what it refuses."""

import warnings

import gymnasium as gym
import numpy as np
import pytest

import lidarena  # noqa: F401

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # PettingZoo's tests import its own old environments
    from pettingzoo.test import api_test, max_cycles_test, parallel_api_test, parallel_seed_test, render_test

from lidarena.base.errors import ActionError, ConfigError, MapError, ScenarioError, TeamError
from lidarena.envs import corridor_v0
from lidarena.envs.corridor.actions import action_for, commands_of

HEAD_ON = {"starts": [(5.0, 7.5), (6.5, 7.5)], "goals": [(6.5, 7.5), (5.0, 7.5)], "robots": 2}


def make(**keywords):
    return corridor_v0.parallel_env(**keywords)


def drive(env, action, steps=60):
    """Everybody does the same until the end; returns what every step gave."""
    record = []
    for _ in range(steps):
        if not env.agents:
            break
        record.append(env.step({name: np.array(action, np.float32) for name in env.agents}))
    return record


def test_pettingzoos_parallel_test_passes(capsys):
    parallel_api_test(make(), 60)
    parallel_api_test(make(action="discrete", robots=6, map="unstructured"), 60)


def test_pettingzoos_aec_test_passes(capsys):
    api_test(corridor_v0.env(), num_cycles=40)


def test_pettingzoos_seed_test_passes():
    parallel_seed_test(lambda: make(neighbours=2), 25)


def test_pettingzoos_render_test_passes(monkeypatch):
    monkeypatch.setenv("MPLBACKEND", "agg")
    render_test(corridor_v0.env)


def test_pettingzoos_max_cycles_test_passes():
    max_cycles_test(corridor_v0)


def test_robots_that_meet_collide_and_stay_where_they_are():
    env = make(**HEAD_ON)
    env.reset(seed=0)
    record = drive(env, (1.0, 0.0))
    rewards, terminated, infos = record[-1][1], record[-1][2], record[-1][4]
    assert terminated == {"robot_0": True, "robot_1": True} and not env.agents
    assert all(info["collision"] and not info["success"] for info in infos.values())
    assert all(reward < -9 for reward in rewards.values())
    terms = infos["robot_0"]["reward_terms"]
    assert terms["collision"] == -10.0 and sum(terms.values()) == pytest.approx(rewards["robot_0"])


def test_where_collisions_do_not_end_it_robots_drive_on():
    env = make(collision_ends=False, max_cycles=20, **HEAD_ON | {"goals": [(17.0, 7.5), (1.0, 7.5)]})
    env.reset(seed=0)
    record = drive(env, (1.0, 0.0))
    assert len(record) == 20 and record[-1][3] == {"robot_0": True, "robot_1": True}
    assert all(info["collision"] for info in record[-1][4].values())


def test_a_robot_that_arrives_is_rewarded_and_finished():
    env = make(robots=2, starts=[(2.0, 7.5), (8.0, 7.0)], goals=[(3.0, 7.5), (17.0, 7.0)], motion_noise=0.0)
    env.reset(seed=0)
    record = drive(env, (1.0, 0.0), 12)
    done = next(step for step in record if step[2]["robot_0"])
    assert done[4]["robot_0"]["success"] and done[1]["robot_0"] > 9.5
    assert env.agents == ["robot_1"]
    progress = sum(step[4]["robot_0"]["reward_terms"]["progress"] for step in record if "robot_0" in step[4])
    assert progress == pytest.approx(0.9, abs=0.15)


def test_rewards_follow_their_weights():
    total = {}
    for weight in (1.0, 3.0):
        env = make(reward={"preset": "default", "time": weight, "progress": 0.0})
        env.reset(seed=1)
        total[weight] = drive(env, (0.0, 0.0), 5)[-1][1]["robot_0"]
    assert total == {1.0: pytest.approx(-0.2), 3.0: pytest.approx(-0.6)}


def test_robots_see_each_other_and_their_goals():
    env = make(lidar={"noise": 0.0}, localization_noise=0.0, neighbours=1, **HEAD_ON)
    observations, infos = env.reset(seed=0)
    row = observations["robot_0"]
    assert row[0] * 3.5 == pytest.approx(1.5 - 0.105, abs=1e-3)
    assert row[36:39] == pytest.approx([1.0, 0.0, 1.5 / 3.5], abs=1e-5)
    assert row[44:47] == pytest.approx([1.0, 0.0, 1.5 / 3.5], abs=1e-5)
    assert infos["robot_0"]["goal"].tolist() == [6.5, 7.5]


def test_a_lone_robot_has_no_neighbours():
    observations, _ = make(robots=1, neighbours=2).reset(seed=0)
    assert not observations["robot_0"][-10:].any()


def test_wheels_obey_without_noise_and_stall_where_people_are_in_the_way():
    env = make(motion_noise=0.0, robots=1, starts=[(2.0, 7.5)], goals=[(17.0, 7.5)])
    env.reset(seed=0)
    drive(env, (1.0, 0.0), 10)
    assert env.episodes.core.physics.poses[0, 0, 0] == pytest.approx(3.0)
    env = make(stall_rate=1.0, robots=1, starts=[(2.0, 7.5)], goals=[(17.0, 7.5)])
    env.reset(seed=0)
    drive(env, (1.0, 0.0), 10)
    assert env.episodes.core.physics.poses[0, 0, 0] < 2.6


@pytest.mark.parametrize(("name", "robots"), [("passing", 2), ("blocked", 6), ("unstructured", 8), ("office", 12)])
def test_every_map_can_be_reset(name, robots):
    env = make(map=name, robots=robots)
    observations, infos = env.reset(seed=3)
    assert len(observations) == robots and (np.abs(observations["robot_0"]) <= 1.0).all()
    assert infos["robot_1"]["map"].shape == env.episodes.core.places.grid.blocked.shape


def test_sixty_four_robots_drive():
    env = make(map="office", robots=64, places="random")
    env.reset(seed=0)
    assert len(drive(env, (0.2, 0.5), 3)) == 3


def test_random_places_differ_from_seed_to_seed():
    env = make(places="random")
    goals = [env.reset(seed=seed)[1]["robot_0"]["goal"].tolist() for seed in (0, 1, 0)]
    assert goals[0] == goals[2] != goals[1]


def test_a_movingai_scenario_says_who_goes_where(tmp_path):
    (tmp_path / "hall.map").write_text("type octile\nheight 3\nwidth 4\nmap\n....\n....\n@...\n")
    line = "0\thall.map\t4\t3\t0\t0\t3\t2\t4.2\n"
    (tmp_path / "hall.scen").write_text("version 1\n" + line)
    env = make(map=str(tmp_path / "hall.map"), robots=1, places=str(tmp_path / "hall.scen"))
    _, infos = env.reset(seed=0)
    assert infos["robot_0"]["goal"].tolist() == [3.5, 0.5]
    assert env.episodes.core.starts[0, 0].tolist() == [0.5, 2.5]
    paths = make(map=tmp_path / "hall.map", robots=1, places=tmp_path / "hall.scen")  # a Path is as good as its text
    assert paths.reset(seed=0)[1]["robot_0"]["goal"].tolist() == [3.5, 0.5]
    with pytest.raises(ScenarioError, match="starts for 1 robots; 2 are asked for"):
        make(map=str(tmp_path / "hall.map"), robots=2, places=str(tmp_path / "hall.scen"))
    (tmp_path / "torn.scen").write_text("version 1\n0\thall.map\t4\n")
    with pytest.raises(ScenarioError, match="torn in line 2"):
        make(map=str(tmp_path / "hall.map"), robots=1, places=str(tmp_path / "torn.scen"))
    with pytest.raises(ScenarioError, match=r"needs the MovingAI \.map"):
        make(robots=1, places=str(tmp_path / "hall.scen"))
    (tmp_path / "other.map").write_text("type octile\nheight 2\nwidth 2\nmap\n..\n..\n")
    with pytest.raises(ScenarioError, match="is for a map of 4 x 3"):
        make(map=str(tmp_path / "other.map"), robots=1, places=str(tmp_path / "hall.scen"))


@pytest.mark.parametrize(
    ("keywords", "error", "sentence"),
    [
        ({"robotts": 4}, ConfigError, "did you mean 'robots'"),
        ({"robots": 0}, ConfigError, "robots = 0 is out of range"),
        ({"robots": 65}, ConfigError, "from 1 to 64"),
        ({"action": "discret"}, ConfigError, "did you mean 'discrete'"),
        ({"render_mode": "ascii"}, ConfigError, "render_mode = 'ascii' is not known"),
        ({"robot": {"radius": float("nan")}}, ConfigError, "radius = nan"),
        ({"collision_ends": 1}, ConfigError, "must be true or false"),
        ({"map": 3}, ConfigError, "map = 3 must be"),
        ({"map": "offise"}, MapError, "did you mean 'office'"),
        ({"places": "anywhere"}, ConfigError, "places = 'anywhere'"),
        ({"starts": [(1, 1)]}, ConfigError, "starts and goals are given together"),
        ({"max_cycles": 0}, ConfigError, "max_cycles = 0"),
        ({"max_episode_steps": 50}, ConfigError, "'max_episode_steps' is called 'max_cycles' here"),
        ({"map": "env1", "places": "predefined"}, ConfigError, "no predefined places"),
        ({"robots": 30}, ConfigError, "has starts for 24; at most 24 robots"),
        ({"map": "passing"}, ConfigError, "robots = 4, but map 'passing' has starts for 2"),
        ({"robot": {"radius": 0.6}}, TeamError, "does not fit at the place"),
        (HEAD_ON | {"goals": [(1.0, 1.0)]}, ConfigError, "must be 2 points"),
        (HEAD_ON | {"goals": [(5.0, 8.7), (2.0, 7.5)]}, TeamError, "goal .* of robot 0"),
        (HEAD_ON | {"goals": [(8.0, 7.5), (8.0, 7.5)]}, TeamError, "share the goal"),
        (HEAD_ON | {"starts": [(5.0, 7.5), (5.1, 7.5)]}, TeamError, r"overlap: they are 0\.10 m apart"),
        (HEAD_ON | {"robot": {"radius": 0.55}, "goals": [(8.0, 7.5), (2.0, 12.0)]}, TeamError, "wider than every door"),
    ],
)
def test_what_cannot_be_is_refused_with_one_sentence(keywords, error, sentence):
    with pytest.raises(error, match=sentence) as refusal:
        make(**keywords)
    assert "\n" not in str(refusal.value)


def test_a_goal_behind_walls_is_refused(tmp_path):
    (tmp_path / "two.map").write_text("type octile\nheight 2\nwidth 5\nmap\n..@..\n..@..\n")
    with pytest.raises(TeamError, match=r"robot 0 cannot reach its goal .* no free way"):
        make(map=str(tmp_path / "two.map"), robots=1, starts=[(0.5, 0.5)], goals=[(4.5, 0.5)])


def test_a_map_too_small_for_the_team_is_refused(tmp_path):
    (tmp_path / "one.map").write_text("type octile\nheight 1\nwidth 2\nmap\n..\n")
    with pytest.raises(TeamError, match=r"no solvable starts and goals|no room"):
        make(map=str(tmp_path / "one.map"), robots=9, places="random").reset(seed=0)


def test_actions_that_make_no_sense_are_refused():
    env = make(**HEAD_ON)
    with pytest.raises(gym.error.ResetNeeded):
        env.step({})
    env.reset(seed=0)
    good = np.zeros(2, np.float32)
    for actions, sentence in (
        ({"robot_0": good, "robot_1": good, "robot_2": good}, "there is no agent 'robot_2'"),
        ({"robot_0": good}, "the action of agent 'robot_1' is missing"),
        ({"robot_0": good, "robot_1": good * np.nan}, "'robot_1' is NaN or outside"),
        ({"robot_0": good, "robot_1": good + 2}, "'robot_1' is NaN or outside"),
        ({"robot_0": good, "robot_1": 1}, "'robot_1' is not of its action space"),
        ({"robot_0": good, "robot_1": [[1], [1, 2]]}, "'robot_1' is not of its action space"),
        ([good, good], "actions of type list were given; a dictionary by agent is needed"),
        (None, "actions of type NoneType"),
    ):
        with pytest.raises(ActionError, match=sentence):
            env.step(actions)


def test_an_action_of_a_finished_agent_is_refused():
    env = make(robots=2, starts=[(2.0, 7.5), (8.0, 7.0)], goals=[(2.3, 7.5), (17.0, 7.0)])
    env.reset(seed=0)
    drive(env, (0.5, 0.0), 6)
    assert env.agents == ["robot_1"]
    with pytest.raises(ActionError, match="'robot_0' is finished, it has arrived"):
        env.step({"robot_0": np.zeros(2), "robot_1": np.zeros(2)})


def test_discrete_actions_are_checked():
    env = make(action="discrete", robots=1)
    env.reset(seed=0)
    for action in (7, -1):
        with pytest.raises(ActionError, match="outside of its action space"):
            env.step({"robot_0": action})
    with pytest.raises(ActionError, match="not of its action space"):
        env.step({"robot_0": 1.5})


def test_commands_and_actions_are_inverse_to_each_other():
    for command in ((0.3, -1.0), (-0.2, 0.5)):
        action = action_for("continuous", *command)
        assert np.allclose(commands_of("continuous", [action], 1)[0], command)
    assert action_for("discrete", 0.5, 0.1) == 1
    assert np.abs(action_for("continuous", 1.0, 1.0)).max() <= 1.0
    with pytest.raises(ActionError, match="whole numbers 0 to 6"):
        commands_of("discrete", [0.5], 1)


def test_the_picture_shows_the_team(tmp_path):
    env = make(render_mode="rgb_array")
    with pytest.raises(gym.error.ResetNeeded):
        env.render()
    env.reset(seed=0)
    before = env.render()
    drive(env, (0.5, 0.5), 5)
    assert before.ndim == 3 and before.dtype == np.uint8 and (before != env.render()).any()


def test_seeds_and_agents_are_numpys_too_or_refused_in_a_sentence():
    env = make()
    first = env.reset(seed=np.int64(3))[0]
    again = env.reset(seed=3, options={"whatever": 1})[0]
    assert all(np.array_equal(first[name], again[name]) for name in env.agents)
    for seed in ("3", 1.0, -1, True):
        with pytest.raises(ConfigError, match="must be a whole number of at least 0, or None"):
            env.reset(seed=seed)
    for space in (env.action_space, env.observation_space):
        with pytest.raises(ConfigError, match=r"there is no agent 'robot0'; did you mean 'robot_0'\?"):
            space("robot0")
