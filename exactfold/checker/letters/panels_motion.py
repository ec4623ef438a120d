"""Motions of rigid panels to second order with given letters, verified part by part.

A part in which no fold has a letter rests. Where all vertices have at most four folds, the sides of
all folds name a line at each vertex, and the densities fit if they do round all loops. Elsewhere
Krawczyk's test shows that all conditions have a zero near given densities, at which they are
independent, so that true motions are tangent to it (docs/assignment.md, Theorem 6).
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
"""The entries of a row that are not 0, by the place of the fold."""


def check_motion(
    sheet: PanelSheet, near: Near, wanted: Mapping[Edge, str], given: Any, *, true: bool
) -> None:
    """Verify a motion with the letters for each part; with `true`, that true ones begin like it."""
    live = {pair(v, u) for v, around in near.items() for u in around}
    for fold, letter in wanted.items():
        able = letter not in SIDES or fold in live or sheet.boundary_set.issuperset(fold)
        require(able, f"fold {fold[0]}-{fold[1]} has a letter and stays flat")
    groups = connected(near)
    for group, entry in zip(groups, items(given, "motion", len(groups)), strict=True):
        folds = sorted({pair(v, u) for v, around in group.items() for u in around})
        if entry is None:
            rests = all(wanted[fold] not in SIDES for fold in folds)
            require(rests, f"the part of vertex {min(group)} has letters and rests")
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
        require(fits(wanted[i, j], side), f"fold {i}-{j} has another letter")
    modes, lines = Modes(sheet, group), dict[int, int]()
    for v, around in group.items():
        own = {u: sides[pair(v, u)] for u in around}
        known = [line for line, found in ways(modes.lines[v], around) if found == own]
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
            require(truly, f"the loop {name(loop)} does not truly fold")


# --- vertices with more folds --------------------------------------------------------------------


def _check_regular(
    sheet: PanelSheet, group: Near, letters: list[str], folds: list[Edge], entry: Any
) -> None:
    """The test |Y F(c)| + |1 - Y J| r + |Y| H r^2 < r, row by row, for c, Y and r of the file.

    H bounds how much J changes. Folds that are no unknowns have exactly the densities given. The
    test implies that Y J is not singular at the zero: the conditions are independent.
    """
    keys(entry, "densities bits unit unknowns inverse shift radius", "a motion")
    bits, shift = natural(entry["bits"], "bits"), natural(entry["shift"], "shift")
    unit = integer(entry["unit"])
    require(bits <= BITS, "numbers are too long")
    at_most(max(shift, abs(unit)), MOST_SHIFT, "the bits by which numbers are moved", "MOST_SHIFT")
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
        require(goes, f"fold {folds[k][0]}-{folds[k][1]} is not shown to go its way")
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
        # all multiplied by 2^(shift + BITS + 1), and the radius by 2^bits
        left = (start << 2 * bits) + (off * radius << bits) + 2 * change * radius**2
        require(left < one * radius << bits, f"Krawczyk's test fails in row {n}")


def _spokes(sheet: PanelSheet, v: int, around: list[int], unit: int) -> list[tuple[Edge, Vector]]:
    """The folds at a vertex with their vectors over 2^unit, the neighbour of least number first.

    Where no sum of w_k d_k vanishes, the form depends on which fold is the first.
    """
    first = around.index(min(around))
    scale = sheet.tower.number(Fraction(2) ** -unit)
    found = []
    for u in around[first:] + around[:first]:
        x, y = sheet.vector(v, u)
        found.append((pair(v, u), (scale * x, scale * y)))
    return found


def _conditions(
    stars: list[list[tuple[Edge, Vector]]],
    folds: list[Edge],
    densities: list[Interval],
    place: Mapping[int, int],
) -> tuple[list[Interval], list[Row], list[int]]:
    """At each vertex in turn x, y and the form, or one of x and y for a straight pair.

    The values at the densities; the derivatives; and for each condition a bound of the sum of how
    much its derivatives by unknowns change if all unknowns change by 1, times 2^BITS.
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
