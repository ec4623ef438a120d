"""Folds that are proved to be exactly flat, because K_v = 0 leaves them no other choice."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from ..core.linear import kernel, matrix_of, rational_sqrt
from .sheet import Edge, Sheet

MOST_KNOWN = 4096
"""The largest number of answers of `forced_flat` that a sheet remembers at a time."""


def flat_at(
    sheet: Sheet, vertex: int, folds: tuple[Edge, ...], signs: tuple[int | None, ...]
) -> list[Edge]:
    """The answer of `forced_flat`. The sheet remembers it, because many branches ask the same."""
    known, question = sheet.forced_flat, (vertex, folds, signs)
    if question not in known:
        if len(known) >= MOST_KNOWN:
            known.clear()
        known[question] = forced_flat(sheet, vertex, folds, signs)
    return known[question]


def forced_flat(
    sheet: Sheet, vertex: int, folds: tuple[Edge, ...], signs: tuple[int | None, ...]
) -> list[Edge]:
    """The folds around a vertex that must be flat, given the signs of some (None where open).

    The given signs are those of the folds on the branch. The heights of the star for which the
    folds with sign 0 are flat form a space, and the branch has a point in this space at which the
    curvature form vanishes. If the space has dimension 1 and the form is not 0, the point is 0. In
    dimension 2 the form vanishes at 0 only, or on two lines. If these lines are rational, the point
    lies on a line that agrees with the known signs.
    """
    ring = sheet.star(vertex)
    free = ring[2:]  # modulo planes: the hub and two neighbouring vertices of the ring are at 0
    if len(free) - signs.count(0) > 2:
        return []
    rows = [[Fraction(sheet.bend(f).get(j, 0)) for j in free] for f in folds]
    basis = kernel([r for r, sign in zip(rows, signs, strict=True) if sign == 0], len(free))
    form = matrix_of(sheet.curvature(vertex), free)

    def polar(a: list[Fraction], b: list[Fraction]) -> Fraction:
        terms = (
            x * w * y
            for x, line in zip(a, form, strict=True)
            for w, y in zip(line, b, strict=False)
        )
        return sum(terms, Fraction(0))

    lines: list[list[Fraction]] = []  # where the form vanishes
    if (len(basis) == 1 and polar(basis[0], basis[0]) == 0) or len(basis) > 2:
        return []
    if len(basis) == 2:
        u, v = basis
        a, b, c = polar(u, u), polar(u, v), polar(v, v)
        square = b * b - a * c
        root = rational_sqrt(square) if square >= 0 else None
        if (square >= 0 and root is None) or not (a or b or c):
            return []
        if root is not None:
            pairs = [(-b + root, a), (-b - root, a)] if a else [(Fraction(1), 0 * b), (-c, 2 * b)]
            lines = [[s * x + t * y for x, y in zip(u, v, strict=True)] for s, t in pairs]
    vectors = [
        [sum((r * h for r, h in zip(row, line, strict=True)), Fraction(0)) for row in rows]
        for line in lines
    ]
    known = [(k, sign) for k, sign in enumerate(signs) if sign is not None]

    def agrees(vector: list[Fraction]) -> bool:
        one = [(vector[k] > 0) - (vector[k] < 0) for k, _ in known]
        return not any(s for _, s in known) or any(
            all(x * side == s for x, (_, s) in zip(one, known, strict=True)) for side in (1, -1)
        )

    left = [vector for vector in vectors if agrees(vector)]
    return [
        f
        for k, f in enumerate(folds)
        if signs[k] is None and all(vector[k] == 0 for vector in left)
    ]


def close_flat(sheet: Sheet, signs: dict[Edge, int | None], curved: Iterable[int] = ()) -> None:
    """Set the open signs to 0 that `flat_at` proves to be 0, until nothing changes.

    `curved` are the interior vertices at which the curvature form does not vanish, so that they are
    left out.
    """
    inner = set(sheet.interior) - set(curved)
    pending = {v for fold, sign in signs.items() if sign is None for v in fold} & inner
    while pending:
        vertex = pending.pop()
        folds = tuple((min(vertex, j), max(vertex, j)) for j in sheet.star(vertex))
        for fold in flat_at(sheet, vertex, folds, tuple(signs[f] for f in folds)):
            signs[fold] = 0
            pending |= set(fold) & inner
