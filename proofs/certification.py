"""Why a box is a proof: Krawczyk's test for quadrics, and when a list of roots is complete."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.rings import ring

from exactfold.rigidity import QuadraticSystem
from exactfold.solve import krawczyk
from exactfold.solve.algebraic.groebner_bases import groebner
from exactfold.solve.certify.box import IsolatingBox
from proofs.dual_space import dual_space
from proofs.framework import Proof, Script, run

NAME = "certification"
TITLE = "Krawczyk's test, completeness, and multiplicities"


def prove(change: str | None = None) -> Proof:
    """Prove the identities behind docs/mathematics.md, 3, 4 and 8."""
    script = Script(
        NAME,
        TITLE,
        ("n quadrics in n unknowns with rational coefficients", "refined Bezout (Fulton, 12.3)"),
        change,
    )
    script.state(
        "T.41",
        "docs/mathematics.md, 3",
        r"k_0+rM<1,\ \eta+(k_0+rM)r<r \Rightarrow \text{exactly one zero, regular and real}",
        note="G(x) = x - Y F(x) contracts the box into its interior (Banach); I - Y F' has norm "
        "below 1 on it, so Y and F' are regular there",
        code="krawczyk",
        cited="Banach's fixed point theorem",
    )
    script.state(
        "T.42",
        "docs/mathematics.md, 4 and 8",
        r"\text{disjoint boxes, or dual spaces at isolated zeros, that add up to } 2^n "
        r"\text{ are all zeros}",
        note="refined Bezout is cited, not proved; without isolation dual spaces prove nothing, as "
        "the example shows",
        code="isolate, check_complete",
        cited="refined Bezout (Fulton)",
    )
    _contraction(script)
    _numbers(script)
    _lines_of_zeros(script)
    return script.proof()


def _contraction(script: Script) -> None:
    """G(x) - G(y) = (I - Y F'(m)) (x - y) - Y H((x + y)/2 - m, x - y), for n = 2 and any numbers.

    Every quadric is a sum of monomials x_j x_k, x_j and 1. The identity is linear in F and in Y, so
    that the case of two unknowns proves the general case.
    """
    names = "x1 x2 y1 y2 m1 m2 y11 y12 y21 y22 a b c d e f g h i j k l"
    _, *z = ring(names, QQ)
    x, y, m = z[0:2], z[2:4], z[4:6]
    matrix = [z[6:8], z[8:10]]
    half = script.alter("Hessian doubled", 1, 2)
    forms = [z[10:16], z[16:22]]  # p u^2 + q u v + r v^2 + s u + t v + w

    def value(q: Any, at: Any) -> Any:
        u, v = at
        return q[0] * u**2 + q[1] * u * v + q[2] * v**2 + q[3] * u + q[4] * v + q[5]

    def gradient(q: Any, at: Any) -> list[Any]:
        u, v = at
        return [2 * q[0] * u + q[1] * v + q[3], q[1] * u + 2 * q[2] * v + q[4]]

    def hessian(q: Any, s: Any, t: Any) -> Any:
        return 2 * q[0] * s[0] * t[0] + q[1] * (s[0] * t[1] + s[1] * t[0]) + 2 * q[2] * s[1] * t[1]

    step = [p - q for p, q in zip(x, y, strict=True)]
    twice_middle = [p + q - 2 * r for p, q, r in zip(x, y, m, strict=True)]
    for row in range(2):
        left = step[row] - sum(
            w * (value(q, x) - value(q, y)) for w, q in zip(matrix[row], forms, strict=True)
        )
        linear = step[row] - sum(
            w * sum(p * s for p, s in zip(gradient(q, m), step, strict=True))
            for w, q in zip(matrix[row], forms, strict=True)
        )
        curved = sum(
            w * hessian(q, twice_middle, step) for w, q in zip(matrix[row], forms, strict=True)
        )
        script.identity(
            f"row {row + 1}: G(x) - G(y) = (I - Y F'(m))(x - y) - Y H((x + y)/2 - m, x - y)",
            2 * left - 2 * linear + half * curved,
            of="T.41",
        )


def _numbers(script: Script) -> None:
    """The bound k0 + r M is a Lipschitz constant on the box; the test finds known roots."""
    shift = script.alter("a root moved", Fraction(0), Fraction(1, 3))

    def isolates(roots: list[tuple[Fraction, Fraction]]) -> bool:
        (a, b), (c, d) = roots
        first: list[list[Any]] = [[1, 0, -(a + c) / 2], [0, 0, 0], [-(a + c) / 2, 0, a * c]]
        second: list[list[Any]] = [[0, 0, 0], [0, 1, -(b + d) / 2], [0, -(b + d) / 2, b * d]]
        system = QuadraticSystem.from_rational([first, second])
        point = (a + shift, d + shift)
        (box,) = krawczyk(system, [[float(a), float(d)]])
        return isinstance(box, IsolatingBox) and all(
            low <= value <= high
            for value, (low, high) in zip(point, map(box.interval, range(2)), strict=True)
        )

    values = [Fraction(p, q) for p in (-3, 1, 2) for q in (1, 7)]
    script.cases(
        "boxes around products of known roots hold them",
        (isolates([(a, b), (a + 1, b + Fraction(1, 9))]) for a in values for b in values),
        of="T.41",
    )


def _lines_of_zeros(script: Script) -> None:
    """xy = x(y + 1) = 0 is the line x = 0; dual spaces at four of its points add up to 4 = 2^2."""
    wanted = script.alter("finitely many zeros", None, 4)
    xy = [[0, 1, 0], [1, 0, 0], [0, 0, 0]]
    shifted = [[0, 1, 1], [1, 0, 0], [1, 0, 0]]
    script.counterexample(
        "xy = x(y + 1) = 0 has a line of zeros: points on it, however many, prove no count",
        groebner(QuadraticSystem.from_rational([xy, shifted])).dimension == wanted,
        of="T.42",
    )
    parabola = [[2, 0, 0], [0, 0, -1], [0, -1, 0]]
    axis = [[0, 0, 0], [0, 1, 0], [0, 0, 0]]
    system = QuadraticSystem.from_rational([parabola, axis])
    (root,) = groebner(system).classes
    dual = dual_space(system, root, script.alter("dual space cut off", 10, 3))
    script.example(
        "x^2 = y, y^2 = 0: the dual space at 0 has dimension 4 = 2^2 and is complete",
        dual.dimension == 4 and dual.is_complete,
        of="T.42",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
