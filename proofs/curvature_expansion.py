"""The Gaussian curvature of a nearly flat vertex to second order (Appendix A, Section II B)."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.fields import field
from sympy.polys.rings import ring

from exactfold.rigidity import curvature_form, stress_form, wheel_stress
from proofs.framework import Proof, Script, run
from proofs.raised import (
    Change,
    between,
    change_by,
    chords,
    elevated,
    raised,
    slopes,
    triangle,
)
from proofs.spokes import Vector, drawn, equation, wheel
from proofs.wheel_stress import Angle, free_wheel

NAME = "curvature_expansion"
TITLE = "The second-order Gaussian curvature of a vertex"


def prove(change: str | None = None) -> Proof:
    """Law of cosines, its second-order expansion, the constraint on the heights, and K_v."""
    hypotheses = (
        "a hub with N >= 3 spokes of lengths L_i > 0 and planar angles alpha_{i,i+1} in (0, pi) "
        "between adjacent ones, which sum to 2 pi; index i modulo N",
        "heights t h_i with t small; in-plane displacements of order t^2",
    )
    script = Script(NAME, TITLE, hypotheses, change)
    _law_of_cosines(script)
    second = _expansion(script)
    _deficit(script, second)
    _heights(script, second)
    _constraint(script)
    _curvature_form(script)
    return script.proof()


def _law_of_cosines(script: Script) -> None:
    """Unit vectors at polar angles psi, psi' and azimuths phi, phi + beta."""
    _, p, q, f, b = field("p q f b", QQ)
    psi, psi1, phi, beta = map(Angle.twice_arctan, (p, q, f, b))
    cos_alpha = between(psi, psi1, phi, beta)
    sign = script.alter("law of cosines with the sign of the dual law", 1, -1)
    script.identity(
        "e_i . e_{i+1} = cos psi_i cos psi_{i+1} + sin psi_i sin psi_{i+1} cos beta",
        cos_alpha - (sign * psi.cos * psi1.cos + psi.sin * psi1.sin * beta.cos),
        of="A.2",
    )
    numbers = [Angle.twice_arctan(Fraction(k, 7)) for k in (3, 5, 9, 11)]
    script.formula(
        "A.2",
        "Appendix A, spherical law of cosines",
        r"\cos\alpha_{i,i+1}=\cos\psi_i\cos\psi_{i+1}+\sin\psi_i\sin\psi_{i+1}\cos\beta_{i,i+1}",
        over=[triangle(psi, psi1, phi, beta)],
        at=[triangle(*numbers)],
        note="Remark: alpha is a side of the spherical triangle, beta its angle at the z axis",
        equation="A2",
    )


def _expansion(script: Script) -> Change:
    """Insert psi = pi/2 + t p and beta = alpha + t b1 + t^2 b2, and compare the powers of t."""
    _, t, C, S, p, q, b1, b2, x = ring("t C S p q b1 b2 x", QQ)

    def sine(y: Any) -> Any:  # up to and including t^4
        return y - y**3 / 6

    def cosine(y: Any) -> Any:  # up to and including t^5
        return 1 - y**2 / 2 + y**4 / 24

    def up_to_second(poly: Any) -> list[Any]:
        return [poly.coeff_wrt(t, k) for k in range(3)]

    slope = script.alter("psi = pi/2 + (h_i - h_0)/L_i", 1, -1)
    script.identity(
        "cos(pi/2 - t x) = t x up to and including t^2, so psi = pi/2 - (h_i - h_0)/L_i + O(t^3)",
        *up_to_second(sine(t * x) - slope * t * x),
        of="A.1",
    )
    _, P, small, h0, h1, L = field("P t h0 h1 L", QQ)
    height = small * (h1 - h0) / L
    arc = height + height**3 / 6
    script.identity(
        "the angle x + x^3/6 has the sine x, up to and including x^4",
        *up_to_second(sine(t * x + (t * x) ** 3 / 6) - slope * t * x),
        of="A.1",
    )
    script.formula(
        "A.1",
        "Appendix A, the angle psi_i",
        r"\psi_i=\frac{\pi}{2}-\frac{h_i-h_0}{L_i}",
        over=[
            {
                "i": 1,
                "psi": {1: P / 2 - arc}.__getitem__,
                "h": {0: small * h0, 1: small * h1}.__getitem__,
                "L": {1: L}.__getitem__,
                "pi": P,
                "zero": lambda d: (d / small**3).denom.degree(1) <= 0,
            }
        ],
        note="to second order in the heights; exactly, cos psi_i = (h_i - h_0)/L_i, because L_i is "
        "the length of the fold in space as well",
        equation="A1",
    )
    delta = t * b1 + t**2 * b2
    turn = script.alter("cos(alpha + delta) expanded with the wrong sign", -1, 1)
    law = sine(t * p) * sine(t * q)  # cos psi = -sin(delta psi): the two signs cancel
    law += cosine(t * p) * cosine(t * q) * (C * cosine(delta) + turn * S * sine(delta)) - C
    order0, order1, order2 = up_to_second(law)
    cosines = script.alter("cos alpha on the other side", 0, 2)
    script.identity("order t^0 vanishes", order0 + cosines * C, of="A.3")
    script.identity("order t: -sin(alpha) b1 = 0, so that b1 = 0", order1 + S * b1, of="A.3")
    mixed = script.alter("sign of delta psi_i delta psi_{i+1}", 2, -2)
    printed = mixed * p * q - p**2 * C - q**2 * C  # over 2 sin(alpha)
    script.identity(
        "order t^2 with b1 = 0: 2 sin(alpha) b2 is the printed numerator",
        (2 * order2 + 2 * S * b2).subs(b1, 0) - printed,
        of="A.3",
    )
    change = change_by(order2.subs(b1, 0), {"C": C, "S": S, "p": p, "q": q, "b": b2})
    free = field("C S p q", QQ)[1:]
    numbers = [Fraction(k, 7) for k in (3, 5, 9, 11)]
    script.formula(
        "A.3",
        "Appendix A, expansion of the law of cosines",
        r"\delta\beta_{i,i+1}=\frac{2\delta\psi_i\delta\psi_{i+1}-\delta\psi_i^2"
        r"\cos\alpha_{i,i+1}-\delta\psi_{i+1}^2\cos\alpha_{i,i+1}}{2\sin\alpha_{i,i+1}}",
        over=[slopes(change, *free)],
        at=[slopes(change, *numbers)],
        note="Remark: no term of first order, since sin alpha is not 0",
        equation="A3",
    )
    return change


def _deficit(script: Script, change: Change) -> None:
    """The angles beta add up to a full turn round the z axis; the angles alpha fall short by K."""
    _, *g = ring("a b c d e f", QQ)
    z0, z1, z2 = (g[0], g[1]), (g[2], g[3]), (g[4], g[5])

    def turn(z: tuple[Any, Any], w: tuple[Any, Any]) -> tuple[Any, Any]:  # w times conjugate of z
        return (z[0] * w[0] + z[1] * w[1], z[0] * w[1] - z[1] * w[0])

    def times(z: tuple[Any, Any], w: tuple[Any, Any]) -> tuple[Any, Any]:
        return (z[0] * w[0] - z[1] * w[1], z[0] * w[1] + z[1] * w[0])

    norm = script.alter("norm of the middle fold forgotten", z1[0] ** 2 + z1[1] ** 2, 1)
    left, right = times(turn(z0, z1), turn(z1, z2)), turn(z0, z2)
    script.identity(
        "projected folds z_j: (z_1 conj z_0)(z_2 conj z_1) = |z_1|^2 z_2 conj z_0, so by induction "
        "the product around the hub is positive and sum beta is a multiple of 2 pi",
        left[0] - norm * right[0],
        left[1] - norm * right[1],
        of="A.4 IIB.31",
    )
    script.state(
        "A.4",
        "Appendix A, 'no matter K', and Fig. (singlevertex)",
        r"\sum_i\beta_{i,i+1}=2\pi",
        note="near the unfolded state, by continuity. Remark: a multiple of 2 pi for every star "
        "without a fold along the z axis",
    )
    script.state(
        "IIB.31",
        "Section II B, definition of the trace",
        r"\text{``it is non-self-intersecting for a vertex sufficiently close to being unfolded "
        r"and thus cuts the sphere into two pieces''}",
        note="Remark: there every beta is close to its alpha in (0, pi), and they add up to 2 pi "
        "(A.4), so that the trace is a graph over the equator",
        rests="A.4",
    )
    script.formula(
        "A.5",
        "Appendix A, sum of the delta beta",
        r"\sum_i\alpha_{i,i+1}=2\pi-K,\quad \sum_i\delta\beta_{i,i+1}=K",
        over=[raised(wheel(3), change)],
        at=[raised(names, change) for names in drawn(3, 5)],
        note="to second order here, K = K_v(h); the sum of the delta beta is exactly K. K small is "
        "needed for the expansion of delta beta only. For a sheet cut from the plane K = 0, and "
        "the sum of the delta beta must vanish",
        equation="A4",
    )


def _sector(angle: Angle, L: Any, L1: Any, x: Any, x1: Any) -> Any:
    """The value of delta beta by A.3, with delta psi = -x/L."""
    d, d1 = -x / L, -x1 / L1
    return (2 * d * d1 - (d * d + d1 * d1) * angle.cos) / (2 * angle.sin)


def _heights(script: Script, change: Change) -> None:
    """One sector between spokes of lengths L, L', with x = h_i - h_0 and x' = h_{i+1} - h_0."""
    _, p, L, L1, x, x1 = field("p L L1 x x1", QQ)
    a = Angle.twice_arctan(p)
    c, s = L * L1 * a.sin, L * L1 * a.cos
    delta = _sector(a, L, L1, x, x1)
    rim = script.alter("sign of the rim coefficient", -1, 1)
    other = script.alter("L_i and L_{i+1} exchanged in the spoke coefficient", L1, L)
    printed = rim * a.csc / (L * L1) * (x - x1) ** 2 / 2
    printed += (a.csc / other - a.cot / L) * x**2 / (2 * L)
    printed += (a.csc / L - a.cot / L1) * x1**2 / (2 * L1)
    script.identity(
        "delta beta in the heights, as printed (Delta L cancels)", delta - printed, of="A.6"
    )
    free, numbers = wheel(3), drawn(3, 4)
    bent = [{**names, "delta beta": raised(names, change)["delta beta"]} for names in numbers]
    script.formula(
        "A.6",
        "Appendix A, delta beta in terms of the heights",
        r"\delta\beta_{i,i+1}=-\csc\alpha_{i,i+1}\frac{\Delta L_{i,i+1}}{L_iL_{i+1}}"
        r"\frac{(h_i-h_{i+1})^2}{2\Delta L_{i,i+1}}+(\frac{\csc\alpha_{i,i+1}}{L_{i+1}}"
        r"-\frac{\cot\alpha_{i,i+1}}{L_i})\frac{(h_i-h_0)^2}{2L_i}+(\frac{\csc\alpha_{i,i+1}}{L_i}"
        r"-\frac{\cot\alpha_{i,i+1}}{L_{i+1}})\frac{(h_{i+1}-h_0)^2}{2L_{i+1}}",
        over=[{**free, "delta beta": raised(free, change)["delta beta"]}],
        at=bent,
        equation="A5",
    )
    half = script.alter("summand without its one half", 2, 1)
    main = x / L * (x1 / L1) / a.sin - a.cot / half * ((x / L) ** 2 + (x1 / L1) ** 2)
    script.identity(
        "the summand of Section II B, with psi = +x/L from the xy-plane",
        delta - main,
        of="IIB.1 IIB.2",
    )
    script.formula(
        "IIB.1",
        "Section II B, curvature constraint",
        r"0=\sum_I\{\frac{\psi_I\psi_{I+1}}{\sin\alpha_{I,I+1}}-\frac{1}{2}\cot\alpha_{I,I+1}"
        r"[\psi_I^2+\psi_{I+1}^2]\}",
        over=[elevated(free)],
        at=map(elevated, numbers),
        note="psi_I is measured from the xy-plane here and from the z axis in Appendix A; "
        "psi_I = -delta psi_I, and the form is even. The sum is K up to third order",
        code="curvature_form",
        equation="6",
    )
    _, t, hn, hm, ax, ay, bx, by, size = field("t hn hm ax ay bx by size", QQ)
    rise = t * (hn - hm) / size
    sizes = {(ax - bx, ay - by): size}
    script.formula(
        "IIB.2",
        "Section II B, psi to lowest order",
        r"\psi_{(n,m)}=(h_n-h_m)/|\mathbf{U}_n-\mathbf{U}_m|",
        over=[
            {
                "n": 1,
                "m": 2,
                "psi": {(1, 2): rise + rise**3 / 6}.__getitem__,
                "h": {1: t * hn, 2: t * hm}.__getitem__,
                "U": {1: Vector((ax, ay), sizes), 2: Vector((bx, by), sizes)}.__getitem__,
                "zero": lambda d: (d / t**3).denom.degree(0) <= 0,
            }
        ],
        note="n the far end, m the hub; exactly sin psi = (h_n - h_m)/L",
    )
    sign = script.alter("scalar product with the wrong sign", 1, -1)
    rational = x * x1 / c - sign * s / (2 * c) * (x**2 / L**2 + x1**2 / L1**2)
    script.identity("delta beta = x x'/c - (s/2c)(x^2/L^2 + x'^2/L'^2)", delta - rational, of="A.8")
    tent = _sector(a, L, L1, -L, script.alter("a cone that is not round", -L1, L1))
    script.identity(
        "round cone x = -L: delta beta = tan(alpha/2) > 0, K > 0 on a tent", tent - p, of="A.9"
    )
    chord = (L - L1 * a.cos) ** 2 + (L1 * a.sin) ** 2
    sign = script.alter("law of cosines for Delta L with a plus", -2, 2)
    script.identity(
        "|U_{i+1} - U_i|^2 by the planar law of cosines",
        chord - (L**2 + L1**2 + sign * L * L1 * a.cos),
        of="A.7",
    )
    script.formula(
        "A.7",
        "Section II B, and Appendix A with a root, Delta L",
        r"\Delta L_{I,I+1}^2=L_I^2+L_{I+1}^2-2L_IL_{I+1}\cos\alpha_{I,I+1}",
        over=[chords(free)],
        at=map(chords, numbers),
    )


def _constraint(script: Script) -> None:
    """Add the terms of the two sectors (i-1, i) and (i, i+1) at spoke i, for every N."""
    _, p, q, L0, L1, L2, x0, x1, x2 = field("p q L0 L1 L2 x0 x1 x2", QQ)
    before, after = Angle.twice_arctan(p), Angle.twice_arctan(q)
    both = _sector(before, L0, L1, x0, x1) + _sector(after, L1, L2, x1, x2)
    boundaries = (
        -before.csc / (L0 * L1) * (x0 - x1) ** 2 / 2 - after.csc / (L1 * L2) * (x1 - x2) ** 2 / 2
    )
    far = (before.csc / L1 - before.cot / L0) * x0**2 / (2 * L0)
    far += (after.csc / L1 - after.cot / L2) * x2**2 / (2 * L2)
    last = script.alter("cot alpha_{i-1,i} divided by L_{i-1}", L1, L0)
    spoke = after.csc / L2 + before.csc / L0 - after.cot / L1 - before.cot / last
    script.identity(
        "spoke i collects its printed coefficient from the sectors (i-1, i) and (i, i+1); every "
        "(sector, spoke) pair occurs once, so the sum over i is Eq. (constraint) for every N",
        both - boundaries - far - spoke * x1**2 / (2 * L1),
        of="A.8",
    )
    script.formula(
        "A.8",
        "Appendix A, Eq. (constraint)",
        r"0=\sum_i\left[-\csc\alpha_{i,i+1}\frac{\Delta L_{i,i+1}}{L_iL_{i+1}}"
        r"\frac{(h_i-h_{i+1})^2}{2\Delta L_{i,i+1}}+(\frac{\csc\alpha_{i,i+1}}{L"
        r"_{i+1}}+\frac{\csc\alpha_{i-1,i}}{L_{i-1}}-\frac{\cot\alpha_{i,i+1}}{L"
        r"_i}-\frac{\cot\alpha_{i-1,i}}{L_i})\frac{(h_i-h_0)^2}{2L_i}\right]",
        over=[equation(wheel(3), 1)],
        at=[equation(names, 1) for names in drawn(3, 4)],
        note="the sum extends over all lines of the display; its right-hand side is K_v(h)",
        code="curvature_form",
        equation="A6",
    )


def _curvature_form(script: Script) -> None:
    """The form equals the angle deficit of a graph, and the form that exactfold computes."""
    _, t, a, b, u, v, x, x1, k = field("t a b u v x x1 k", QQ)
    c, s, l2, m2 = a * v - b * u, a * u + b * v, a * a + b * b, u * u + v * v
    kappa = x * x1 / c - s / (2 * c) * (x**2 / l2 + x1**2 / m2)
    sign = script.alter("deficit with the opposite sign", 1, -1)
    exact = (s + t**2 * x * x1) * (1 - t**2 * x**2 / (2 * l2)) * (1 - t**2 * x1**2 / (2 * m2))
    order2 = (exact - (s + sign * c * t**2 * kappa)).diff(t).diff(t).subs(t, 0)
    script.identity(
        "edges d + t x z, d' + t x' z of a graph: L L' cos(angle) = s + c kappa t^2 + O(t^4), so "
        "angle = alpha - kappa t^2 and the deficit 2 pi - sum of angles is K_v(h) t^2",
        order2,
        of="A.5 A.9",
    )
    differences: list[Any] = []
    factor = script.alter("Eq. (compat) equals the constraint without the factor 2", 2, 1)
    for n in (3, 4, 5):
        wheel = free_wheel(n)
        form, stress = curvature_form(wheel, n), stress_form(wheel, wheel_stress(wheel, n))
        compat = [[2 * entry for entry in row] for row in stress.matrix]
        d = wheel.vertices
        for i, vi in enumerate(form.labels):
            for j, vj in enumerate(form.labels):
                differences.append(factor * form.matrix[i][j] - compat[vi][vj])
        for j in range(n):
            k = (j + 1) % n
            cross = d[j][0] * d[k][1] - d[j][1] * d[k][0]
            row, column = form.labels.index(j), form.labels.index(k)
            differences.append(2 * form.matrix[row][column] - 1 / cross)
    script.identity(
        "curvature_form over the field of all spokes, N = 3, 4, 5: mixed entries 1/(2c), and twice "
        "the form is sum_e w_e (h_i - h_j)^2 of Eq. (compat) with the wheel stress",
        *differences,
        of="A.9",
    )
    script.state(
        "A.9",
        "Appendix A, after Eq. (constraint)",
        r"\text{``This is precisely the form of the quadratic constraint that we get from "
        r"the self stresses in Eq. (\ref{eq:compat})''}",
        note="Remark: the same equation: Eq. (constraint) is one half of Eq. (compat) with the "
        "stress of Eq. (wheelstress). K_v > 0 on a cone over a convex polygon",
        code="curvature_form, stress_form, wheel_stress",
        equation="A6",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
