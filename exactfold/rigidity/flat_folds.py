"""Deduces, vertex by vertex, which folds are exactly flat on a branch.

Take a vertex at which some folds are known to be flat. The bends of its other folds span a space of
dimension d. If the curvature form is definite on this space (always so for d = 1, unless the form
vanishes), all its folds are flat. If d = 2 and the form vanishes on one or two rational lines, the
branch lies on one of these lines. Then a fold is flat if it does not bend on any line that agrees
with the known signs. This settles crosses (collinear folds at a vertex of degree 4) and all that
follows from them.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from fractions import Fraction
from functools import lru_cache
from math import isqrt

from exactfold.exact.linalg import nullspace
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.functionals import fold_functional


def flat_folds(
    pattern: CreasePattern, signs: Mapping[Edge, int | None], curved: Collection[int] = ()
) -> frozenset[Edge]:
    """The folds that are proved flat on a branch with the given fold signs (None if undecided).

    `signs` must be right on the branch. A fold that is not returned may still be flat. `curved` are
    interior vertices whose curvature form does not vanish, so that they prove nothing.

    >>> cross = CreasePattern(
    ...     [(2, 0), (0, 3), (-2, 0), (0, -1), (0, 0)],
    ...     [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    >>> sorted(flat_folds(cross, {(0, 4): 1, (1, 4): None, (2, 4): 1, (3, 4): None}))
    [(1, 4), (3, 4)]
    """
    known = dict(signs)
    interior = set(pattern.interior) - set(curved)
    pending = {v for fold, sign in known.items() if sign is None for v in fold} & interior
    while pending:
        vertex = pending.pop()
        around = tuple((min(vertex, j), max(vertex, j)) for j in pattern.star(vertex))
        if len(around) - 2 - sum(known[fold] == 0 for fold in around) > 2:
            continue  # at least three dimensions remain
        for fold in _at_vertex(pattern, vertex, around, tuple(known[fold] for fold in around)):
            known[fold] = 0
            pending |= set(fold) & interior
    return frozenset(fold for fold, sign in known.items() if sign == 0)


@lru_cache(maxsize=4096)
def _at_vertex(
    pattern: CreasePattern, vertex: int, folds: tuple[Edge, ...], signs: tuple[int | None, ...]
) -> list[Edge]:
    """The undecided folds around a vertex that are flat; cached, as many branches ask the same."""
    ring = pattern.star(vertex)
    # Heights of the star modulo planes: the hub and two neighbouring vertices have height 0.
    free = ring[2:]
    bends = [fold_functional(pattern, fold) for fold in folds]
    rows = [[Fraction(bend.get(j, 0)) for j in free] for bend in bends]
    flat = [row for row, sign in zip(rows, signs, strict=True) if sign == 0]
    basis = nullspace(flat) if flat else _identity(len(free))
    form = curvature_form(pattern, vertex)
    lifted = [
        {v: Fraction(0) for v in form.labels} | dict(zip(free, b, strict=True)) for b in basis
    ]
    undecided = [k for k, sign in enumerate(signs) if sign is None]
    if not basis or (len(basis) == 1 and form(lifted[0]) != 0):
        return [folds[k] for k in undecided]
    if len(basis) != 2:
        return []
    lines = _null_lines(
        form.polar(lifted[0], lifted[0]),
        form.polar(lifted[0], lifted[1]),
        form.polar(lifted[1], lifted[1]),
    )
    if lines is None:
        return []
    vectors = []
    for s, t in lines:
        heights = [s * a + t * b for a, b in zip(*basis, strict=True)]
        vector = [
            sum((c * h for c, h in zip(row, heights, strict=True)), Fraction(0)) for row in rows
        ]
        if _agrees(vector, signs):
            vectors.append(vector)
    return [folds[k] for k in undecided if all(vector[k] == 0 for vector in vectors)]


def _identity(size: int) -> list[list[Fraction]]:
    return [[Fraction(int(i == j)) for j in range(size)] for i in range(size)]


def _null_lines(a: Fraction, b: Fraction, c: Fraction) -> list[tuple[Fraction, Fraction]] | None:
    """All directions (s, t) with a s^2 + 2 b s t + c t^2 = 0; None if they are not all rational."""
    if a == b == c == 0:
        return None
    discriminant = b * b - a * c
    if discriminant < 0:
        return []
    root = _rational_sqrt(discriminant)
    if root is None:
        return None
    if a != 0:
        return [(-b + root, a), (-b - root, a)]
    return [(Fraction(1), Fraction(0)), (-c, 2 * b)]


def _rational_sqrt(value: Fraction) -> Fraction | None:
    p, q = isqrt(value.numerator), isqrt(value.denominator)
    exact = p * p == value.numerator and q * q == value.denominator
    return Fraction(p, q) if exact else None


def _agrees(vector: list[Fraction], signs: Sequence[int | None]) -> bool:
    """Whether a multiple of `vector` has the known signs (None means unknown)."""
    pairs = [((x > 0) - (x < 0), s) for x, s in zip(vector, signs, strict=True) if s is not None]
    return any(all(x * side == s for x, s in pairs) for side in (1, -1)) or all(
        s == 0 for _, s in pairs
    )
