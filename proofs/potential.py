"""What makes the branch system special: a cubic potential, and paths that cannot cross."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.fields import field

from exactfold import random_square
from exactfold.exact.linalg import inertia
from exactfold.rigidity import curvature_form
from exactfold.rigidity.timelike import round_cone
from proofs.framework import Proof, Script, run

NAME = "potential"
TITLE = "The cubic potential and the popping homotopy"

Vector = tuple[Any, Any]


def prove(change: str | None = None) -> Proof:
    """The claims behind the solvers (docs/theorem.md, section 7)."""
    script = Script(NAME, TITLE, ("any straight-line triangulation of a disk",), change)
    script.state(
        "T.31",
        "Statement of exactfold on the branch system",
        r"\partial K_v/\partial h_w = \partial K_w/\partial h_v \text{ for interior } v, w",
        note="so the forms are the gradient of a cubic in the interior heights",
        code="curvature_form",
    )
    script.state(
        "T.33",
        "Statement of exactfold on the popping homotopy",
        r"\text{convex boundary: } (1-T)(l_v^2-k)+TK_v=0,\ e_vl_v>0 "
        r"\text{ is real, regular and unique for } 0\le T<1",
        note="docs/theorem.md, section 7; with a reflex corner, in the sheet with its notch closed",
        code="popping",
        words="docs/theorem.md, 7",
    )
    _symmetry(script)
    _lorentzian_along_the_path(script)
    return script.proof()


def corner_polar(d: Vector, e: Vector, x: Any, y: Any, u: Any, v: Any) -> Any:
    """The polar form, at (x, y) and (u, v), of the term of a face with spokes d, e in K."""
    c, s = d[0] * e[1] - d[1] * e[0], d[0] * e[0] + d[1] * e[1]
    dd, ee = d[0] ** 2 + d[1] ** 2, e[0] ** 2 + e[1] ** 2
    return (x * v + y * u) / (2 * c) - s / (2 * c) * (x * u / dd + y * v / ee)


def _symmetry(script: Script) -> None:
    """K_v(e_x, e_w) = K_w(e_x, e_v) for an edge vw with faces vwa and wvb, x any of the four."""
    _, *z = field("w1 w2 a1 a2 b1 b2", QQ)
    at = {"v": (0 * z[0], 0 * z[0]), "w": (z[0], z[1]), "a": (z[2], z[3]), "b": (z[4], z[5])}
    lowered = script.alter("slope of the wrong spoke", 0, 1)

    def polar(hub: str, first: str, second: str) -> Any:
        other = "w" if hub == "v" else "v"
        faces = [(other, "a"), ("b", other)] if hub == "v" else [("a", other), (other, "b")]
        total = 0 * z[0]
        for j, k in faces:
            spokes = [(at[n][0] - at[hub][0], at[n][1] - at[hub][1]) for n in (j, k)]
            one, two = (
                [int(name == n) - int(name == hub) for n in (j, k)] for name in (first, second)
            )
            total += corner_polar(spokes[lowered], spokes[1 - lowered], *one, *two)
        return total

    sign = script.alter("polar form antisymmetric", 1, -1)
    for x in "vwab":
        script.identity(
            f"K_v(e_{x}, e_w) = K_w(e_{x}, e_v)",
            polar("v", x, "w") - sign * polar("w", x, "v"),
            of="T.31",
        )
    script.cases(
        "the same for the package's forms on random squares",
        (
            curvature_form(p, v).functional(_unit(p, v, w))[x]
            == sign * curvature_form(p, w).functional(_unit(p, w, v))[x]
            for p in (random_square(5, seed) for seed in range(4))
            for v, w in p.folds
            if v in p.interior and w in p.interior
            for x in {v, w, *p.opposite((v, w))}
        ),
        of="T.31",
    )


def _unit(pattern: Any, hub: int, vertex: int) -> dict[int, Fraction]:
    labels = curvature_form(pattern, hub).labels
    return {v: Fraction(int(v == vertex)) for v in labels}


def _lorentzian_along_the_path(script: Script) -> None:
    """K^T = (1 - T) l^2 + T K keeps one positive direction and the key lemma, for 0 < T <= 1."""
    _, kt, kth, kh, T = field("Ktt Kth Kh T", QQ)
    sign = script.alter("N with the wrong sign", 1, -1)
    square = kth**2 / kt  # l(h)^2, scaled so that K = l^2 - N
    n_of_h = square - kh
    script.identity(
        "(1 - T) l^2 + T K = l^2 - T N with N = l^2 - K",
        (1 - T) * square + T * kh - (square - sign * T * n_of_h),
        of="T.33",
    )
    twice = script.alter("mixed term counted once", 2, 1)
    residual = kh - twice * (kth / kt) * kth + (kth / kt) ** 2 * kt  # K(h - (K(t,h)/K(t,t)) t)
    script.identity(
        "N(h) = -K(h - K(t,h)/K(t,t) t): minus K on the complement of t, where K <= 0",
        n_of_h + residual,
        of="T.33",
    )
    sign = script.alter("l^2 subtracted twice", 1, -1)
    script.identity(
        "T K = K^T - (1 - T) l^2: where K^T <= 0 and 0 < T <= 1, also K <= 0 (key lemma)",
        T * kh - ((1 - T) * square + T * kh) + sign * (1 - T) * square,
        of="T.33",
    )
    nullity = script.alter("nullity 3", 4, 3)
    script.cases(
        "N is positive semidefinite of nullity 4 for the package's round cones (exact inertia)",
        (
            _n_inertia(p, v, nullity)
            for p in (random_square(5, s) for s in range(5))
            for v in p.interior
        ),
        of="T.33",
    )


def _n_inertia(pattern: Any, vertex: int, nullity: int) -> bool:
    form = curvature_form(pattern, vertex)
    cone = round_cone(pattern, vertex)
    line = form.functional(cone)
    size = form(cone)
    matrix = [
        [line[a] * line[b] / size - form.matrix[i][j] for j, b in enumerate(form.labels)]
        for i, a in enumerate(form.labels)
    ]
    positive, negative, zero = inertia(matrix)
    return negative == 0 and zero == nullity and positive == len(form.labels) - nullity


if __name__ == "__main__":
    sys.exit(run(prove()))
