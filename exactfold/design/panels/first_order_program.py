"""Linear programs on the first-order motions of a sheet of panels.

Floating point proposes what exact arithmetic verifies.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from fractions import Fraction
from functools import cached_property
from heapq import heapify, heappop, heappush
from math import log2

import numpy as np
from flint import fmpq
from scipy import sparse
from scipy.optimize import linprog

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import UNLIMITED, Clock
from exactfold.design.panels.refutation import PanelRefutation
from exactfold.design.refutations.refutation import Letters
from exactfold.exact.surds import Surd
from exactfold.panels.spaces.kernel import Entry, Key, entry, increase, number
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge, Point

_TIGHT = 1e-7
_PLACES = 40
_SHORT = 1e-6
_INNER = 0.1
_MOST_WORK = 2_000_000
SIDES = {"V": 1, "M": -1}


class FirstOrderProgram:
    """The linear programs of one sheet and its letters: motions with the letters, or refutations.

    A motion w satisfies sum_k w_k d_k = 0 at each vertex (`Star`). It bends a fold the way of its
    letter if w_f > 0 for a valley and w_f < 0 for a mountain. `stars` are those that the flat
    closure leaves; all other folds have no condition here. The unit of length is the longest fold.
    """

    def __init__(
        self, stars: Mapping[int, Star], letters: Letters, clock: Clock = UNLIMITED
    ) -> None:
        self.stars, self.letters, self.clock = stars, letters, clock
        self.vertices = list(stars)
        self.folds = sorted({edge for star in stars.values() for edge in star.folds})
        self.lettered = [edge for edge in self.folds if letters[edge] in SIDES]
        self._place = {edge: k for k, edge in enumerate(self.folds)}
        self._row = {v: k for k, v in enumerate(self.vertices)}

    @property
    def options(self) -> dict[str, float]:
        """The options of a linear program: the time that is left."""
        return {} if self.clock.left is None else {"time_limit": self.clock.left}

    @cached_property
    def unit(self) -> float:
        """The largest coordinate of a fold."""
        return max(abs(float(x)) for s in self.stars.values() for d in s.directions for x in d)

    @cached_property
    def matrix(self) -> sparse.csr_matrix:
        """The matrix with matrix @ w = 0 for motions: two rows per vertex, one column per fold."""
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
        """A motion in which as many folds as possible bend their way, and the folds that do not.

        No fold bends against its letter. Sums of such motions are such motions, so this is a
        linear program: it maximises the sum, over the folds, of the amount by which each bends
        its way, counted up to 1.
        """
        count, many = len(self.folds), len(self.lettered)
        signs = [-SIDES[self.letters[edge]] for edge in self.lettered]
        at = [self._place[edge] for edge in self.lettered]
        rows = sparse.csr_matrix((signs, (range(many), at)), shape=(many, count))
        nothing = sparse.csr_matrix((2 * len(self.stars), many))
        solution = linprog(
            np.concatenate([np.zeros(count), -np.ones(many)]),
            A_ub=sparse.hstack([rows, sparse.identity(many)], format="csr"),
            b_ub=np.zeros(many),
            A_eq=sparse.hstack([self.matrix, nothing], format="csr"),
            b_eq=np.zeros(2 * len(self.stars)),
            bounds=[(None, None)] * count + [(0, 1)] * many,
            method="highs",
            options=self.options,
        )
        if solution.status != 0:
            return dict.fromkeys(self.folds, 0.0), list(self.lettered)
        rest = [edge for edge, x in zip(self.lettered, solution.x[count:], strict=True) if x < 0.5]
        return dict(zip(self.folds, map(float, solution.x[:count]), strict=True)), rest

    def holding_flat(self, rest: Iterable[Edge]) -> dict[int, Point] | None:
        """Vectors whose sums are against the letters of these folds, and 0 at all other folds.

        As many of the sums as possible are not 0. Sums that have to be 0 are exactly 0. None if no
        such vectors are found.
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
        solution = linprog(
            np.concatenate([np.full(2 * size, _SHORT), -np.ones(many)]),
            A_ub=sparse.hstack([turned, -turned, sparse.identity(many)], format="csr"),
            b_ub=np.zeros(many),
            A_eq=equal if others else None,
            b_eq=np.zeros(len(others)) if others else None,
            bounds=[(0, None)] * (2 * size) + [(0, 1)] * many,
            method="highs",
            options=self.options,
        )
        if solution.status != 0:
            return None
        y = solution.x[:size] - solution.x[size : 2 * size]
        return self._exact(y, sums @ y) if np.abs(y).max() > 0 else None

    def motion(self, wanted: Iterable[Edge] | None = None) -> dict[Edge, float] | None:
        """A motion in which all wanted folds bend their way as much as possible; None if none can.

        By default all folds with letters are wanted.
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
        solution = linprog(
            goal,
            A_ub=limits,
            b_ub=np.zeros(len(at)),
            A_eq=equal,
            b_eq=np.zeros(equal.shape[0]),
            bounds=[(-1, 1)] * count + [(None, 1)],
            method="highs",
            options=self.options,
        )
        if solution.status != 0 or not solution.x[-1] > _TIGHT:
            return None
        return dict(zip(self.folds, map(float, solution.x[:-1]), strict=True))

    def extreme_motions(
        self, inner: Mapping[Edge, float], number: int
    ) -> Iterator[dict[Edge, float]]:
        """Motions with the letters at random vertices of the linear program; the seed is fixed.

        `inner` is a motion in which each fold with a letter bends its way by some amount. In the
        motions found it bends its way by at least a tenth of the least of these amounts, no density
        exceeds 1, and a random linear function is the largest.
        """
        sides = [SIDES.get(self.letters[edge], 0) for edge in self.folds]
        ways = [s * inner[edge] for s, edge in zip(sides, self.folds, strict=True) if s]
        least = _INNER * min(ways, default=0.0)
        bounds = [(least if s > 0 else -1.0, -least if s < 0 else 1.0) for s in sides]
        random = np.random.default_rng(1)
        for _ in range(number):
            solution = linprog(
                random.standard_normal(len(self.folds)),
                A_eq=self.matrix,
                b_eq=np.zeros(self.matrix.shape[0]),
                bounds=bounds,
                method="highs",
                options=self.options,
            )
            if solution.status == 0:
                yield dict(zip(self.folds, map(float, solution.x), strict=True))

    def refutation(self, wanted: Iterable[Edge] | None = None) -> PanelRefutation | None:
        """Vectors that show that not all wanted folds can bend their way; None if none are found.

        By default all folds with letters are wanted; the other letters are free. A linear program
        proposes small vectors at few vertices, which are then made exact where their sums vanish.
        None decides nothing.
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
        turned = sparse.diags(signs) @ sums[at]  # each sum is at most 0, and their total is -1
        upper = sparse.hstack([turned, -turned], format="csr")
        equal = [sparse.csr_matrix(signs @ sums[at])]
        if free:
            equal.append(sums[free])
        both = sparse.vstack(equal)
        solution = linprog(
            np.ones(2 * size),
            A_ub=upper,
            b_ub=np.zeros(len(held)),
            A_eq=sparse.hstack([both, -both], format="csr"),
            b_eq=np.append(-1.0, np.zeros(len(free))),
            method="highs",
            options=self.options,
        )
        if solution.status != 0:
            return None
        y = solution.x[:size] - solution.x[size:]
        exact = self._exact(y, sums @ y)
        if exact is None:
            return None
        refutation = PanelRefutation(exact)
        return refutation if refutation.holds_on(self.stars, letters) else None

    def _exact(self, y: FloatArray, sums: FloatArray) -> dict[int, Point] | None:
        """Exact vectors near those given.

        They are 0 where the given vectors are 0, and their sums are 0 where the given sums are 0.
        """
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

    Each equation is solved for the unknown whose coefficient is about the largest. All other
    unknowns get the given values, rounded to multiples of 2^-40. None if the computation takes too
    long.

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
    """The logarithm of the size of a number, approximately."""
    if isinstance(value, Surd):
        return log2(abs(float(value)))
    return int(value.p).bit_length() - int(value.q).bit_length()


def _bits(value: Entry) -> int:
    parts = value.parts if isinstance(value, Surd) else (value,)
    return sum(int(x.p).bit_length() + int(x.q).bit_length() for x in parts)


def _near(value: float) -> fmpq:
    near = Fraction(round(value * (1 << _PLACES)), 1 << _PLACES)
    return fmpq(near.numerator, near.denominator)
