"""Networks for the tests: the labelled instances, and random ones."""

import csv
import gzip
import io
import json
import random
import tarfile
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any, NamedTuple

import pytest

from lidarena.base.errors import TemporalError
from lidarena.temporal import STNU

DATA = Path(__file__).parents[3] / "shared" / "data" / "stnu"
needs_data = pytest.mark.skipif(not DATA.exists(), reason="the labelled networks of ../shared/data/stnu are not there")


class Labelled(NamedTuple):
    """A network with the answers that are known to be right."""

    name: str
    network: STNU
    controllable: bool
    consistent: bool | None = None


def build(points: Iterable[str], requirements: Iterable[Any], contingent: Iterable[Any]) -> STNU:
    """A network from rows ``[A, lower, upper, B]``."""
    network = STNU(points)
    for start, lower, upper, end in requirements:
        network.add_requirement(start, end, lower, upper)
    for start, lower, upper, end in contingent:
        network.add_contingent_link(start, end, lower, upper)
    return network


def classic() -> Iterator[Labelled]:
    """The small networks of other programs."""
    for one in json.loads((DATA / "classic_small.json").read_text()):
        rows = [*one["requirement"], *one["contingent"]]
        points = dict.fromkeys(point for row in rows for point in (row[0], row[3]))
        network = build(points, one["requirement"], one["contingent"])
        yield Labelled(one["id"], network, one["dc"], one["consistent"])


def fuzz() -> Iterator[Labelled]:
    """2,000 random networks on whose labels three implementations agree."""
    with gzip.open(DATA / "fuzz2000.jsonl.gz", "rt") as lines:
        for one in map(json.loads, lines):
            requirements = [(start, None, upper, end) for start, upper, end in one["edges"]]
            yield Labelled(one["id"], build(one["nodes"], requirements, one["contingent"]), one["dc"])


def heatlab() -> Iterator[Labelled]:
    """Prob-in-Ctrl's networks."""
    labels = csv.DictReader(io.StringIO((DATA / "heatlab_labels.csv").read_text()))
    answers = {row["file"]: row["dc"] == "1" for row in labels}
    with tarfile.open(DATA / "heatlab_prob_in_ctrl_MIT.tar.gz") as archive:
        for name, answer in answers.items():
            file = archive.extractfile(f"dataset/{name}")
            assert file is not None
            yield Labelled(name, _heatlab_network(json.load(file)), answer)


def _heatlab_network(found: dict[str, Any]) -> STNU:
    rows: dict[str, list[tuple[str, float, float, str]]] = {"stc": [], "stcu": []}
    for one in found["constraints"]:
        bounds = (float(one["min_duration"]), float(one["max_duration"]))
        rows[one["type"]].append((str(one["first_node"]), *bounds, str(one["second_node"])))
    points = dict.fromkeys(str(one[end]) for one in found["constraints"] for end in ("first_node", "second_node"))
    return build(points, rows["stc"], rows["stcu"])


def random_network(rng: random.Random) -> STNU:
    """A small network, chained and with ties now and then; about half of them are controllable."""
    points = [f"P{number}" for number in range(rng.randint(3, 7))]
    order = rng.sample(points, len(points))
    network = STNU(points)
    ended: set[str] = set()
    for _ in range(rng.randint(1, 3)):
        start, end = rng.sample(range(len(order)), 2)
        if rng.random() < 0.8 and start > end:
            start, end = end, start
        if order[end] not in ended:
            lower = rng.randint(0, 6)
            upper = lower + rng.choice([0, 1, 3, 6])
            with suppress(TemporalError):  # links in a circle
                network.add_contingent_link(order[start], order[end], lower, upper)
                ended.add(order[end])
    for _ in range(rng.randint(2, 9)):
        start, end = rng.sample(range(len(order)), 2)
        network.add_requirement(order[start], order[end], upper=rng.randint(-4, 14))
    return network
