"""The estimators by name, and what else ``slam=`` takes.

A name, ``"module:callable"``, a class or function of one's own, or, to give it options, a dictionary of ``name`` and
the options, as in YAML: ``slam: {name: "my_slam:Estimator", gain: 2.0}``.
"""

from collections.abc import Callable, Mapping
from functools import partial
from inspect import Parameter, isclass, signature
from typing import Any

from lidarena.base.errors import ConfigError, EstimatorError, KeywordError, suggest
from lidarena.base.import_names import import_named
from lidarena.slam.estimator import BatchEstimator, EstimatorSettings
from lidarena.slam.world_estimators import WorldEstimators

BUILT_IN = {
    "rbpf": "lidarena.slam.rbpf.estimator:ParticleFilterEstimator",
    "graph": "lidarena.slam.graph.estimator:GraphEstimator",
    "odometry": "lidarena.slam.dead_reckoning:DeadReckoningEstimator",
    "truth": "lidarena.slam.true_pose:TruePoseEstimator",
}
"""What the package has, as ``"module:callable"``."""


def estimator_name(slam: Any) -> str:
    """Return what names an estimator: that of a dictionary, or of a class or function of one's own."""
    named = slam.get("name") if isinstance(slam, Mapping) else slam
    return named if isinstance(named, str) else str(getattr(named, "__name__", repr(named)))


def check_slam(slam: Any) -> None:
    """Refuse what cannot be made an estimator of.

    Raises:
        ConfigError: There is none of this name, or no such option; with the nearest right one.
    """
    maker, options = _maker_of(slam)
    if isinstance(slam, Mapping) or estimator_name(slam) not in BUILT_IN:
        _check_call(estimator_name(slam), maker, options)


def make_estimator(slam: Any, settings: EstimatorSettings) -> BatchEstimator:
    """Make the estimators of a batch.

    Args:
        slam: What the keyword ``slam`` takes.
        settings: What they are made for.

    Raises:
        ConfigError: As ``check_slam``, or an option out of range.
        EstimatorError: What is made is no estimator.
    """
    maker, options = _maker_of(slam)
    _check_call(estimator_name(slam), maker, options)
    if _is_batch(maker):
        made: BatchEstimator = maker(settings, **options)
        return made
    return WorldEstimators(settings, f"slam estimator {estimator_name(slam)!r}", partial(maker, **options))


def _maker_of(slam: Any) -> tuple[Callable[..., Any], dict[str, Any]]:
    """What is called to make an estimator, and the options that it is called with."""
    options: dict[str, Any] = {}
    if isinstance(slam, Mapping):
        if "name" not in slam:
            raise ConfigError(f"slam = {dict(slam)!r} needs a 'name' beside its options")
        options = {str(key): value for key, value in slam.items() if key != "name"}
        slam = slam["name"]
    if isinstance(slam, str):
        if ":" not in slam and slam not in BUILT_IN:
            raise ConfigError(f"slam = {slam!r} is not known{suggest(slam, BUILT_IN)}, or 'module:callable'")
        maker = import_named(BUILT_IN.get(slam, slam), f"slam = {slam!r}")
    else:
        maker = slam
    if not callable(maker):
        raise ConfigError(f"slam = {slam!r} must be a name, or a class or function that makes an estimator")
    return maker, options


def _is_batch(maker: Any) -> bool:
    return isclass(maker) and issubclass(maker, BatchEstimator)


def _check_call(name: str, maker: Callable[..., Any], options: Mapping[str, Any]) -> None:
    """Refuse options that it does not take, and what cannot be called with a ``ScanSpec``."""
    try:
        parameters = signature(maker).parameters
    except (TypeError, ValueError):  # compiled, and silent about what it takes
        return
    kinds = {parameter.kind for parameter in parameters.values()}
    allowed = [key for key, value in list(parameters.items())[1:] if value.kind in _BY_NAME]
    for key in options:
        if key not in allowed and Parameter.VAR_KEYWORD not in kinds:
            hint = suggest(key, allowed) if allowed else "; it has none"
            raise KeywordError(f"slam estimator {name!r} got an unexpected keyword argument {key!r}{hint}")
    try:
        signature(maker).bind(None, **options)
    except TypeError as error:
        shown = ", ".join(["lidar", *(f"{key}={value!r}" for key, value in options.items())])
        raise EstimatorError(f"slam estimator {name!r} cannot be made by a call ({shown}): {error}") from error


_BY_NAME = (Parameter.POSITIONAL_OR_KEYWORD, Parameter.KEYWORD_ONLY)
