"""Motions of sheets with vertices of any degree: linear spaces, and cones where forms remain."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final, TypeAlias

import networkx as nx
from flint import arb, fmpq

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.plurals import counted
from exactfold.errors import TooManyModesError
from exactfold.exact.joined_fields import joined
from exactfold.exact.surds import Number, ball, common_field, real_root, sign
from exactfold.panels.spaces.kernel import Entry, Rows, entry, imposed, number
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge

Vector: TypeAlias = list[Entry]
Squares: TypeAlias = list[tuple[Entry, Vector]]
MOST_ROOTS: Final = 5
_BITS: Final = 53


@dataclass(frozen=True)
class Leaf:
    """A part of the motions: a linear space, or its points at which the remaining forms vanish.

    `rows` gives the density of each active fold as a linear function of `size` parameters.
    `vertices` are those whose form does not vanish on the space; each of these forms has one sign
    once and the other sign at least twice. `dimension` is that of the real solutions if they are
    one component; with two or more forms this has to be shown (docs/panels.md, Double covers).
    """

    rows: Mapping[Edge, tuple[Number, ...]]
    size: int
    vertices: tuple[int, ...]

    def __repr__(self) -> str:
        left = f", {counted(len(self.vertices), 'form')} left" if self.vertices else ""
        return f"<Leaf: {counted(len(self.rows), 'fold')}, dimension {self.size}{left}>"

    @property
    def dimension(self) -> int:
        """The dimension of the space minus the number of remaining forms."""
        return self.size - len(self.vertices)

    @property
    def folds(self) -> tuple[Edge, ...]:
        """The folds that are not flat on the whole leaf."""
        return tuple(sorted(self.rows))


def leaves(
    stars: Mapping[int, Star], rows: Rows, size: int, most: int, clock: Clock = UNLIMITED
) -> list[Leaf]:
    """The real motions to second order as a union of leaves, none of which lies in another.

    `rows` is the space of first-order motions. On a linear space, a semidefinite form leaves its
    kernel. A form of inertia (1, 1) is a product of two linear forms, over the field with the
    square root of its discriminant, and splits the space. Other forms remain. Parts of the sheet
    that share no active fold are independent, because every condition belongs to a single vertex.

    Raises `TooManyModesError` if this takes more than `most` steps. A step is one fold of a vertex
    times one dimension, times the square of the degree of the field. It also raises this error when
    the clock has passed.
    """
    return SubspaceSearch(stars, most, clock).leaves(rows, size)


class SubspaceSearch:
    """The splitting of spaces of motions, with a limit on its work; `TooManyModesError` beyond.

    `sums` says whether a semidefinite form met was a sum of several squares. The complex zeros of
    such a form have a larger dimension than its kernel.
    """

    def __init__(self, stars: Mapping[int, Star], most: int, clock: Clock = UNLIMITED) -> None:
        self.stars = stars
        self.most = most
        self.clock = clock
        self.work = self._kept = 0
        self.sums = False

    def leaves(self, rows: Rows, size: int) -> list[Leaf]:
        """The leaves of a space without the flat state."""
        return [leaf for leaf in self.solved(dict(rows), size) if leaf.size]

    def solved(self, rows: Rows, size: int, settled: frozenset[int] = frozenset()) -> list[Leaf]:
        """The leaves of one space: the product of the leaves of its independent parts.

        The forms of `settled` vertices are known to vanish on the space.
        """
        total: list[Leaf] = [Leaf({}, 0, ())]
        for part, part_size in independent_parts(rows, size, self.stars):
            part_leaves = _maximal(self._split(part, part_size, settled))
            total = [_sum(a, b) for a in total for b in part_leaves]
            self.count(len(total))
        return total

    def count(self, steps: int) -> None:
        """Add to the work done. A limit of work makes the search end in the same way on every
        machine, unless the clock ends it before.
        """
        self.clock.check()
        self.work += steps
        if self.work > self.most:
            raise TooManyModesError(
                "splitting its spaces of motions one by one takes more work than is allowed"
            )

    def _split(self, rows: Rows, size: int, settled: frozenset[int]) -> list[Leaf]:
        """The leaves of a part, without some that lie in leaves found before.

        The form of the chosen vertex has two linear factors. First the space on which one of them
        vanishes is split. After that, motions on which the other vanishes are wanted only where the
        first does not. So the first factor is kept as a row, the density of a fold that is not in
        the sheet (`_is_kept`), and spaces on which it vanishes are left out.
        """
        kept = sum(map(_is_kept, rows))
        rows, size, found = self._reduced(rows, size, settled)
        if sum(map(_is_kept, rows)) < kept:
            return []
        if not found.products:
            return [made_leaf(rows, size, found.left)]
        v, (one, other) = self._chosen(found, rows)
        now = found.settled | {v}
        solutions: list[Leaf] = []
        child, child_size = imposed(rows, size, one)
        if sum(map(_is_kept, child)) == kept:
            solutions += self.solved(child, child_size, now)
        self._kept += 1
        child, child_size = imposed({**rows, (v, -self._kept): one}, size, other)
        if sum(map(_is_kept, child)) == kept + 1:
            solutions += self.solved(child, child_size, now)
        return solutions

    def _chosen(self, found: _Forms, rows: Rows) -> tuple[int, tuple[Vector, Vector]]:
        """The vertex whose form is split next, and the factors of its form.

        It needs no new square root, if there is such a vertex, and it has the most neighbours that
        are settled, so that loops close early.
        """

        def rank(v: int) -> tuple[int, int, int]:
            folds = [edge for edge in self.stars[v].folds if edge in rows]
            near = sum(u in found.settled for edge in folds for u in edge)
            return -near, len(folds), v

        order = sorted(found.products, key=rank)
        k, both = _factored([found.products[v] for v in order], rows, MOST_ROOTS)
        return order[k], both

    def reduced(self, rows: Rows, size: int) -> tuple[Rows, int, list[Squares], list[int]]:
        """The space after all semidefinite forms; the forms that split; the vertices with other
        forms.
        """
        rows, size, found = self._reduced(rows, size, frozenset())
        return rows, size, list(found.products.values()), found.left

    def _reduced(self, rows: Rows, size: int, settled: frozenset[int]) -> tuple[Rows, int, _Forms]:
        known = set(settled)
        while True:
            products: dict[int, Squares] = {}
            left: list[int] = []
            before = size
            weight = common_field(x for row in rows.values() for x in row).dimension ** 2
            for v in sorted({v for edge in rows for v in edge if v in self.stars} - known):
                self.count(len(self.stars[v].folds) * size * weight)
                squares = squares_of(self.stars[v], rows, size, self.clock)
                if is_semidefinite(squares):
                    self.sums = self.sums or len(squares) > 1
                    rows, size = imposed(rows, size, *(functional for _, functional in squares))
                if not squares or is_semidefinite(squares):
                    known.add(v)
                elif len(squares) == 2:
                    products[v] = squares
                else:
                    left.append(v)
            if size == before:
                return rows, size, _Forms(products, left, frozenset(known))


@dataclass(frozen=True)
class _Forms:
    """The forms of vertices on a space: those that split, those left, and those that vanish."""

    products: dict[int, Squares]
    left: list[int]
    settled: frozenset[int]


def _is_kept(edge: Edge) -> bool:
    """Whether the row of this key is a factor that must not vanish; folds join two vertices."""
    return edge[1] < 0


def reduced(
    stars: Mapping[int, Star], rows: Rows, size: int, most: int, clock: Clock = UNLIMITED
) -> tuple[Rows, int, bool]:
    """The space after all semidefinite forms, and whether one of these was a sum of squares.

    It is unchanged if that takes more than `most` steps, or if the clock has passed.
    """
    search = SubspaceSearch(stars, most, clock)
    try:
        rows, size, _, _ = search.reduced(rows, size)
    except TooManyModesError:
        return rows, size, False
    return rows, size, search.sums


def is_semidefinite(squares: Squares) -> bool:
    """Whether a nonzero form takes only one sign."""
    signs = {sign(d) for d, _ in squares}
    return len(signs) == 1


def factors(
    products: Sequence[Squares], rows: Rows, most_roots: int = MOST_ROOTS
) -> tuple[Vector, Vector]:
    """The two linear factors of a form d1 l1^2 + d2 l2^2, where d1 and d2 have opposite signs.

    The form is d1 (l1 - r l2)(l1 + r l2) with r^2 = -d2 / d1. If several forms are given, one that
    needs no new square root is preferred. Raises `TooManyModesError` if a new root is needed and
    there are `most_roots` roots already.
    """
    return _factored(products, rows, most_roots)[1]


def _factored(
    products: Sequence[Squares], rows: Rows, most_roots: int
) -> tuple[int, tuple[Vector, Vector]]:
    """The place of the form that is chosen by `factors`, and its factors."""
    field = common_field(x for row in rows.values() for x in row)
    radicands = [-squares[1][0] / squares[0][0] for squares in products]
    known = (k for k, x in enumerate(radicands) if field.square_root(field.number(x)) is not None)
    k = next(known, None)
    if k is None:
        if len(field.radicands) >= most_roots:
            raise TooManyModesError(
                f"the spaces of motions need more than {most_roots} independent square roots"
            )
        k = 0
    root, squares = entry(real_root(radicands[k], field)), products[k]
    pairs = list(zip(squares[0][1], squares[1][1], strict=True))
    return k, ([x - root * y for x, y in pairs], [x + root * y for x, y in pairs])


def made_leaf(rows: Rows, size: int, left: Iterable[int]) -> Leaf:
    """A leaf of these rows; `left` are the vertices whose forms remain."""
    folds = (edge for edge in rows if not _is_kept(edge))
    numbers = {edge: tuple(number(x) for x in rows[edge]) for edge in folds}
    return Leaf(numbers, size, tuple(left))


def squares_of(star: Star, rows: Rows, size: int, clock: Clock = UNLIMITED) -> Squares:
    """The form of a vertex on the space, as sum d_i l_i^2 with independent l_i.

    One product of numbers with many nested roots may take long, so the clock is asked in between.
    Raises `TooManyModesError` if it has passed.
    """
    local = [(d, rows[e]) for e, d in zip(star.folds, star.directions, strict=True) if e in rows]
    directions = [(entry(x), entry(y)) for (x, y), _ in local]
    basis, coordinates = _row_space([row for _, row in local], size)
    count = len(basis)
    # The density of fold k is sum_a coordinates[k][a] basis[a].
    form: list[Vector] = [[fmpq(0)] * count for _ in range(count)]
    for j, dj in enumerate(directions):
        for k, dk in enumerate(directions[:j]):
            clock.check()
            c = dk[0] * dj[1] - dk[1] * dj[0]
            if not c:
                continue
            for a in range(count):
                if not (left := coordinates[k][a]):
                    continue
                for b in range(count):
                    if coordinates[j][b]:
                        term = c * left * coordinates[j][b]
                        form[a][b] = form[a][b] + term
                        form[b][a] = form[b][a] + term
    return [(d, _combined(functional, basis, size)) for d, functional in _diagonalised(form, clock)]


def _row_space(rows: Sequence[Sequence[Entry]], size: int) -> tuple[list[Vector], list[Vector]]:
    """A basis of the span of the rows, chosen among the rows, and every row in that basis."""
    basis: list[Vector] = []
    reduced: list[tuple[int, Vector, Vector]] = []  # pivot, reduced row, in terms of the basis
    coordinates: list[Vector] = []
    for row in rows:
        work: Vector = list(row)
        terms: Vector = [fmpq(0)] * len(rows)
        for pivot, other, expressed in reduced:
            if factor := work[pivot]:
                pairs = zip(work, other, strict=True)
                work = [x - factor * y if y else x for x, y in pairs]
                terms = [x + factor * y for x, y in zip(terms, expressed, strict=True)]
        first = next((k for k, x in enumerate(work) if x), None)
        if first is not None:
            here = len(basis)
            basis.append(list(row))
            scale = work[first]
            expressed = [-x / scale for x in terms]
            expressed[here] = expressed[here] + 1 / scale
            reduced.append((first, [x / scale for x in work], expressed))
            terms = [fmpq(k == here) for k in range(len(rows))]
        coordinates.append(terms)
    return basis, [terms[: len(basis)] for terms in coordinates]


def row_rank(rows: Sequence[Sequence[Entry]], size: int) -> int:
    """The rank of a matrix of exact numbers.

    >>> row_rank([[fmpq(1), fmpq(2)], [fmpq(2), fmpq(4)]], 2)
    1
    """
    return len(_row_space(rows, size)[0])


def _diagonalised(form: Sequence[Sequence[Entry]], clock: Clock) -> list[tuple[Entry, Vector]]:
    """A symmetric matrix as sum d_i l_i^2 with d_i not 0, by completing squares."""
    size = len(form)
    work = [list(row) for row in form]
    squares: list[tuple[Entry, Vector]] = []
    while True:
        pivot = next((k for k in range(size) if work[k][k]), None)
        if pivot is None:
            pair = next(((i, j) for i in range(size) for j in range(i) if work[i][j]), None)
            if pair is None:
                return squares
            i, j = pair  # 2 m x y = m ((x + y)^2 - (x - y)^2) / 2, other terms included
            functional = [work[i][k] + work[j][k] for k in range(size)]
            value = 2 * work[i][j]
        else:
            functional, value = list(work[pivot]), work[pivot][pivot]
        weight = 1 / value
        squares.append((weight, functional))
        for a in range(size):
            clock.check()
            for b in range(size):
                if functional[a] and functional[b]:
                    work[a][b] = work[a][b] - weight * functional[a] * functional[b]


def _combined(weights: Sequence[Entry], vectors: Sequence[Vector], size: int) -> Vector:
    total: Vector = [fmpq(0)] * size
    for weight, vector in zip(weights, vectors, strict=True):
        if weight:
            pairs = zip(total, vector, strict=True)
            total = [x + weight * y if y else x for x, y in pairs]
    return total


def independent_parts(rows: Rows, size: int, stars: Mapping[int, Star]) -> list[tuple[Rows, int]]:
    """The space as a direct sum over the parts of the sheet that active folds connect."""
    graph = nx.Graph()
    for edge, row in rows.items():
        if any(row):
            ends = [v for v in edge if v in stars]
            graph.add_edges_from((edge, ("vertex", v)) for v in ends)
            graph.add_node(edge)
    groups = [
        sorted((node for node in group if node[0] != "vertex"), key=lambda e: (_is_kept(e), e))
        for group in nx.connected_components(graph)
    ]  # a kept factor depends on the folds of its vertex, so it is never in the basis below
    if len(groups) == 1 and len(groups[0]) == len(rows):
        return [(rows, size)]
    parts = []
    for group in groups:
        basis, coordinates = _row_space([rows[edge] for edge in group], size)
        parts.append((dict(zip(group, coordinates, strict=True)), len(basis)))
    return parts


def _sum(a: Leaf, b: Leaf) -> Leaf:
    """The direct sum of two leaves on different parts of the sheet."""
    zeros_a, zeros_b = (Fraction(0),) * a.size, (Fraction(0),) * b.size
    rows = {edge: row + zeros_b for edge, row in a.rows.items()}
    rows.update({edge: zeros_a + row for edge, row in b.rows.items()})
    return Leaf(rows, a.size + b.size, tuple(sorted(a.vertices + b.vertices)))


def _maximal(candidates: Iterable[Leaf]) -> list[Leaf]:
    """The leaves that lie in no other leaf; among equal leaves, the first."""
    kept: list[Leaf] = []
    for leaf in sorted(candidates, key=lambda leaf: (-leaf.size, len(leaf.vertices))):
        one = {
            edge: _value(row, map(arb, range(1, leaf.size + 1))) for edge, row in leaf.rows.items()
        }
        if not any(not _outside(one, other) and _inside(leaf, other) for other in kept):
            kept.append(leaf)
    return kept


def _outside(motion: Mapping[Edge, arb], leaf: Leaf) -> bool:
    """Whether balls show that a motion does not lie in the space of a leaf."""
    places: dict[int, Edge] = {}  # a fold for each parameter, whose density it is
    for edge, row in leaf.rows.items():
        some = [k for k, x in enumerate(row) if x]
        if len(some) == 1 and row[some[0]] == 1:
            places.setdefault(some[0], edge)
    if len(places) < leaf.size:
        return False
    zero = arb(0)
    at = [motion.get(places[k], zero) for k in range(leaf.size)]
    return any(
        not (motion.get(edge, zero) - _value(row, at)).contains(0)
        for edge, row in leaf.rows.items()
    )


def _value(row: Iterable[Number], at: Iterable[arb]) -> arb:
    """The value of a linear function at a point, in balls."""
    return sum((ball(x, _BITS) * y for x, y in zip(row, at, strict=True) if x), arb(0))


def _inside(leaf: Leaf, other: Leaf) -> bool:
    """Whether the motions of one leaf lie in the space of another, and so in the other leaf.

    A leaf contains all motions in its space, because the remaining forms vanish at every motion,
    too.
    """
    if not set(leaf.rows) <= set(other.rows):
        return False
    folds = list(other.rows)
    zero = (Fraction(0),) * leaf.size
    columns = [[*other.rows[edge], *leaf.rows.get(edge, zero)] for edge in folds]
    entries = [[entry(x) for x in row] for row in joined(columns)]
    both, _ = _row_space(_transposed(entries), len(folds))
    return len(both) == other.size


def _transposed(rows: Sequence[Sequence[Entry]]) -> list[Vector]:
    return [list(column) for column in zip(*rows, strict=True)]
