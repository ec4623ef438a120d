"""Definite stresses: they show that parts are rigid, and that a system has finitely many zeros."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from ..core.linear import inertia, matrix_of
from ..core.reading import items, keys, parse_rational, require
from .sheet import Form, Sheet, turn


def check_lorentzian(sheet: Sheet, vertex: int) -> None:
    """Raise unless the curvature form of a vertex of degree N has inertia (1, N - 3, 3)."""
    labels = [*sheet.star(vertex), vertex]  # in this order elimination fills only two columns
    expected = (1, len(labels) - 4, 3)
    require(
        inertia(matrix_of(sheet.curvature(vertex), labels)) == expected,
        f"the curvature form of vertex {vertex} does not have the inertia {expected}",
    )


def check_definite(sheet: Sheet, inside: list[int], weights: list[Fraction]) -> None:
    """Raise unless sum_v weight_v K_v is positive definite on heights that vanish outside `inside`.

    If it is, the K_v have no common complex zero w = a + i b there but 0. For at a common zero
    K_v(a) = K_v(b) and B_v(a, b) = 0. If b is not 0, some K_v(b) > 0. Then K_v would be positive in
    two directions, but it has one positive direction only.
    """
    total: Form = {}
    for v, weight in zip(inside, weights, strict=True):
        require(weight > 0, "a multiplier is not positive")
        check_lorentzian(sheet, v)
        for pair, w in sheet.curvature(v).items():
            total[pair] = total.get(pair, 0) + weight * w
    require(inertia(matrix_of(total, inside)) == (len(inside), 0, 0), "a stress is not definite")


def check_triangles(sheet: Sheet, evidence: Any) -> Sheet:
    """The sheet without the vertices inside listed 3-cycles; a definite stress for each."""
    emptied = sheet
    for entry in items(evidence, "triangles"):
        keys(entry, "corners inside multipliers", "triangle")
        corners, inside = items(entry["corners"], "corners", 3), items(entry["inside"], "inside")
        for v in corners + inside:
            require(type(v) is int and v in emptied.points, f"{v!a} is not a vertex")
        a, b, c = (emptied.points[v] for v in corners)
        require(turn(a, b, c) > 0, f"the 3-cycle {corners} is not counter-clockwise")
        for i, j in ((0, 1), (0, 2), (1, 2)):
            edge = (min(corners[i], corners[j]), max(corners[i], corners[j]))
            require(edge in emptied.edges, f"{corners} is not a 3-cycle of edges")
        within = [
            v
            for v in emptied.interior
            if all(turn(p, q, emptied.points[v]) > 0 for p, q in ((a, b), (b, c), (c, a)))
        ]
        require(within and sorted(inside) == within, f"not the vertices inside {corners}")
        weights = [
            parse_rational(m) for m in items(entry["multipliers"], "multipliers", len(inside))
        ]
        check_definite(emptied, inside, weights)
        emptied = emptied.emptied(corners, inside)
    return emptied


def check_finite(sheet: Sheet, multipliers: Any) -> None:
    """Raise unless a stress shows that the branch system has finitely many zeros.

    Then the multiplicities of the zeros add up to exactly 2^n. If the boundary is not convex, a
    triangle closes the notch first. If the stress is definite, the curvature forms of all interior
    vertices have no common zero but 0 on heights that vanish on the boundary. In projective space
    these heights are a hyperplane; with a closed notch the form of its corner adds the equation of
    a quadric instead. A curve of zeros of the branch system would meet the hyperplane, or the
    quadric.
    """
    corners = sheet.boundary
    for k, v in enumerate(corners):
        before, after = corners[k - 1], corners[(k + 1) % len(corners)]
        if turn(*(sheet.points[u] for u in (before, v, after))) < 0:
            faces = [sheet.face(t) for t in sheet.triangles]
            sheet = Sheet(sheet.points, [*faces, (before, after, v)])
            break
    weights = [parse_rational(m) for m in items(multipliers, "multipliers", len(sheet.interior))]
    check_definite(sheet, sheet.interior, weights)
