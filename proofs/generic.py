"""The theorems of docs/generic.md: projective invariance, and almost every sheet.

The proof of Theorem 11 for a rim with an angle of pi, in the notation of its section 3:

Let b = 4, and let x lie on the side pq of the triangle pqs. Theorem 2 covers this
rim. Two things change.

Realizations of T'. They exist unless p and q are joined by an edge (Floater; the face or the
vertices between pq and x would have no room). T, which has a realization, has no such edge. A
contraction into x or s makes none. A contraction of u into p makes one if u is joined to q as well.
(Here p and q are the corners, not the neighbours a_0 and a_k of step 4.) Consider the 4-cycle u p x
q. The other paths do not meet u, p and q except for the one to q; so the path to x is inside the
4-cycle, or is x itself, and the path to s is outside. No face has a vertex inside and one outside,
and all faces at x are inside. So the first vertices of these two paths are y and z, and e has a
face inside and one outside: it is up or uq. As p is not the first vertex of its path, e = uq, and
the path to p is u, p. If the path to x or to s has more than one vertex, contract its last edge
instead. Otherwise the faces of e are uqx and uqs; as upx and ups are 3-cycles, hence faces, u is
the only interior vertex. There E holds: heights with uq flat have folds up, ux and us only and
form, modulo planes, a line, on which K_u vanishes only at 0 unless two of the three folds are
collinear. For almost all positions they are not, and a flat star is against the rim. The same holds
with p and q exchanged.

The limit. If x has a neighbour in T other than u, p and q, then alpha < pi as before. Otherwise p
and q are the neighbours of x on the rim and alpha = pi. Let xi be perpendicular to pq, let lambda
be the height of the line pq at x, lambda != h_x, and kappa = 1/|xp| + 1/|xq|. The thin faces
contribute to K_u [machine: the limit of eps times this]

    -(kappa / eps) (h_u - h_x) (lambda - (h_u + h_x) / 2) + O(max |h|^2).

So |h_u - h_x| |2 lambda - h_x - h_u| <= C eps max |h|^2. The vertices of the thin faces other than
u lie on the rim, so the other equations do not contain these faces. Divided by their maxima,
unbounded solutions would have a rim and an h_u that tend to 0, and a limit would contradict the key
lemma. So the solutions are bounded, and the limit of a sequence of them is a solution of T' at U',
with the rim r or with the rim in which h_x is replaced by its mirror image 2 lambda - h_x, which
changes the sign of the saddle. Up to planes that rim is -r, and minus the solution has the rim r
and the same flat folds. So both cases contradict P_e'(U') != 0.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Iterable, Iterator, Sequence
from fractions import Fraction
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

import networkx as nx
import sympy
from sympy import QQ
from sympy.polys.fields import field

from exactfold import CreasePattern, random_square
from exactfold._support.verdict import PROVED
from exactfold.branches import count_branches
from exactfold.pattern.crease_pattern import Triangle
from exactfold.pattern.families import flat_octahedron_in_square, flat_vertex_square
from proofs.framework import Proof, Script, run

NAME = "generic"
TITLE = "Almost every sheet: projective invariance and distinct branches"


def prove(change: str | None = None) -> Proof:
    """The identities behind docs/generic.md, and each step of its proof on examples."""
    script = Script(
        NAME,
        TITLE,
        (
            "a triangulated quadrilateral, given up to the positions of its interior vertices; its "
            "corners are fixed, and may have a reflex angle or an angle of pi",
        ),
        change,
    )
    script.state(
        "T.10",
        "docs/generic.md, Theorem 10",
        r"\omega'_{vw}=\mu_v\mu_w\,\omega_{vw}/\det L,\quad K'_v=\mu_vK_v/\det L",
        note="projective maps carry curvature forms and branches over",
        code="project",
        words="docs/generic.md, Theorem 10",
    )
    script.state(
        "T.11",
        "docs/generic.md, Theorem 11",
        r"B_{distinct}=2^{V_i-V_t}\text{ unless the interior vertices lie in the zeros of a "
        r"nonzero polynomial; then all folds outside triangulated triangles are bent on "
        r"all branches}",
        note="the paper found the number by computing (Section III A); for exceptions see IIIA.12",
        code="BranchCount.exceptional_vertices",
        words="docs/generic.md, Theorem 11",
    )
    _projective(script)
    _thin_faces(script)
    _straight_corner(script)
    _paths_and_contractions(script)
    _sheets(script)
    return script.proof()


def _projective(script: Script) -> None:
    power = script.alter("the factor of one end only", 1, 0)
    rng = random.Random(1)
    script.cases(
        "the stress of a fold obeys omega'_ac = omega_ac mu_a mu_c / det L",
        (_stress_is_carried_over(rng, power) for _ in range(20)),
        of="T.10",
    )
    script.identity(
        "across the fold ac the gradient jumps by omega_ac = [acyz]/([acy][caz]) times c - a, "
        "turned by a right angle",
        *_jump_of_the_gradient(script.alter("turned the other way", 1, -1)),
        of="T.10",
    )
    w, mu, nu, h, k = sympy.symbols("omega mu nu h k")
    script.identity(
        "mu nu omega (k/nu - h/mu) = mu omega (k - h) - h omega (nu - mu): over the star the first "
        "part is left, as the stress is in equilibrium in the plane",
        mu * nu * w * (k / nu - h / mu)
        - mu * w * (k - h)
        + script.alter("sign of the moment", 1, -1) * h * w * (nu - mu),
        of="T.10",
    )


def _jump_of_the_gradient(turn: int) -> list[Any]:
    """The identity of the jump of the gradient, in two coordinates.

    A translation and a plane reduce it to a point a = 0 with height 0.
    """
    _, *z = field("c1 c2 c3 y1 y2 y3 z1 z2 z3", QQ)
    c, y, z3 = z[:3], z[3:6], z[6:]

    def cross(p: list[Any], q: list[Any]) -> Any:
        return p[0] * q[1] - p[1] * q[0]

    def gradient(p: list[Any], q: list[Any]) -> list[Any]:
        return [
            (p[2] * q[1] - q[2] * p[1]) / cross(p, q),
            (p[0] * q[2] - q[0] * p[2]) / cross(p, q),
        ]

    volume = c[2] * cross(y, z3) + y[2] * cross(z3, c) + z3[2] * cross(c, y)
    stress = volume / (cross(c, y) * cross(z3, c))
    jump = [p - q for p, q in zip(gradient(c, y), gradient(z3, c), strict=True)]
    return [jump[0] + turn * stress * c[1], jump[1] - turn * stress * c[0]]


def _stress_is_carried_over(rng: random.Random, power: int) -> bool:
    """Test the stress of four random points with heights (a first, c second) under a random map."""
    points = [[1, *(Fraction(rng.randint(-99, 99), 7) for _ in range(3))] for _ in range(4)]
    matrix = sympy.Matrix(3, 3, [rng.randint(-99, 99) for _ in range(9)])
    factors, images = [], []
    for one, x, y, height in points:
        mu, *image = sympy.Matrix([[one, x, y]]) * matrix
        factors.append(mu)
        images.append([1, *(entry / mu for entry in image), height / mu])

    def stress(of: list[list[Any]]) -> Any:
        """The jump of the gradient over the length, up to one sign that no point changes."""
        a, c, y, z = (row[:3] for row in of)
        return sympy.Matrix(of).det() / (
            sympy.Matrix([a, c, y]).det() * sympy.Matrix([c, a, z]).det()
        )

    expected = stress(points) * factors[0] * factors[1] ** power / matrix.det()
    return bool(stress(images) == expected)


def _corner(d: tuple[Any, Any], e: tuple[Any, Any], rise: Any, other: Any) -> Any:
    """The term of a face with spokes d, e (counter-clockwise) in K, by heights at their ends."""
    c, s = d[0] * e[1] - d[1] * e[0], d[0] * e[0] + d[1] * e[1]
    dd, ee = d[0] ** 2 + d[1] ** 2, e[0] ** 2 + e[1] ** 2
    return rise * other / c - s / (2 * c) * (rise**2 / dd + other**2 / ee)


def _thin_faces(script: Script) -> None:
    a, b, s, r = sympy.symbols("theta_p theta_q sigma r")
    m = sympy.Symbol("m", positive=True)
    sign = script.alter("sign of the mixed term", 1, -1)
    # the face u, x, p at u: spokes of lengths eps and m, at the angle pi - theta
    spokes = (sympy.Integer(1), sympy.Integer(0)), (-m * sympy.cos(a), m * sympy.sin(a))
    script.identity(
        "a thin face adds (sigma^2 + r^2) cot(theta)/2 - sigma r / sin(theta)",
        sympy.simplify(
            _corner(*spokes, -s, r * m)
            - (s**2 + r**2) * sympy.cot(a) / 2
            + sign * s * r / sympy.sin(a)
        ),
        of="T.11",
    )
    total = script.alter("difference of the angles", a + b, a - b)
    script.identity(
        "cot(theta_p) + cot(theta_q) = sin(theta_p + theta_q) / (sin(theta_p) sin(theta_q))",
        sympy.simplify(
            (sympy.cot(a) + sympy.cot(b)) * sympy.sin(a) * sympy.sin(b) - sympy.sin(total)
        ),
        of="T.11",
    )


def _straight_corner(script: Script) -> None:
    """The limit case: x lies on the side pq, and u is its only other neighbour."""
    P, Q, m, eps = sympy.symbols("P Q m epsilon", positive=True)
    hx, hu, hp, hq = sympy.symbols("h_x h_u h_p h_q")
    u = (m * eps, eps)

    def spoke(x: Any) -> tuple[Any, Any]:
        return x - u[0], -u[1]

    thin = _corner(spoke(-Q), spoke(0), hq - hu, hx - hu) + _corner(
        spoke(0), spoke(P), hx - hu, hp - hu
    )
    line = (hp / P + hq / Q) / (1 / P + 1 / Q)
    half = script.alter("the height of u alone", sympy.Rational(1, 2), 1)
    mean = half * hu + (1 - half) * hx
    limit = sympy.cancel(sympy.together(eps * thin)).subs(eps, 0)
    script.identity(
        "at a corner x on a side pq, whose height at x is L: eps K_thin tends to "
        "-(1/|xp| + 1/|xq|)(h_u - h_x)(L - (h_u + h_x)/2); so h_u tends to h_x or to 2 L - h_x",
        limit + (1 / P + 1 / Q) * (hu - hx) * (line - mean),
        of="T.11",
    )


def disjoint_paths(
    triangles: Iterable[Triangle], rim: Iterable[int], corners: Iterable[int]
) -> list[list[int]]:
    """A largest set of disjoint paths from the corners to the rim, none of them through the rim."""
    graph, rim = nx.Graph(), set(rim)
    for a, b, c in triangles:
        graph.add_edges_from([(a, b), (b, c), (c, a)])
    graph.add_edges_from(("from", v) for v in corners)
    graph.add_edges_from((v, "to") for v in rim)
    found = nx.node_disjoint_paths(graph, "from", "to")
    return [path[1 : 2 + min(k for k, v in enumerate(path[1:]) if v in rim)] for path in found]


def outside_triangles(pattern: CreasePattern, corners: set[int]) -> bool:
    """Whether no triangle of edges has all of these vertices on it or inside."""
    return not any(corners <= {*cycle, *inside} for cycle, inside in pattern.triangulated_triangles)


def contracted(triangles: Iterable[Triangle], u: int, x: int) -> list[Triangle]:
    """The triangles after u is moved into its neighbour x; triangles with both vanish."""
    return [
        (x if a == u else a, x if b == u else b, x if c == u else c)
        for a, b, c in triangles
        if not {u, x} <= {a, b, c}
    ]


def is_simple_disk(triangles: Sequence[Triangle]) -> bool:
    """Whether triangles that fit together form a disk without double edges."""
    halves = [half for a, b, c in triangles for half in ((a, b), (b, c), (c, a))]
    edges = {frozenset(half) for half in halves}
    vertices = {v for face in triangles for v in face}
    euler = len(vertices) - len(edges) + len(triangles)
    return len(set(halves)) == len(halves) and euler == 1


def _contractions(pattern: CreasePattern, ends: int) -> Iterator[bool]:
    """Step 4 of the proof, for all folds: whether the sheet that is left is as the step says."""
    for fold in pattern.folds:
        corners = {*fold, *pattern.opposite(fold)}
        for path in disjoint_paths(pattern.triangles, pattern.boundary, corners):
            if len(path) > 1:
                u, x = path[-ends:-1][0], path[-1]
                left = contracted(pattern.triangles, u, x)
                a, c, y, z = (x if v == u else v for v in (*fold, *pattern.opposite(fold)))
                faces = {frozenset(t) for t in left}
                yield (
                    is_simple_disk(left)
                    and {frozenset((a, c, y)), frozenset((a, c, z))} <= faces
                    and len(disjoint_paths(left, pattern.boundary, {a, c, y, z})) == 4
                )


def _paths_and_contractions(script: Script) -> None:
    sheets = [random_square(n, seed=seed) for n in (3, 5, 7) for seed in range(4)]
    sheets += [flat_octahedron_in_square(), flat_vertex_square()]
    needed = script.alter("three paths suffice", 4, 3)

    def paths(sheet: CreasePattern, corners: set[int]) -> int:
        return len(disjoint_paths(sheet.triangles, sheet.boundary, corners))

    script.cases(
        "four disjoint paths lead from the corners of the faces of a fold to the boundary if and "
        "only if the fold is inside no triangle of edges",
        (
            (paths(sheet, corners) >= needed) is outside_triangles(sheet, corners)
            for sheet in sheets
            for fold in sheet.folds
            for corners in [{*fold, *sheet.opposite(fold)}]
        ),
        of="T.11",
    )
    ends = script.alter("contraction of the first edge of a path", 2, 99)
    script.cases(
        "with no vertices inside triangles of edges, the last edge of a path can be contracted: "
        "a simple disk is left, with both faces of the fold and four disjoint paths",
        (
            holds
            for sheet in sheets
            for holds in _contractions(sheet.without_rigid_parts()[0], ends)
        ),
        of="T.11",
    )


def _sheets(script: Script) -> None:
    lost = script.alter("vertices inside triangles count", 0, 1)
    straight = CreasePattern(
        [(-4, 0), (0, 0), (4, 0), (1, 6), (1, 2), ("1/2", 4)],
        [(0, 1, 4), (1, 2, 4), (2, 3, 5), (2, 5, 4), (0, 4, 5), (0, 5, 3)],
    )
    sheets = [random_square(4, seed=seed) for seed in range(6)] + [
        flat_octahedron_in_square(),
        straight,
    ]
    results = [count_branches(sheet) for sheet in sheets]
    script.cases(
        "random squares, a flat octahedron and a sheet with a corner on a side have 2^(Vi - Vt) "
        "branches",
        (
            r.status is PROVED and r.distinct == 1 << (r.pattern.Vi - (1 - lost) * r.pattern.Vt)
            for r in results
        ),
        of="T.11",
    )
    exception = count_branches(flat_vertex_square())
    script.counterexample(
        "flat-vertex has 3 branches and no triangulated triangle: the polynomial has zeros",
        exception.distinct == script.alter("four branches", 3, 4) and exception.pattern.Vt == 0,
        of="T.11",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
