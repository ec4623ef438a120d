"""Fits the coordinates of a drawing with numbers of a field, and weighs each fit against chance."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import Final, TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.exact.surds import Number
from exactfold.pattern.drawing.candidates import Match, field_of, matches, reduced_match

Written: TypeAlias = Sequence[tuple[Fraction, Fraction]]
"""The points as the file states them."""

_EXTENSIONS: Final = {
    1: [field_of(2), field_of(3), field_of(5)],
    2: [
        field_of(2).adjoined(2 + field_of(2).root),
        field_of(2).adjoined(3),
        field_of(2).adjoined(5),
    ],
    3: [field_of(3).adjoined(2)],
    5: [field_of(5).adjoined(10 + 2 * field_of(5).root), field_of(5).adjoined(2)],
}
"""Fields with one more root, by the radicand of the field; some are for 22.5, 15, 18 degrees."""
_SURE: Final = 12.0
"""By so many bits a number with one more root must beat chance."""
_SAMPLE: Final = 24
_NOISE: Final = Fraction(1, 2**46)
"""The least noise that coordinates from float computations are assumed to have."""


@dataclass(frozen=True)
class Frame:
    """The points of a drawing, measured from an origin in a unit of length: exactly and as floats.

    `points` holds the exact coordinates, `places` the floats.
    """

    origin: tuple[Fraction, Fraction]
    unit: Fraction
    points: Written
    places: FloatArray


@dataclass(frozen=True)
class Model:
    """A frame, a field, and the numbers of the field that the coordinates fit.

    `known` holds the coordinates of the points in the field; a coordinate that fits no number is
    None. `groups` holds, for x and for y, the groups of points whose decimals agree. `within` is
    the tolerance in the frame. `bits` is minus the binary logarithm of the probability that chance
    gives such a fit.
    """

    frame: Frame
    radicand: int
    known: list[tuple[Number | None, Number | None]]
    groups: tuple[list[list[int]], list[list[int]]]
    within: Fraction
    bits: float

    @property
    def open(self) -> int:
        """The number of points that lack a coordinate."""
        return sum(x is None or y is None for x, y in self.known)

    @cached_property
    def representatives(self) -> list[tuple[Fraction, Fraction]]:
        """For each coordinate, the shortest decimal among those that agree with it."""
        columns = []
        for axis, groups in enumerate(self.groups):
            column = [point[axis] for point in self.frame.points]
            for group in groups:
                shortest = min((column[v] for v in group), key=lambda c: (c.denominator, c))
                for v in group:
                    column[v] = shortest
            columns.append(column)
        return list(zip(*columns, strict=True))


def refined(model: Model) -> Model:
    """Fits larger numbers to the rest, within four times the noise of the coordinates that fit."""
    within, field = _noise(model), field_of(model.radicand)
    tried = {r: reduced_match(r, within, field) for r in _left(model)}
    return _with(model, {r: match for r, match in tried.items() if match is not None})


def extended(model: Model, made: Mapping[int, tuple[Number, Number]]) -> Model:
    """Adds the points that were `made`, and one more root if half of the rest fits with it.

    22.5-degree designs with lengths along slanted lines are an example: most coordinates lie in
    Q(sqrt 2), others in Q(sqrt 2, sqrt (2 + sqrt 2)).
    """
    within = _noise(model)
    model = replace(model, known=[made.get(v, pair) for v, pair in enumerate(model.known)])
    left = _left(model)
    best: dict[Fraction, Match] = {}
    for field in _EXTENSIONS[model.radicand] if left else ():
        fits: dict[Fraction, Match] = {}
        for done, r in enumerate(left, 1):
            if (match := reduced_match(r, within, field, _SURE)) is not None:
                fits[r] = match
            if done >= _SAMPLE and 2 * len(fits) < done:
                break
        if 2 * len(fits) >= len(left) and len(fits) > len(best):
            best = fits
    return _with(model, best)


def _noise(model: Model) -> Fraction:
    """Four times the largest distance between a fitting coordinate and its decimals."""
    noise = [abs(float(c - r)) for c, r in _paired(model) if c is not None]
    return min(model.within, max(_NOISE, 4 * Fraction(max(noise, default=1.0))))


def _left(model: Model) -> list[Fraction]:
    """The decimals that do not fit any number."""
    return list(dict.fromkeys(r for c, r in _paired(model) if c is None))


def _with(model: Model, fits: Mapping[Fraction, Match]) -> Model:
    flat = [fits[r].value if c is None and r in fits else c for c, r in _paired(model)]
    bits = model.bits + sum(match.bits for match in fits.values())
    return replace(model, known=list(zip(flat[::2], flat[1::2], strict=True)), bits=bits)


def _paired(model: Model) -> Iterator[tuple[Number | None, Fraction]]:
    """Yields each coordinate with its decimals, x before y."""
    for known, decimals in zip(model.known, model.representatives, strict=True):
        yield from zip(known, decimals, strict=True)


def fitted_model(frame: Frame, radicand: int, within: Fraction) -> Model:
    """Matches the coordinates with small numbers; decimals that agree are matched together."""
    columns: list[list[Number | None]] = []
    groups = (
        _groups(frame.places[:, 0], float(within)),
        _groups(frame.places[:, 1], float(within)),
    )
    total = 0.0
    for axis, alike in enumerate(groups):
        middle = np.array([frame.places[group[len(group) // 2], axis] for group in alike])
        fits: list[Match | None] = matches(middle, float(within), radicand)
        column: list[Number | None] = [None] * len(frame.points)
        for group, match in zip(alike, fits, strict=True):
            for v in group:
                column[v] = None if match is None else match.value
            total += 0.0 if match is None else match.bits
        columns.append(column)
    return Model(frame, radicand, list(zip(*columns, strict=True)), groups, within, total)


def _groups(values: FloatArray, within: float) -> list[list[int]]:
    """Groups of indices; the values in a group differ by at most the tolerance."""
    floats = values.tolist()
    groups: list[list[int]] = []
    for v in np.argsort(values, kind="stable").tolist():
        last = groups[-1] if groups else None
        if last is not None and floats[v] - floats[last[0]] <= within:
            last.append(v)
        else:
            groups.append([v])
    return groups


def frames(written: Written) -> list[Frame]:
    """The frames to try: as written, then from the lower left corner in widths, then in heights."""
    xs, ys = zip(*written, strict=True)
    corner = (min(xs), min(ys))
    zero = (Fraction(0), Fraction(0))
    frames = [(zero, Fraction(1))]
    for unit in (max(xs) - min(xs), max(ys) - min(ys)):
        if unit and (corner, unit) not in frames:
            frames.append((corner, unit))
    return [_frame(written, origin, unit) for origin, unit in frames]


def _frame(written: Written, origin: tuple[Fraction, Fraction], unit: Fraction) -> Frame:
    (x0, y0), scale = origin, 1 / unit
    points = [((x - x0) * scale, (y - y0) * scale) for x, y in written]
    return Frame(origin, unit, points, np.array([[float(x), float(y)] for x, y in points]))
