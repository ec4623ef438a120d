"""Loops of folds that nearly close.

The coordinates of the drawing may be rounded; snapping them may close such loops.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Any, Final, TypedDict

import networkx as nx
from flint import ctx

from exactfold._support.documents import FoldText, Natural
from exactfold.errors import ExactfoldError
from exactfold.panels.densities import Density, Roots, UndecidedDensityError
from exactfold.panels.local import LocalMode, local_modes
from exactfold.panels.stars import edge_of, stars
from exactfold.pattern.panel_pattern import Edge, PanelPattern

NEAR: Final = 1e-6
"""A product that is not 1 but differs from 1 by less than this is a near miss."""
RECORDED: Final = 1e-3
"""On an inexact sheet, loops that close up to a multiple of its noise are near misses, too; loops
are recorded up to this."""
_TIMES_NOISE: Final = 100
SNAPS: Final = ("auto", 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 15, 16, 20, 24, 30, 32, 48, 60, 64, 100)
"""The snaps that are tried, in this order; they are values of `--snap`."""
_BITS: Final = 256
_FARTHEST: Final = 1e-4
_MOST_VERTICES: Final = 400
_MOST_MISSES: Final = 16

Reopened = Callable[[Any], tuple[PanelPattern, float]]
"""Reads the sheet with another snap; returns it and the largest move of a coordinate over
the size.
"""


class NearMissDocument(TypedDict):
    """A loop of folds that nearly closes."""

    fold: FoldText
    quotient: float
    """The product of the gains round the loop, which is near to 1 and not 1."""
    loop: list[Natural]
    """The vertices of the loop."""
    off: float
    """The distance of the quotient from 1."""
    snap: str | None
    """The first value of --snap that closes the loop exactly; null if none of those tried does."""
    largest_move: float | None
    """How far that snap moves a coordinate, by the size of the sheet."""
    tried: list[str]
    """The values of --snap that were tried, in their order."""


@dataclass(frozen=True)
class NearMiss:
    """A loop whose product of gains is not 1 but within 1e-6 of 1.

    `loop` are its vertices; the first two are the ends of `fold`. `modes` are the local modes at
    these vertices. `quotient` is the product, and `off` its distance from 1. `snap` is the first
    snap in `tried` that closes the loop exactly, and `largest_move` is how far it moves a
    coordinate, divided by the size of the sheet. Both are None if no snap closes the loop or none
    was tried.
    """

    fold: Edge
    quotient: float
    off: float
    loop: tuple[int, ...]
    modes: tuple[LocalMode, ...]
    snap: str | int | None = None
    largest_move: float | None = None
    tried: tuple[str | int, ...] = ()

    def to_dict(self) -> NearMissDocument:
        """The object of this near miss in the JSON output."""
        return {
            "fold": f"{self.fold[0]}-{self.fold[1]}",
            "quotient": self.quotient,
            "loop": list(self.loop),
            "off": self.off,
            "snap": None if self.snap is None else str(self.snap),
            "largest_move": self.largest_move,
            "tried": [str(snap) for snap in self.tried],
        }

    @property
    def text(self) -> str:
        """The near miss and its remedy in words."""
        shown = "-".join(map(str, (*self.loop, self.loop[0])))
        start = f"the loop of folds {shown} nearly closes, off by {self.off:.1e}: "
        if self.snap is not None:
            return (
                f"{start}--snap {self.snap} closes it (largest move {self.largest_move:.1g} of "
                "the size)"
            )
        if self.tried:
            return start + "none of the snaps that were tried closes it"
        return start + "the coordinates of the drawing may be rounded (try --snap auto)"


def near_limit(noise: float | None) -> float:
    """The distance from 1 below which a product that is not 1 is a near miss.

    `noise` is the noise level of the drawing, None for an exact one.
    """
    return max(NEAR, _TIMES_NOISE * (noise or 0.0))


def near_miss(
    chosen: Iterable[LocalMode], mode: LocalMode, start: Edge, end: Edge, quotient: Density
) -> NearMiss:
    """The loop that a local mode would close, from its fold `end` back to its fold `start`.

    `chosen` are the local modes so far; active folds join them.
    """
    known = {other.vertex: other for other in chosen}
    graph = nx.Graph()
    for v, other in known.items():
        graph.add_edges_from(fold for fold in other.folds if set(fold) <= known.keys())
        graph.add_node(v)
    first, last = (sum(fold) - mode.vertex for fold in (end, start))
    around = nx.shortest_path(graph, first, last)
    modes = (mode, *(known[v] for v in around))
    before = ctx.prec
    ctx.prec = _BITS
    try:
        off = float(abs(quotient.ball(_BITS) - 1))
    finally:
        ctx.prec = before
    return NearMiss(end, quotient.approx, off, (mode.vertex, *around), modes)


def snapped_misses(
    misses: Sequence[NearMiss], pattern: PanelPattern, reopened: Reopened
) -> tuple[NearMiss, ...]:
    """The near misses, each with the first snap of `SNAPS` that closes it, if one does.

    `reopened` reads the sheet again. Denominators are tried for sheets with up to 400 vertices, and
    accepted if no coordinate moves by more than 1e-4 of the size. A snap that changes the edges of
    the sheet closes nothing. Only the first 16 near misses are tried.
    """
    open_ones = dict(enumerate(misses[:_MOST_MISSES]))
    snapped = list(misses)
    tried: tuple[str | int, ...] = ()
    for snap in SNAPS if len(pattern.vertices) <= _MOST_VERTICES else SNAPS[:1]:
        if not open_ones:
            break
        tried += (snap,)
        try:
            sheet, move = reopened(snap)
        except ExactfoldError:
            continue
        if move > _FARTHEST or sheet.edges != pattern.edges:
            continue
        for k, miss in list(open_ones.items()):
            if closes(sheet, miss):
                snapped[k] = replace(miss, snap=snap, largest_move=move, tried=tried)
                del open_ones[k]
    for k, miss in open_ones.items():
        snapped[k] = replace(miss, tried=tried)
    return tuple(snapped)


def closes(sheet: PanelPattern, miss: NearMiss) -> bool:
    """Whether the product round the loop is exactly 1 on a sheet with the same edges.

    At each vertex, the local mode with the same active folds and the nearest gain is used.
    """
    moving = stars(sheet)
    roots = Roots(sheet.field)
    total = roots.density(Fraction(1))
    for k, (v, old) in enumerate(zip(miss.loop, miss.modes, strict=True)):
        before = edge_of(v, miss.loop[k - 1])
        after = edge_of(v, miss.loop[(k + 1) % len(miss.loop)])
        star = moving.get(v)
        if star is None or len(star.folds) > 4:
            return False
        gains = [mode.gain(before, after) for mode in local_modes(star) if mode.folds == old.folds]
        if not gains:
            return False
        wanted = float(old.gain(before, after))
        total = total.times(roots.density(min(gains, key=lambda g: abs(float(g) - wanted))))
    try:
        return total.is_one()
    except UndecidedDensityError:
        return False
