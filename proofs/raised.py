"""The names in the formulas of Appendix A: a vertex whose folds are raised a little."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import prod
from typing import Any

from proofs.formulas import Names
from proofs.spokes import Vector, equation
from proofs.wheel_stress import Angle

Change = Callable[[Any, Any, Any, Any], Any]
"""The second-order change of beta from cos and sin of alpha and the two slopes."""


def between(psi: Angle, psi1: Angle, phi: Angle, beta: Angle) -> Any:
    """The scalar product of unit vectors with polar angles psi, psi1, azimuths phi, phi + beta."""
    turned = phi + beta
    fold = (psi.sin * phi.cos, psi.sin * phi.sin, psi.cos)
    fold1 = (psi1.sin * turned.cos, psi1.sin * turned.sin, psi1.cos)
    return sum(x * y for x, y in zip(fold, fold1, strict=True))


def triangle(psi: Angle, psi1: Angle, phi: Angle, beta: Angle) -> Names:
    """The names in the law of cosines, for the folds i = 1 and 2."""
    alpha = Angle(between(psi, psi1, phi, beta), None)
    return {
        "i": 1,
        "psi": {1: psi, 2: psi1}.__getitem__,
        "alpha": lambda *ij: {(1, 2): alpha}[ij],
        "beta": lambda *ij: {(1, 2): beta}[ij],
    }


def change_by(order2: Any, names: dict[str, Any]) -> Change:
    """A function that computes the second-order change of beta.

    Its arguments are the cosine and sine of alpha, and the two slopes. The coefficient of t^2,
    `order2`, must be 0. This equation is affine in the change, and is evaluated term by term in any
    field.
    """
    places = {name: order2.ring.gens.index(generator) for name, generator in names.items()}
    parts: list[list[tuple[int, dict[str, int]]]] = [[], []]
    for powers, coefficient in (24 * order2).terms():
        exponents = {name: powers[place] for name, place in places.items()}
        parts[exponents.pop("b")].append((int(coefficient), exponents))

    def change(cos: Any, sin: Any, p: Any, q: Any) -> Any:
        values = {"C": cos, "S": sin, "p": p, "q": q}
        constant, slope = (
            sum(c * prod(values[name] ** k for name, k in e.items() if k) for c, e in part)
            for part in parts
        )
        return -constant / slope

    return change


def slopes(change: Change, C: Any, S: Any, p: Any, q: Any) -> Names:
    """The names in the expansion, for the folds i = 1 and 2.

    "delta beta" is of order t^2, and "delta psi" of order t.
    """
    return {
        "i": 1,
        "delta beta": lambda *ij: {(1, 2): change(C, S, p, q)}[ij],
        "delta psi": {1: p, 2: q}.__getitem__,
        "alpha": lambda *ij: {(1, 2): Angle(C, S)}[ij],
    }


def raised(names: Names, change: Change) -> Names:
    """The names of a wheel whose heights are raised; K and all changes are to second order.

    Only the sum of the flat angles matters, so they are taken as 1, 2, 3, ... times one number. The
    angle between the edges d + t x z and d' + t x' z differs from the flat angle by -kappa t^2,
    where L L' cos(angle) = s + c kappa t^2.
    """
    n, h, length = names["N"], names["h"], names["L"]

    def slope(i: int) -> Any:
        return (h(i) - h(0)) / length(i)

    def beta(i: int, j: int) -> Any:
        angle = names["alpha"](i, j)
        return change(angle.cos, angle.sin, -slope(i), -slope(j))

    def alpha(i: int, j: int) -> Any:
        (a, b), (u, v) = (names["ends"][(k - 1) % n] for k in (i, j))
        x, x1, s, c = h(i) - h(0), h(j) - h(0), a * u + b * v, a * v - b * u
        if (j - i) % n != 1:
            raise LookupError(f"no sector from {i} to {j}")
        kappa = (x * x1 - s * (x**2 / (a * a + b * b) + x1**2 / (u * u + v * v)) / 2) / c
        return ((i - 1) % n + 1) - kappa

    half = Fraction(n * (n + 1), 4) if n % 4 not in (0, 3) else n * (n + 1) // 4
    return {
        **names,
        "alpha": alpha,
        "delta beta": beta,
        "psi": slope,
        "K": names["K"](),
        "pi": half,
    }


def elevated(names: Names) -> Names:
    """The names for the constraint K_v(h) = 0 in terms of the angles psi, to lowest order."""
    heights, length = names["h"], names["L"]
    return equation({**names, "psi": lambda i: (heights(i) - heights(0)) / length(i)}, 1)


def chords(names: Names) -> Names:
    """The same names, where Delta L are the lengths of vectors between the ends of spokes."""
    ends = [Vector(end) for end in names["ends"]]
    n = len(ends)

    def chord(i: int, j: int) -> Length:
        if (j - i) % n != 1:
            raise LookupError(f"no side from {i} to {j}")
        side = ends[(j - 1) % n] - ends[(i - 1) % n]
        return Length(side * side)

    return {**names, "Delta L": chord}


@dataclass(frozen=True)
class Length:
    """A length of which only the square is known, so that it has no other powers."""

    square: Any

    def __pow__(self, exponent: int) -> Any:
        if exponent != 2:
            raise TypeError("not a square")
        return self.square
