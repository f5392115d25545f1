"""The plainStnu text of the CSTNU Tool and its generator: names, edges ``U w V``, contingent links ``A x y C``."""

from collections.abc import Iterator
from pathlib import Path

from lidarena.base.errors import TemporalError
from lidarena.base.files import write_text
from lidarena.temporal.edges import shown
from lidarena.temporal.stn import STN
from lidarena.temporal.stnu import STNU

_HEADINGS = (
    "KIND OF NETWORK",
    "Num Time-Points",
    "Num Ordinary Edges",
    "Num Contingent Links",
    "Time-Point Names",
    "Ordinary Edges",
    "Contingent Links",
)


def read_plain_stnu(path: str | Path, *, origin: str | None = "Z") -> STNU:
    """Read a network in plainStnu text.

    Args:
        path: The file.
        origin: The point before all others, where the network has one of that name (the format implies it); None if no
            point is.

    Returns:
        The network, named after the file.

    Raises:
        TemporalError: The file is missing, torn, or no such text; the message says where.
    """
    try:
        text = Path(path).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise TemporalError(f"{str(path)!r} cannot be read as plainStnu text: {error}") from error
    return parse_plain_stnu(text, name=Path(path).stem, origin=origin, source=str(path))


def parse_plain_stnu(text: str, *, name: str = "", origin: str | None = "Z", source: str = "the text") -> STNU:
    """Read a network from plainStnu text, like `read_plain_stnu`.

    Raises:
        TemporalError: It is torn or no such text; the message says where, in ``source``.
    """
    sections = _sections(text, source)
    names = [point for _, words in sections["Time-Point Names"] for point in words]
    network = STNU(names, name=name)
    edges, links = sections["Ordinary Edges"], sections.get("Contingent Links", [])
    for title, found in (("Time-Points", len(names)), ("Ordinary Edges", len(edges)), ("Contingent Links", len(links))):
        _check_count(sections.get(f"Num {title}"), found, title, source)
    for where, words in edges:
        tail, weight, head = _row(words, 3, "U weight V", where)
        network.add_requirement(tail, head, upper=_number(weight, where))
    for where, words in links:
        activation, lower, upper, contingent = _row(words, 4, "A lower upper C", where)
        network.add_contingent_link(activation, contingent, _number(lower, where), _number(upper, where))
    put_origin_first(network, origin)
    return network


def put_origin_first(network: STN, origin: str | None) -> None:
    """Ask that no point comes before ``origin``, where the network has such a point."""
    if origin is not None and origin in network:
        for point in network.points:
            if point != origin:
                network.add_requirement(origin, point, lower=0.0)


def write_plain_stnu(path: str | Path, network: STN) -> Path:
    """Write a network as plainStnu text.

    Raises:
        TemporalError: A point's name has a space in it, which the format cannot hold.
        WriteError: The place is not writable.
    """
    return write_text(path, format_plain_stnu(network))


def format_plain_stnu(network: STN) -> str:
    """A network as plainStnu text.

    Raises:
        TemporalError: A point's name has a space in it or begins with ``#``, which the format cannot hold.
    """
    for point in network.points:
        if len(point.split()) != 1 or point.startswith("#"):
            raise TemporalError(f"plainStnu text cannot hold the name {point!r}: no spaces, and no # at its beginning")
    links = network.contingent_links if isinstance(network, STNU) else ()
    edges = [f"{edge.tail} {shown(edge.weight)} {edge.head}" for edge in network.edges]
    rows = [f"{link.activation} {shown(link.lower)} {shown(link.upper)} {link.contingent}" for link in links]
    parts = [("KIND OF NETWORK", ["STNU"]), ("Num Time-Points", [str(len(network))])]
    parts += [("Num Ordinary Edges", [str(len(edges))]), ("Num Contingent Links", [str(len(rows))])]
    parts += [("Time-Point Names", [" ".join(network.points)]), ("Ordinary Edges", edges), ("Contingent Links", rows)]
    return "".join(f"# {title}\n" + "".join(f"{line}\n" for line in body) for title, body in parts)


def _sections(text: str, source: str) -> dict[str, list[tuple[str, list[str]]]]:
    """The rows under every heading, each with where it stands."""
    found: dict[str, list[tuple[str, list[str]]]] = {}
    known = {title.lower(): title for title in _HEADINGS}
    rows: list[tuple[str, list[str]]] | None = None
    for number, line in _lines(text):
        where = f"line {number} of {source}"
        if line.startswith("#"):
            title = known.get(line.strip("# \t").lower())
            rows = found.setdefault(title, []) if title else rows
        elif rows is None:
            raise TemporalError(f"{where} stands before any heading such as '# Time-Point Names': {line[:60]!r}")
        else:
            rows.append((where, line.split()))
    for title in ("Time-Point Names", "Ordinary Edges"):
        if title not in found:
            raise TemporalError(f"{source} is torn or no plainStnu text: it has no heading '# {title}'")
    return found


def _lines(text: str) -> Iterator[tuple[int, str]]:
    for number, line in enumerate(text.splitlines(), start=1):
        if line.strip():
            yield number, line.strip()


def _check_count(rows: list[tuple[str, list[str]]] | None, found: int, title: str, source: str) -> None:
    if not rows:
        return
    where, words = rows[0]
    if _number(words[0], where) != found:
        raise TemporalError(f"{source} is torn: it tells {words[0]} {title} and holds {found}")


def _row(words: list[str], count: int, form: str, where: str) -> list[str]:
    if len(words) != count:
        raise TemporalError(f"{where} must be '{form}', got {' '.join(words)[:60]!r}")
    return words


def _number(word: str, where: str) -> float:
    try:
        return float(word)
    except ValueError:
        raise TemporalError(f"{where} needs a number, got {word!r}") from None
