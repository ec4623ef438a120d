"""The space of first-order motions of a sheet of panels, exactly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import TypeAlias

from exactfold.exact.surds import Number, exact
from exactfold.modes.stars import Star
from exactfold.pattern.panel_pattern import Edge

Rows: TypeAlias = dict[Edge, Sequence[Number]]
"""The density of each fold as a linear function of parameters; folds that are flat left out."""


def first_order(stars: Mapping[int, Star]) -> tuple[Rows, int]:
    """The first-order motions `sum_j w_j d_j = 0` at all vertices, in parameters, and their number.

    Conditions are eliminated one by one; each parameter is the density of one fold.

    >>> star = Star(0, ((0, 1), (0, 2)), ((1, 0), (-2, 0)))
    >>> first_order({0: star})
    ({(0, 1): [Fraction(2, 1)], (0, 2): [Fraction(1, 1)]}, 1)
    """
    pivots: dict[Edge, dict[Edge, Number]] = {}
    users: dict[Edge, set[Edge]] = {}
    for star in stars.values():
        for axis in (0, 1):
            row: dict[Edge, Number] = {}
            for edge, direction in zip(star.folds, star.directions, strict=True):
                if direction[axis] != 0:
                    _add(row, edge, direction[axis], pivots)
            if not row:
                continue
            pivot = min(row, key=lambda edge: (len(users.get(edge, ())), edge))
            scale = exact(row.pop(pivot))
            solved: dict[Edge, Number] = {edge: -x / scale for edge, x in row.items()}
            for user in users.pop(pivot, set()):
                weight = pivots[user].pop(pivot)
                for edge, x in solved.items():
                    _increase(pivots[user], edge, weight * x)
                    if edge in pivots[user]:
                        users.setdefault(edge, set()).add(user)
                    else:
                        users.get(edge, set()).discard(user)
            pivots[pivot] = solved
            for edge in solved:
                users.setdefault(edge, set()).add(pivot)
    folds = sorted({edge for star in stars.values() for edge in star.folds})
    free = [edge for edge in folds if edge not in pivots]
    place = {edge: k for k, edge in enumerate(free)}
    rows: Rows = {}
    for edge in folds:
        entries = pivots.get(edge, {edge: Fraction(1)})
        vector: list[Number] = [Fraction(0)] * len(free)
        for other, x in entries.items():
            vector[place[other]] = x
        if entries:
            rows[edge] = vector
    return rows, len(free)


def imposed(rows: Rows, size: int, *functionals: Sequence[Number]) -> tuple[Rows, int]:
    """The subspace where linear functions of the parameters vanish, in fewer parameters.

    >>> imposed({(0, 1): [1, 0], (0, 2): [0, 1]}, 2, [1, 1])
    ({(0, 1): [Fraction(-1, 1)], (0, 2): [1]}, 1)
    """
    waiting = [list(functional) for functional in functionals]
    while waiting:
        functional = waiting.pop(0)
        pivot = next((k for k, x in enumerate(functional) if x != 0), None)
        if pivot is None:
            waiting = [f for f in waiting if any(x != 0 for x in f)]
            continue
        scale = exact(functional[pivot])
        solved: list[Number] = [-x / scale for x in functional]

        rows = {edge: _without(row, pivot, solved) for edge, row in rows.items()}
        waiting = [_without(f, pivot, solved) for f in waiting]
        size -= 1
    return {edge: row for edge, row in rows.items() if any(x != 0 for x in row)}, size


def _without(row: Sequence[Number], pivot: int, solved: Sequence[Number]) -> list[Number]:
    """The row with the parameter `pivot` expressed in the others."""
    x = row[pivot]
    rest = [k for k in range(len(row)) if k != pivot]
    return [row[k] for k in rest] if x == 0 else [row[k] + x * solved[k] for k in rest]


def _add(
    row: dict[Edge, Number], edge: Edge, weight: Number, pivots: Mapping[Edge, dict[Edge, Number]]
) -> None:
    if edge not in pivots:
        _increase(row, edge, weight)
        return
    for other, x in pivots[edge].items():
        _increase(row, other, weight * x)


def _increase(row: dict[Edge, Number], edge: Edge, value: Number) -> None:
    total = row.get(edge, 0) + value
    if total == 0:
        row.pop(edge, None)
    else:
        row[edge] = total
