"""Parts of a sheet whose vertices have more than four folds: spaces of motions, and which fold."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction

from exactfold.errors import TooManyModesError
from exactfold.exact.joined_fields import rank_at_least
from exactfold.exact.surds import Number, exact
from exactfold.modes.extension import extension
from exactfold.modes.kernel import Rows, first_order
from exactfold.modes.local import LocalMode
from exactfold.modes.result import Part
from exactfold.modes.stars import Star
from exactfold.modes.subspaces import Leaf, independent_parts, leaves
from exactfold.pattern.panel_pattern import Edge, PanelPattern
from exactfold.verdict import PROVED
from exactfold.wording import counted

MOST_DIMENSION = 16
MOST_STEPS = 150_000


def by_spaces(pattern: PanelPattern, moving: Mapping[int, Star]) -> Part:
    """The motions of a part with vertices of any degree: linear spaces, and which of them fold.

    Raises `TooManyModesError` where several forms are left, or the spaces are too many.
    """
    vertices = tuple(moving)
    folds = len({edge for star in moving.values() for edge in star.folds})
    least = folds - 2 * len(vertices)  # each vertex has two conditions
    if least > MOST_DIMENSION:
        return _too_many(vertices, None, f"{least} or more")
    rows, size = first_order(moving)
    if size == 0:
        return Part(vertices, "subspaces", {0: 1}, {0: 1}, dimension=0)
    if size > MOST_DIMENSION:
        return _too_many(vertices, size, str(size))
    spaces = leaves(moving, rows, size, MOST_STEPS)
    counts: dict[int, int] = {}
    for leaf in spaces:
        if leaf.dimension is None:
            raise TooManyModesError(
                f"in a space of dimension {leaf.size} the conditions of vertices "
                f"{', '.join(map(str, leaf.vertices))} are left, and are not solved yet"
            )
        counts[leaf.dimension] = counts.get(leaf.dimension, 0) + 1
    if not counts:
        return Part(vertices, "subspaces", {0: 1}, {0: 1}, dimension=size)
    ordered = dict(sorted(counts.items()))
    folding = [_extends(pattern, moving, leaf) for leaf in spaces]
    alone = len(moving) == 1 or all(_is_regular(moving, rows, size, leaf) for leaf in spaces)
    known = all(folding) and alone
    return Part(
        vertices,
        "subspaces",
        ordered,
        ordered if known else None,
        spaces=tuple(spaces),
        folding=tuple(folding),
        dimension=size,
        reason=""
        if known
        else "whether motions of vertices with more than four folds truly fold is not decided",
    )


def _too_many(vertices: tuple[int, ...], size: int | None, said: str) -> Part:
    reason = (
        f"the first-order motions of {counted(len(vertices), 'vertex')} round vertex "
        f"{vertices[0]} have dimension {said}; they are decomposed up to {MOST_DIMENSION}"
    )
    return Part(vertices, "subspaces", None, None, dimension=size, reason=reason)


def _extends(pattern: PanelPattern, moving: Mapping[int, Star], leaf: Leaf) -> bool:
    """Whether a space of motions is tangent to true ones: modes that fold apart from each other.

    One vertex alone has true motions near the flat state as its motions to second order, by Morse's
    lemma. A part extends if all its conditions are independent at one of its points
    (`_is_independent`), or if it is a mode that does. Other folds are held flat, so this can prove
    that a space extends and never that it does not: a motion might use them at a higher order.
    """
    for rows, size in independent_parts(dict(leaf.rows), leaf.size, moving):
        active = [star.vertex for star in moving.values() if set(star.folds) & set(rows)]
        if len(active) == 1 and size == len(rows) - 2:
            continue
        if set(active) & set(leaf.vertices):
            return False
        if _is_independent({v: moving[v].only(rows) for v in active}, rows, size):
            continue
        modes = [_local(star, rows) for star in moving.values() if set(star.folds) & set(rows)]
        if size != 1 or any(len(mode.folds) > 4 for mode in modes):
            return False
        stars = {mode.vertex: moving[mode.vertex].only(mode.folds) for mode in modes}
        if extension(pattern, stars, modes).verdict is not PROVED:
            return False
    return True


def _is_regular(moving: Mapping[int, Star], rows: Rows, size: int, leaf: Leaf) -> bool:
    """Whether a leaf is a line at which the conditions have full rank.

    At w on the line the derivatives `dK_v(w)` of all vertices leave in the space of first-order
    motions that line alone, shown by balls; then one curve of true motions at most is tangent to it
    (docs/panels.md, 5).
    """
    if leaf.size != 1 or leaf.vertices:
        return False
    point = {edge: row[0] for edge, row in leaf.rows.items()}
    return rank_at_least(_derivatives(moving, rows, size, point)) >= size - 1


def _is_independent(stars: Mapping[int, Star], space: Rows, size: int) -> bool:
    """Whether all closing conditions are independent near a point of a space of motions.

    If the first-order conditions of these vertices are independent, and so are the derivatives of
    the `K_v` at a point of the space, in the first-order motions, then true motions near the flat
    state are tangent to all points of the space near that one (docs/panels.md, 5).
    """
    rows, dimension = first_order(stars)
    folds = {edge for star in stars.values() for edge in star.folds}
    if dimension != len(folds) - 2 * len(stars):
        return False
    weights = range(1, size + 1)
    point = {
        e: sum((w * x for w, x in zip(weights, row, strict=True)), start=Fraction(0))
        for e, row in space.items()
    }
    return rank_at_least(_derivatives(stars, rows, dimension, point)) == len(stars)


def _derivatives(
    stars: Mapping[int, Star], rows: Rows, size: int, point: Mapping[Edge, Number]
) -> list[list[Number]]:
    """The derivatives of all `K_v` at a point, on the space of first-order motions."""
    found: list[list[Number]] = []
    for star in stars.values():
        weights = star.derivative([point.get(edge, Fraction(0)) for edge in star.folds])
        row: list[Number] = [Fraction(0)] * size
        for weight, edge in zip(weights, star.folds, strict=True):
            if weight != 0 and edge in rows:
                row = [x + weight * y for x, y in zip(row, rows[edge], strict=True)]
        found.append(row)
    return found


def _local(star: Star, rows: Rows) -> LocalMode:
    """The motion of one vertex on a space with one parameter."""
    folds = tuple(edge for edge in star.folds if edge in rows)
    scale = exact(rows[folds[0]][0])
    return LocalMode(star.vertex, 0, folds, tuple(rows[edge][0] / scale for edge in folds))
