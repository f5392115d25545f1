"""A vehicle goes on from its arrays to the bit, and knows how unsure it is."""

import numpy as np

from lidarena.envs.seabed.options import SeabedOptions
from lidarena.envs.seabed.state import Vehicle
from tests.envs.seabed.short_flights import SHORT


def begun() -> Vehicle:
    vehicle = Vehicle(SeabedOptions.checked(SHORT))
    vehicle.begin(np.random.default_rng(0), None)
    return vehicle


def test_it_goes_on_from_its_arrays_to_the_bit() -> None:
    one, two = begun(), begun()
    one.step(20, "plain")
    one.step(10, "six_clouds")
    two.load_arrays({name: array.copy() for name, array in one.arrays().items()})
    for vehicle in (one, two):
        vehicle.step(20, "six_clouds_to_middle")
    for name, array in one.arrays().items():
        assert np.array_equal(array, two.arrays()[name]), name


def test_it_grows_less_sure_and_looks_ahead() -> None:
    vehicle = begun()
    assert vehicle.uncertainty.tolist() == [0.0, 0.0] and np.isnan(vehicle.nees)
    spreads = []
    for _ in range(3):
        vehicle.step(20, "plain")
        spreads.append(float(vehicle.uncertainty[0]))
    assert 0.0 < spreads[0] < spreads[1] < spreads[2] < 0.1 and 0.0 < vehicle.nees < 200.0
    assert 0.2 < vehicle.speed < 0.8 and 0.5 < vehicle.overlap < 1.0 and vehicle.turn_rate < 0.5
    assert np.allclose(vehicle.planar, vehicle.scene.flight.planar[60], atol=0.02)


def test_after_the_end_nothing_more_is_done() -> None:
    vehicle = begun()
    for _ in range(3):
        vehicle.step(50, "plain")
    cost, frames = vehicle.cost, list(vehicle.frames)
    assert frames[-1] == vehicle.last_frame == 100
    vehicle.step(50, "six_clouds")
    assert vehicle.cost == cost and vehicle.frames == frames and vehicle.spent == vehicle.drift == 0.0


def test_a_frame_is_paid_for_once() -> None:
    vehicle = begun()
    vehicle.step(20, "plain")
    first = vehicle.spent
    vehicle.step(20, "six_clouds")
    assert vehicle.spent > 2.0 * first and vehicle.cost > first


def test_what_was_refused_is_not_tried_again_from_there() -> None:
    vehicle = Vehicle(SeabedOptions.checked(SHORT | {"least_matches": 5000}))
    vehicle.begin(np.random.default_rng(0), None)
    tried = []
    plain, six = "plain", "six_clouds"
    for skip, mode in ((40, six), (40, plain), (40, plain), (10, six), (20, plain), (40, plain), (40, plain)):
        vehicle.step(skip, mode)
        tried.append(vehicle.skip)
    assert vehicle.refused and vehicle.frame == 0
    assert tried == [40, 40, 20, 10, 10, 5, 40]  # where even the shortest is refused, all may be tried


def test_a_limit_ends_with_a_fine_step_and_comes_along_in_the_arrays() -> None:
    vehicle, other = begun(), begun()
    vehicle.refused_from[:] = 20.0, 10.0
    other.load_arrays(vehicle.arrays())
    for one in (vehicle, other):
        one.step(20, "plain")
        assert one.frame == one.skip == 10 and np.isinf(one.refused_from).all()


def test_of_both_scenes_one_is_drawn_and_comes_along_in_the_arrays() -> None:
    options = SeabedOptions.checked(SHORT | {"scene": "both", "duration": None})
    vehicle, rng, kinds = Vehicle(options), np.random.default_rng(2), set()
    for _ in range(8):
        vehicle.begin(rng, None)
        kinds.add(vehicle.kind)
    assert kinds == set(options.kinds)
    other = Vehicle(options)
    other.begin(np.random.default_rng(5), None)
    other.load_arrays(vehicle.arrays())
    assert other.kind == vehicle.kind and other.last_frame == vehicle.last_frame
