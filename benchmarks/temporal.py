"""How long a check of dynamic controllability takes, beside the same algorithm in plain Python, on one core.

python benchmarks/temporal.py [--lanes FOLDER] [--repeats 30]

HRC-shaped networks have two lanes, human and robot: the human's actions are contingent links, what follows in a lane,
and now and then across the lanes, is ordered, a deadline bounds the whole. ``--lanes`` takes plainStnu files' folder.
"""

import argparse
import heapq
import math
import random
import statistics
import time
from collections import defaultdict
from collections.abc import Callable
from pathlib import Path

from lidarena.temporal import STNU, check_controllability, read_plain_stnu

BARS = {50: 0.1, 200: 1.0, 500: 5.0}
"""Milliseconds, by points."""
LANES_BAR = 50.0
Edges = dict[int, dict[int, int]]


def hrc_network(points: int, seed: int) -> STNU:
    """Two lanes of actions with a start and an end each, from one origin to a deadline; dynamically controllable."""
    rng = random.Random(seed)
    actions = (points - 1) // 4
    names = [f"{lane}{at}.{end}" for at in range(actions) for lane in "hr" for end in ("start", "end")]
    network = STNU(["Z", *names])
    for at in range(actions):
        low = rng.randint(4, 8)
        network.add_contingent_link(f"h{at}.start", f"h{at}.end", low, low + rng.randint(1, 6))
        network.add_requirement(f"r{at}.start", f"r{at}.end", low, 20)
        for lane in "hr":
            before = f"{lane}{at - 1}.end" if at else "Z"
            network.add_requirement(before, f"{lane}{at}.start", rng.randint(0, 3), None)
        if at and rng.random() < 0.5:
            first, then = rng.choice([("h", "r"), ("r", "h")])
            network.add_requirement(f"{first}{at - 1}.end", f"{then}{at}.start", 0, None)
        network.add_requirement("Z", f"r{at}.end", None, 30 * actions)
        network.add_requirement("Z", f"h{at}.end", None, 30 * actions)
    return network


def plain_python(network: STNU) -> bool:
    """Morris (2014) with dictionaries and a heap."""
    number = {point: at for at, point in enumerate(network.points)}
    into: Edges = defaultdict(dict)
    upper: dict[int, tuple[int, float]] = {}
    lower: dict[int, int] = {}

    def tighten(tail: int, head: int, weight: float) -> None:
        into[head][tail] = min(into[head].get(tail, math.inf), weight)

    for edge in network.edges:
        tighten(number[edge.tail], number[edge.head], edge.weight)
    for at, link in enumerate(network.contingent_links):
        prime, start, end = len(number) + at, number[link.activation], number[link.contingent]
        tighten(start, prime, link.lower)
        tighten(prime, start, -link.lower)
        upper[prime] = (end, link.lower - link.upper)
        lower[end] = prime
    negative = set(upper) | {head for head, tails in into.items() if min(tails.values()) < 0}
    state: dict[int, bool] = {}
    return all(_propagate(node, into, upper, lower, negative, state) for node in negative)


def _propagate(
    source: int,
    into: Edges,
    upper: dict[int, tuple[int, float]],
    lower: dict[int, int],
    negative: set[int],
    state: dict[int, bool],
) -> bool:
    if source in state:
        return state[source]
    state[source] = False  # under way: to come here again is a negative cycle
    begin = {tail: weight for tail, weight in into[source].items() if weight < 0}
    if source in upper:
        tail, weight = upper[source]
        begin[tail] = min(begin.get(tail, 0), weight)
    distance: dict[int, float] = {source: 0, **begin}
    queue, closed = [(weight, tail) for tail, weight in begin.items()], set()
    heapq.heapify(queue)
    while queue:
        length, node = heapq.heappop(queue)
        if node in closed or length > distance[node]:
            continue
        closed.add(node)
        if length >= 0:
            into[source][node] = min(into[source].get(node, math.inf), length)
            continue
        if node in negative and not _propagate(node, into, upper, lower, negative, state):
            return False
        tails = [(tail, weight) for tail, weight in into[node].items() if weight >= 0]
        if node in lower and lower[node] != source:
            tails.append((lower[node], 0))
        for tail, weight in tails:
            if length + weight < distance.get(tail, math.inf):
                distance[tail] = length + weight
                heapq.heappush(queue, (length + weight, tail))
    state[source] = True
    return True


def milliseconds(check: Callable[[STNU], object], network: STNU, repeats: int) -> float:
    """The median time of one check of a network that was not looked at before."""
    spent = []
    for _ in range(repeats):
        network._arrays = None  # as after a change, so that nothing kept from the last check helps
        begin = time.perf_counter()
        check(network)
        spent.append(1e3 * (time.perf_counter() - begin))
    return statistics.median(spent)


def tell(title: str, networks: list[STNU], repeats: int, bar: float) -> None:
    """Print one row: the median over networks of both programs, whether they agree, and the bar."""
    assert all(bool(check_controllability(one)) == plain_python(one) for one in networks)
    ours = [milliseconds(check_controllability, one, repeats) for one in networks]
    theirs = statistics.median(milliseconds(plain_python, one, max(1, repeats // 10)) for one in networks)
    yes = sum(bool(check_controllability(one)) for one in networks)
    print(
        f"{title:<28}{statistics.median(ours):9.3f}{max(ours):9.3f}{theirs:11.2f}{bar:8.1f}   "
        f"{yes} of {len(networks)} controllable"
    )


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--lanes", type=Path, help="a folder of plainStnu files named dc_… and notDC_…")
    parser.add_argument("--repeats", type=int, default=30)
    options = parser.parse_args()
    print(f"{'milliseconds a check':<28}{'median':>9}{'slowest':>9}{'in Python':>11}{'bar':>8}")
    for points, bar in BARS.items():
        networks = [hrc_network(points, seed) for seed in range(10)]
        tell(f"HRC, {len(networks[0])} points", networks, options.repeats, bar)
    for nodes in (50, 200, 500) if options.lanes else ():
        networks = [read_plain_stnu(file) for file in sorted(options.lanes.glob(f"dc_{nodes:03d}nodes*.plainStnu"))]
        tell(f"generator lanes, {nodes} nodes", networks, options.repeats, LANES_BAR)


if __name__ == "__main__":
    main()
