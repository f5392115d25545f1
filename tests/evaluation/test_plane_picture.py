"""The plane explains itself to a stranger, and its names do not cover each other."""

from pathlib import Path

import numpy as np
import pytest
from matplotlib.figure import Figure
from PIL import Image

from lidarena.evaluation.plane import planes_of, pooled
from lidarena.evaluation.plane_picture import draw_plane, draw_planes
from tests.evaluation.test_plane import MEANS, POLICIES, row, rows_in


def test_one_picture_of_all_and_one_of_each(tmp_path: Path) -> None:
    planes = planes_of([*rows_in("Env-2"), *rows_in("mazes", 2.0)], POLICIES)
    paths = draw_planes(planes, pooled(planes, "frontier"), tmp_path)
    assert [path.relative_to(tmp_path).as_posix() for path in paths] == [
        "plane.png",
        "planes/Env-2.png",
        "planes/mazes.png",
    ]
    for path in paths:
        with Image.open(path) as image:
            assert image.width > 800 and image.convert("L").entropy() > 0.5
    assert draw_planes([], None, tmp_path / "none") == [] and not (tmp_path / "none").exists()


def test_of_one_environment_there_is_one_picture(tmp_path: Path) -> None:
    planes = planes_of(rows_in("Env-2"), POLICIES)
    assert [path.name for path in draw_planes(planes, None, tmp_path)] == ["plane.png"]


def texts(figure: Figure) -> list[str]:
    axes = figure.axes[0]
    return [text.get_text() for text in (*axes.texts, *figure.legends[0].get_texts())]


def test_it_explains_itself() -> None:
    [plane] = planes_of(rows_in("Env-2"), POLICIES)
    figure = draw_plane(plane)
    axes = figure.axes[0]
    assert "Path (m)" in axes.get_xlabel() and "D-optimality per metre (10⁻³)" in axes.get_ylabel()
    assert "12 episodes, the same for all; means with 95% intervals" in axes.get_title()
    assert axes.get_xscale() == axes.get_yscale() == "log"
    assert {"frontier", "nearest_frontier", "0", "1", "explores less than the others"} <= set(texts(figure))
    assert "combined: one trained agent, its preference beside each point" in texts(figure)
    assert "what the rules reach, and mixtures of them" in texts(figure)


def test_names_do_not_cover_each_other() -> None:
    [plane] = planes_of(rows_in("Env-2"), POLICIES)
    figure = draw_plane(plane)
    figure.draw_without_rendering()
    boxes = [text.get_window_extent() for text in figure.axes[0].texts]
    assert not any(a.overlaps(b) for k, a in enumerate(boxes) for b in boxes[:k])


@pytest.mark.parametrize(("low", "high"), [(0.2, 0.25), (10, 11), (1, 1000), (0.014, 0.3)])
def test_axes_have_ticks_whatever_they_span(low: float, high: float) -> None:
    means = dict.fromkeys(MEANS, (low, low)) | {"frontier": (high, high)}
    [plane] = planes_of([row(p.title, "Env", *means[p.title], np.ones(6)) for p in POLICIES], POLICIES)
    axes = draw_plane(plane).axes[0]
    for ticks, (begin, end) in ((axes.get_xticks(), axes.get_xlim()), (axes.get_yticks(), axes.get_ylim())):
        assert sum(begin <= tick <= end for tick in ticks) >= 3


def test_few_episodes_and_equal_policies_are_drawn_too() -> None:
    same = dict.fromkeys(MEANS, (10.0, 2.0)) | {"idle": (10.0, 2.1)}
    [plane] = planes_of([row(p.title, "Env", *same[p.title], np.ones(1)) for p in POLICIES], POLICIES)
    figure = draw_plane(plane)
    assert "one episode" in figure.axes[0].get_title() and "interval" not in figure.axes[0].get_title()
