"""Force balance of the wheel stress at the hub (Appendix B, second half)."""

from __future__ import annotations

import sys
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.fields import field
from sympy.polys.rings import ring

from exactfold.rigidity import wheel_stress
from proofs.force_balance import spoke, star
from proofs.framework import Proof, Script, run
from proofs.spokes import drawn, forces, random_stars, wheel, without
from proofs.statements import Severity
from proofs.wheel_stress import Angle, cross

NAME = "hub_balance"
TITLE = "Force balance of the wheel stress at the hub"


def prove(change: str | None = None) -> Proof:
    """The induction of Appendix B line by line, and its repair."""
    hypotheses = (
        "a hub 0 with N >= 3 spokes of lengths L_i > 0, angles alpha_{i,i+1} in (0, pi) between "
        "adjacent ones, sum 2 pi; u_j the unit vectors of the spokes",
    )
    script = Script(NAME, TITLE, hypotheses, change)
    _base_case(script)
    _induction_formulas(script)
    _induction_step(script)
    _last_display(script)
    _choice_of_spoke(script)
    return script.proof()


def _base_case(script: Script) -> None:
    """Three spokes: a = alpha_12, b = alpha_23, c = alpha_31 = 2 pi - a - b."""
    K, p, q, L1, L2, L3 = field("p q L1 L2 L3", QQ)
    a, b = Angle.twice_arctan(p), Angle.twice_arctan(q)
    c = -(a + b)
    sign = script.alter("simpletrig with a difference of cotangents", 1, -1)
    script.identity(
        "csc a csc b = csc(a + b)(cot a + cot b)",
        a.csc * b.csc + c.csc * (a.cot + sign * b.cot),
        of="B.11",
    )
    sign = script.alter("csc alpha_31 without its sign", 1, -1)
    script.identity(
        "-csc alpha_31 = csc(alpha_12 + alpha_23)", sign * c.csc + (a + b).csc, of="B.12"
    )
    script.formula(
        "B.11",
        "Appendix B, Eq. (simpletrig)",
        r"\csc a\csc b=\csc(a+b)(\cot a+\cot b)",
        over=[{"a": a, "b": b}],
        note="wherever sin a, sin b, sin(a + b) are not 0",
        equation="B13",
    )
    script.formula(
        "B.12",
        "Appendix B, after Eq. (simpletrig)",
        r"-\csc\alpha_{3,1}=\csc(\alpha_{1,2}+\alpha_{2,3})",
        over=[wheel(3)],
        at=drawn(3),
    )
    stress = [spoke(L3, L1, L2, c, a), spoke(L1, L2, L3, a, b), spoke(L2, L3, L1, b, c)]
    ratio = stress[0] / b.sin
    line1 = b.csc * (a.csc / L2 + c.csc / L3 - a.cot / L1 - c.cot / L1)
    line2 = (
        script.alter("sign of the L_3 term", 1, -1) * c.csc * b.csc / L3
        + c.csc * a.csc / L1
        - c.csc * (b.cot + a.cot) / L2
    )
    script.identity(
        "first display: sigma_1/sin alpha_23 = line 1 = line 2",
        ratio - line1,
        ratio - line2,
        of="B.13",
    )
    script.formula(
        "B.13",
        "Appendix B, base case, first display",
        r"\frac{\sigma_1}{\sin\alpha_{2,3}}=\csc\alpha_{2,3}(\frac{\csc\alpha_{1"
        r",2}}{L_2}+\frac{\csc\alpha_{3,1}}{L_3}-\frac{\cot\alpha_{1,2}}{L_1}-"
        r"\frac{\cot\alpha_{3,1}}{L_1})=\frac{\csc\alpha_{3,1}\csc\alpha_{2,3}}{"
        r"L_3}+\frac{\csc\alpha_{3,1}\csc\alpha_{1,2}}{L_1}+\frac{-\csc\alpha_{3"
        r",1}(\cot\alpha_{2,3}+\cot\alpha_{1,2})}{L_2}",
        over=[wheel(3)],
        at=drawn(3),
        note="Remark: its second line needs Eq. (simpletrig) twice and is sigma_2/sin(alpha_31) "
        "already; display B.14 is the first line multiplied out and belongs between the two",
        equation="B11 and B12",
    )
    right = script.alter("the cotangents as printed", c, b)
    line3 = c.csc * b.csc / L3 - b.csc * (a.cot + right.cot) / L1 + b.csc * a.csc / L2
    script.identity("second display corrected", ratio - line3, of="B.14")
    third = Angle(Fraction(-3, 5), Fraction(4, 5))  # a = alpha_12; b below; c closes up
    other = Angle(Fraction(-4, 5), Fraction(3, 5))
    last = -(third + other)
    printed = script.alter("example with the index corrected", other, last)
    gap = (third.cot + last.cot) - (third.cot + printed.cot)
    script.counterexample(
        "cos a = -3/5, cos b = -4/5, alpha_31 = pi/2: the cotangent sums over L_1 differ by 4/3",
        last.sin == 1 and gap == Fraction(4, 3),
        against="B.14",
    )
    script.formula(
        "B.14",
        "Appendix B, base case, after 'applying Eq. (simpletrig) twice'",
        r"\frac{\sigma_1}{\sin\alpha_{2,3}}=\frac{\csc\alpha_{3,1}\csc\alpha_{2,"
        r"3}}{L_3}+\frac{-\csc\alpha_{2,3}(\cot\alpha_{1,2}+\cot\alpha_{2,3})}{L"
        r"_1}+\frac{\csc\alpha_{2,3}\csc\alpha_{1,2}}{L_2}",
        r"\frac{\sigma_1}{\sin\alpha_{2,3}}=\frac{\csc\alpha_{3,1}\csc\alpha_{2,"
        r"3}}{L_3}+\frac{-\csc\alpha_{2,3}(\cot\alpha_{1,2}+\cot\alpha_{3,1})}{L"
        r"_1}+\frac{\csc\alpha_{2,3}\csc\alpha_{1,2}}{L_2}",
        over=[wheel(3)],
        at=drawn(3),
        note="index: cot alpha_31, not cot alpha_23. "
        "Remark: for example, cosines -3/5, -4/5, 0 of alpha_12, "
        "alpha_23, alpha_31, where the coefficients of 1/L_1 differ by csc(alpha_23) 4/3",
        equation="B14",
        severity=Severity.TYPO,
    )
    sign = script.alter("one of the positive terms negative", 1, -1)
    common = b.csc * c.csc / L3 + c.csc * a.csc / L1 + sign * a.csc * b.csc / L2
    script.identity(
        "all three ratios are csc_23 csc_31/L_3 + csc_31 csc_12/L_1 + csc_12 csc_23/L_2, a sum of "
        "positive terms",
        *(s / angle.sin - common for s, angle in zip(stress, (b, c, a), strict=True)),
        of="B.15",
    )
    script.formula(
        "B.15",
        "Appendix B, base case, law of sines",
        r"\sigma_1/\sin\alpha_{2,3}=\sigma_2/\sin\alpha_{3,1}=\sigma_3/\sin" r"\alpha_{1,2}",
        over=[wheel(3)],
        at=drawn(3),
        equation="B10",
    )
    u = [(K(1), K(0)), (a.cos, a.sin), ((a + b).cos, (a + b).sin)]
    sines = (b.sin, c.sin, a.sin)
    shift = script.alter("sines of the wrong angles", 0, 1)
    closed = [sum(sines[(j + shift) % 3] * u[j][k] for j in range(3)) for k in (0, 1)]
    script.identity(
        "sin alpha_23 u_1 + sin alpha_31 u_2 + sin alpha_12 u_3 = 0", *closed, of="B.16"
    )
    script.formula(
        "B.16",
        "Appendix B, base case",
        r"\sum_{j=1}^3\sigma_j\mathbf{u}_j=\mathbf{0}",
        over=forces(wheel(3)),
        at=forces(wheel(3, numbers=True)),
        note="turning angles alpha; the angle opposite sigma_1 is pi - alpha_23: with three spokes "
        "all sigma_j are positive, so the sides have lengths sigma_j. With four or more a sigma_j "
        "can be negative, and its side is traversed backwards",
        code="wheel_stress",
        equation="B9",
    )


def _induction_formulas(script: Script) -> None:
    """Spokes i-2 .. i+1; z, a, b the angles between them; superscript 0: without spoke i."""
    _, r, p, q, L0, L1, L2, L3 = field("r p q L0 L1 L2 L3", QQ)
    z, a, b = Angle.twice_arctan(r), Angle.twice_arctan(p), Angle.twice_arctan(q)
    merged = script.alter("angle after removal not merged", a + b, a)
    change = spoke(L0, L1, L2, z, a) - spoke(L0, L1, L3, z, merged)
    long = a.csc / L2 + z.csc / L0 - (a.cot + z.cot) / L1
    long += -(a + b).csc / L3 - z.csc / L0 + ((a + b).cot + z.cot) / L1
    sign = script.alter("Delta sigma_{i-1} with a sum of cotangents", 1, -1)
    short = a.csc / L2 - (a + b).csc / L3 - (a.cot - sign * (a + b).cot) / L1
    script.identity(
        "Delta sigma_{i-1} = sigma_{i-1} - sigma^0_{i-1}, unsimplified", change - long, of="B.25"
    )
    script.identity("its terms with alpha_{i-2,i-1} cancel", long - short, of="B.25 B.17")
    mirrored = spoke(L2, L3, L0, b, z) - spoke(L1, L3, L0, a + b, z)  # z: angle i+1, i+2; L0: i+2
    far = script.alter("Delta sigma_{i+1} with L_{i+1} for L_{i-1}", L1, L3)
    after = b.csc / L2 - (a + b).csc / far - (b.cot - (a + b).cot) / L3
    script.identity("Delta sigma_{i+1}", mirrored - after, of="B.17")
    script.formula(
        "B.25",
        "Appendix B, induction",
        r"\Delta\sigma_{i-1}=\frac{\csc\alpha_{i-1,i}}{L_i}+\frac{\csc\alpha_{i-"
        r"2,i-1}}{L_{i-2}}-\frac{\cot\alpha_{i-1,i}+\cot\alpha_{i-2,i-1}}{L_{i-1"
        r"}}-\frac{\csc(\alpha_{i-1,i}+\alpha_{i,i+1})}{L_{i+1}}-\frac{\csc"
        r"\alpha_{i-2,i-1}}{L_{i-2}}+\frac{\cot(\alpha_{i-1,i}+\alpha_{i,i+1})+"
        r"\cot\alpha_{i-2,i-1}}{L_{i-1}}",
        over=[without(5)],
        at=[without(5, numbers=True)],
        note="Remark: with Delta sigma_{i-1} = sigma_{i-1} - sigma^0_{i-1} and Eq. (spokes) for "
        "sigma_i",
        equation="B17",
    )
    script.formula(
        "B.17",
        "Appendix B, induction, formulas for the lengths",
        r"\Delta\sigma_{i-1}=\frac{\csc\alpha_{i-1,i}}{L_i}-\frac{\csc(\alpha_{i"
        r"-1,i}+\alpha_{i,i+1})}{L_{i+1}}-\frac{\cot\alpha_{i-1,i}-\cot(\alpha_{"
        r"i-1,i}+\alpha_{i,i+1})}{L_{i-1}}",
        over=[without(5)],
        at=[without(5, numbers=True)],
        quoted=r"\Delta\sigma_{i-1}\text{ \dots\ }=\frac{\csc\alpha_{i-1,i}}{L_i}-\frac{\csc("
        r"\alpha_{i-1,i}+\alpha_{i,i+1})}{L_{i+1}}-\frac{\cot\alpha_{i-1,i}-\cot(\alpha_{i-1,i}+"
        r"\alpha_{i,i+1})}{L_{i-1}}",
        note="and its mirror image Delta sigma_{i+1}; defined unless alpha_{i-1,i} + "
        "alpha_{i,i+1} = pi",
        equation="B18 and B19",
    )
    script.state(
        "B.18",
        "Appendix B, induction",
        r"\text{``the self stress evaluated on corresponding spokes of }G_{n+1}\text{ and "
        r"}G_{n,i}\text{ are identical except at the edges }i-1,i,i+1\text{''}",
        note="Remark: Eq. (spokes) for spoke j contains L_{j-1}, L_j, L_{j+1} and its two angles "
        "only",
        rests="B.2",
    )


def _induction_step(script: Script) -> None:
    """sigma_i u_i + Delta sigma_{i-1} u_{i-1} + Delta sigma_{i+1} u_{i+1} = 0."""
    K, p, q, L1, L2, L3 = field("p q L1 L2 L3", QQ)
    a, b = Angle.twice_arctan(p), Angle.twice_arctan(q)
    total = a + b
    sigma = spoke(L1, L2, L3, a, b)
    before = a.csc / L2 - total.csc / L3 - (a.cot - total.cot) / L1
    after = b.csc / L2 - total.csc / L1 - (b.cot - total.cot) / L3
    beta = Angle(K(-1), K(0)) + (-total)
    sign = script.alter("sin beta_i negative", 1, -1)
    script.identity(
        "sin beta_i = +sin(alpha_{i-1,i} + alpha_{i,i+1})", beta.sin - sign * total.sin, of="B.19"
    )
    sign = script.alter("the law of sines as printed", -1, 1)
    script.identity(
        "sigma_i/sin beta_i = -Delta sigma_{i-1}/sin alpha_{i,i+1} = "
        "-Delta sigma_{i+1}/sin alpha_{i-1,i}",
        sigma / beta.sin - sign * before / b.sin,
        sigma / beta.sin - sign * after / a.sin,
        of="B.20",
    )
    # Vectors, with u_{i-1} = (1, 0): no law of sines and no lengths are needed.
    sign = script.alter("Delta sigma_{i+1} reversed", 1, -1)
    last = sign * after
    closed = (before + sigma * a.cos + last * total.cos, sigma * a.sin + last * total.sin)
    script.identity(
        "sigma_i u_i + Delta sigma_{i-1} u_{i-1} + Delta sigma_{i+1} u_{i+1} = 0",
        *closed,
        of="B.20 B.23",
    )
    five: list[tuple[Any, Any]] = [(1, 0), ("4/5", "3/5"), ("7/25", "24/25"), (-1, 0), (0, -1)]
    i = script.alter("another spoke taken out", 1, 2)
    full, less = wheel_stress(star(*five), 5), wheel_stress(star(*five[:i], *five[i + 1 :]), 4)
    rise = full[(0, 5)] - less[(0, 4)]  # unit spokes: densities are stresses
    script.counterexample(
        "five unit spokes, cos alpha_12 = cos alpha_23 = 4/5, i = 2: sigma_i/sin beta_i = 25/36, "
        "Delta sigma_{i-1}/sin alpha_{i,i+1} = -25/36",
        full[(1, 5)] / Fraction(24, 25) == Fraction(25, 36)
        and rise / Fraction(3, 5) == Fraction(-25, 36),
        against="B.20",
    )
    script.formula(
        "B.19",
        "Appendix B, induction, angle of the small triangle",
        r"\beta_i=\pi-\alpha_{i-1,i}-\alpha_{i,i+1}",
        over=[without(5)],
        at=[without(5, numbers=True)],
        note="a triangle if this is positive; for its sides see B.26, for the law of sines B.20",
    )
    script.formula(
        "B.20",
        "Appendix B, induction, law of sines, and first line of the last display",
        r"\sigma_i/\sin\beta_i=\Delta\sigma_{i-1}/\sin\alpha_{i,i+1}",
        r"\sigma_i/\sin\beta_i=-\Delta\sigma_{i-1}/\sin\alpha_{i,i+1}=-\Delta"
        r"\sigma_{i+1}/\sin\alpha_{i-1,i}",
        over=[without(5)],
        at=[without(5, numbers=True)],
        note="sin(beta_i) is +sin(alpha_{i-1,i} + alpha_{i,i+1}); in the last display only the "
        "leftmost side needs the sign. "
        "Remark: for example, five unit spokes (1,0), (4/5,3/5), (7/25,24/25), "
        "(-1,0), (0,-1), the second taken out: 25/36 against -25/36. Remark: or beta_i = "
        "alpha_{i-1,i} + alpha_{i,i+1} - pi, which mends both. For the sides see B.26",
        equation="B20",
        severity=Severity.TYPO,
    )


def _last_display(script: Script) -> None:
    """The chain from -csc(a + b) sigma_i to Delta sigma_{i-1}/sin alpha_{i,i+1}."""
    _, p, q, L1, L2, L3 = field("p q L1 L2 L3", QQ)
    a, b = Angle.twice_arctan(p), Angle.twice_arctan(q)
    total, sigma = a + b, spoke(L1, L2, L3, a, b)
    lines = [
        -total.csc * (b.csc / L3 + a.csc / L1 - (b.cot + a.cot) / L2),
        -total.csc * (b.csc / L3 + a.csc / L1) + b.csc * a.csc / L2,
        b.csc * (-total.csc / L3 + a.csc / script.alter("third line: L_{i+1} for L_i", L2, L3))
        - b.csc * (a.cot - total.cot) / L1,
        (a.csc / L2 - total.csc / L3 - (a.cot - total.cot) / L1) / b.sin,
    ]
    sign = script.alter("first line with the printed sign", -1, 1)
    script.identity(
        "-sigma_i/sin beta_i = first line", sign * sigma / total.sin - lines[0], of="B.21"
    )
    script.identity(
        "each further line equals the next", *(x - y for x, y in pairwise(lines)), of="B.21"
    )
    script.formula(
        "B.21",
        "Appendix B, last display, right-hand sides",
        r"-\csc(\alpha_{i-1,i}+\alpha_{i,i+1})(\frac{\csc\alpha_{i,i+1}}{L_{i+1}}"
        r"+\frac{\csc\alpha_{i-1,i}}{L_{i-1}}-\frac{\cot\alpha_{i,i+1}+\cot\alpha_{i-1,i}}{L_i})"
        r"=-\csc(\alpha_{i-1,i}+\alpha_{i,i+1})(\frac{\csc\alpha_{i,i+1}}{L_{i+1}}"
        r"+\frac{\csc\alpha_{i-1,i}}{L_{i-1}})+\frac{\csc\alpha_{i,i+1}\csc\alpha_{i-1,i}}{L_i}"
        r"=\csc\alpha_{i,i+1}(\frac{-\csc(\alpha_{i-1,i}+\alpha_{i,i+1})}{L_{i+1}}"
        r"+\frac{\csc\alpha_{i-1,i}}{L_i})-\frac{\csc\alpha_{i,i+1}(\cot\alpha_{i-1,i}"
        r"-\cot(\alpha_{i-1,i}+\alpha_{i,i+1}))}{L_{i-1}}"
        r"=\frac{\Delta\sigma_{i-1}}{\sin\alpha_{i,i+1}}",
        over=[without(5)],
        at=[without(5, numbers=True)],
        note="as far as the four right-hand sides go, which are equal; the left-hand side needs "
        "the sign of B.20",
        equation="B20 to B24",
    )


def _choice_of_spoke(script: Script) -> None:
    """Which spoke can be taken out, and the only star from which none can."""
    straight = star((1, 0), (0, 1), (-1, 0), (0, -1)).vertices
    step = script.alter("one angle for the sum of two", 1, 0)
    script.counterexample(
        "cross: alpha_{i-1,i} + alpha_{i,i+1} = pi for every i, so no spoke can be taken out",
        all(cross(straight[i - 1], straight[(i + step) % 4]) == 0 for i in range(4)),
        against="B.22",
    )
    for size in (4, 5, 6, 7, 8):
        _, *angles = ring([f"a{k}" for k in range(size)], QQ)
        sums = [angles[k - 1] + angles[k] for k in range(size)]
        every = sums[:: script.alter("sums at every spoke of four", 2, 1)] if size == 4 else sums
        script.identity(
            "four spokes: the sums at opposite spokes add up to all angles, 2 pi, so one is < pi, "
            "or all are pi"
            if size == 4
            else f"{size} spokes: the {size} sums add up to twice all angles, 4 pi, so one is at "
            f"most 4 pi/{size} < pi",
            sum(every) - (1 if size == 4 else script.alter(f"once, {size}", 2, 1)) * sum(angles),
            of="B.22",
        )
    wide = script.alter("spokes with a wide pair beside them", 1, -1)
    script.cases(
        "random stars of 4 to 8 spokes have a spoke between two others less than pi apart, unless "
        "they are two straight lines",
        (
            any(wide * cross(d[k - 1], d[(k + 1) % len(d)]) > 0 for k in range(len(d)))
            or (len(d) == 4 and all(cross(d[k], d[k - 2]) == 0 for k in range(4)))
            for d in random_stars()
        ),
        of="B.22",
    )
    _, p, *L = field("p L1 L2 L3 L4", QQ)
    a = Angle.twice_arctan(p)
    flip = Angle(-a.cos, a.sin)  # pi - a
    angles = (a, flip, a, script.alter("lines that do not cross straight", flip, a))
    s = [spoke(L[j - 1], L[j], L[(j + 1) % 4], angles[j - 1], angles[j]) for j in range(4)]
    script.identity(
        "all sums pi: sigma_1 = sigma_3, sigma_2 = sigma_4", s[0] - s[2], s[1] - s[3], of="B.22"
    )
    script.state(
        "B.22",
        "Appendix B, induction: G_{n,i} by removing 'an arbitrary' spoke vertex i",
        r"\text{``the star graph }G_{n,i}\text{ formed by removing (an arbitrary) spoke "
        r"vertex }i\text{''}",
        r"\text{for a spoke }i\text{ with }\alpha_{i-1,i}+\alpha_{i,i+1}<\pi",
        "equal to pi: Eq. (spokes) has no meaning in G_{n,i}; larger: G_{n,i} has a reflex "
        "sector, where the formulas hold, but neither the figure nor 'angles in (0, pi)'. Such a "
        "spoke exists unless N = 4 and the spokes form two straight lines, as in the cross (1,0), "
        "(0,1), (-1,0), (0,-1), where the induction fails for every i; there sigma_1 = sigma_3 "
        "and sigma_2 = sigma_4 directly",
        severity=Severity.CONDITION,
    )
    script.formula(
        "B.23",
        "Appendix B, force balance at the hub",
        r"\sum_{j=1}^N\sigma_j\mathbf{u}_j=\mathbf{0}",
        over=forces(wheel(4)),
        at=[names for drawing in drawn(4, 5, 6) for names in forces(drawing)],
        note="Remark: by the corrected induction, and by B.24 without induction; printed for N = 3 "
        "(B.16)",
        code="wheel_stress",
        rests="B.24",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
