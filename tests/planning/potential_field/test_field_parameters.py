import dataclasses
import warnings

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lidarena.base.errors import ConfigError
from lidarena.planning.potential_field.field_parameters import (
    PRESETS,
    FieldParameters,
    FieldWarning,
    field_parameters,
    largest_gain_ratio,
    least_gain_ratio,
)
from lidarena.planning.potential_field.potential_field import plan_path
from tests.planning.potential_field.circle_scenes import GOAL, PRINTED


def test_the_paper_preset_holds_the_printed_numbers():
    p = PRESETS["paper"]
    printed = dict(k=1.0, eta=1.0, n=2.0, rho_0=8.0, rho_1=8.0, s=0.5, h_0=1.5, gamma=0.1)
    assert {name: getattr(p, name) for name in printed} == printed
    assert p.trap_test == "equal" and p.fill_shape == "reciprocal" and p.attempts == 1 and p.ways == 1


@given(st.floats(0.05, 20), st.floats(0.01, 0.99))
def test_eq_13_is_the_largest_value_of_eq_12(rho_0, share):
    searched = largest_gain_ratio(rho_0, share * rho_0, 2.0)
    assert searched == pytest.approx(least_gain_ratio(rho_0, share * rho_0), rel=2e-3, abs=1e-6 / rho_0**2)


def test_eq_13_ends_where_the_obstacle_does_not_reach():
    assert least_gain_ratio(8.0, 8.0) == least_gain_ratio(8.0, 9.0) == largest_gain_ratio(8.0, 9.0, 3.0) == 0.0
    assert least_gain_ratio(8.0, 7.999999) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize(("preset", "eta"), [("paper", 1e5), ("robust", 1e7)])
@pytest.mark.parametrize("n", [2.0, 2.5])
def test_breaking_the_bound_is_named(preset, eta, n):
    with pytest.warns(FieldWarning, match=r"k/eta = .* breaks the bound of eq\. 13"):
        plan_path(PRINTED, (0, 0), GOAL, preset, eta=eta, n=n, max_steps=10)


@pytest.mark.parametrize("preset", sorted(PRESETS))
def test_presets_keep_the_bound(preset):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        plan_path(PRINTED, (0, 0), GOAL, preset, max_steps=10)


def test_the_bound_tells_where_a_second_minimum_begins():
    for eta, trapped in ((0.9, False), (1.1, True)):
        gain = eta / least_gain_ratio(1.5, 0.5)
        with warnings.catch_warnings(record=True) as said:
            warnings.simplefilter("always")
            result = plan_path(
                [[0.5, 0, 0]], (-4, 0), (0, 0), "paper", rho_0=1.5, eta=gain, fill_shape="none", gamma=0.001,
                arrival_radius=0.001, trap_test="window",
            )  # fmt: skip
        assert result.success is not trapped
        assert bool(said) is trapped


NUMBERS = [f.name for f in dataclasses.fields(FieldParameters) if isinstance(f.default, float)]
WHOLE = ["max_steps", "attempts", "ways"]


@pytest.mark.parametrize("name", NUMBERS)
@pytest.mark.parametrize("value", [0.0, -1.0, float("nan"), float("inf"), "1", True, [1.0]])
def test_a_number_that_has_no_meaning_is_refused(name, value):
    with pytest.raises(ConfigError, match=f"{name} = .*a finite number above 0 is needed"):
        field_parameters("robust", **{name: value})


@pytest.mark.parametrize("name", [*WHOLE, "seed", "max_fills"])
@pytest.mark.parametrize("value", [-1, 1.5, float("nan"), "2", True])
def test_a_count_must_be_whole(name, value):
    with pytest.raises(ConfigError, match=f"{name} = .*a whole number"):
        field_parameters("paper", **{name: value})


@pytest.mark.parametrize("name", WHOLE)
def test_a_count_of_none_is_refused(name):
    with pytest.raises(ConfigError, match=name):
        field_parameters("paper", **{name: 0})


@pytest.mark.parametrize(
    ("overrides", "says"),
    [
        ({"guard": 1}, "guard = 1; True or False"),
        ({"trap_test": "windows"}, "did you mean 'window'"),
        ({"fill_shape": "cone"}, "cone.*Allowed: bump"),
        ({"rho0": 3.0}, "no parameter 'rho0'; did you mean 'rho_0'"),
        ({"arrival_radius": 0.01}, "gamma / 2"),
        ({"k": None}, "k = None"),
        ({"ways": 4}, "ways = 4; a whole number from 1 to 3"),
    ],
)
def test_other_bad_parameters_are_refused_in_a_sentence(overrides, says):
    with pytest.raises(ConfigError, match=says) as refusal:
        field_parameters("robust", **overrides)
    assert "\n" not in str(refusal.value)


def test_unknown_presets_are_refused():
    with pytest.raises(ConfigError, match="did you mean 'robust'"):
        field_parameters("robsut")
    with pytest.raises(ConfigError, match=r"preset .*'paper'.* is not known"):
        field_parameters(["paper"])


def test_the_balance_is_where_the_docstring_says():
    p = PRESETS["robust"]
    rho = 1.4 * p.h_0
    assert p.repulsion_gain() * (1 / rho - 1 / p.rho_0) / rho**2 == pytest.approx(p.k * p.d_0)


def test_a_scale_leaves_what_was_given():
    p = field_parameters("robust", gamma=0.2, arrival_radius=0.2).fitted(0.1, {"gamma": 0.2, "arrival_radius": 0.2})
    assert (p.gamma, p.arrival_radius) == (0.2, 0.2)
    np.testing.assert_allclose((p.rho_0, p.h_0, p.rho_1, p.d_0), (0.8, 0.15, 0.8, 0.8))
    assert PRESETS["paper"].fitted(0.1, {}) is PRESETS["paper"]


def test_tightening_opens_gaps():
    p = PRESETS["robust"].tightened(1 / 32)
    assert p.h_0 == pytest.approx(1.5 / 32) and p.rho_0 == 0.25 and p.gamma == p.h_0 / 2
