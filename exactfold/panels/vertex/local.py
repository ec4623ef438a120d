"""The one-dimensional motions of a vertex with four folds or a straight pair."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from exactfold.exact.surds import Number, common_field, exact, real_root, simple
from exactfold.panels.vertex.stars import Star, bracket
from exactfold.pattern.panel_pattern import Edge


@dataclass(frozen=True)
class LocalMode:
    """One line of motions at a vertex; `values[k]` is the fold density of `folds[k]`.

    Folds with value 0 are left out, so every listed fold is active. Densities are fold angle /
    length, up to a common factor. `index` distinguishes the modes of a vertex.
    """

    vertex: int
    index: int
    folds: tuple[Edge, ...]
    values: tuple[Number, ...]

    def gain(self, start: Edge, end: Edge) -> Number:
        """The density of `end` divided by the density of `start`."""
        return self.values[self.folds.index(end)] / exact(self.values[self.folds.index(start)])


def local_modes(star: Star) -> tuple[LocalMode, ...]:
    """The motions to second order of a vertex with at most four folds, after the flat closure.

    A straight pair has one mode, the straight crease. Four folds whose sectors are all less than pi
    have two modes. They are the zeros of a form of inertia (1, 1, 0) on the plane of the local
    motions, and the discriminant gives them. A value is 0 exactly if there is a straight pair. The
    computation is exact: the values lie in the field of the coordinates, or in that field with one
    square root adjoined.

    >>> star = Star(4, ((0, 4), (1, 4), (2, 4), (3, 4)), ((2, 1), (-1, 1), (-1, -1), (1, -2)))
    >>> modes = local_modes(star)
    >>> [star.form(mode.values) for mode in modes], modes[0].folds == star.folds
    ([0, 0], True)
    """
    if len(star.folds) == 2:
        one, other = star.directions
        axis = 0 if one[0] != 0 else 1
        ratio = -one[axis] / exact(other[axis])
        return (_mode(star, 0, (Fraction(1), ratio)),)
    first, second = _plane(star)
    both = [x + y for x, y in zip(first, second, strict=True)]
    a, c = star.form(first), star.form(second)
    twice_b = star.form(both) - a - c  # a x^2 + 2 b x y + c y^2
    if a == 0:
        lines: list[tuple[Number, Number]] = [(1, 0), (-c, twice_b)]
    else:
        square = twice_b * twice_b - 4 * a * c
        root = real_root(square, common_field((a, c, square)))
        lines = [(-twice_b + s * root, 2 * a) for s in (1, -1)]
    return tuple(
        _mode(star, k, [x * p + y * q for p, q in zip(first, second, strict=True)])
        for k, (x, y) in enumerate(lines)
    )


def _plane(star: Star) -> tuple[list[Number], list[Number]]:
    """Two independent local motions of four folds, each with one fold flat.

    In the first motion fold 0 is flat.
    """
    d = star.directions
    motions: list[list[Number]] = []
    for skip in range(4):
        i, j, k = (n for n in range(4) if n != skip)
        w: list[Number] = [Fraction(0)] * 4
        # w_i d_i + w_j d_j + w_k d_k = 0 with the brackets of the opposite pairs (Cramer)
        w[i], w[j], w[k] = bracket(d[j], d[k]), bracket(d[k], d[i]), bracket(d[i], d[j])
        if not motions or any(
            motions[0][p] * w[q] != motions[0][q] * w[p] for p in range(4) for q in range(p)
        ):
            motions.append(w)
        if len(motions) == 2:
            break
    return motions[0], motions[1]


def _mode(star: Star, index: int, values: Sequence[Number]) -> LocalMode:
    kept = [k for k, value in enumerate(values) if value != 0]
    scale = exact(values[kept[0]])
    return LocalMode(
        star.vertex,
        index,
        tuple(star.folds[k] for k in kept),
        tuple(simple(exact(values[k]) / scale) for k in kept),
    )
