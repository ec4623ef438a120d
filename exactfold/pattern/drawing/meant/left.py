"""Relations that an exact sheet nearly has: its digits may be rounded, and what they say is noise.

Floats propose where to look, and exact arithmetic tells nearly from exactly. Nothing here is part
of a proof.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from math import atan2, cos, exp, hypot, inf, lcm, log, pi, sin
from typing import TYPE_CHECKING, Final, Protocol

from exactfold.pattern.drawing.meant.values import Edge, Kind, Relation
from exactfold.pattern.remembered import remembered

if TYPE_CHECKING:
    from exactfold._support.arrays import BoolArray, FloatArray, IndexArray, IntArray
    from exactfold.exact.surds import Number

NEAREST: Final = 3e-3
"""No relation whose defect is larger is near."""
_CHANCE: Final = 1e-3
"""Relations are near if random angles have so many as near with a lower probability."""
_ROUGH: Final = 1e-6
"""Logarithms of chances from arrays are good to this."""
_STEPS: Final = 30
"""Points on a grid of so many steps across the sheet are not rounded; no relation there misses by
less than 1e-3."""
_SMALL: Final = 16
"""On sheets of so many vertices plain floats look first, as NumPy takes longer to load."""
_FURTHER: Final = 1.01
"""Plain floats and arrays agree about what is this many times further off than `NEAREST`."""
_FITS: Final = 2**61
"""Products below this, rounding included, are 64-bit integers."""
_TRUST: Final = 1e-9
"""Angles from floats are good to this; smaller defects are computed exactly. All are if positions
are only enclosed: then the angles are those of exact directions."""


class Sheet(Protocol):
    """A sheet of triangles or of panels."""

    @property
    def vertices(self) -> Sequence[tuple[Number, Number]]:
        """The exact points."""

    @property
    def edges(self) -> tuple[Edge, ...]:
        """All edges."""

    @property
    def boundary_edges(self) -> tuple[Edge, ...]:
        """The edges round the sheet."""


@remembered
def left_relations(sheet: Sheet) -> tuple[Relation, ...]:
    """The relations that the sheet nearly has but does not have exactly, the nearest first.

    These are straight paths through a vertex, straight borders, and sums of Kawasaki at vertices
    with an even number of folds, at least four, with a defect of at most 3e-3. If k relations have
    at most the defect of the k-th, and chance may bring k / 2 as near with a probability of at
    least 1e-3, these k are not near.

    >>> from exactfold.pattern.families import two_vertex
    >>> left_relations(two_vertex())
    ()
    >>> from exactfold.pattern.crease_pattern import CreasePattern
    >>> rounded = CreasePattern([(0, 0), (1, 0), (1, 1), (0, 1), ("1/3", "0.333333333334")],
    ...     [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    >>> [(near.name, round(near.defect, 14)) for near in left_relations(rounded)]
    [('kawasaki@4', 4.2e-13), ('straight@4:0-2', 7.1e-13)]
    """
    if _is_on_a_grid(sheet) or (len(sheet.vertices) <= _SMALL and _has_none(sheet)):
        return ()
    import numpy as np  # here, as most small sheets do without

    places = np.array(_places(sheet))
    size = float(np.ptp(places, axis=0).max())
    tests = [test for test in _tests(sheet, places) if len(test.hubs)]
    if not all(test.shortest.all() for test in tests):
        return ()  # floats cannot tell the points of this sheet apart
    # So many are expected below a defect of 1.
    trusted = inf if hasattr(sheet, "directions") else _TRUST
    expected = sum(float((2 * size / (pi * test.shortest)).sum()) for test in tests)
    # Integers, where the sheet has them: a common factor does not turn the vectors.
    points: Sequence[tuple[Number, Number]]
    points, *_ = getattr(sheet, "integer_vertices", (sheet.vertices,))
    directions: Mapping[Edge, tuple[Number, Number]] = getattr(sheet, "directions", {})
    whole = None if directions else _small_integers(points)
    rows = []  # for each test: the defects of its near relations, their places, its number, rows
    for k, test in enumerate(tests):
        defects = test.off * test.shortest / size
        chosen = np.flatnonzero(defects < NEAREST)
        open_ = chosen[test.off[chosen] < trusted]
        holds = test.hold(whole, open_)
        defects[open_[holds]] = 0.0
        for row in open_[~holds].tolist():
            defects[row] = _exact(points, directions, test.terms(row)) * test.shortest[row] / size
        chosen = chosen[defects[chosen] > 0]
        rows.append((defects[chosen], test.order[chosen], np.full(len(chosen), k), chosen))
    if not rows:
        return ()
    found, order, number, row_in_test = (np.concatenate(part) for part in zip(*rows, strict=True))
    believed = _believed(np.sort(found), expected)
    if not believed:
        return ()
    first = np.flatnonzero(found <= np.partition(found, believed - 1)[believed - 1])
    nearest = first[np.lexsort((order[first], found[first]))][:believed]
    near = zip(number[nearest], row_in_test[nearest], found[nearest], strict=True)
    return tuple(tests[k].relation(int(row), float(defect)) for k, row, defect in near)


def _small_integers(points: Sequence[tuple[Number, Number]]) -> IntArray | None:
    """The points as 64-bit integers whose differences are such, too; None if they are not."""
    import numpy as np

    if not all(type(x) is int is type(y) and max(abs(x), abs(y)) < _FITS for x, y in points):
        return None
    return np.array(points, dtype=np.int64)


def _believed(defects: FloatArray, expected: float) -> int:
    """The largest k for which chance hardly brings k / 2 relations as near as the k-th defect.

    The defects are in ascending order. Two relations at a vertex may follow from each other, so k
    relations are k / 2 events. Arrays propose where to look, from the last k down.
    """
    import numpy as np

    means = expected * defects
    numbers = (np.arange(len(means)) + 2) // 2
    above = numbers > means
    with np.errstate(divide="ignore", invalid="ignore"):
        powers = numbers - means + numbers * np.log(means / numbers)
    may = (means == 0) | (above & (powers < log(_CHANCE) + _ROUGH))
    for k in np.flatnonzero(may)[::-1].tolist():
        if chance(float(means[k]), k // 2 + 1) < _CHANCE:
            return int(k) + 1
    return 0


def _places(sheet: Sheet) -> FloatArray | list[tuple[float, float]]:
    """The points as floats; points beyond floats are moved and scaled to the size 1 first."""
    import numpy as np

    vertices = sheet.vertices
    try:
        if hasattr(sheet, "integer_vertices"):  # the same floats, as one division of integers
            points, common = sheet.integer_vertices
            return np.array(np.array(points, dtype=object) / common, dtype=np.float64)
        return [(float(x), float(y)) for x, y in vertices]
    except OverflowError:
        xs, ys = zip(*vertices, strict=True)
        left, low = min(xs), min(ys)
        size = max(max(xs) - left, max(ys) - low)
        return [(float((x - left) / size), float((y - low) / size)) for x, y in vertices]


def chance(mean: float, number: int) -> float:
    """An upper bound (Chernoff's) of the probability of `number` or more events, if so many are
    expected as `mean` says.
    """
    if mean == 0:
        return 0.0
    return exp(number - mean + number * log(mean / number)) if number > mean else 1.0


def nearly(relations: tuple[Relation, ...]) -> str:
    """How many relations nearly hold, and the nearest of them, in words."""
    least = relations[0]
    if len(relations) == 1:
        near = f"one relation nearly holds, {least.name}"
    else:
        near = f"{len(relations)} relations nearly hold, such as {least.name}"
    return f"{near}, off by {least.defect:.1g} of the size"


def off_by(relations: tuple[Relation, ...]) -> tuple[str, ...]:
    """A line for each relation, with its defect."""
    return tuple(f"{one.name} is off by {one.defect:.1e}" for one in relations)


_Terms = tuple[tuple[Edge, int], ...]


@dataclass(frozen=True)
class _Tests:
    """Relations of one kind that are looked for, at vertices of one degree, row by row.

    `ends` are the other ends of the edges at `hubs`; the angles of the first, third, ... of them
    count as positive. `off` is the angle by which a relation misses, in radians, `shortest` its
    shortest edge, and `order` its place among all.
    """

    kind: Kind
    hubs: IndexArray
    ends: IndexArray
    order: IndexArray
    off: FloatArray
    shortest: FloatArray

    @classmethod
    def of(
        cls,
        kind: Kind,
        places: FloatArray,
        hubs: IndexArray,
        ends: IndexArray,
        order: IndexArray,
    ) -> _Tests:
        """The tests of these edges."""
        import numpy as np

        x, y = np.moveaxis(places[ends] - places[hubs, None], -1, 0)
        angles = np.arctan2(y, x)
        if kind == "kawasaki":
            turned = np.argsort(angles, axis=1, kind="stable")
            angles, ends = (np.take_along_axis(a, turned, axis=1) for a in (angles, ends))
        total = angles[:, ::2].sum(axis=1) - angles[:, 1::2].sum(axis=1)
        off = abs(np.arctan2(np.sin(total), abs(np.cos(total))))
        if kind != "kawasaki":
            off[np.cos(total) > 0] = pi / 2  # two edges on the same side form no path
        return cls(kind, hubs, ends, order, off, np.hypot(x, y).min(axis=1))

    def hold(self, points: IntArray | None, rows: IndexArray) -> BoolArray:
        """Which of the relations in these rows hold exactly, as far as 64-bit integers can tell.

        The product of the directions, conjugated where the sign is negative, is then real.
        """
        import numpy as np

        if points is None:
            return np.zeros(len(rows), dtype=bool)
        x, y = np.ones(len(rows), dtype=np.int64), np.zeros(len(rows), dtype=np.int64)
        largest = np.ones(len(rows))
        for k, w in enumerate(self.ends[rows].T):
            a, b = (points[w] - points[self.hubs[rows]]).T
            b = b if k % 2 == 0 else -b
            x, y = x * a - y * b, x * b + y * a
            largest *= abs(a) + abs(b)
        return np.asarray((y == 0) & (largest < _FITS))

    def terms(self, row: int) -> _Terms:
        """The edges of a relation, and the signs of their angles."""
        v = int(self.hubs[row])
        return tuple((_edge(v, w), (-1) ** k) for k, w in enumerate(self.ends[row].tolist()))

    def relation(self, row: int, defect: float) -> Relation:
        """The relation in a row."""
        name = f"{self.kind}@{self.hubs[row]}"
        if self.kind == "straight":
            name += ":{}-{}".format(*self.ends[row])
        return Relation(self.kind, name, self.terms(row), 1, defect)


def _is_on_a_grid(sheet: Sheet) -> bool:
    if len(sheet.vertices) > (_STEPS + 1) ** 2:
        return False  # different points on a grid are not more
    common, columns = 1, ([x for x, _ in sheet.vertices], [y for _, y in sheet.vertices])
    for value in (c for column in columns for c in column):
        common = lcm(common, getattr(value, "denominator", 0))
        if not 0 < common <= 10**6:
            return False
    return all(common * (max(column) - min(column)) <= _STEPS for column in columns)


def _has_none(sheet: Sheet) -> bool:
    """Whether no relation of a small sheet is near without being exact, one relation at a time.

    False if it is open: then `_tests` look at all of them again.
    """
    if hasattr(sheet, "directions"):
        return False
    try:
        places = [(float(x), float(y)) for x, y in sheet.vertices]
    except OverflowError:
        return False
    size = max(max(column) - min(column) for column in zip(*places, strict=True))
    for kind, v, ends in _relations(sheet):
        (x, y), points = places[v], [places[w] for w in ends]
        angles = {w: atan2(b - y, a - x) for w, (a, b) in zip(ends, points, strict=True)}
        in_turn = sorted(ends, key=angles.__getitem__) if kind == "kawasaki" else ends
        total = sum(angles[w] * (-1) ** k for k, w in enumerate(in_turn))
        off = abs(atan2(sin(total), abs(cos(total))))
        if kind != "kawasaki" and cos(total) > 0:
            off = pi / 2
        shortest = min(hypot(a - x, b - y) for a, b in points)
        if off * shortest < _FURTHER * NEAREST * size:
            terms = tuple((_edge(v, w), (-1) ** k) for k, w in enumerate(in_turn))
            if off > _TRUST or not shortest or _exact(sheet.vertices, {}, terms):
                return False
    return True


def _relations(sheet: Sheet) -> Iterator[tuple[Kind, int, list[int]]]:
    """The kind, the vertex and the other ends of every relation that `_tests` look for."""
    rim = set(sheet.boundary_edges)
    border: dict[int, list[int]] = {}
    inner: dict[int, list[int]] = {}
    for edge in sheet.edges:
        for v, w in (edge, edge[::-1]):
            (border if edge in rim else inner).setdefault(v, []).append(w)
    yield from (("border", v, ends) for v, ends in border.items() if len(ends) == 2)
    for v, ends in inner.items():
        if v in border:
            continue
        yield from (("straight", v, list(pair)) for pair in combinations(ends, 2))
        if len(ends) >= 4 and len(ends) % 2 == 0:
            yield "kawasaki", v, ends


def _tests(sheet: Sheet, places: FloatArray) -> Iterator[_Tests]:
    """Every relation that is looked for: straight borders, straight paths, and Kawasaki's sums."""
    import numpy as np

    edges = np.array(sheet.edges, dtype=np.intp).reshape(-1, 2)
    rim = set(sheet.boundary_edges)
    on_rim = np.array([edge in rim for edge in sheet.edges], dtype=bool)
    border: dict[int, list[int]] = {}
    for v, w in edges[on_rim].tolist():
        border.setdefault(v, []).append(w)
        border.setdefault(w, []).append(v)
    straight = [v for v, near in border.items() if len(near) == 2]
    ends = np.array([sorted(border[v]) for v in straight], dtype=np.intp).reshape(-1, 2)
    count = len(straight)
    yield _Tests.of("border", places, np.array(straight, dtype=np.intp), ends, np.arange(count))
    # Nothing has to close at a vertex of the boundary.
    inner = edges[~on_rim]
    at, far = inner.ravel(), inner[:, ::-1].ravel()
    off_rim = ~np.isin(at, np.array([*border], dtype=np.intp))
    at, far = at[off_rim], far[off_rim]
    by_end = np.lexsort((far, at))
    hubs, seen, degrees = np.unique(at, return_index=True, return_counts=True)
    starts = np.cumsum(degrees) - degrees
    in_turn = np.argsort(seen)  # vertices come in the order in which edges have them first
    relations = (degrees * (degrees - 1) // 2 + 1)[in_turn]
    first = np.empty(len(hubs), dtype=np.intp)
    first[in_turn] = count + np.cumsum(relations) - relations
    for degree in dict.fromkeys(degrees[in_turn].tolist()):
        chosen = in_turn[degrees[in_turn] == degree]
        ends = far[by_end][starts[chosen, None] + np.arange(degree)]
        i, j = np.triu_indices(degree, 1)
        pairs = np.stack([ends[:, i], ends[:, j]], axis=-1).reshape(-1, 2)
        order = (first[chosen, None] + np.arange(len(i))).ravel()
        yield _Tests.of("straight", places, np.repeat(hubs[chosen], len(i)), pairs, order)
        if degree >= 4 and degree % 2 == 0:
            yield _Tests.of("kawasaki", places, hubs[chosen], ends, first[chosen] + len(i))


def _exact(
    points: Sequence[tuple[Number, Number]],
    directions: Mapping[Edge, tuple[Number, Number]],
    terms: _Terms,
) -> float:
    """The angle by which a sum misses a multiple of pi, from exact vectors; 0 if it does not.

    The product of the directions, conjugated where the sign is negative, is real if the sum is a
    multiple of pi.
    """
    x: Number = 1
    y: Number = 0
    for edge, sign in terms:
        (ax, ay), (bx, by) = points[edge[0]], points[edge[1]]
        u, w = directions.get(edge, (bx - ax, by - ay))
        w = w * sign
        x, y = x * u - y * w, x * w + y * u
    return abs(float(y / x)) if x else pi / 2


def _edge(v: int, w: int) -> Edge:
    return (v, w) if v < w else (w, v)
