"""A motion to second order near a candidate, proved: as it is, or in a subspace of the motions."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from exactfold.design.panels.first_order_program import SIDES
from exactfold.design.panels.regular_motion import regular_motion
from exactfold.design.refutations.refutation import Letters
from exactfold.errors import TooManyModesError
from exactfold.panels.kernel import Entry, Rows, first_order, imposed
from exactfold.panels.regular import Balls, Forms, parameter_folds, regular_point, truly_folds
from exactfold.panels.stars import Star
from exactfold.panels.subspaces import Leaf, factors, is_semidefinite, made_leaf, squares_of
from exactfold.pattern.panel_pattern import Edge

_NEAR: Final = 1e-6
_MOST_ENTRIES: Final = 6_000
_MOST_WORK: Final = 2_000_000


@dataclass(frozen=True)
class ProvedMotion:
    """A motion to second order: its densities nearly, and whether it is known to fold truly."""

    densities: Mapping[Edge, float]
    folds: bool


def proved_motion(
    stars: Mapping[int, Star], letters: Letters, near: Mapping[Edge, float]
) -> ProvedMotion | None:
    """A motion near a candidate with these letters where all forms vanish, or None.

    Where all conditions are independent, `regular_motion` proves it. Elsewhere semidefinite forms
    leave their kernels and forms of inertia (1, 1) that factor of theirs which vanishes near the
    candidate, exactly, until nothing changes, and Krawczyk's operator shows a zero of the forms
    that are left (`regular_point`). None decides nothing.
    """
    found = regular_motion(stars, near)
    if found is not None:
        if all(side * found[edge][0] > found[edge][1] for edge, side in _wanted(stars, letters)):
            return ProvedMotion({edge: x for edge, (x, _) in found.items()}, True)
        return None
    folds = {edge for star in stars.values() for edge in star.folds}
    if len(folds) * (len(folds) - 2 * len(stars)) > _MOST_ENTRIES:
        return None
    rows, size = first_order(stars)
    leaf = leaf_near(stars, rows, size, near)
    if leaf is None:
        return None
    w = regular_point(Forms(stars), leaf, near)
    if w is None or not _has_letters(w, letters, stars):
        return None
    middle = {edge: float(x.mid()) for edge, x in w.items()}
    return ProvedMotion(middle, truly_folds(stars, w))


def _wanted(stars: Mapping[int, Star], letters: Letters) -> list[tuple[Edge, int]]:
    folds = {edge for star in stars.values() for edge in star.folds}
    return [(edge, SIDES[letters[edge]]) for edge in sorted(folds) if letters[edge] in SIDES]


def _has_letters(w: Balls, letters: Letters, stars: Mapping[int, Star]) -> bool:
    """Whether balls show that all folds of these stars that have letters go their way."""
    return all(edge in w and bool(side * w[edge] > 0) for edge, side in _wanted(stars, letters))


def leaf_near(
    stars: Mapping[int, Star], rows: Rows, size: int, near: Mapping[Edge, float]
) -> Leaf | None:
    """The exact space on which the forms that can be are split, near a candidate."""
    work = 0
    while True:
        left: list[int] = []
        before = size
        for v in sorted({v for edge in rows for v in edge if v in stars}):
            squares = squares_of(stars[v], rows, size)
            if is_semidefinite(squares):
                functionals: Sequence[Sequence[Entry]] = [f for _, f in squares]
            elif len(squares) == 2:
                try:
                    both = factors([squares], rows)
                except TooManyModesError:
                    return None
                at = [near[edge] for edge in parameter_folds(rows, size)]
                functionals = [min(both, key=lambda row: _relative(row, at))]
                if _relative(functionals[0], at) > _NEAR:
                    return None
            else:
                if squares:
                    left.append(v)
                continue
            work += len(rows) * size * len(functionals)
            if work > _MOST_WORK:
                return None
            rows, size = imposed(rows, size, *functionals)
        if size == before:
            return made_leaf(rows, size, left) if size else None


def _relative(functional: Sequence[Any], at: Sequence[float]) -> float:
    """How large a functional is at a point, for its size."""
    weights = [float(x) for x in functional]
    total = sum(x * y for x, y in zip(weights, at, strict=True))
    return abs(total) / (max(map(abs, weights)) * max(map(abs, at)))
