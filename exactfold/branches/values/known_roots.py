"""The zero in an isolating box as an algebraic number, if it is quickly found and proved."""

from __future__ import annotations

from fractions import Fraction
from functools import lru_cache

from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.groebner_bases import groebner
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.certify.exact_krawczyk import krawczyk_at

FEW = 4
"""With at most this many unknowns n, all zeros are computed in order to know one.

With more, SymPy takes long to name a root of a polynomial of degree 2^n: about 20 s per height at n
= 5.
"""

_BITS = 256
_FINEST = 4096


def zero_in(system: QuadraticSystem, box: IsolatingBox) -> tuple[RootClass, int] | None:
    """The class of the zero in a real box, and the number of this zero in it; or None.

    The number counts the real zeros of the class. A rational zero is guessed from a sharper box.
    Exact substitution proves it, because the box has only one zero. Other zeros are found among all
    zeros of a system of at most `FEW` unknowns (`groebner`): the zero is the one whose bounds meet
    the box. None does not mean that the zero has no short form.

    >>> from exactfold.solve.certify.exact_krawczyk import krawczyk
    >>> system = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> root_class, index = zero_in(system, krawczyk(system, [[1.4142]])[0])
    >>> root_class.polynomial, index
    ((-2, 0, 1), 1)
    """
    rational = _rational(system, box)
    if rational is not None or system.size > FEW:
        return None if rational is None else (rational, 0)
    bits = _BITS
    while bits <= _FINEST:
        near = [
            (root_class, index)
            for root_class in _classes(system)
            for index, point in enumerate(root_class.real_points(bits))
            if all(
                low <= right and left <= high
                for (low, high), (left, right) in zip(point, _sides(box), strict=True)
            )
        ]
        if len(near) <= 1:
            return near[0] if near else None
        bits *= 2
    return None


def _rational(system: QuadraticSystem, box: IsolatingBox) -> RootClass | None:
    """The zero as a class of its own, if its coordinates are rational with short denominators."""
    sharpened = krawczyk_at(system, box, _BITS) if box.bits < _BITS else box
    fine = sharpened if isinstance(sharpened, IsolatingBox) else box
    # By chance, a fraction with denominator q may be within 1/q^2 of a number.
    most = 1 << fine.bits // 3
    point = [Fraction(m, 1 << fine.bits).limit_denominator(most) for m in fine.real]
    inside = all(a <= x <= b for x, (a, b) in zip(point, _sides(fine), strict=True))
    if not inside or any(system.values_at(point)):
        return None
    return RootClass.from_coordinates((0, 1), [[x] for x in point], 1, (0,) * system.size)


def _sides(box: IsolatingBox) -> list[tuple[Fraction, Fraction]]:
    return [box.interval(k) for k in range(len(box.real))]


@lru_cache(maxsize=4)
def _classes(system: QuadraticSystem) -> tuple[RootClass, ...]:
    """All zeros of a system; they are the same for all branches of a pattern."""
    return tuple(groebner(system).classes)
