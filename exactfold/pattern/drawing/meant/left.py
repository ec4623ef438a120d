"""Relations that an exact sheet nearly has: its digits may be rounded, and what they say is noise.

Floats propose where to look, and exact arithmetic tells nearly from exactly. Nothing here is part
of a proof.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import combinations
from math import atan2, cos, exp, hypot, lcm, log, pi, sin
from typing import TYPE_CHECKING, Final, Protocol

from exactfold.pattern.drawing.meant.values import Edge, Kind, Relation

if TYPE_CHECKING:
    from exactfold.exact.surds import Number

NEAREST: Final = 3e-3
"""No relation whose defect is larger is near."""
_CHANCE: Final = 1e-3
"""Relations are near if random angles have so many as near with a lower probability."""
_STEPS: Final = 30
"""Points on a grid of so many steps across the sheet are not rounded; no relation there misses by
less than 1e-3."""
_TRUST: Final = 1e-9
"""Angles from floats are good to this; smaller defects are computed exactly."""


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


def left_relations(sheet: Sheet) -> tuple[Relation, ...]:
    """The relations that the sheet nearly has but does not have exactly, the nearest first.

    These are straight paths through a vertex, straight borders, and sums of Kawasaki at vertices
    with four folds, with a defect of at most 3e-3. If k relations have at most the defect of the
    k-th, and chance may bring k / 2 as near with a probability of at least 1e-3, these k are
    not near.

    >>> from exactfold.pattern.families import two_vertex
    >>> left_relations(two_vertex())
    ()
    >>> from exactfold.pattern.crease_pattern import CreasePattern
    >>> rounded = CreasePattern([(0, 0), (1, 0), (1, 1), (0, 1), ("1/3", "0.333333333334")],
    ...     [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    >>> [(near.name, round(near.defect, 14)) for near in left_relations(rounded)]
    [('kawasaki@4', 4.2e-13), ('straight@4:0-2', 7.1e-13)]
    """
    if _is_on_a_grid(sheet):
        return ()
    places = _places(sheet.vertices)
    size = max(max(column) - min(column) for column in zip(*places, strict=True))
    tests = list(_tests(sheet, places))
    shortest = [min(_length(places, edge) for edge, _ in terms) for _, _, terms, _ in tests]
    if not all(shortest):
        return ()  # floats cannot tell the points of this sheet apart
    expected = sum(2 * size / (pi * length) for length in shortest)  # below a defect of 1
    near = []
    for (kind, name, terms, off), length in zip(tests, shortest, strict=True):
        if off * length / size >= NEAREST:
            continue
        if off < _TRUST:
            off = _exact(sheet, terms)
        if off:
            near.append(Relation(kind, name, terms, 1, off * length / size))
    near.sort(key=lambda relation: relation.defect)
    # Two relations at a vertex may follow from each other, so k relations are k / 2 events.
    chances = [_chance(expected * one.defect, (k + 2) // 2) for k, one in enumerate(near)]
    believed = [k for k, chance in enumerate(chances, 1) if chance < _CHANCE]
    return tuple(near[: max(believed, default=0)])


def _places(vertices: Sequence[tuple[Number, Number]]) -> list[tuple[float, float]]:
    """The points as floats; points beyond floats are moved and scaled to the size 1 first."""
    try:
        return [(float(x), float(y)) for x, y in vertices]
    except OverflowError:
        xs, ys = zip(*vertices, strict=True)
        left, low = min(xs), min(ys)
        size = max(max(xs) - left, max(ys) - low)
        return [(float((x - left) / size), float((y - low) / size)) for x, y in vertices]


def _chance(mean: float, number: int) -> float:
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
_Places = Sequence[tuple[float, float]]


def _is_on_a_grid(sheet: Sheet) -> bool:
    common, columns = 1, ([x for x, _ in sheet.vertices], [y for _, y in sheet.vertices])
    for value in (c for column in columns for c in column):
        common = lcm(common, getattr(value, "denominator", 0))
        if not 0 < common <= 10**6:
            return False
    return all(common * (max(column) - min(column)) <= _STEPS for column in columns)


def _tests(sheet: Sheet, places: _Places) -> Iterator[tuple[Kind, str, _Terms, float]]:
    """Every relation that is looked for: kind, name, terms, and by how many radians it misses."""
    boundary = set(sheet.boundary_edges)
    border: dict[int, list[int]] = {}
    around: dict[int, list[int]] = {}
    for edge in sheet.edges:
        for v, w in (edge, edge[::-1]):
            (border if edge in boundary else around).setdefault(v, []).append(w)
    for v, (i, j) in ((v, sorted(near)) for v, near in border.items() if len(near) == 2):
        yield _test("border", f"border@{v}", places, v, ((i, 1), (j, -1)))
    for v, near in around.items():
        if v in border:
            continue  # nothing has to close at a vertex of the boundary
        for i, j in combinations(sorted(near), 2):
            yield _test("straight", f"straight@{v}:{i}-{j}", places, v, ((i, 1), (j, -1)))
        if len(near) == 4:
            turned = sorted(near, key=lambda w: _angle(places, v, w))
            signs = [(w, (-1) ** k) for k, w in enumerate(turned)]
            yield _test("kawasaki", f"kawasaki@{v}", places, v, signs)


def _test(
    kind: Kind, name: str, places: _Places, v: int, signs: Sequence[tuple[int, int]]
) -> tuple[Kind, str, _Terms, float]:
    total = sum(sign * _angle(places, v, w) for w, sign in signs)
    off = abs(atan2(sin(total), abs(cos(total))))
    if kind != "kawasaki" and cos(total) > 0:
        off = pi / 2  # two edges on the same side of the vertex form no path
    return kind, name, tuple((_edge(v, w), sign) for w, sign in signs), off


def _exact(sheet: Sheet, terms: _Terms) -> float:
    """The angle by which a sum misses a multiple of pi, from exact vectors; 0 if it does not.

    The product of the directions, conjugated where the sign is negative, is real if the sum is a
    multiple of pi.
    """
    directions: Mapping[Edge, tuple[Number, Number]] = getattr(sheet, "directions", {})
    x: Number = 1
    y: Number = 0
    for edge, sign in terms:
        (ax, ay), (bx, by) = (sheet.vertices[v] for v in edge)
        u, w = directions.get(edge, (bx - ax, by - ay))
        w = w * sign
        x, y = x * u - y * w, x * w + y * u
    return abs(float(y / x)) if x else pi / 2


def _angle(places: _Places, v: int, w: int) -> float:
    return atan2(places[w][1] - places[v][1], places[w][0] - places[v][0])


def _length(places: _Places, edge: Edge) -> float:
    (ax, ay), (bx, by) = places[edge[0]], places[edge[1]]
    return hypot(bx - ax, by - ay)


def _edge(v: int, w: int) -> Edge:
    return (v, w) if v < w else (w, v)
