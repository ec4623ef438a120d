"""The proof that there is a motion to second order near a candidate.

Some motions are proved directly, others only in a subspace of the first-order motions.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Final

from exactfold.design.panels.first_order_program import SIDES
from exactfold.design.panels.regular_motion import regular_motion
from exactfold.design.refutations.refutation import Letters
from exactfold.errors import TooManyModesError
from exactfold.panels.spaces.kernel import Entry, Rows, first_order, imposed
from exactfold.panels.spaces.quadratics import factors, is_semidefinite, squares_of
from exactfold.panels.spaces.regular import (
    Balls,
    Forms,
    parameter_folds,
    regular_point,
    truly_folds,
)
from exactfold.panels.spaces.subspaces import Leaf, made_leaf
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge

_NEAR: Final = 1e-6
_MOST_ENTRIES: Final = 6_000
_MOST_WORK: Final = 2_000_000


@dataclass(frozen=True)
class ProvedMotion:
    """A proved motion to second order.

    `densities` are approximate. `folds` says whether the motion is known to extend to a finite
    flex.
    """

    densities: Mapping[Edge, float]
    folds: bool


def proved_motion(
    stars: Mapping[int, Star], letters: Letters, near: Mapping[Edge, float]
) -> ProvedMotion | None:
    """A motion near a candidate with these letters at which all forms vanish, or None.

    If all conditions are independent, `regular_motion` proves it. Otherwise the space of motions is
    cut down exactly: a semidefinite form leaves its kernel, and a form of inertia (1, 1) leaves
    that of its two factors which vanishes near the candidate. This is repeated until nothing
    changes. Then Krawczyk's operator shows a zero of the remaining forms (`regular_point`). None
    decides nothing.
    """
    boxes = regular_motion(stars, near)
    if boxes is not None:
        if all(side * boxes[edge][0] > boxes[edge][1] for edge, side in _wanted(stars, letters)):
            return ProvedMotion({edge: x for edge, (x, _) in boxes.items()}, True)
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
    """Whether balls show that every fold of these stars with a letter bends the way of
    its letter.
    """
    return all(edge in w and bool(side * w[edge] > 0) for edge, side in _wanted(stars, letters))


def leaf_near(
    stars: Mapping[int, Star], rows: Rows, size: int, near: Mapping[Edge, float]
) -> Leaf | None:
    """The exact space near a candidate that remains when every form that can be split is split."""
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
    """The size of a functional at a point, relative to the sizes of both."""
    weights = [float(x) for x in functional]
    total = sum(x * y for x, y in zip(weights, at, strict=True))
    return abs(total) / (max(map(abs, weights)) * max(map(abs, at)))
