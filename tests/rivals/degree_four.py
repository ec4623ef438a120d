"""Vertices of degree four: their curvature form is a product of two linear forms."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from math import prod

from flint import fmpz

from exactfold.errors import NotApplicableError
from exactfold.exact.forms import QuadraticForm
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.rigidity.curvature import curvature_form

_PRIMES = 100  # squares of the first primes are taken out of D


@dataclass(frozen=True)
class Splitting:
    """K_v = scale (L^2 - D M^2) = scale (L + sqrt(D) M)(L - sqrt(D) M), D a positive integer.

    D is 1 iff the form is a product of two linear forms over Q. `sum_part` is L and
    `root_part` M, as coefficients by vertex.
    """

    scale: Fraction
    D: int
    sum_part: Mapping[int, Fraction]
    root_part: Mapping[int, Fraction]

    def __repr__(self) -> str:
        return f"<Splitting: two linear forms over {'Q' if self.D == 1 else f'Q(sqrt({self.D}))'}>"

    @property
    def is_rational(self) -> bool:
        """Whether the two linear forms have rational coefficients."""
        return self.D == 1


def area_product(pattern: CreasePattern, vertex: int) -> Fraction:
    """c_12 c_23 c_34 c_41: the product of the doubled areas of the triangles at a vertex.

    At a vertex v of degree four the curvature form splits into linear forms over Q(sqrt(c_12 c_23
    c_34 c_41)): over Q iff the product is the square of a rational number. Indeed K_v lives on two
    dimensions. If the spokes 1 and 3 are not collinear, affine functions make x_1 = x_3 = 0, and

        2 K_v = -(c_13 / (c_12 c_23)) x_2^2 + (c_13 / (c_34 c_41)) x_4^2,

    as cot a_12 + cot a_23 = L_2^2 c_13 / (c_12 c_23). If they are, with d_3 = -a d_1, the product
    is a^2 c_12^2 c_41^2: with a straight crease path through v, the form always splits over Q.

    Raises `NotApplicableError` unless the vertex is interior of degree four.

    >>> from exactfold.pattern.families import two_vertex
    >>> area_product(two_vertex(), 4)
    Fraction(1261, 176400)
    """
    if vertex not in pattern.interior or pattern.degree(vertex) != 4:
        raise NotApplicableError(f"vertex {vertex} is not an interior vertex of degree four")
    product = Fraction(1)
    for triangle in pattern.triangles:
        if vertex in triangle:
            (ax, ay), (bx, by), (cx, cy) = (pattern.vertices[v] for v in triangle)
            product *= (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    return product


def split_form(pattern: PatternLike, vertex: int) -> Splitting:
    """The two linear forms of a vertex of degree four, checked by multiplying out.

    What they say of a branch: docs/mathematics.md, Conjugate branches.
    Raises `NotApplicableError` unless the vertex is interior of degree four, `ArithmeticError` if
    the check fails (an internal error).

    >>> from exactfold.pattern.families import flat_vertex_square
    >>> split_form(flat_vertex_square(), 4).is_rational  # a straight crease path through it
    True
    """
    pattern = as_pattern(pattern)
    discriminant = area_product(pattern, vertex)
    form = curvature_form(pattern, vertex)
    squares = form.diagonalised  # K_v = a left^2 + b right^2, as the form has rank two
    (b, right), (a, left) = sorted(
        (weight, dict(zip(form.labels, row, strict=True)))
        for weight, row in zip(squares.weights, squares.rows, strict=True)
    )
    ratio = -b / a
    whole, root = _without_squares(ratio.numerator * ratio.denominator)
    factor = Fraction(root, ratio.denominator)  # ratio = whole factor^2
    found = Splitting(a, whole, left, {v: factor * x for v, x in right.items()})
    _check(form, found)
    if _is_square(discriminant) != found.is_rational:
        raise ArithmeticError(f"areas and form disagree at vertex {vertex}")
    return found


def _check(form: QuadraticForm, found: Splitting) -> None:
    for i, u in enumerate(form.labels):
        for j, v in enumerate(form.labels):
            product = found.sum_part[u] * found.sum_part[v]
            product -= found.D * found.root_part[u] * found.root_part[v]
            if found.scale * product != form.matrix[i][j]:
                raise ArithmeticError("the linear forms do not multiply to the curvature form")


def _is_square(value: Fraction) -> bool:
    return all(fmpz(x).is_square() for x in (value.numerator, value.denominator))


def _without_squares(value: int) -> tuple[int, int]:
    """(d, r) with value = d r^2 > 0; d is 1 for a square, and free of the squares of small primes.

    No more, as nobody can factor long integers.
    """
    if fmpz(value).is_square():
        return 1, int(fmpz(value).isqrt())
    root = prod((int(p) ** (e // 2) for p, e in fmpz(value).factor(trial_limit=_PRIMES)), start=1)
    return value // root**2, root
