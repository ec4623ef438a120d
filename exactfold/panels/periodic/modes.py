"""`count_panel_cell`: all periodic motions of a tessellation of rigid panels at the flat state."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from fractions import Fraction

from exactfold._support.clock import QUICK, Clock
from exactfold._support.plurals import counted
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.errors import TooManyModesError
from exactfold.exact.joined_fields import joined
from exactfold.exact.surds import Number, Surd, exact, sign, simple
from exactfold.panels.by_spaces import MOST_REDUCTION, MOST_STEPS, checked_components
from exactfold.panels.periodic.result import PanelCell, PeriodicMotion, PeriodicPart
from exactfold.panels.periodic.torus import Torus
from exactfold.panels.spaces.kernel import Rows, entry, first_order, number
from exactfold.panels.spaces.splitting import Splitting
from exactfold.panels.spaces.subspaces import Leaf, independent_parts, reduced
from exactfold.panels.vertex.holes import close_always
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.periodic.cell_files import as_cell
from exactfold.pattern.periodic.cells import Side

_SIGNS = {1: "V", -1: "M", 0: "F"}


def count_panel_cell(cell: object, *, limit: float | None = None) -> PanelCell:
    """The motions of a tessellation of rigid panels whose fold angles repeat in each cell.

    `cell` is a `PeriodicPattern`, or what `read_cell` reads; its `diagonals` do not fold. Let w be
    fold angle / length. The sheet closes to second order if at each vertex sum_j w_j d_j = 0 and
    K_v(w) = 0 (docs/panels.md, Motions at the flat sheet). The solutions are found for all
    directions n together, by splitting linear spaces exactly. On each, the gradient grows by B l
    along a lattice vector l: B = 0, and the motion is planar, or B = b n n^T, and the sheet rolls
    up across n (docs/tessellations.md, 6). A part of one dimension truly folds if all vertices
    close for tan(fold angle / 2) = T w length and every T, with the same angles in each cell.

    UNDECIDED, with the reason, if the solutions are not known; whether they truly fold has a
    verdict of its own. Raises the errors of `read_cell`.

    >>> miura = count_panel_cell("miura-cell")
    >>> [(m.dimension, m.direction, str(m.folds)) for m in miura]
    [(2, (0, 1), 'proved'), (1, None, 'proved')]
    >>> count_panel_cell("square-twist-cell").field_names
    ('Q(sqrt 5)',)
    """
    start, clock = time.perf_counter(), Clock(limit)
    pattern = as_cell(cell)
    torus = Torus(pattern)
    moving = torus.stars()
    try:
        motions = _motions(torus, moving, clock)
    except TooManyModesError as error:
        result = PanelCell(pattern, torus.folds, UNDECIDED, str(error), ())
    else:
        what = counted(len(motions), "component")
        result = PanelCell(
            pattern,
            torus.folds,
            PROVED,
            f"{what} of all motions to second order, for all directions together",
            tuple(motions),
        )
    return replace(result, seconds=time.perf_counter() - start)


def _motions(torus: Torus, moving: Mapping[int, Star], clock: Clock) -> list[PeriodicMotion]:
    """All components; raises `TooManyModesError`."""
    if not moving:
        return []
    rows, size = first_order(moving, clock.share(1 / 2).at_least(QUICK))
    small, left, _ = reduced(moving, rows, size, MOST_REDUCTION, clock)
    if not left:
        return []
    found = Splitting(moving, MOST_STEPS, clock).leaves(small, left)
    motions = []
    for leaf in found:
        clock.check()
        _, components = checked_components(moving, leaf, found)
        motions += [_motion(torus, moving, leaf)] * len(components)
    return sorted(motions, key=lambda motion: -motion.dimension)


def _motion(torus: Torus, moving: Mapping[int, Star], leaf: Leaf) -> PeriodicMotion:
    densities = torus.densities(leaf.rows)
    planar, direction = _rolling(torus.bends(densities))
    entries: Rows = {edge: [entry(x) for x in row] for edge, row in leaf.rows.items()}
    parts: list[PeriodicPart] = []
    folds: Verdict = PROVED
    for rows, size in independent_parts(entries, leaf.size, moving):
        numbers = {edge: tuple(number(x) for x in row) for edge, row in rows.items()}
        active = torus.densities(numbers)
        lines = size == 1
        parts.append(PeriodicPart(size, active, _letters(torus, active) if lines else None))
        closing = lines and close_always(moving, {edge: row[0] for edge, row in numbers.items()})
        folds = folds if closing else UNDECIDED
    return PeriodicMotion(leaf.dimension, planar, direction, tuple(parts), folds)


def _letters(torus: Torus, densities: Mapping[Side, tuple[Number, ...]]) -> str:
    """A letter for each fold, with M for the first one that folds."""
    signs = [sign(densities[fold][0]) if fold in densities else 0 for fold in torus.folds]
    first = next(s for s in signs if s)
    return "".join(_SIGNS[-first * s] for s in signs)


def _rolling(bends: list[tuple[Number, ...]]) -> tuple[bool, tuple[Number, Number] | None]:
    """Whether B is 0 on a space, and the direction n if B is a multiple of one n n^T there.

    On a linear space of solutions all B have rank 1, so that they are multiples of one of them. On
    a cone that spans a larger space n may vary, and there is none.
    """
    b_11, b_12, b_22 = joined(bends)
    columns = [column for column in zip(b_11, b_12, b_22, strict=True) if any(map(sign, column))]
    if not columns:
        return True, None
    first = columns[0]
    for column in columns[1:]:
        if any(
            sign(first[i] * column[j] - first[j] * column[i]) for i in range(3) for j in range(i)
        ):
            return False, None
    x, y = (first[1], first[2]) if sign(first[2]) else (first[0], first[1])
    if sign(first[0] * first[2] - first[1] * first[1]):
        return False, None
    return False, _shortest(simple(x), simple(y))


def _shortest(x: Number, y: Number) -> tuple[Number, Number]:
    """A rational direction as the shortest vector of integers that points up."""
    if not sign(y):
        return 1, 0
    slope = simple(exact(x) / exact(y))
    return (slope, Fraction(1)) if isinstance(slope, Surd) else Fraction(slope).as_integer_ratio()
