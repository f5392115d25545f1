from lidarena.envs.exploration.goal_choice.options import GoalChoiceOptions


def test_what_makes_the_world_is_handed_on() -> None:
    options = GoalChoiceOptions.checked({"map": "env2", "slam": "truth", "preference": 0.5, "time_limit": None})
    assert (options.world.map, options.world.slam, options.preference, options.time_limit) == (
        "env2",
        "truth",
        0.5,
        None,
    )
    assert options.world.stop_at is None and options.world.max_episode_steps == -1 and options.max_episode_steps == 2000
