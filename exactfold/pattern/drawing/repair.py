"""Repairs drawings; each step can be left out, and reports what it did and where."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final

from exactfold._support.plurals import counted
from exactfold.errors import FoldError, MalformedPatternError, PatternError, UsageError
from exactfold.pattern.drawing.coordinates import Exact, exact_coordinates, resolution
from exactfold.pattern.drawing.drawing import Drawing, Snap, Steps
from exactfold.pattern.drawing.inexactness import GAP, clear_distances
from exactfold.pattern.drawing.mending import (
    Repair,
    coinciding,
    dissolved,
    floats,
    merged,
    used,
    without_dangling,
    without_duplicates,
    without_flat_lines,
)
from exactfold.pattern.drawing.sheets import bordered, sheets
from exactfold.pattern.drawing.splitting import split

STEPS: Final = ("merge", "duplicates", "split", "join", "dangling", "dissolve", "border")
"""The steps of repair, in their order."""
_LEAST: Final = ("merge", "duplicates", "split", "dangling")
"""Some drawings have no panels without these steps; the other steps only change the panels."""
_NEAR: Final = Fraction(1, 10**6)
_COARSEST: Final = Fraction(1, 300)
"""Points are never merged automatically at a larger share of the size."""
_ADVISED: Final = Fraction(1, 100)
"""Merging at a larger share of the size is never advised."""
_TRIALS: Final = 3
_MEET: Final = "draw each line from one line to another, so that they meet in common ends"


def repaired(
    drawing: Drawing, *, merge: Fraction | None = None, steps: Collection[str] = STEPS
) -> tuple[Drawing, tuple[Repair, ...]]:
    """The drawing after the given steps, and a report of what they did.

    The step `merge` merges near-duplicate points. `duplicates` drops lines without length and lines
    that are drawn twice. `split` cuts lines at T-junctions and crossings. `join` drops lines F and
    J. `dangling` drops lines that end inside a panel. `dissolve` removes vertices on straight lines
    without other lines. `border` gives the letter B to the lines round the sheet.

    The argument `merge` is the distance, in units of the larger side, up to which points coincide
    and a point lies on a line. By default it is 1e-6, or two units of the last decimal of the file
    if that is larger. Coordinates stay exact: crossings are solved in the field of the points. So
    `exact_sheets` snaps the points before `split`.

    Points keep their indices; points on no line are not removed. Raises `UsageError` for a step
    that does not exist or a distance that is not positive, and `MalformedPatternError` for a
    drawing without lines.

    >>> from exactfold.pattern.drawing.drawing import Line
    >>> cross = Drawing(((0, 0), (2, 0), (2, 2), (0, 2)),
    ...     (Line(0, 1, "B"), Line(1, 2, "B"), Line(2, 3, "B"), Line(3, 0, "B"),
    ...      Line(0, 2, "M"), Line(1, 3, "V")), "two diagonals")
    >>> mended, repairs = repaired(cross)
    >>> mended.points[4], len(mended.lines), str(repairs[0])
    ((Fraction(1, 1), Fraction(1, 1)), 8, '1 crossing of lines is a vertex: at 4 (1, 1)')
    """
    unknown = sorted(set(steps) - set(STEPS))
    if unknown:
        raise UsageError(f"there is no step {unknown[0]!r}: the steps are {', '.join(STEPS)}")
    near = _distance(drawing, merge)
    repairs: list[Repair] = []
    for step in STEPS:
        if step not in steps:
            continue
        drawing, reports = _step(drawing, step, near)
        repairs += reports
        if step == "split" and reports and "merge" in steps:
            drawing, reports = coinciding(drawing)  # several crossings can be the same point
            repairs += reports
        if step == "split" and "duplicates" in steps:
            drawing, reports = without_duplicates(drawing)
            repairs += reports
    return drawing, tuple(repairs)


def attempts(drawing: Drawing, steps: Steps, merge: Fraction | None) -> list[Collection[str]]:
    """The sets of repair steps, in the order in which they are tried."""
    if steps == "least":
        return [(), _LEAST] if merge is None else [_LEAST]
    if steps == "all":
        return [("join",), STEPS] if drawing.exact and merge is None else [STEPS]
    return [steps]


@dataclass(frozen=True)
class Sheets:
    """The sheets of a drawing, with exact coordinates, and how they were found."""

    sheets: tuple[Drawing, ...]
    coordinates: Exact
    repairs: tuple[Repair, ...]

    def __repr__(self) -> str:
        sheets, repairs = counted(len(self.sheets), "sheet"), counted(len(self.repairs), "repair")
        return f"<Sheets: {sheets} after {repairs}>"


def exact_sheets(
    drawing: Drawing,
    *,
    snap: Snap = "auto",
    tolerance: Fraction | None = None,
    merge: Fraction | None = None,
    steps: Collection[str] = STEPS,
) -> Sheets:
    """Makes sheets of a drawing: merges points, makes coordinates exact, then does the other steps.

    The order matters. Points that nearly coincide become one point. Coordinates are recognised as
    they were drawn. Only then are crossings and T-junctions computed, in the field that was found,
    so that three creases through a point of the design meet there exactly.

    Without `merge`, the merging distance is the finest clear one (`clear_distances`) up to 1/300 of
    the size. If the sheet then has holes or loose ends, the next two are tried. The first of the
    repairs mentions a distance that is larger than the default of `repaired`. If nothing can be
    read, coarser distances up to 1/100 are tried, but only to name in the error message the first
    one that would work.

    Raises the errors of `repaired`, `exact_coordinates` and `sheets`.

    >>> from exactfold.pattern.drawing.drawing import Line
    >>> third = Fraction("0.333333333333")
    >>> made = exact_sheets(Drawing(((0, 0), (1, 0), (1, 1), (0, 1), (third, 0), (third, 1)),
    ...     (Line(0, 1, "B"), Line(1, 2, "B"), Line(2, 3, "B"), Line(3, 0, "B"),
    ...      Line(4, 5, "M")), "one crease"))
    >>> made.sheets[0].points[4], len(made.sheets[0].lines), made.coordinates.denominator
    ((Fraction(1, 3), Fraction(0, 1)), 7, 3)
    """
    near = _distance(drawing, merge)
    inexact = merge is None and "merge" in steps and not drawing.exact
    clear = _clear(drawing, near, _COARSEST, GAP) if inexact else []
    distances = clear[:_TRIALS] or [near]
    first = [step for step in STEPS[:2] if step in steps]
    before, begun = repaired(drawing, merge=distances[0], steps=first)
    exact = exact_coordinates(_used_only(before), snap, tolerance=tolerance)
    # Snapping can make points coincide that were further apart than the merging distance.
    least = 2 * exact.tolerance if merge is None else Fraction(0)

    remedies: dict[Exception, str] = {}

    def made(distance: Fraction) -> Sheets:
        after, ended = repaired(exact.drawing, merge=max(distance, least), steps=steps)
        try:
            found, cut = sheets(after)
            return Sheets(found, exact, (*_noted(distance, near), *begun, *ended, *cut))
        except (FoldError, PatternError) as error:
            for loose in (repair for repair in ended if repair.step == "dangling"):
                if loose.count > len(after.lines):
                    error.args = (f"{error}; {loose}", *error.args[1:])
                    remedies[error] = _MEET
            raise

    done, refusals = _until_whole(made, distances)
    if done:
        return min(done.values(), key=_loose)
    if inexact and all(line.letter != "C" for line in drawing.lines):
        coarser = _clear(drawing, distances[-1] * 2, _ADVISED, GAP / 2)[-_TRIALS:]
        round_ones = [Fraction(f"{1.05 * float(distance):.2g}") for distance in coarser]
        for distance in list(_until_whole(made, round_ones)[0])[:1]:
            remedies[refusals[0]] = (
                f"`exactfold convert --merge {float(distance):g}` would read it: lines that miss "
                "each other by up to that share of the size then meet"
            )
    if refusals[0] in remedies:
        refusals[0].args = (
            f"{refusals[0]}; {remedies[refusals[0]]}",
            *refusals[0].args[1:],
        )
    raise refusals[0]


def _clear(drawing: Drawing, near: Fraction, most: Fraction, gap: float) -> list[Fraction]:
    """Distances at which to merge, as shares of the size, the finest first."""
    clean, _ = repaired(drawing, merge=near, steps=STEPS[:2])
    if not (size := _extent(clean)):
        return []
    clear = clear_distances(clean, float(near) * size, float(most) * size, gap)
    return [Fraction(distance / size * (1 + 1e-9)) for distance in clear]


def _until_whole(
    made: Callable[[Fraction], Sheets], distances: Iterable[Fraction]
) -> tuple[dict[Fraction, Sheets], list[FoldError | PatternError]]:
    """The sheets by distance, up to the first without loose ends; and the errors."""
    done: dict[Fraction, Sheets] = {}
    refusals: list[FoldError | PatternError] = []
    for distance in distances:
        try:
            done[distance] = made(distance)
        except (FoldError, PatternError) as error:
            refusals.append(error)
            continue
        if not _loose(done[distance]):
            break
    return done, refusals


def _loose(sheets: Sheets) -> int:
    """The number of lines that were dropped because one panel lies on both their sides."""
    return sum(repair.count for repair in sheets.repairs if repair.step == "dangling")


def _noted(distance: Fraction, near: Fraction) -> list[Repair]:
    if distance <= near * Fraction(101, 100):
        return []
    sentence = (
        "the drawing is inexact: points and lines that miss each other by up to "
        f"{float(distance):.1e} of the size are taken to meet; no others miss by up to {GAP:g} "
        "times that"
    )
    return [Repair("merge", 1, (), sentence)]


def _step(drawing: Drawing, step: str, near: Fraction) -> tuple[Drawing, list[Repair]]:
    if step == "duplicates":
        return without_duplicates(drawing)
    if step == "join":
        return without_flat_lines(drawing)
    if step == "dangling":
        return without_dangling(drawing)
    if step == "border":
        return bordered(drawing)
    within = float(near) * _extent(drawing)
    return {"merge": merged, "split": split, "dissolve": dissolved}[step](drawing, within)


def _distance(drawing: Drawing, merge: Fraction | None) -> Fraction:
    if merge is None:
        return max(_NEAR, 2 * resolution(drawing))
    if merge <= 0:
        raise UsageError(f"the distance at which points are merged must be positive, not {merge}")
    return Fraction(merge)


def _extent(drawing: Drawing) -> float:
    if not drawing.lines:
        return 0.0
    places = floats(drawing.points)[used(drawing.lines)]
    return float((places.max(axis=0) - places.min(axis=0)).max())


def _used_only(drawing: Drawing) -> Drawing:
    """Moves points on no line to the first point, so that they do not decide the field."""
    members = set(used(drawing.lines))
    if not members:
        raise MalformedPatternError("the drawing has no lines")
    stand_in = drawing.points[min(members)]
    points = tuple(p if v in members else stand_in for v, p in enumerate(drawing.points))
    return replace(drawing, points=points)
