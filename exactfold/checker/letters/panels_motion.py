"""Motions of rigid panels to second order with given letters, verified part by part.

A part in which no fold has a letter may rest. If all vertices of a part have at most four folds,
the sides of its folds determine a line at each vertex, and the densities fit if they fit round all
loops. In other parts Krawczyk's test shows that all conditions have a common zero near given
densities, and that they are independent there. So true motions are tangent to this zero
(docs/assignment.md, Theorem 4).
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from itertools import combinations
from typing import Any

from ..core import limits
from ..core.intervals import Interval
from ..core.reading import at_most, integer, items, keys, natural, require
from ..panels.loops import Loops
from ..panels.modes import Modes, loops_of, name
from ..sheets.panels import Edge, Near, PanelSheet, Vector, connected, cross, pair
from .panels_refuted import SIDES, fits, ways

BITS = 128
MOST_CONDITIONS = limits.MOST_CONDITIONS
MOST_SHIFT = limits.MOST_SHIFT

Row = dict[int, Interval]
"""A row of the Jacobian: {index of a fold: entry}; entries that are 0 are left out."""


def check_motion(
    sheet: PanelSheet, near: Near, wanted: Mapping[Edge, str], given: Any, *, true: bool
) -> None:
    """Verify that each part has a motion with the letters.

    If `true`, verify as well that true motions begin like it.
    """
    live = {pair(v, u) for v, around in near.items() for u in around}
    for fold, letter in wanted.items():
        able = letter not in SIDES or fold in live or sheet.boundary_set.issuperset(fold)
        require(able, f"fold {fold[0]}-{fold[1]} has a letter, but stays flat in every motion")
    groups = connected(near)
    for group, entry in zip(groups, items(given, "motion", len(groups)), strict=True):
        folds = sorted({pair(v, u) for v, around in group.items() for u in around})
        if entry is None:
            rests = all(wanted[fold] not in SIDES for fold in folds)
            require(rests, f"the part of vertex {min(group)} has letters, but is given no motion")
        elif "sides" in entry:
            keys(entry, "sides", "a motion")
            _check_lines(sheet, group, wanted, dict(zip(folds, entry["sides"], strict=True)), true)
        else:
            _check_regular(sheet, group, [wanted[fold] for fold in folds], folds, entry)


# --- vertices with at most four folds ------------------------------------------------------------


def _check_lines(
    sheet: PanelSheet, group: Near, wanted: Mapping[Edge, str], text: dict[Edge, str], true: bool
) -> None:
    sides = {fold: SIDES.get(letter, 0) for fold, letter in text.items()}
    for (i, j), side in sides.items():
        require(fits(wanted[i, j], side), f"fold {i}-{j} does not have the letter asked for")
    modes, lines = Modes(sheet, group), dict[int, int]()
    for v, around in group.items():
        own = {u: sides[pair(v, u)] for u in around}
        known = [line for line, way in ways(modes.lines[v], around) if way == own]
        require(known, f"vertex {v} has no motion with these sides")
        for line in known:
            if line is not None:
                lines[v] = line
    active = {v: [u for u in group[v] if sides[pair(v, u)]] for v in lines}
    loops = Loops(modes)
    for part in connected(active):
        for loop in loops_of(sheet, part):
            require(modes.closes(loop, lines), f"the loop {name(loop)} does not close")
            truly = not true or loops.closes(lines, loop)
            require(truly, f"the loop {name(loop)} does not close for true motions")


# --- vertices with more folds --------------------------------------------------------------------


def _check_regular(
    sheet: PanelSheet, group: Near, letters: list[str], folds: list[Edge], entry: Any
) -> None:
    """Raise unless |Y F(c)| + |1 - Y J| r + |Y| H r^2 < r holds in every row.

    The file gives c, Y and r. H bounds how much the Jacobian J changes. A fold that is not an
    unknown has exactly the density given. The test implies that Y J is not singular at the zero, so
    that the conditions are independent.
    """
    keys(entry, "densities bits unit unknowns inverse shift radius", "a motion")
    bits, shift = natural(entry["bits"], "bits"), natural(entry["shift"], "shift")
    unit = integer(entry["unit"])
    require(bits <= BITS, f"the densities have more than {BITS} bits")
    what = "the bits by which numbers are shifted"
    at_most(max(shift, abs(unit)), MOST_SHIFT, what, "MOST_SHIFT")
    scaled = [integer(c) for c in items(entry["densities"], "densities", len(folds))]
    unknowns = [natural(k, "an unknown") for k in items(entry["unknowns"], "unknowns")]
    radius = natural(entry["radius"], "radius")
    size = len(unknowns)
    at_most(size, MOST_CONDITIONS, "the conditions", "MOST_CONDITIONS")
    place = {k: n for n, k in enumerate(unknowns)}
    for k, letter in enumerate(letters):
        side = SIDES.get(letter, 0)
        margin = radius if k in place else 0
        goes = not side or side * scaled[k] > margin
        require(goes, f"fold {folds[k][0]}-{folds[k][1]} is not proved to follow its letter")
    densities = [Interval.of(Fraction(c, 1 << bits), BITS) for c in scaled]
    stars = [_spokes(sheet, v, group[v], unit) for v in group]
    values, rows, changes = _conditions(stars, folds, densities, place)
    require(len(rows) == size, f"there are {len(rows)} conditions and {size} unknowns")
    one = 1 << shift + BITS + 1
    inverse = items(entry["inverse"], "inverse", size)
    doubled = [
        [(place[k], x.low + x.high, x.high - x.low) for k, x in row.items() if k in place]
        for row in rows
    ]
    for n, weights in enumerate(inverse):
        y = [integer(x) for x in items(weights, "a row of the inverse", size)]
        sums, spread = [0] * size, 0
        sums[n] = -one
        for weight, row in zip(y, doubled, strict=True):
            if weight:
                for k, middle, width in row:
                    sums[k] += weight * middle
                    spread += abs(weight) * width
        off = sum(map(abs, sums)) + spread
        value = sum((_scaled(v, w) for w, v in zip(y, values, strict=True)), Interval(0, 0, BITS))
        start = 2 * max(-value.low, value.high)
        change = sum(abs(w) * h for w, h in zip(y, changes, strict=True))
        # Both sides are multiplied by 2^(shift + BITS + 1), and the radius by 2^bits.
        left = (start << 2 * bits) + (off * radius << bits) + 2 * change * radius**2
        require(left < one * radius << bits, f"Krawczyk's test fails in row {n}")


def _spokes(sheet: PanelSheet, v: int, around: list[int], unit: int) -> list[tuple[Edge, Vector]]:
    """The folds at a vertex, with their vectors over 2^unit.

    The first fold leads to the neighbour with the smallest number, and the others follow in order.
    Where sum_k w_k d_k does not vanish, the value of the form depends on which fold is the first.
    """
    first = around.index(min(around))
    scale = sheet.tower.number(Fraction(2) ** -unit)
    spokes = []
    for u in around[first:] + around[:first]:
        x, y = sheet.vector(v, u)
        spokes.append((pair(v, u), (scale * x, scale * y)))
    return spokes


def _conditions(
    stars: list[list[tuple[Edge, Vector]]],
    folds: list[Edge],
    densities: list[Interval],
    place: Mapping[int, int],
) -> tuple[list[Interval], list[Row], list[int]]:
    """The closing conditions of all vertices: their values, their derivatives, and bounds.

    A vertex has three conditions, x, y and the form; a straight pair has only one, x or y. The
    values are those at the densities. The bound of a condition, times 2^BITS, is for the sum of the
    changes of its derivatives by the unknowns if all unknowns change by 1.
    """
    number = {fold: k for k, fold in enumerate(folds)}
    values, rows, changes = [], list[Row](), []
    for star in stars:
        at = [number[fold] for fold, _ in star]
        spokes = [d for _, d in star]
        pair_axis = 0 if spokes[0][0].sign() else 1
        for axis in (0, 1) if len(star) > 3 else (pair_axis,):
            row = {k: d[axis].enclosed(BITS) for k, d in zip(at, spokes, strict=True)}
            rows.append(row)
            changes.append(0)
            values.append(_total(densities[k] * x for k, x in row.items()))
        if len(star) < 4:
            continue
        row, change, products = {}, 0, []
        for (j, c), (k, d) in combinations(zip(at, spokes, strict=True), 2):
            bracket = cross(c, d).enclosed(BITS)
            products.append(bracket * densities[j] * densities[k])
            for one, other in ((j, k), (k, j)):
                term = bracket * densities[other]
                row[one] = row[one] + term if one in row else term
            if j in place and k in place:
                change += 2 * max(-bracket.low, bracket.high)
        rows.append(row)
        changes.append(change)
        values.append(_total(products))
    return values, rows, changes


def _total(terms: Any) -> Interval:
    return sum(terms, Interval(0, 0, BITS))


def _scaled(value: Interval, weight: int) -> Interval:
    ends = sorted((weight * value.low, weight * value.high))
    return Interval(ends[0], ends[1], value.bits)
