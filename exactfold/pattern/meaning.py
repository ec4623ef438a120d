"""From digits that are inexact to the sheet that was meant, if it can be inferred."""

from __future__ import annotations

import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Final

from exactfold._support.plurals import counted
from exactfold.errors import FoldError, PatternError, TooLargeError, UsageError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.drawing.drawing import Drawing, Line
from exactfold.pattern.drawing.meant.left import left_relations, off_by
from exactfold.pattern.drawing.meant.levels import loop_levels
from exactfold.pattern.opened import Opened, panels, triangulated

if TYPE_CHECKING:  # sheets with exact digits do without them
    from exactfold.pattern.panel_pattern import PanelPattern


_MOST_EDGES: Final = 1200
"""Sheets with more edges get no proposals."""
_TIMES_MISSED: Final = 10
"""No proposal is further from the drawing than so many times what the drawing misses."""
_TIMES_NOISE: Final = 100
"""Recognising coordinates must not move one by more than this many times the largest defect."""
_NO_LEVEL: Final = "no noise level stands out from chance (--noise EPS states one)"
_NONE_NEAR: Final = "no relation between creases holds nearly but not exactly"


def meaning(found: Opened, written: Callable[[], Opened]) -> Opened:
    """The sheet that was meant, if the digits of `found` are inexact; `found` itself if not.

    Digits are inexact if relations between creases hold nearly but not exactly. `written` reads the
    sheet with its digits as written. If no sheet can be inferred, `found` is returned, and its
    `doubt` says why. If the reading asks for relations, they are listed in the lines of the sheet.
    """
    reading = found.reading
    if reading.snap not in (None, "auto") and reading.overrules:
        takes = "takes the digits as written" if reading.snap == "exact" else "rounds all digits"
        raise UsageError(
            f"--snap {reading.snap} {takes}: leave out --without, --also, --noise and --unit"
        )
    return _with_relations(_meaning(found, written))


def _with_relations(known: Opened) -> Opened:
    """The same sheet; its lines list the relations if the reading asks for them."""
    if not known.reading.relations:
        return known
    meant = known.meant
    listed = meant.listed if meant is not None else off_by(known.left) or (_NONE_NEAR,)
    return replace(known, lines=known.lines + listed, seen=known.seen + listed)


def _meaning(found: Opened, written: Callable[[], Opened]) -> Opened:
    """`meaning` without a list of the relations."""
    reading = found.reading
    if reading.snap == "exact":
        return found
    left = found.left
    if not left and not reading.overrules:
        return found
    from exactfold.pattern.meant import Meant, inferred

    if isinstance(reading.snap, int):
        return replace(found, meant=Meant(left=left, reason=f"--snap {reading.snap} leaves them"))
    try:
        raw = written()
    except (FoldError, PatternError) as error:
        reason = f"the digits as written do not make a sheet: {error}"
        return replace(found, meant=Meant(left=left, reason=reason))
    sheet = panels(raw.sheet) if isinstance(raw.sheet, CreasePattern) else raw.sheet
    if sheet.field.radicands:
        return replace(
            found, meant=Meant(left=left, reason="the coordinates in the file are irrational")
        )
    meant = inferred(sheet, reading)
    if not left and meant.inferred and not meant.distance:
        return _unchanged(found)
    if meant.realized is None or meant.realized.sheet is None:
        if meant.reason and reading.overrules and (reading.also or not left):
            raise UsageError(
                f"no sheet near the drawing is as asked for: {meant.reason}; state fewer relations "
                "or less noise"
            )
        reason = meant.reason or (_NO_LEVEL if left else "")
        found = found if left else _unchanged(found)
        return replace(found, meant=replace(meant, left=left, reason=reason))
    exact = meant.realized.sheet
    lines = tuple(line for line in raw.lines if not line.startswith("coordinates kept"))
    return replace(
        raw,
        sheet=_triangles(exact) if meant.existence == "exact" else exact,
        lines=(*lines, *meant.lines),
        brief=_with_coordinates(raw, meant.brief),
        seen=(*raw.seen, *meant.held),
        largest_move=meant.distance or 0.0,
        field_name=exact.field_name,
        meant=meant,
        reading=reading,
        again=found.again,
    )


def _unchanged(found: Opened) -> Opened:
    """An exact drawing; its lines say that the options for inexact ones changed nothing."""
    reading = found.reading
    given = {"--without": reading.without, "--also": reading.also}
    numbers = {"--noise": reading.noise, "--unit": reading.unit}
    names = [name for name, value in given.items() if value]
    names += [name for name, value in numbers.items() if value is not None]
    said = (f"{_NONE_NEAR}: {', '.join(names)} changed nothing",)
    return replace(found, lines=found.lines + said, seen=found.seen + said)


def recognised(found: Opened) -> Opened | None:
    """A triangulated sheet with recognised coordinates, if its digits are inexact without them.

    None if its digits are exact, if `snap` or a relation was asked for, if relations nearly hold
    even then, or if a coordinate would move far more than its noise.
    """
    reading = found.reading
    if reading.snap is not None or reading.overrules:
        return None
    left = found.left
    if not left:
        return None
    from exactfold.pattern.drawing.coordinates import exact_coordinates
    from exactfold.pattern.panel_pattern import PanelPattern

    if not isinstance(found.sheet, CreasePattern):
        return None
    lines = tuple(Line(i, j, found.assignment.get((i, j), "U")) for i, j in found.sheet.edges)
    known = exact_coordinates(Drawing(tuple(found.sheet.vertices), lines, ""), "auto")
    if known.largest_move > _TIMES_NOISE * left[-1].defect:
        return None
    try:
        sheet = PanelPattern(known.points, found.sheet.edges)
    except (FoldError, PatternError):
        return None
    if left_relations(sheet) or len(sheet.faces) != len(found.sheet.triangles):
        return None
    return _with_relations(
        replace(
            found,
            sheet=_triangles(sheet),
            lines=(*found.lines, known.text),
            brief=_with_coordinates(found, known.brief),
            largest_move=known.largest_move,
            field_name=sheet.field_name,
        )
    )


def proposals(
    found: Opened, seconds: float, loops: Sequence[float] = ()
) -> list[tuple[float, Opened]]:
    """Exact sheets near a drawing without a clear noise level, each with a level that gives it.

    The levels are those at the widest gaps between the relations that the drawing misses, the
    widest first. If it misses none narrowly, but loops of folds nearly close, off by `loops`, they
    are parts of the largest of these. A sheet that still nearly has relations is left out, and so
    is one that is far from the drawing for what this misses, or has the relations of one before.
    After `seconds` no other level is tried. The list is empty if the sheet that was meant is known,
    or if something was said about it.
    """
    reading = found.reading
    if not (found.doubt or loops) or reading.overrules or reading.snap == "exact":
        return []
    if found.again is None or (found.meant is not None and found.meant.inferred):
        return []
    if isinstance(reading.snap, int) or len(found.sheet.edges) > _MOST_EDGES:
        return []
    end = time.monotonic() + seconds
    try:
        raw = found.again(reading.as_written)
    except (FoldError, PatternError):
        return []
    made: list[tuple[float, Opened]] = []
    drawn = panels(raw.sheet) if isinstance(raw.sheet, CreasePattern) else raw.sheet
    for level in _levels(drawn) if found.doubt else loop_levels(max(loops)):
        if time.monotonic() > end:
            break
        opened = found.again(replace(reading, noise=level))
        meant = opened.meant
        if meant is None or not meant.inferred or opened.doubt:
            continue
        names = {relation.name for relation in meant.relations}
        if any(
            other.meant and names == {r.name for r in other.meant.relations} for _, other in made
        ):
            continue  # the same sheet but for free angles
        missed = max(relation.defect for relation in meant.relations)
        if opened.largest_move <= _TIMES_MISSED * missed:
            made.append((level, opened))
    return made


def _levels(sheet: PanelPattern) -> list[float]:
    from exactfold.exact.surds import rational
    from exactfold.pattern.drawing.meant.drawn import NEAR, Drawn
    from exactfold.pattern.drawing.meant.levels import proposed_levels
    from exactfold.pattern.drawing.meant.local import local_relations

    if sheet.field.radicands:
        return []
    points = [(rational(x), rational(y)) for x, y in sheet.vertices]
    drawn = Drawn(points, sheet.edges, frozenset(sheet.boundary_edges))
    defects = [relation.defect for relation, _ in local_relations(drawn)[0]]
    return proposed_levels(defects, NEAR * min(drawn.lengths.values()))


def _with_coordinates(found: Opened, coordinates: str) -> tuple[str, ...]:
    """The words of `brief` with these about the coordinates."""
    lines, _, *more = found.brief or (counted(len(found.sheet.edges), "line"), "")
    return lines, coordinates, *more


def _triangles(exact: PanelPattern) -> CreasePattern | PanelPattern:
    """The sheet, triangulated if its coordinates are short enough for that."""
    try:
        return triangulated(exact) or exact
    except TooLargeError:
        return exact
