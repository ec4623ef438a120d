"""Appendix-free warm-up: the expansion of the length equations (Section II A)."""

from __future__ import annotations

import sys
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy

from proofs.framework import Proof, Ruling, Script, run

NAME = "length_equations"
TITLE = "The expansion of the length equations"


def prove(change: str | None = None) -> Proof:
    """Eq. (expanded): |X_n - X_m|^2 - L^2 under X = U + t^2 u + t h z, order by order in t."""
    script = Script(NAME, TITLE, ("an edge of length L > 0; any displacements u and h",), change)
    t, h = sympy.symbols("t h")
    U, u = sympy.Matrix(sympy.symbols("U_x U_y")), sympy.Matrix(sympy.symbols("u_x u_y"))
    factor = script.alter("factor two dropped", 2, 1)
    moved = (U + t**2 * u).dot(U + t**2 * u) + (t * h) ** 2 - U.dot(U)
    leading = t**2 * (factor * U.dot(u) + h**2)
    script.identity(
        "|X|^2 - L^2 = t^2 (2 U.u + h^2) + t^4 |u|^2", moved - leading - t**4 * u.dot(u)
    )
    script.state(
        "II.2",
        "Section II A, Eq. (expanded)",
        r"2\frac{U_n-U_m}{|U_n-U_m|}\cdot(u_n-u_m)+\frac{(h_n-h_m)^2}{|U_n-U_m|}\approx 0",
        Ruling.AS_PRINTED,
        note="to lowest order in t, with in-plane displacements of order t^2; exact remainder "
        "t^4 |u_n - u_m|^2 / |U_n - U_m|",
        code="BranchSystem",
    )
    return script.proof()


if __name__ == "__main__":
    sys.exit(run(prove()))
