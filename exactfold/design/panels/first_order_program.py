"""Linear programs on the first-order motions of a sheet of panels; floats propose, and no more."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from fractions import Fraction
from functools import cached_property
from heapq import heapify, heappop, heappush
from math import log2

import numpy as np
from flint import fmpq
from scipy import sparse
from scipy.optimize import linprog

from exactfold._support.arrays import FloatArray
from exactfold.design.panels.refutation import PanelRefutation
from exactfold.design.refutations.refutation import Letters
from exactfold.exact.surds import Surd
from exactfold.panels.kernel import Entry, Key, entry, increase, number
from exactfold.panels.stars import Star
from exactfold.pattern.panel_pattern import Edge, Point

_TIGHT = 1e-7
_PLACES = 40
_SHORT = 1e-6
_MOST_WORK = 2_000_000
SIDES = {"V": 1, "M": -1}


class FirstOrderProgram:
    """The linear programs of one sheet and its letters: motions with them, and why there are none.

    A motion w has `sum_k w_k d_k = 0` at each vertex (`Star`), and goes its way at a fold if w_f >
    0 for a valley and < 0 for a mountain. `stars` are those that the flat closure leaves; all other
    folds have no condition here. Lengths are taken in units of the longest fold.
    """

    def __init__(self, stars: Mapping[int, Star], letters: Letters) -> None:
        self.stars, self.letters = stars, letters
        self.vertices = list(stars)
        self.folds = sorted({edge for star in stars.values() for edge in star.folds})
        self.lettered = [edge for edge in self.folds if letters[edge] in SIDES]
        self._place = {edge: k for k, edge in enumerate(self.folds)}
        self._row = {v: k for k, v in enumerate(self.vertices)}

    @cached_property
    def unit(self) -> float:
        """The longest coordinate of a fold."""
        return max(abs(float(x)) for s in self.stars.values() for d in s.directions for x in d)

    @cached_property
    def matrix(self) -> sparse.csr_matrix:
        """Two rows for each vertex, a column for each fold: matrix @ w = 0 for motions."""
        values, rows, columns = [], [], []
        for k, star in enumerate(self.stars.values()):
            for edge, direction in zip(star.folds, star.directions, strict=True):
                for axis in (0, 1):
                    values.append(float(direction[axis]) / self.unit)
                    rows.append(2 * k + axis)
                    columns.append(self._place[edge])
        shape = (2 * len(self.stars), len(self.folds))
        return sparse.csr_matrix((values, (rows, columns)), shape=shape)

    def going_together(self) -> tuple[dict[Edge, float], list[Edge]]:
        """A motion in which no fold goes against its letter and as many as may be go their way,
        and those that do not.

        Sums of such motions are such motions, so that it is a linear program: the sum over the
        folds of the amount by which they go their way, at most 1 each, is the largest possible.
        """
        count, many = len(self.folds), len(self.lettered)
        signs = [-SIDES[self.letters[edge]] for edge in self.lettered]
        at = [self._place[edge] for edge in self.lettered]
        rows = sparse.csr_matrix((signs, (range(many), at)), shape=(many, count))
        nothing = sparse.csr_matrix((2 * len(self.stars), many))
        found = linprog(
            np.concatenate([np.zeros(count), -np.ones(many)]),
            A_ub=sparse.hstack([rows, sparse.identity(many)], format="csr"),
            b_ub=np.zeros(many),
            A_eq=sparse.hstack([self.matrix, nothing], format="csr"),
            b_eq=np.zeros(2 * len(self.stars)),
            bounds=[(None, None)] * count + [(0, 1)] * many,
            method="highs",
        )
        if found.status != 0:
            return dict.fromkeys(self.folds, 0.0), list(self.lettered)
        rest = [edge for edge, x in zip(self.lettered, found.x[count:], strict=True) if x < 0.5]
        return dict(zip(self.folds, map(float, found.x[:count]), strict=True)), rest

    def holding_flat(self, rest: Iterable[Edge]) -> dict[int, Point] | None:
        """Vectors whose sums are against the letters of these folds, and 0 at all others.

        As many as may be of the sums are not 0; exact where they must be 0. None if none are found.
        """
        strict = set(rest)
        sums, size = self.matrix.T.tocsr(), 2 * len(self.stars)
        at = [self._place[f] for f in self.folds if f in strict]
        others = [self._place[f] for f in self.folds if f not in strict]
        signs = sparse.diags([float(SIDES[self.letters[f]]) for f in self.folds if f in strict])
        turned, many = signs @ sums[at], len(at)
        equal = sparse.hstack(
            [sums[others], -sums[others], sparse.csr_matrix((len(others), many))], format="csr"
        )
        found = linprog(
            np.concatenate([np.full(2 * size, _SHORT), -np.ones(many)]),
            A_ub=sparse.hstack([turned, -turned, sparse.identity(many)], format="csr"),
            b_ub=np.zeros(many),
            A_eq=equal if others else None,
            b_eq=np.zeros(len(others)) if others else None,
            bounds=[(0, None)] * (2 * size) + [(0, 1)] * many,
            method="highs",
        )
        if found.status != 0:
            return None
        y = found.x[:size] - found.x[size : 2 * size]
        return self._exact(y, sums @ y) if np.abs(y).max() > 0 else None

    def motion(self, wanted: Iterable[Edge] | None = None) -> dict[Edge, float] | None:
        """A motion in which the wanted folds, or all with letters, go their way by as much as may
        be; None if there is none.
        """
        chosen = self.lettered if wanted is None else list(wanted)
        count = len(self.folds)
        if not chosen:
            return dict.fromkeys(self.folds, 0.0)
        signs = [-SIDES[self.letters[edge]] for edge in chosen]
        at = [self._place[edge] for edge in chosen]
        rows = sparse.csr_matrix((signs, (range(len(at)), at)), shape=(len(at), count))
        limits = sparse.hstack([rows, np.ones((len(at), 1))], format="csr")
        goal = np.append(np.zeros(count), -1.0)
        equal = sparse.hstack([self.matrix, np.zeros((2 * len(self.stars), 1))], format="csr")
        found = linprog(
            goal,
            A_ub=limits,
            b_ub=np.zeros(len(at)),
            A_eq=equal,
            b_eq=np.zeros(equal.shape[0]),
            bounds=[(-1, 1)] * count + [(None, 1)],
            method="highs",
        )
        if found.status != 0 or not found.x[-1] > _TIGHT:
            return None
        return dict(zip(self.folds, map(float, found.x[:-1]), strict=True))

    def refutation(self, wanted: Iterable[Edge] | None = None) -> PanelRefutation | None:
        """Vectors that show that not all wanted folds, or all with letters, can go their way.

        Small ones at few vertices, by a linear program; then exact where their sums vanish. The
        other letters are free. None if none is found, which decides nothing.
        """
        chosen = set(self.lettered if wanted is None else wanted)
        letters = {f: self.letters[f] if f in chosen else "U" for f in self.folds}
        size = 2 * len(self.stars)
        sums = self.matrix.T.tocsr()
        free = [self._place[f] for f in self.folds if letters[f] == "U"]
        held = [f for f in self.folds if letters[f] != "U"]
        at = [self._place[f] for f in held]
        signs = np.array([SIDES[letters[f]] for f in held], dtype=float)
        if not held:
            return None
        turned = sparse.diags(signs) @ sums[at]  # at most 0, and in all -1
        upper = sparse.hstack([turned, -turned], format="csr")
        equal = [sparse.csr_matrix(signs @ sums[at])]
        if free:
            equal.append(sums[free])
        both = sparse.vstack(equal)
        found = linprog(
            np.ones(2 * size),
            A_ub=upper,
            b_ub=np.zeros(len(held)),
            A_eq=sparse.hstack([both, -both], format="csr"),
            b_eq=np.append(-1.0, np.zeros(len(free))),
            method="highs",
        )
        if found.status != 0:
            return None
        y = found.x[:size] - found.x[size:]
        exact = self._exact(y, sums @ y)
        if exact is None:
            return None
        refutation = PanelRefutation(exact)
        return refutation if refutation.holds_on(self.stars, letters) else None

    def _exact(self, y: FloatArray, sums: FloatArray) -> dict[int, Point] | None:
        """Exact vectors near those given, 0 where these are, with sums 0 where theirs are."""
        largest = float(np.abs(y).max())
        used = [k for k in range(len(y)) if abs(y[k]) > _TIGHT * largest]
        if not used:
            return None
        active = {self.vertices[k // 2] for k in used}
        small = _TIGHT * max(float(np.abs(sums).max()), _TIGHT * largest)
        rows: dict[Edge, dict[int, Entry]] = {}
        for v in active:
            star = self.stars[v]
            for edge, direction in zip(star.folds, star.directions, strict=True):
                if abs(sums[self._place[edge]]) > small:
                    continue
                row = rows.setdefault(edge, {})
                for axis in (0, 1):
                    if direction[axis]:
                        row[2 * self._row[v] + axis] = entry(direction[axis])
        columns = sorted({2 * self._row[v] + axis for v in active for axis in (0, 1)})
        values = solved(rows.values(), {k: float(y[k]) / largest for k in columns})
        if values is None:
            return None
        points: dict[int, Point] = {}
        for v in sorted(active):
            a, b = (number(values[2 * self._row[v] + axis]) for axis in (0, 1))
            if a != 0 or b != 0:
                points[v] = (a, b)
        return points or None


def solved(
    rows: Iterable[Mapping[Key, Entry]], near: Mapping[Key, float]
) -> dict[Key, Entry] | None:
    """An exact solution of homogeneous linear equations near one in floating point.

    Unknowns that are not solved for are rounded to multiples of 2^-40 of those given. Each equation
    is solved for the unknown with the largest coefficient, nearly. None if it takes too long.

    >>> solved([{0: fmpq(1), 1: fmpq(2)}, {0: fmpq(1), 1: fmpq(2)}], {0: 0.5, 1: 0.0})
    {0: 1/2, 1: -1/4}
    """
    place: dict[Key, int] = {}
    pivots: list[tuple[Key, dict[Key, Entry]]] = []
    work = 0
    for given in rows:
        row: dict[Key, Entry] = {k: x for k, x in given.items() if x}
        waiting = [place[k] for k in row if k in place]
        heapify(waiting)
        while waiting:
            pivot, weights = pivots[heappop(waiting)]
            weight = row.pop(pivot, None)
            if weight is None:
                continue
            work += len(weights) * (1 + _bits(weight) // 64)
            if work > _MOST_WORK:
                return None
            for k, x in weights.items():
                if k in place and k not in row:
                    heappush(waiting, place[k])
                increase(row, k, weight * x)
        if row:
            pivot = min(row, key=lambda k: -_size(row[k]))
            scale = row.pop(pivot)
            place[pivot] = len(pivots)
            pivots.append((pivot, {k: -x / scale for k, x in row.items()}))
    values: dict[Key, Entry] = {k: _near(x) for k, x in near.items() if k not in place}
    for pivot, weights in reversed(pivots):
        total: Entry = fmpq(0)
        for k, x in weights.items():
            if values[k]:
                total = total + x * values[k]
        values[pivot] = total
    return {k: values[k] for k in near}


def _size(value: Entry) -> float:
    """The logarithm of the size of a number, nearly."""
    if isinstance(value, Surd):
        return log2(abs(float(value)))
    return int(value.p).bit_length() - int(value.q).bit_length()


def _bits(value: Entry) -> int:
    parts = value.parts if isinstance(value, Surd) else (value,)
    return sum(int(x.p).bit_length() + int(x.q).bit_length() for x in parts)


def _near(value: float) -> fmpq:
    near = Fraction(round(value * (1 << _PLACES)), 1 << _PLACES)
    return fmpq(near.numerator, near.denominator)
