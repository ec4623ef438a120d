"""Warns if numbers almost, but not exactly, agree with a simpler pattern.

If a coordinate is rounded, a straight crease path, a flat vertex or a corner of 180 degrees is
lost. The count of the rounded pattern is right, but says nothing about the pattern that was meant.
The warning is never part of a proof.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from math import lcm
from typing import TypedDict

from exactfold._support.documents import Natural, Positive, Several
from exactfold.errors import InputError
from exactfold.exact.numbers import decimal_above, format_rational, snap
from exactfold.pattern.crease_pattern import CreasePattern, Point
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.pattern.remembered import remembered

Triple = tuple[int, int, int]

_NEAR = Fraction(1, 10**9)
_CHANCE = 10**5
"""A fraction p/q that differs from a number by less than 1/(10^5 q^2) is hardly there by chance."""
_LARGEST = 10**9
"""Fractions with larger denominators do not count as simple."""


class WarningDocument(TypedDict):
    """A warning: the pattern is almost a simpler one, which may have another result."""

    vertices: Several[Natural]
    """The vertices that almost have simpler coordinates, or at which a path is almost straight."""
    snap: Positive | None
    """The denominator that rounds to the simpler pattern."""
    text: str


@dataclass(frozen=True)
class NearDegeneracy:
    """Which simpler pattern a pattern almost is, and what in it is almost straight.

    `simple` maps a vertex to a nearby point with far smaller denominators, at most 1e-9 of the size
    of the pattern away. `nearest` is the pattern with all these points in place, or None if they
    form no valid pattern. `move` is the largest change of a coordinate. Rounding to multiples of
    1/`denominator` (`--snap`) gives `nearest`; `denominator` is None if no rounding does.
    `straight` holds paths (i, v, j) of folds or boundary edges that turn at v, but by less than
    1e-9.
    """

    simple: dict[int, Point]
    straight: tuple[Triple, ...]
    nearest: CreasePattern | None
    denominator: int | None
    move: Fraction

    @property
    def sentences(self) -> tuple[str, ...]:
        """The first of the nearly simple vertices and of the nearly straight paths, in words."""
        sentences = []
        if self.simple:
            vertex, (x, y) = min(self.simple.items())
            more = f", and {len(self.simple) - 1} more like it" if len(self.simple) > 1 else ""
            sentences.append(
                f"vertex {vertex} is within {decimal_above(self.move, 2)} of "
                f"({format_rational(x)}, {format_rational(y)}), but not at it{more}"
            )
        if self.straight:
            i, v, j = self.straight[0]
            more = f", and {len(self.straight) - 1} more" if len(self.straight) > 1 else ""
            sentences.append(f"the path {i}-{v}-{j} is nearly straight, but not quite{more}")
        return tuple(sentences)

    @property
    def text(self) -> str:
        """The warning in words: what was found, what it means for the answer, and a remedy."""
        advice = "the answer is right for these numbers, but perhaps not for the intended pattern"
        if self.denominator is not None:
            advice += f"; --snap {self.denominator} rounds the coordinates to the simpler pattern"
        return f"{'; '.join(self.sentences)}: {advice}"

    def to_dict(self) -> WarningDocument:
        """The warning as JSON: the vertices, the denominator to round with, and the text."""
        return {
            "vertices": sorted({*self.simple, *(v for _, v, _ in self.straight)}),
            "snap": self.denominator,
            "text": self.text,
        }

    def __repr__(self) -> str:
        return (
            f"<NearDegeneracy: {len(self.simple)} nearly simple vertices, {len(self.straight)} "
            f"nearly straight paths, denominator {self.denominator}>"
        )


def near_degenerate(pattern: PatternLike) -> NearDegeneracy | None:
    """What is almost simple or almost straight in a pattern; None if nothing is.

    A vertex is almost simple if one of its coordinates has a convergent p/q of its continued
    fraction at a distance of at most 1e-9 times the larger side of the pattern and of at most
    1/(10^5 q^2). This happens to about one random number in ten thousand. The result None does not
    mean that the pattern is generic, and a result does not mean that the pattern was meant to be
    degenerate.

    >>> rounded = CreasePattern(
    ...     [(0, 0), (1, 0), (1, 1), (0, 1), ("0.3333333333333", "0.3333333333333001")],
    ...     [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    >>> degeneracy = near_degenerate(rounded)
    >>> degeneracy.denominator, degeneracy.straight, rounded.snapped(3)[0] == degeneracy.nearest
    (3, ((0, 4, 2),), True)
    >>> near_degenerate("two-vertex") is None
    True
    """
    return _found(as_pattern(pattern))


def warnings(pattern: CreasePattern) -> list[WarningDocument]:
    """Warnings, as JSON, that a designer should read before the count; often there is none.

    >>> from exactfold.pattern.families import two_vertex
    >>> warnings(two_vertex())
    []
    """
    degeneracy = near_degenerate(pattern)
    return [] if degeneracy is None else [degeneracy.to_dict()]


@remembered
def _found(pattern: CreasePattern) -> NearDegeneracy | None:
    xs, ys = ([point[k] for point in pattern.vertices] for k in (0, 1))
    tolerance = _NEAR * max(max(xs) - min(xs), max(ys) - min(ys))
    simple = {}
    for v, (x, y) in enumerate(pattern.vertices):
        near = _simple(x, tolerance), _simple(y, tolerance)
        if near != (None, None):
            simple[v] = (x if near[0] is None else near[0], y if near[1] is None else near[1])
    straight = tuple(sorted(_nearly_straight(pattern)))
    if not simple and not straight:
        return None
    nearest, denominator, move = None, None, Fraction(0)
    if simple:
        points = [simple.get(v, point) for v, point in enumerate(pattern.vertices)]
        pairs = zip(pattern.vertices, points, strict=True)
        move = max(abs(a - b) for p, q in pairs for a, b in zip(p, q, strict=True))
        nearest = _pattern(points, pattern)
        denominator = None if nearest is None else _denominator(pattern, points)
    return NearDegeneracy(simple, straight, nearest, denominator, move)


def _simple(value: Fraction, tolerance: Fraction) -> Fraction | None:
    """The first convergent that is nearer than chance explains, but is not the value itself."""
    n, d = value.numerator, value.denominator
    if d < _CHANCE:
        return None
    (p, q), (p_next, q_next), (a, b) = (0, 1), (1, 0), (n, d)
    while True:
        whole = a // b
        (p, q), (p_next, q_next) = (p_next, q_next), (whole * p_next + p, whole * q_next + q)
        a, b = b, a - whole * b
        if b == 0 or q_next > _LARGEST:
            return None
        off = abs(n * q_next - p_next * d)  # times 1 / (d q)
        if off * q_next * _CHANCE <= d and Fraction(off, d * q_next) <= tolerance:
            return Fraction(p_next, q_next)


def _pattern(points: list[Point], like: CreasePattern) -> CreasePattern | None:
    try:
        return CreasePattern(points, like.triangles)
    except InputError:
        return None


def _denominator(pattern: CreasePattern, points: list[Point]) -> int | None:
    """The denominator that rounds the vertices of a pattern to the points; None if none does."""
    denominator = lcm(*(x.denominator for point in points for x in point))
    for point, aim in zip(pattern.vertices, points, strict=True):
        if any(snap(x, denominator) != y for x, y in zip(point, aim, strict=True)):
            return None
    return denominator


def _nearly_straight(pattern: CreasePattern) -> Iterator[Triple]:
    """Yields the paths that turn at a vertex, but by less than 1e-9; exact, on integer points."""
    points, _ = pattern.integer_vertices
    boundary = pattern.boundary
    sides = {
        v: (boundary[k - 1], boundary[(k + 1) % len(boundary)]) for k, v in enumerate(boundary)
    }
    for v, (x, y) in enumerate(points):
        spokes = {}
        for j in sides.get(v) or pattern.star(v):
            dx, dy = points[j][0] - x, points[j][1] - y
            spokes[j] = dx, dy, dx * dx + dy * dy
        for (i, (ax, ay, a)), (j, (bx, by, b)) in combinations(sorted(spokes.items()), 2):
            if ax * bx + ay * by < 0:
                sine = ax * by - ay * bx
                if sine and sine * sine * _NEAR.denominator**2 <= a * b:
                    yield i, v, j
