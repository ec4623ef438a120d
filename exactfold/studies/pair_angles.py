"""Angles between lines, counted in bins with proof that each pair is in its bin."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exactfold.arrays import FloatArray, IntArray
from exactfold.studies.lines import Lines

BINS = 64
"""Bins of width pi / 128 from 0, parallel, to pi / 2, orthogonal."""

_ROWS = 512
_U = 2.0**-53
_WIDTH = np.pi / 2 / BINS


@dataclass(frozen=True)
class PairAngles:
    """How many pairs of different branches have an angle in each bin.

    `unclear` of these may be in the next bin, as bounds did not tell. `mean_square` approximates
    the mean of cos^2 of the angle, 0 if there are no pairs.
    """

    bins: tuple[int, ...]
    unclear: int
    mean_square: float


def pair_angles(lines: Lines) -> PairAngles:
    """The angles between all pairs of branches, as lines in the space of fold angles.

    |u . v| as computed is within t = e_u + e_v + (F + 4) u of the true cosine. A pair is in its bin
    if the cosines of both edges are further away than t; where they are not, u and v are computed
    anew from sharper roots.

    >>> from exactfold.pattern.families import single_vertex
    >>> found = pair_angles(Lines.of(single_vertex(4)))
    >>> sum(found.bins), found.bins.index(1), found.unclear
    (1, 63, 0)
    """
    directions, errors = lines.directions, lines.errors
    count, size = directions.shape
    bins: IntArray = np.zeros(BINS, dtype=np.int64)
    if count < 2:
        return PairAngles(tuple(bins.tolist()), 0, 0.0)
    edges = np.cos(np.arange(BINS + 1) * _WIDTH)
    slack = 2.0 * float(errors.max()) + (size + 4) * _U
    # d(angle) = d(cos) / sin, and no edge but 0 has a smaller sine than the first.
    near = 2.0 * slack / np.sin(_WIDTH) / _WIDTH + 1e-12
    doubtful: list[tuple[int, int, int]] = []
    for start in range(0, count, _ROWS):
        part = directions[start : start + _ROWS]
        later = np.arange(start, count)[None, :] > np.arange(start, start + len(part))[:, None]
        cosines = np.minimum(np.abs(part @ directions[start:].T), 1.0)
        places = np.arccos(cosines) / _WIDTH
        found = np.minimum(places, BINS - 0.5).astype(np.int64)
        bins += np.bincount(found[later], minlength=BINS)
        edge = np.rint(places)
        close = later & (np.abs(places - edge) <= near) & (edge > 0) & (edge < BINS)
        rows, columns = np.nonzero(close)
        triples = (rows + start).tolist(), (columns + start).tolist(), found[close].tolist()
        doubtful += zip(*triples, strict=True)
    unclear = 0
    for i, j, before in doubtful:
        after, certain = _bin(directions[[i, j]], errors[[i, j]], edges)
        if not certain:
            after, certain = _bin(*lines.sharper([i, j]), edges)
        bins[before] -= 1
        bins[after] += 1
        unclear += not certain
    gram = directions.T @ directions
    square = (float((gram**2).sum()) - count) / (count * (count - 1))
    return PairAngles(tuple(bins.tolist()), unclear, square)


def _bin(pair: FloatArray, errors: FloatArray, edges: FloatArray) -> tuple[int, bool]:
    """The bin of the angle of two lines, and whether it is certain."""
    cosine = abs(float(pair[0] @ pair[1]))
    reach = float(errors.sum()) * (1.0 + 2.0**-20) + (pair.shape[1] + 8) * _U
    inner = edges[1:BINS]
    clear = not bool((np.abs(inner - cosine) <= reach).any())
    return int((cosine <= inner).sum()), clear
