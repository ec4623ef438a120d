"""Families of ways to fold, each with one motion that represents it, and the drawn letters."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED
from exactfold.app.pictures.drawn_ways import first_rates
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.motion.panels.listing import PanelWay
from exactfold.panels.result import Decomposition
from exactfold.panels.spaces.subspaces import Leaf
from exactfold.panels.vertex.stars import Star, stars
from exactfold.pattern.opening import Opened
from exactfold.pattern.panel_pattern import Edge

DRAWN: Final = "letters of the file"
DRAWN_SECONDS: Final = 20.0
"""The time for the question whether the sheet folds with the letters of the file."""
_TRIES: Final = 60
_ZERO: Final = 1e-9
_MOST_CORRECTIONS: Final = 30


@dataclass(frozen=True)
class Representative:
    """A direction to first order in which a sheet is proved to fold.

    `densities` are fold angle / length, nearly. `dimension` is that of the family which the
    direction represents; None if it is not known. `why` says what is proved of it.
    """

    name: str
    densities: Mapping[Edge, float]
    dimension: int | None
    why: str


def representative(
    way: PanelWay, ways: Decomposition, letters: Mapping[Edge, str]
) -> Representative | None:
    """A direction in which a way folds that bends in spaces of motions; None if none is found.

    Among the directions of a family one is chosen that has many of the `letters` of the file.
    """
    densities = {fold: -1.0 if letters.get(fold) == "M" else 1.0 for fold in way.free}
    for mode in way.modes:
        densities |= first_rates(mode)
    moving = stars(ways.pattern, ways.held)
    motions = {id(one.leaf): one.motion for part in ways.parts for one in part.found}
    for leaf in way.spaces:
        if id(leaf) in motions:
            densities |= {edge: float(x.mid()) for edge, x in motions[id(leaf)].items()}
            continue
        point = _point_of(leaf, moving, letters)
        if point is None:
            return None
        densities |= point
    return Representative(
        f"way {way.number}",
        densities,
        way.dimension,
        "it truly folds: true motions start in this direction",
    )


def drawn_motion(
    opened: Opened, clock: Clock, letters: Mapping[Edge, str] | None = None
) -> Representative | None:
    """The motion with the letters of the file, or with others, if true motions provably have them.

    None if the sheet is doubted, or if no such motion is found in time.
    """
    from exactfold.design.panels.match import match_panels

    asked = opened.letters if letters is None else letters
    if opened.doubt or not {"M", "V"}.intersection(asked.values()):
        return None
    matched = match_panels(opened, asked, clock=clock)
    if matched.truly is not PROVED or not matched.densities:
        return None
    return Representative(
        DRAWN, matched.densities, None, "true motions begin with the letters of the file"
    )


def side_with(letters: str, drawn: str) -> int:
    """On which side a way has the mountains and valleys of the file: 1, -1, or 0 for none.

    >>> side_with("MVMV", "MVUU"), side_with("MVMV", "VMUU"), side_with("MVMV", "MMUU")
    (1, -1, 0)
    """
    wanted = [(k, letter) for k, letter in enumerate(drawn) if letter != "U"]
    if not any(letter in "MV" for _, letter in wanted):
        return 0
    for side, seen in ((1, letters), (-1, letters.translate(UPSIDE_DOWN))):
        if all(seen[k] == letter for k, letter in wanted):
            return side
    return 0


def _point_of(
    leaf: Leaf, moving: Mapping[int, Star], letters: Mapping[Edge, str]
) -> Mapping[Edge, float] | None:
    """A direction in a leaf that has many of the letters and bends every fold, in floats."""
    edges = sorted(leaf.rows)
    rows = np.array([[float(x) for x in leaf.rows[edge]] for edge in edges])
    wish = np.array([{"M": -1.0, "V": 1.0}.get(letters.get(edge, ""), 0.0) for edge in edges])
    if leaf.motion:
        w = np.array([float(sum(leaf.densities[edge])) for edge in edges])
        side = -1.0 if (np.sign(w) * wish).sum() < 0 else 1.0
        return dict(zip(edges, (side * w / np.abs(w).max()).tolist(), strict=True))
    forms = [_form(moving[v], edges, rows) for v in leaf.vertices]
    generator = np.random.default_rng(0)
    starts = [np.linalg.lstsq(rows, wish, rcond=None)[0]] if wish.any() else []
    starts += [generator.normal(size=leaf.size) for _ in range(_TRIES)]
    best: tuple[tuple[float, float], FloatArray] | None = None
    for start in starts:
        point = _on_forms(start, forms)
        if point is None:
            continue
        w = rows @ point
        largest = float(np.abs(w).max())
        if not largest:
            continue
        for side in (1.0, -1.0) if wish.any() else (1.0,):
            agreeing = float((np.sign(side * w) == wish)[wish != 0].sum())
            worth = (agreeing, float(np.abs(w).min()) / largest)
            if best is None or worth > best[0]:
                best = worth, side * w / largest
    return None if best is None else dict(zip(edges, best[1].tolist(), strict=True))


def _form(star: Star, edges: Sequence[Edge], rows: FloatArray) -> FloatArray:
    """The symmetric matrix of the second-order condition at a vertex, in the parameters."""
    at = {edge: k for k, edge in enumerate(edges)}
    size = rows.shape[1]
    matrix = np.zeros((size, size))
    for j, (fold, (x, y)) in enumerate(zip(star.folds, star.directions, strict=True)):
        for other, (u, v) in zip(star.folds[:j], star.directions[:j], strict=True):
            if fold in at and other in at:
                weight = float(u) * float(y) - float(v) * float(x)
                matrix += weight * np.outer(rows[at[fold]], rows[at[other]])
    return np.asarray((matrix + matrix.T) / 2)


def _on_forms(start: FloatArray, forms: Sequence[FloatArray]) -> FloatArray | None:
    """Parameters near the start at which all forms vanish, by Newton's method; None if it fails."""
    point = start / (np.linalg.norm(start) or 1.0)
    if not forms:
        return np.asarray(point)
    for _ in range(_MOST_CORRECTIONS):
        values = np.array([point @ form @ point for form in forms])
        if np.abs(values).max() < _ZERO**1.5 * max(float(np.abs(form).max()) for form in forms):
            return np.asarray(point)
        slopes = np.array([2 * form @ point for form in forms])
        point = point - np.linalg.lstsq(slopes, values, rcond=None)[0]
        size = float(np.linalg.norm(point))
        if not 0.1 < size < 10:
            return None
    return None
