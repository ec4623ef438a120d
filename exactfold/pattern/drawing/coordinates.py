"""Finds the exact coordinates of a drawing: the smallest field that its decimals fit."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import lcm
from typing import Final

from exactfold._support.plurals import agreeing, counted
from exactfold.errors import MalformedPatternError, UsageError
from exactfold.exact.numbers import snap as snapped
from exactfold.exact.surds import Surd, common_field
from exactfold.pattern.drawing.candidates import RADICANDS
from exactfold.pattern.drawing.construction import constructed
from exactfold.pattern.drawing.drawing import Drawing, Point, Snap
from exactfold.pattern.drawing.fitting import (
    Frame,
    Model,
    Written,
    extended,
    fitted_model,
    frames,
    refined,
)

_FINEST: Final = Fraction(1, 10**9)
"""No tolerance is finer than this, in units of the size."""
_COARSER: Final = (Fraction(1, 10**8), Fraction(1, 10**7), Fraction(1, 10**6))
"""These tolerances are tried, too, as a file can have more digits than its precision."""
_WRITTEN: Final = 1024
"""Decimals on a grid of at most so many steps across the drawing count as exact."""
_LEAST_BITS: Final = 20.0
"""By so many bits the fit of a whole drawing must beat chance."""
_MOST_KEPT: Final = 0.5
"""A field is not believed if a larger share of the vertices fits no number."""


@dataclass(frozen=True)
class Exact:
    """A drawing with exact coordinates, and how they were found.

    `drawing` has points in Q (fractions), in Q(sqrt `radicand`), or in a field with one more root.
    If `snap` found them, they are in units of `unit` from `origin`. `largest_move` and `tolerance`
    are in units of the larger side of the drawing. `bits` is minus the binary logarithm of the
    probability that random decimals fit as well. `constructed` counts the vertices that were found
    as crossings of straight lines. `kept` lists the vertices with a coordinate that fits no number
    and keeps its decimals.
    """

    drawing: Drawing
    radicand: int = 1
    denominator: int = 1
    origin: tuple[Fraction, Fraction] = (Fraction(0), Fraction(0))
    unit: Fraction = Fraction(1)
    tolerance: Fraction = Fraction(0)
    largest_move: float = 0.0
    bits: float = 0.0
    constructed: int = 0
    kept: tuple[int, ...] = ()
    reason: str = ""

    def __repr__(self) -> str:
        return f"<Exact: {self.drawing!r}, in {self.field_name}>"

    @property
    def points(self) -> tuple[Point, ...]:
        """The exact points of the drawing."""
        return self.drawing.points

    @property
    def field_name(self) -> str:
        """The field in words: `Q`, `Q(sqrt 2)` or `Q(sqrt 2, sqrt (2 + r1))`."""
        return common_field(c for point in self.points for c in point).name

    @property
    def brief(self) -> str:
        """In a few words, what the coordinates are now."""
        if self.reason and not self.drawing.exact:
            return "exact as written" if self.field_name != "Q" else "decimals as written"
        kept = f" but for {counted(len(self.kept), 'vertex')}" if self.kept else ""
        return f"exact in {self.field_name}{kept}"

    @property
    def text(self) -> str:
        """One line on how the coordinates were made exact."""
        if self.reason:
            return f"coordinates kept as written: {self.reason}"
        parts = [f"coordinates in {self.field_name}, {_denominators(self.denominator)}"]
        if self.unit != 1:
            x, y = (float(c) for c in self.origin)
            parts.append(f"in units of {float(self.unit):.10g} from ({x:.6g}, {y:.6g})")
        if self.constructed:
            drawn = agreeing(self.constructed, "is")
            parts.append(f"{counted(self.constructed, 'vertex')} {drawn} a crossing of lines")
        if self.kept:
            keep = "keeps its decimals" if len(self.kept) == 1 else "keep their decimals"
            parts.append(f"{counted(len(self.kept), 'vertex')} of {len(self.points)} {keep}")
        if self.largest_move == 0:
            parts.append("nothing moved")
        else:
            within = f"tolerance {float(self.tolerance):.1g}"
            if self.largest_move > self.tolerance:
                within = f"{within} of a number, to which crossings and the common unit add"
            parts.append(f"largest move {self.largest_move:.1g} of the size, {within}")
        return "; ".join(parts)


def exact_coordinates(
    drawing: Drawing, snap: Snap = "auto", *, tolerance: Fraction | None = None
) -> Exact:
    """The drawing in the smallest of Q, Q(sqrt 2), Q(sqrt 3), Q(sqrt 5) that its decimals fit.

    With `snap="auto"` the coordinates become exact in these steps. Decimals on a grid of at most
    1,024 steps across the drawing count as exact. Otherwise each coordinate becomes the smallest
    number (a + b sqrt d)/q within the tolerance, if a random number would hardly have one so small.
    This is tried as written, then with the width or the height of the drawing as unit. Remaining
    vertices become crossings of two known straight lines of the drawing. Coordinates that are still
    left become numbers with one more root, such as sqrt (2 + sqrt 2) for lengths at 22.5 degrees,
    if this fits half of them.

    `tolerance` is in units of the larger side. By default it is the last digit of the file, at
    least 1e-9, and up to 1e-6 if the digits contain noise. With `snap=n` coordinates become the
    nearest multiples of 1/n, and with "exact" they stay unchanged.

    Raises `MalformedPatternError` for a drawing without extent, and `UsageError` for another
    `snap`, a tolerance that is not positive, or coordinates that are irrational already. If no
    field is found, there may be one all the same.

    >>> from exactfold.pattern.drawing.drawing import Line
    >>> points = [(0, 0), (1, 0), (1, 1), (0, 1), (Fraction("0.707106781"), 0)]
    >>> exact = exact_coordinates(Drawing(tuple(points), (Line(0, 4, "B"),), "five points"))
    >>> exact.points[4], exact.field_name
    ((1/2*r1, Fraction(0, 1)), 'Q(sqrt 2)')
    >>> print(exact.text)
    coordinates in Q(sqrt 2), denominators up to 2; largest move 2e-10 of the size, tolerance 1e-09
    """
    if snap == "exact":
        return Exact(
            drawing,
            reason="the file states exact coordinates" if drawing.exact else "as requested",
        )
    written = _fractions(drawing)
    size = _size(written)
    if isinstance(snap, int) and not isinstance(snap, bool):
        near = [(snapped(x, snap), snapped(y, snap)) for x, y in written]
        move = max(
            abs(a - b)
            for p, q in zip(near, written, strict=True)
            for a, b in zip(p, q, strict=True)
        )
        return Exact(
            _with(drawing, near),
            denominator=_common(near),
            tolerance=Fraction(1, 2 * snap) / size,
            largest_move=float(move / size),
        )
    if snap != "auto":
        raise UsageError(f'snap must be "auto", "exact" or a denominator, not {snap!r}')
    if tolerance is not None and tolerance <= 0:
        raise UsageError(f"the tolerance must be positive, not {tolerance}")
    common = _common(written)
    if tolerance is None and common * size <= _WRITTEN:
        return Exact(drawing, denominator=common)
    best: Exact | None = None
    seen = frames(written)
    for within in [tolerance] if tolerance is not None else _tolerances(written, size):
        fitted = _fitted(drawing, written, seen, size, within)
        # Chance fits more at a coarser tolerance, so the fit must be far better to be believed.
        if fitted is not None and (best is None or 2 * len(fitted.kept) < len(best.kept)):
            best = fitted
        if best is not None and not best.kept:
            break
    if best is None or len(best.kept) > _MOST_KEPT * len(written):
        return Exact(drawing, reason=_unfit(best))
    return best


def _unfit(best: Exact | None) -> str:
    if best is None:
        return "they do not fit small numbers of Q, Q(sqrt 2), Q(sqrt 3) or Q(sqrt 5)"
    fit = len(best.points) - len(best.kept)
    known = f"only {fit}" if fit else "none"
    verb = "fit" if fit > 1 else "fits"
    return f"{known} of {counted(len(best.points), 'vertex')} {verb} numbers of {best.field_name}"


def resolution(drawing: Drawing) -> Fraction:
    """The last decimal digit of the coordinates, in units of the larger side, at least 1e-9.

    Coordinates with square roots, and fractions without a finite decimal, count as exact.

    >>> resolution(Drawing(((Fraction("0.333"), 2), (0, 0)), (), "two points"))
    Fraction(1, 2000)
    """
    if any(isinstance(c, Surd) for point in drawing.points for c in point):
        return _FINEST
    written = _fractions(drawing)
    return max(_FINEST, _last_digit(written, _size(written)))


# --- fitting -------------------------------------------------------------------------------------


def _fitted(
    drawing: Drawing, written: Written, seen: Sequence[Frame], size: Fraction, within: Fraction
) -> Exact | None:
    best: Model | None = None
    for radicand in RADICANDS:
        for frame in seen:
            model = fitted_model(frame, radicand, within * size / frame.unit)
            if model.bits < _LEAST_BITS:
                continue
            if not model.open:
                return _finished(drawing, written, size, within, model)
            if best is None or model.bits > best.bits:
                best = model
    return None if best is None else _finished(drawing, written, size, within, best)


def _finished(
    drawing: Drawing,
    written: Written,
    size: Fraction,
    within: Fraction,
    model: Model,
) -> Exact:
    model = refined(model)
    frame, limit = model.frame, float(model.within)
    made = dict(constructed(frame.places, model.known, drawing.lines, model.radicand, limit))
    model = extended(model, made)
    made |= constructed(frame.places, model.known, drawing.lines, model.radicand, limit)
    points: list[Point] = []
    kept = []
    for v, ((x, y), stand_in) in enumerate(zip(model.known, model.representatives, strict=True)):
        if v in made:
            points.append(made[v])
            continue
        if x is None or y is None:
            kept.append(v)
        points.append((stand_in[0] if x is None else x, stand_in[1] if y is None else y))
    (x0, y0), unit = frame.origin, frame.unit
    move = max(
        abs(float(a * unit + c - b))
        for point, drawn in zip(points, written, strict=True)
        for a, b, c in zip(point, drawn, (x0, y0), strict=True)
    )
    left = set(kept)
    fitting = [point for v, point in enumerate(points) if v not in left]
    return Exact(
        _with(drawing, points),
        radicand=model.radicand if any(isinstance(c, Surd) for p in points for c in p) else 1,
        denominator=_largest(fitting),
        origin=frame.origin,
        unit=unit,
        tolerance=within,
        largest_move=move / float(size),
        bits=model.bits,
        constructed=len(made),
        kept=tuple(kept),
    )


def _tolerances(written: Written, size: Fraction) -> list[Fraction]:
    finest = max(_FINEST, _last_digit(written, size))
    return [finest, *(coarser for coarser in _COARSER if coarser > finest)]


def _last_digit(written: Written, size: Fraction) -> Fraction:
    """10^-k over the size, where k is the largest number of decimals of a coordinate.

    Coordinates that are noise about zero are ignored. The result is zero if the decimals lie on a
    grid so coarse that they count as exact.
    """
    values = {c for point in written for c in point if abs(c) > _FINEST * size}
    if lcm(*(value.denominator for value in values)) * size <= _WRITTEN:
        return Fraction(0)
    digits = 0
    for value in values:
        rest, twos, fives = value.denominator, 0, 0
        twos = (rest & -rest).bit_length() - 1
        rest >>= twos
        while rest % 5 == 0:
            rest, fives = rest // 5, fives + 1
        if rest > 1:
            return Fraction(0)
        digits = max(digits, twos, fives)
    return Fraction(1, 10**digits) / size


# --- small parts ---------------------------------------------------------------------------------


def _fractions(drawing: Drawing) -> list[tuple[Fraction, Fraction]]:
    points = []
    for x, y in drawing.points:
        if isinstance(x, Surd) or isinstance(y, Surd):
            raise UsageError("the coordinates of this drawing are irrational and already exact")
        points.append((Fraction(x), Fraction(y)))
    return points


def _size(written: Written) -> Fraction:
    if not written:
        raise MalformedPatternError("the drawing has no points")
    xs, ys = [x for x, _ in written], [y for _, y in written]
    size = max(max(xs) - min(xs), max(ys) - min(ys))
    if not size:
        raise MalformedPatternError("all points of the drawing coincide")
    return size


def _with(drawing: Drawing, points: Sequence[Point]) -> Drawing:
    return replace(drawing, points=tuple(points), exact=False)


def _parts(points: Sequence[Point]) -> list[int]:
    return [
        part.denominator
        for point in points
        for c in point
        for part in (c.coefficients if isinstance(c, Surd) else (Fraction(c),))
    ]


def _common(points: Sequence[Point]) -> int:
    return lcm(*_parts(points))


def _largest(points: Sequence[Point]) -> int:
    return max(_parts(points), default=1)


def _denominators(largest: int) -> str:
    return "whole numbers" if largest == 1 else f"denominators up to {largest}"
