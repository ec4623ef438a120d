"""Wheel stresses are a basis of the self stresses, for every triangulated disk (Section II)."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.fields import field
from sympy.polys.rings import ring

from exactfold import CreasePattern
from exactfold.exact.linalg import rank
from exactfold.pattern import families
from exactfold.rigidity import rigidity_matrix, self_stresses, wheel_stress
from proofs.framework import Proof, Script, run

NAME = "wheel_stress"
TITLE = "Wheel stresses are a basis of the self stresses"

TRIANGLE = CreasePattern([(0, 0), (1, 0), (0, 1)], [(0, 1, 2)])


@dataclass(frozen=True)
class Angle:
    """An angle, given by its cosine and sine in any field, so that sums of angles stay rational."""

    cos: Any
    sin: Any

    @classmethod
    def twice_arctan(cls, p: Any) -> Angle:
        """The angle 2 arctan p. Every angle except pi is one; p > 0 gives the angles in (0, pi)."""
        return cls((1 - p * p) / (1 + p * p), 2 * p / (1 + p * p))

    def __add__(self, other: Angle) -> Angle:
        return Angle(
            self.cos * other.cos - self.sin * other.sin, self.sin * other.cos + self.cos * other.sin
        )

    def __neg__(self) -> Angle:
        return Angle(self.cos, -self.sin)

    def __sub__(self, other: Angle) -> Angle:
        return self + -other

    @property
    def csc(self) -> Any:
        """Cosecant."""
        return 1 / self.sin

    @property
    def cot(self) -> Any:
        """Cotangent."""
        return self.cos / self.sin


def with_vertices(pattern: CreasePattern, vertices: list[tuple[Any, Any]]) -> CreasePattern:
    """The triangulation of `pattern` with other coordinates, elements of any field of functions.

    exactfold's formulas then run over that field, so that an identity between their results holds
    for every geometry with this triangulation.
    """
    free = object.__new__(CreasePattern)
    object.__setattr__(free, "vertices", tuple(vertices))
    object.__setattr__(free, "triangles", pattern.triangles)
    return free


def free_wheel(n: int) -> CreasePattern:
    """The wheel with n free spokes: hub n at the origin, spoke ends 0 .. n - 1."""
    K, *g = field([f"{axis}{j}" for j in range(n) for axis in "xy"], QQ)
    ends = [(g[2 * j], g[2 * j + 1]) for j in range(n)]
    return with_vertices(families.single_vertex(n), [*ends, (K(0), K(0))])


def cross(a: Any, b: Any) -> Any:
    """Cross product of plane vectors."""
    return a[0] * b[1] - a[1] * b[0]


def dot(a: Any, b: Any) -> Any:
    """Scalar product of plane vectors."""
    return a[0] * b[0] + a[1] * b[1]


def prove(change: str | None = None) -> Proof:
    """Prove the rank 2V - 3 by gluing triangles, the wheel stress, and Vi independent stresses."""
    hypotheses = (
        "a triangulated disk in the plane: V = Vi + Ve vertices, E edges, F triangles of non-zero "
        "area, any two of them joined by a chain of triangles that share edges",
        "convexity and genericity are not assumed",
    )
    script = Script(NAME, TITLE, hypotheses, change)
    _compatibility(script)
    _rank(script)
    _counts(script)
    _force_balance(script)
    _independence(script)
    _basis(script)
    return script.proof()


def _compatibility(script: Script) -> None:
    """The rows of C times lengths are those of `rigidity_matrix`; rigid motions are in ker C."""
    K, ax, ay, bx, by, cx, cy, tx, ty, w = field("ax ay bx by cx cy tx ty w", QQ)
    triangle = with_vertices(TRIANGLE, [(ax, ay), (bx, by), (cx, cy)])
    rows, points = rigidity_matrix(triangle), triangle.vertices
    turn = script.alter("a reflection in place of a rotation", -1, 1)
    motion = [z for x, y in points for z in (tx + turn * w * y, ty + w * x)]
    ends = script.alter("displacements added", 1, -1)
    products, lengths = [], []
    for row, (i, j) in zip(rows, triangle.edges, strict=True):
        move = sum((m * u for m, u in zip(row, motion, strict=True)), K(0))
        along = [points[i][k] - points[j][k] for k in (0, 1)]
        products.append(move)
        lengths.append(
            move - sum(along[k] * (motion[2 * i + k] - ends * motion[2 * j + k]) for k in (0, 1))
        )
    script.identity("row (i, j) applied to u is (U_i - U_j) . (u_i - u_j)", *lengths, of="IIA.14")
    script.identity(
        "translations and rotations are in the kernel of every row", *products, of="IIA.14"
    )
    script.state(
        "IIA.14",
        "Section II A, Eq. (isometry)",
        r"\left[\mathbf{C}\left(\begin{array}{c}\mathbf{u}_1\\ "
        r"\vdots\end{array}\right)\right]_{(n,m)}=\frac{\mathbf{U}_n-\mathbf{U}_m}{\left|\mathbf{U}_n-\mathbf{U}_m\right|}\cdot\left(\mathbf{u}_n-\mathbf{u}_m\right)",
        note="Remark: row (n, m) of the rigidity matrix is this row times |U_n - U_m|, so its left "
        "kernel consists of the stress densities sigma/|U_n - U_m|",
        code="rigidity_matrix",
        equation="3",
    )
    columns = ([2, 4, 5], [3, 4, 5])
    minors = [cross_minor([[row[c] for c in chosen] for row in rows]) for chosen in columns]
    area = cross((bx - ax, by - ay), (cx - ax, cy - ay))
    double = script.alter("the area for twice the area", 1, 2)
    script.identity(
        "triangle ABC: two 3 x 3 minors with squares adding up to |AB|^2 (2 area)^2 > 0: rank 3, "
        "and in-plane motions of one triangle are its rigid motions",
        minors[0] ** 2 + minors[1] ** 2 - ((bx - ax) ** 2 + (by - ay) ** 2) * (area / double) ** 2,
        of="IIB.3 IIB.7",
    )


def cross_minor(m: list[list[Any]]) -> Any:
    """Determinant of a 3 x 3 matrix over any ring."""
    return (
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] * m[2][1])
        - m[0][1] * (m[1][0] * m[2][2] - m[1][2] * m[2][0])
        + m[0][2] * (m[1][0] * m[2][1] - m[1][1] * m[2][0])
    )


def _rank(script: Script) -> None:
    """Rigid motions of neighbouring triangles agree at two points, hence everywhere."""
    R, px, py, qx, qy = ring("px py qx qy", QQ)
    end = script.alter("triangles glued at one vertex only", (qx, qy), (px, py))
    first = [[R(1), R(0), -py], [R(0), R(1), px]]
    minors = [cross_minor([*first, row]) for row in ([R(1), R(0), -end[1]], [R(0), R(1), end[0]])]
    script.identity(
        "a rigid motion (t, w) with t + w JP = t + w JQ = 0 is zero: two minors with squares "
        "adding up to |PQ|^2; so the motions of two triangles that share an edge are the same "
        "rigid motion, and along chains of triangles those of all: ker C has dimension 3",
        minors[0] ** 2 + minors[1] ** 2 - (qx - px) ** 2 - (qy - py) ** 2,
        of="IIB.7",
    )


def _counts(script: Script) -> None:
    """Euler's formula, and the count of positions and constraints of a wheel."""
    _, vi, ve, n = ring("Vi Ve N", QQ)
    edges, vertices = 3 * vi + 2 * ve - 3, vi + ve
    faces = (2 * edges - ve) / 3  # every fold in two triangles, every boundary edge in one
    disk = script.alter("Euler characteristic of the sphere", 1, 2)
    script.identity(
        "E = 3 Vi + 2 Ve - 3 from V - E + F = 1", vertices - edges + faces - disk, of="IIB.7"
    )
    left = script.alter("four rigid motions", 3, 4)
    script.identity(
        "E - (2V - 3) = Vi self stresses", edges - (2 * vertices - left) - vi, of="IIB.7"
    )
    script.identity(
        "wheel: 2N - ((2N + 2) - 3) = 1", 2 * n - ((2 * (n + 1)) - left) - 1, of="IIB.3"
    )
    script.state(
        "IIB.3",
        "Section II B, the wheel",
        r"\text{``the }2N+2\text{ in-plane positions of the vertices are subject to "
        r"}2N\text{ constraints. Since there are three planar Euclidean motions, there must "
        r"be generically one self stress''}",
        note="Remark: the 2N + 2 positions are the coordinates of N + 1 vertices. Exactly one self "
        "stress for every wheel with non-degenerate triangles, generic or not",
        code="self_stresses",
    )


def _force_balance(script: Script) -> None:
    """The wheel stress is the Maxwell-Cremona stress of (minus) the hat function of the hub."""
    _, *g = field("x0 y0 x1 y1 x2 y2", QQ)
    d0, d1, d2 = (g[0], g[1]), (g[2], g[3]), (g[4], g[5])

    def gradient(a: Any, b: Any) -> Any:  # of the hat on the triangle (0, a, b)
        c = cross(a, b)
        return ((a[1] - b[1]) / c, (b[0] - a[0]) / c)

    g0, g1 = gradient(d0, d1), gradient(d1, d2)
    one = script.alter("hat of height -1", 1, -1)
    script.identity(
        "the hat is 1 at the hub and 0 at the rim", dot(g1, d1) + one, dot(g1, d2) + one, of="IIB.5"
    )
    c0, c1, length2 = cross(d0, d1), cross(d1, d2), dot(d1, d1)
    angles = script.alter("cotangents left out", 1, 0)
    spoke = 1 / c1 + 1 / c0 - angles * (dot(d1, d2) / c1 + dot(d0, d1) / c0) / length2
    rim = script.alter("rim density 1/c", -1, 1) / c1
    jump = (g1[0] - g0[0], g1[1] - g0[1])
    along = (d2[0] - d1[0], d2[1] - d1[1])
    script.identity(
        "crossing spoke d_j the gradient jumps by -w_j J d_j, crossing rim edge e_j from outside "
        "by -w_{j,j+1} J e_j; the jumps around a vertex add up to zero, so sum w_e e = 0 at hub "
        "and rim vertices, for every N",
        jump[0] - spoke * d1[1],
        jump[1] + spoke * d1[0],
        g1[0] - rim * along[1],
        g1[1] + rim * along[0],
        of="IIB.5",
    )
    sign = script.alter("spokes with the sign of the rim", 1, -1)
    residues = []
    for n in (3, 4, 5):
        wheel = free_wheel(n)
        stress = wheel_stress(wheel, n)
        rows = dict(zip(wheel.edges, rigidity_matrix(wheel), strict=True))
        for e in wheel.edges:
            stress[e] *= sign if n in e else 1
        residues += [sum(stress[e] * rows[e][k] for e in wheel.edges) for k in range(2 * n + 2)]
    script.identity(
        "the same by exactfold over the field of all spokes, N = 3, 4, 5", *residues, of="IIB.5"
    )
    script.state(
        "IIB.5",
        "Section II B, after Eq. (wheelstress)",
        r"\text{``we prove that Eqs. (\ref{wheelstress}) do give the coefficients of a self "
        r"stress''}",
        note="Remark: also after embedding in the larger structure with all other components zero; "
        "for the proof of Appendix B see B.1 and following",
        code="wheel_stress",
    )


def _independence(script: Script) -> None:
    """On edge ab of triangle abp the wheel stress of p has density -1/c; c is twice the area."""
    wheel = free_wheel(4)
    d, stress = wheel.vertices, wheel_stress(wheel, 4)
    c = [cross(d[j], d[(j + 1) % 4]) for j in range(4)]
    sign = script.alter("coefficient opposite to the apex zero", 1, 0)
    boundaries = [stress[(min(j, (j + 1) % 4), max(j, (j + 1) % 4))] for j in range(4)]
    script.identity(
        "on the edge ab opposite to p the stress of p is -1/c: if sum_v l_v w^v = 0 and l = 0 at "
        "a, b and at the apex beyond ab (or ab is a boundary edge), then l_p = 0; from the rim "
        "inwards along chains of triangles all l_v = 0",
        *(sign * boundaries[j] * c[j] + 1 for j in range(4)),
        of="IIB.6 IIB.7",
    )
    patterns = (
        families.two_vertex(),
        families.waterbomb(),
        families.flat_vertex_square(),
        families.flat_octahedron_in_square(),
        families.hypar(2),
        families.h1_sequence(5),
    )
    motions = script.alter("ranks with four rigid motions", 3, 4)
    script.cases(
        "by exactfold: rank C = 2V - 3, rank of the wheel stresses = number of self stresses = Vi",
        (_ranks(f, motions) for f in patterns),
        of="IIB.6 IIB.7 IIB.8",
    )


def _ranks(pattern: CreasePattern, motions: int) -> bool:
    stresses = [wheel_stress(pattern, v) for v in pattern.interior]
    rows = [[w.get(e, 0) for e in pattern.edges] for w in stresses]
    regular = rank(rigidity_matrix(pattern)) == 2 * len(pattern.vertices) - motions
    return regular and rank(rows) == len(self_stresses(pattern)) == pattern.Vi


def _basis(script: Script) -> None:
    """The conclusion: Vi independent elements of a space of dimension E - rank C = Vi."""
    script.state(
        "IIB.6",
        "Section II B, first observation",
        r"\text{``at least }V_i\text{ self stresses''}",
        note="Remark: the wheel stresses are linearly independent",
    )
    script.state(
        "IIB.7",
        "Section II B, Fig. (wheel)",
        r"\text{``form a basis for the space of self stresses of a generic unfolded triangulated "
        r"origami, thus the dimensionality \dots\ is equal to the number of internal vertices''}",
        note="for every triangulated disk: rank C = 2V - 3 by gluing triangles, E - 2V + 3 = Vi, "
        "and Vi wheel stresses are independent. Genericity is not needed",
        code="wheel_stress, self_stresses",
    )
    script.state(
        "IIB.8",
        "Section II B, last sentence before the configuration space of a vertex; Introduction",
        r"\text{``the wheel stress constraint is precisely Gaussian curvature "
        r"preservation''}",
        note="Remark: the equations K_v(h) = 0, one an interior vertex, are equivalent to Eq. "
        "(compat) for all self stresses (A.9 and IIB.7)",
        code="BranchSystem",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
