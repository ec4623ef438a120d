"""Fold angles of the modes of small meshes, in floating point, by trying all local modes."""

from __future__ import annotations

from itertools import product

import numpy as np

from exactfold.pattern.panel_pattern import PanelPattern


def local_modes(directions: np.ndarray) -> list[np.ndarray]:
    """The densities w with sum w_j d_j = 0 and K(w) = 0 of four folds, and no motion."""
    basis = np.linalg.svd(directions.T)[2][2:]
    cross = np.array([[np.linalg.det([a, b]) for b in directions] for a in directions])
    form = basis @ (np.triu(cross, 1) + np.triu(cross, 1).T) @ basis.T
    values, vectors = np.linalg.eigh(form)  # one is negative and one is positive
    low, high = np.sqrt(np.abs(values))
    lines = [np.array([high, low]), np.array([high, -low])]
    modes = [vectors @ line @ basis for line in lines]
    return [np.where(np.abs(w) < 1e-9 * np.abs(w).max(), 0, w) for w in modes] + [np.zeros(4)]


def elementary_modes(pattern: PanelPattern) -> list[np.ndarray]:
    """The unit vectors of fold angles of all modes of a sheet with four folds at each vertex."""
    points = np.array([[float(x), float(y)] for x, y in pattern.vertices])
    around = {}
    for v in pattern.interior:
        ends = sorted(
            (np.arctan2(*(points[u] - points[v])[::-1]), u)
            for fold in pattern.folds
            for u in fold
            if v in fold and u != v
        )
        around[v] = [u for _, u in ends]
    lengths = {f: np.linalg.norm(points[f[1]] - points[f[0]]) for f in pattern.folds}
    locals_ = [
        local_modes(np.array([points[u] - points[v] for u in around[v]])) for v in pattern.interior
    ]
    found = []
    for choice in product(*locals_):
        motions = _joined(pattern, around, dict(zip(pattern.interior, choice, strict=True)))
        if len(motions) == 1:  # connected, and not flat
            [w] = motions
            angles = np.array([w.get(f, 0.0) * lengths[f] for f in pattern.folds])
            angles /= np.linalg.norm(angles)
            found.append(angles)
    return found


def _joined(pattern, around, choice):
    """The motions, one for each connected set of active vertices; none if they do not agree."""
    left = {v for v, w in choice.items() if w.any()}
    motions = []
    while left:
        v = min(left)
        known, waiting, done = {}, [(v, 1.0)], set()
        while waiting:
            v, scale = waiting.pop()
            if v in done:
                continue
            done.add(v)
            for u, w in zip(around[v], choice[v], strict=True):
                fold = (min(u, v), max(u, v))
                if abs(known.setdefault(fold, scale * w) - scale * w) > 1e-7 * abs(scale):
                    return []
                if u in choice and w:
                    back = choice[u][around[u].index(v)]
                    if not back:
                        return []
                    waiting.append((u, scale * w / back))
        left -= done
        motions.append({fold: w for fold, w in known.items() if w})
    return motions
