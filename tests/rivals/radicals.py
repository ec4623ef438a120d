"""Heights of branches as nested square roots, for patterns built by H1 moves."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TypeAlias

import sympy
from flint import fmpq, fmpq_mat

from exactfold.errors import NotApplicableError, SolverError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern, Triangle
from exactfold.pattern.validate import orientation
from exactfold.rigidity.curvature import curvature_form
from exactfold.solve.algebraic.quotient import QuotientAlgebra

Element: TypeAlias = tuple[Fraction, ...]
Move: TypeAlias = tuple[int, int, int, int]


def h1_moves(pattern: CreasePattern) -> tuple[Move, ...] | None:
    """H1 moves (v1, v2, v3, w) that build the pattern from two triangles; None if there are none.

    Each move joins a new boundary vertex w to consecutive boundary vertices v1, v2, v3, which are
    not collinear. Then v2 becomes interior. The moves are found backwards, by removing boundary
    vertices of degree three. Their order need not be the order in which the pattern was built.

    >>> from exactfold.pattern.families import h1_sequence, single_vertex
    >>> [w for *_, w in h1_moves(h1_sequence(3))], h1_moves(single_vertex(5))
    ([2, 3, 6], None)
    """
    if pattern.Ve != 4:
        return None
    found = _peel(pattern, frozenset(pattern.triangles), tuple(pattern.boundary))
    return None if found is None else tuple(reversed(found))


def _peel(
    pattern: CreasePattern, triangles: frozenset[Triangle], boundary: tuple[int, ...]
) -> list[Move] | None:
    if len(triangles) == 2:
        return []
    points, _ = pattern.integer_vertices
    for k, w in enumerate(boundary):
        star = [t for t in triangles if w in t]
        if len(star) != 2:
            continue
        [v2] = set(star[0]) & set(star[1]) - {w}
        move = (boundary[k - 1], v2, boundary[(k + 1) % 4], w)
        if v2 in boundary or orientation(*(points[v] for v in move[:3])) == 0:
            continue
        rest = _peel(pattern, triangles - set(star), (*boundary[:k], v2, *boundary[k + 1 :]))
        if rest is not None:
            return [move, *rest]
    return None


@dataclass(frozen=True)
class Tower:
    """The ring Q[r_1, ..., r_m] with r_k^2 = radicands[k - 1], an element of Q[r_1, ..., r_(k-1)].

    An element is the tuple of the coefficients of the 2^k products of r_1, ..., r_k. Bit i of the
    position says whether r_(i+1) is a factor. An identity in this ring holds for every choice of
    the signs of the roots, even if some radicand is a square.

    >>> tower = Tower(((Fraction(2),), (Fraction(1), Fraction(1))))  # sqrt(2), sqrt(1 + sqrt(2))
    >>> root = (Fraction(0), Fraction(0), Fraction(1), Fraction(0))
    >>> [int(c) for c in tower.times(root, root)]
    [1, 1, 0, 0]
    """

    radicands: tuple[Element, ...]

    @property
    def dimension(self) -> int:
        """The dimension 2^m of the ring over Q, for m roots."""
        return 1 << len(self.radicands)

    def widened(self, a: Element) -> Element:
        """The element with all 2^m coefficients."""
        return a + (Fraction(0),) * (self.dimension - len(a))

    def times(self, a: Element, b: Element) -> Element:
        """The product of two elements of the same level."""
        if len(a) == 1:
            return (a[0] * b[0],)
        half = len(a) // 2
        radicand = self.radicands[half.bit_length() - 1]
        low = self.times(a[:half], b[:half])
        if any(a[half:]) and any(b[half:]):
            high = self.times(self.times(a[half:], b[half:]), radicand)
            low = tuple(x + y for x, y in zip(low, high, strict=True))
        cross = self.times(a[:half], b[half:]), self.times(a[half:], b[:half])
        return low + tuple(x + y for x, y in zip(*cross, strict=True))

    @cached_property
    def algebra(self) -> QuotientAlgebra:
        """The ring as a quotient algebra in the unknowns r_k, for `root_classes`."""
        size = self.dimension
        units = [tuple(Fraction(i == k) for i in range(size)) for k in range(size)]
        levels = range(len(self.radicands))
        matrices = []
        for k in levels:
            images = [self.times(units[1 << k], unit) for unit in units]
            matrices.append(
                fmpq_mat(
                    [
                        [fmpq(x.numerator, x.denominator) for x in row]
                        for row in zip(*images, strict=True)
                    ]
                )
            )
        basis = tuple(tuple(mask >> k & 1 for k in levels) for mask in range(size))
        return QuotientAlgebra(basis, tuple(matrices))


@dataclass(frozen=True)
class BranchTower:
    """The branches of a pattern built by H1 moves, in a tower of square roots.

    `elements` holds the height of each vertex. Heights are scaled and changed by affine functions
    so that the first triangle has height 0 and the fourth vertex of the first quadrilateral has
    height 1. Each of the 2^m choices of signs of the roots r_k is a branch. If a radicand is zero,
    opposite signs of its root give the same branch, which is then a multiple solution.
    """

    pattern: CreasePattern
    moves: tuple[Move, ...]
    tower: Tower
    elements: tuple[Element, ...]

    def heights(self, signs: Sequence[int]) -> dict[int, sympy.Expr]:
        """The exact heights of all vertices on the branch with these signs (+1, -1) of the roots.

        Raises `UsageError` for a wrong number of signs.
        """
        if len(signs) != len(self.moves) or any(s not in (1, -1) for s in signs):
            raise UsageError(f"give {len(self.moves)} signs 1 or -1, not {tuple(signs)}")
        roots: list[sympy.Expr] = []
        for sign, radicand in zip(signs, self.tower.radicands, strict=True):
            roots.append(sign * sympy.sqrt(_expression(radicand, roots)))
        return {v: _expression(a, roots) for v, a in enumerate(self.elements)}

    def verify(self) -> None:
        """Checks by substitution, exactly in the tower, that every curvature form vanishes.

        Raises `SolverError` if one does not.
        """
        for v in self.pattern.interior:
            form = curvature_form(self.pattern, v)
            heights = [self.elements[u] for u in form.labels]
            total = self.tower.widened((Fraction(0),))
            for row, left in zip(form.matrix, heights, strict=True):
                value = _combination(row, heights)
                total = tuple(
                    x + y for x, y in zip(total, self.tower.times(left, value), strict=True)
                )
            if any(total):
                raise SolverError(f"the curvature form of vertex {v} does not vanish")


def branch_tower(pattern: CreasePattern) -> BranchTower:
    """All branches of a pattern built by H1 moves, as nested square roots; verified.

    When a move joins w to v1, v2, v3, the form of v2 is the only new equation. It is
    a x^2 + 2 b x + c = 0 in x = h_w, where b and c are polynomials in the heights known before, and
    a = -c_13 / (2 c_1w c_w3) is a rational number that is not 0 (docs/mathematics.md, Curvature
    form). So x = -b/a + r with r^2 = (b/a)^2 - c/a. Each move adds a square root, so that the
    degree of the field of a branch is a power of 2. No branch is missing: if the first fold is
    flat, all heights are zero.

    Raises `NotApplicableError` if the pattern is not built by H1 moves (`h1_moves`).

    >>> from exactfold.pattern.families import h1_sequence
    >>> branch_tower(h1_sequence(1)).heights((-1,))[1]
    32/5 - 32*sqrt(111)/45
    """
    moves = h1_moves(pattern)
    if moves is None:
        raise NotApplicableError("the pattern is not built by H1 moves")
    radicands: list[Element] = []
    known: dict[int, Element] = _first_quadrilateral(pattern, moves)
    for _, v2, _, w in moves:
        tower = Tower(tuple(radicands))
        form = curvature_form(pattern, v2)
        k = form.labels.index(w)
        lead = form.matrix[k][k]
        others = [i for i in range(len(form.labels)) if i != k]
        heights = [tower.widened(known[form.labels[i]]) for i in others]
        shift = _combination([-form.matrix[k][i] / lead for i in others], heights)
        radicand = tower.times(shift, shift)
        for i, left in zip(others, heights, strict=True):
            value = _combination([form.matrix[i][j] / lead for j in others], heights)
            product = tower.times(left, value)
            radicand = tuple(x - y for x, y in zip(radicand, product, strict=True))
        radicands.append(radicand)
        root = (Fraction(1),) + (Fraction(0),) * (tower.dimension - 1)
        known[w] = shift + root
    tower = Tower(tuple(radicands))
    elements = tuple(tower.widened(known[v]) for v in range(len(pattern.vertices)))
    found = BranchTower(pattern, moves, tower, elements)
    found.verify()
    return found


def _first_quadrilateral(pattern: CreasePattern, moves: Sequence[Move]) -> dict[int, Element]:
    """The heights 0, 0, 0, 1 of the two triangles that exist before the moves."""
    added = {w for *_, w in moves}
    first, second = (t for t in pattern.triangles if added.isdisjoint(t))
    return {v: (Fraction(v not in first),) for v in {*first, *second}}


def _combination(weights: Sequence[Fraction], elements: Sequence[Element]) -> Element:
    """The sum of weights_i elements_i."""
    total = [Fraction(0)] * len(elements[0])
    for weight, element in zip(weights, elements, strict=True):
        if weight:
            total = [x + weight * y if y else x for x, y in zip(total, element, strict=True)]
    return tuple(total)


def _expression(element: Element, roots: Sequence[sympy.Expr]) -> sympy.Expr:
    """The element as an expression in the roots r_k."""
    terms = []
    for mask, c in enumerate(element):
        if c:
            factors = [root for k, root in enumerate(roots) if mask >> k & 1]
            terms.append(sympy.Mul(sympy.Rational(c.numerator, c.denominator), *factors))
    return sympy.Add(*terms)
