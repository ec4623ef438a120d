"""Rational solutions, and lines over quadratic fields, of exact rays: for certificates."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.branches.periodic.exactly import ExactRay, rays_on
from exactfold.branches.periodic.spaces import (
    Cover,
    Spaces,
    combined,
    dot,
    identity,
    image,
    summed,
)
from exactfold.exact.linalg import nullspace
from exactfold.exact.surds import split_square
from exactfold.rigidity.equations.periodic import PeriodicProblem, Row

Pair = tuple[Fraction, Fraction]

_SMALL: Final = 1e-6
"""The b of a unit vector below which it is taken for 0."""


@dataclass(frozen=True)
class QuadraticLine:
    """A line with the entries a + c sqrt(`radicand`) on z, the first that is not 0 being 1."""

    radicand: int
    point: tuple[Pair, ...]
    ray: ExactRay

    @property
    def signs(self) -> tuple[int, ...]:
        """The signs of all vertices."""
        return self.ray.signs

    @classmethod
    def of(cls, ray: ExactRay) -> QuadraticLine | None:
        """The line of a ray, if it lies in a quadratic field; else None."""
        known = ray.root.root_class
        if known.degree != 2:
            return None
        low, middle, lead = known.polynomial
        radicand, square = split_square(middle * middle - 4 * lead * low)
        # the roots in increasing order; 2 lead t = -middle -+ square sqrt(radicand)
        side = 1 if (ray.root.index == 1) == (lead > 0) else -1
        root = Fraction(-middle, 2 * lead), Fraction(side * square, 2 * lead)
        point = [_at(entry, root, radicand) for entry in ray.entries]
        first = next(pair for pair in point if any(pair))
        return cls(radicand, tuple(_over(pair, first, radicand) for pair in point), ray)

    def is_component(self, problem: PeriodicProblem) -> bool:
        """Whether it is a component of the solutions: its space Z is the line (Theorem 17).

        A vector p + q sqrt(radicand) is the rational vector (p, q), of twice the length.
        """
        one, other = ([pair[k] for pair in self.point] for k in (0, 1))
        flat = [
            v
            for v, rows in enumerate(problem.bends_at)
            if not any(dot(row, part) for row in rows for part in (one, other))
        ]
        forms = [star.form for star in problem.stars]
        normal = identity(2 * len(one))
        rows = [
            row
            for v, form in enumerate(forms)
            if v not in flat
            for row in polar(form, [*one, *other], self.radicand)
        ]
        if rows:
            normal = nullspace(rows)
        if not flat:
            return len(normal) == 2
        total = summed([forms[v] for v in flat])
        sums = [
            [dot(row, a) for a in normal] for c in normal for row in polar(total, c, self.radicand)
        ]
        return len(nullspace(sums)) == 2


def polar(form: Sequence[Row], vector: Sequence[Fraction], radicand: int) -> list[Row]:
    """The polar form with a vector: a row; or two rows on (p, q) for a vector p + q sqrt(radicand).

    The vector is then (p, q), of twice the length, too. `radicand` is 0 for a rational vector.
    """
    if not radicand:
        return [image(form, vector)]
    half = len(vector) // 2
    whole, roots = image(form, vector[:half]), image(form, vector[half:])
    return [(*whole, *(radicand * x for x in roots)), (*roots, *whole)]


def rational_point(ray: ExactRay) -> tuple[Fraction, ...] | None:
    """The point z of a ray that is rational; else None."""
    known = ray.root.root_class
    if known.degree != 1:
        return None
    root = Fraction(-known.polynomial[0], known.polynomial[1]), Fraction(0)
    return tuple(_at(entry, root, 0)[0] for entry in ray.entries)


def covering(
    rays: Iterable[ExactRay], missing: Iterable[Sequence[float]]
) -> tuple[QuadraticLine, ...] | None:
    """Lines over quadratic fields that cover all missing sign vectors; None if some is left."""
    lines = [line for line in map(QuadraticLine.of, rays) if line is not None]
    used: dict[int, None] = {}
    for signs in missing:
        place = next((k for k, line in enumerate(lines) if agree(line.signs, signs)), None)
        if place is None:
            return None
        used[place] = None
    return tuple(lines[k] for k in used)


def solved_near(
    spaces: Spaces, ray: FloatArray, known: dict[tuple[frozenset[int], int], list[ExactRay]]
) -> Iterator[Cover | QuadraticLine]:
    """Components of the solutions that may hold a ray in floats at which vertices are flat.

    On the heights at which these vertices are flat, all solutions are found exactly, with b other
    than 0 if the ray has it. `known` keeps what was solved before.
    """
    problem = spaces.problem
    for flat in filter(None, spaces.flat_near(ray)):
        level = spaces.level(flat)
        place = len(ray) - 1
        if abs(ray[-1]) < _SMALL:
            place = int(np.abs(ray[:-1]).argmax())
            weights = nullspace([[row[-1] for row in level]]) if level else []
            level = tuple(combined(w, level) for w in weights)
        if (flat, place) not in known:
            chart = tuple(identity(len(ray))[place])
            known[flat, place] = rays_on(problem, level, chart)
        for exact in known[flat, place]:
            point, line = rational_point(exact), QuadraticLine.of(exact)
            if point is not None and (cover := spaces.at(point)) is not None:
                yield cover
            elif line is not None and line.is_component(problem):
                yield line


def agree(signs: Sequence[int], given: Sequence[float]) -> bool:
    """Whether a sign vector, or its opposite, agrees with signs where these are not 0."""
    pairs = [(s, e) for s, e in zip(signs, given, strict=True) if s]
    return all(s == e for s, e in pairs) or all(s == -e for s, e in pairs)


def _at(entry: Sequence[Fraction], root: Pair, radicand: int) -> Pair:
    value = Fraction(0), Fraction(0)
    for c in reversed(entry):
        value = times(value, root, radicand)
        value = value[0] + c, value[1]
    return value


def times(one: Pair, other: Pair, radicand: int) -> Pair:
    """The product of a + b sqrt(radicand) and c + d sqrt(radicand)."""
    (a, b), (c, d) = one, other
    return a * c + radicand * b * d, a * d + b * c


def _over(one: Pair, other: Pair, radicand: int) -> Pair:
    c, d = other
    norm = c * c - radicand * d * d
    return times(one, (c / norm, -d / norm), radicand)
