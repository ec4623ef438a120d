"""Relations between distant edges: on a grid of angles, parallel, or mirrored."""

from __future__ import annotations

from bisect import bisect, insort
from collections.abc import Iterable, Iterator, Sequence
from itertools import islice
from math import comb, log2, pi
from typing import Final, NamedTuple

from exactfold.pattern.drawing.meant.accepted import Accepted, Trial
from exactfold.pattern.drawing.meant.drawn import Drawn
from exactfold.pattern.drawing.meant.noise import LOOKED_FOR, is_rare
from exactfold.pattern.drawing.meant.values import Edge, Relation

UNITS: Final = (*range(1, 61), 64, 72, 80, 90, 96, 120, 144, 180)
"""Grids of multiples of 180 / n degrees are tried for these n."""
_WIDEST: Final = 0.05
"""Edges whose direction is known less well, in radians, say nothing about distant ones."""
_EXACT: Final = 4
_PLAIN: Final = 2
"""Without a grid, edges may be mirrored in the axes of the drawing."""
_REFERENCES: Final = 3
_DIRECTIONS: Final = 100
_EDGES: Final = 300
"""So many directions and so many edges, the longest, are enough to choose a grid."""


class Grid(NamedTuple):
    """Directions at multiples of 180 / `unit` degrees from the axes or from a reference edge."""

    unit: int
    reference: Edge | None


def add_distant(accepted: Accepted, unit: int | None = None) -> Grid | None:
    """Accepts relations between distant edges: grid, parallel, and mirrored; returns the grid.

    Straight and border relations must have been accepted before, so that each line of the drawing
    counts once. `unit` forces a grid of 180 / `unit` degrees. Edges exactly along the axes or at 45
    degrees to them stay there in any case.
    """
    drawn = accepted.drawn
    grid = _chosen(accepted, _sure(accepted), unit)
    if grid is not None:
        accepted.believe(list(_on_grid(accepted, grid, forced=unit is not None)))
    if grid is None or grid.reference is not None or grid.unit % _EXACT:
        trials = _on_grid(accepted, Grid(_EXACT, None), forced=False)
        accepted.believe(
            [trial for trial in trials if not (trial.relation and trial.relation.defect)]
        )
    accepted.believe(list(_paired(accepted, 1, (1,), drawn, None)))
    reference = None if grid is None else grid.reference
    accepted.believe(
        list(_paired(accepted, _PLAIN if grid is None else grid.unit, (1, -1), drawn, reference))
    )
    return grid


def grid_relation(drawn: Drawn, edge: Edge, unit: int, other: Edge | None = None) -> Relation:
    """The relation that an edge is at a multiple of 180 / `unit` degrees to the axes or another."""
    terms = [(edge, 1)] if other is None else [(edge, 1), (other, -1)]
    name = f"grid:{edge[0]}-{edge[1]}" + ("" if other is None else f",{other[0]}-{other[1]}")
    return drawn.relation("grid", name, terms, drawn.turns(terms, unit).denominator)


def parallel(drawn: Drawn, edge: Edge, other: Edge) -> Relation:
    """The relation that two edges are parallel."""
    name = f"parallel:{edge[0]}-{edge[1]},{other[0]}-{other[1]}"
    return drawn.relation("parallel", name, [(edge, 1), (other, -1)])


def mirrored(
    drawn: Drawn, edge: Edge, other: Edge, unit: int = _PLAIN, reference: Edge | None = None
) -> Relation:
    """The relation that two edges are mirrored in a direction of the grid."""
    terms = [(edge, 1), (other, 1)]
    if reference is not None:
        terms.append((reference, -2))
    name = f"mirrored:{edge[0]}-{edge[1]},{other[0]}-{other[1]}"
    return drawn.relation("mirrored", name, terms, drawn.turns(terms, unit).denominator)


def _spread(accepted: Accepted, edge: Edge) -> float:
    """The angle by which an edge may be off."""
    return accepted.tolerance / accepted.drawn.lengths[edge]


def _sure(accepted: Accepted) -> list[Edge]:
    """The free edges whose directions are known well enough, the longest first."""
    return [edge for edge in accepted.free() if _spread(accepted, edge) < _WIDEST]


def _chosen(accepted: Accepted, edges: Sequence[Edge], unit: int | None) -> Grid | None:
    """The grid that explains the directions best; None if chance explains them as well."""
    units = UNITS if unit is None else (unit,)
    grids = {}
    for reference in (None, *islice(_unlike(accepted, edges, None), _REFERENCES)):
        unlike = list(islice(_unlike(accepted, edges, reference), _DIRECTIONS))
        # A turned grid has an angle of its own, which says as much as one edge on a grid.
        cost = 0.0 if reference is None else -log2(2 * _spread(accepted, reference) / pi)
        for n in units:
            grids[Grid(n, reference)] = _explained(accepted, unlike, Grid(n, reference)) - cost
    if unit is not None:
        return max(grids, key=lambda grid: grids[grid])
    for grid, bits in sorted(grids.items(), key=lambda pair: -pair[1]):
        if bits > 0 and _is_clear(accepted, edges[:_EDGES], grid):
            return grid
    return None


def _is_clear(accepted: Accepted, edges: Sequence[Edge], grid: Grid) -> bool:
    """Whether chance hardly puts as many of the longest edges on a grid up to this one."""
    expected, hits = 0.0, 0
    for edge in edges:
        if edge != grid.reference:
            off, spread, step = _off_grid(accepted, edge, grid)
            expected += min(1.0, 2 * spread / step)
            hits += off <= spread
            if is_rare(expected, hits, unlikely=LOOKED_FOR / grid.unit):
                return True
    return False


def _unlike(accepted: Accepted, edges: Iterable[Edge], reference: Edge | None) -> Iterator[Edge]:
    """The longest edge of each direction, up to the symmetries that a grid usually has.

    Mirrored directions are on a grid together. So are those that differ by a multiple of 15
    degrees, if they are not at multiples of 7.5 degrees themselves. Edges parallel to the reference
    are left out.
    """
    start = 0.0 if reference is None else accepted.drawn.angles[reference]
    seen: dict[float, list[tuple[float, Edge]]] = {pi: [], pi / 12: []}
    for edge in edges:
        angle, spread = accepted.drawn.angles[edge] - start, _spread(accepted, edge)
        period = pi if _off(angle, pi / 24) <= spread else pi / 12
        place = _off(angle, period)
        if reference is not None and _off(angle, pi) <= spread:
            continue
        if all(abs(place - other) > spread for other, _ in _around(seen[period], place)):
            insort(seen[period], (place, edge))
            yield edge


def _off(angle: float, step: float) -> float:
    """The distance of an angle from the next multiple of a step."""
    rest = angle % step
    return min(rest, step - rest)


def _off_grid(accepted: Accepted, edge: Edge, grid: Grid) -> tuple[float, float, float]:
    """By how much an edge misses a grid, by how much it may, and the step of the grid."""
    angles = accepted.drawn.angles
    start = 0.0 if grid.reference is None else angles[grid.reference]
    step = pi / grid.unit
    return _off(angles[edge] - start, step), _spread(accepted, edge), step


def _explained(accepted: Accepted, edges: Sequence[Edge], grid: Grid) -> float:
    """Minus the binary logarithm of the probability that chance puts as many edges on a grid.

    Any of the edges might have been on the grid, and any unit up to this one might have been tried.
    """
    bits, hits = -2 * log2(grid.unit), 0
    for edge in edges:
        off, spread, step = _off_grid(accepted, edge, grid)
        if off <= spread:
            bits -= log2(min(1.0, 2 * spread / step))
            hits += 1
    return bits - log2(comb(len(edges), hits))


def _on_grid(accepted: Accepted, grid: Grid, *, forced: bool) -> Iterator[Trial]:
    for edge in _sure(accepted):
        if edge == grid.reference:
            continue
        relation = grid_relation(accepted.drawn, edge, grid.unit, grid.reference)
        found = relation if relation.defect <= accepted.tolerance else None
        probability = 2 * _spread(accepted, edge) * grid.unit / pi
        yield Trial(0.0 if forced else min(1.0, probability), found)


def _paired(
    accepted: Accepted, unit: int, signs: Sequence[int], drawn: Drawn, reference: Edge | None
) -> Iterator[Trial]:
    """Looks, for each free edge, for a longer one at a multiple of pi / `unit` to it.

    The sign 1 looks for differences of two angles, and -1 for sums.
    """
    step = pi / unit
    start = 0.0 if reference is None else drawn.angles[reference]
    known: list[tuple[float, Edge]] = []
    for edge in _sure(accepted):
        if edge == reference:
            continue
        angle, spread = (drawn.angles[edge] - start) % step, _spread(accepted, edge)
        found = None
        for sign in signs:
            place = (sign * angle) % step
            near = min(
                _around(known, place), key=lambda pair: _off(pair[0] - place, step), default=None
            )
            if near is None or _off(near[0] - place, step) > spread:
                continue
            if sign < 0:
                relation = mirrored(drawn, edge, near[1], unit, reference)
            elif unit == 1:
                relation = parallel(drawn, edge, near[1])
            else:
                relation = grid_relation(drawn, edge, unit, near[1])
            if relation.defect <= accepted.tolerance:
                found = relation
                break
        yield Trial(min(1.0, len(known) * len(signs) * 2 * spread / step), found)
        if found is None:
            insort(known, (angle, edge))


def _around(known: Sequence[tuple[float, Edge]], place: float) -> list[tuple[float, Edge]]:
    """The entries next to a place, on a circle."""
    if not known:
        return []
    k = bisect(known, (place,))
    return [known[k - 1], known[k % len(known)]]
