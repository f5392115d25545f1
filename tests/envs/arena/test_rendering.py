import numpy as np

from lidarena.baselines import make
from lidarena.envs import ArenaEnv
from lidarena.world.canvas import BLUE, GREEN, MAGENTA, ORANGE, RED

COLOURS = {"driven": GREEN, "plan": ORANGE, "after regression": BLUE, "hits": RED}


def picture_of(steps: int = 5, **keywords: object) -> np.ndarray:
    env = ArenaEnv(render_mode="rgb_array", **keywords)
    env.reset(seed=0)
    for _ in range(steps):
        env.step(np.zeros(1, np.float32))
    picture = env.render()
    assert picture is not None
    return picture


def count(picture: np.ndarray, colour: tuple[int, int, int]) -> int:
    return int((picture == colour).all(axis=2).sum())


def test_everything_that_the_legend_names_is_there() -> None:
    panel = picture_of(arena="yang:u")[44:-64]
    for name, colour in COLOURS.items():
        assert count(panel, colour) > 15, name
    assert count(panel, MAGENTA) > 10  # the fills leave minima inside of the trap


def test_the_green_line_grows_with_the_way_driven() -> None:
    short, long = (count(picture_of(steps, arena="yang")[44:-64], GREEN) for steps in (2, 30))
    assert long > 2 * short


def test_rooms_keep_their_shape() -> None:
    tall = picture_of(arena="env2", goal=(1.0, 6.5))
    assert tall.shape == (560 + 44 + 64, 640, 3)


def test_an_episode_that_begins_is_drawn_anew() -> None:
    env = ArenaEnv(arena="u_trap", pick="by_seed", render_mode="rgb_array")
    env.reset(seed=0)
    first = env.render()
    env.reset(seed=1)
    second = env.render()
    env.reset(seed=0)
    assert first is not None and not np.array_equal(first, second)
    assert np.array_equal(first, env.render())


def test_drawing_changes_no_bit_of_the_world() -> None:
    plain, drawn = ArenaEnv(arena="random"), ArenaEnv(arena="random", render_mode="rgb_array")
    for env in (plain, drawn):
        env.reset(seed=2)
    for _ in range(4):
        drawn.render()
        one, two = (env.step(np.full(1, 0.05, np.float32)) for env in (plain, drawn))
        assert one[0].tobytes() == two[0].tobytes() and one[1] == two[1]


def test_a_policy_shows_its_own_plan_until_the_episode_ends() -> None:
    env = ArenaEnv(arena="yang", render_mode="rgb_array")
    env.reset(seed=0)
    field = env.render()
    aside = np.array([[5.0, 90.0], [95.0, 90.0]])
    env.show(aside)
    own = env.render()
    assert field is not None and own is not None
    assert count(own[44:-64], ORANGE) == 0 and count(own[44:-64], BLUE) > 500
    env.show(aside, before=np.array([[5.0, 80.0], [95.0, 80.0]]))
    smoothed = env.render()
    assert smoothed is not None and count(smoothed[44:-64], ORANGE) > 500
    env.reset(seed=0)
    assert np.array_equal(env.render(), field)


def picture_after_a_decision(name: str) -> np.ndarray:
    env = ArenaEnv(arena="yang:u", render_mode="rgb_array")
    observation, info = env.reset(seed=0)
    policy = make(name, env)
    policy.reset(seed=0)
    policy.act(observation, info)
    picture = env.render()
    assert picture is not None
    return picture[44:-64]


def test_planners_show_what_they_drive() -> None:
    for name, smooths in (("astar", False), ("apf_improved", True), ("apf_improved_lidar", False)):
        picture = picture_after_a_decision(name)
        assert count(picture, BLUE) > 100, name
        assert (count(picture, ORANGE) > 0) == smooths, name


def test_who_plans_no_farther_than_two_steps_shows_no_more() -> None:
    assert count(picture_after_a_decision("apf_lidar"), BLUE) < 100
