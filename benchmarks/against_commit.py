"""Environment speed beside another checkout of this repository: the same programs, in turn, on the same machine.

python benchmarks/against_commit.py OTHER [--rounds 8] [--python OTHER/.venv/bin/python]

OTHER is a folder such as ``git worktree add /tmp/before COMMIT`` makes. In each round ``environment.py``, ``corridor.py``
and ``arena.py`` of both checkouts run one after the other, on one thread, first one checkout and then the other, and in
the next round the other way round. A second is one of the processor's that the process got: other work on the machine
counts little. The table has the median over rounds of this checkout's rate over the other's, and the quartiles.
"""

import argparse
import os
import re
import statistics
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

HERE = Path(__file__).parents[1]
BAR = 0.98


class Row(NamedTuple):
    """A figure that a program prints: the first number behind what a line begins with."""

    program: str
    begins: str
    title: str


ROWS = (
    Row("environment", "lidarena, 64 worlds, 30-particle", "exploration, 64 worlds, SLAM live"),
    Row("environment", "lidarena, 64 worlds, slam='truth'", "exploration, 64 worlds, true poses"),
    Row("corridor", "lidarena, 64 teams", "corridor, 64 teams of 4"),
    Row("arena", "lidarena, 64 worlds", "arena, 64 worlds"),
)
STEPS = {"environment": 400, "corridor": 400, "arena": 1500}
BY_THE_PROCESSOR = """
import os, runpy, sys, time
time.perf_counter = time.process_time
sys.argv = sys.argv[1:]
sys.path.insert(0, os.getcwd())
runpy.run_path(sys.argv[0], run_name="__main__")
"""
"""Runs a program all whose clocks count the processor's time of the process."""


def rates(checkout: Path, python: Path, program: str) -> dict[Row, float]:
    """Run a program of a checkout; its rates [1/s]."""
    environment = os.environ | {"NUMBA_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PYTHONPATH": str(checkout)}
    command = [str(python), "-c", BY_THE_PROCESSOR, f"benchmarks/{program}.py", "--steps", str(STEPS[program])]
    done = subprocess.run(command, cwd=checkout, env=environment, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{program}.py failed in {checkout}:\n{done.stderr}")
    found = {}
    for row in ROWS:
        if row.program == program:
            line = next(line for line in done.stdout.splitlines() if line.startswith(row.begins))
            numbers = re.findall(r"\s([\d,]+)(?=/s| steps/s|\s{2,}|$)", line)
            found[row] = float(numbers[0].replace(",", ""))
    return found


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("other", type=Path, help="the checkout to compare with")
    parser.add_argument("--rounds", type=int, default=8)
    parser.add_argument("--python", type=Path, help="which has what the other checkout needs; this one if left out")
    options = parser.parse_args()
    other = options.other.resolve()
    pythons = {HERE: Path(sys.executable), other: options.python or Path(sys.executable)}
    programs = sorted({row.program for row in ROWS}, key=list(STEPS).index)
    for checkout, python in pythons.items():  # compiles the kernels
        for program in programs:
            rates(checkout, python, program)
    ratios: dict[Row, list[float]] = {row: [] for row in ROWS}
    for number in range(options.rounds):
        for program in programs:
            order = [HERE, other] if number % 2 else [other, HERE]
            found = {checkout: rates(checkout, pythons[checkout], program) for checkout in order}
            for row, rate in found[HERE].items():
                ratios[row].append(rate / found[other][row])
        print(f"round {number + 1}: " + ", ".join(f"{values[-1]:.2f}" for values in ratios.values()), flush=True)
    print(f"{f'rate here over that of {other.name}, {options.rounds} rounds':44}{'median':>8}{'quartiles':>16}")
    for row, values in ratios.items():
        low, median, high = statistics.quantiles(values, n=4, method="inclusive")
        print(
            f"{row.title:44}{median:8.3f}{f'{low:.3f} to {high:.3f}':>16}{'' if median >= BAR else '  below ' + str(BAR)}"
        )


if __name__ == "__main__":
    main()
