"""The picture shows robots, goals, trails, plans and who waits for whom, each where it is and in its own colour."""

from typing import Any

import numpy as np
import pytest
from matplotlib import pyplot
from numpy.typing import NDArray

from lidarena.envs import BatchedCorridor, corridor_v0
from lidarena.envs.corridor.rendering import COLOURS, TeamScene, TeamSketch, draw_team
from lidarena.world.canvas import ORANGE, RED
from lidarena.world.load import load_floorplan

Image = NDArray[np.uint8]
PLAN = load_floorplan("office")
POSES = np.array([(3.0, 7.5, 0.0), (10.0, 7.0, 1.0)])
GOALS = np.array([(6.0, 13.0), (15.5, 2.0)])
NOBODY = np.zeros(2, np.bool_)


def picture(sketch: TeamSketch | None = None, trails: Any = None, **changes: Any) -> Image:
    values = {"poses": POSES, "goals": GOALS, "arrived": NOBODY, "crashed": NOBODY} | changes
    scene = TeamScene(PLAN, **values, radius=0.2, time=1.2)
    return draw_team(scene, POSES[:, None, :2] if trails is None else trails, sketch or TeamSketch())


def near(image: Image, point: tuple[float, float], reach: float = 0.5) -> Image:
    """The pixels (n, 3) around a point [m]; the plan is 900 pixels wide, below a header."""
    scale = 900 / 19.2
    height = round(15.2 * scale)
    row, col = 28 + height - (point[1] + 0.1) * scale, (point[0] + 0.1) * scale
    size = reach * scale
    return image[int(row - size) : int(row + size), int(col - size) : int(col + size)].reshape(-1, 3)


def count(pixels: Image, colour: tuple[int, int, int]) -> int:
    return int((np.abs(pixels.astype(int) - colour).max(axis=1) < 12).sum())


def test_robots_and_their_goals_have_one_colour_and_stand_where_they_are() -> None:
    image = picture()
    for robot, other in ((0, 1), (1, 0)):
        for point in (POSES[robot], GOALS[robot]):
            assert count(near(image, point), COLOURS[robot]) > 10
            assert count(near(image, point), COLOURS[other]) == 0
    assert count(near(image, (6.0, 3.0)), COLOURS[0]) == 0


def test_trails_plans_and_crosses_are_drawn_along_their_points() -> None:
    bare, line = picture(), np.array([(3.0, 7.5), (8.0, 7.5)])
    trails = np.stack([np.linspace((1.0, 7.5), (3.0, 7.5), 9), np.tile(POSES[1, :2], (9, 1))], axis=0)
    trailed, planned = picture(trails=trails), picture(TeamSketch({0: line}))
    crossed = picture(TeamSketch({0: line}, np.array([(7.0, 7.5)])))
    assert (near(trailed, (1.7, 7.5), 0.2) != near(bare, (1.7, 7.5), 0.2)).any()
    assert (near(trailed, (5.5, 7.5), 0.2) == near(bare, (5.5, 7.5), 0.2)).all()
    assert count(near(planned, (6.0, 7.5)), COLOURS[0]) > 3 and count(near(bare, (6.0, 7.5)), COLOURS[0]) == 0
    assert count(near(crossed, (7.0, 7.5)), RED) > 10 and count(near(planned, (7.0, 7.5)), RED) == 0


def test_an_arrow_leads_from_who_waits_to_whom_it_waits_for() -> None:
    bare, waiting = picture(), picture(TeamSketch(waits=((0, 1),)))
    for share in (0.3, 0.5, 0.7):
        between = tuple(POSES[0, :2] + share * (POSES[1, :2] - POSES[0, :2]))
        assert count(near(waiting, between, 0.2), ORANGE) > 3 and count(near(bare, between, 0.2), ORANGE) == 0
    towards, away = (near(waiting, tuple(POSES[robot, :2] + (d, 0)), 0.55) for robot, d in ((1, -0.5), (0, 0.5)))
    assert count(towards, ORANGE) > 1.3 * count(away, ORANGE)  # the tip is at robot 1


def test_who_has_arrived_and_who_has_crashed_is_seen() -> None:
    one = np.array([True, False])
    assert (near(picture(arrived=one), GOALS[0]) != near(picture(), GOALS[0])).any()
    assert (near(picture(arrived=one), GOALS[1]) == near(picture(), GOALS[1])).all()
    assert (near(picture(crashed=one), POSES[0, :2]) != near(picture(), POSES[0, :2])).any()
    assert (picture(crashed=one)[:28] != picture()[:28]).any()  # the header tells it in words


def test_who_has_arrived_is_numbered_once() -> None:
    """Robot 3 at its goal was labelled 33."""
    beside = tuple(GOALS[0] + (0.36, 0.2))
    assert count(near(picture(), beside, 0.1), COLOURS[0]) > 0
    assert count(near(picture(arrived=np.array([True, False])), beside, 0.1), COLOURS[0]) == 0


@pytest.mark.parametrize("name", ["passing", "blocked", "unstructured"])
def test_every_map_has_room_for_its_words(name: str) -> None:
    env = corridor_v0.parallel_env(map=name, robots=2, render_mode="rgb_array")
    env.reset(seed=0)
    image = env.render()
    assert image is not None and image.shape[1] >= 640
    words = np.argwhere((image[:28] < 128).all(axis=2))
    assert len(words) > 100 and words[:, 1].max() < image.shape[1] - 4


def test_each_world_of_a_batch_has_its_own_picture() -> None:
    batch = BatchedCorridor(2, robots=2, render_mode="rgb_array")
    batch.reset(seed=0)
    one, other = batch.render()
    assert one.shape == other.shape and (one != other).any()


def test_a_window_shows_the_picture_until_it_is_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    pyplot.switch_backend("agg")
    env = corridor_v0.parallel_env(robots=2, render_mode="human")
    env.reset(seed=0)
    before = set(pyplot.get_fignums())
    assert env.render() is None
    env.step(dict.fromkeys(env.agents, np.array([0.5, 0.0], np.float32)))
    assert env.render() is None
    assert len(set(pyplot.get_fignums()) - before) == 1  # one window, not one a picture
    env.close()
    assert set(pyplot.get_fignums()) == before
    env.close()
