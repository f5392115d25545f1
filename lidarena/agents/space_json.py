"""Gymnasium spaces as plain JSON and back, for policy files."""

import math
from typing import Any

import numpy as np
from gymnasium import spaces
from numpy.typing import NDArray

from lidarena.base.errors import PolicyFileError

_MOST_NUMBERS = 100_000_000


def to_json(space: spaces.Space[Any]) -> dict[str, Any]:
    """Describe a space.

    Args:
        space: `Box`, `Discrete`, `MultiDiscrete`, `MultiBinary`, or a `Dict` of these.

    Returns:
        Lists, texts and numbers that `json.dumps` takes; infinite bounds are the texts ``"inf"`` and ``"-inf"``.

    Raises:
        PolicyFileError: The space is of another kind.
    """
    if isinstance(space, spaces.Dict):
        return {"type": "Dict", "spaces": {str(key): to_json(sub) for key, sub in space.spaces.items()}}
    if isinstance(space, spaces.Box):
        bounds = {"low": _bound(space.low), "high": _bound(space.high)}
        return {"type": "Box", "shape": list(space.shape), "dtype": str(space.dtype), **bounds}
    if isinstance(space, spaces.Discrete):
        return {"type": "Discrete", "n": int(space.n), "start": int(space.start)}
    if isinstance(space, spaces.MultiDiscrete):
        return {"type": "MultiDiscrete", "nvec": space.nvec.tolist()}
    if isinstance(space, spaces.MultiBinary):
        return {
            "type": "MultiBinary",
            "n": int(space.n) if isinstance(space.n, int | np.integer) else list(space.shape),
        }
    raise PolicyFileError(f"a space of type {type(space).__name__} cannot be written to a policy file")


def from_json(description: dict[str, Any]) -> spaces.Space[Any]:
    """Make the space that `to_json` described.

    Raises:
        PolicyFileError: The description is none.
    """
    try:
        return _make(description)
    except (KeyError, TypeError, ValueError, AssertionError, OverflowError, AttributeError, RecursionError):
        raise PolicyFileError(f"{str(description)[:80]!r} describes no space") from None


def _make(description: dict[str, Any]) -> spaces.Space[Any]:
    match description["type"]:
        case "Dict":
            return spaces.Dict({key: _make(sub) for key, sub in description["spaces"].items()})
        case "Box":
            shape = _shape(description["shape"])
            dtype = np.dtype(description["dtype"])
            if dtype.kind not in "biuf":
                raise ValueError("not a number type")
            low, high = (np.asarray(description[key], dtype=np.float64).astype(dtype) for key in ("low", "high"))
            return spaces.Box(np.broadcast_to(low, shape), np.broadcast_to(high, shape), dtype=dtype.type)
        case "Discrete":
            return spaces.Discrete(int(description["n"]), start=int(description["start"]))
        case "MultiDiscrete":
            return spaces.MultiDiscrete(np.asarray(description["nvec"], dtype=np.int64))
        case "MultiBinary":
            n = description["n"]
            return spaces.MultiBinary(_shape(n) if isinstance(n, list) else _shape([n])[0])
    raise ValueError("unknown type")


def _shape(sizes: list[int]) -> tuple[int, ...]:
    shape = tuple(int(size) for size in sizes)
    if math.prod(shape) > _MOST_NUMBERS or min(shape, default=1) < 0:
        raise ValueError("too large")
    return shape


def _bound(values: NDArray[Any]) -> Any:
    """One number if all are equal, else nested lists."""
    same = values.size > 0 and bool((values == values.flat[0]).all())
    return _finite(values.flat[0].item() if same else values.tolist())


def _finite(value: Any) -> Any:
    if isinstance(value, list):
        return [_finite(item) for item in value]
    return str(value) if isinstance(value, float) and math.isinf(value) else value
