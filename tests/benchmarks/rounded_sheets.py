"""Counts triangulated sheets whose coordinates were turned, scaled and rounded to decimals.

python tests/benchmarks/rounded_sheets.py [--turns N] [--random N] [--only TEXT]

A degenerate sheet, with flat vertices or other features that rounding destroys, is counted exactly,
and again as a FOLD file of triangles in N positions for each number of decimals. "same" is the
answer of the exact sheet: the status, all numbers, and the letters of all branches. Otherwise the
answer has to be UNDECIDED; "OTHER" would be a proof about rounding noise. In random squares nothing
is degenerate: they have to stay PROVED. This is the table of docs/import.md.
"""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Callable, Mapping
from fractions import Fraction
from math import cos, sin
from typing import Any, Final

from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.ways import count_ways
from exactfold.branches.values.result import BranchCount
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.degenerate import (
    DEGENERATE,
    nested_triangles,
    notched,
    ringed_square,
    straight_path,
)
from exactfold.pattern.loading import PatternLike, load
from exactfold.pattern.triangulating.delaunay_sheets import delaunay
from exactfold.pattern.triangulating.random_squares import random_square

DIGITS: Final = (4, 6, 8, 10, 12, 15)
RANDOM_DIGITS: Final = (4, 6, 10, 16)
TURNS: Final = ((0.731, (0.32, 0.87)), (1.234, (0.0, 0.0)), (2.0, (-0.6, 0.1)))
"""Angles in radians, and shifts."""
SCALE: Final = 1.2345678


def _mirrored() -> CreasePattern:
    """A pentagon with an axis, and two vertices that are mirror images."""
    half = Fraction(1, 2)
    corners = [(2, 0), (1, 2), (-2, 1), (-2, -1), (1, -2)]
    return delaunay([*corners, (half, half), (half, -half)])


def _in_a_hexagon() -> CreasePattern:
    """A hexagon with four vertices, and two axes."""
    corners = [(2, 0), (1, 2), (-1, 2), (-2, 0), (-1, -2), (1, -2)]
    return delaunay([*corners, (1, 0), (-1, 0), (0, 1), (0, -1)])


SHEETS: Final[Mapping[str, Callable[[], CreasePattern]]] = {
    **DEGENERATE,
    "ring without hub": lambda: ringed_square(4, hub=False),
    "straight-path 4": lambda: straight_path(4),
    "nested-triangles 3": lambda: nested_triangles(3),
    "notched 3": lambda: notched(3),
    "flat-octahedron": lambda: load("flat-octahedron"),
    "waterbomb": lambda: load("waterbomb"),
    "mirrored pentagon": _mirrored,
    "hexagon": _in_a_hexagon,
}


def rounded(sheet: CreasePattern, digits: int, turn: int | None = 0) -> dict[str, Any]:
    """A FOLD file of the sheet, rounded to decimals; it is turned, scaled and shifted before.

    Without a turn it is only rounded.
    """
    angle, (right, up) = (0.0, (0.0, 0.0)) if turn is None else TURNS[turn]
    scale = 1.0 if turn is None else SCALE
    c, s = scale * cos(angle), scale * sin(angle)
    points = [(float(x), float(y)) for x, y in sheet.vertices]
    turned = [(c * x - s * y + right, s * x + c * y + up) for x, y in points]
    return {
        "vertices_coords": [[round(x, digits), round(y, digits)] for x, y in turned],
        "faces_vertices": [list(face) for face in sheet.triangles],
    }


def answer(sheet: PatternLike) -> tuple[object, ...]:
    """All that a count says of a sheet that does not depend on where it lies."""
    result = count_ways(sheet)
    families = result.families if isinstance(result, BranchCount) else result
    known: tuple[object, ...] = (result.status, str(families and families.second_order))
    if not isinstance(result, BranchCount):
        return (*known, str(result.true))
    pieces = result.connected_components
    numbers = (result.distinct, result.with_multiplicity, result.real, result.true_bounds)
    letters = Counter(branch.names[1] for branch in result.branches)
    return (*known, *numbers, pieces and (pieces.low, pieces.high), letters)


def verdict(exact: tuple[object, ...], found: tuple[object, ...]) -> str:
    """How the answer for a rounded sheet compares with that of the exact one."""
    if found == exact:
        return "same"
    return "UNDECIDED" if found[0] is UNDECIDED else "OTHER"


def print_degenerate(turns: int, only: str) -> None:
    """A row for each degenerate sheet, with the answers for each number of decimals."""
    print(f"| sheet | branches | {' | '.join(f'{d} decimals' for d in DIGITS)} |")
    print("|---|---:|" + "---|" * len(DIGITS))
    total: Counter[str] = Counter()
    for name, make in SHEETS.items():
        if only not in name:
            continue
        sheet = make()
        exact = answer(sheet)
        cells = []
        for digits in DIGITS:
            found = [verdict(exact, answer(rounded(sheet, digits, k))) for k in range(turns)]
            total.update(found)
            cells.append(", ".join(f"{n} {what}" for what, n in Counter(found).items()))
        ways = exact[2] if len(exact) > 3 and exact[2] is not None else "families"
        print(f"| {name} | {ways} | {' | '.join(cells)} |", flush=True)
    print("\n" + ", ".join(f"{number} {what}" for what, number in sorted(total.items())))


def print_random(number: int) -> None:
    """How many random squares of each size stay PROVED."""
    print("\n| vertices | " + " | ".join(f"{d} decimals" for d in RANDOM_DIGITS) + " |")
    print("|---:|" + "---:|" * len(RANDOM_DIGITS))
    for size in (2, 3, 4, 5, 6, 8):
        sheets = [random_square(size, seed=seed, denominator=10**17) for seed in range(number)]
        cells = []
        for digits in RANDOM_DIGITS:
            proved = sum(answer(rounded(sheet, digits))[0] is PROVED for sheet in sheets)
            cells.append(f"{proved} of {number}")
        print(f"| {size} | {' | '.join(cells)} |", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--turns", type=int, default=len(TURNS), help="positions of each sheet")
    parser.add_argument("--random", type=int, default=12, help="random squares of each size")
    parser.add_argument("--only", default="", help="only sheets whose name has this text")
    arguments = parser.parse_args()
    print_degenerate(arguments.turns, arguments.only)
    if arguments.random:
        print_random(arguments.random)


if __name__ == "__main__":
    main()
