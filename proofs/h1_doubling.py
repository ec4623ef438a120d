"""The H1 move doubles the branches, and when it does not (Section IV).

Notation of `butterfly`: T has four boundary vertices v1, v2, v3, v4 in order, w is attached to v1,
v2, v3, and A is the angle of T at v2. By the theorem there, each branch of T gives two branches of
T', simple if it is simple, where A > pi, and where A < pi unless the branch is flat at v2; so all
depends on the following, which the paper does not ask.

Lemma. Let T have no chords and A < pi. A branch that is flat at v2 is the sheet folded along the
straight line v1 v3, so that folds are collinear at an interior vertex.

Proof. Let h be 0 on the faces at v2, and F the set of all faces that can be reached from these over
edges without leaving h = 0. Call the other pieces of the sheet (connected over edges) gaps.
(1) h is 0 on every edge between F and a gap. If a gap has an angle below pi at an interior vertex u
where no other gap ends, then 0 = K_u(h) is the integral over that sector, negative unless h = 0 on
it (Wirtinger, docs/theorem.md, 2), when it would belong to F. So there is no such corner.
(2) Since F is connected over edges, a closed curve through gaps and the outside of the sheet that
meets F in vertices only has all of F on one side. So a gap is a simple polygon without holes, and
two gaps, or a gap and the outside, meet in one vertex or along one arc at most, and these contacts
form a forest. A polygon has three corners with angles below pi. A gap that meets others in one
vertex only would have two such corners against (1); so all gaps meet the outside along an arc.
(3) Let h(v4) not be 0. The faces at v4 lie in one gap G, the edges v1 v2, v2 v3 in F; so G is the
only gap, and F is a polygon whose angles at interior vertices are at most pi, by (1). If the sheet
is not reflex at v1 or v3, F is convex; if it is reflex at v1, all of F is seen from v1. In any case
F holds the segment v1 v3 (a contradiction if v4 is reflex) and the triangle v1 v2 v3. Cut the sheet
along it: the triangle v1 v3 v4 is rigid (docs/theorem.md, 4), h is affine on it, and the sheet is
folded along v1 v3, which must consist of edges and, without chords, pass through interior vertices.
(4) Let h(v4) = 0. Then h is 0 on the boundary, hence 0 if the sheet is convex. Else a gap has
corners below pi at v1, v3 and v4 only, by (1), hence at all three: it holds both edges at v4, v4 is
not reflex, and (3) shows that F holds the triangle v1 v2 v3. The triangle v1 v3 v4 has h = 0 on its
boundary and is flat: there is no gap. QED
"""

from __future__ import annotations

import sys
from fractions import Fraction
from pathlib import Path

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import sympy

from exactfold import CreasePattern, random_square
from exactfold.branches import count_branches
from exactfold.branches.values.result import BranchCount
from exactfold.pattern import families
from proofs.butterfly import DART, FAN, KITE, quadratic
from proofs.framework import Proof, Script, run
from proofs.mountain_valley import sector
from proofs.statements import Severity

NAME = "h1_doubling"
TITLE = "The H1 move doubles the branches"

Point = tuple[Fraction | int, Fraction | int]

_CORNERS: list[Point] = [(-1, 0), (0, 1), (1, 0), (0, -1), (Fraction(1, 4), 0)]
FOLDED = CreasePattern(_CORNERS, [(0, 4, 1), (1, 4, 2), (2, 4, 3), (3, 4, 0)])
"""A hub 4 on the diagonal v1 v3 = 0 2: one of its two branches is folded along this line."""
BEYOND = CreasePattern([*_CORNERS, (0, 3)], [*FOLDED.triangles, (0, 1, 5), (1, 2, 5)])
"""The same with w = 5 attached at v1, v2, v3 = 0, 1, 2."""


def prove(change: str | None = None) -> Proof:
    """Doubling under the hypotheses of Section IV, and what happens without them."""
    script = Script(
        NAME,
        TITLE,
        (
            "four boundary vertices, no interior vertices of degree 3",
            "where doubling is claimed: no two folds at a vertex are collinear",
        ),
        change,
    )
    _sector(script)
    _flat_corners(script)
    _straight(script)
    _doubling(script)
    return script.proof()


def _sector(script: Script) -> None:
    """Step (1): a sector with angle below pi whose two sides have slope 0."""
    r, t, u = sympy.symbols("rho t u")
    whole = (t + u) / (1 - t * u)
    first, second = (1 - t**2) / (2 * t), (1 - u**2) / (2 * u)
    sine = 2 * whole / (1 + whole**2) * (1 + t**2) * (1 + u**2) / (4 * t * u)
    sign = script.alter("curvature of a bent sector positive", -1, 1)
    script.identity(
        "a spoke of slope rho in a sector with sides of slope 0 gives -(1/2) (cot a + cot b) "
        "rho^2 and cot a + cot b = sin(a + b) / (sin a sin b) > 0 for a + b < pi; more spokes: "
        "docs/theorem.md, 2",
        sector(0, r, t) + sector(r, 0, u) - sign * (first + second) * r**2 / 2,
        first + second - sine,
        of="IV.7",
    )


def _is_flat(count: BranchCount, corner: int) -> list[bool]:
    """For each branch whether all folds at a boundary vertex are proved flat."""
    return [
        all(letter == "F" for fold, letter in b.assignment.items() if corner in fold)
        for b in count.branches
    ]


def _flat_corners(script: Script) -> None:
    """The lemma on patterns without collinear folds, and where folds are collinear."""
    patterns = [DART, KITE, families.hypar(1)]
    patterns += [random_square(n, seed) for n in (2, 3, 4) for seed in (0, 1)]
    patterns += [families.h1_sequence(3, seed) for seed in (0, 1)]
    wanted = script.alter("flat corners everywhere", False, True)
    script.cases(
        "patterns without collinear folds: no branch is flat at a corner",
        (
            not families.collinear_folds(p)
            and all(flat is wanted for v in p.boundary for flat in _is_flat(count, v))
            for p in patterns
            for count in (count_branches(p),)
        ),
        of="IV.7",
    )
    seed, both = (count_branches(p, method="groebner") for p in (FOLDED, BEYOND))
    doubled = script.alter("doubling in spite of a flat corner", 3, 4)
    script.counterexample(
        "folds collinear along v1 v3: one of 2 branches is flat at v2, and T' has 3 branches, of "
        "multiplicities 1, 1 and 2",
        sorted(_is_flat(seed, 1)) == [False, True]
        and both.distinct == doubled
        and sorted(b.multiplicity or 0 for b in both.branches) == [1, 1, 2],
        of="IV.7 IV.6",
    )


def _straight(script: Script) -> None:
    """A = pi: one value a branch, and one new branch."""
    r, s, m, t = sympy.symbols("rho_3 rho_1 rho_w t")
    sine = 2 * t / (1 + t**2)
    both = sector(r, m, t) + sector(m, s, 1 / t)
    script.identity(
        "beta_1 + beta_2 = pi: K_{v2} is linear in rho_w with coefficient (rho_1 + rho_3)/sin "
        "beta_1",
        sympy.diff(both, m) - (r + script.alter("wrong sign of rho_1", 1, -1) * s) / sine,
        of="IV.7",
    )
    count = count_branches(families.flat_vertex_square(), method="groebner")
    lost = script.alter("doubling through a straight corner", 3, 4)
    script.counterexample(
        "the square with a straight crease path: T (one vertex) has 2 branches, T' has 2 + 1 = 3, "
        "of multiplicities 1, 1 and 2",
        count.distinct == lost and sorted(b.multiplicity or 0 for b in count.branches) == [1, 1, 2],
        of="IV.6",
    )
    script.state(
        "IV.6",
        "Section IV, assumption of no crosses",
        r"\text{``these nongeneric collinearities can rigidify folds in a flat state''}",
        note="Remark: on one of the three branches of the flat-vertex square a whole vertex star "
        "stays flat",
        code="families.collinear_folds",
    )


def attached(pattern: CreasePattern) -> CreasePattern:
    """A convex quadrilateral with w attached at its corners 0, 1, 2, convex again."""
    (x, y), (far_x, far_y) = pattern.vertices[1], pattern.vertices[3]
    w, new = (x + (x - far_x) / 3, y + (y - far_y) / 4), len(pattern.vertices)
    return CreasePattern([*pattern.vertices, w], [*pattern.triangles, (1, 0, new), (2, 1, new)])


def _doubling(script: Script) -> None:
    counts = [count_branches(families.h1_sequence(k, seed)) for k in (1, 2, 3) for seed in (0, 1)]
    factor = script.alter("tripling", 2, 3)
    script.cases(
        "random H1 sequences without collinear folds double at each of three moves",
        (c.distinct == c.real == factor**c.pattern.Vi for c in counts),
        of="IV.7 IV.14",
    )
    seeds = [families.hypar(1), random_square(3, 1), random_square(4, 2)]
    script.cases(
        "other seeds with four boundary vertices, no collinear folds: a move doubles the branches",
        (
            not families.collinear_folds(larger)
            and after.distinct == after.real == factor * len(count_branches(seed).branches)
            for seed in seeds
            for larger in (attached(seed),)
            for after in (count_branches(larger),)
        ),
        of="IV.20",
    )
    c, b, a = quadratic(FAN, 5, 4, dict(zip(range(4), (0, 1, -1, 0), strict=True)))
    flat = quadratic(FAN, 5, 4, dict.fromkeys(range(4), 0))
    c, b, a = script.alter("the seed unfolded", (c, b, a), flat)
    script.counterexample(
        "a seed with five boundary vertices, folded at its reflex corner: no height of w (IV.4)",
        b * b - 4 * a * c < 0,
        against="IV.20",
    )
    script.state(
        "IV.20",
        "Section IV, last paragraph",
        r"\text{``one can generalize the arguments in this section to H1-like triangulations where "
        r"the seed is \dots\ e.g. a single-vertex origami''}",
        r"\text{for seeds with four boundary vertices: each move doubles the branches. With five "
        r"or more there are two attachments if the angle of }T\text{ at }v_2\text{ is less than }"
        r"\pi\text{, which may belong to one branch, and there may be none if it is larger}",
        "four boundary vertices: the arguments of the section (IV.7) do not use the seed. Five or "
        "more: IV.4; the two attachments meet where T is flat at v2",
        "count_branches",
        severity=Severity.CONDITION,
        rests="IV.7",
    )
    script.state(
        "IV.14",
        "Section IV, last argument",
        r"\text{``a neighborhood of the unfolded state of the configuration space of the "
        r"two butterflies together consists of two intersecting lines, topologically a "
        r"letter X''}",
        note="Remark: v2 has degree 3 in the seed, so the doubling needs only that its fold is "
        "bent",
        code="families.single_vertex",
    )
    script.state(
        "IV.7",
        "Section IV, last argument; Introduction",
        r"\text{``for each H1 move, the number of 1D branches doubles \dots\ }2^{V_i}\text{ "
        r"branches''}",
        note="under the hypotheses of the section; all branches are then simple, hence true ones "
        "(IIA.11). The argument needs more than the paper says: where the angle of T at v2 is "
        "below pi, no branch of T may be flat at v2, which follows from the absence of collinear "
        "folds (a lemma proved in words in proofs/h1_doubling.py, tested on 11 cases); where it "
        "is above pi, see IV.4. With collinear folds the number need not double: if v1, v2, v3 "
        "are collinear, B branches become B + 1; hub (1/4,0) in the square (-1,0), (0,1), (1,0), "
        "(0,-1) with w = (0,3): 2 become 3",
        code="count_branches",
        rests="IV.4",
        words="lemma in proofs/h1_doubling.py",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
