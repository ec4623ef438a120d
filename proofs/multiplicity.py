"""Multiplicity of triangulated triangles, and the number of distinct branches (Section III A).

Multiplicity theorem. Let m vertices lie inside triangulated triangles and w be their heights over
the planes of the corners, y the other heights in a chart. The m inner forms G(w) have only w = 0 in
common (definite stress), so they are a regular sequence and A = Q[w] / (G) is a local ring of
length 2^m. Modulo w the other forms F(y, w) are the forms F(y, 0) of the emptied pattern. If these
have an isolated zero y0 of multiplicity k, they are a regular sequence on the closed fibre of the
flat A-algebra A[y], hence on A[y] near y0, with a flat quotient: (y0, 0) has multiplicity 2^m k.
"""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from exactfold import BranchSystem, CreasePattern, QuadraticSystem, families, groebner
from proofs.branch_counts import OCTAHEDRON, SQUARE, TWISTED, inner_points, restricted
from proofs.framework import Proof, Ruling, Script, run

NAME = "multiplicity"
TITLE = "Multiplicities and the number of distinct branches"

CORRECTED, FALSE = Ruling.CORRECTED, Ruling.FALSE

HUB = (Fraction(3, 7), Fraction(5, 9))


def prove(change: str | None = None) -> Proof:
    """2^Vt times the multiplicity in the emptied pattern; fewer than 2^(Vi - Vt) branches."""
    script = Script(
        NAME, TITLE, ("four boundary vertices; finitely many roots of the emptied pattern",), change
    )
    _multiplicity(script)
    return script.proof()


def _multiplicity(script: Script) -> None:
    """2^Vt, times the multiplicity in the emptied pattern; the number of distinct branches."""
    inner = CreasePattern(
        [(0, 0), (9, 0), (0, 9), *inner_points((0, 0), (9, 0), (0, 9))], OCTAHEDRON
    )
    for pattern, m in ((families.single_vertex(3), 1), (inner, 3), (TWISTED, 3)):
        forms = [restricted(pattern, v, pattern.interior) for v in pattern.interior]
        zero = Fraction(0)
        system = QuadraticSystem.from_rational(
            [[[*row, zero] for row in form] + [[zero] * (m + 1)] for form in forms]
        )
        solution = groebner(system)
        script.certificate(
            f"{m} inner forms: complete intersection, one zero of multiplicity 2^{m}",
            [c.multiplicity for c in solution.classes]
            == [2 ** script.alter(f"length of the inner ring, {pattern.sha256[:6]}", m, m + 1)],
        )
    octahedron = [tuple((0, 1, 4, 5, 6, 7)[k] for k in t) for t in OCTAHEDRON]
    wheel = [(1, 2, 4), (2, 3, 4), (3, 0, 4)]
    rigid = CreasePattern([*SQUARE, HUB, *inner_points((0, 0), (1, 0), HUB)], [*wheel, *octahedron])
    third = CreasePattern(
        [*SQUARE, HUB, (Fraction(1, 2), Fraction(1, 5))],
        [*wheel, (0, 1, 5), (1, 4, 5), (4, 0, 5)],
    )
    script.certificate(
        "whole systems: hub and octahedron 2 roots of multiplicity 8, hub and degree-3 vertex 2 "
        "of 2",
        _multiplicities(rigid) == [8, 8] and _multiplicities(third) == [2, 2],
    )
    flat = families.flat_vertex_square()
    extra = CreasePattern(
        [*flat.vertices, (Fraction(17, 30), Fraction(1, 15))],
        [*(t for t in flat.triangles if set(t) != {0, 1, 5}), (0, 1, 6), (1, 5, 6), (5, 0, 6)],
    )
    factor = script.alter("multiplicities not multiplied", 2, 1)
    script.counterexample(
        "flat-vertex square: 3 roots of multiplicities 1, 1, 2, not 4; with a degree-3 vertex "
        "added "
        "2, 2, 4: twice those of the emptied pattern, not all 2^Vt = 2",
        _multiplicities(flat) == [1, 1, 2]
        and _multiplicities(extra) == [factor * k for k in (1, 1, 2)]
        and (flat.Vi, flat.Vt, extra.Vt) == (2, 0, 1),
    )
    script.state(
        "IIIA.12",
        "Section III A, Eq. (B distinct)",
        r"B_{distinct}=2^{V_i-V_t}",
        FALSE,
        r"\sum_{branches}\mu=2^{V_i-V_t}\text{ with multiplicities }\mu\text{ in the emptied "
        r"pattern; "
        r"}B_{distinct}\le2^{V_i-V_t},\text{ equality iff all }\mu=1",
        "square with inner vertices (1/2,1/2), (7/10,1/5), triangles 015, 125, 245, 405, 234, 304: "
        "Vt = 0 and 3 branches. A straight crease path is the usual cause",
        "BranchCount.distinct",
    )
    script.state(
        "IIIA.13",
        "Section III A, before Eq. (B distinct)",
        r"\text{``the distinct roots of the quadratic equations had multiplicity }2^{V_t}\text{''}",
        CORRECTED,
        r"2^{V_t}\mu,\ \mu\text{ the multiplicity in the emptied pattern}",
        "as printed whenever the emptied pattern has simple roots. The square of IIIA.12 with a "
        "degree-3 vertex (17/30, 1/15) in 015 has multiplicities 2, 2, 4",
        "Branch.multiplicity",
    )


def _multiplicities(pattern: CreasePattern) -> list[int]:
    """Multiplicities of all roots of the branch system of the whole pattern, in order."""
    classes = groebner(BranchSystem(pattern).chart.system).classes
    return sorted(c.multiplicity for c in classes for _ in range(c.degree))


if __name__ == "__main__":
    sys.exit(run(prove()))
