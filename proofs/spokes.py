"""The names in the formulas of the appendices: stars with free spokes.

These are the environments of `Script.formula`. Spokes, lengths and heights are free elements of a
field of rational functions. exactfold computes stresses, forms and determinants over this field, so
that a formula is compared with the library and not with another formula.
"""

from __future__ import annotations

import random
from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field as field_
from fractions import Fraction
from functools import cache
from math import atan2
from typing import Any

import sympy
from sympy import QQ
from sympy.polys.fields import field

from exactfold.pattern import families
from exactfold.rigidity import curvature_form, wheel_stress
from proofs.claims import is_zero
from proofs.wheel_stress import Angle, cross, dot, with_vertices


@dataclass(frozen=True)
class Vector:
    """A vector, with the lengths of vectors that formulas use; square roots are free symbols."""

    coordinates: tuple[Any, ...]
    sizes: Mapping[tuple[Any, ...], Any] = field_(default_factory=dict, compare=False)

    def __sub__(self, other: Vector) -> Vector:
        pairs = zip(self.coordinates, other.coordinates, strict=True)
        return Vector(tuple(a - b for a, b in pairs), self.sizes)

    def __add__(self, other: Vector) -> Vector:
        pairs = zip(self.coordinates, other.coordinates, strict=True)
        return Vector(tuple(a + b for a, b in pairs), self.sizes)

    def __neg__(self) -> Vector:
        return Vector(tuple(-a for a in self.coordinates), self.sizes)

    def __mul__(self, other: Vector) -> Any:
        pairs = zip(self.coordinates, other.coordinates, strict=True)
        return sum(a * b for a, b in pairs)

    def __rmul__(self, factor: Any) -> Vector:
        return Vector(tuple(factor * a for a in self.coordinates), self.sizes)

    def __truediv__(self, divisor: Any) -> Vector:
        return Vector(tuple(a / divisor for a in self.coordinates), self.sizes)

    def __abs__(self) -> Any:
        found = self.sizes.get(self.coordinates)
        return self.sizes[(-self).coordinates] if found is None else found


@cache
def wheel(
    n: int, pinned: bool = False, numbers: bool = False, flat: bool = False
) -> dict[str, Any]:
    """The names of a flat vertex with n free spokes; indices are taken modulo n, the hub is 0.

    "alpha" are angles over one or more sectors, and "eta" are angles at spoke vertex 2. "L" and
    "Delta L" are lengths, "h" heights, and "sigma" the stresses of exactfold's wheel stress. "f",
    "g" and "A" are entries of -2 K_v, and "K" computes K_v(h). The lengths of the rim are square
    roots, but they are free symbols too: a right formula does not depend on them, or uses "Delta L
    squared". If `pinned`, the heights of the hub and of spokes 1 and n are 0. If `numbers`, all
    free elements are rational numbers. If `flat`, only the lengths of the rim and the heights are
    numbers, because names of a flat sheet do not need them.
    """
    letters = [f"p{k}" for k in range(1, n)]
    letters += [f"{x}{k}" for x in "LDh" for k in range(1, n + 1)] + ["h0"]
    primes = [sympy.prime(k) for k in range(2, len(letters) + 9)]
    free: list[Any] = [Fraction(primes[k], primes[k + 4]) for k in range(len(letters))]
    one: Any = Fraction
    if not numbers:
        few = 2 * n - 1 if flat else len(letters)
        one, *free[:few] = field(letters[:few], QQ)
    p, rest = free[: n - 1], free[n - 1 :]
    lengths, rim, heights = rest[:n], rest[n : 2 * n], rest[2 * n : 3 * n]
    sectors = [Angle.twice_arctan(t) for t in p]
    turns = [Angle(one(1), one(0))]
    for sector in sectors:
        turns.append(turns[-1] + sector)
    sectors.append(-turns[-1])
    ends = [(r * turn.cos, r * turn.sin) for r, turn in zip(lengths, turns, strict=True)]
    sheet = with_vertices(families.single_vertex(n), [*ends, (one(0), one(0))])
    stress, form = wheel_stress(sheet, n), curvature_form(sheet, n)
    place = {v: form.labels.index(v) for v in range(n + 1)}
    raised = {0: rest[3 * n], **{k + 1: x for k, x in enumerate(heights)}}
    if pinned:
        raised |= {0: one(0), 1: one(0), n: one(0)}

    def spoke(i: int) -> int:
        return (i - 1) % n

    def adjacent(i: int, j: int) -> int:
        """The number of the sector from spoke i to spoke j."""
        if (j - i) % n != 1:
            raise LookupError(f"no sector from {i} to {j}")
        return spoke(i)

    def alpha(i: int, j: int) -> Angle:
        if (j - i) % n == 0:
            raise LookupError(f"no angle from {i} to {j}")
        total = sectors[spoke(i)]
        for k in range(1, (j - i) % n):
            total = total + sectors[spoke(i + k)]
        return total

    def sigma(i: int, j: int | None = None) -> Any:
        if j is None:
            return stress[spoke(i), n] * lengths[spoke(i)]
        k = adjacent(i, j)
        return stress[min(k, (k + 1) % n), max(k, (k + 1) % n)] * rim[k]

    def eta(i: int, j: int) -> Angle:
        """The angle at spoke vertex 2 between its spoke and the rim edge from i to j."""
        k, other = adjacent(i, j), j if i == 2 else i
        if 2 not in (i, j):
            raise LookupError("eta is an angle at spoke vertex 2")
        a, b = ends[1], ends[spoke(other)]
        edge = (b[0] - a[0], b[1] - a[1])
        size = lengths[1] * rim[k]
        turn = cross(edge, (-a[0], -a[1]))
        return Angle(-dot(edge, a) / size, (turn if i == 2 else -turn) / size)

    def entry(i: int, j: int) -> Any:
        row, column = (place[n if k == 0 else spoke(k)] for k in (i, j))
        return -2 * form.matrix[row][column]

    def minor(size: int) -> Any:
        """chi(size): the determinant of the form of Appendix C on h_2, ..., h_{size - 1}."""
        if not 2 <= size <= n:
            raise LookupError(f"no determinant chi({size})")
        rows = [[entry(i, j) for j in range(2, size)] for i in range(2, size)]
        return _determinant(rows, one(1))

    def value() -> Any:
        """K_v(h)."""
        total = one(0)
        for i in range(n + 1):
            for j in range(n + 1):
                entry_ij = form.matrix[place[spoke(i) if i else n]][place[spoke(j) if j else n]]
                total += entry_ij * raised[i] * raised[j]
        return total

    return {
        "all": range(1, n + 1),
        "N": n,
        "i": 2,
        "I": 2,
        "n": 2,
        "alpha": alpha,
        "L": lambda i: lengths[spoke(i)],
        "Delta L": lambda i, j: rim[adjacent(i, j)],
        "eta": eta,
        "h": lambda i: raised[i if i == 0 else spoke(i) + 1],
        "sigma": sigma,
        "sigma~": sigma,
        "f": lambda i: entry(i, i),
        "g": lambda i, j: entry(i, j) if adjacent(i, j) >= 0 else None,
        "A": lambda i: entry(0, i),
        "chi": minor,
        "Delta": lambda j: minor(j + 2),
        "K": value,
        "ends": ends,
    }


def _determinant(rows: list[list[Any]], one: Any) -> Any:
    """The determinant by expansion along the first row, in any ring."""
    if not rows:
        return one
    total = 0 * one
    for k, x in enumerate(rows[0]):
        if x:
            rest = [[*row[:k], *row[k + 1 :]] for row in rows[1:]]
            total = total + (-1) ** k * x * _determinant(rest, one)
    return total


def equation(names: dict[str, Any], factor: int) -> dict[str, Any]:
    """The same names, for formulas 0 = right side that state K_v(h) = 0.

    The right side must be `factor` times K_v(h).
    """
    target = factor * names["K"]()
    return {**names, "zero": lambda difference: is_zero(difference - target)}


def drawn(*sizes: int) -> list[dict[str, Any]]:
    """The names of wheels with numbers, where a mistake in a formula shows quickly."""
    return [wheel(n, numbers=True) for n in sizes]


def forces(names: dict[str, Any]) -> list[dict[str, Any]]:
    """The same names twice: "u" are the first, then the second coordinates of the unit spokes."""
    ends, length = names["ends"], names["L"]
    return [{**names, "u": lambda i, k=k: ends[(i - 1) % len(ends)][k] / length(i)} for k in (0, 1)]


def ladder(names: dict[str, Any]) -> dict[str, Any]:
    """The same names, with the three parallel segments of the crossed ladders at spoke 2.

    All three are perpendicular to spoke 2, and positive on the side of spoke 1. A goes from the hub
    to the line of the rim from spoke 1. B goes from the end of spoke 2 to the line of spoke 1. h
    goes from spoke 2 to the end of spoke 1.
    """
    ends, length = names["ends"], names["L"](2)
    spoke, other = ends[1], ends[0]
    along, up = dot(other, spoke) / length, cross(other, spoke) / length
    high = {"A": up * length / (length - along), "B": up * length / along, "h": up}
    return {**names, **high, "values": tuple(high.values())}


@cache
def without(n: int, i: int = 2, numbers: bool = False) -> dict[str, Any]:
    """The names of a wheel of n spokes for the induction of Appendix B, where spoke i is taken out.

    "Delta sigma" is the change of the stresses of its two neighbours. "beta" is the angle between
    spoke i + 1 and the line of spoke i - 1, drawn on through the hub.
    """
    names = dict(wheel(n, numbers=numbers, flat=True))
    a, length, ends = names["alpha"], names["L"], names["ends"]

    def spokes(before: int, at: int, after: int) -> Any:
        """The stress of a spoke between two others, by Eq. (spokes)."""
        left, right = a(before, at), a(at, after)
        terms = right.csc / length(after) + left.csc / length(before)
        return terms - (right.cot + left.cot) / length(at)

    changes = {
        i - 1: names["sigma"](i - 1) - spokes(i - 2, i - 1, i + 1),
        i + 1: names["sigma"](i + 1) - spokes(i - 1, i + 1, i + 2),
    }
    before, after = ends[i - 2], ends[i % n]
    size = length(i - 1) * length(i + 1)
    beta = Angle(-dot(before, after) / size, cross(before, after) / size)
    half_turn = Angle(a(1, 2).cos * 0 - 1, a(1, 2).cos * 0)
    names |= {
        "i": i,
        "Delta sigma": lambda j: changes[j],
        "beta": lambda j: {i: beta}[j],
        "pi": half_turn,
    }
    return names


def random_stars() -> list[list[tuple[int, int]]]:
    """Integer spokes in counter-clockwise order, angles below pi; most are nearly a cross."""
    source, found = random.Random(1), [[(2, 1), (-1, 2), (-4, -2), (1, -2)]]
    while len(found) < 60:
        near = [(9, 0), (0, 9), (-9, 0), (0, -9), (9, 9), (-9, 9), (-9, -9), (9, -9)]
        chosen = near[: 4 + len(found) % 5]
        spokes = [(x + source.randint(-2, 2), y + source.randint(-2, 2)) for x, y in chosen]
        spokes.sort(key=lambda d: atan2(d[1], d[0]))
        if all(cross(spokes[k - 1], spokes[k]) > 0 for k in range(len(spokes))):
            found.append(spokes)
    return found


@cache
def equal_angles(n: int) -> dict[str, Any]:
    """The names of a vertex with n spokes of length 3 at equal angles; exact algebraic numbers.

    "lambda" are the eigenvalues of the form of Appendix C on h_2, ..., h_{n-1}, from the smallest
    to the largest: f + g times those of a path, whose characteristic polynomial is solved.
    """
    angle = 2 * sympy.pi / n
    f, g = 2 * sympy.cot(angle) / 9, -sympy.csc(angle) / 9
    size = n - 2
    path = sympy.Matrix(size, size, lambda i, j: int(abs(i - j) == 1))
    roots = [r for r, k in path.eigenvals().items() for _ in range(k)]
    values = sorted((f + g * r for r in roots), key=lambda x: float(x))
    return {
        "N": n,
        "L": 3,
        "f": f,
        "g": g,
        "pi": sympy.pi,
        "lambda": lambda m: dict(enumerate(values, start=1))[m],
        "zero": is_algebraic_zero,
    }


def is_algebraic_zero(value: Any) -> bool:
    """Whether an algebraic number is 0: not if 30 digits say so, else by its minimal polynomial."""
    value = sympy.sympify(value)
    if abs(sympy.N(value, 30)) > sympy.Float("1e-20"):
        return False
    x = sympy.Symbol("x")
    return bool(sympy.minimal_polynomial(value, x) == x)
