"""Regular points of the motions to second order, and what they prove of components."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Final, TypeAlias

import numpy as np
from flint import arb, arb_mat, ctx
from scipy.linalg import qr

from exactfold.exact.surds import ball
from exactfold.panels.spaces.kernel import first_order
from exactfold.panels.spaces.subspaces import Leaf
from exactfold.panels.vertex.holes import restricted
from exactfold.panels.vertex.stars import Star, bracket
from exactfold.pattern.panel_pattern import Edge

BITS: Final = 128
_RADIUS: Final = 1e-9
_TIMES_STEP: Final = 8.0
_REFINED: Final = 2
_LEAST_RADIUS: Final = 1e-30

Balls: TypeAlias = Mapping[Edge, Any]
"""Enclosures of the densities of the folds that are not flat."""

BallRows: TypeAlias = Mapping[Edge, Sequence[tuple[int, Any]]]
"""The nonzero entries of the rows of a space, as (parameter, enclosure)."""


class Forms:
    """The forms of the vertices and their derivatives, in balls with 128 bits."""

    def __init__(self, stars: Mapping[int, Star]) -> None:
        self.stars = stars
        self._brackets: dict[int, list[tuple[Edge, Edge, Any]]] = {}

    def _terms(self, v: int) -> list[tuple[Edge, Edge, Any]]:
        if v not in self._brackets:
            star = self.stars[v]
            pairs = list(zip(star.folds, star.directions, strict=True))
            self._brackets[v] = [
                (e, f, ball(bracket(d, c), BITS))
                for k, (f, c) in enumerate(pairs)
                for e, d in pairs[:k]
            ]
        return self._brackets[v]

    def value(self, v: int, w: Balls) -> Any:
        """The value of the form of vertex v at w."""
        return sum((w[e] * w[f] * c for e, f, c in self._terms(v) if e in w and f in w), arb(0))

    def gradient(self, v: int, w: Balls) -> dict[Edge, Any]:
        """The derivative of the form of vertex v at w, by fold."""
        gradient: dict[Edge, Any] = {}
        for e, f, c in self._terms(v):
            if f in w:
                gradient[e] = gradient.get(e, 0) + c * w[f]
            if e in w:
                gradient[f] = gradient.get(f, 0) + c * w[e]
        return gradient

    def derivatives(
        self, vertices: Iterable[int], w: Balls, rows: BallRows, size: int
    ) -> list[list[Any]]:
        """The derivatives at w of the forms of these vertices with respect to a space's
        parameters.
        """
        derivatives = []
        for v in vertices:
            total = [arb(0)] * size
            for edge, weight in self.gradient(v, w).items():
                for k, x in rows.get(edge, ()):
                    total[k] += weight * x
            derivatives.append(total)
        return derivatives


def in_balls(rows: Mapping[Edge, Sequence[Any]]) -> BallRows:
    """The rows of a space, enclosed in balls."""
    return {
        edge: [(k, ball(x, BITS)) for k, x in enumerate(row) if x] for edge, row in rows.items()
    }


def point(rows: Mapping[Edge, Sequence[Any]], size: int) -> Balls:
    """An enclosure of the motion of a space with the parameters 1, 2, 3, ..."""
    before = ctx.prec
    ctx.prec = BITS
    try:
        return _motion(in_balls(rows), [arb(k + 1) for k in range(size)])
    finally:
        ctx.prec = before


def parameter_folds(rows: Mapping[Edge, Sequence[Any]], size: int) -> list[Edge]:
    """For each parameter of a space, a fold whose density equals it."""
    folds: dict[int, Edge] = {}
    for edge, row in rows.items():
        entries = [k for k, x in enumerate(row) if x]
        if len(entries) == 1 and row[entries[0]] == 1:
            folds.setdefault(entries[0], edge)
    return [folds[k] for k in range(size)]


def regular_point(forms: Forms, leaf: Leaf, near: Mapping[Edge, float]) -> Balls | None:
    """An enclosure of a motion in a leaf at which the leaf's forms are regular, or None.

    The motion is near the given one. The forms of `leaf.vertices` vanish there and have independent
    derivatives on the space. Krawczyk's operator K(X) = c - Y F(c) + (1 - Y F'(X)) (X - c) shows
    this: it maps a box X into its interior. The box has as many parameters as there are forms; the
    other parameters are those of `near`. All points of a leaf without forms are regular. None means
    that the operator does not show it.
    """
    before = ctx.prec
    ctx.prec = BITS
    try:
        rows = in_balls(leaf.rows)
        start = [arb(near[edge]) for edge in parameter_folds(leaf.rows, leaf.size)]
        if not leaf.vertices:
            return _motion(rows, start)
        return _krawczyk(forms, leaf, rows, start)
    finally:
        ctx.prec = before


def _krawczyk(forms: Forms, leaf: Leaf, rows: BallRows, start: list[Any]) -> Balls | None:
    count = len(leaf.vertices)
    w = _motion(rows, start)
    jacobian = forms.derivatives(leaf.vertices, w, rows, leaf.size)
    approximate = np.array([[float(x.mid()) for x in row] for row in jacobian])
    if count > leaf.size or np.linalg.matrix_rank(approximate) < count:
        return None
    chosen = sorted(qr(approximate, pivoting=True, mode="r")[1][:count])
    inverse = arb_mat(np.linalg.inv(approximate[:, chosen]).tolist())
    start = list(start)
    for _ in range(_REFINED):
        w = _motion(rows, start)
        values = arb_mat([[forms.value(v, w)] for v in leaf.vertices])
        step = inverse * values
        for k, j in enumerate(chosen):
            start[j] = (start[j] - step[k, 0]).mid()
    values = arb_mat([[forms.value(v, _motion(rows, start))] for v in leaf.vertices])
    step = inverse * values
    largest = max(float(abs(step[k, 0]).upper()) for k in range(count))
    radius = min(_RADIUS, max(_TIMES_STEP * largest, _LEAST_RADIUS))
    box = list(start)
    for k in chosen:
        box[k] = box[k] + arb(0, radius)
    around = _motion(rows, box)
    slopes = forms.derivatives(leaf.vertices, around, rows, leaf.size)
    ones = arb_mat([[int(i == j) for j in range(count)] for i in range(count)])
    rest = ones - inverse * arb_mat([[row[k] for k in chosen] for row in slopes])
    offsets = arb_mat([[arb(0, radius)] for _ in chosen])
    image = rest * offsets - step
    if not all(abs(image[k, 0]) < radius for k in range(count)):
        return None
    for k, j in enumerate(chosen):
        box[j] = start[j] + image[k, 0]
    return _motion(rows, box)


def _motion(rows: BallRows, parameters: Sequence[Any]) -> Balls:
    return {edge: sum((x * parameters[k] for k, x in row), arb(0)) for edge, row in rows.items()}


def rank_at_least(matrix: Sequence[Sequence[Any]], wanted: int) -> bool:
    """Whether balls show that a matrix has at least this rank, by a minor that is not zero."""
    if wanted == 0:
        return True
    approximate = np.array([[float(x.mid()) for x in row] for row in matrix])
    if min(approximate.shape) < wanted:
        return False
    columns = qr(approximate, pivoting=True, mode="r")[1][:wanted]
    rows = qr(approximate[:, columns].T, pivoting=True, mode="r")[1][:wanted]
    square = approximate[np.ix_(rows, columns)]
    if np.linalg.matrix_rank(square) < wanted:
        return False
    before = ctx.prec
    ctx.prec = BITS
    try:
        # |1 - Y M| < 1 in the norm of row sums shows that M is invertible
        minor = arb_mat([[matrix[int(i)][int(j)] for j in columns] for i in rows])
        product = arb_mat(np.linalg.inv(square).tolist()) * minor
        sums = [
            sum((abs(product[i, j] - int(i == j)) for j in range(wanted)), arb(0))
            for i in range(wanted)
        ]
        return all(total < 1 for total in sums)
    finally:
        ctx.prec = before


def is_component(forms: Forms, rows: BallRows, size: int, w: Balls, dimension: int) -> bool:
    """Whether the motions near w have at most this dimension in the space of these rows.

    They do if the derivatives at w of all forms have rank `size - dimension` on the space
    (docs/panels.md, Regular points).
    """
    before = ctx.prec
    ctx.prec = BITS
    try:
        derivatives = forms.derivatives(forms.stars, w, rows, size)
    finally:
        ctx.prec = before
    return rank_at_least(derivatives, size - dimension)


def truly_folds(stars: Mapping[int, Star], w: Balls) -> bool:
    """Whether the implicit function theorem shows that a motion is tangent to true motions.

    Folds that are not in w are held flat. The answer is True under two conditions (docs/panels.md,
    Regular points). The first-order conditions are independent: two for each vertex, one for a
    straight pair, and as many as its rank for a hole. The derivatives at w of all forms are
    independent on the first-order motions. False decides nothing.
    """
    active = restricted(stars, w.keys())
    full = [v for v, star in active.items() if star.has_form]
    rows, size = first_order(active)
    if size != len(w) - sum(star.conditions for star in active.values()):
        return False
    if any(len(active[v].folds) < 4 and active[v].hole is None for v in full):
        return False
    before = ctx.prec
    ctx.prec = BITS
    try:
        derivatives = Forms(active).derivatives(full, w, in_balls(rows), size)
    finally:
        ctx.prec = before
    return rank_at_least(derivatives, len(full))


def outside(w: Balls, leaf: Leaf) -> bool:
    """Whether balls show that a motion does not lie in the space of a leaf."""
    if any(edge not in leaf.rows and not x.contains(0) for edge, x in w.items()):
        return True
    before = ctx.prec
    ctx.prec = BITS
    try:
        folds = parameter_folds(leaf.rows, leaf.size)
        parameters = [w.get(edge, arb(0)) for edge in folds]
        for edge, row in leaf.rows.items():
            here = sum(
                (ball(x, BITS) * a for x, a in zip(row, parameters, strict=True) if x), arb(0)
            )
            if not (w.get(edge, arb(0)) - here).contains(0):
                return True
    finally:
        ctx.prec = before
    return False
