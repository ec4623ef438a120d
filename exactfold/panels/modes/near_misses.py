"""Loops of folds that nearly close, perhaps because the coordinates of the drawing are rounded."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Final, TypedDict

import networkx as nx
from flint import ctx

from exactfold._support.documents import FoldText, Natural
from exactfold.panels.modes.densities import Density
from exactfold.panels.vertex.local import LocalMode
from exactfold.pattern.panel_pattern import Edge

NEAR: Final = 1e-6
"""A product that is not 1 but differs from 1 by less than this is a near miss."""
RECORDED: Final = 1e-3
"""On an inexact sheet, loops that close up to a multiple of its noise are near misses, too; loops
are recorded up to this."""
_TIMES_NOISE: Final = 100
_CHANCE: Final = 0.01
"""Of decimals nobody knows how far they were rounded. That one of n loops of unrelated folds closes
up to `_CHANCE` / n has about this probability."""
MOST_LOOPS: Final = round(_CHANCE / NEAR)
"""Among more loops, `NEAR` is nearer than chance explains."""
_BITS: Final = 256


class NearMissDocument(TypedDict):
    """A loop of folds that nearly closes."""

    fold: FoldText
    """Where the loop does not close."""
    quotient: float
    """The product of the gains round the loop, which is near to 1 and not 1."""
    loop: list[Natural]
    """The vertices of the loop."""
    off: float
    """The distance of the quotient from 1."""


@dataclass(frozen=True)
class NearMiss:
    """A loop whose product of gains is not 1 but near 1.

    `loop` are its vertices; the first two are the ends of `fold`. `modes` are the local modes at
    these vertices. `quotient` is the product, and `off` its distance from 1.
    """

    fold: Edge
    quotient: float
    off: float
    loop: tuple[int, ...]
    modes: tuple[LocalMode, ...]

    def to_dict(self) -> NearMissDocument:
        """The object of this near miss in the JSON output."""
        return {
            "fold": f"{self.fold[0]}-{self.fold[1]}",
            "quotient": self.quotient,
            "loop": list(self.loop),
            "off": self.off,
        }

    @property
    def text(self) -> str:
        """The near miss in words."""
        shown = "-".join(map(str, (*self.loop, self.loop[0])))
        return f"the loop of folds {shown} nearly closes, off by {self.off:.1e}"


def near_limit(noise: float | None, loops: int = 0) -> float:
    """The distance from 1 below which a product that is not 1 is a near miss.

    `noise` is the noise level of the drawing, None if it is not known. `loops` is the number of
    loops that were found not to close if the coordinates are decimals that may be rounded, else 0.

    >>> near_limit(None), near_limit(1e-8), near_limit(None, 1000)
    (1e-06, 1e-06, 1e-05)
    """
    chance = min(RECORDED, _CHANCE / loops) if loops else 0.0
    return max(NEAR, _TIMES_NOISE * (noise or 0.0), chance)


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
