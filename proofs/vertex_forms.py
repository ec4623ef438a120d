"""The quadratic form of one vertex: signs, factor, stress, null directions, determinant.

Appendix C up to the continuant (its eigenvalues are in `vertex_eigenvalues`). Spokes are
d_n = L_n u_n with free lengths L_n and unit vectors u_n = ((1 - t^2)/(1 + t^2), 2t/(1 + t^2)), so
that csc a = 1/(u_n x u_{n+1}) and cot a = (u_n . u_{n+1})/(u_n x u_{n+1}) are rational functions.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from math import prod
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.fields import field

from exactfold import CreasePattern
from exactfold.exact.linalg import from_fmpq, to_flint
from exactfold.pattern.families import single_vertex
from exactfold.rigidity import curvature_form, stress_form, wheel_stress
from exactfold.rigidity.kapovich_millson import kapovich_millson
from proofs.framework import Proof, Script, run
from proofs.spokes import drawn, equation, wheel
from proofs.statements import Severity

NAME = "vertex_forms"
TITLE = "The quadratic form of one vertex: sign, factor, null directions, determinant"
HYPOTHESES = (
    "spokes d_1, ..., d_N of any lengths around the hub, indices mod N, consecutive ones not "
    "parallel",
    "where a sign is claimed: a flat vertex, all angles in (0, pi) with sum 2 pi (N >= 3)",
)
REFLEX = [(4, 0), (1, 1), (0, 4), (-1, -1)]  # the link polygon is reflex at (1, 1)


def cross(a: Any, b: Any) -> Any:
    """The cross product a x b in the plane."""
    return a[0] * b[1] - a[1] * b[0]


def dot(a: Any, b: Any) -> Any:
    """The scalar product a . b in the plane."""
    return a[0] * b[0] + a[1] * b[1]


def csc(a: Any, b: Any) -> Any:
    """Cosecant of the angle between unit vectors."""
    return 1 / cross(a, b)


def cot(a: Any, b: Any) -> Any:
    """Cotangent of the angle between unit vectors."""
    return dot(a, b) / cross(a, b)


def unit(t: Any) -> Any:
    """The unit vector at the angle 2 arctan t."""
    return (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)


@lru_cache
def symbols(names: str) -> Any:
    """The generators of the field of rational functions over Q in these variables."""
    return field(names, QQ)[1:]


def star(*spokes: tuple[int, int]) -> CreasePattern:
    """A hub at the origin (the last vertex) with these spokes."""
    faces = [(k, (k + 1) % len(spokes), len(spokes)) for k in range(len(spokes))]
    return CreasePattern([*spokes, (0, 0)], faces)


def prove(change: str | None = None) -> Proof:
    """All statements on the form of one vertex, with the checks that establish them."""
    script = Script(NAME, TITLE, HYPOTHESES, change)
    _forms(script)
    _stress_signs(script)
    _null_directions(script)
    _determinant(script)
    return script.proof()


def _forms(script: Script) -> None:
    """The forms as sums over sectors: one sector between spokes n and n+1 after the other."""
    t, s, L, M, h0, h, k = symbols("t s L M h0 h k")
    csc_, cot_ = csc(unit(t), unit(s)), cot(unit(t), unit(s))
    x, y = h - h0, k - h0
    curvature = (x / L) * (y / M) * csc_ - cot_ / 2 * ((x / L) ** 2 + (y / M) ** 2)
    spoke, next_spoke = (csc_ / M - cot_ / L) / L, (csc_ / L - cot_ / M) / M
    stress = -csc_ / (L * M) * (h - k) ** 2 + spoke * x**2 + next_spoke * y**2
    f, f_next, g = cot_ / L**2, cot_ / M**2, -csc_ / (L * M)
    A, A_next = -f - g, -f_next - g
    appendix = 2 * g * h * k + f * h**2 + f_next * k**2
    appendix += 2 * h0 * (A * h + A_next * k) - h0**2 * (A + A_next)
    factor = script.alter("wrong sign between the two forms", -2, 2)
    script.identity(
        "in each sector: form (compat) = 2 K, form (constraint) = K, form of Appendix C = -2 K",
        stress - 2 * curvature,
        appendix - factor * curvature,
        of="C.1 C.3",
    )
    script.identity(
        "in each sector: A_n = -f_n - g = (csc a / L_{n+1} - cot a / L_n) / L_n = sigma_n / L_n",
        A - script.alter("sigma_n for sigma_n / L_n", 1, L) * spoke,
        A_next - next_spoke,
        of="C.2",
    )
    pattern = star(*REFLEX)
    matrix = curvature_form(pattern, 4).matrix
    script.example(
        "on a star with a reflex link the library has the same forms: K = (1/2) sum w (h - h')^2, "
        "and -2 K is the form of Appendix C",
        stress_form(pattern, wheel_stress(pattern, 4)).matrix
        == tuple(tuple(matrix[(i + 1) % 5][(j + 1) % 5] for j in range(5)) for i in range(5))
        and kapovich_millson(REFLEX).form.matrix
        == tuple(tuple(factor * entry for entry in row) for row in matrix),
        of="C.1 C.3",
    )
    script.formula(
        "C.1",
        r"Appendix C, 'Eq. (constraint) then reads'",
        r"0=\sum_{n=1}^N(g_{n,n+1}2h_nh_{n+1}+f_nh_n^2+A_n2h_0h_n)-h_0^2\sum_{n=" r"1}^NA_n",
        over=[equation(wheel(3), -2)],
        at=[equation(names, -2) for names in drawn(4, 5)],
        note="as an equation. As a form it is -2 K_v, where Eq. (constraint) is K_v and Eq. "
        "(compat) with the wheel stress (wheelstress) is 2 K_v: the sign is reversed on the way",
        code="curvature_form, stress_form, kapovich_millson",
    )
    script.formula(
        "C.2",
        "Appendix C, definitions of f_n, g_{n,n+1}, A_n",
        r"A_n=-f_n-g_{n,n+1}-g_{n-1,n}=\frac{\sigma_n}{L_n}",
        over=[wheel(5)],
        at=drawn(4, 5),
        note="Remark: sigma_n is the stress of Eq. (spokes); rationally f_n = (d_{n-1} x "
        "d_{n+1})/(c_{n-1} c_n), g_{n,n+1} = -1/c_n with c_n = d_n x d_{n+1}",
        code="wheel_stress",
        equation="C3",
    )


def _stress_signs(script: Script) -> None:
    a, b, c = (symbols("ax ay bx by cx cy")[2 * i : 2 * i + 2] for i in range(3))
    before, after = cross(a, b), cross(b, c)
    f = (dot(a, b) / before + dot(b, c) / after) / dot(b, b)
    A = 1 / before + 1 / after - f
    turn = cross((b[0] - a[0], b[1] - a[1]), (c[0] - b[0], c[1] - b[1]))
    script.identity(
        "A_n = turn_n / (c_{n-1} c_n), turn_n = (d_n - d_{n-1}) x (d_{n+1} - d_n)",
        A - script.alter("turn of the link reversed", 1, -1) * turn / (before * after),
        f - cross(a, c) / (before * after),
        of="C.23",
    )
    convex = [(4, 0), (3, 3), (0, 4), (-1, -1)]
    stress = wheel_stress(star(*script.alter("a convex link", REFLEX, convex)), 4)
    script.counterexample(
        "hub (0,0), spokes (4,0), (1,1), (0,4), (-1,-1): A_2 = -1/2, the other three A_n > 0",
        stress[1, 4] == Fraction(-1, 2) and all(stress[j, 4] > 0 for j in (0, 2, 3)),
        of="C.23",
        against="C.23",
    )
    sign = script.alter("rim densities positive", -1, 1)
    script.example(
        "its rim densities in the sign of Eq. (wheelstress) are -1/c_n < 0",
        all(
            stress[min(j, k), max(j, k)] == Fraction(sign, cross(REFLEX[j], REFLEX[k])) < 0
            for j, k in ((0, 1), (1, 2), (2, 3), (3, 0))
        ),
        of="C.3",
        against="C.3",
    )
    script.state(
        "C.3",
        "Appendix C, first paragraph",
        r"\text{``This form has the interpretation as the energy if the wheel self stress "
        r"is applied as a pre-stress'' \dots\ ``this pre-stress places the spokes under "
        r"compression and the outer edges under tension''}",
        r"\text{the form of Eq. (constraint) is the energy of a pre-stress with the outer edges "
        r"under compression; its negative, the form that is written next, that of one with the "
        r"outer edges under tension}",
        note="the energy of a pre-stress is (1/2) sum_e w_e (h_n - h_m)^2 with w_e > 0 for "
        "tension. Eq. (constraint) has w = -csc a/(L L') < 0 on the rim; the form of Appendix C, "
        "-2 K_v, has the opposite stress, to which the sentence applies (C.23 for the spokes)",
        code="wheel_stress",
        severity=Severity.TYPO,
    )
    script.state(
        "C.23",
        "Appendix C, first paragraph",
        r"\text{``this pre-stress places the spokes under compression''}",
        r"\text{spoke }n\text{ is under compression iff the link polygon is strictly convex at }n"
        r"\text{, unstressed iff it is straight there, under tension iff it is reflex there}",
        note="for the pre-stress of C.3 with the outer edges under tension; all signs are opposite "
        "for the other. Spoke under tension: hub (0,0), spokes (4,0), (1,1), (0,4), (-1,-1), at "
        "(1,1)",
        code="wheel_stress",
        severity=Severity.CONDITION,
    )


def _null_directions(script: Script) -> None:
    a, b, c = (symbols("ax ay bx by cx cy")[2 * i : 2 * i + 2] for i in range(3))
    before, after = cross(a, b), cross(b, c)
    f = cross(a, c) / (before * after)
    sign = script.alter("sign of g", -1, 1)
    script.identity(
        "the row of spoke n vanishes on h_j = l . d_j: g_{n-1,n} d_{n-1} + f_n d_n + g_{n,n+1} "
        "d_{n+1} = 0 (and the row of the hub is minus the sum of the others)",
        *(sign * a[i] / before + f * b[i] + sign * c[i] / after for i in range(2)),
        of="C.4",
    )
    g, a, c = (symbols("gx gy ax ay cx cy")[2 * i : 2 * i + 2] for i in range(3))
    turn = script.alter("quarter turn to the right", 1, -1)
    script.identity(
        "an affine function that vanishes at the hub, d_1 and d_N is zero: its slope g satisfies "
        "c_N g = (g . d_1) J d_N - (g . d_N) J d_1, J the quarter turn, and c_N = d_N x d_1 is "
        "not 0",
        cross(c, a) * g[0] + turn * (dot(g, a) * c[1] - dot(g, c) * a[1]),
        cross(c, a) * g[1] - turn * (dot(g, a) * c[0] - dot(g, c) * a[0]),
        of="C.4",
    )
    script.state(
        "C.4",
        "Appendix C and Section II B",
        r"\text{``three null directions, corresponding to the vertical translation and "
        r"rotations about the }x-\text{ and }y-\text{axes'' \dots\ ``We can remove these by "
        r"setting }h_0=h_1=h_N=0\text{''}",
        note="Remark: exactly three, by C.6: the remaining determinant chi(N) = "
        "-c_N/(c_1...c_{N-1}) is not 0",
        code="curvature_form",
        rests="C.6",
    )
    script.example(
        "with h_0 = h_1 = h_N = 0 the terms left have indices 2 to N-1, tridiagonally (N = 3 to 9)",
        all(_is_pinned_form(n, sign) for n in range(3, 10)),
        of="C.5",
    )
    script.formula(
        "C.5",
        "Appendix C, Eq. (form)",
        r"0=\sum_{n=2}^{N-1}(g_{n,n+1}2h_nh_{n+1}+f_nh_n^2)",
        over=[equation(wheel(4, True), -2)],
        at=[equation(wheel(n, True, True), -2) for n in (4, 5)],
        note="with h_N = 0: the term g_{N-1,N} h_{N-1} h_N drops out; the matrix is (N-2) x (N-2)",
        equation="C4",
    )


def _is_pinned_form(n: int, sign: int) -> bool:
    """Whether rows 2 to N-1 of the library's matrix, times -2, are those of Eq. (form).

    `sign` is that of g, -1.
    """
    matrix, d = curvature_form(single_vertex(n), n).matrix, single_vertex(n).vertices
    for i in range(2, n):  # label i sits at position i of the matrix and at d[i - 1]
        for j in range(2, n):
            near = {i: cross(d[i - 2], d[i]) / (cross(d[i - 2], d[i - 1]) * cross(d[i - 1], d[i]))}
            near[i + 1] = sign / cross(d[i - 1], d[i])
            near[i - 1] = sign / cross(d[i - 2], d[i - 1])
            if -2 * matrix[i][j] != near.get(j, 0):
                return False
    return True


def _determinant(script: Script) -> None:
    *angles, lp, lq, front = symbols("t1 tp tq tr lp lq front")
    first, p, q, r = map(unit, angles)  # spokes 1, N, N+1, N+2
    chi = front * cross(first, p)  # front: the product of csc a_{n,n+1} / L_n^2 so far
    chi_1 = front * csc(p, q) / lp**2 * cross(first, q)
    chi_2 = front * csc(p, q) * csc(q, r) / (lp**2 * lq**2) * cross(first, r)
    f = (cot(p, q) + cot(q, r)) / lq**2
    g = -csc(p, q) / (lp * lq)
    power = script.alter("g not squared", 2, 1)
    script.identity(
        "step for every N: chi(N+2) = f_{N+1} chi(N+1) - g_{N,N+1}^2 chi(N) for the closed formula",
        chi_2 - f * chi_1 + g**power * chi,
        of="C.6 C.7",
    )
    over = script.alter("base over the wrong length", lq, lp)
    script.identity(
        "base: the formula gives chi(2) = 1 (empty matrix) and chi(3) = f_2",
        csc(p, q) * cross(p, q) - 1,
        csc(p, q) * csc(q, r) / over**2 * cross(p, r) - f,
        of="C.6 C.7",
    )
    d = [(4, 0), (3, 3), (0, 4), (-3, 1), (-1, -4), (2, -3)]
    crosses = [cross(a, b) for a, b in pairwise(d)]
    matrix = kapovich_millson(d).form.matrix

    def minor(n: int) -> Fraction:
        """The minor chi(n) of rows 2 to n-1, by elimination."""
        rows = [row[2:n] for row in matrix[2:n]]
        return from_fmpq(to_flint(rows).det()) if rows else Fraction(1)

    shift = script.alter("recurrence index as printed", 0, 1)

    def right_side(n: int, s: int) -> Fraction:
        i = n + 1 + s
        return matrix[i][i] * minor(n + 1) - matrix[i - 1][i] ** 2 * minor(n)

    script.example(
        "the recurrence holds for the determinants of a six-fold star, N = 2, 3, 4",
        all(minor(n + 2) == right_side(n, shift) for n in (2, 3, 4)),
        of="C.7",
    )
    printed = script.alter("the corrected recurrence for the printed one", 1, 0)
    script.counterexample(
        "with f_{N+2} and g_{N+1,N+2} it fails on the same star for N = 2, 3, 4",
        all(minor(n + 2) != right_side(n, printed) for n in (2, 3, 4)),
        against="C.7",
    )
    last = script.alter("chi(n) over c_n as well", 1, 0)
    script.example(
        "chi(n) = (d_1 x d_n)/(c_1 ... c_{n-1}) on the same star, n = 3 to 6",
        all(minor(n) * prod(crosses[: n - last]) == cross(d[0], d[n - 1]) for n in (3, 4, 5, 6)),
        of="C.6",
    )
    script.formula(
        "C.6",
        "Appendix C, Eq. (determinant)",
        r"\chi(N)=\frac{\prod_{n=1}^{N-1}\csc\alpha_{n,n+1}}{\prod_{n=2}^{N-1}L_"
        r"n^2}\sin(\sum_{n=1}^{N-1}\alpha_{n,n+1})",
        over=[wheel(3), wheel(4)],
        at=drawn(3, 4, 5),
        functions=["chi"],
        note="chi(n) is the determinant on h_2, ..., h_{n-1}, of size n - 2; rationally "
        "(d_1 x d_n)/(c_1 ... c_{n-1})",
        code="kapovich_millson",
        equation="C5",
    )
    script.formula(
        "C.7",
        "Appendix C, the continuant",
        r"\chi(N+2)=f_{N+2}\chi(N+1)-g_{N+1,N+2}^2\chi(N)",
        r"\chi(N+2)=f_{N+1}\chi(N+1)-g_{N,N+1}^2\chi(N)",
        over=[{**wheel(4), "N": 2}, {**wheel(5), "N": 3}],
        at=[{**names, "N": n} for names in drawn(6) for n in (2, 3, 4)],
        functions=["chi"],
        note=(
            "indices one too large. chi(2) = 1, chi(3) = f_2; for spokes (4,0), (3,3), (0,4), "
            "(-3,1), (-1,-4), (2,-3) the printed recurrence fails at N = 2"
        ),
        equation="C6",
        severity=Severity.TYPO,
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
