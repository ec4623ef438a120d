"""Linear spaces of solutions of a periodic sheet, found in floats and proved over Q.

All solutions form linear spaces: the spans L_e of the cones C_e of sign vectors
(docs/tessellations.md, Theorem 15). Take h in C_e. Let F be the vertices that are flat in h, N the
space of all a with K_u(h, a) = 0 for all u that are not in F, and Z the radical, on N, of the sum
of the K_v with v in F. If all K_v vanish on Z, then Z is a component of the solutions, and it holds
C_s for every s that agrees with h off F (docs/tessellations.md, Theorem 17). A form that is a
multiple of a square on Z vanishes on its radical only, which then takes the place of Z.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.exact.linalg import Matrix, from_fmpq, nullspace, to_flint
from exactfold.rigidity.equations.periodic import PeriodicProblem, Row
from exactfold.solve.numeric.periodic_rays import floats

_FLAT = (1e-3, 1e-5, 1e-7)
"""Values of l_v at a unit vector below which a vertex is taken for flat, tried in this order."""
_STEPS = 40
_SMALL = 1e-9
_MOST_DENOMINATOR = 10**5
_GRID = 1 << 20


@dataclass(frozen=True)
class Space:
    """A linear space of solutions, with a reduced echelon basis on z, and its flat vertices."""

    basis: tuple[Row, ...]
    flat: frozenset[int]

    @property
    def dimension(self) -> int:
        """The dimension."""
        return len(self.basis)

    @property
    def is_ray(self) -> bool:
        """Whether it is a line on which b is not 0."""
        return len(self.basis) == 1 and self.bends

    @property
    def bends(self) -> bool:
        """Whether b is not 0 on the whole space."""
        return any(row[-1] for row in self.basis)


@dataclass(frozen=True)
class Cover:
    """A space that holds the cones C_s of all s that agree with `signs` off the flat vertices.

    `point` is a rational point of the space, and `signs` are those of its vertices.
    """

    space: Space
    point: Row
    signs: tuple[int, ...]


def echelon(rows: Matrix) -> tuple[Row, ...]:
    """The reduced echelon form of the span of rational rows; rows that are 0 are left out.

    >>> echelon([[2, 4], [1, 2]])
    ((Fraction(1, 1), Fraction(2, 1)),)
    """
    if not rows:
        return ()
    reduced, rank = to_flint(rows).rref()
    width = len(rows[0])
    return tuple(tuple(from_fmpq(reduced[i, j]) for j in range(width)) for i in range(rank))


@dataclass(frozen=True)
class Spaces:
    """Exact linear algebra with the forms of one problem."""

    problem: PeriodicProblem

    @cached_property
    def _forms(self) -> FloatArray:
        return np.array([floats(star.form) for star in self.problem.stars])

    def values(self, point: Sequence[Fraction]) -> tuple[int, ...]:
        """The signs of all vertices at a rational point."""
        rows = self.problem.vertices.values()
        totals = [sum(c * x for c, x in zip(row, point, strict=True)) for row in rows]
        return tuple((total > 0) - (total < 0) for total in totals)

    def flat_on(self, basis: Sequence[Row]) -> frozenset[int]:
        """The vertices whose stars are flat on a whole space."""
        bends = self.problem.bends_at
        return frozenset(
            v
            for v in range(self.problem.sheet.V)
            if all(not dot(row, vector) for row in bends[v] for vector in basis)
        )

    def solves(self, basis: Sequence[Row]) -> bool:
        """Whether all K_v vanish on the span of a basis."""
        return all(
            not dot(turned, other)
            for star in self.problem.stars
            for k, vector in enumerate(basis)
            for turned in [image(star.form, vector)]
            for other in basis[k:]
        )

    def around(self, point: Row) -> tuple[Row, ...]:
        """The space Z of a solution, or a smaller one by squares, in reduced echelon form."""
        flat = self.flat_on([point])
        rows = [
            image(star.form, point) for v, star in enumerate(self.problem.stars) if v not in flat
        ]
        normal = nullspace(rows) if rows else identity(self.problem.sheet.V)
        forms = [self.problem.stars[v].form for v in sorted(flat)]
        space = _radical(summed(forms), normal) if forms else [*map(tuple, normal)]
        while True:
            radicals = (_radical(form, space) for form in forms)
            smaller = next((r for r in radicals if len(r) == len(space) - 1), None)
            if smaller is None:
                return echelon(space)
            space = smaller

    def cover(self, ray: FloatArray) -> Cover | None:
        """A space that holds C_e, and the proof, from floats near a ray of C_e; or None."""
        found = (self._covered(ray, flat) for flat in self.flat_near(ray))
        return next((cover for cover in found if cover is not None), None)

    def flat_near(self, ray: FloatArray) -> list[frozenset[int]]:
        """The vertices that may be flat at a ray that is known in floats: a few sets to try."""
        lines = floats([star.functional for star in self.problem.stars])
        sizes = np.abs(lines @ ray) / np.linalg.norm(lines, axis=1)
        sets = (frozenset(np.flatnonzero(sizes < small).tolist()) for small in _FLAT)
        return list(dict.fromkeys(sets))

    def level(self, flat: frozenset[int]) -> tuple[Row, ...]:
        """A basis of the heights at which some vertices are flat."""
        rows = [row for v in flat for row in self.problem.bends_at[v]]
        return echelon(nullspace(rows) if rows else identity(self.problem.sheet.V))

    def _covered(self, ray: FloatArray, flat: frozenset[int]) -> Cover | None:
        rows = [row for v in flat for row in self.problem.bends_at[v]]
        level = self.level(flat)
        if not level:
            return None
        near: FloatArray | None = ray
        basis: tuple[Row, ...] | None = level
        if not self.solves(level):
            frame = np.linalg.qr(floats(level).T)[0]
            near = self._refined(ray, frame, flat)
            basis = None if near is None else self._guessed(near, flat)
        if near is None or basis is None or not self.solves(basis):
            return None
        point = self._rounded(near, basis, rows)
        if point is None or self.flat_on([point]) != flat:
            return None
        return self.at(point)

    def at(self, point: Row) -> Cover | None:
        """The cover by a rational solution, if all forms vanish on its Z."""
        space = self.around(point)
        if not self.solves(space):
            return None
        return Cover(Space(space, self.flat_on(space)), point, self.values(point))

    def _refined(
        self, ray: FloatArray, frame: FloatArray, flat: frozenset[int]
    ) -> FloatArray | None:
        """The ray, moved into the space of `frame` and to a zero of the forms there."""
        others = [v for v in range(self.problem.sheet.V) if v not in flat]
        forms = np.array([frame.T @ self._forms[v] @ frame for v in others])
        if not len(forms):
            return None
        forms /= np.maximum(np.abs(forms).max(axis=(1, 2)), 1e-300)[:, None, None]
        y = frame.T @ ray
        for _ in range(_STEPS):
            size = np.linalg.norm(y)
            if not np.isfinite(size) or size < _SMALL:
                return None
            y /= size
            gradients = forms @ y
            values = gradients @ y
            if np.abs(values).max() < 1e-15:
                break
            y = y - np.linalg.lstsq(2 * gradients, values, rcond=1e-7)[0]
        return np.asarray(frame @ y / np.linalg.norm(y))

    def _guessed(self, near: FloatArray, flat: frozenset[int]) -> tuple[Row, ...] | None:
        """The space Z of a zero in floats, with a rational basis; None if it looks irrational."""
        others = [v for v in range(self.problem.sheet.V) if v not in flat]
        rows = self._forms[others] @ near
        rows /= np.maximum(np.linalg.norm(rows, axis=1), 1e-300)[:, None]
        normal = _null(rows)
        if flat:
            total = self._forms[sorted(flat)].sum(axis=0)
            total /= max(np.abs(total).max(), 1e-300)
            normal = normal @ _null(normal.T @ total @ normal)
        return _rational(normal.T)

    def _rounded(self, near: FloatArray, basis: Sequence[Row], rows: Sequence[Row]) -> Row | None:
        """A rational point of a space near a float point, on which the given rows vanish."""
        inner = [[dot(row, vector) for vector in basis] for row in rows]
        weights = nullspace(inner) if inner else identity(len(basis))
        vectors = [combined(w, basis) for w in weights]
        if not vectors:
            return None
        at = np.linalg.lstsq(floats(vectors).T, near, rcond=None)[0]
        return combined([Fraction(round(_GRID * x), _GRID) for x in at.tolist()], vectors)


def dot(a: Sequence[Fraction], b: Sequence[Fraction]) -> Fraction:
    """The value of a row at a vector."""
    return sum((x * y for x, y in zip(a, b, strict=True)), Fraction(0))


def image(form: Sequence[Row], vector: Sequence[Fraction]) -> Row:
    """The polar form with a vector, as a row."""
    return tuple(dot(row, vector) for row in form)


def combined(weights: Sequence[Fraction], vectors: Sequence[Sequence[Fraction]]) -> Row:
    """The sum of vectors with weights."""
    return tuple(dot(weights, column) for column in zip(*vectors, strict=True))


def chart_where_one(
    basis: Sequence[Sequence[Fraction]], row: Sequence[Fraction]
) -> list[Sequence[Fraction]] | None:
    """The chart of a span on which a row is 1: the directions in which it goes on, then a point.

    None if the row vanishes on the span.
    """
    values = [dot(row, vector) for vector in basis]
    place = next((k for k, value in enumerate(values) if value), None)
    if place is None:
        return None
    foot = [x / values[place] for x in basis[place]]
    others = [
        [x - value * f for x, f in zip(vector, foot, strict=True)]
        for k, (vector, value) in enumerate(zip(basis, values, strict=True))
        if k != place
    ]
    return [*others, foot]


def summed(forms: Sequence[Sequence[Row]]) -> list[Row]:
    """The sum of forms."""
    return [
        tuple(sum(entries, Fraction(0)) for entries in zip(*rows, strict=True))
        for rows in zip(*forms, strict=True)
    ]


def _radical(form: Sequence[Row], basis: Sequence[Sequence[Fraction]]) -> list[Row]:
    """A basis of the radical of a form on the span of a basis."""
    images = [image(form, row) for row in basis]
    weights = nullspace([[dot(turned, row) for row in basis] for turned in images]) if basis else []
    return [combined(w, basis) for w in weights]


def identity(size: int) -> list[list[Fraction]]:
    """The rows of the identity."""
    return [[Fraction(int(i == j)) for j in range(size)] for i in range(size)]


def _null(rows: FloatArray) -> FloatArray:
    """An orthonormal basis of the null space, as columns."""
    _, values, vectors = np.linalg.svd(rows)
    rank = int((values > 1e-7).sum())
    return np.asarray(vectors[rank:].T)


def _rational(rows: FloatArray) -> tuple[Row, ...] | None:
    """The reduced echelon form of the span of rows, if its entries look rational."""
    work = np.array(rows)
    found = 0
    for column in range(work.shape[1]):
        if found == len(work):
            break
        pivot = found + int(np.abs(work[found:, column]).argmax())
        if abs(work[pivot, column]) < 1e-7:
            continue
        work[[found, pivot]] = work[[pivot, found]]
        work[found] /= work[found, column]
        for other in range(len(work)):
            if other != found:
                work[other] -= work[other, column] * work[found]
        found += 1
    exact = []
    for row in work[:found].tolist():
        guesses = [Fraction(x).limit_denominator(_MOST_DENOMINATOR) for x in row]
        if any(abs(float(g) - x) > 1e-7 for g, x in zip(guesses, row, strict=True)):
            return None
        exact.append(tuple(guesses))
    return tuple(exact)
