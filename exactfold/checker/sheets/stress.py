"""Definite stresses: the parts of a sheet that are rigid, and systems with finitely many zeros."""

from __future__ import annotations

from fractions import Fraction
from typing import Any

from ..core.linear import inertia, matrix_of
from ..core.reading import items, keys, parse_rational, require
from .sheet import Form, Sheet, turn


def check_lorentzian(sheet: Sheet, vertex: int) -> None:
    """The curvature form of a flat vertex of degree N has inertia (1, N - 3, 3)."""
    labels = [*sheet.star(vertex), vertex]  # in this order elimination fills in two columns only
    expected = (1, len(labels) - 4, 3)
    require(
        inertia(matrix_of(sheet.curvature(vertex), labels)) == expected,
        f"the curvature form of vertex {vertex} has not inertia {expected}",
    )


def check_definite(sheet: Sheet, inside: list[int], weights: list[Fraction]) -> None:
    """sum_v weight_v K_v is positive definite on heights that vanish outside `inside`.

    Then the K_v have no common complex zero w = a + i b but 0 there: K_v(a) = K_v(b) and
    B_v(a, b) = 0, and if b is not 0 some K_v(b) > 0, though K_v has one positive direction only.
    """
    total: Form = {}
    for v, weight in zip(inside, weights, strict=True):
        require(weight > 0, "a multiplier is not positive")
        check_lorentzian(sheet, v)
        for pair, w in sheet.curvature(v).items():
            total[pair] = total.get(pair, 0) + weight * w
    require(inertia(matrix_of(total, inside)) == (len(inside), 0, 0), "a stress is not definite")


def check_triangles(sheet: Sheet, evidence: Any) -> Sheet:
    """Remove the triangulated triangles, each by a definite stress; the emptied sheet."""
    emptied = sheet
    for entry in items(evidence, "triangles"):
        keys(entry, "corners inside multipliers", "triangle")
        corners, inside = items(entry["corners"], "corners", 3), items(entry["inside"], "inside")
        for v in corners + inside:
            require(type(v) is int and v in emptied.points, f"{v!a} is no vertex")
        a, b, c = (emptied.points[v] for v in corners)
        require(turn(a, b, c) > 0, f"the 3-cycle {corners} is not counter-clockwise")
        for i, j in ((0, 1), (0, 2), (1, 2)):
            edge = (min(corners[i], corners[j]), max(corners[i], corners[j]))
            require(edge in emptied.edges, f"{corners} is no 3-cycle of edges")
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
    """The branch system has finitely many zeros, so that multiplicities add up to 2^n exactly.

    A definite stress of the sheet (its notch closed by a triangle if the boundary is not convex)
    leaves no common zero of the curvature forms on heights that vanish on the outer boundary:
    these fill a hyperplane (a quadric cone's section) that every curve of zeros would meet.
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
