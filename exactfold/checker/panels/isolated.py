"""Parts of a sheet whose ways are all isolated (docs/panels.md, Isolated ways).

Krawczyk's test shows that each box holds one motion to second order, a simple zero of the forms of
the vertices. The boxes are disjoint, and as many as the zeros that m quadrics can have in P^m. So
they hold all complex motions, up to multiples, and the real ones are the ways.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import lcm
from typing import Any

from ..core import limits
from ..core.krawczyk import Krawczyk, inverse
from ..core.reading import at_most, integer, items, keys, keys_of, require
from ..core.towers import Number
from ..sheets.boxes import Box, check_disjoint, read_box
from ..sheets.panels import Edge
from .claims import IsolatedClaim
from .motions import folds_of
from .spaces import Spaces

Entries = dict[tuple[int, int], int]


@dataclass
class _System:
    """Quadrics (1/2) z^T S z with z = (x, 1), and linear functions of z with integer rows."""

    size: int
    quadrics: list[Entries]
    rows: list[list[int]]


def isolated_ways(spaces: Spaces, given: Any) -> tuple[tuple[Edge, ...], tuple[int, ...], int]:
    """The folds that bend on each way of a part, the vertices with a form, the number of ways.

    The first-order conditions of the part are independent, and its first-order motions have one
    dimension more than there are vertices with a form. So each way extends to true motions.
    """
    keys(given, keys_of(IsolatedClaim), "isolated ways")
    numbers = {v: spaces.sheet.numbers(v, spaces.near) for v in spaces.near}
    full = tuple(v for v, (_, forms) in numbers.items() if forms)
    at_most(len(full), limits.ISOLATED_FORMS, "the vertices of one part", "ISOLATED_FORMS")
    folds = {spaces.sheet.fold(v, u) for v, around in spaces.near.items() for u in around}
    freedom = len(folds) - sum(conditions for conditions, _ in numbers.values())
    square = len(spaces.first_order) == freedom == len(full) + 1
    require(square, "a part with isolated ways has other numbers of motions and conditions")
    system = _system(spaces, full, given["chart"])
    real = [read_box(entry, system.size) for entry in items(given["real"], "real")]
    others = [read_box(entry, 2 * system.size) for entry in items(given["nonreal"], "nonreal")]
    count = len(real) + 2 * len(others)
    require(count == 1 << system.size, f"{count} isolated ways, not 2^{system.size}")
    test = Krawczyk(system)
    for box in real:
        test.check(box.center, box.radius, box.bits)
        bent = all(box.sign(row) for row in system.rows)
        require(bent, "a fold may be flat on an isolated way")
    test = Krawczyk(_realified(system))
    boxes = [Box([*box.center, *[0] * system.size], box.radius, box.bits) for box in real]
    for box in others:
        test.check(box.center, box.radius, box.bits)
        ahead, turn = box.center[: system.size], box.center[system.size :]
        boxes += [box, Box([*ahead, *(-y for y in turn)], box.radius, box.bits)]
    check_disjoint(boxes)
    return folds_of(spaces.first_order), full, len(real)


def _system(spaces: Spaces, full: tuple[int, ...], given: Any) -> _System:
    """The forms in the unknowns of the chart: the densities of all its folds but the last.

    An entry (i, j, c) of the chart names a fold and its weight; the sum of all weights times
    densities is 1.
    """
    space = spaces.first_order
    size = len(full)
    entries = [
        items(entry, "an entry of the chart", 3) for entry in items(given, "chart", size + 1)
    ]
    folds = [(integer(i), integer(j)) for i, j, _ in entries]
    *weights, last = [Fraction(integer(c)) for _, _, c in entries]
    require(last, "the last weight of the chart is 0")
    zero = spaces.sheet.tower.number(0)
    densities = [[_rational(motion.get(fold, zero)) for motion in space] for fold in folds]
    # column k holds the motion, in the basis, for which only entry k of z is not 0
    columns = inverse(densities)
    for row in columns:
        row[size] /= last
        row[:size] = [x - weight * row[size] for x, weight in zip(row[:size], weights, strict=True)]
    quadrics = []
    for v in full:
        form = [[_rational(spaces.form(v, a, b)) for b in space] for a in space]
        half = _product(form, columns)
        whole = _product(_transposed(columns), half)
        scale = lcm(*(x.denominator for row in whole for x in row))
        quadrics.append(
            {(i, j): int(x * scale) for i, row in enumerate(whole) for j, x in enumerate(row) if x}
        )
    rows = []
    for fold in folds_of(space):
        motions = [[_rational(motion.get(fold, zero)) for motion in space]]
        [row] = _product(motions, columns)
        scale = lcm(*(x.denominator for x in row))
        rows.append([int(x * scale) for x in row])
    return _System(size, quadrics, rows)


def _rational(value: Number) -> Fraction:
    require(not any(value.parts[1:]), "isolated ways are listed of sheets with rational vertices")
    return value.parts[0]


def _product(a: list[list[Fraction]], b: list[list[Fraction]]) -> list[list[Fraction]]:
    columns = _transposed(b)
    return [
        [
            sum((x * y for x, y in zip(row, column, strict=True) if x), Fraction(0))
            for column in columns
        ]
        for row in a
    ]


def _transposed(a: list[list[Fraction]]) -> list[list[Fraction]]:
    return [list(column) for column in zip(*a, strict=True)]


def _realified(system: _System) -> _System:
    """The real and imaginary parts of the quadrics in the real and imaginary parts of x."""
    n = system.size
    quadrics: list[Entries] = []
    for quadric in system.quadrics:
        real: Entries = {}
        imaginary: Entries = {}
        for (i, j), w in quadric.items():
            a, b = (k if k < n else 2 * n for k in (i, j))
            real[a, b] = w
            if j < n:
                imaginary[a, n + j] = w
            if i < n:
                imaginary[n + i, b] = w
            if i < n and j < n:
                real[n + i, n + j] = -w
        quadrics += [real, imaginary]
    return _System(2 * n, quadrics, [])
