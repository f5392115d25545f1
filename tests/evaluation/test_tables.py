"""Rounding, and the four forms of the table."""

import csv
import io
import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rich.console import Console

from lidarena.evaluation.measures import arena, corridor, exploration
from lidarena.evaluation.measures.table_columns import Measure
from lidarena.evaluation.statistics import Interval
from lidarena.evaluation.tables import PRINTED, csv_text, interval_text, latex_text, markdown_text, terminal_table
from tests.evaluation.rows import BY_NAME, row_of

N = 12
NOISE = np.random.default_rng(0).standard_normal(N)
ROWS = [
    row_of("random_walk", completeness=list(0.3 + 0.02 * NOISE), collision=[1] * N, path_length=list(2 + 0.1 * NOISE)),
    row_of("frontier", completeness=list(0.97 + 0.01 * NOISE), collision=[0] * N, path_length=list(30 + NOISE)),
    row_of("random_walk", "Env-2", completeness=[0.4], collision=[1], path_length=[3.0]),
]


@pytest.mark.parametrize(
    ("interval", "measure", "expected"),
    [
        ((25.0163, 23.9, 26.2), "path_length", ("25.0", "[23.9, 26.2]")),
        ((0.9732, 0.9581, 0.9847), "completeness", ("97.3", "[95.8, 98.5]")),
        ((0.9, 0.5958, 0.9821), "success", ("90", "[60, 98]")),
        ((0.00191286, 0.00185626, 0.002026), "d_optimality", ("1.913", "[1.856, 2.026]")),
        ((1234.5, 1100.0, 1380.0), "time", ("1234", "[1100, 1380]")),
        ((1.0, 1.0, 1.0), "completeness", ("100", "[100, 100]")),
        ((-0.0001, -3.0, 3.0), "return", ("0.0", "[−3.0, 3.0]")),
        ((25.0163, math.nan, math.nan), "path_length", ("25.0", "")),
        ((math.nan, math.nan, math.nan), "path_length", ("–", "")),
        ((0.0, 0.0, 0.0), "path_length", ("0", "[0, 0]")),
    ],
)
def test_rounding(interval: tuple[float, float, float], measure: str, expected: tuple[str, str]) -> None:
    assert interval_text(Interval(*interval), BY_NAME[measure]) == expected


@given(st.floats(-1e5, 1e5), st.floats(1e-3, 1e4), st.floats(1e-3, 1e4))
def test_rounding_loses_little_of_the_interval(mean: float, below: float, above: float) -> None:
    interval = Interval(mean, mean - below, mean + above)
    text, bounds = interval_text(interval, BY_NAME["return"], signed=True)
    numbers = [float(part.replace("−", "-")) for part in (text, *bounds.strip("[]").split(", "))]
    half = (below + above) / 2
    assert np.allclose(numbers, interval, atol=max(0.06 * half, 0.51 if half >= 10 else 0, 6e-4))
    assert all(sign in "+−0" for sign in (text[0], bounds[1]))


def test_csv_reads_back_unrounded() -> None:
    lines = list(csv.DictReader(io.StringIO(csv_text(ROWS))))
    assert len(lines) == 9
    path = next(line for line in lines if line["policy"] == "frontier" and line["measure"] == "path_length")
    assert float(path["mean"]) == ROWS[1].metrics["path_length"].interval.mean
    assert (path["unit"], path["episodes"], path["env"]) == ("m", "12", "Env-1")
    assert lines[-1]["ci_low"] == "" and float(lines[-1]["mean"]) == 3.0


def test_markdown_shows_units_bold_and_differences() -> None:
    text = markdown_text(ROWS)
    assert "## Env-1 (12 episodes)" in text and "## Env-2 (1 episode)" in text
    assert "| Policy | Explored (%) ↑ | Collisions (%) ↓ | Path (m) ↓ |" in text
    assert "| random\\_walk | 30" in text  # Markdown must not make the name italic
    frontier = next(line for line in text.splitlines() if line.startswith("| frontier |"))
    assert "**97" in frontier and "**0** [0, 24]" in frontier and "**30" in frontier
    assert "Difference from random\\_walk, seed by seed:" in text
    last = [line for line in text.splitlines() if line.startswith("| frontier |")][-1]
    assert "| +" in last and last.endswith("| – |")  # the paths of unequal explorers are not compared
    assert "Path is compared only among policies whose 'Explored' cannot be told from the best" in text
    widths = [line.count(" | ") for line in text.splitlines() if line.startswith("|")]
    assert set(widths) == {3}


def test_latex_is_balanced_and_escaped() -> None:
    text = latex_text(ROWS)
    assert text.count("{") == text.count("}") and text.count("$") % 2 == 0
    assert r"random\_walk" in text and r"Explored (\%) $\uparrow$" in text and r"\textbf{97" in text
    body = [line for line in text.splitlines() if line.endswith(r"\\")]
    assert {line.count("&") for line in body} == {4} and len(body) == 4
    assert r"\begin{tabular}{llrrr}" in text and text.isascii()


def test_latex_escapes_whatever_a_name_holds() -> None:
    text = latex_text([row_of("a&b%c$d#e_f{g}h~i^j\\k", time=[1.0, 2.0])])
    assert r"a\&b\%c\$d\#e\_f\{g\}h\textasciitilde{}i\textasciicircum{}j\textbackslash{}k" in text


@pytest.mark.parametrize("width", [60, 80, 200])
def test_the_terminal_table_fits(width: int) -> None:
    console = Console(width=width, record=True, file=io.StringIO())
    console.print(terminal_table(ROWS, width))
    text = console.export_text()
    assert "Env-1 · 12 episodes each" in text and "(m) ↓" in text
    assert ("30.02 [29.63, 30.43]" in text) == (width > 60)
    assert max(len(line) for line in text.splitlines()) <= width
    assert "…" not in text


def test_six_measures_of_policies_with_long_names_fit_a_small_terminal() -> None:
    names = [measure.name for measure in BY_NAME.values() if measure.main and measure in exploration.MEASURES.table]
    values = {name: list(30 + NOISE) for name in names if name != "collision"} | {"collision": [0.0] * N}
    console = Console(width=80, record=True, file=io.StringIO())
    console.print(terminal_table([row_of(name, **values) for name in ("frontier", "distance_advantage")], 80))
    text = console.export_text()
    assert "distance_advantage" in text and "D-optimality" in text and "±" in text and "[" not in text
    assert len(names) == 6


def test_no_more_than_six_measures_are_printed() -> None:
    columns = tuple(Measure(f"m{k}", f"M{k}", main=True) for k in range(9))
    console = Console(width=200, record=True, file=io.StringIO())
    console.print(terminal_table([row_of("one", columns=columns, **{f"m{k}": [1.0] for k in range(9)})], 200))
    text = console.export_text()
    assert "M5" in text and "M6" not in text


@pytest.mark.parametrize("module", [arena, corridor, exploration])
def test_no_family_has_more_main_measures_than_are_printed(module: Any) -> None:
    assert len([measure for measure in module.MEASURES.table if measure.main]) <= PRINTED


def test_names_are_not_markup() -> None:
    console = Console(width=120, record=True, file=io.StringIO())
    console.print(terminal_table([row_of("[red]x", "[bold]", time=[1.0, 2.0])], 120))
    assert "[red]x" in console.export_text(clear=False) and "[bold]" in console.export_text()


def test_every_measure_has_a_heading_of_its_own() -> None:
    headings = [measure.heading for measure in BY_NAME.values()]
    assert len(set(headings)) == len(headings)
