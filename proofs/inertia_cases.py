"""The inertia of the Jacobian on hostile patterns; popping a vertex up raises its height.

Theorem (notation of docs/theorem.md). Let h and h' be solutions of Theorem 2 for the same boundary
heights and the same k >= 0, without flat vertices, whose signs differ at v only: v is up in h. Then
h_v > h'_v.

Proof. 1. Kernels. Let K_u(g) > 0, or K_u(g) = 0 and the star of u not be flat, for all u != v. Let
w in V_0 have K_u(g, w) = 0 for these u. By (L), K_u(w) <= 0. A plane of such w would contain a
w != 0 with K_v(w) <= 0, against the key lemma. So they form a line, and K_v(w) > 0 for w != 0. If
J(g) w = 0, then w_v != 0: otherwise take the multipliers m of the key lemma and a w' in V_0 with
K_u(g, w') = -K_u(m, w) for u != v; then T(m, w, w) = sum_u w_u K_u(m, w) = -w^T J(g) w' = 0, but
T(m, w, w) = sum_u m_u K_u(w) > 0.

2. Chords. J((h + h')/2) (h - h') = (K(h) - K(h'))/2 = 0. So h_v != h'_v by 1, as in the proof of
Theorem 2 (d) and (e). For k > 0 the solutions depend continuously on k and the boundary heights, so
that h_v - h'_v has one sign for all of these, also in the limit k -> 0. Take boundary heights 0,
and fix k_u > 0 for u != v.

3. A curve from h' to h. The g in V_0 with K_u(g) = k_u and the given signs for u != v form a smooth
curve C with the tangent w = w(g) of 1 that has K_v(w) = 1 and pops up at v. For a tangent w_0 the
function K_v(w_0, .) increases along C, as two vectors of one nappe have a positive product; so no
component is closed. On an unbounded sequence in C, f = K_v tends to infinity by the key lemma; and
by Theorem 2 (d) C has two points with a given value f > 0, first one with v down, then one with v
up. So C is connected.

4. Half turns. The plane curve (g_v, f(g)), g in C, has the tangent (w_v, 2x) with x = K_v(g, w),
which is never 0 by 1, and does not meet itself, by 2. J(g) is singular only where x = 0. Where
w_v != 0, V_0 is the sum of the line of w and of {y_v = 0}, orthogonal for J(g), as J(g) w = x e_v;
and J(g) is nonsingular on {y_v = 0}. So the number of positive eigenvalues grows by one where the
tangent turns through the horizontal counter-clockwise, and falls by one where it turns clockwise.
From end to end it grows by 1 (Theorem 4), so the tangent makes half a turn from down to up
counter-clockwise. As the curve does not meet itself, its last end is to the right of its first, by
Hopf's Umlaufsatz: h_v > h'_v.
"""

from __future__ import annotations

import random
import sys
from collections.abc import Iterator, Sequence
from fractions import Fraction
from functools import lru_cache
from itertools import combinations, product
from pathlib import Path
from typing import Any

if not __package__:  # run as a file
    sys.path.insert(0, str(Path(__file__).resolve().parent.parent))

from sympy import QQ
from sympy.polys.rings import ring

from exactfold import BranchCount, CreasePattern, random_square
from exactfold._support.verdict import PROVED
from exactfold.exact.linalg import Inertia, from_fmpq, inertia_by_elimination, to_flint
from proofs.chambers import (
    Solutions,
    corner_sign,
    counted,
    inertia_at,
    jacobian,
    solve,
    vertex_signs,
)
from proofs.framework import Proof, Script, run
from proofs.patterns import (
    DART,
    darts,
    degenerate_patterns,
    grid_quadrilaterals,
    hostile_patterns,
    quadrilaterals,
)

NAME = "inertia_cases"
TITLE = "Theorem 4 on hostile patterns, and popping up raises a vertex"


def prove(change: str | None = None) -> Proof:
    """Test Theorem 4 and its corollary where they could fail, by exact signs and inertias."""
    script = Script(
        NAME,
        TITLE,
        ("convex boundary; a quadrilateral with a reflex corner: the sheet with its notch closed",),
        change,
    )
    script.state(
        "T.5",
        "Statement of exactfold on two solutions whose signs differ at v alone",
        r"\text{same boundary heights and }k\ge0:\ "
        r"h_v\text{ is larger where }v\text{ is popped up}",
        note="convex boundary, no flat vertex",
        code="Branch.heights",
        words="theorem in proofs/inertia_cases.py",
    )
    _chambers(script)
    _branches(script)
    _tensor(script)
    _midpoints(script)
    _half_turns(script)
    _popping_raises(script)
    return script.proof()


@lru_cache(maxsize=1)
def _hostile() -> list[CreasePattern]:
    return list(hostile_patterns(13))


@lru_cache(maxsize=1)
def _branch_sheets() -> dict[str, list[CreasePattern]]:
    degenerate = [*degenerate_patterns().values(), *grid_quadrilaterals(24)]
    return {
        "convex sheets": [*(p for p in quadrilaterals(16) if p.is_convex), *_squares()],
        "straight creases and flat vertices": [p for p in degenerate if p.is_convex],
        "reflex corner, up in the closed sheet": [
            p for p in [DART, *darts(16), *degenerate] if not p.is_convex
        ],
    }


def _squares() -> list[CreasePattern]:
    return [random_square(n, seed) for n in (2, 3, 4) for seed in range(4)]


def _chambers(script: Script) -> None:
    """Heights with all K_v > 0: solutions for all sign vectors, and sums within one chamber."""
    swapped = script.alter("up and down exchanged", False, True)

    def agree(pattern: CreasePattern, heights: dict[int, Fraction]) -> bool:
        signs = vertex_signs(pattern, heights)
        expected = (signs.count(1), signs.count(-1), 0)
        expected = (expected[1], expected[0], 0) if swapped else expected
        return inertia_by_elimination(jacobian(pattern, heights)) == expected

    def points() -> Iterator[tuple[CreasePattern, dict[int, Fraction]]]:
        for seed, pattern in enumerate(_hostile()):
            first = solve(pattern, seed)
            yield from ((pattern, h) for h in first.points)
            if pattern.Vi < 5:
                other = solve(pattern, seed + 100)
                for one, signs in zip(first.points, first.signs, strict=True):
                    two = other.points[other.signs.index(signs)]
                    yield pattern, {v: 3 * one[v] + two[v] / 7 for v in one}

    script.cases(
        "the inertia of J(h), by exact elimination, is (up, down, 0) at points of all chambers of "
        "hostile patterns",
        (agree(pattern, heights) for pattern, heights in points()),
        of="T.5",
    )


def _branches(script: Script) -> None:
    """Certified branches: J is nonsingular on the whole box, with the inertia of its centre."""
    closed_only = script.alter("the notch left open", True, False)
    nonzero = script.alter("flat vertices not counted", False, True)

    def expected(signs: Sequence[int]) -> Inertia:
        return signs.count(1), signs.count(-1), 0 if nonzero else signs.count(0)

    def agree(result: BranchCount) -> Iterator[bool]:
        pattern = result.pattern
        yield result.status is PROVED
        for branch in result.branches:
            sheet, side, signs = pattern, 1, dict(branch.vertex_signs)
            if not pattern.is_convex and closed_only:
                side = corner_sign(pattern, branch) or 0
                sheet = pattern.with_notch_closed()
                signs = {v: side * s for v, s in signs.items()}
                signs |= {v: 1 for v in sheet.interior if v not in signs}
            box = {v: (side * low, side * high) for v, (low, high) in branch.heights.items()}
            flat = {v for v, s in signs.items() if not s}
            yield inertia_at(sheet, box, flat) == expected(list(signs.values()))

    for title, patterns in _branch_sheets().items():
        script.cases(
            f"inertia of J on the boxes of all branches; {title}: (up, down, flat)",
            (ok for p in patterns for ok in agree(counted(p))),
            of="T.5",
        )
    found = {inertia_at(DART, b.heights, set()) for b in counted(DART).branches}
    script.counterexample(
        "false for the reflex sheet itself: hub (0,0) in (4,-4), (1,0), (4,4), (-4,0) is down on "
        "both branches, J is positive on one and negative on the other",
        found == script.alter("the signs of the open sheet", {(1, 0, 0), (0, 1, 0)}, {(0, 1, 0)})
        and {b.sign_text for b in counted(DART).branches} == {"-"},
        of="T.5",
    )


def _tensor(script: Script) -> None:
    """The case K_u(a, b) = T(e_u, a, b), J = T(h, ., .), with any symmetric trilinear form T."""
    sign = script.alter("w'^T J(h) w with the wrong sign", 1, -1)
    count = script.alter("K_u(w) counted twice", 1, 2)
    for n in (1, 2, 3, 4):
        triples = [(i, j, k) for i, j, k in product(range(n), repeat=3) if i <= j <= k]
        names = [f"t{i}{j}{k}" for i, j, k in triples]
        names += [f"{name}{i}" for name in "hwxz" for i in range(n)]
        _, *generators = ring(names, QQ)
        entry = dict(zip(triples, generators, strict=False))
        vectors = generators[len(triples) :]
        h, w, dw, z = (vectors[k * n : k * n + n] for k in range(4))

        def form(a: Any, b: Any, c: Any, entry: Any = entry, n: int = n) -> Any:
            return sum(
                entry[(t := sorted((i, j, k)))[0], t[1], t[2]] * a[i] * b[j] * c[k]
                for i, j, k in product(range(n), repeat=3)
            )

        units = [[int(i == k) for i in range(n)] for k in range(n)]
        moved = sum(w[u] * (form(units[u], z, w) + form(units[u], h, dw)) for u in range(n))
        rest = sum(dw[u] * form(units[u], h, w) for u in range(n))
        script.identity(
            f"n = {n}: sum_u w_u (K_u(z, w) + K_u(h, w')) = T(z, w, w) + w'^T J(h) w; so if "
            "J(h) w = 0, w_v = 0 and K_u(z, w) + K_u(h, w') = 0 for u != v, T(z, w, w) = 0",
            moved - form(z, w, w) - sign * rest,
            of="T.5",
        )
        script.identity(
            f"n = {n}: T(z, w, w) = w^T J(z) w = sum_u z_u K_u(w)",
            form(z, w, w) - count * sum(z[u] * form(units[u], w, w) for u in range(n)),
            of="T.5",
        )


def _midpoints(script: Script) -> None:
    _, *y = ring("a b c d e f p1 p2 p3 q1 q2 q3", QQ)
    matrix = ((y[0], y[1], y[2]), (y[1], y[3], y[4]), (y[2], y[4], y[5]))

    def polar(left: Any, right: Any) -> Any:
        return sum(left[i] * matrix[i][j] * right[j] for i, j in product(range(3), repeat=2))

    one, two = y[6:9], y[9:]
    factor = script.alter("the midpoint without its factor", 1, 2)
    total = [a + b for a, b in zip(one, two, strict=True)]
    chord = [b - a for a, b in zip(one, two, strict=True)]
    script.identity(
        "K(q) - K(p) = 2 K((p + q)/2, q - p), K any quadratic form: a chord between points of "
        "equal K_u is in the kernel of the row of u at its midpoint",
        polar(two, two) - polar(one, one) - factor * polar(total, chord),
        of="T.5",
    )
    _, p0, q0, *x = ring("p0 q0 p1 p2 p3 q1 q2 q3", QQ)
    p, q = x[:3], x[3:]
    dot = sum(a * b for a, b in zip(p, q, strict=True))
    kp, kq = p0**2 - sum(a**2 for a in p), q0**2 - sum(b**2 for b in q)
    squares = sum((p[i] * q[j] - p[j] * q[i]) ** 2 for i, j in combinations(range(3), 2))
    sign = script.alter("the squares subtracted", 1, -1)
    script.identity(
        "(p0 q0)^2 - (p.q)^2 = K(p) q0^2 + |p|^2 K(q) + sum of squares, for K = x0^2 - |x|^2: on "
        "one nappe K(p, q) = p0 q0 - p.q > 0 and K((p + q)/2) > 0",
        (p0 * q0) ** 2 - dot**2 - (kp * q0**2 + sum(a**2 for a in p) * kq + sign * squares),
        of="T.5",
    )


def _half_turns(script: Script) -> None:
    """J w = x e_v: J is positive on more directions than its minor without v where x w_v > 0."""
    up = script.alter("the sign of x w_v reversed", 1, -1)

    def agree(pattern: CreasePattern, seed: int) -> Iterator[bool]:
        source = random.Random(seed)
        h = {v: Fraction(source.randint(-9, 9)) for v in range(len(pattern.vertices))}
        matrix = jacobian(pattern, h)
        whole = range(pattern.Vi)
        for v in whole:
            units = [[Fraction(k == v)] for k in whole]
            minor = [[matrix[i][j] for j in whole if j != v] for i in whole if i != v]
            part = inertia_by_elimination(minor)
            if inertia_by_elimination(matrix)[2] or part[2]:
                continue
            w_v = from_fmpq(to_flint(matrix).solve(to_flint(units))[v, 0])  # here x = 1
            yield inertia_by_elimination(matrix)[0] == part[0] + (up * w_v > 0)

    script.cases(
        "J w = x e_v: the number of positive eigenvalues of J is that of its minor without v, and "
        "one more if x w_v > 0",
        (ok for seed, p in enumerate(hostile_patterns(20)) for ok in agree(p, seed)),
        of="T.5",
    )


def _popping_raises(script: Script) -> None:
    """h_v is larger if v is up, when all other signs, k >= 0 and the boundary heights are equal."""
    down = script.alter("popping up lowers", 1, -1)

    def pairs(vectors: Sequence[tuple[Any, ...]]) -> Iterator[tuple[int, int, int]]:
        """Positions of two sign vectors that differ at one vertex only, where the first is up."""
        for one, other in product(range(len(vectors)), repeat=2):
            places = [k for k, s in enumerate(vectors[one]) if s != vectors[other][k]]
            if len(places) == 1 and vectors[one][places[0]] == 1:
                yield one, other, places[0]

    def of_solutions(found: Solutions) -> Iterator[bool]:
        for one, other, k in pairs(found.signs):
            v = found.pattern.interior[k]
            yield down * (found.points[one][v] - found.points[other][v]) > 2 * found.radius

    def of_branches(result: BranchCount) -> Iterator[bool]:
        branches = [b for b in result.branches if 0 not in b.vertex_signs.values()]
        order = result.pattern.interior
        for one, other, k in pairs([tuple(b.vertex_signs[v] for v in order) for b in branches]):
            high, low = branches[one].heights[order[k]], branches[other].heights[order[k]]
            yield high[0] > low[1] if down > 0 else high[1] < low[0]

    script.cases(
        "popping one vertex up raises it: solutions for positive curvatures, hostile patterns",
        (ok for seed, p in enumerate(_hostile()) for ok in of_solutions(solve(p, seed))),
        of="T.5",
    )
    script.cases(
        "popping one vertex up raises it: branches of convex sheets with saddle 1",
        (ok for pattern in _squares() for ok in of_branches(counted(pattern))),
        of="T.5",
    )


if __name__ == "__main__":
    sys.exit(run(prove()))
