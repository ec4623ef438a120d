"""The space of first-order motions of a sheet of panels, computed exactly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TypeAlias, TypeVar

from flint import fmpq

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.exact.linalg import from_fmpq
from exactfold.exact.root_tower import to_fmpq
from exactfold.exact.surds import Number, Surd
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge

Entry: TypeAlias = Surd | fmpq
"""A number to compute with; FLINT's rationals are about ten times faster than fractions."""

Key = TypeVar("Key")

Rows: TypeAlias = dict[Edge, Sequence[Entry]]
"""The density of each fold as a linear function of parameters; flat folds are left out."""


def entry(value: Number | fmpq) -> Entry:
    """Convert a number of a result to a number to compute with."""
    return value if isinstance(value, Surd) else to_fmpq(value)


def number(value: Entry) -> Number:
    """Convert a number to compute with to a number of a result."""
    return value if isinstance(value, Surd) else from_fmpq(value)


def first_order(stars: Mapping[int, Star], clock: Clock = UNLIMITED) -> tuple[Rows, int]:
    """The first-order motions sum_j w_j d_j = 0 at all vertices, and their number of parameters.

    The conditions are eliminated one by one. Each parameter is the density of one fold. Raises
    `TooManyModesError` when the clock has passed.

    >>> star = Star(0, ((0, 1), (0, 2)), ((1, 0), (-2, 0)))
    >>> first_order({0: star})
    ({(0, 1): [2], (0, 2): [1]}, 1)
    """
    pivots: dict[Edge, dict[Edge, Entry]] = {}
    users: dict[Edge, set[Edge]] = {}
    for star in stars.values():
        for axis in (0, 1):
            row: dict[Edge, Entry] = {}
            for edge, direction in zip(star.folds, star.directions, strict=True):
                if direction[axis]:
                    clock.check()
                    _add(row, edge, entry(direction[axis]), pivots)
            if not row:
                continue
            pivot = min(row, key=lambda edge: (len(users.get(edge, ())), edge))
            scale = row.pop(pivot)
            solved: dict[Edge, Entry] = {edge: -x / scale for edge, x in row.items()}
            for user in users.pop(pivot, set()):
                clock.check()
                weight = pivots[user].pop(pivot)
                for edge, x in solved.items():
                    increase(pivots[user], edge, weight * x)
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
        entries = pivots.get(edge, {edge: fmpq(1)})
        vector: list[Entry] = [fmpq(0)] * len(free)
        for other, x in entries.items():
            vector[place[other]] = x
        if entries:
            rows[edge] = vector
    return rows, len(free)


def imposed(rows: Rows, size: int, *functionals: Sequence[Entry]) -> tuple[Rows, int]:
    """The subspace on which linear functions of the parameters vanish, with fewer parameters.

    >>> one, zero = fmpq(1), fmpq(0)
    >>> imposed({(0, 1): [one, zero], (0, 2): [zero, one]}, 2, [one, one])
    ({(0, 1): [-1], (0, 2): [1]}, 1)
    """
    waiting = [list(functional) for functional in functionals]
    while waiting:
        functional = waiting.pop(0)
        pivot = next((k for k, x in enumerate(functional) if x), None)
        if pivot is None:
            waiting = [f for f in waiting if any(f)]
            continue
        scale = functional[pivot]
        solved: list[Entry] = [-x / scale for x in functional]

        rows = {edge: _without(row, pivot, solved) for edge, row in rows.items()}
        waiting = [_without(f, pivot, solved) for f in waiting]
        size -= 1
    return {edge: row for edge, row in rows.items() if any(row)}, size


def _without(row: Sequence[Entry], pivot: int, solved: Sequence[Entry]) -> list[Entry]:
    """The row in which the parameter `pivot` is expressed by the others."""
    x = row[pivot]
    rest = [k for k in range(len(row)) if k != pivot]
    if not x:
        return [row[k] for k in rest]
    return [row[k] + x * solved[k] if solved[k] else row[k] for k in rest]


def _add(
    row: dict[Edge, Entry], edge: Edge, weight: Entry, pivots: Mapping[Edge, dict[Edge, Entry]]
) -> None:
    if edge not in pivots:
        increase(row, edge, weight)
        return
    for other, x in pivots[edge].items():
        increase(row, other, weight * x)


def increase(row: dict[Key, Entry], key: Key, value: Entry) -> None:
    """Add a value to an entry of a sparse row; a row contains no zeros."""
    total = row[key] + value if key in row else value
    if total:
        row[key] = total
    else:
        row.pop(key, None)
