"""A page of random floor plans: ``python -m lidarena.world.random_plans --out docs/pictures/random_worlds.png``."""

import argparse
import sys
from collections.abc import Sequence
from pathlib import Path

import cv2
import numpy as np
from numpy.typing import NDArray

from lidarena.base.errors import LidarenaError
from lidarena.base.files import check_writable, write_bytes
from lidarena.base.terminal import make_output_printable
from lidarena.world.canvas import INK, Canvas, draw_floorplan, write
from lidarena.world.floorplan import Floorplan
from lidarena.world.plan_generators import size_of
from lidarena.world.random_plans import KINDS, random_plans

_CELL = 208
"""Sides of the square that a plan has on the page, with what is written below it [pixels]."""
_TEXT, _GAP = 18, 8
_PNG = [cv2.IMWRITE_PNG_COMPRESSION, 9]


def draw_page(specs: Sequence[str], each: int, seed: int) -> NDArray[np.uint8]:
    """Draw a page (height, width, 3) with a row of ``each`` plans for every spec, the seeds counting from ``seed``.

    Raises:
        MapError: A spec that there is not, or no plan comes out.
    """
    rows = []
    for spec in specs:
        draw = random_plans(spec)
        plans = [draw(np.random.default_rng(seed + column)) for column in range(each)]
        rows.append(np.hstack([_drawn(plan) for plan in plans]))
    return np.vstack(rows)


def _drawn(plan: Floorplan) -> NDArray[np.uint8]:
    """One plan as large as fits, in the middle of its square, with its name and size below."""
    cell: NDArray[np.uint8] = np.full((_CELL, _CELL, 3), 255, np.uint8)
    width, height = size_of(plan)
    canvas = Canvas(plan.bounds, min((_CELL - _GAP) / width, (_CELL - _TEXT - _GAP) / height) - 1e-6)
    draw_floorplan(canvas, plan)
    rows, columns = canvas.image.shape[:2]
    top, left = (_CELL - _TEXT - rows) // 2, (_CELL - columns) // 2
    cell[top : top + rows, left : left + columns] = canvas.image
    write(cell, f"{plan.name}, {width:.1f} x {height:.1f} m", _GAP // 2, _CELL - 5, INK, 0.36)
    return cell


def main(arguments: list[str] | None = None) -> int:
    """Draw the page; return 0, or 2 for a refusal."""
    make_output_printable()
    parser = argparse.ArgumentParser(description="Draw a page of random floor plans.")
    parser.add_argument("specs", nargs="*", help="such as random:rooms?area_max=60; every kind by default")
    parser.add_argument("--each", type=int, default=10, help="plans of each")
    parser.add_argument("--seed", type=int, default=0, help="of the first plan")
    parser.add_argument("--out", type=Path, default=Path("results/random_worlds.png"), help="the picture, a .png")
    given = parser.parse_args(arguments)
    if given.each < 1 or given.seed < 0:
        parser.error(f"--each {given.each} --seed {given.seed}: at least one plan and a seed from 0 are needed")
    try:
        check_writable(given.out)
        page = draw_page(given.specs or [f"random:{kind}" for kind in KINDS], given.each, given.seed)
        write_bytes(given.out, cv2.imencode(".png", cv2.cvtColor(page, cv2.COLOR_RGB2BGR), _PNG)[1].tobytes())
    except LidarenaError as refusal:
        print(refusal, file=sys.stderr)
        return 2
    print(given.out)
    return 0


if __name__ == "__main__":
    sys.exit(main())
