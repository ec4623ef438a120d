"""Which folds can follow their letters together to first order, and which never can.

The motions here (docs/assignment.md) are those of the folds that the flat closure leaves. They
satisfy sum_k w_k d_k = 0 at each vertex, and no fold goes against its letter.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..core.reading import items, natural, require
from ..core.towers import Number
from ..sheets.panels import Edge, Near, PanelSheet, pair, read_edges
from .panels_refuted import SIDES, numbers


def check_never(
    sheet: PanelSheet, near: Near, wanted: Mapping[Edge, str], claimed: Any, steps: list[Any]
) -> bool:
    """Verify that the claimed folds stay flat in all first-order motions that respect the letters.

    The evidence is a list of steps, and a step gives a vector at some vertices. The vectors add up
    to a sum at each fold. A sum must be 0 at a fold without a letter, and must not have the side of
    the letter at other folds. Where the sum is not 0, the fold stays flat, and later steps may have
    any sum at this fold. Returns whether all folds with a letter that are shown to stay flat are
    claimed.
    """
    live = {pair(v, u) for v, around in near.items() for u in around}
    flat = {e for e in wanted if e not in live and not sheet.boundary_set.issuperset(e)}
    for number, step in enumerate(steps):
        total: dict[Edge, Number] = {}
        for v, values in items(step, "a step"):
            x, y = numbers(sheet, values, 2)
            for u in near[natural(v, "a vertex")]:
                a, b = sheet.vector(v, u)
                fold, value = pair(v, u), x * a + y * b
                total[fold] = total[fold] + value if fold in total else value
        for (i, j), value in total.items():
            if (i, j) not in flat:
                agrees = value.sign() in (0, -SIDES.get(wanted[i, j], 0))
                require(agrees, f"step {number}: the sum at fold {i}-{j} has the wrong sign")
        flat |= {fold for fold, value in total.items() if value.sign()}
    never = read_edges(claimed, "never")
    for i, j in never:
        require((i, j) in flat, f"fold {i}-{j} is not proved to stay flat")
        require(wanted[i, j] in SIDES, f"fold {i}-{j} is not asked to be a mountain or a valley")
    return {fold for fold in flat if wanted[fold] in SIDES}.issubset(never)


def check_together(
    sheet: PanelSheet, near: Near, wanted: Mapping[Edge, str], claimed: Any, given: list[Any]
) -> bool:
    """Verify a first-order motion in which all claimed folds follow their letters.

    Returns whether the claimed folds are complete: all folds with a letter that follow it in this
    motion, and all that lie from boundary to boundary, which can always follow it.
    """
    live = {pair(v, u) for v, around in near.items() for u in around}
    densities: dict[Edge, Number] = {}
    for entry in given:
        *ends, value = items(entry, "a density", 3)
        i, j = (natural(v, "a vertex") for v in ends)
        require((i, j) in live, f"fold {i}-{j} has a density, but is flat or in no condition")
        (densities[i, j],) = numbers(sheet, [value], 1)
        against = densities[i, j].sign() == -SIDES.get(wanted[i, j], 0) != 0
        require(not against, f"fold {i}-{j} goes against its letter")
    for v, around in near.items():
        for axis in (0, 1):
            total = sheet.tower.number(0)
            for u in around:
                if pair(v, u) in densities:
                    total = total + densities[pair(v, u)] * sheet.vector(v, u)[axis]
            require(total.sign() == 0, f"the folds at vertex {v} do not close")
    zero = sheet.tower.number(0)
    going = {
        fold
        for fold, letter in wanted.items()
        if letter in SIDES
        and (sheet.boundary_set.issuperset(fold) or densities.get(fold, zero).sign())
    }
    together = read_edges(claimed, "together")
    for i, j in together:
        require((i, j) in going, f"fold {i}-{j} does not follow its letter")
    return going.issubset(together)
