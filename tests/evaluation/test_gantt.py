import pickle

import numpy as np
from matplotlib.figure import Figure

import lidarena
from lidarena.envs.workshop.env import WorkshopEnv
from lidarena.evaluation.episodes import run_episode
from lidarena.evaluation.gantt import GanttChart
from lidarena.evaluation.picture import axis_titles


def chart() -> GanttChart:
    env = WorkshopEnv(task="pile", human="free", expose_truth=True)
    made = run_episode(env, lidarena.baselines.make("greedy", env), 0, keep_picture=True).picture
    assert isinstance(made, GanttChart)
    return made


def test_lanes_tell_who_has_done_what() -> None:
    made = chart()
    worked = made.parts[made.parts[:, 1] == 3]
    assert {int(one) for one in worked[:, 2]} == set(range(5)) and (made.parts[:, 4] > made.parts[:, 3]).all()
    for agent in (0, 1):
        own = made.parts[made.parts[:, 0] == agent]
        assert np.allclose(own[1:, 3], own[:-1, 4])  # without a gap
    axes = Figure().add_subplot()
    made.draw(axes)
    assert [label.get_text() for label in axes.get_yticklabels()] == ["human", "robot"]
    assert any(text.get_text().startswith("cube") for text in axes.texts)
    assert "deadline" in axes.get_legend_handles_labels()[1]
    assert axis_titles(made) == ("time (s)", "") and axis_titles(None) == ("x (m)", "y (m)")
    assert made.bounds()[1] >= made.deadline and pickle.loads(pickle.dumps(made)).actions == made.actions


def test_without_the_truth_there_is_no_picture() -> None:
    env = WorkshopEnv(task="pile")
    assert run_episode(env, lidarena.baselines.make("greedy", env), 0, keep_picture=True).picture is None
