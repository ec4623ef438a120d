"""Small sheets of panels, and what holds of every frame of a motion, by other formulas."""

from itertools import product
from math import acos, pi

import numpy as np
from panel_sheets import (
    grid,
    outlined,
)


def one_vertex(*tips):
    """A vertex at the origin with a fold to each of these points, on the hull of the points."""
    return outlined([(0, 0), *tips], [(0, k + 1) for k in range(len(tips))], 1)


def strip(widths, height=2):
    """Panels side by side, with a fold from boundary to boundary between neighbours."""
    xs = [sum(widths[:k]) for k in range(len(widths) + 1)]
    return grid(len(widths), 1, lambda i, j: (xs[i], height * j))


def sectors(pattern, v):
    """The sector angles at a vertex, the k-th from fold k to the next."""
    at = np.array([float(c) for c in pattern.vertices[v]])
    around = [np.array([float(c) for c in pattern.vertices[u]]) - at for u in pattern.stars[v]]
    units = [d / np.linalg.norm(d) for d in around]
    return [acos(float(units[k] @ units[(k + 1) % len(units)])) for k in range(len(units))]


def turned(axis, angle):
    """A rotation, from the exponential series of its generator."""
    x, y = axis
    generator = angle * np.array([[0, 0, y], [0, 0, -x], [-y, x, 0]])
    total, term = np.eye(3), np.eye(3)
    for k in range(1, 40):
        term = term @ generator / k
        total = total + term
    return total


def open_by(pattern, angles):
    """How far the rotations round each interior vertex are from composing to the identity."""
    columns = {fold: k for k, fold in enumerate(pattern.folds)}
    worst = 0.0
    for v, around in pattern.stars.items():
        total = np.eye(3)
        for u in around:
            d = np.array([float(c) for c in pattern.direction(v, u)])
            fold = angles[columns[min(u, v), max(u, v)]]
            total = total @ turned(d / np.linalg.norm(d), fold)
        worst = max(worst, float(np.abs(total - np.eye(3)).max()))
    return worst


def checked(motion):
    """Closed vertices, rigid panels, and fold angles as they are in space, in every frame."""
    pattern = motion.pattern
    size = float(np.ptp(motion.coords[0], axis=0).max())
    assert motion.residual < 1e-12
    assert motion.gap < 1e-12 * size
    assert max(open_by(pattern, row) for row in motion.angles[::5]) < 1e-12
    assert not motion.angles[0].any()
    assert np.abs(motion.coords[0][:, 2]).max() == 0
    flat = motion.coords[0]
    columns = {fold: k for k, fold in enumerate(pattern.folds)}
    normals = []
    for face in pattern.faces:
        corners = list(face)
        before = np.linalg.norm(flat[corners][:, None] - flat[corners][None], axis=2)
        for coords in motion.coords:
            after = np.linalg.norm(coords[corners][:, None] - coords[corners][None], axis=2)
            assert np.abs(after - before).max() < 1e-12 * size
        normals.append(np.array([newell(coords[corners]) for coords in motion.coords]))
    for (i, j), k in columns.items():
        left, right = (normals[pattern.sides[half]] for half in ((i, j), (j, i)))
        axis = motion.coords[:, j] - motion.coords[:, i]
        axis /= np.linalg.norm(axis, axis=1)[:, None]
        # A valley turns the normal of the left face about the fold, from that of the right one.
        sine = (np.cross(right, left) * axis).sum(axis=1)
        found = np.arctan2(sine, (left * right).sum(axis=1))
        off = (found - motion.angles[:, k] + pi) % (2 * pi) - pi
        assert np.abs(off).max() < 1e-11
    return motion


def newell(corners):
    """The unit normal of a polygon in space."""
    total = np.cross(corners, np.roll(corners, -1, axis=0)).sum(axis=0)
    return total / np.linalg.norm(total)


def angle(motion, fold, frame=-1):
    return motion.angles[frame, motion.pattern.folds.index(tuple(sorted(fold)))]


def lengths_kept(pattern, spots):
    """Whether all distances inside panels are kept exactly."""
    for face in pattern.faces:
        for i, j in product(face, face):
            ends = pattern.vertices[i], pattern.vertices[j]
            if squared(*ends) != squared(spots[i], spots[j]):
                return False
    return True


def squared(one, other):
    return sum((a - b) * (a - b) for a, b in zip(one, other, strict=True))
