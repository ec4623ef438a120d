"""Sheets with more than four corners, and a second way to their pieces: shapes over many rims."""

from __future__ import annotations

from itertools import product

import networkx as nx
import numpy as np

from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.curvature import curvature_form
from exactfold.rigidity.functionals import vertex_sign_functional


def faces(text: str) -> list[tuple[int, ...]]:
    """Triangles from their digits."""
    return [tuple(int(c) for c in word) for word in text.split()]


FOUR_CIRCLES = CreasePattern(
    [(-3, -4), (5, 2), (5, -1), (-2, -3), (0, -1), (3, 4), (-4, 1)],
    faces("023 036 142 154 243 346 456"),
)
"""D = 2, vertex 3 of degree 4: D >= deg - 2, and its star is never flat all the same."""

NEVER_FLAT = CreasePattern(
    [
        *((9, 10), (-8, 14), (-21, 1), (6, -15), (19, 4)),
        *((6, -6), (-12, 9), (1, -12), (8, -11), ("3/4", -5)),
    ],
    faces("126 237 348 387 015 054 458 165 569 276 679 598 789"),
)
"""D = 2, the star of vertex 9 is a convex quadrilateral, and other folds bend if it is flat."""

TUNED_ANTIPRISM = CreasePattern(
    [
        *(("-201/16", "99/16"), ("3/4", "-171/28"), ("201/16", "-99/16"), ("-3/4", "171/28")),
        *((0, -3), (3, 0), (0, 3), (-3, 0), (0, 0)),
    ],
    faces("014 154 125 265 236 376 307 047 458 568 678 748"),
)
"""D = 1: with the star of vertex 8 flat the densities fit round it, and the fold angles do not."""


def joined_by_shapes(pattern: CreasePattern, angles: int = 720) -> int:
    """Pieces for D = 2 in floating point: shapes over the circle of rims, and where stars flatten.

    The shape over a rim with signs e is the zero of l_v - e_v |A_v h| (docs/mathematics.md,
    Nappes), found by Newton's method for all angles at once. Along the circle l_v touches 0 like
    the distance from an angle; so a local minimum is a joint if it is small, after refinement.
    """
    inner, rim = pattern.interior, pattern.boundary[3:]
    circle = np.linspace(0, 2 * np.pi, angles, endpoint=False)
    graph = nx.Graph()
    for signs in product((1, -1), repeat=len(inner)):
        graph.add_node(signs)
        sizes = _sizes(pattern, signs, circle, inner, rim)
        for k in range(len(inner)):
            if _touches(pattern, signs, k, circle, sizes[:, k], inner, rim):
                graph.add_edge(signs, (*signs[:k], -signs[k], *signs[k + 1 :]))
    return int(nx.number_connected_components(graph))


def _sizes(pattern, signs, angles, inner, rim):
    """|l_v| of each vertex, over the size of the heights, at each angle."""
    labels = [*inner, *rim]
    rows, forms = [], []
    for v in inner:
        form = curvature_form(pattern, v)
        matrix = np.zeros((len(labels), len(labels)))
        for a, left in zip(form.labels, form.matrix, strict=True):
            for b, x in zip(form.labels, left, strict=True):
                if a in labels and b in labels:
                    matrix[labels.index(a), labels.index(b)] = float(x)
        read = vertex_sign_functional(pattern, v)
        row = np.array([float(read.get(u, 0)) for u in labels])
        # l^2 - K is semidefinite if K(t, .) is divided by the root of K(t, t).
        values, vectors = np.linalg.eigh(matrix)
        inverse = vectors @ np.diag([1 / x if abs(x) > 1e-9 else 0 for x in values]) @ vectors.T
        rows.append(row / np.sqrt(row @ inverse @ row))
        forms.append(np.outer(rows[-1], rows[-1]) - matrix)
    lines, norms, signs = np.array(rows), np.array(forms), np.array(signs)
    n = len(inner)
    h = np.zeros((len(angles), len(labels)))
    h[:, n:] = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    h[:, :n] = np.linalg.solve(lines[:, :n], (3 * signs - h[:, n:] @ lines[:, n:].T).T).T
    for _ in range(60):
        bends = np.einsum("vij,aj->avi", norms, h)
        length = np.sqrt(np.maximum(np.einsum("avi,ai->av", bends, h), 1e-30))
        value = h @ lines.T - signs * length
        slope = lines[None, :, :n] - (signs / length)[:, :, None] * bends[:, :, :n]
        step = np.linalg.solve(slope, value[:, :, None])[:, :, 0]
        h[:, :n] -= step
        if np.abs(step).max() < 1e-13:
            break
    return np.abs(h @ lines.T) / np.abs(h).max(axis=1)[:, None]


def _touches(pattern, signs, k, circle, sizes, inner, rim):
    width = circle[1] - circle[0]
    for at in np.flatnonzero((sizes <= np.roll(sizes, 1)) & (sizes <= np.roll(sizes, -1))):
        low, high = circle[at] - width, circle[at] + width
        for _ in range(6):
            angles = np.linspace(low, high, 21)
            found = _sizes(pattern, signs, angles, inner, rim)[:, k]
            best = angles[int(found.argmin())]
            low, high = best - (high - low) / 18, best + (high - low) / 18
        if found.min() < 1e-6:
            return True
    return False
