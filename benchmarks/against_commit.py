"""Environment speed beside another checkout of this repository: the same programs, in turn, on the same machine.

python benchmarks/against_commit.py OTHER [--rounds 40] [--python OTHER/.venv/bin/python]

OTHER is a folder such as ``git worktree add /tmp/before COMMIT`` makes. ``environment.py``, ``corridor.py`` and
``arena.py`` of both checkouts make the worlds that they measure; then each measures a second or less by turns, one
thread, both from the same seeds. A second is one of the processor's, so that other work on the machine counts little.
The table has the median over rounds of this checkout's rate over the other's, and the quartiles.
"""

import argparse
import os
import statistics
import subprocess
import sys
from pathlib import Path
from typing import IO, NamedTuple, cast

HERE = Path(__file__).parents[1]
BAR = 0.98


class Row(NamedTuple):
    """What a program measures: the title, decisions before the first turn, and in a turn."""

    title: str
    before: int
    steps: int


PROGRAMS = {
    "environment": (
        Row("exploration, 64 worlds, SLAM live", 40, 40),
        Row("exploration, 64 worlds, true poses", 200, 300),
    ),
    "corridor": (Row("corridor, 64 teams of 4", 200, 60),),
    "arena": (Row("arena, 64 worlds", 300, 300),),
}
IN_TURNS = """
import importlib.util, os, sys, time
time.perf_counter = time.process_time
answers, sys.stdout = sys.stdout, open(os.devnull, "w")
spec = importlib.util.spec_from_file_location("program", f"benchmarks/{sys.argv.pop()}.py")
program = importlib.util.module_from_spec(spec)
spec.loader.exec_module(program)
name = "rate" if hasattr(program, "rate") else "rates"
measure, called = getattr(program, name), []

def by_turns(step, worlds, steps):
    called.append(worlds)
    if len(called) == 1:  # the naive rival
        return 1.0 if name == "rate" else (1.0, 1.0)
    for asked in map(int, sys.stdin):
        if not asked:
            break
        found = measure(step, worlds, asked)
        print(found if name == "rate" else found[0], file=answers, flush=True)
    return found

setattr(program, name, by_turns)
program.main()
"""
"""Runs a program's ``main``, in which each measurement of ours waits to be asked for so many steps; 0: the next."""


class Worker:
    """One program of one checkout, waiting for its turn.

    Args:
        checkout: Folder.
        python: Interpreter.
        program: Name of the program.
    """

    def __init__(self, checkout: Path, python: Path, program: str) -> None:
        settings = {"NUMBA_NUM_THREADS": "1", "OMP_NUM_THREADS": "1", "PYTHONPATH": str(checkout)}
        self._process = subprocess.Popen(
            [str(python), "-c", IN_TURNS, program],
            cwd=checkout,
            env=os.environ | settings,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            text=True,
        )

    def rate(self, steps: int) -> float:
        """Steps a second, measured over so many decisions."""
        self._ask(steps)
        answer = cast(IO[str], self._process.stdout).readline()
        if not answer:
            sys.exit("a program has failed, see above")
        return float(answer)

    def go_on(self) -> None:
        """Let the program come to its next measurement, or to its end."""
        self._ask(0)

    def _ask(self, steps: int) -> None:
        pipe = cast(IO[str], self._process.stdin)
        pipe.write(f"{steps}\n")
        pipe.flush()


def main() -> None:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("other", type=Path, help="the checkout to compare with")
    parser.add_argument("--rounds", type=int, default=40)
    parser.add_argument("--python", type=Path, help="which has what the other checkout needs; this one if left out")
    options = parser.parse_args()
    here, other = Path(sys.executable), options.other.resolve()
    print(f"{f'rate over that of {other.name}, {options.rounds} rounds':44}{'median':>8}{'quartiles':>18}", flush=True)
    for program, rows in PROGRAMS.items():
        workers = [Worker(HERE, here, program), Worker(other, options.python or here, program)]
        for row in rows:
            for worker in workers:
                worker.rate(row.before)
            ratios = []
            for number in range(options.rounds):
                found = {worker: worker.rate(row.steps) for worker in workers[:: 1 if number % 2 else -1]}
                ratios.append(found[workers[0]] / found[workers[1]])
            low, median, high = statistics.quantiles(ratios, n=4, method="inclusive")
            verdict = "" if median >= BAR else f"  below {BAR}"
            print(f"{row.title:44}{median:8.3f}{f'{low:.3f} to {high:.3f}':>18}{verdict}", flush=True)
            for worker in workers:
                worker.go_on()


if __name__ == "__main__":
    main()
