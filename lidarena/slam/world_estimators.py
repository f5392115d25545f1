"""Estimators that know one world each, in plain NumPy, as a batch: what a ``WorldEstimator`` is plugged in with."""

from collections.abc import Callable
from inspect import signature
from typing import Any

import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import EstimatorError
from lidarena.base.generator_state import generator_from_words, generator_words
from lidarena.base.jit import leaf
from lidarena.slam.estimator import (
    BatchEstimator,
    EstimatorSettings,
    Floats,
    MapGrid,
    ScanSpec,
    WorldEstimator,
)
from lidarena.slam.readings import Share, next_world
from lidarena.slam.uncertainty import COVARIANCE_FLOOR, d_optimality
from lidarena.world.odometry import wrap
from lidarena.world.sensors import Sensing, sense

_METHODS = {"reset": ("pose", "grid"), "update": ("odometry", "scan", "time")}


class WorldEstimators(BatchEstimator):
    """One ``WorldEstimator`` for each world; sensors are read on all threads, estimating is done on the caller's.

    Args:
        settings: What it is made for.
        name: How the estimator is called in messages.
        make: Makes one for a ``ScanSpec``.

    Raises:
        EstimatorError: What was made is no estimator.
    """

    def __init__(self, settings: EstimatorSettings, name: str, make: Callable[[ScanSpec], WorldEstimator]) -> None:
        super().__init__(settings)
        self._name = name
        cos, sin = settings.directions
        lidar = settings.lidar
        self.spec = ScanSpec(np.arctan2(sin, cos), lidar.max_range, lidar.noise, lidar.min_range)
        self.each = [make(self.spec) for _ in range(settings.worlds)]
        self._check_each()
        self._draws = _draws(self.each[0].reset)
        self._generators = [np.random.default_rng(0) for _ in range(settings.worlds)] if self._draws else []
        self._updates = np.zeros(settings.worlds, np.int64)
        self.restorable = all(callable(getattr(self.each[0], name, None)) for name in ("get_state", "set_state"))

    def _check_each(self) -> None:
        """Refuse what lacks a method, or is the same object for two worlds."""
        if len({id(one) for one in self.each}) < len(self.each):
            raise EstimatorError(f"{self._name} made the same object for two worlds; each needs one of its own")
        for method, names in _METHODS.items():
            found, shown = getattr(self.each[0], method, None), f"{method}({', '.join(names)})"
            if not callable(found):
                raise EstimatorError(f"{self._name} made {_kind(self.each[0])}, which has no method {shown}")
            own = {"rng": None} if method == "reset" and _draws(found) else {}
            try:
                signature(found).bind(*names, **own)
            except TypeError as error:
                raise EstimatorError(f"{self._name} has a method {method} that cannot be called as {shown}") from error

    def start(self, world: int, plan: int, origin: Floats, pose: Floats, rng: np.random.Generator) -> None:
        """Reset one world's estimator; one that asks for a generator gets its own, seeded from the world's."""
        super().start(world, plan, origin, pose, rng)
        if self._draws:
            self._generators[world] = np.random.default_rng(int(rng.integers(2**63)))
        self._updates[world] = 0
        self._reset(world)

    def _reset(self, world: int) -> None:
        grid = MapGrid(self.maps.origin[world].copy(), self.settings.resolution, self.maps.occupancy.shape[1:])
        own: dict[str, Any] = {"rng": self._generators[world]} if self._draws else {}
        self.each[world].reset(self.estimate[world].copy(), grid, **own)

    def sense_and_estimate(self, sensing: Sensing, share: Share) -> None:
        """Read the sensors of world after world."""
        sense_only(sensing, share)

    def finish(self, sensing: Sensing, first: int, last: int, active: NDArray[np.bool_]) -> None:
        """Tell the estimators of the active worlds what was measured, and take over what they believe."""
        for world in (first + np.flatnonzero(active[first:last])).tolist():
            begins = self._updates[world] == 0
            reading = np.zeros(3) if begins else sensing.sensors.readings[world, 0].copy()
            time = float(self._updates[world]) * sensing.period
            scan = sensing.sensors.scans[world, 0]
            self.each[world].update(reading, scan.copy() if sensing.sensors.fresh[world] else np.zeros_like(scan), time)
            self._updates[world] += 1
            self._take_over(world)

    def _take_over(self, world: int) -> None:
        """Copy one world's belief into the batch, once it is found to be one."""
        x, y, theta = self._numbers(world, "pose", (3,)).tolist()
        self.estimate[world] = x, y, wrap(theta)
        covariance = self._numbers(world, "covariance", (3, 3))
        symmetric = np.allclose(covariance, covariance.T, rtol=1e-6, atol=1e-12)
        if not symmetric or (np.diag(covariance) < 0.0).any():
            shown = covariance.tolist()
            raise EstimatorError(f"{self._name}: covariance = {shown} is not symmetric with a diagonal of at least 0")
        self.covariance[world] = covariance + np.diag(COVARIANCE_FLOOR)
        self.d_optimality[world] = d_optimality(self.covariance[world])
        cells = self._map(world)
        self.maps.occupancy[world] = cells
        wanted = self.maps.wanted[self.maps.plan[world]]
        self.maps.covered[world] = np.count_nonzero((cells >= 0) & (wanted > 0))

    def _numbers(self, world: int, attribute: str, shape: tuple[int, ...]) -> NDArray[np.float64]:
        """One of an estimator's attributes as finite numbers of a shape."""
        value = self._attribute(world, attribute)
        try:
            array = np.asarray(value, dtype=np.float64)
        except (TypeError, ValueError) as error:
            raise EstimatorError(f"{self._name}: {attribute} = {value!r} must be numbers of shape {shape}") from error
        if array.shape != shape:
            raise EstimatorError(f"{self._name}: {attribute} has the shape {array.shape}, not {shape}")
        if not np.isfinite(array).all():
            raise EstimatorError(f"{self._name}: {attribute} = {array.tolist()} is not finite")
        return array

    def _map(self, world: int) -> NDArray[Any]:
        """The map of one world's estimator, with nothing in it but -1, 0 and 100."""
        cells, shape = np.asarray(self._attribute(world, "map")), self.maps.occupancy.shape[1:]
        if cells.shape != shape:
            raise EstimatorError(f"{self._name}: map has the shape {cells.shape}, not {shape} as the grid")
        strange = (cells != -1) & (cells != 0) & (cells != 100)
        if strange.any():
            allowed = "-1 (unknown), 0 (free) and 100 (occupied) are allowed"
            raise EstimatorError(f"{self._name}: map has a cell {cells[strange][0]}; {allowed}")
        return cells

    def _attribute(self, world: int, attribute: str) -> Any:
        if not hasattr(self.each[world], attribute):
            raise EstimatorError(f"{self._name} has no attribute {attribute!r} after update()")
        return getattr(self.each[world], attribute)

    def arrays(self) -> dict[str, NDArray[Any]]:
        """The beliefs, and what each estimator's ``get_state`` gives.

        Raises:
            EstimatorError: It has no ``get_state`` and ``set_state``, or gives no arrays.
        """
        if not self.restorable:
            raise EstimatorError(f"{self._name} has no get_state() and set_state(), so its worlds cannot be saved")
        named = self._own_arrays()
        for world, one in enumerate(self.each):
            state = one.get_state()  # type: ignore[attr-defined]
            if not isinstance(state, dict) or not all(isinstance(name, str) for name in state):
                raise EstimatorError(f"{self._name}: get_state() must return a dictionary of arrays by name")
            named |= {f"own.{world}.{name}": self._storable(name, value) for name, value in state.items()}
        return named

    def _own_arrays(self) -> dict[str, NDArray[Any]]:
        named = super().arrays() | {"updates": self._updates}
        for unused in ("maps.visits", "maps.hits"):
            del named[unused]
        if self._draws:
            named["own_generators"] = np.stack([generator_words(rng) for rng in self._generators])
        return named

    def _storable(self, name: str, value: Any) -> NDArray[Any]:
        array = np.array(value)
        if array.dtype.kind not in "biuf":
            raise EstimatorError(f"{self._name}: get_state()[{name!r}] = {value!r} is no array of numbers")
        return array

    def load_arrays(self, saved: dict[str, NDArray[Any]]) -> None:
        """Continue from the arrays of another batch of the same estimators: reset each, then hand it its state."""
        for name, array in self._own_arrays().items():
            array[...] = saved[name]
        for world, one in enumerate(self.each):
            if self._draws:
                self._generators[world] = generator_from_words(saved["own_generators"][world])
            self._reset(world)
            prefix = f"own.{world}."
            state = {name.removeprefix(prefix): saved[name].copy() for name in saved if name.startswith(prefix)}
            one.set_state(state)  # type: ignore[attr-defined]
            if self._draws:  # reset may have drawn from it
                words = generator_from_words(saved["own_generators"][world])
                self._generators[world].bit_generator.state = words.bit_generator.state


def _draws(reset: Callable[..., Any]) -> bool:
    """Whether a ``reset`` asks for a generator."""
    return "rng" in signature(reset).parameters


def _kind(thing: Any) -> str:
    return "None" if thing is None else f"a {type(thing).__name__}"


@leaf
def sense_only(sensing: Sensing, share: Share) -> None:
    """Read the sensors of world after world."""
    w = next_world(share)
    while w < share.last:
        sense(w, sensing)
        w = next_world(share)
