"""Popping up and down, and the chambers of vertex sign patterns (Sections II B and III B).

K is the curvature form of a vertex, and t its round cone. The module `eigenvector` has the nappes
and the eigenvector h_-.
"""

from __future__ import annotations

import sys
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from exactfold import CreasePattern, random_square
from exactfold.exact.linalg import rank
from exactfold.pattern.families import flat_octahedron_in_square
from exactfold.rigidity import definite_stress
from exactfold.rigidity.functionals import vertex_sign_functional
from proofs.framework import Proof, Script, run
from proofs.patterns import SPIKY
from proofs.statements import Severity
from proofs.vertex_forms import cot, csc, dot, star, symbols, unit

NAME = "vertex_signs"
TITLE = "Popping up and down, and the chambers of sign patterns"
HYPOTHESES = (
    "flat vertices, angles in (0, pi) with sum 2 pi, spokes of any lengths: inertia (1, N-3, 3)",
    "for chambers: a triangulated convex polygon",
)


def prove(change: str | None = None) -> Proof:
    """Statements on the trace of a vertex, on popping and on chambers."""
    script = Script(NAME, TITLE, HYPOTHESES, change)
    _popping(script)
    _hemispheres(script)
    _chambers(script)
    return script.proof()


def _popping(script: Script) -> None:
    s, t, p, q = symbols("s t p q")
    u, v, half = unit(s), unit(t), (t - s) / (1 + s * t)
    slope = (p, q)  # on a face rho(theta) = slope . (cos theta, sin theta)
    integral = dot(slope, (v[1] - u[1], u[0] - v[0]))
    x, y = dot(slope, u), dot(slope, v)
    polar = -(x + y) / 2 * csc(u, v) + cot(u, v) / 2 * (x + y)
    script.identity(
        "in each sector the polar form with the round cone is -(1/2) tan(a/2) (psi_j + psi_{j+1}) "
        "= -(1/2) int rho, rho the slope in direction theta: K(t, h) = -(1/2) int rho d theta",
        integral - half * (x + y),
        polar + script.alter("factor one half", 1, 2) * integral / 2,
        of="IIB.29",
    )
    # The area above the trace z = eps rho(theta) + ... on the sphere is 2 pi - eps int rho + ...
    opposite = script.alter("the straight line bent, too", (-5, 0, 0), (-4, 0, 3))
    ring = [(5, 0, 0), (0, 3, 4), opposite, (0, -3, 4)]  # times 5
    script.counterexample(
        "four spokes at right angles, folded along a straight line: unit vectors (1,0,0), "
        "(0,3/5,4/5), (-1,0,0), (0,-3/5,4/5) keep the angles and hold two antipodes, which lie in "
        "no open hemisphere",
        all(sum(a * b for a, b in zip(ring[k - 1], ring[k], strict=True)) == 0 for k in range(4))
        and all(a == -b for a, b in zip(ring[0], ring[2], strict=True)),
        against="IIB.28",
    )
    script.state(
        "IIB.28",
        "Section II B, popped up and popped down",
        r"\text{the trace of a folded origami vertex lies completely in an open hemisphere}",
        r"\text{in a closed hemisphere; in an open one unless the vertex is folded along a "
        r"straight line only}",
        note="the trace has length 2 pi: if it holds antipodes it consists of two great "
        "semicircles. "
        "Remark: then, too, one side has area less than 2 pi, and the definition of popping "
        "is not affected. Remark: that all other closed curves of length 2 pi lie in an open "
        "hemisphere is classical and not checked here",
        severity=Severity.CONDITION,
        cited="closed curves of length below 2 pi lie in an open hemisphere",
    )
    script.state(
        "IIB.29",
        "Section II B, popped up and popped down",
        r"\text{``one of the nappes of the double cone configuration space consists of "
        r"popped up configurations and the other consists of popped down configurations''}",
        note="near the unfolded state: for heights eps h the area above the trace is 2 pi + 2 eps "
        "K(t, h) + O(eps^2), t the round cone, and K(t, h) is not 0 on a nappe. The printed "
        "argument (the two types meet only in the unfolded state) needs connected nappes: for N = "
        "4 they are two rays each",
        code="vertex_sign_functional",
        rests="IIB.24",
    )


def _hemispheres(script: Script) -> None:
    """The simpler definition by hemispheres agrees with the one by areas."""
    s, t, x, y = symbols("s t x y")
    u, v = unit(s), unit(t)
    polar = -(x + y) / 2 * csc(u, v) + cot(u, v) / 2 * (x + y)
    weight = script.alter("half angle replaced by the angle", (t - s) / (1 + s * t), csc(u, v))
    script.identity(
        "K(t, h) = -(1/2) sum_j tan(a_j/2) (psi_j + psi_{j+1}): if all edges rise from the vertex, "
        "every term is negative, so the vertex is popped down; if all descend, popped up",
        polar + weight * (x + y) / 2,
        of="IIB.30",
    )
    level = {0: 2, 1: 1, 2: 2, 3: 1, 4: 0}
    plane = script.alter("folded, not rotated", (1, 0, -1, 0, 0), (1, 0, 1, 0, 0))
    tilted = {v: h - 3 * plane[v] for v, h in level.items()}
    functional = vertex_sign_functional(star((1, 0), (0, 1), (-1, 0), (0, -1)), 4)
    signs = [sum(w * heights[v] for v, w in functional.items()) for heights in (level, tilted)]
    script.example(
        "rotated, four rising edges rise and descend, and the vertex stays popped down",
        signs[0] == signs[1] < 0 and min(tilted.values()) < 0 < max(tilted.values()),
        of="IIB.30",
    )
    script.state(
        "IIB.30",
        "Section II B, last sentence",
        r"\text{``popped down (up) vertices are those whose edge vectors are all in the "
        r"northern (southern) hemisphere. Our definition is a rotation-invariant "
        r"generalization''}",
        note="to lowest order in the heights, like the vertex signs of exactfold",
        code="vertex_sign_functional",
    )


def _is_independent(pattern: CreasePattern) -> bool:
    rows = [vertex_sign_functional(pattern, v) for v in pattern.interior]
    matrix = [[row.get(j, 0) for j in pattern.interior] for row in rows]
    return rank(matrix) == pattern.Vi and definite_stress(pattern) is not None


def _chambers(script: Script) -> None:
    s, t, r = symbols("s t r")
    before, after, u, v, w = (t - s) / (1 + s * t), (r - t) / (1 + t * r), unit(s), unit(t), unit(r)
    weight = csc(u, v) - cot(u, v) + csc(v, w) - cot(v, w)
    script.identity(
        "K(t, h) = (1/2) sum_j m_j (h_0 - h_j), m_j = (tan(a_{j-1,j}/2) + tan(a_{j,j+1}/2))/L_j > "
        "0: heights that are 0 on the boundary and have all K_v(t_v, h) = 0 vanish (maximum "
        "principle)",
        weight - before - script.alter("mean value weights", after, -after),
        of="IIIB.2",
    )
    squares = [random_square(5, k) for k in range(3)]
    reflex = script.alter("a reflex sheet", (), (SPIKY,))
    script.cases(
        "these functionals have rank Vi on the interior heights, and sum m_v K_v, m_v > 0, is "
        "positive definite there: heights with K_v(e_v, h) = 0, hence K_v(h) <= 0, at every v "
        "vanish",
        map(_is_independent, [*squares, flat_octahedron_in_square(), *reflex]),
        of="IIIB.2",
    )
    script.state(
        "IIIB.2",
        "Section III B, chambers",
        r"\text{``The set of all such planes arising from the }V_i-V_t\text{ foldable "
        r"vertices divides }\mathbb{R}^{V_i-V_t+1}\text{ into }2^{V_i-V_t}\text{ chambers'' "
        r"\dots\ ``Each of these chambers is topologically the product of an orthant of "
        r"}\mathbb{R}^{V_i-V_t}\text{ with a real line''}",
        note="Remark: because the functionals e_v . h are independent: heights that are 0 on the "
        "boundary, flat in the triangulated triangles, and have K_v(e_v, h) = 0 at the foldable v "
        "have K_v(h) <= 0 everywhere, and vanish by the key lemma for convex polygons "
        "(docs/theorem.md). The paper does not say why",
        code="definite_stress, vertex_sign_functional",
        words="docs/theorem.md, key lemma",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
