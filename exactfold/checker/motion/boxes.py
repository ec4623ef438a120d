"""Boxes with the vertices of a moving sheet during a stretch of the motion, and tests on them.

All numbers are integers over 2^GRID. At each moment of the stretch there is a number y with
0 <= y <= 1, the same for all vertices, such that the vertex v is at (1 - y) a + y b + e, where
|e| <= error in each coordinate. `boxes[v]` is (a, b, error).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import isqrt
from operator import mul
from typing import Protocol, TypeVar

from .bounds import Vector, dot
from .equations import LengthEquations
from .lengths import GRID

Box = tuple[Vector, Vector, int]
Boxes = dict[int, Box]
Direction = list[int]
Point = list[float]

_Number = TypeVar("_Number", int, float)
_DIRECTION_BITS = 30


class Curved(Protocol):
    """Positions as polynomials q(x) + e for |x| <= 1, as in `lengths.Path`."""

    columns: list[Vector]
    errors: Vector
    degree: int

    def below(self, s: Fraction) -> int:
        """The x of a parameter s, over 2^GRID, rounded down."""

    def above(self, s: Fraction) -> int:
        """The x of a parameter s, over 2^GRID, rounded up."""


def flat_of(equations: LengthEquations) -> dict[int, Vector]:
    """The positions of the vertices in the flat sheet, over 2^GRID, rounded down.

    They are in the unit of the equations.
    """
    points, unit = equations.sheet.points, equations.unit
    x, y = points[equations.pinned[0]]
    return {
        v: [int(((a - x) / unit * (1 << GRID)) // 1), int(((b - y) / unit * (1 << GRID)) // 1), 0]
        for v, (a, b) in points.items()
    }


def boxes_on(
    path: Curved, flat: dict[int, Vector], place: dict[int, int], low: int, high: int, planar: bool
) -> Boxes:
    """The boxes of all vertices for low <= x <= high, over 2^GRID.

    If `planar`, they are the boxes of the projections to the plane z = 0. The polynomials are
    expanded about the middle by repeated division. Each step is rounded by at most a unit, so that
    all steps together change a value by at most degree (degree + 1) / 2.
    """
    middle = (low + high) >> 1
    half, degree = high - middle, path.degree
    boxes: Boxes = {}
    for v, (x, y, z) in flat.items():
        if v not in place:
            boxes[v] = [x, y, z], [x, y, z], 1
            continue
        k = place[v]
        starts, ends, error = [], [], 0
        for axis, rest in enumerate((x, y, z)):
            if planar and axis == 2:
                starts.append(0)
                ends.append(0)
                continue
            row = path.columns[k + axis][:]
            for m in range(degree):
                for i in range(degree - 1, m - 1, -1):
                    row[i] += middle * row[i + 1] >> GRID
            beyond = 0
            for c in reversed(row[2:]):
                beyond = (beyond * half >> GRID) + abs(c) + 1
            beyond = ((beyond * half >> GRID) + 1) * half >> GRID
            slope = row[1] * half >> GRID
            starts.append(rest + row[0] - slope)
            ends.append(rest + row[0] + slope)
            error = max(error, path.errors[k + axis] + beyond)
        boxes[v] = starts, ends, error + degree * (degree + 1) // 2 + 4
    return boxes


def parted(boxes: Boxes, one: Sequence[int], two: Sequence[int], n: Direction) -> bool:
    """Whether n.(x - y) > 0 for all corners x of one face and y of the other, all along.

    Along the stretch the left side is linear up to the errors, so that its two ends decide.
    """
    size = sum(map(abs, n))
    for end in (False, True):
        points = {v: boxes[v][1] if end else boxes[v][0] for v in (*one, *two)}
        least = min(dot(n, points[v]) - size * boxes[v][2] for v in one)
        if any(dot(n, points[v]) + size * boxes[v][2] >= least for v in two):
            return False
    return True


def parted_at(boxes: Boxes, v: int, one: Sequence[int], two: Sequence[int], n: Direction) -> bool:
    """Whether n.(x - v) > 0 > n.(y - v) all along for corners x of one face and y of the other."""
    return parted(boxes, one, [v], n) and parted(boxes, [v], two, n)


def open_by_distance(boxes: Boxes, left: int, right: int, closed: int) -> bool:
    """Whether the distance of two vertices exceeds the root of `closed` / 2^(2 GRID), all along.

    If g is the gap in the middle of the stretch and d its change, |g + d|^2 >= |g|^2 + 2 g.d. All
    lengths are doubled here.
    """
    (a, b, e), (c, d, f) = boxes[left], boxes[right]
    gap = [p + q - r - s for p, q, r, s in zip(a, b, c, d, strict=True)]
    drift = [q - p + r - s for p, q, r, s in zip(a, b, c, d, strict=True)]
    lost = abs(dot(gap, drift)) + 2 * (e + f) * sum(map(abs, gap))
    return dot(gap, gap) - 2 * lost > 4 * closed


def upright(boxes: Boxes, i: int, j: int, k: int) -> bool:
    """Whether the projection of the face ijk to the plane z = 0 stays counter-clockwise."""
    (o, p, e), arms = boxes[i], []
    for v in (j, k):
        a, b, f = boxes[v]
        middle = [a[t] + b[t] - o[t] - p[t] for t in (0, 1)]
        spread = [abs(b[t] - a[t] - p[t] + o[t]) + 2 * (e + f) for t in (0, 1)]
        arms.append((middle, spread))
    ((x, y), (r, s)), ((z, w), (t, u)) = arms
    change = r * (abs(w) + u) + abs(x) * u + s * (abs(z) + t) + abs(y) * t
    return x * w - y * z > change


def volume_sign(boxes: Boxes, i: int, j: int, k: int, m: int) -> int:
    """The sign of det(x_j - x_i, x_k - x_i, x_m - x_i) all along, 0 if it is not certain.

    If each arm a changes by d, the determinant changes by at most the product of all |a| + |d|
    minus the product of all |a|. This bound grows with each |a|.
    """
    o, p, e = boxes[i]
    arms, most, sizes = [], 1, 1
    for v in (j, k, m):
        a, b, f = boxes[v]
        arm = [s + t - q - r for s, t, q, r in zip(a, b, o, p, strict=True)]
        spread = [abs(t - s - r + q) + 2 * (e + f) for s, t, q, r in zip(a, b, o, p, strict=True)]
        size = isqrt(dot(arm, arm)) + 1
        arms.append(arm)
        sizes *= size
        most *= size + isqrt(dot(spread, spread)) + 1
    volume = dot(arms[0], crossed(arms[1], arms[2]))
    return 0 if abs(volume) <= most - sizes else 1 if volume > 0 else -1


def nearer(boxes: Boxes, left: int, right: int, mean: int) -> bool:
    """Whether the distance of two vertices is below the root of `mean` / 2^(2 GRID), all along."""
    (a, b, e), (c, d, f) = boxes[left], boxes[right]
    gap = [max(abs(p - r), abs(q - s)) + e + f for p, q, r, s in zip(a, b, c, d, strict=True)]
    return dot(gap, gap) < mean


# --- directions, chosen in floats: the tests are valid with any direction -------------------------


def middle_of(box: Box) -> Point:
    """The middle of a box, in floats."""
    return [(a + b) / (2 << GRID) for a, b in zip(box[0], box[1], strict=True)]


def best_apart(boxes: Boxes, one: Sequence[int], two: Sequence[int], planar: bool) -> Direction:
    """The direction with the widest gap between two triangles.

    If the triangles are disjoint, one of these directions parts them: the normals, the cross
    products of a side of each, and the normals of the sides within the planes of the triangles.
    """
    p, q = ([middle_of(boxes[v]) for v in face] for face in (one, two))
    sides = [[minus(t[(k + 1) % 3], t[k]) for k in range(3)] for t in (p, q)]

    def made() -> Iterator[Point]:
        if planar:
            yield from ([-s[1], s[0], 0.0] for side in sides for s in side)
            return
        yield from ([float(i == k) for i in range(3)] for k in range(3))
        for side in sides:
            normal = unit(crossed(side[0], side[1]))
            yield normal
            yield from (crossed(s, normal) for s in side)
        yield from (crossed(s, t) for s in sides[0] for t in sides[1])

    best, width = [0.0, 0.0, 0.0], 0.0
    for n in map(unit, made()):
        a, b = [sum(map(mul, n, x)) for x in p], [sum(map(mul, n, x)) for x in q]
        for gap, sign in ((min(a) - max(b), 1), (min(b) - max(a), -1)):
            if gap > width:
                best, width = [sign * c for c in n], gap
    return whole(best)


def best_corner(
    boxes: Boxes, v: int, one: Sequence[int], two: Sequence[int], planar: bool
) -> Direction:
    """The direction n that maximises the least of the products n.p with four unit vectors p.

    The p are the directions of the arms. n points to the point of their convex hull that is nearest
    to 0. This point lies on a vertex, an edge or a face of the hull, and each of these gives one
    direction to try.
    """
    at = middle_of(boxes[v])
    p = [unit(minus(middle_of(boxes[w]), at)) for w in one]
    p += [unit(minus(at, middle_of(boxes[w]))) for w in two]
    made = list(p)
    for i in range(4):
        for j in range(i):
            made.append([a + b for a, b in zip(p[i], p[j], strict=True)])
            if planar:
                continue
            for k in range(j):
                normal = crossed(minus(p[j], p[i]), minus(p[k], p[i]))
                sign = 1 if sum(map(mul, normal, p[i])) > 0 else -1
                made.append([sign * c for c in normal])
    units = [unit(n) for n in made]
    return whole(max(units, key=lambda n: min(sum(map(mul, n, x)) for x in p)))


def crossed(a: Sequence[_Number], b: Sequence[_Number]) -> list[_Number]:
    """The cross product."""
    return [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]


def minus(a: Point, b: Point) -> Point:
    """The difference."""
    return [x - y for x, y in zip(a, b, strict=True)]


def unit(a: Point) -> Point:
    """The unit vector in this direction; 0 for 0."""
    size = sum(x * x for x in a) ** 0.5
    return [x / size for x in a] if size else a


def whole(a: Point) -> Direction:
    """A multiple of the vector, rounded to integers."""
    return [round(x * (1 << _DIRECTION_BITS)) for x in a]
