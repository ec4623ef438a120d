"""`fold_flat`: all flat-folded states of a sheet, vertex by vertex and then as a whole."""

from __future__ import annotations

import time
from collections.abc import Mapping
from typing import Final

import numpy as np

from exactfold._support.clock import LIMIT, Clock
from exactfold._support.progress import Progress
from exactfold.design.refutations.asked import by_fold
from exactfold.errors import TooManyModesError, UsageError
from exactfold.exact.surds import exact
from exactfold.layers.conflicts import conflict
from exactfold.layers.constraints import Constraints
from exactfold.layers.images import Complex, Images, images_of
from exactfold.layers.orders import LISTED, Orders, Search
from exactfold.layers.overlaps import Overlaps
from exactfold.layers.pieces import pieces_of
from exactfold.layers.states import Component, Conflict, FlatStates, Near, Used
from exactfold.layers.vertices import failures
from exactfold.layers.witnesses import witness
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened, panels
from exactfold.pattern.panel_pattern import Edge, EnclosedPattern, Point

_NEAR: Final = 1e-6
"""In a drawing, a corner and a line of the folded image that miss each other by less than this,
by the size, may have been meant to meet."""
_ENCLOSED: Final = (
    "the folds of the sheet that was meant have exact directions, but its vertices are known only "
    "nearly, so that it is not known which of them meet when it is folded"
)


def fold_flat(
    sheet: PatternLike,
    letters: Mapping[Edge, str] | str | None = None,
    *,
    most: int = LISTED,
    limit: float | None = LIMIT,
    progress: Progress | None = None,
) -> FlatStates:
    """Find all flat-folded states of a sheet, or prove that there is none (docs/flat.md).

    A state is an order of layers: for each pair of panels that overlap in the folded image it says
    which one lies above, so that no panel passes through another one or through a crease. Creases
    with F or J in the file are not folded, all others are, by 180 degrees. `letters` are those of
    the file if None and it has some; "any" folds every other crease either way; or they have M, V,
    F or U (folded, either way) for the folds, by fold (i, j), i < j, or as text in their order.

    All states are counted, and the first `most` of each component are listed.

    The answer is PROVED if there is a state. It is REFUTED if a vertex does not fold flat, exactly,
    or if the conditions on orders contradict each other. It is UNDECIDED after `limit` seconds, and
    if it is one about inexact digits of a drawing: if its reading is in doubt (`Opened.doubt`), or
    if corners and lines of the folded image nearly meet, unless the snap is "exact".

    Raises `UsageError` for letters that do not fit, `PackageMissingError` without python-sat, and
    the errors of `open_sheet`.

    >>> fold_flat("miura")
    <FlatStates: proved, 1 state, <PanelPattern: 9 interior vertices, 24 folds, 16 panels>>
    >>> fold_flat("map-fold", "any").count
    56
    """
    start = time.perf_counter()
    clock = Clock(limit)
    opened = open_sheet(sheet)
    pattern = panels(opened.sheet) if isinstance(opened.sheet, CreasePattern) else opened.sheet
    chosen, used = _letters(opened, pattern.folds, letters)
    exactly = opened.reading.snap == "exact"
    doubt = "" if exactly else opened.doubt

    def found(**known: object) -> FlatStates:
        return FlatStates(
            pattern,
            chosen,
            used,
            meant=opened.meant,
            seconds=time.perf_counter() - start,
            **{"doubt": doubt, **known},  # type: ignore[arg-type]
        )

    if progress is not None:
        progress("vertices", 0, 0)
    if stuck := failures(pattern, chosen):
        return found(failures=stuck)
    if isinstance(pattern, EnclosedPattern):
        return found(stopped=_ENCLOSED)
    images = images_of(pieces_of(pattern, chosen))
    if progress is not None:
        progress("overlaps", 0, 0)
    overlaps = Overlaps(images)
    near = None if exactly or opened.again is None else _near(overlaps)
    if near is not None and not doubt:
        doubt = f"{near.text}, so that the answer holds only for these digits"
    pairs = tuple((int(i), int(j)) for i, j in overlaps.pairs)
    base = {"images": images, "pairs": pairs, "near": near, "doubt": doubt}
    constraints = Constraints(overlaps)
    try:
        orders = Search(constraints, clock, progress, most).run()
    except TooManyModesError as error:
        return found(**base, stopped=str(error))
    if orders.refuted:
        why = conflict(constraints, orders.used, clock.at_least(5))
        points = (Conflict(one, _unscaled(images, witness(overlaps, one))) for one in why)
        return found(**base, conflict=tuple(points))
    return found(
        **base,
        fixed=tuple(orders.fixed.tolist()),
        components=_components(orders),
        stopped=orders.stopped,
    )


def _letters(
    opened: Opened, folds: tuple[Edge, ...], letters: Mapping[Edge, str] | str | None
) -> tuple[dict[Edge, str], Used]:
    """The letter M, V, F or U of each fold, and whose they are."""
    flat = {fold: opened.assignment.get(fold, "U") for fold in folds}
    if not {"M", "V", "U"} & set(flat.values()):
        flat = dict.fromkeys(folds, "U")  # the file says nothing about directions
    drawn = {fold: "F" if x in "FJ" else x if x in "MV" else "U" for fold, x in flat.items()}
    if letters is None or letters == "drawn":
        if {"M", "V"} & set(drawn.values()):
            return drawn, "drawn"
        if letters == "drawn":
            raise UsageError(
                "no fold of the sheet is drawn as a mountain or a valley: give letters"
            )
    if letters is None or letters == "any":
        return {fold: "F" if x == "F" else "U" for fold, x in drawn.items()}, "any"
    return dict(by_fold(folds, letters)), "given"


def _components(orders: Orders) -> tuple[Component, ...]:
    return tuple(
        Component(
            tuple(one.pairs.tolist()), one.count, tuple(tuple(row) for row in one.states.tolist())
        )
        for one in orders.components
    )


def _near(overlaps: Overlaps) -> Near | None:
    """The nearest corner and line that miss each other by less than `_NEAR`."""
    sides = overlaps.sides
    width = max(np.ptp(sides.x), np.ptp(sides.y))
    line, point, distance = sides.nearest
    if not distance < _NEAR * width:
        return None
    vertex = next(v for v, number in overlaps.number.items() if number == point)
    edge = overlaps.edge_on(line)
    return Near(float(distance / width), vertex, edge)


def _unscaled(images: Images, point: Complex) -> Point:
    scale = exact(images.scale)
    return point[0] / scale, point[1] / scale
