"""Quadratic forms modulo a prime: no common zeros, or zeros that are one component.

The forms have coefficients in a field of square roots, in which a prime p splits: all roots have
values modulo p. If the forms modulo p have no common zero but 0, or if they generate a prime ideal
whose zeros have the expected dimension, the same holds over the complex numbers (docs/panels.md,
One component modulo a prime).
"""

from __future__ import annotations

import random
from collections.abc import Iterator, Sequence
from fractions import Fraction
from itertools import combinations_with_replacement
from math import isqrt

from .reduction import Work

Parts = Sequence[Fraction]
Vector = list[int]
Matrix = list[Vector]
Weighted = Sequence[tuple[Parts, Sequence[Parts]]]
"""A form sum d l^2: the coefficients of d, and those of each value of l."""

LARGEST_PRIME = (1 << 31) - 1
PRIMES = 2000
POINTS = 64
MOST_VARIABLES = 5


def reduced_forms(
    forms: Sequence[Weighted], radicands: Sequence[Parts], work: Work
) -> tuple[list[Matrix], int] | None:
    """The matrices of forms modulo a prime, and the prime; None if no prime is found."""
    for p in _primes():
        work.count_short(isqrt(p) // 2)
        try:
            roots = _roots(radicands, p)
            if roots is not None:
                return [_matrix(form, roots, p, work) for form in forms], p
        except ZeroDivisionError:
            continue
    return None


def _primes() -> Iterator[int]:
    """Yield primes p = 3 modulo 4, from the largest on."""
    found, p = 0, LARGEST_PRIME
    while found < PRIMES:
        if all(p % q for q in range(3, isqrt(p) + 1, 2)):
            found += 1
            yield p
        p -= 4


def _roots(radicands: Sequence[Parts], p: int) -> list[int] | None:
    """Square roots of all radicands modulo p, one level after the other; None if one has none."""
    roots: list[int] = []
    for radicand in radicands:
        square = _residue(radicand, roots, p)
        root = pow(square, (p + 1) // 4, p)
        if not square or root * root % p != square:
            return None
        roots.append(root)
    return roots


def _residue(parts: Parts, roots: Sequence[int], p: int) -> int:
    """A number modulo p; raises `ZeroDivisionError` if p divides a denominator."""
    if len(parts) == 1:
        if parts[0].denominator % p == 0:
            raise ZeroDivisionError
        return parts[0].numerator * pow(parts[0].denominator, -1, p) % p
    half = len(parts) // 2
    root = roots[half.bit_length() - 1]
    return (_residue(parts[:half], roots, p) + root * _residue(parts[half:], roots, p)) % p


def _matrix(form: Weighted, roots: Sequence[int], p: int, work: Work) -> Matrix:
    size = len(form[0][1])
    work.count(len(form) * (size << len(roots)), None)
    work.count_short(len(form) * size**2)
    total = [[0] * size for _ in range(size)]
    for weight, values in form:
        d = _residue(weight, roots, p)
        row = [_residue(value, roots, p) for value in values]
        for j, x in enumerate(row):
            for k, y in enumerate(row):
                total[j][k] = (total[j][k] + d * x * y) % p
    return total


def only_zero(forms: Sequence[Matrix], p: int, work: Work) -> bool:
    """Whether it is proved that the forms vanish together only at 0, over the complex numbers.

    They do if the products of the forms with monomials span all forms of some degree.
    """
    size = len(forms[0])
    if size > MOST_VARIABLES:
        return False
    for degree in range(2, size + 2):
        columns = {m: k for k, m in enumerate(combinations_with_replacement(range(size), degree))}
        rows: list[Vector] = []
        for form in forms:
            for monomial in combinations_with_replacement(range(size), degree - 2):
                row = [0] * len(columns)
                work.count_short(size**2 * degree)
                for j in range(size):
                    for k in range(size):
                        place = columns[tuple(sorted((*monomial, j, k)))]
                        row[place] = (row[place] + form[j][k]) % p
                rows.append(row)
        if len(_echelon(rows, p, work)) == len(columns):
            return True
    return False


def one_component(forms: Sequence[Matrix], p: int, work: Work) -> bool:
    """Whether it is proved that the forms generate a prime ideal over the complex numbers.

    The first form has rank 3 or more. Each later form K gets a vector u on which no earlier form
    depends. If K(u) is not 0, the discriminant of K along u is a square at one regular zero of the
    earlier forms, and no square at another. If K(u) is 0, the linear function b = K(., u) and the
    form vanish together with the earlier forms only where two more conditions than theirs hold.
    """
    size = len(forms[0])
    generator = random.Random(size)
    points = [[generator.randrange(p) for _ in range(size)] for _ in range(POINTS)]
    if len(_echelon(forms[0], p, work)) < 3:
        return False
    room = [[int(j == k) for k in range(size)] for j in range(size)]
    for number, form in enumerate(forms):
        work.count_short((POINTS + len(room)) * size * (size + len(room)))
        u = _direction(form, room, generator, p)
        if u is None:
            return False
        slopes = _times(form, u, p)
        last = _dot(slopes, u, p)
        moved = [_shifted(point, room, generator, p) for point in points]
        points, classes = _zeros(form, slopes, last, u, moved, p)
        if number and last and len(classes) < 2:
            return False
        if not last and not _apart(forms[:number], form, slopes, generator, p, work):
            return False
        room = _kernel(form, room, p, work)
    return True


def _direction(form: Matrix, room: Matrix, generator: random.Random, p: int) -> Vector | None:
    """A vector u of a space with K(u) != 0, or with K(., u) != 0 if the form vanishes there."""
    slopes = (_times(form, a, p) for a in room)
    if not any(_dot(slope, b, p) for slope in slopes for b in room):
        return next((u for u in room if any(_times(form, u, p))), None)
    while True:
        u = _shifted([0] * len(form), room, generator, p)
        if _dot(_times(form, u, p), u, p):
            return u


def _zeros(
    form: Matrix, slopes: Vector, last: int, u: Vector, points: Sequence[Vector], p: int
) -> tuple[list[Vector], set[bool]]:
    """Zeros of a form on the lines along u through points, with derivatives along u that are not 0.

    Where K(u) is not 0, also whether the discriminants that are not 0 are squares.
    """
    zeros: list[Vector] = []
    classes: set[bool] = set()
    for w in points:
        middle, value = _dot(slopes, w, p), _dot(_times(form, w, p), w, p)
        if not last:
            steps = [-value * pow(2 * middle, -1, p)] if middle else []
        else:
            square = (middle * middle - value * last) % p
            root = pow(square, (p + 1) // 4, p)
            if not square:
                continue
            classes.add(root * root % p == square)
            over = pow(last, -1, p)
            found = root * root % p == square
            steps = [(s * root - middle) * over for s in (1, -1)] if found else []
        zeros += [[(x + step * y) % p for x, y in zip(w, u, strict=True)] for step in steps]
    return zeros[:POINTS], classes


def _apart(
    earlier: Sequence[Matrix], form: Matrix, b: Vector, generator: random.Random, p: int, work: Work
) -> bool:
    """Whether earlier forms, b and K have, without u, the common zeros of a regular sequence.

    They have if on some space of as many dimensions as there are forms, on which b vanishes, the
    forms vanish together only at 0. Where b vanishes, no form depends on u, so that u may stay.
    """
    size, number = len(form), len(earlier) + 1
    space = _kernel_of([b], p, work)
    work.count_short(number**2 * size**2)
    basis = [_shifted([0] * size, space, generator, p) for _ in range(number)]
    inner = [
        [[_dot(_times(k, a, p), c, p) for c in basis] for a in basis] for k in (*earlier, form)
    ]
    return only_zero(inner, p, work)


def _kernel(form: Matrix, room: Matrix, p: int, work: Work) -> Matrix:
    """The vectors of a space on which the form does not depend."""
    values = [_times(form, vector, p) for vector in room]
    weights = _kernel_of([list(column) for column in zip(*values, strict=True)], p, work)
    return [_combined(row, room, p) for row in weights]


def _kernel_of(rows: Matrix, p: int, work: Work) -> Matrix:
    """A basis of the vectors at which linear functions vanish."""
    size = len(rows[0]) if rows else 0
    echelon = _echelon(rows, p, work)
    basis = []
    for free in (k for k in range(size) if k not in echelon):
        vector = [0] * size
        vector[free] = 1
        for lead in sorted(echelon, reverse=True):
            row = echelon[lead]
            vector[lead] = -sum(row[k] * vector[k] for k in range(lead + 1, size)) % p
        basis.append(vector)
    return basis


def _echelon(rows: Sequence[Vector], p: int, work: Work) -> dict[int, Vector]:
    """Independent rows by their first column, which has a 1 there."""
    echelon: dict[int, Vector] = {}
    for given in rows:
        row = [x % p for x in given]
        for k in range(len(row)):
            if row[k]:
                work.count_short(len(row))
                if k not in echelon:
                    over = pow(row[k], -1, p)
                    echelon[k] = [x * over % p for x in row]
                    break
                scale = row[k]
                row = [(x - scale * y) % p for x, y in zip(row, echelon[k], strict=True)]
    return echelon


def _shifted(point: Vector, room: Matrix, generator: random.Random, p: int) -> Vector:
    shift = _combined([generator.randrange(p) for _ in room], room, p)
    return [(x + y) % p for x, y in zip(point, shift or [0] * len(point), strict=True)]


def _combined(weights: Sequence[int], vectors: Matrix, p: int) -> Vector:
    columns = zip(*vectors, strict=True)
    return [_dot(weights, column, p) for column in columns]


def _times(form: Matrix, vector: Sequence[int], p: int) -> Vector:
    return [_dot(row, vector, p) for row in form]


def _dot(a: Sequence[int], b: Sequence[int], p: int) -> int:
    return sum(x * y for x, y in zip(a, b, strict=True)) % p
