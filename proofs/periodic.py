"""The theorems of docs/tessellations.md: periodic sheets roll up in 2^(V - 1) real ways."""

from __future__ import annotations

import sys
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import cache
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.fields import field

from exactfold._support.verdict import PROVED
from exactfold.branches import PeriodicCount, count_periodic
from exactfold.exact.linalg import inertia_by_elimination, nullspace, rank
from exactfold.pattern import PeriodicPattern, random_cell, read_cell
from exactfold.pattern.periodic.cells import Corner
from exactfold.rigidity.curvature import star_matrix
from exactfold.rigidity.equations.periodic import PeriodicProblem
from proofs.cells import ONE, TWO, Vector, curvatures
from proofs.framework import Proof, Script, run

NAME = "periodic"
TITLE = "Tessellations: all branches are real, one for each pair of sign vectors"
DIRECTIONS = ((3, 4), (1, 0), (-2, 5))


def prove(change: str | None = None) -> Proof:
    """The identities of the proofs for free geometries, and the conclusions on random cells."""
    script = Script(
        NAME,
        TITLE,
        (
            "a straight-line triangulation of the plane that repeats under a lattice; loops and "
            "repeated edges in the cell are allowed",
        ),
        change,
    )
    _state(script)
    _sums(script)
    _gradients(script)
    _special_cases(script)
    _conclusions(script)
    _covers(script)
    _rigidity(script)
    return script.proof()


def _state(script: Script) -> None:
    place = "docs/tessellations.md, Theorem"
    script.state(
        "T.15",
        f"{place} 15",
        r"X=\bigcup_sL_s\otimes\mathbb C:\text{ at most }2^{V-1}\text{ linear spaces, all real; an "
        r"isolated solution has multiplicity }2^{|F|}",
        note="the curvatures of a cell add up to 0, which takes the place of the key lemma",
        code="count_periodic",
        words=f"{place} 15",
    )
    script.state(
        "T.16",
        f"{place} 16",
        r"\text{without pleats }2^{V-1}\text{ solutions with }b=1\text{, with multiplicity, all "
        r"real; each pair of opposite vertex sign vectors occurs once}",
        note="the sign of b depends on the vertex signs only; it is negative if all pop up",
        code="PeriodicCount",
        words=f"{place} 16",
    )
    script.state(
        "T.17",
        f"{place} 17",
        r"C_s\subset Z=\operatorname{rad}\Big(\sum_{v\in F}K_v\Big|_N\Big)\text{ if }s\text{ are "
        r"the signs of }h\text{ off its flat vertices }F",
        note="by this a list of solutions is proved complete",
        code="periodic_certificate",
        words=f"{place} 17",
    )
    script.state(
        "T.18",
        f"{place} 18",
        r"\text{without pleats each solution without flat stars is tangent to an analytic family "
        r"of surfaces that two commuting screw motions leave invariant}",
        note="two-dimensional families: McInerney et al., arXiv 2003.01095",
        words=f"{place} 18",
    )


# --- the sum of the curvatures --------------------------------------------------------------------


def _sums(script: Script) -> None:
    names = "a1 a2 b1 b2 x y w p q r"
    _, a1, a2, b1, b2, x, y, w, p, q, r = field(names, QQ)
    lattice, area = [(a1, a2), (b1, b2)], a1 * b2 - a2 * b1
    factor = script.alter("twice the area", 1, 2)

    def height(corner: Corner, place: Vector) -> Any:
        s, t = place
        own = w if corner[0] == 1 else 0
        return own + (p * s * s + 2 * q * s * t + r * t * t) / 2

    for faces, points in ((ONE, [(x * 0, x * 0)]), (TWO, [(x * 0, x * 0), (x, y)])):
        total = sum(curvatures(faces, lattice, points, height))
        script.identity(
            f"Lemma 1 for all cells and heights of {len(points)} vertices: the K_v add up to the "
            "area of the cell times det B",
            total - factor * area * (p * r - q * q),
            of="T.15 T.16",
        )
    script.cases(
        "Lemma 1 with B = b n n^T on random cells: the forms add up to 0",
        (
            not any(any(sum(column) for column in zip(*rows, strict=True)) for rows in matrices)
            for seed in range(6)
            for problem in [PeriodicProblem.of(random_cell(4, seed, flips=seed), (3, 4))]
            for matrices in [zip(*(s.form for s in _dropped(script, problem)), strict=True)]
        ),
        of="T.15 T.16",
    )


def _dropped(script: Script, problem: PeriodicProblem) -> Sequence[Any]:
    """The stars of a problem; a mistake forgets one of them."""
    first = 1 if script.change == "one vertex is forgotten" else 0
    return problem.stars[first:]


def _gradients(script: Script) -> None:
    script.changes.append("one vertex is forgotten")
    _, *z = field("a b c d g1 g2 h1 h2", QQ)
    a, b, c, d, g1, g2, h1, h2 = z
    det = a * d - b * c

    def mapped(x: Any, y: Any) -> Vector:  # the inverse transpose of ((a, b), (c, d))
        return (d * x - c * y) / det, (a * y - b * x) / det

    (p1, p2), (q1, q2) = mapped(g1, g2), mapped(h1, h2)
    power = script.alter("areas of gradients kept", det, det / det)
    script.identity(
        "affine maps divide areas of gradients by det A, hence all K_v; n . x stays",
        power * (p1 * q2 - p2 * q1) - (g1 * h2 - g2 * h1),
        of="T.16",
    )


# --- special cases --------------------------------------------------------------------------------


def _special_cases(script: Script) -> None:
    _, *s = field("a1 a2 b1 b2 x y n1 n2 w", QQ)
    a1, a2, b1, b2, x, y, n1, n2, w = s
    lattice, zero = [(a1, a2), (b1, b2)], x * 0

    degree = script.alter("a cubic profile", 2, 3)

    def rolled(_: Corner, place: Vector) -> Any:
        return (n1 * place[0] + n2 * place[1]) ** degree / 2

    script.identity(
        "V = 1: (n . x)^2 / 2 is a solution for all lattices and directions",
        *curvatures(ONE, lattice, [(zero, zero)], rolled),
        of="T.16",
    )
    level = script.alter("the rows of loops are not level", 0, 1)

    def pleat(corner: Corner, _: Vector) -> Any:
        v, i, _j = corner
        return w * v + level * w * i * i

    script.identity(
        "parallel loop edges at two vertices: heights that are level along them are a pleat, for "
        "all positions",
        *curvatures(TWO, lattice, [(zero, zero), (x, y)], pleat),
        of="T.16",
    )
    script.identity(
        "the form of a vertex of degree 3 has rank one, for all stars",
        *_minors_of_degree_three(script.alter("four spokes", 3, 4)),
        of="T.15 T.16",
    )
    script.identity(
        "the waterbomb: w = (0, 0, (|n|^2 + s) / 2) with s^2 = n_1^2 (n_1^2 + 4 n_2^2), b = 1, "
        "satisfies all equations for all n",
        *_waterbomb(script.alter("sign under the root", 4, -4)),
        of="T.16",
    )


def _minors_of_degree_three(spokes: int) -> list[Any]:
    _, *z = field("d1 d2 d3 d4 e1 e2", QQ)
    d = [(z[0], z[1]), (z[2], z[3]), (-z[0] - z[2] * z[4], -z[1] - z[3] * z[4])]
    if spokes == 4:
        d.append((z[5], z[0]))
    matrix = star_matrix(d, lambda a, b: a / b)
    return [
        matrix[i][i] * matrix[j][j] - matrix[i][j] * matrix[j][i]
        for i in range(3)
        for j in range(i)
    ]


def _waterbomb(four: int) -> list[Any]:
    """K_v at the two solutions, as polynomials in n with s^2 replaced."""
    _, n1, n2, s = field("n1 n2 s", QQ)
    cell = read_cell("waterbomb-cell")
    top = (n1**2 + n2**2 + s) / 2

    def height(corner: Corner, place: Vector) -> Any:
        own = top if corner[0] == 2 else 0
        return own + (n1 * place[0] + n2 * place[1]) ** 2 / 2

    square = n1**2 * (n1**2 + four * n2**2)
    points = [
        (QQ(x.numerator, x.denominator), QQ(y.numerator, y.denominator)) for x, y in cell.points
    ]
    lattice = [
        (QQ(x.numerator, x.denominator), QQ(y.numerator, y.denominator)) for x, y in cell.lattice
    ]
    left = []
    for value in curvatures(cell.faces, lattice, points, height):
        total = value * 0
        for powers, c in value.numer.terms():
            total += (
                c
                * n1 ** powers[0]
                * n2 ** powers[1]
                * square ** (powers[2] // 2)
                * s ** (powers[2] % 2)
            )
        left.append(total)
    return left


# --- conclusions ----------------------------------------------------------------------------------


@cache
def _counts() -> tuple[PeriodicCount, ...]:
    """Proved counts of random cells, three directions each."""
    return tuple(
        count_periodic(random_cell(vertices, seed, flips=seed), n)
        for vertices in (1, 2, 3, 4)
        for seed in range(3)
        for n in DIRECTIONS
    )


def _conclusions(script: Script) -> None:
    weight = script.alter("multiplicity 1 everywhere", 2, 1)
    script.cases(
        "sum of 2^|F| over branches and pleats is 2^(V - 1), on random cells",
        (
            result.status is PROVED
            and sum(weight ** branch.vertex_signs.count("0") for branch in result)
            + _pleats(result, weight)
            == 2 ** (result.pattern.V - 1)
            for result in _counts()
            if result.evidence is not None and not result.families
        ),
        of="T.15 T.16",
    )
    side = script.alter("all up rolls up", -1, 1)
    script.cases(
        "all up rolls down, for every direction",
        (
            branch.b == side
            for result in _counts()
            for branch in result
            if "-" not in branch.vertex_signs and "0" not in branch.vertex_signs
        ),
        of="T.16",
    )
    script.cases(
        "the sign of b depends on the vertex signs only, not on the direction",
        _same_sides(script.alter("the other side", 1, -1)),
        of="T.16",
    )


def _pleats(result: PeriodicCount, weight: int) -> int:
    """The multiplicities of lines of pleats: 2^(flat vertices), with those inside triangles."""
    evidence = result.evidence
    if evidence is None:
        return 0
    rigid = len(evidence.problem.parts.rigid)
    lines = {c.space for c in evidence.covers if c.space.dimension == 1 and not c.space.bends}
    return sum(weight ** (rigid + len(line.flat)) for line in lines)


def _same_sides(other: int) -> Iterator[bool]:
    for k in range(0, len(_counts()), len(DIRECTIONS)):
        first, *rest = _counts()[k : k + len(DIRECTIONS)]
        known = {branch.vertex_signs: branch.b for branch in first}
        for result in rest:
            yield all(
                branch.b == other * known[branch.vertex_signs]
                for branch in result
                if branch.vertex_signs in known
            )


def _covers(script: Script) -> None:
    side = script.alter("the sum is negative", 0, 1)
    script.cases(
        "at solutions with flat vertices F the sum of K_v over F has no negative direction on N",
        (
            inertia_by_elimination(_sum_on_normal(problem, cover.point))[1 - side] == 0
            for name, n in (("resch-cell", (0, 1)), ("kisrhombille-cell", (1, 0)))
            for evidence in [count_periodic(name, n).evidence]
            if evidence is not None
            for problem in [evidence.problem]
            for cover in evidence.covers
            if cover.space.flat
        ),
        of="T.15 T.17",
    )


def _sum_on_normal(problem: PeriodicProblem, point: Sequence[Fraction]) -> list[list[Fraction]]:
    """The sum over flat vertices, on the space N of a solution."""

    def image(form: Sequence[Sequence[Fraction]], h: Sequence[Fraction]) -> list[Fraction]:
        return [sum((a * b for a, b in zip(row, h, strict=True)), Fraction(0)) for row in form]

    images = [image(star.form, point) for star in problem.stars]
    normal = nullspace([row for row in images if any(row)])
    flat = [star.form for star, row in zip(problem.stars, images, strict=True) if not any(row)]

    def paired(a: Sequence[Fraction], c: Sequence[Fraction]) -> Fraction:
        rows = (image(form, a) for form in flat)
        return sum((x * y for row in rows for x, y in zip(row, c, strict=True)), Fraction(0))

    return [[paired(a, c) for c in normal] for a in normal]


def _rigidity(script: Script) -> None:
    more = script.alter("no lattice parameters", 4, 0)
    script.cases(
        "the lengths of a cell have rank 2 V + 1 in its points and lattice: V - 1 self stresses",
        (
            rank(_length_rows(cell, more)) == 2 * cell.V + 1
            for vertices in (1, 2, 3, 5)
            for seed in range(3)
            for cell in [random_cell(vertices, seed, flips=seed)]
        ),
        of="T.18",
    )


def _length_rows(cell: PeriodicPattern, more: int) -> list[list[Fraction]]:
    rows = []
    for u, v, i, j in cell.edges:
        (px, py), (qx, qy) = cell.place((u, 0, 0)), cell.place((v, i, j))
        dx, dy = qx - px, qy - py
        row = [Fraction(0)] * (2 * cell.V + more)
        for k, d in ((0, dx), (1, dy)):
            row[2 * v + k] += d
            row[2 * u + k] -= d
            if more:
                row[2 * cell.V + k] += i * d
                row[2 * cell.V + 2 + k] += j * d
        rows.append(row)
    return rows


if __name__ == "__main__":
    raise SystemExit(run(prove()))
