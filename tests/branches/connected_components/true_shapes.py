"""True configurations near the flat state, by Newton's method on angle sums of projected faces."""

from __future__ import annotations

from collections.abc import Mapping

from mpmath import acos, mp, mpf, pi, sqrt

from exactfold.pattern.crease_pattern import CreasePattern

mp.dps = 40


def angle_deficits(pattern: CreasePattern, heights: Mapping[int, mpf]) -> list[mpf]:
    """2 pi less the angles at each interior vertex in the triangles with projected sides."""

    def side(i: int, j: int) -> mpf:
        (ax, ay), (bx, by) = pattern.vertices[i], pattern.vertices[j]
        square = (ax - bx) ** 2 + (ay - by) ** 2
        return mpf(square.numerator) / square.denominator - (heights[i] - heights[j]) ** 2

    found = []
    for v in pattern.interior:
        total = mpf(0)
        ring = pattern.star(v)
        for a, b in zip(ring, (*ring[1:], ring[0]), strict=True):
            p, q, r = side(v, a), side(v, b), side(a, b)
            total += acos((p + q - r) / (2 * sqrt(p * q)))
        found.append(2 * pi - total)
    return found


def true_heights(
    pattern: CreasePattern, start: Mapping[int, mpf], rim: Mapping[int, mpf]
) -> dict[int, mpf]:
    """The true configuration with this rim that Newton's method finds from a start inside."""
    names = pattern.interior

    def equations(*inner: mpf) -> list[mpf]:
        return angle_deficits(pattern, {**rim, **dict(zip(names, inner, strict=True))})

    solved = mp.findroot(equations, [start[v] for v in names], tol=mpf(10) ** -60, maxsteps=60)
    return {**rim, **{v: solved[k] for k, v in enumerate(names)}}
