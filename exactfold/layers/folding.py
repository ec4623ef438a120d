"""`fold_flat`: all flat-folded states of a sheet, vertex by vertex and then as a whole."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from math import hypot, prod, radians
from typing import Final

from exactfold._support.clock import LIMIT, Clock
from exactfold._support.plurals import agreeing, counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import UNDECIDED
from exactfold.design.refutations.asked import by_fold
from exactfold.errors import InputError, TooManyModesError, UsageError
from exactfold.exact.surds import exact
from exactfold.layers.conflicts import ConflictSearch
from exactfold.layers.constraints import Constraints
from exactfold.layers.images import Complex, Images, images_of
from exactfold.layers.nearly import Blurred, reflections
from exactfold.layers.orders import LISTED, Orders, Search
from exactfold.layers.overlaps import Overlaps
from exactfold.layers.pieces import pieces_of
from exactfold.layers.states import Component, Conflict, FlatStates, Near, Used
from exactfold.layers.vertices import failures
from exactfold.layers.witnesses import witness
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, open_sheet
from exactfold.pattern.opening import Opened, panels
from exactfold.pattern.panel_pattern import Edge, EnclosedPattern, PanelPattern, Point
from exactfold.pattern.rounding import half_step, size_of

_NEAR: Final = 2e-4
"""In a drawing, a corner and a line of the folded image that miss each other by less than this,
by the size of the sheet, may have been meant to meet, however exact its digits are."""
_ROUNDING: Final = 1e-14
"""Moves by so much of the size are rounding errors of floats."""
_DIGITS: Final = 1e-11
"""So are moves by so much of the size that half of the last digit explains."""
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
    if it is one about inexact digits of a drawing: if its reading is in doubt (`Opened.doubt`), if
    it depends on whether corners and lines of the folded image that nearly meet do, or if reading
    moved coordinates and the digits as written have another number of states. The snap "exact"
    takes the digits as they are.

    Raises `UsageError` for letters that do not fit, and the errors of `open_sheet`.

    >>> fold_flat("miura")
    <FlatStates: proved, 1 state, <PanelPattern: 9 interior vertices, 24 folds, 16 panels>>
    >>> fold_flat("map-fold", "any").count
    320
    """
    start = time.perf_counter()
    clock = Clock(limit)
    opened = open_sheet(sheet)
    pattern = panels(opened.sheet) if isinstance(opened.sheet, CreasePattern) else opened.sheet
    pattern.check_disk("folding flat")
    chosen, used = _letters(opened, pattern.folds, letters)
    found = _found(pattern, chosen, used, most, clock, progress)
    doubt, near = "", None  # what was not read from a file is exact
    if opened.reading.snap != "exact":
        doubt = opened.doubt
        if found.as_written is not UNDECIDED and opened.again is not None:
            written = _as_written(opened)
            off = _noise(opened, written)
            if found.images is not None:
                near = _near(found, _blur(off, found.images), clock)
            if near is not None:
                doubt = doubt or _depends(near, found.count)
            doubt = doubt or _moved(opened, written, found, letters, clock)
            doubt = doubt or _hardly_fails(found, off)
    seconds = time.perf_counter() - start
    return replace(
        found, doubt=doubt, near=near, meant=opened.meant, cuts=opened.cuts, seconds=seconds
    )


def _found(
    pattern: PanelPattern,
    letters: dict[Edge, str],
    used: Used,
    most: int,
    clock: Clock,
    progress: Progress | None,
) -> FlatStates:
    """The answer for exactly these coordinates."""
    found = FlatStates(pattern, letters, used)
    if progress is not None:
        progress("vertices", 0, 0)
    if stuck := failures(pattern, letters):
        return replace(found, failures=stuck)
    if isinstance(pattern, EnclosedPattern):
        return replace(found, stopped=_ENCLOSED)
    images = images_of(pieces_of(pattern, letters))
    if progress is not None:
        progress("overlaps", 0, 0)
    overlaps = Overlaps(images)
    pairs = tuple((i, j) for i, j in overlaps.pairs.tolist())
    found = replace(found, images=images, pairs=pairs)
    constraints = Constraints(overlaps)
    try:
        orders = Search(constraints, clock, progress, most).run()
    except TooManyModesError as error:
        return replace(found, stopped=str(error))
    if orders.refuted:
        why = ConflictSearch(constraints, orders.used).find(clock.at_least(5))
        points = (Conflict(one, _unscaled(images, witness(overlaps, one))) for one in why)
        return replace(found, conflict=tuple(points))
    return replace(
        found,
        fixed=tuple(orders.fixed.tolist()),
        components=_components(orders),
        stopped=orders.stopped,
    )


def _as_written(opened: Opened) -> Opened:
    """The sheet with the digits of its file; the sheet itself if a grid was asked for."""
    asked = isinstance(opened.reading.snap, int)
    if opened.again is None or asked:
        return opened
    try:
        return opened.again(opened.reading.as_written)
    except (InputError, UsageError):
        return opened


def _noise(opened: Opened, written: Opened) -> float:
    """By so much of the size vertices may be off, as far as the digits and the reader tell."""
    if isinstance(opened.reading.snap, int):
        return 0.0
    off = half_step(written.sheet.vertices)  # the digits: reading may have scaled the sheet
    if opened.meant is not None and opened.meant.inferred:
        off = max(off, opened.meant.noise or 0.0, opened.meant.distance or 0.0)
    return off


def _blur(off: float, images: Images) -> float:
    """What misses by less than this, by the size of the sheet, may have been meant to meet.

    If vertices are off by e, a point behind k reflections is off by up to (1 + 2 k) e, as long as
    directions are exact. Two of them miss each other by up to twice as much.
    """
    return max(_NEAR, 2 * (1 + 2 * reflections(images.pieces)) * off)


def _if_met(found: FlatStates, overlaps: Overlaps, blur: float, clock: Clock) -> int | None:
    """The number of states if all corners and lines that nearly meet are taken to meet.

    This is computed in floats, and proves nothing. None if it is not known.
    """
    try:
        blurred = Blurred(overlaps, blur)
        orders = Search(Constraints(blurred), clock.at_least(5), most=1).run()
    except (KeyError, ValueError, TooManyModesError):
        return None
    if orders.refuted:
        return 0
    counts = [one.count for one in orders.components]
    return None if None in counts else prod(count for count in counts if count is not None)


def _depends(near: Near, count: int | None) -> str:
    """Why an answer is in doubt in which corners and lines nearly meet; empty if it is not.

    It is unless as many states remain if all that nearly meets is taken to meet.
    """
    if near.states == count is not None:
        return ""
    states = "it is not known how many states there are"
    if near.states is not None:
        states = f"there {agreeing(near.states, 'is')} {counted(near.states, 'state')}"
    return (
        f"{near.text}; if all that nearly meets is taken to meet, {states}: --snap exact takes the "
        "digits as they are"
    )


def _moved(
    opened: Opened,
    written: Opened,
    found: FlatStates,
    letters: Mapping[Edge, str] | str | None,
    clock: Clock,
) -> str:
    """Why an answer is in doubt for which coordinates were moved; empty if it is not.

    It is if each vertex folds flat as it was written, too, but with another number of states. If
    a vertex does not, the digits are noise, and say nothing against the coordinates that were found
    for them; and so do moves by the rounding of floats.
    """
    if written is opened or opened.largest_move <= _ROUNDING:
        return ""
    if opened.largest_move <= min(_DIGITS, half_step(written.sheet.vertices)):
        return ""
    try:
        digits = fold_flat(written, letters, limit=clock.left)
    except (InputError, UsageError):
        return ""
    if digits.failures or (digits.status, digits.count) == (found.status, found.count):
        return ""
    states = "a number of states that is not known"
    if digits.count is not None:
        states = counted(digits.count, "state")
    return (
        f"coordinates moved by up to {opened.largest_move:.1g} of the size when the drawing was "
        f"read, and the digits as written have {states}: --snap exact takes them, --snap DEN a grid"
    )


def _hardly_fails(found: FlatStates, off: float) -> str:
    """Why a refutation by single vertices is in doubt; empty if it is not.

    It is if Kawasaki's condition alone fails, by angles that may be meant to be 0: if both ends of
    creases are off by e in each coordinate, their directions are by up to 3 e / length.
    """
    if not found.failures:
        return ""
    points = found.pattern.scaled_vertices
    size = size_of(points)
    for one in found.failures:
        x, y = points[one.vertex]
        ends = (points[i + j - one.vertex] for i, j in found.pattern.folds if one.vertex in (i, j))
        lengths = (hypot(float(a - x), float(b - y)) for a, b in ends)
        meant = max(_NEAR, sum(3 * off * size / length for length in lengths))
        if one.off is None or abs(radians(one.off)) > meant:
            return ""
    text = found.failures[0].text
    return f"{text}, which may be noise: --snap exact takes the digits as they are"


def _letters(
    opened: Opened, folds: tuple[Edge, ...], letters: Mapping[Edge, str] | str | None
) -> tuple[dict[Edge, str], Used]:
    """The letter M, V, F or U of each fold, and whose they are."""
    flat = {fold: opened.assignment.get(fold, "U") for fold in folds}
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
            tuple(one.pairs.tolist()),
            one.count,
            tuple(tuple(row) for row in one.states.tolist()),
            one.least,
        )
        for one in orders.components
    )


def _near(found: FlatStates, blur: float, clock: Clock) -> Near | None:
    """The nearest corner and line, if they miss each other by less than a share of the size."""
    if found.images is None:
        return None
    overlaps = Overlaps(found.images)
    sides = overlaps.sides
    size = size_of(found.pattern.scaled_vertices)
    line, point, distance = sides.nearest
    if not distance < blur * size:
        return None
    vertex = next(v for v, number in overlaps.number.items() if number == point)
    states = _if_met(found, overlaps, blur * size, clock)
    return Near(sides.distance(line, point) / size, vertex, overlaps.edge_on(line), states)


def _unscaled(images: Images, point: Complex) -> Point:
    scale = exact(images.scale)
    return point[0] / scale, point[1] / scale
