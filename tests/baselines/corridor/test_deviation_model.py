"""The model of how robots stray: what is recorded is what is fitted, and risk falls with distance."""

import itertools

import numpy as np
import pytest

from lidarena.base.errors import ConfigError
from lidarena.baselines.corridor.deviation_model import BIN, DeviationModel, shipped_model


def test_the_fit_is_a_density_near_the_histogram():
    distances = np.random.default_rng(0).exponential(0.05, 20_000)
    model = DeviationModel.fitted(distances, 28)
    at = np.linspace(0.0, 2.0, 20_001)
    assert np.trapezoid(model.density(at), at) == pytest.approx(1.0, abs=1e-3)
    centres = (np.arange(6) + 0.5) * BIN
    assert model.density(centres) == pytest.approx(np.exp(-centres / 0.05) / 0.05, rel=0.3)
    assert (model.knots[:, 1] >= 0).all() and model.counts.sum() == 20_000


def test_the_risk_falls_from_certain_to_none():
    model = DeviationModel.fitted(np.random.default_rng(1).exponential(0.05, 5_000), 28)
    risks = [model.risk(gap, 0.4) for gap in (0.0, 0.3, 0.4, 0.5, 0.7, 5.0)]
    assert risks[0] == pytest.approx(1.0, abs=0.02) and risks[-1] == 0.0
    assert all(before >= after for before, after in itertools.pairwise(risks))
    assert risks[2] == pytest.approx(0.5, abs=0.1)  # robots planned to touch do so about every other time


def test_costs_are_what_the_planner_takes():
    table = shipped_model().costs(0.2, 0.4)
    assert table[0, 0] == 0.0 and (np.diff(table[:, 0]) > 0).all() and table[-1, 1] == 0.0
    assert table[:, 1].max() <= 64.0
    at_two_cells = table[table[:, 0] == 2.0, 1][0]
    assert 5.0 < at_two_cells < 40.0


def test_a_model_survives_its_file(tmp_path):
    model = shipped_model()
    model.save(tmp_path / "model.json")
    again = DeviationModel.load(tmp_path / "model.json")
    assert np.array_equal(again.knots, model.knots) and np.array_equal(again.counts, model.counts) and again.runs == 28


def test_bad_files_and_too_few_distances_are_refused(tmp_path):
    with pytest.raises(ConfigError, match="is no deviation model"):
        DeviationModel.load(tmp_path / "missing.json")
    (tmp_path / "torn.json").write_text('{"runs": 1')
    with pytest.raises(ConfigError, match="is no deviation model"):
        DeviationModel.load(tmp_path / "torn.json")
    with pytest.raises(ConfigError, match="too few"):
        DeviationModel.fitted([0.1], 1)
