"""The folds at each vertex that are able to fold: the flat closure."""

from __future__ import annotations

from collections.abc import Container, Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import TypeAlias

from exactfold.exact.surds import Number, sign
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point

Twist: TypeAlias = tuple[Number, Number, Number]
"""The line of a fold: its direction d = (x, y), and the moment p x d of a point p on it."""


@dataclass(frozen=True)
class Hole:
    """The folds that are crossed on a way round a hole, counter-clockwise, and their lines.

    `number` counts the holes from 0, and `rank` is the dimension of the span of the twists.
    """

    number: int
    folds: tuple[Edge, ...]
    twists: tuple[Twist, ...]
    rank: int


@dataclass(frozen=True)
class Star:
    """The folds at an interior vertex that may fold, counter-clockwise, with their directions.

    `directions[k]` points along `folds[k]` away from the vertex. Let w be fold angle / length. The
    first-order motions are the w with sum_k w_k d_k = 0. The second-order condition is sum_{k<j}
    w_k w_j [d_k, d_j] = 0; its left side is twice the signed area of the gradient polygon.

    The conditions round a hole are those of one or three such stars, whose `vertex` is a number
    beyond all vertices (`exactfold.panels.vertex.holes`). Then `hole` is the hole, and `directions`
    are two of three coordinates of the lines of the folds. `conditions` is the number of
    independent conditions of first order that the star adds to those of other stars, and `has_form`
    says whether it has a condition of second order.
    """

    vertex: int
    folds: tuple[Edge, ...]
    directions: tuple[Point, ...]
    hole: Hole | None = None

    @property
    def conditions(self) -> int:
        """1 for a straight pair, else 2; those round a hole are as many as its rank."""
        if self.hole is not None:
            return 2 if self.hole.rank == 2 else 1
        return 1 if len(self.folds) == 2 else 2

    @property
    def has_form(self) -> bool:
        """Whether the second-order condition is not empty."""
        return len(self.folds) > 2 if self.hole is None else self.hole.rank > 1

    def form(self, w: Sequence[Number]) -> Number:
        """The left side of the second-order condition at w: twice the area of the gradient polygon.

        >>> right = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1)))
        >>> right.form((1, 0, 1, 0)), right.form((1, 1, 1, 1))
        (0, 2)
        """
        total: Number = 0
        for j, (dj, wj) in enumerate(zip(self.directions, w, strict=True)):
            for dk, wk in zip(self.directions[:j], w[:j], strict=True):
                total = total + wk * wj * bracket(dk, dj)
        return total

    def derivative(self, w: Sequence[Number]) -> list[Number]:
        """The gradient of `form` at w.

        >>> right = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1)))
        >>> right.derivative((1, 0, 1, 0))
        [0, 2, 0, 0]
        """
        gradient: list[Number] = []
        for j, dj in enumerate(self.directions):
            total: Number = 0
            for k, (dk, wk) in enumerate(zip(self.directions, w, strict=True)):
                if k != j:
                    total = total + wk * (bracket(dk, dj) if k < j else bracket(dj, dk))
            gradient.append(total)
        return gradient

    def only(self, folds: Iterable[Edge]) -> Star:
        """The star of these folds alone; the other folds are held flat.

        That of a hole keeps its number of conditions, which may now depend on each other.
        """
        wanted = set(folds)
        kept = [k for k, edge in enumerate(self.folds) if edge in wanted]
        return Star(
            self.vertex,
            tuple(self.folds[k] for k in kept),
            tuple(self.directions[k] for k in kept),
            self.hole,
        )

    def foldable(self) -> tuple[int, ...]:
        """The positions of the folds that can fold here; the others are flat in every real motion.

        Consider the form on the space of local motions, of dimension N - 2, when the folds do not
        all lie on one line. Its inertia is (1, N-3, 0) if all sectors are less than pi, (0, N-3, 1)
        if one sector is pi, and (0, N-2, 0) if one sector exceeds pi. If one sector is pi, only the
        straight pair at that sector can fold; if one exceeds pi, no fold can. Three folds whose
        sectors are all less than pi have a definite form.

        >>> Star(0, ((0, 1), (0, 2), (0, 3)), ((1, 0), (0, 1), (-1, 0))).foldable()
        (0, 2)
        >>> Star(0, ((0, 1), (0, 2), (0, 3)), ((1, 0), (0, 1), (-1, -1))).foldable()
        ()
        """
        count = len(self.folds)
        for k in range(count):
            first, second = k, (k + 1) % count
            a, b = self.directions[first], self.directions[second]
            turn = sign(bracket(a, b))
            if turn == 0 and first != second and sign(dot(a, b)) < 0:
                return tuple(sorted((first, second)))
            if turn < 0:
                return ()
        return tuple(range(count)) if count >= 4 else ()


def bracket(a: Point, b: Point) -> Number:
    """The cross product a x b."""
    return a[0] * b[1] - a[1] * b[0]


def dot(a: Point, b: Point) -> Number:
    """The scalar product."""
    return a[0] * b[0] + a[1] * b[1]


def stars(pattern: PanelPattern, flat: Iterable[Edge] = ()) -> Mapping[int, Star]:
    """The star of every interior vertex at which some fold can fold, after the flat closure.

    Folds in `flat` are held flat. At each vertex the folds that cannot fold in any real motion are
    removed (`Star.foldable`). This may make a fold flat at its other end, so the step is repeated
    until nothing changes. Each remaining star is a straight pair, or has at least four folds with
    all sectors less than pi. A fold that ends at an interior vertex but lies in no star is flat in
    every real motion.

    >>> from exactfold.pattern.panel_pattern import PanelPattern
    >>> corner = PanelPattern([(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)],
    ...     [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4)])
    >>> stars(corner)[4].folds
    ((2, 4), (0, 4))
    """
    pattern.check_disk()
    return flat_closure(pattern, set(flat))


def flat_closure(pattern: PanelPattern, gone: set[Edge]) -> Mapping[int, Star]:
    """The stars of interior vertices as `stars` has them; holes, if there are any, do not count.

    `gone` has the folds that are held flat, and receives all others that stay flat.
    """
    remaining: dict[int, Star] = {}
    waiting = dict.fromkeys(pattern.interior)
    while waiting:
        v, _ = waiting.popitem()
        star = star_at(pattern, v, gone)
        kept = star.foldable() if star.folds else ()
        for k, edge in enumerate(star.folds):
            if k not in kept:
                gone.add(edge)
                if (u := sum(edge) - v) in pattern.stars:
                    waiting[u] = None
        remaining[v] = star.only(star.folds[k] for k in kept)
    return MappingProxyType({v: remaining[v] for v in pattern.interior if remaining[v].folds})


def incidence(stars: Mapping[int, Star]) -> dict[Edge, tuple[int, ...]]:
    """The stars that each fold belongs to.

    >>> incidence({0: Star(0, ((0, 1), (0, 2)), ((1, 0), (-2, 0)))})
    {(0, 1): (0,), (0, 2): (0,)}
    """
    found: dict[Edge, list[int]] = {}
    for v, star in stars.items():
        for edge in star.folds:
            found.setdefault(edge, []).append(v)
    return {edge: tuple(at) for edge, at in found.items()}


def star_at(pattern: PanelPattern, vertex: int, flat: Container[Edge] = ()) -> Star:
    """All folds at an interior vertex but for those that are held flat."""
    ends = [u for u in pattern.stars[vertex] if edge_of(vertex, u) not in flat]
    return Star(
        vertex,
        tuple(edge_of(vertex, u) for u in ends),
        tuple(pattern.direction(vertex, u) for u in ends),
    )


def edge_of(i: int, j: int) -> Edge:
    """The edge as a sorted pair."""
    return (i, j) if i < j else (j, i)
