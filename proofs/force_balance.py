"""Force balance of the wheel stress at the rim and at the hub (Appendix B)."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.fields import field

from exactfold import CreasePattern
from exactfold.pattern import families
from exactfold.rigidity import wheel_stress
from proofs.framework import Proof, Script, run
from proofs.spokes import drawn, ladder, wheel
from proofs.statements import Severity
from proofs.wheel_stress import Angle, cross, dot, with_vertices

NAME = "force_balance"
TITLE = "Force balance of the wheel stress"


def spoke(L0: Any, L1: Any, L2: Any, before: Angle, after: Angle) -> Any:
    """Eq. (spokes): the stress of the spoke L1 between L0 and L2."""
    return after.csc / L2 + before.csc / L0 - after.cot / L1 - before.cot / L1


def star(*spokes: tuple[Any, Any]) -> CreasePattern:
    """The wheel with these spokes; its hub is the last vertex, at the origin."""
    n = len(spokes)
    return CreasePattern([*spokes, (0, 0)], [(j, (j + 1) % n, n) for j in range(n)])


def prove(change: str | None = None) -> Proof:
    """Check Appendix B line by line, and give a proof in one line that covers every star."""
    hypotheses = (
        "a hub 0 with N >= 3 spokes of lengths L_i > 0, angles alpha_{i,i+1} in (0, pi) between "
        "adjacent ones, sum 2 pi; eta_{i,i+1}, eta_{i-1,i} are the angles at spoke vertex i",
        "the last part (B.24): any closed sequence of spokes with cross products c_j != 0",
    )
    script = Script(NAME, TITLE, hypotheses, change)
    _stresses(script)
    _rim(script)
    _crossed_ladders(script)
    _telescope(script)
    _small_triangle(script)
    return script.proof()


def _stresses(script: Script) -> None:
    """Eqs. (wheelstress), (outer), (spokes) divided by edge lengths are exactfold's densities."""
    K, p, q, *L = field("p q L1 L2 L3", QQ)
    a, b = Angle.twice_arctan(p), Angle.twice_arctan(q)
    alpha, turns = (a, b, -(a + b)), (Angle(K(1), K(0)), a, a + b)
    ends = [(r * turn.cos, r * turn.sin) for r, turn in zip(L, turns, strict=True)]
    stress = wheel_stress(with_vertices(families.single_vertex(3), [*ends, (K(0), K(0))]), 3)
    sign = script.alter("rim stress positive", -1, 1)
    differences = []
    for j in range(3):
        k, i = (j + 1) % 3, j - 1
        rim = sign * alpha[j].csc / (L[j] * L[k])
        differences.append(stress[(min(j, k), max(j, k))] - rim)
        differences.append(stress[(j, 3)] - spoke(L[i], L[j], L[k], alpha[i], alpha[j]) / L[j])
    script.identity(
        "wheel_stress is Eqs. (outer), (spokes) over the edge lengths",
        *differences,
        of="IIB.4 B.1 B.2",
    )
    code, read = "wheel_stress", "Remark: read off A.8: coefficient of (h_i - h_j)^2 / (2 length)"
    script.formula(
        "IIB.4",
        "Section II B, Eq. (wheelstress)",
        r"\tilde{\sigma}_{I,I+1}=-\csc\alpha_{I,I+1}\frac{\Delta L_{I,I+1}}{L_IL_{I+1}},\quad "
        r"\tilde{\sigma}_I=L_{I+1}^{-1}\csc\alpha_{I,I+1}+L_{I-1}^{-1}\csc\alpha_{I-1,I}"
        r"-L_I^{-1}(\cot\alpha_{I,I+1}+\cot\alpha_{I-1,I})",
        over=[wheel(4)],
        at=drawn(4, 5),
        code=code,
        equation="7",
    )
    script.formula(
        "B.1",
        "Appendix B, Eq. (outer)",
        r"\sigma_{i,i+1}=-\csc\alpha_{i,i+1}\frac{\Delta L_{i,i+1}}{L_iL_{i+1}}",
        over=[wheel(4), wheel(5)],
        at=drawn(4, 5),
        note=read,
        code=code,
        equation="B1",
    )
    script.formula(
        "B.2",
        "Appendix B, Eq. (spokes)",
        r"\sigma_i=\frac{\csc\alpha_{i,i+1}}{L_{i+1}}+\frac{\csc\alpha_{i-1,i}}{"
        r"L_{i-1}}-\frac{\cot\alpha_{i,i+1}}{L_i}-\frac{\cot\alpha_{i-1,i}}{L_i}",
        over=[wheel(4), wheel(5)],
        at=drawn(4, 5),
        note=read,
        code=code,
        equation="B2",
    )
    script.state(
        "B.3",
        "Appendix B, second paragraph",
        r"\bm{\sigma}^T\cdot\mathbf{C}=\mathbf{0}^T\text{ \dots\ ``self stresses are "
        r"assignments of tensions and compressions to edges that preserve force balance at "
        r"each vertex''}",
        note="Remark: the columns of vertex n give the sum over its edges of sigma times the unit "
        "vector",
        rests="IIA.14",
    )


def _rim(script: Script) -> None:
    """Forces at spoke vertex i = (L, 0), neighbours at angles alpha = a and -b from the spoke."""
    K, p, q, L, M, N, D, E = field("p q L M N D E", QQ)  # M, N = L_{i+1}, L_{i-1}; D, E the rims
    a, b, zero = Angle.twice_arctan(p), Angle.twice_arctan(q), K(0)
    to_next, to_last = (M * a.cos - L, M * a.sin), (N * b.cos - L, -N * b.sin)
    to_hub = (-L, zero)
    sin_next, cos_next = cross(to_hub, to_next) / (-L * D), dot(to_hub, to_next) / (L * D)
    sin_last, cos_last = cross(to_hub, to_last) / (L * E), dot(to_hub, to_last) / (L * E)
    rim_next, rim_last = -a.csc * D / (L * M), -b.csc * E / (L * N)
    over = script.alter("outer2 with L_{i+1}", L, M)
    script.identity("Eq. (outer2)", rim_next + 1 / (sin_next * over), of="B.4")
    over = script.alter("outer3 with L_{i-1}", L, N)
    script.identity("Eq. (outer3)", rim_last + 1 / (sin_last * over), of="B.5")
    script.formula(
        "B.4",
        "Appendix B, Eq. (outer2)",
        r"\sigma_{i,i+1}=-\csc\eta_{i,i+1}/L_i",
        over=[wheel(4), wheel(5)],
        at=drawn(4, 5),
        equation="B3",
    )
    script.formula(
        "B.5",
        "Appendix B, Eq. (outer3)",
        r"\sigma_{i-1,i}=-\csc\eta_{i-1,i}/L_i",
        over=[wheel(4), wheel(5)],
        at=drawn(4, 5),
        note="both eta are angles at vertex i. Remark: so Eq. (outer3) is not Eq. (outer2) with i "
        "- 1 for i, whose eta_{i-1,i} would be the other angle, at vertex i - 1",
        equation="B4",
    )
    sign = script.alter("perpendicular balance as printed", 1, -1)
    script.identity(
        "sigma_{i,i+1} sin eta_{i,i+1} = sigma_{i-1,i} sin eta_{i-1,i} = -1/L_i",
        rim_next * sin_next - sign * rim_last * sin_last,
        rim_next * sin_next + 1 / L,
        of="B.6",
    )
    sign = script.alter("both rim edges on one side of the spoke", 1, -1)
    script.identity(
        "perpendicular components of the two rim forces add up to zero",
        rim_next * to_next[1] / D + sign * rim_last * to_last[1] / E,
        of="B.6",
    )
    value = script.alter("rim of the cross positive", Fraction(-1), Fraction(1))
    # alpha = pi/2 and L = 1 throughout: sigma sin eta = -1/L on both sides
    square = wheel_stress(star((1, 0), (0, 1), (-1, 0), (0, -1)), 4)
    script.counterexample(
        "cross of unit spokes: rim density times height over the spoke is -1 on both sides, so the "
        "printed equation reads -1 = +1",
        square[(0, 1)] == square[(0, 3)] == value and value != -value,
        against="B.6",
    )
    script.formula(
        "B.6",
        "Appendix B, forces perpendicular to the spoke",
        r"\sigma_{i,i+1}\sin\eta_{i,i+1}=-\sigma_{i-1,i}\sin\eta_{i-1,i}",
        r"\sigma_{i,i+1}\sin\eta_{i,i+1}=\sigma_{i-1,i}\sin\eta_{i-1,i}=-1/L_i",
        over=[wheel(4), wheel(5)],
        at=drawn(4, 5),
        note="the edges leave on opposite sides of the spoke, so equal magnitudes balance; "
        "also the subscript of the second eta has slipped to the line. "
        "Remark: for example, a cross of unit spokes",
        severity=Severity.TYPO,
    )
    total = script.alter("one cotangent lost", 1, 0)
    cot_next, cot_last = cos_next / sin_next, cos_last / sin_last
    along = -(rim_next * to_next[0] / D + rim_last * to_last[0] / E)
    script.identity(
        "F_rim parallel to the spoke", along + (cot_last + total * cot_next) / L, of="B.7"
    )
    script.formula(
        "B.7",
        "Appendix B, F_rim parallel, in two parts, Eq. (spokepar)",
        r"F_{rim,\parallel}=-(\cot\eta_{i-1,i}+\cot\eta_{i,i+1})/L_i,\quad "
        r"F_{rim,\parallel}=F_{rim,\parallel,-}+F_{rim,\parallel,+},\quad "
        r"F_{rim,\parallel,-}=-\cot\eta_{i-1,i}/L_i,\quad "
        r"F_{rim,\parallel,+}=-\cot\eta_{i,i+1}/L_i",
        over=[_rim_forces(wheel(4))],
        at=map(_rim_forces, drawn(4, 5)),
        functions=[rf"F_{{rim,\parallel{side}}}" for side in ("", ",-", ",+")],
        quoted=r"F_{rim,\parallel}=-(\cot\eta_{i-1,i}+\cot\eta_{i,i+1})/L_i\text{ \dots\ }"
        r"=F_{rim,\parallel,-}+F_{rim,\parallel,+}\text{ \dots\ }"
        r"F_{rim,\parallel,-}=-\cot\eta_{i-1,i}/L_i\text{ \dots\ }"
        r"F_{rim,\parallel,+}=-\cot\eta_{i,i+1}/L_i",
        equation="B5 to B7",
    )
    sign = script.alter("first piece with the cotangent added", 1, -1)
    over = script.alter("second piece with L_i for L_{i+1}", M, L)
    first, second = b.csc / N - sign * b.cot / L, a.csc / over - a.cot / L
    script.identity(
        "first piece cancels F_{rim,-}, second F_{rim,+}", first - cot_last / L, of="B.8"
    )
    script.identity(
        "the two pieces make up the spoke", first + second - spoke(N, L, M, b, a), of="B.8"
    )
    script.identity("second piece cancels F_{rim,+}", second - cot_next / L, of="B.8")
    script.formula(
        "B.8",
        "Appendix B, Eq. (firstpiece) and the cancellation of both pieces",
        r"\csc\alpha_{i-1,i}/L_{i-1}-\cot\alpha_{i-1,i}/L_i=\cot\eta_{i-1,i}/L_i",
        over=[wheel(4), wheel(5)],
        at=drawn(4, 5),
        quoted=r"\text{``The first piece is }\csc\alpha_{i-1,i}/L_{i-1}-\cot\alpha_{i-1,i}/L_i"
        r"\text{'' \dots\ ``the first part of the force along the spoke edge (Eq. "
        r"(\ref{eq:firstpiece})) cancels }F_{rim,\parallel,-}\text{''}",
        note="Remark: Eq. (firstpiece) is minus F_{rim,-} = -cot(eta_{i-1,i})/L_i; for acute, "
        "right and obtuse angles. The second piece is its mirror image",
        equation="B8",
    )
    sign = script.alter("foot of the height beyond the hub", 1, -1)
    script.identity(
        "cot eta_{i-1,i} = (L_i - h cot alpha)/h",
        cot_last - (L - sign * N * b.cos) / (N * b.sin),
        of="B.9",
    )


def _crossed_ladders(script: Script) -> None:
    """Lines from (0, 0) to (L, B) and from (0, A) to (L, 0) cross at height h."""
    _, A, B, L, p, e = field("A B L p e", QQ)
    h = script.alter("harmonic sum replaced by the mean", A * B / (A + B), (A + B) / 2)
    x = L * h / B
    script.identity("1/A + 1/B = 1/h", 1 / A + 1 / B - 1 / h, A * (1 - x / L) - h, of="B.9")
    alpha, eta = Angle.twice_arctan(p), Angle.twice_arctan(e)
    opposite = script.alter("law of sines with the other angle", eta, alpha)
    length = L * opposite.sin / (alpha + eta).sin  # L_{i-1} by the law of sines
    script.identity(
        "A = L tan eta, B = L tan alpha, h = L_{i-1} sin alpha, for all angles",
        eta.cot / L + alpha.cot / L - 1 / (length * alpha.sin),
        of="B.10",
    )
    script.formula(
        "B.9",
        "Appendix B, crossed ladders, Fig. (crossedladder)",
        r"1/A+1/B=1/h",
        over=[_without_values(ladder(wheel(4)))],
        at=[_without_values(ladder(names)) for names in drawn(4, 5)],
        note="for signed lengths, hence also for an obtuse angle; at a right angle 1/A or 1/B is 0",
    )
    obtuse = Angle(Fraction(script.alter("obtuse angle taken acute", -3, 3), 5), Fraction(4, 5))
    script.example(
        "alpha with cosine -3/5, L_i = 1: B = L_i tan alpha = -4/3 is no side length",
        1 / obtuse.cot == Fraction(-4, 3),
        of="B.10",
    )
    script.formula(
        "B.10",
        "Appendix B, A, B and h as sides of right triangles",
        r"\text{``}L_i\tan\eta_{i-1,i}\text{ which is the side length }A\text{ of a certain right "
        r"triangle'' \dots\ ``}L_i\tan\alpha_{i-1,i}\text{ which is the side length }B\text{'' "
        r"\dots\ ``}L_{i-1}\sin\alpha_{i-1,i}\text{, which is the side length }h\text{''}",
        over=[ladder(wheel(4))],
        at=map(ladder, drawn(4, 5)),
        note="as in the figure, for acute angles; A and B are signed, negative for an obtuse angle "
        "and infinite for a right one. With these signs the cancellation B.8 holds always",
    )


def _without_values(names: dict[str, Any]) -> dict[str, Any]:
    return {name: value for name, value in names.items() if name != "values"}


def _rim_forces(names: dict[str, Any]) -> dict[str, Any]:
    """The same names with the forces of the rim at spoke vertex 2 along its spoke, outwards."""
    ends, forces = names["ends"], {}
    for side, (i, j) in {"-": (1, 2), "+": (2, 3)}.items():
        a, b = ends[1], ends[j - 1] if i == 2 else ends[i - 1]
        away = dot((a[0] - b[0], a[1] - b[1]), a) / (names["Delta L"](i, j) * names["L"](2))
        forces[rf"F_{{rim,\parallel,{side}}}"] = names["sigma"](i, j) * away
    return {**names, **forces, r"F_{rim,\parallel}": sum(forces.values())}


def _telescope(script: Script) -> None:
    """The balance for all N at once, by densities w. The spokes d, e, f are consecutive; J turns
    left."""
    _, *g = field("x0 y0 x1 y1 x2 y2", QQ)
    d, e, f = (g[0], g[1]), (g[2], g[3]), (g[4], g[5])

    def turned(v: Any, k: int) -> Any:
        return -v[1] if k == 0 else v[0]

    def part(v: Any, w: Any, k: int) -> Any:  # (w - (s/|v|^2) v)/c
        return (w[k] - dot(v, w) / dot(v, v) * v[k]) / abs_cross

    abs_cross, sign = cross(d, e), script.alter("J turns right", 1, -1)
    script.identity(
        "(d_{j+1} - (s_j/L_j^2) d_j)/c_j = J d_j/L_j^2 and "
        "(d_j - (s_j/L_{j+1}^2) d_{j+1})/c_j = -J d_{j+1}/L_{j+1}^2",
        *(part(d, e, k) - sign * turned(d, k) / dot(d, d) for k in (0, 1)),
        *(part(e, d, k) + sign * turned(e, k) / dot(e, e) for k in (0, 1)),
        of="B.24",
    )
    w = 1 / cross(e, f) + 1 / cross(d, e)
    w -= (dot(e, f) / cross(e, f) + dot(d, e) / cross(d, e)) / dot(e, e)
    half = script.alter("rim force doubled", 1, 2)
    rim = [-half * (e[k] - f[k]) / cross(e, f) - (e[k] - d[k]) / cross(d, e) for k in (0, 1)]
    script.identity(
        "rim vertex: the three forces add up to 0", *(rim[k] + w * e[k] for k in (0, 1)), of="B.24"
    )
    sign = script.alter("sector that does not telescope", 1, -1)
    step = [
        (d[k] + e[k]) / cross(d, e)
        - dot(d, e) / cross(d, e) * (d[k] / dot(d, d) + e[k] / dot(e, e))
        - (turned(d, k) / dot(d, d) - sign * turned(e, k) / dot(e, e))
        for k in (0, 1)
    ]
    script.identity(
        "hub: sum_j w_j d_j, collected by sectors, is a telescoping sum of "
        "J d_j/L_j^2 - J d_{j+1}/L_{j+1}^2 around the hub, hence 0",
        *step,
        of="B.24",
    )
    script.state(
        "B.24",
        "Appendix B, conclusion",
        r"\text{``Eqs. (\ref{eq:outer}) and (\ref{eq:spokes}) define a self stress on the "
        r"wheel graph''}",
        note="Remark: short proof for every closed star with c_j != 0, back-tracks and any winding "
        "too: d_{j+1} - (s_j/L_j^2) d_j = (c_j/L_j^2) J d_j telescopes at the hub, cancels at the "
        "rim",
        code="wheel_stress",
    )


def _small_triangle(script: Script) -> None:
    """The sides of the triangle in the induction, for five spokes one of which is taken out."""
    five: list[tuple[Any, Any]] = [(1, 0), ("4/5", "3/5"), ("7/25", "24/25"), (-1, 0), (0, -1)]
    i = script.alter("a spoke taken out that is not beside the first", 1, 2)
    full, less = wheel_stress(star(*five), 5), wheel_stress(star(*five[:i], *five[i + 1 :]), 4)
    sides = [full[(1, 5)], full[(0, 5)] - less[(0, 4)], full[(2, 5)] - less[(1, 4)]]
    script.counterexample(
        "five unit spokes, cos alpha_12 = cos alpha_23 = 4/5, i = 2: sigma_i = 2/3, Delta "
        "sigma_{i-1} = Delta sigma_{i+1} = -5/12",
        sides == [Fraction(2, 3), Fraction(-5, 12), Fraction(-5, 12)],
        against="B.26",
    )
    script.state(
        "B.26",
        "Appendix B, induction, the small triangle",
        r"\text{``there is a closed triangle with side lengths }\Delta\sigma_{i-1}="
        r"\sigma_{i-1}-\sigma^0_{i-1}\text{, }\Delta\sigma_{i+1}=\sigma_{i+1}-\sigma^0_{i+1}"
        r"\text{, and }\sigma_i\text{''}",
        r"\text{the side lengths are }|\Delta\sigma_{i-1}|\text{, }|\Delta\sigma_{i+1}|\text{ and "
        r"}|\sigma_i|\text{; where }\sigma_i>0\text{ both differences are negative}",
        "as sigma_i/sin beta_i = -Delta sigma_{i-1}/sin alpha_{i,i+1} (B.20), and the sines are "
        "positive if alpha_{i-1,i} + alpha_{i,i+1} < pi (B.22). "
        "Remark: for example, five unit spokes (1,0), "
        "(4/5,3/5), (7/25,24/25), (-1,0), (0,-1), the second taken out: 2/3, -5/12, -5/12",
        severity=Severity.TYPO,
        rests="B.20",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
