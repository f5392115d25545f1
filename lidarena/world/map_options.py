"""The seed and the options that stand in a map's name, such as ``"maze:7?width=10&loops=0.2"``."""

from urllib.parse import parse_qsl

from lidarena.base.errors import MapError, suggest


def read_seed(spec: str, text: str, example: str) -> int:
    """Return the whole number in a spec such as ``"maze:7"``.

    Raises:
        MapError: It is none.
    """
    if not (text.isascii() and text.isdecimal() and len(text) < 20):
        raise MapError(f"map {spec!r} has seed {text!r}; a whole number is needed, as in {example!r}")
    return int(text)


def read_options(spec: str, text: str, allowed: list[str]) -> dict[str, float]:
    """Return the numbers of ``key=value&key=value``.

    Raises:
        MapError: A key is not allowed or given twice, or a value is no number.
    """
    try:
        pairs = parse_qsl(text, keep_blank_values=True, strict_parsing=bool(text))
    except ValueError as error:
        raise MapError(f"map {spec!r} has options {text!r}; they are written as in '?key=1.5&key=2'") from error
    values: dict[str, float] = {}
    for key, value in pairs:
        if key not in allowed:
            raise MapError(f"map {spec!r} has no option {key!r}{suggest(key, allowed)}")
        if key in values:
            raise MapError(f"map {spec!r} gives {key!r} twice; once is allowed")
        try:
            values[key] = float(value)
        except ValueError as error:
            raise MapError(f"map {spec!r} has {key} {value!r}; a number is needed") from error
    return values
