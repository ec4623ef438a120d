"""The folds at each vertex that can fold at all: the flat closure."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType

from exactfold.exact.surds import Number, sign
from exactfold.pattern.panel_pattern import Edge, PanelPattern, Point


@dataclass(frozen=True)
class Star:
    """The folds at an interior vertex that may fold, counter-clockwise, with their directions.

    `directions[k]` points along `folds[k]` away from the vertex. The first-order motions are the
    `w` with `sum_k w_k d_k = 0`, where w is fold angle / length, and the second-order condition is
    `sum_{k<j} w_k w_j [d_k, d_j] = 0` (the signed area of the gradient polygon, doubled).
    """

    vertex: int
    folds: tuple[Edge, ...]
    directions: tuple[Point, ...]

    def form(self, w: Sequence[Number]) -> Number:
        """The second-order condition at w, twice the signed area of the gradient polygon.

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
        found: list[Number] = []
        for j, dj in enumerate(self.directions):
            total: Number = 0
            for k, (dk, wk) in enumerate(zip(self.directions, w, strict=True)):
                if k != j:
                    total = total + wk * (bracket(dk, dj) if k < j else bracket(dj, dk))
            found.append(total)
        return found

    def only(self, folds: Iterable[Edge]) -> Star:
        """The star with these folds, the others held flat."""
        wanted = set(folds)
        kept = [k for k, edge in enumerate(self.folds) if edge in wanted]
        return Star(
            self.vertex,
            tuple(self.folds[k] for k in kept),
            tuple(self.directions[k] for k in kept),
        )

    def foldable(self) -> tuple[int, ...]:
        """Positions of the folds that can fold here; the others are flat in every real motion.

        If not all folds lie on one line, the form on the N - 2 dimensional space of local motions
        has inertia (1, N-3, 0) if all sectors are less than pi, (0, N-3, 1) if one is pi and
        (0, N-2, 0) if one exceeds pi: then only the straight pair at that sector folds, or nothing.
        Three folds with all sectors below pi have a definite form.

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
    """a x b."""
    return a[0] * b[1] - a[1] * b[0]


def dot(a: Point, b: Point) -> Number:
    """The scalar product."""
    return a[0] * b[0] + a[1] * b[1]


def stars(pattern: PanelPattern, flat: Iterable[Edge] = ()) -> Mapping[int, Star]:
    """The star of every interior vertex where something can fold, after the flat closure.

    Folds in `flat` are held flat. At each vertex, folds that cannot fold in any real motion are
    taken away (`Star.foldable`), which may leave a fold flat at its other end, and so on until
    nothing changes. What is left has at each vertex a straight pair, or four or more folds with all
    sectors less than pi. A fold that is not in any star and ends at an interior vertex is flat in
    every real motion.

    >>> from exactfold.pattern.panel_pattern import PanelPattern
    >>> corner = PanelPattern([(0, 0), (2, 0), (2, 2), (0, 2), (1, 1)],
    ...     [(0, 1), (1, 2), (2, 3), (3, 0), (0, 4), (1, 4), (2, 4)])
    >>> stars(corner)[4].folds
    ((2, 4), (0, 4))
    """
    gone = set(flat)
    found: dict[int, Star] = {}
    waiting = dict.fromkeys(pattern.interior)
    while waiting:
        v, _ = waiting.popitem()
        around = [(edge_of(v, u), u) for u in pattern.stars[v] if edge_of(v, u) not in gone]
        star = Star(
            v,
            tuple(edge for edge, _ in around),
            tuple(pattern.direction(v, u) for _, u in around),
        )
        kept = star.foldable() if around else ()
        for k, (edge, u) in enumerate(around):
            if k not in kept:
                gone.add(edge)
                if u in pattern.stars:
                    waiting[u] = None
        found[v] = star.only(star.folds[k] for k in kept)
    return MappingProxyType({v: found[v] for v in pattern.interior if found[v].folds})


def edge_of(i: int, j: int) -> Edge:
    """The edge as a sorted pair."""
    return (i, j) if i < j else (j, i)
