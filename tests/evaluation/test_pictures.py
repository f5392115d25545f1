"""Pictures exist, are not blank, and say what they should."""

from dataclasses import replace
from pathlib import Path

import gymnasium as gym
import numpy as np
import pytest
from PIL import Image

from lidarena.baselines import make
from lidarena.evaluation.comparison_config import EnvEntry, PolicyEntry
from lidarena.evaluation.episodes import run_episode
from lidarena.evaluation.pictures import Cell, draw_pictures, overview, progress, single
from lidarena.evaluation.trace import TeamTrace, Walls
from tests.evaluation.rows import SQUARE, episode_of, trace_of

VALUES = {"completeness": 0.97, "path_length": 31.24, "time": 105.2}


def cell_of(policy: str, env: str = "Env-1", ending: str = "success", speed: float = 0.1, **shape: bool) -> Cell:
    first = episode_of(0, VALUES, ending, speed, trace_of(crashed=ending == "collision", **shape))
    others = [episode_of(k, VALUES, ending, speed * (1 + 0.05 * k)) for k in (1, 2)]
    return Cell(EnvEntry(id=env), PolicyEntry(name=policy), [first, *others])


def test_all_pictures_are_drawn(tmp_path: Path) -> None:
    cells = [[cell_of("random", env, "collision", 0.03), cell_of("frontier", env)] for env in ("Env-1", "Env-2")]
    paths = draw_pictures(cells, tmp_path / "pictures")
    assert [path.relative_to(tmp_path / "pictures").as_posix() for path in paths] == [
        "overview.png",
        "progress.png",
        "Env-1/random.png",
        "Env-1/frontier.png",
        "Env-2/random.png",
        "Env-2/frontier.png",
    ]
    for path in paths:
        with Image.open(path) as image:
            assert image.width > 400 and image.height > 300
            assert image.convert("L").entropy() > 0.5


def test_without_traces_there_are_no_maps(tmp_path: Path) -> None:
    bare = Cell(EnvEntry(id="Env-1"), PolicyEntry(name="random"), [episode_of(0, VALUES)])
    assert [path.name for path in draw_pictures([[bare]], tmp_path)] == ["progress.png"]
    without_time = replace(episode_of(0, VALUES), progress=None)
    nothing = Cell(EnvEntry(id="Env-1"), PolicyEntry(name="random"), [without_time])
    assert draw_pictures([[nothing]], tmp_path) == []


@pytest.mark.parametrize("shape", [{"walls": False}, {"grid": False}, {"grid": False, "walls": False}])
def test_maps_may_lack_walls_or_cells(shape: dict[str, bool]) -> None:
    figure = single(cell_of("random", **shape))
    figure.canvas.draw()
    low, high = figure.axes[0].get_xlim()
    assert low < 1 and high > 3


def test_a_picture_explains_itself() -> None:
    figure = single(cell_of("frontier", ending="collision"))
    axes = figure.axes[0]
    assert axes.get_title() == "frontier in Env-1, seed 0\nexplored 97% in 31.2 m, 105 s: collision"
    assert (axes.get_xlabel(), axes.get_ylabel()) == ("x (m)", "y (m)")
    assert axes.get_aspect() == 1.0
    labels = {text.get_text() for text in figure.legends[0].get_texts()}
    assert {"true path", "path as SLAM believes it", "true walls", "mapped as free"} <= labels
    assert {"start", "end", "collision"} <= labels


def test_the_map_lies_where_the_walls_are() -> None:
    image = single(cell_of("frontier")).axes[0].get_images()[0]
    assert image.get_extent() == [0, 4.0, 0, 4.0] or tuple(image.get_extent()) == (0, 4.0, 0, 4.0)
    assert image.origin == "lower"


def test_the_overview_has_a_panel_each_and_equal_limits_in_a_row() -> None:
    figure = overview([[cell_of(name, env) for name in ("random", "frontier")] for env in ("Env-1", "Env-2", "Env-3")])
    assert len(figure.axes) == 6
    assert figure.axes[0].get_xlim() == figure.axes[1].get_xlim()
    assert "Env-2" in figure.axes[2].get_ylabel()


def test_progress_has_a_panel_per_environment() -> None:
    figure = progress([[cell_of("random", env)] for env in ("Env-1", "Env-2", "Env-3", "Env-4")])
    assert [axes.get_title() for axes in figure.axes][:4] == [f"Env-{k} (3 episodes each)" for k in (1, 2, 3, 4)]


def test_a_graph_is_drawn_and_explained_wherever_a_policy_kept_one() -> None:
    graph = replace(trace_of(), nodes=np.array([[1.0, 1.0], [2.0, 1.5], [3.0, 3.0]]), links=np.array([[0, 1], [1, 2]]))
    plain, with_graph = cell_of("frontier"), cell_of("ealc")
    with_graph = replace(with_graph, episodes=[replace(with_graph.episodes[0], picture=graph)])
    figure = overview([[plain, with_graph]])
    legend = [text.get_text() for text in figure.legends[0].get_texts()]
    assert "topological graph" in legend and legend.count("true path") == 1
    lines = {line.get_label(): line for line in figure.axes[1].lines}
    assert np.array_equal(np.array(lines["topological graph"].get_xydata()), graph.nodes)
    assert "topological graph" not in {line.get_label() for line in figure.axes[0].lines}


def test_a_team_is_drawn_robot_by_robot() -> None:
    steps = np.linspace(0, 1, 20)[:, None]
    paths = np.stack([np.hstack([1 + 2 * steps, 1 + 0 * steps]), np.hstack([3 - steps, 2 + steps])], axis=1)
    goals = np.array([[3.0, 1.0], [2.0, 3.0]])
    team = TeamTrace(paths, goals, np.array([False, True]), Walls(SQUARE))
    episode = replace(episode_of(0, {}, "collision", picture=team), caption="one of two arrived")
    figure = single(Cell(EnvEntry(id="office"), PolicyEntry(name="apart"), [episode]))
    axes = figure.axes[0]
    assert axes.get_title() == "apart in office, seed 0\none of two arrived"
    lines = [line for line in axes.get_lines() if len(line.get_xdata()) == 20]
    assert [line.get_xydata()[-1].tolist() for line in lines] == goals.tolist()
    assert lines[0].get_color() != lines[1].get_color()
    ends = [line.get_marker() for line in axes.get_lines() if len(line.get_xdata()) == 1]
    assert ends == ["o", "*", "s", "o", "*", "X"]
    figure.canvas.draw()


def test_a_comparison_of_teams_keeps_what_pictures_need() -> None:
    env = gym.make("lidarena/CorridorCentral-v0", map="passing", robots=2, places="predefined", expose_truth=True)
    episode = run_episode(env, make("prioritized_search", env), 3, keep_picture=True, max_steps=20)
    trace = episode.picture
    assert isinstance(trace, TeamTrace) and trace.paths.shape == (21, 2, 2) and trace.goals.shape == (2, 2)
    assert not trace.collided.any() and len(trace.walls.edges)
    assert episode.caption.startswith("0% of the robots arrived")
