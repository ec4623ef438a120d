"""Orders of layers by brute force, straight from what may not cross; for small maps and vertices.

Nothing here knows of constraints, pieces or solvers. Panels are put on top of each other in every
order; then every line of the image on which creases lie is looked at in a vertical section.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from itertools import permutations, product

Arc = tuple[int, int, bool]
"""Two panels joined by a crease, and whether it is folded at the end of larger positions."""


def crossing(order: Sequence[int], arcs: Sequence[Arc], through: Sequence[int]) -> bool:
    """Whether arcs that join panels at one place of the section cross each other, or a panel that
    passes this place. Arcs on different sides of the place do not meet."""
    height = {panel: k for k, panel in enumerate(order)}
    for k, (a, b, side) in enumerate(arcs):
        low, high = sorted((height[a], height[b]))
        if any(low < height[c] < high for c in through):
            return True
        for c, d, other in arcs[k + 1 :]:
            if side == other:
                inside = [low < height[panel] < high for panel in (c, d)]
                if inside[0] != inside[1]:
                    return True
    return False


def stamps(
    widths: Sequence[Fraction | int], closed: bool = False
) -> Iterator[tuple[tuple[tuple[int, int], ...], str]]:
    """Every state of folded stamps: the relations (lower, upper) of stamps that overlap.

    Each comes with its letters, those of the creases in their order. If the strip is `closed`, a
    crease joins the last stamp to the first one, as among the sectors of a vertex.
    """
    count = len(widths)
    ends: list[tuple[Fraction, Fraction]] = []
    at, step = Fraction(0), 1
    for width in widths:
        ends.append((at, at + step * width))
        at, step = at + step * width, -step
    spans = [(min(pair), max(pair)) for pair in ends]
    places = sorted({x for span in spans for x in span})
    found = set()
    for order in permutations(range(count)):
        good = True
        for place in places:
            arcs = [
                (k, (k + 1) % count, spans[k][1] == place)
                for k in range(count if closed else count - 1)
                if ends[k][1] == place
            ]
            through = [k for k in range(count) if spans[k][0] < place < spans[k][1]]
            good = good and not crossing(order, arcs, through)
        if not good:
            continue
        height = {panel: k for k, panel in enumerate(order)}
        relations = tuple(
            (i, j) if height[i] < height[j] else (j, i)
            for i in range(count)
            for j in range(i + 1, count)
            if max(spans[i][0], spans[j][0]) < min(spans[i][1], spans[j][1])
        )
        letters = "".join(
            "V" if (height[k] < height[(k + 1) % count]) == (k % 2 == 0) else "M"
            for k in range(count if closed else count - 1)
        )
        found.add((relations, letters))
    yield from found


def map_orders(rows: int, columns: int) -> Iterator[tuple[tuple[int, ...], Mapping]]:
    """Every order of the panels of a folded map, bottom first, with the letter of each crease.

    All panels (row, column) lie on one square. Its four sides are looked at one by one: creases
    between columns lie on the left or the right side, those between rows on the lower or the upper.
    """
    panels = list(product(range(rows), range(columns)))
    number = {panel: k for k, panel in enumerate(panels)}
    sides: dict[tuple[str, int], list[tuple[int, int]]] = {}
    creases = []
    for (r, c), k in number.items():
        for name, other, place in (("column", (r, c + 1), c), ("row", (r + 1, c), r)):
            if other in number:
                sides.setdefault((name, place % 2), []).append((k, number[other]))
                creases.append((k, number[other]))
    up = [(r + c) % 2 == 0 for r, c in panels]
    for order in permutations(range(len(panels))):
        height = {panel: k for k, panel in enumerate(order)}
        if any(crossing(order, [(a, b, True) for a, b in some], ()) for some in sides.values()):
            continue
        letters = {(a, b): "V" if (height[a] < height[b]) == up[a] else "M" for a, b in creases}
        yield order, letters
