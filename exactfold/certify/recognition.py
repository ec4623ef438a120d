"""Exact form of isolated roots: their parametrisation rebuilt from sharp boxes, then verified."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import islice, pairwise

from exactfold.certify.box import IsolatingBox
from exactfold.certify.krawczyk import krawczyk_at
from exactfold.errors import ParametrisationError
from exactfold.solve.exact_solution import RootClass
from exactfold.solve.quotient import separating_forms
from exactfold.system.quadratic import QuadraticSystem

_BITS = (128, 512, 2048, 8192, 32768)
_FORMS_TRIED = 4
_SLACK = 16


def recognise(system: QuadraticSystem, boxes: Sequence[IsolatingBox]) -> list[RootClass] | None:
    """The zeros in real boxes as classes of conjugate algebraic points, exactly.

    With t_i the values of a separating form, q = prod (T - t_i) and w_j = sum_i x_ij
    prod_{k != i} (T - t_k) have rational coefficients if the zeros are all zeros of some rational
    system (such as all zeros at which given folds are flat). They are read off sharp boxes by
    continued fractions, and what is returned has passed `RootClass.verify` and has a zero in each
    of the boxes. None if no rational coefficients were found, which decides nothing.

    >>> from exactfold.certify.krawczyk import krawczyk
    >>> system = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> [c.polynomial for c in recognise(system, krawczyk(system, [[1.4142], [-1.4142]]))]
    [(-2, 0, 1)]
    """
    forms = list(islice(separating_forms(system.size), system.size + _FORMS_TRIED))
    for bits in _BITS:
        sharp = [
            box if box.bits >= bits + _SLACK else krawczyk_at(system, box, bits + _SLACK)
            for box in boxes
        ]
        found = [box for box in sharp if isinstance(box, IsolatingBox)]
        if len(found) < len(boxes):
            return None
        form = next((f for f in forms if _separates(found, f, bits // 2)), None)
        whole = None if form is None else _rebuilt(found, form, bits)
        if whole is None:
            continue
        try:
            classes = whole.factors()
            for root_class in classes:
                root_class.verify(system)
        except (ParametrisationError, ZeroDivisionError):
            continue  # too few bits
        if _is_spread(classes, found):
            return classes
    return None


def _values(boxes: Sequence[IsolatingBox], form: Sequence[int]) -> list[Fraction]:
    return [
        Fraction(sum(c * m for c, m in zip(form, box.real, strict=True)), 1 << box.bits)
        for box in boxes
    ]


def _separates(boxes: Sequence[IsolatingBox], form: Sequence[int], bits: int) -> bool:
    """Whether the values of the form on the centres are at least 2^-bits apart."""
    values = sorted(_values(boxes, form))
    return all((b - a) * (1 << bits) > 1 for a, b in pairwise(values))


def _rebuilt(boxes: Sequence[IsolatingBox], form: Sequence[int], bits: int) -> RootClass | None:
    """One parametrisation, by a polynomial of degree len(boxes), from fractions near its floats."""
    points = [[Fraction(m, 1 << box.bits) for m in box.real] for box in boxes]
    values = _values(boxes, form)
    whole = [Fraction(1)]
    for t in values:
        whole = [
            a - t * b for a, b in zip([Fraction(0), *whole], [*whole, Fraction(0)], strict=True)
        ]
    sums = [[Fraction(0)] * len(boxes) for _ in points[0]]
    for t, point in zip(values, points, strict=True):
        quotient, carry = [Fraction(0)] * len(boxes), Fraction(0)
        for k in range(len(boxes), 0, -1):
            carry = whole[k] + t * carry
            quotient[k - 1] = carry
        for line, x in zip(sums, point, strict=True):
            for k, c in enumerate(quotient):
                line[k] += x * c
    bound = 1 << (bits // 2)
    lines = [[_nearby(c, bound, bits) for c in line] for line in (whole, *sums)]
    exact = [[c for c in line if c is not None] for line in lines]
    if any(len(a) < len(b) for a, b in zip(exact, lines, strict=True)):
        return None
    return RootClass.from_monic(exact[0], exact[1:], form)


def _nearby(value: Fraction, bound: int, bits: int) -> Fraction | None:
    """A fraction of small denominator that agrees with the value to most of its bits."""
    short = value.limit_denominator(bound)
    size = max(1, abs(value.numerator) // value.denominator)
    return short if abs(short - value) * (1 << (bits * 3 // 4)) < size else None


def _is_spread(classes: Sequence[RootClass], boxes: Sequence[IsolatingBox]) -> bool:
    """Whether each box holds exactly one real zero of the classes."""
    bits = max(box.bits - box.radius.bit_length() for box in boxes) + 8
    points = [point for root_class in classes for point in root_class.real_points(min(bits, 256))]
    counts = [
        sum(
            all(
                low <= interval[1] and interval[0] <= high
                for (low, high), interval in zip(
                    point, (box.interval(k) for k in range(len(point))), strict=True
                )
            )
            for point in points
        )
        for box in boxes
    ]
    return len(points) == len(boxes) and all(count == 1 for count in counts)
