"""The checks of `validate` for sheets with many triangles, in arrays; `validate` names culprits."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import chain
from typing import TYPE_CHECKING, Final

from exactfold.pattern.validate import IntPoint, Triangle

if TYPE_CHECKING:
    from exactfold._support.arrays import IntArray

MANY: Final = 2000
"""From this number of triangles on, arrays are quicker than loops."""
_SHORT: Final = 2**29
"""With coordinates up to this, twice the area of a triangle is below 2^63."""

Point = tuple[Fraction, Fraction]


def distinct_points(vertices: Sequence[object]) -> tuple[Point, ...] | None:
    """The same points if all are pairs of fractions and different; None if some may not be."""
    if not _are_tuples(vertices, 2, Fraction):
        return None
    points: tuple[Point, ...] = tuple(vertices)  # type: ignore[arg-type]
    seen = {(x.numerator, x.denominator, y.numerator, y.denominator) for x, y in points}
    return points if len(seen) == len(points) else None


def index_triples(triangles: Sequence[object], count: int) -> list[Triangle] | None:
    """The same triples if all have three different indices in range; None if some may not."""
    import numpy as np

    if not _are_tuples(triangles, 3, int):
        return None
    triples: list[Triangle] = list(triangles)  # type: ignore[arg-type]
    try:
        a, b, c = np.array(triples, dtype=np.int64).T
    except OverflowError:
        return None
    inside = min(a.min(), b.min(), c.min()) >= 0 and max(a.max(), b.max(), c.max()) < count
    return triples if inside and not ((a == b) | (b == c) | (c == a)).any() else None


def oriented_disk(
    points: Sequence[IntPoint], triangles: Sequence[Triangle]
) -> tuple[tuple[Triangle, ...], tuple[int, ...]] | None:
    """The triangles as `validate.oriented_triangles` returns them, and the boundary.

    The result is None for small sheets, for long coordinates, and unless the triangles pass the
    checks of `validate.incidence` and `validate.disk`. Let all triangles be positive, each directed
    edge be on one of them, the triangles at each vertex form one fan, and the boundary be one
    cycle. Then the sheet is connected: another part would have no boundary, and the areas of the
    triangles of a closed surface add up to 0.
    """
    if len(triangles) < MANY or max(map(abs, chain.from_iterable(points))) > _SHORT:
        return None
    import numpy as np

    places, corners = np.array(points, dtype=np.int64), np.array(triangles, dtype=np.int64)
    a, b, c = (places[corners[:, k]] for k in range(3))
    u, v = b - a, c - a
    areas = u[:, 0] * v[:, 1] - u[:, 1] * v[:, 0]
    if (areas < 0).all():
        corners = corners[:, [0, 2, 1]]
    elif not (areas > 0).all():
        return None
    turned = (np.argmin(corners, axis=1)[:, None] + np.arange(3)) % 3
    corners = np.take_along_axis(corners, turned, axis=1)
    boundary = _boundary(corners, len(points))
    if boundary is None:
        return None
    return tuple((i, j, k) for i, j, k in corners.tolist()), boundary


def _boundary(corners: IntArray, count: int) -> tuple[int, ...] | None:
    """The boundary of a disk, from its smallest vertex; None if the triangles are none."""
    import numpy as np

    # Side (v, a) of the triangle vab; after it around v comes (v, b).
    at, before, after = (
        np.concatenate([corners[:, (k + s) % 3] for k in range(3)]) for s in range(3)
    )
    sides = at * count + before
    by_side = np.argsort(sides)
    known = sides[by_side]
    degrees = np.bincount(at, minlength=count)
    if (known[1:] == known[:-1]).any() or not degrees.all():
        return None

    def find(wanted: IntArray) -> IntArray:
        place = np.minimum(np.searchsorted(known, wanted), len(known) - 1)
        return np.where(known[place] == wanted, by_side[place], -1)

    following = find(at * count + after)
    first = np.empty(count, dtype=np.int64)
    first[at] = np.arange(len(at))
    begins = np.flatnonzero(find(before * count + at) < 0)  # no triangle before this one
    if not len(begins) or len(np.unique(at[begins])) < len(begins):
        return None
    first[at[begins]] = begins
    # Each vertex has one fan if a walk from its first side passes all its sides.
    steps, here, walking = np.ones(count, dtype=np.int64), first.copy(), np.arange(count)
    while len(walking):
        here[walking] = following[here[walking]]
        walking = walking[(here[walking] >= 0) & (here[walking] != first[walking])]
        steps[walking] += 1
    if (steps != degrees).any():
        return None
    follow = dict(zip(at[begins].tolist(), before[begins].tolist(), strict=True))
    cycle = [min(follow)]
    while (next_ := follow.get(cycle[-1], cycle[0])) != cycle[0] and len(cycle) <= len(follow):
        cycle.append(next_)
    return tuple(cycle) if len(cycle) == len(follow) else None


def sorted_edges(triangles: Sequence[Triangle], count: int) -> tuple[tuple[int, int], ...]:
    """All edges (i, j) with i < j, sorted."""
    import numpy as np

    corners = np.array(triangles, dtype=np.int64)
    ends = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]])
    numbers = np.unique(ends.min(axis=1) * count + ends.max(axis=1))
    return tuple(zip((numbers // count).tolist(), (numbers % count).tolist(), strict=True))


def _are_tuples(rows: Iterable[object], length: int, kind: type) -> bool:
    rows = list(rows)
    if set(map(type, rows)) != {tuple}:
        return False
    tuples: list[tuple[object, ...]] = rows  # type: ignore[assignment]
    return set(map(len, tuples)) == {length} and {type(x) for row in tuples for x in row} == {kind}
