"""Proves what is exactly flat on a branch: by deduction at vertices, or by rational heights.

No error bound can prove that a fold is flat. Both methods here are exact (docs/branch.md, What is
computed and what is proved).
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

import numpy as np

from exactfold._support.arrays import BigArray
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.solve.certify.enclosure import Enclosure, check_hypotheses, nappes

_MOST_BITS = 64
"""Exact heights are tried only if their common denominator has at most so many bits.

The denominator of the boundary heights does not count.
"""


def deduced(sheet: VertexEquations, proof: Enclosure) -> Enclosure:
    """The enclosure with the folds that must be flat because K_v = 0 at their ends (`flat_folds`).

    At the corner of a closed notch K is not 0; but it is a boundary vertex of the unclosed sheet.
    """
    if all(proof.letters):
        return proof
    from exactfold.rigidity.flat_folds import flat_folds  # here: loaded only if needed

    decided = dict(zip(sheet.pattern.folds, proof.letters, strict=True))
    folds = sheet.unclosed.folds
    open_ = {fold: decided[fold] or None for fold in folds}
    known_flat = flat_folds(sheet.unclosed, open_, sheet.targets)
    flat = frozenset(k for k, fold in enumerate(sheet.pattern.folds) if fold in known_flat)
    return with_flat(sheet, proof, flat)


def rational(
    sheet: VertexEquations, proof: Enclosure, wanted: Mapping[int, int]
) -> Enclosure | None:
    """The branch itself, if it has heights with a small common denominator near those of `proof`.

    By Theorem 5 (a), heights with K_v = k_v for all v in the closed nappes `wanted` are the only
    ones. So all signs and letters can be read from these heights. A flat vertex lies in both
    nappes.
    """
    guess = _guess(sheet, proof)
    if guess is None:
        return None
    heights, denominator = guess
    check_hypotheses(sheet, heights, denominator)
    folds = sheet.folds
    bends = folds.bends(heights)
    i, j = folds.corners[:, 0], folds.corners[:, 1]
    areas = folds.areas
    products = bends * (heights[j] - heights[i])
    twice = dict.fromkeys(sheet.unknowns, Fraction(0))  # 2 K_v, in the units of the integers
    flat = dict.fromkeys(sheet.unknowns, True)
    for bend, top, area, ends in zip(bends, products, areas, folds.corners[:, :2], strict=True):
        for v, side in zip(ends.tolist(), (1, -1), strict=True):
            if bend and v in flat:
                twice[v] += Fraction(side * top, area)
                flat[v] = False
    signs = nappes(sheet, bends)
    for v in sheet.unknowns:
        target = 2 * denominator**2 * sheet.targets.get(v, Fraction(0))
        if twice[v] != target or signs[v] != (0 if flat[v] else wanted[v]):
            return None
    exact = Enclosure(
        heights, denominator, signs, Fraction(0), tuple((b > 0) - (b < 0) for b in bends), ()
    )
    return with_flat(sheet, exact, frozenset(np.flatnonzero(bends == 0).tolist()))


def with_flat(sheet: VertexEquations, proof: Enclosure, flat: frozenset[int]) -> Enclosure:
    """The enclosure with these flat folds, and with flat and loose vertices.

    `loose` are the vertices at which no fold is known to bend, but some may; k_v = 0 at all of
    them.
    """
    bent, open_ = set[int](), set[int]()
    for k, ends in enumerate(sheet.folds.corners[:, :2].tolist()):
        (bent if proof.letters[k] else set() if k in flat else open_).update(ends)
    unbent = [v for v in sheet.poppable if v not in bent and v not in sheet.targets]
    loose = tuple(v for v in unbent if v in open_)
    still = tuple(v for v in unbent if v not in open_)
    return replace(proof, loose=loose, flat_folds=flat, flat_vertices=still)


def _guess(sheet: VertexEquations, proof: Enclosure) -> tuple[BigArray, int] | None:
    """The nearest integer heights over the least denominator that seems to fit; None if none."""
    if not proof.squared_distance:
        return None
    # Heights are right to about `places` bits. By chance, p/q is as near as this only to 1/q^2.
    distance = proof.squared_distance
    places = (distance.denominator.bit_length() - distance.numerator.bit_length()) // 2
    most = min(_MOST_BITS, places // 3)
    multiple = 1
    for height in proof.heights[list(sheet.unknowns)].tolist():
        exact = Fraction(multiple * sheet.boundary_denominator * height, proof.denominator)
        multiple *= exact.limit_denominator(1 << max(0, most)).denominator
        if multiple.bit_length() > most:
            return None
    denominator = multiple * sheet.boundary_denominator
    rounded = [
        (2 * height * denominator + proof.denominator) // (2 * proof.denominator)
        for height in proof.heights.tolist()
    ]
    return np.array(rounded, dtype=object), denominator
