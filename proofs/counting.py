"""Counts of Sections II C and III: unknowns, folds, assignments, rays and chambers."""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy

from exactfold import CreasePattern
from exactfold.branches import count_branches
from exactfold.pattern import families
from exactfold.rigidity import BranchSystem
from exactfold.rigidity.functionals import fold_functional
from proofs.framework import Proof, Script, run
from proofs.mountain_valley import half_bend, sector
from proofs.statements import Severity

NAME = "counting"
TITLE = "Degrees of freedom, folds, assignments and chambers"


def prove(change: str | None = None) -> Proof:
    """Prove every count that follows from Euler's formula and linear algebra."""
    script = Script(NAME, TITLE, ("a triangulated disk with Vi, Ve vertices",), change)
    _freedom(script)
    _folds(script)
    _chambers(script)
    return script.proof()


def _freedom(script: Script) -> None:
    Vi, Ve = sympy.symbols("V_i V_e")
    E, F = sympy.symbols("E F")
    disk = script.alter("Euler characteristic of a sphere", 1, 2)
    euler = sympy.solve([Vi + Ve - E + F - disk, 3 * F + Ve - 2 * E], [E, F])
    folds = euler[E] - Ve
    pins = script.alter("two pinned heights", 3, 2)
    D = Vi + Ve - pins - Vi
    script.identity("Euler: 3 Vi + Ve - 3 folds", folds - (3 * Vi + Ve - 3), of="IIC.11")
    script.identity(
        "Vi + Ve heights less 3 for planes and less Vi equations are as many as the 3 V - 6 "
        "coordinates of folded sheets modulo motions less E lengths",
        3 * (Vi + Ve) - script.alter("planar motions only", 6, 3) - euler[E] - D,
        of="IIC.1 IIC.2 IIC.11",
    )
    a, b = sympy.symbols("a b")
    script.identity(
        "a chord cuts a disk into disks with a + b = Ve + 2 boundary vertices; the pieces share "
        "one "
        "edge and turn about it: (a - 3) + (b - 3) + 1 = Ve - 3, the same D",
        D.subs(Ve, a)
        + D.subs(Ve, b)
        + script.alter("the chord does not turn", 1, 0)
        - D.subs(Ve, a + b - 2),
        of="IIC.3",
    )
    sheets = [families.single_vertex(n) for n in (3, 4, 5, 7)]
    sheets += [families.waterbomb(), families.two_vertex(), families.hypar(2)]
    systems = [BranchSystem(p) for p in sheets]
    scaled = script.alter("the scale of the heights fixed", 0, 1)
    script.cases(
        "the branch system has Vi quadrics in Vi + D heights",
        (
            len(s.quadrics) == s.pattern.Vi
            and len(s.variables) == s.pattern.Vi + s.pattern.D - scaled
            for s in systems
        ),
        of="IIC.1 IIC.2 IIIA.1",
    )
    state = script.state
    counts = [_freedoms(s) for s in systems]
    script.formula(
        "IIC.1",
        "Section II C, Eq. (Dcount)",
        r"D=V_e-3",
        at=counts,
        note="holds also with chords. With a convex boundary the dimension of the complex solution "
        "set is exactly Ve - 3: for fixed boundary heights there are finitely many solutions "
        "(definite stress, docs/mathematics.md, 6); transversality is not needed",
        code="CreasePattern.degrees_of_freedom",
        equation="9",
        words="docs/mathematics.md, 6 (dimension)",
    )
    script.formula(
        "IIC.2",
        "Section II C, after Eq. (Dcount)",
        r"\text{``}V_i+V_e-3=D+V_i\text{ nontrivial linear motions''}",
        at=counts,
        code="BranchSystem.variables",
        rests="IIC.1",
    )
    state(
        "IIC.11",
        "Section II C, after Eq. (Dcount)",
        r"\text{``recovers the count for the degrees of freedom for a generic (folded) "
        r"triangulated origami derived from a linear analysis''}",
        note="Remark: 3V - 6 - E = Ve - 3 with E = 3Vi + 2Ve - 3",
    )
    state(
        "IIC.3",
        "Section II C, before Eq. (Dcount) and Fig. (triangle)",
        r"\text{``all folds are incident to at least one internal vertex'' \dots\ ``Such "
        r"folds do not couple to any others''}",
        note="Remark: a convenience: Eq. (Dcount) does not need it",
        code="CreasePattern.chords",
    )
    state(
        "IIC.4",
        "Section II C",
        r"\text{``any vector }\lambda\mathbf{h}\text{ solves Eqs. (\ref{eq:compat}) if "
        r"}\mathbf{h}\text{ does, for any real number }\lambda\text{'' \dots\ ``solutions "
        r"of Eqs. (\ref{eq:compat}) in projective space }\mathbb{RP}^{V_i+D-1}\text{''}",
        code="Chart",
    )
    rho, sigma, t, lam = sympy.symbols("rho sigma t lambda")
    degree = script.alter("forms of degree three", 2, 3)
    script.identity(
        "K_v(lambda h) = lambda^2 K_v(h), sector by sector",
        sector(lam * rho, lam * sigma, t) - lam**degree * sector(rho, sigma, t),
        of="IIC.4",
    )
    lines = script.alter("points, not lines, of R^(Vi + D)", 1, 0)
    script.identity(
        "Vi equations for the lines in the Vi + Ve - 3 heights, the points of RP^(Vi + D - 1), "
        "leave D - 1 dimensions",
        (Vi + Ve - 3 - lines) - Vi - (D - 1),
        of="IIC.12",
    )
    script.identity(
        "an H1 move adds one vertex and three edges: 3 V - 6 - E does not change",
        3 * (Vi + Ve + 1)
        - (euler[E] + script.alter("four new edges", 3, 4))
        - 3 * (Vi + Ve)
        + euler[E],
        of="IV.18",
    )
    state(
        "IV.18",
        "Section IV, Henneberg moves",
        r"\text{``rigidity-preserving transformations of graphs'' \dots\ ``the addition of "
        r"a new vertex and attaching it to the original graph with three new edges''}",
        note="as a count of freedoms, in space; in the unfolded state see IV.4 and IV.7",
    )
    state(
        "IIC.12",
        "Section II C",
        r"\text{``each of these connected components is generically a "
        r"}(D-1)\text{-dimensional component of the intersection of a small sphere centered "
        r"at the unfolded state with the origami configuration space''}",
        note="with a convex boundary every component has that dimension over C",
        rests="IIC.1",
    )
    script.formula(
        "IIIA.1",
        "Section III A",
        r"\text{``resulting in }V_i+1\text{ quadratic polynomials that must be simultaneously "
        r"solved in terms of }V_i+1\text{ vertex heights''}",
        at=[
            {"V_i": s.pattern.Vi, "values": (len(s.quadrics) + 1, len(s.variables))}
            for s in systems
            if s.pattern.Ve == 4
        ],
        note="with sum h_j^2 = 1. Vi + D = Vi + 1 for D = 1",
    )
    n = script.alter("one quadric too many", 1, 2)
    script.example(
        "Bezout: 2^(Vi + 1) zeros, in pairs +-h: half of them, 2^Vi, the Bezout number of the "
        "chart",
        all(
            2 ** (p.Vi + n) // 2 == BranchSystem(p).chart.system.bezout_number
            for p in (families.two_vertex(), families.hypar(1), families.h1_sequence(5))
        ),
        of="IIIA.2",
    )
    script.formula(
        "IIIA.2",
        "Section III A, Bezout's theorem",
        r"\text{``this yields }2^{V_i+1}\text{ roots'' \dots\ ``the branches correspond to "
        r"}\pm\text{ pairs of solutions, we therefore have }B=2^{V_i}\text{''}",
        at=[
            {
                "V_i": p.Vi,
                "B": count_branches(p).real,
                "values": (2 * BranchSystem(p).chart.system.bezout_number,),
            }
            for p in (families.single_vertex(4), families.two_vertex(), families.hypar(1))
        ],
        note="finite and all real for convex boundaries: proved elsewhere; counted with "
        "multiplicity",
        code="QuadraticSystem.bezout_number",
        rests="T.1",
        cited="Bezout's theorem",
    )


def _folds(script: Script) -> None:
    n = sympy.Symbol("n", positive=True)
    square = families.hypar(2), families.two_vertex(), families.single_vertex(4)
    more = script.alter("3 (n + 1) folds", 1, 3)
    script.example(
        "a triangulated square without rigid parts has 3n + 1 folds, n = Vi - Vt (Euler, Ve = 4)",
        all(len(p.folds) == 3 * p.Vi + more for p in square),
        of="IIIA.3",
    )
    reduced, _ = families.flat_octahedron_in_square().without_rigid_parts()
    script.example(
        "the same for the square around a flat octahedron without it (n = 3)",
        len(reduced.folds) == 3 * script.alter("vertices of the octahedron counted", 3, 6) + 1,
        of="IIIA.3",
    )
    exponent = script.alter("printed exponent n - 1", n, n - 1)
    script.identity(
        "2^n branches out of 2^(3n + 1) / 2 assignments: the share (1/4)^n; even with the printed "
        "number of folds it would be (1/4)^(n + 1), not (1/4)^(n - 1)",
        sympy.powsimp(2**n / (2 ** (3 * n + 1) / 2) * 4**exponent, force=True) - 1,
        sympy.powsimp(2**n / (2 ** (3 * (n + 1)) / 2) * 4 ** (n + 1), force=True) - 1,
        of="IIIA.5",
    )
    script.formula(
        "IIIA.3",
        "Section III A, mountain and valley folds",
        r"N_F=3(V_i-V_t+1)",
        r"N_F=3(V_i-V_t)+1",
        at=_squares(),
        quoted=r"\text{``the number of folds (internal edges) for a triangulated square is }"
        r"3(V_i-V_t+1)\text{''}",
        note="one vertex has 4 folds, not 6; agrees with Appendix D, 3Vi + 1; folds inside "
        "triangulated triangles not counted",
        code="CreasePattern.folds",
        severity=Severity.CONSTANT,
    )
    script.formula(
        "IIIA.4",
        "Section III A, mountain and valley folds",
        r"\text{``the potential number of distinct mountain-valley (MV) assignments up to a global "
        r"sign change is }2^{3(V_i-V_t+1)}/2\text{''}",
        r"\text{the potential number of distinct mountain-valley (MV) assignments up to a global "
        r"sign change is }2^{3(V_i-V_t)+1}/2",
        at=[{**names, "values": (2 ** names["N_F"] // 2,)} for names in _squares()],
        note="follows from IIIA.3; one vertex of degree four: 8",
        severity=Severity.CONSTANT,
        rests="IIIA.3",
    )
    sheets = (families.single_vertex(4), families.two_vertex())
    shares = [_share(p) for p in (*sheets, families.flat_octahedron_in_square())]
    script.formula(
        "IIIA.5",
        "Section III A, mountain and valley folds",
        r"\text{``the fraction of these MV assignments that we should expect to find among the "
        r"branches is at most }(1/4)^{V_i-V_t-1}\text{''}",
        r"\text{the fraction of these MV assignments that we should expect to find among the "
        r"branches is at most }(1/4)^{V_i-V_t}",
        at=shares,
        note="2^n branches over the 2^(3n) assignments of IIIA.4, n = Vi - Vt, where all have "
        "different assignments, as in the two-vertex square: 4 of 64; the printed count of "
        "folds would give (1/4)^(n + 1). Remark: as a bound (1/4)^(n - 1) is true and an "
        "overestimate, but not because of the constraints: these do not lower the number of "
        "branches",
        code="BranchCount.repeated_assignments",
        severity=Severity.CONSTANT,
        rests="IIIA.4",
    )
    outcomes = [
        (next(iter(b.vertex_signs.values())), b.assignment_text.count("M"))
        for b in count_branches(families.single_vertex(4)).branches
    ]
    butterfly = CreasePattern([(0, 0), (1, 0), (0, 1), (1, -1)], [(0, 1, 2), (0, 3, 1)])
    lifted = fold_functional(butterfly, (0, 1))
    sign = script.alter("valleys bent downwards", 1, -1)
    script.example(
        "both wings raised is a valley, dihedral angle below pi on the upper side; a branch of a "
        "vertex of degree 4 has three folds of one sign and pops to their side",
        sign * lifted[2] > 0 < lifted[3] and all(o in ((1, 3), (-1, 1)) for o in outcomes),
        of="I.1",
    )
    script.state(
        "I.1",
        "Introduction",
        r"\text{``which folds have dihedral angle larger or smaller than }\pi\text{ "
        r"respectively''}",
        note="measured on the upper side of the sheet",
        code="fold_functional",
    )


def _chambers(script: Script) -> None:
    r, s, t = sympy.symbols("rho sigma t")
    script.identity(
        "K_v(round cone, h) = -(1/2) sum b_j = (1/2) sum_j w_j (h_v - h_j) with w_j = (tan(a_j/2) "
        "+ "
        "tan(a_(j-1)/2)) / L_j > 0: a weighted Laplacian. By the maximum principle these "
        "functionals "
        "are independent on the interior heights",
        half_bend(r, s, t) + half_bend(s, r, t) - script.alter("wrong weight", 1, -1) * t * (r + s),
        of="IIIB.3",
    )
    per = script.alter("one ray a chamber", 2, 1)
    squares = [families.single_vertex(4), families.two_vertex(), families.hypar(1)]
    squares.append(families.flat_octahedron_in_square())
    counts = [count_branches(p) for p in squares]
    script.cases(
        "two branches for each pair of opposite sign vectors, so two rays in each chamber, on "
        "squares with 1, 2 and more vertices",
        (
            list(c.sign_vectors.values()) == [per] * 2 ** (p.Vi - p.Vt - 1)
            for p, c in zip(squares, counts, strict=True)
        ),
        of="IIIB.1 IIIB.3",
    )
    chambers = [
        {"V_i": p.Vi, "V_t": p.Vt, "signs": len(c.sign_vectors), "rays": 2 * (c.distinct or 0)}
        for p, c in zip(squares, counts, strict=True)
    ]
    script.state(
        "IIIA.7",
        "Section III A, after Eq. (B distinct)",
        r"\text{``the branches must lie in a lower-dimensional "
        r"}\mathbb{R}^{V_i-V_t+1}\text{''}",
        note="Remark: each of the Vt inner heights is the value of the plane through the "
        "triangle's corners",
        code="CreasePattern.without_rigid_parts",
        rests="IIC.7",
    )
    script.formula(
        "IIIB.1",
        "Section III B",
        r"\text{``there are therefore }2^{V_i-V_t}\text{ choices of vertex sign patterns'' \dots\ "
        r"``we are left with only }2^{V_i-V_t-1}\text{ equivalence classes''}",
        at=[{**names, "values": (2 * names["signs"], names["signs"])} for names in chambers],
        note="Remark: a vertex of degree 4 has one class and two branches. Here counted as those "
        "of branches: every sign vector occurs",
        code="BranchCount.sign_vectors",
    )
    script.formula(
        "IIIB.3",
        "Section III B, chambers; Fig. (chambers)",
        r"\text{``the }2^{V_i-V_t+1}\text{ distinct rays of the branches always seem to be "
        r"distributed so that two rays lie in each of these chambers''}",
        at=[{**names, "values": (names["rays"],)} for names in chambers],
    )


def _freedoms(system: BranchSystem) -> dict[str, Any]:
    """The numbers of a sheet; D = 3 V - 6 - E counts the freedoms of a folded sheet."""
    p = system.pattern
    D = 3 * len(p.vertices) - 6 - len(p.edges)
    return {"V_i": p.Vi, "V_e": p.Ve, "D": D}


def _share(pattern: CreasePattern) -> dict[str, Any]:
    """The share of assignments that belong to branches, among all assignments up to reflection."""
    count = count_branches(pattern)
    found = (count.distinct or 0) - (count.repeated_assignments or 0)
    share = Fraction(found, 2 ** len(pattern.without_rigid_parts()[0].folds) // 2)
    return {"V_i": pattern.Vi, "V_t": pattern.Vt, "values": (share,)}


def _squares() -> list[dict[str, Any]]:
    """For some squares, the numbers of folds outside triangulated triangles, and of vertices."""
    sheets = [families.single_vertex(4), families.two_vertex(), families.hypar(2)]
    sheets += [families.flat_octahedron_in_square()]
    return [
        {"N_F": len(p.without_rigid_parts()[0].folds), "V_i": p.Vi, "V_t": p.Vt} for p in sheets
    ]


if __name__ == "__main__":
    sys.exit(run(prove()))
