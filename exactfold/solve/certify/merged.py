"""Merges faces that form a larger triangle, so that vertices on its sides are proved flat.

On a grid it happens that faces form a triangle with further vertices on its sides. If the branch is
folded along the sides, all of the triangle is flat, though no equation at a single vertex says so.
It is proved on the sheet with fewer vertices, in which the triangle is one face: its heights are
heights of the given sheet, too (docs/branch.md, Merged faces).
"""

from __future__ import annotations

from collections.abc import Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import pairwise

import numpy as np

from exactfold.errors import PatternError
from exactfold.pattern.crease_pattern import CreasePattern, Edge, Triangle
from exactfold.pattern.validate import IntPoint, orientation
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.solve.certify.enclosed_flat import with_flat
from exactfold.solve.certify.enclosure import Enclosure

Face = tuple[Triangle, tuple[int, ...]]
"""A larger triangle: its corners, counter-clockwise, and the other vertices in it, on it."""


@dataclass(frozen=True)
class Merged:
    """A sheet in which `faces` of the sheet `fine` are single faces.

    Vertex k of `sheet` is vertex `labels[k]` of `fine`.
    """

    fine: VertexEquations
    sheet: VertexEquations
    labels: tuple[int, ...]
    faces: tuple[Face, ...]

    def lifted(self, proof: Enclosure, wanted: Mapping[int, int]) -> Enclosure | None:
        """What a proof on `sheet` says of the branch with the signs `wanted` on `fine`.

        At a vertex inside a larger triangle the lifted branch is flat, so that it lies in both
        nappes. At a vertex on a side it is folded along the side, so that K_v = 0, and the nappe is
        that of the letter. If these are the nappes wanted everywhere, the lifted branch is the one
        with these signs, as there is only one (Theorem 5). Otherwise the result is None.
        """
        labels = self.labels
        if any(wanted[labels[v]] != sign for v, sign in proof.signs.items()):
            return None
        known: dict[Edge, int | None] = {}
        for k, (i, j) in enumerate(self.sheet.pattern.folds):
            flat = not proof.letters[k] and k in proof.flat_folds
            known[labels[i], labels[j]] = 0 if flat else proof.letters[k] or None
        points = self.fine.pattern.integer_vertices[0]
        for corners, others in self.faces:
            for side, inner in _sides(points, corners, others):
                letter = known.get(_edge(*side))
                if inner and letter is None:
                    return None
                chain = (side[0], *inner, side[1])
                for part in pairwise(chain):
                    known[_edge(*part)] = letter
                if letter and any(wanted[v] != -letter for v in inner):
                    return None
        letters = [known.get(fold, 0) for fold in self.fine.pattern.folds]
        flat_folds = frozenset(k for k, letter in enumerate(letters) if letter == 0)
        heights = np.array([0] * len(self.fine.pattern.vertices), dtype=object)
        heights[list(labels)] = proof.heights
        lifted = replace(
            proof,
            heights=heights,
            signs=dict(wanted),
            letters=tuple(letter or 0 for letter in letters),
            merged=self.faces,
        )
        return with_flat(self.fine, lifted, flat_folds)


def merged(sheet: VertexEquations, proof: Enclosure) -> Merged | None:
    """The sheet in which larger triangles without a decided fold inside are faces; None if none."""
    gauge, pattern = sheet.problem.gauge, sheet.pattern
    if sheet.targets or sheet.unclosed is not pattern:
        return None
    faces = _larger_triangles(pattern, proof)
    gone = {v for _, others in faces for v in others}
    if not gone:
        return None
    labels = tuple(v for v in range(len(pattern.vertices)) if v not in gone)
    place = {v: k for k, v in enumerate(labels)}
    kept = [t for t in pattern.triangles if gone.isdisjoint(t)] + [c for c, _ in faces]
    triangles = [(place[a], place[b], place[c]) for a, b, c in kept]
    rim = {place[v]: height for v, height in gauge.boundary_heights.items()}
    try:
        fewer = CreasePattern([pattern.vertices[v] for v in labels], triangles)
    except PatternError:
        return None
    problem = Problem.of(fewer, boundary_heights=None if gauge.kind == "saddle" else rim)
    if problem.rigid or not fewer.interior or problem.gauge.boundary_heights != rim:
        return None
    return Merged(sheet, VertexEquations(problem), labels, tuple(faces))


def heights_inside(
    points: Sequence[IntPoint], faces: Iterable[Face], heights: Mapping[int, Fraction]
) -> dict[int, Fraction]:
    """The heights of the vertices that were merged, each in the plane of three corners."""
    found = {}
    for corners, others in faces:
        a, b, c = (points[v] for v in corners)
        area = orientation(a, b, c)
        for v in others:
            p = points[v]
            parts = (orientation(p, b, c), orientation(a, p, c), orientation(a, b, p))
            terms = (part * heights[u] for part, u in zip(parts, corners, strict=True))
            found[v] = sum(terms, Fraction(0)) / area
    return found


def _larger_triangles(pattern: CreasePattern, proof: Enclosure) -> list[Face]:
    """The larger triangles in which no fold is decided, with all vertices on their sides.

    A vertex is merged if no fold at it is decided, or just two that go straight on. All panels at
    such a vertex must be triangles when all such vertices are left out.
    """
    open_ = [fold for fold, letter in zip(pattern.folds, proof.letters, strict=True) if not letter]
    points, outside = pattern.integer_vertices[0], set(pattern.boundary)
    unbent = set(open_)
    straight = set()
    for v in {v for fold in open_ for v in fold} - outside:
        bent = [w for w in pattern.star(v) if _edge(v, w) not in unbent]
        if not bent or (len(bent) == 2 and _goes_straight(points, v, *bent)):
            straight.add(v)
    panels = [panel for panel in _panels(pattern, open_) if any(v in straight for v in panel[1])]
    while True:
        found, failed = [], set[int]()
        for faces, vertices in panels:
            face = _triangle(points, faces, vertices, straight)
            if face is None:
                failed |= vertices & straight
            else:
                found.append(face)
        if not failed:
            return found
        straight -= failed
        panels = [panel for panel in panels if any(v in straight for v in panel[1])]


def _panels(pattern: CreasePattern, folds: Iterable[Edge]) -> list[tuple[list[Triangle], set[int]]]:
    """The panels into which faces grow together across folds: their faces and vertices."""
    beyond: dict[Triangle, list[Triangle]] = {}
    for i, j in folds:
        left, right = pattern.opposite((i, j))
        one, other = _turned(i, j, left), _turned(j, i, right)
        beyond.setdefault(one, []).append(other)
        beyond.setdefault(other, []).append(one)
    panels, seen = [], set[Triangle]()
    for start in beyond:
        if start not in seen:
            seen.add(start)
            faces = [start]
            for face in faces:
                new = [other for other in dict.fromkeys(beyond[face]) if other not in seen]
                seen.update(new)
                faces += new
            panels.append((faces, {v for face in faces for v in face}))
    return panels


def _triangle(
    points: Sequence[IntPoint],
    faces: Collection[Triangle],
    vertices: set[int],
    straight: set[int],
) -> Face | None:
    """A panel as a triangle whose corners are its vertices that are not `straight`, or None."""
    corners = sorted(vertices - straight)
    if len(corners) != 3:
        return None
    a, b, c = corners
    turn = orientation(points[a], points[b], points[c])
    if turn < 0:
        b, c = c, b
    others = tuple(sorted(vertices & straight))
    ends = ((a, b), (b, c), (c, a))
    inside = all(orientation(points[i], points[j], points[v]) >= 0 for v in others for i, j in ends)
    area = sum(orientation(*(points[v] for v in face)) for face in faces)
    return ((a, b, c), others) if inside and area == abs(turn) else None


def _sides(
    points: Sequence[IntPoint], corners: Triangle, others: Iterable[int]
) -> Iterator[tuple[Edge, list[int]]]:
    """The sides of a larger triangle, and the vertices on each of them from its first end."""
    a, b, c = corners
    for i, j in ((a, b), (b, c), (c, a)):
        p, q = points[i], points[j]
        on = [v for v in others if orientation(p, q, points[v]) == 0]
        yield (
            (i, j),
            sorted(on, key=lambda v: sum((points[v][k] - p[k]) * (q[k] - p[k]) for k in (0, 1))),
        )


def _goes_straight(points: Sequence[IntPoint], v: int, a: int, b: int) -> bool:
    (x, y), (ax, ay), (bx, by) = points[v], points[a], points[b]
    along = (ax - x) * (bx - x) + (ay - y) * (by - y)
    return along < 0 and orientation(points[v], points[a], points[b]) == 0


def _edge(i: int, j: int) -> Edge:
    return (i, j) if i < j else (j, i)


def _turned(a: int, b: int, c: int) -> Triangle:
    """The triangle from its smallest vertex."""
    return min((a, b, c), (b, c, a), (c, a, b))
