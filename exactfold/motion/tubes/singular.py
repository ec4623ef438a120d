"""Singular configurations that are no branch points, described in words (docs/motion.md, 13).

Symmetry can make the lengths of edges depend on each other. Let a part of the sheet be mapped to
itself by a half-turn of the plane. It exchanges m pairs of vertices and e pairs of edges, and may
fix one vertex (k = 1, else k = 0), or one edge, whose ends it exchanges (l = 1, else l = 0). In a
configuration of the part that a half-turn about a line in space maps to itself in the same way, the
equations of its lengths split. On displacements that keep the symmetry they are e + l equations in
3m + k unknowns, 2 of which are moved by motions of the whole part. On displacements that it
reverses they are e equations in 3m + 2k unknowns, 4 of which are.

Proof: displacements y with R y_v = +-y_v', where v' is the image of v and R the linear half-turn,
are given by the y_v of one vertex of each pair and by that of the fixed vertex, which is along the
line for + and perpendicular to it for -. The derivatives of the lengths of an edge and its image
are equal for + and opposite for -: e equations each. A fixed edge v v' is perpendicular to the
line. For - the difference y_v - y_v' = y_v + R y_v is along the line, so that its length has the
derivative 0: it is an equation for + only. Of the infinitesimal motions of space the half-turn
keeps the rotation about the line and the translation along it, and reverses the other four.

If nothing is fixed and e = 3m - 4, as for a ring between two quadrilaterals (m = 4, e = 8), the
equations on reversed displacements are square, and symmetric configurations form a surface as a
rule. Where a motion in it meets the zeros of their determinant, asymmetric configurations branch
off, and Theorem 1 of docs/motion.md cannot hold.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from fractions import Fraction
from itertools import cycle

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import plural
from exactfold.motion.curves.angles import fold_angles_of
from exactfold.motion.curves.framework import Framework
from exactfold.motion.tubes.links import Link
from exactfold.pattern.crease_pattern import CreasePattern, Edge

_FOLDED_FLAT = 1e-2
"""A sheet counts as folded flat if its fold angles differ from 0 or pi by less than this, in
radians.
"""
_DEPENDENT = 1e-3
"""Lengths count as dependent if the least singular value is less than this share of the
next one.
"""
_STRESSED = 1e-4
"""Stresses of edges below this share of the largest stress count as 0."""
_LARGEST = 600
"""Stresses are looked for only if there are at most this many unknowns."""


def singular_at(labels: Sequence[int], steps: Sequence[object], reason: str) -> str:
    """Why tubes end after the last of `steps`: a description of the singular configuration there.

    `labels` are those of `singular_name`. If nothing is recognised, the given `reason` is returned.
    """
    if not steps or not isinstance(link := steps[-1], Link):
        return reason
    x = link.tube.enclosure(link.exit).floats[0]
    name = singular_name(link.tube.framework, labels, x)
    return f"{name}: motions may branch there" if name else reason


def singular_name(framework: Framework, labels: Sequence[int], unknowns: FloatArray) -> str:
    """What is singular near a configuration, as floats show it; empty if the kind is unknown.

    Vertex v of the framework is vertex `labels[v]` of the pattern. It is exact that a sheet folded
    flat at the named folds exists (`folds_flat`).

    >>> from exactfold.pattern.families import two_vertex
    >>> framework = Framework.of(two_vertex())
    >>> singular_name(framework, range(6), np.zeros(framework.size))
    'all faces come to lie in one plane, flat'
    """
    sheet, positions = framework.sheet, framework.positions(unknowns)
    angles = np.abs(fold_angles_of(positions, framework.hinges))
    closed = [fold for fold, a in zip(sheet.folds, angles, strict=True) if a > np.pi / 2]
    if np.minimum(angles, np.pi - angles).max(initial=0.0) < _FOLDED_FLAT:
        if not closed:
            return "all faces come to lie in one plane, flat"
        if folds_flat(sheet, closed):
            return (
                "all faces come to lie in one plane, folded flat, with "
                f"{_listed('fold', [_edge(labels, fold) for fold in closed])} at 180 degrees"
            )
    return _dependent(framework, labels, unknowns)


def folds_flat(sheet: CreasePattern, closed: Iterable[Edge]) -> bool:
    """Whether the sheet closes exactly with these folds at 180 degrees and all others at 0.

    It closes if, at each interior vertex, the reflections in its closed folds have the product 1.
    This means that their number is even and that u_1 conj(u_2) u_3 conj(u_4) ... is real, where the
    u are the directions of these folds, in their order, as complex numbers (Kawasaki). Layers may
    lie in any order.

    >>> from exactfold.pattern.families import single_vertex
    >>> star = single_vertex()
    >>> folds_flat(star, [(0, 4), (1, 4), (2, 4), (3, 4)]), folds_flat(star, [(0, 4), (2, 4)])
    (True, False)
    """
    closed = set(closed)
    for v in sheet.interior:
        x, y = sheet.vertices[v]
        product, number = (Fraction(1), Fraction(0)), 0
        for w, sign in zip(
            (w for w in sheet.star(v) if (min(v, w), max(v, w)) in closed),
            cycle((1, -1)),
            strict=False,
        ):
            a, b = sheet.vertices[w][0] - x, sign * (sheet.vertices[w][1] - y)
            product = product[0] * a - product[1] * b, product[0] * b + product[1] * a
            number += 1
        if number % 2 or product[1]:
            return False
    return True


def _dependent(framework: Framework, labels: Sequence[int], unknowns: FloatArray) -> str:
    """A sentence that names the vertices of a self-stress, if there is one up to its size."""
    if framework.size > _LARGEST:
        return ""
    left, sizes, _ = np.linalg.svd(framework.jacobian(unknowns).toarray())
    if not sizes[-1] < _DEPENDENT * sizes[-2]:
        return ""
    stressed = np.abs(left[:, -1]) > _STRESSED * np.abs(left[:, -1]).max()
    edges = framework.edges[stressed[: len(framework.edges)]]
    if framework.coupling.rows and stressed[len(framework.edges) :].any():
        return "the angles of the driven folds come to depend on the lengths of edges"
    if stressed[len(framework.edges) :].any():
        return "the boundary heights come to depend on the lengths of edges"
    vertices = sorted({int(v) for edge in edges for v in edge})
    names = _listed("vertex", [str(labels[v]) for v in vertices])
    turned = ""
    if half_turn(framework.sheet, vertices):
        turned = ", which a half-turn of the flat sheet maps to themselves,"
    return f"the lengths of edges between {names}{turned} come to depend on each other"


def half_turn(sheet: CreasePattern, vertices: Iterable[int]) -> bool:
    """Whether a half-turn of the plane maps these vertices and the edges between them to
    themselves.

    >>> from exactfold.pattern.families import single_vertex
    >>> star = single_vertex()
    >>> half_turn(star, [0, 1, 2, 3]), half_turn(star, [0, 1])
    (False, True)
    """
    places = {sheet.vertices[v]: v for v in vertices}
    if not places:
        return False
    (x, y) = (sum((p[a] for p in places), Fraction(0)) * 2 / len(places) for a in (0, 1))
    image = {v: places.get((x - p[0], y - p[1])) for p, v in places.items()}
    edges = {frozenset(edge) for edge in sheet.edges if image.keys() >= set(edge)}
    turned = {frozenset(image[v] for v in edge) for edge in edges}
    return None not in image.values() and turned == edges


def _edge(labels: Sequence[int], edge: Edge) -> str:
    return "-".join(str(labels[v]) for v in edge)


def _listed(noun: str, names: Sequence[str]) -> str:
    """A noun followed by its names."""
    *first, last = names
    return f"{plural(noun)} {', '.join(first)} and {last}" if first else f"{noun} {last}"
