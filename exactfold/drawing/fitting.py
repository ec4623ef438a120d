"""A frame and a field for a drawing: what each coordinate is in it, and against what odds."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import Final, TypeAlias

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.drawing.candidates import Match, matches, reduced_match
from exactfold.exact.surds import Number

Written: TypeAlias = Sequence[tuple[Fraction, Fraction]]
"""Points as the file states them."""

_NOISE: Final = Fraction(1, 2**46)
"""The least noise that is expected in coordinates computed in floats."""


@dataclass(frozen=True)
class Model:
    """A frame, a field and what each coordinate is there.

    `places` are the points in the frame, in floats; `known` their coordinates in the field, None
    where nothing fits; `representatives` the shortest of the decimals that agree; `within` the
    tolerance in the frame, `bits` minus the logarithm of the probability of such a fit by chance.
    """

    origin: tuple[Fraction, Fraction]
    unit: Fraction
    radicand: int
    places: FloatArray
    known: list[tuple[Number | None, Number | None]]
    representatives: list[tuple[Fraction, Fraction]]
    within: float
    bits: float

    @property
    def open(self) -> int:
        """How many points lack a coordinate."""
        return sum(x is None or y is None for x, y in self.known)


def refined(model: Model) -> Model:
    """Larger numbers for what fits none, within four times the noise of those that fit."""
    noise = [abs(float(c - r)) for c, r in _paired(model) if c is not None]
    within = min(Fraction(model.within), max(_NOISE, 4 * Fraction(max(noise, default=1.0))))
    tried = {r: reduced_match(r, within, model.radicand) for c, r in _paired(model) if c is None}
    found = {r: match for r, match in tried.items() if match is not None}
    flat = [found[r].value if c is None and r in found else c for c, r in _paired(model)]
    bits = model.bits + sum(match.bits for match in found.values())
    return replace(model, known=list(zip(flat[::2], flat[1::2], strict=True)), bits=bits)


def _paired(model: Model) -> Iterator[tuple[Number | None, Fraction]]:
    """Each coordinate, x before y, with its decimals."""
    for known, decimals in zip(model.known, model.representatives, strict=True):
        yield from zip(known, decimals, strict=True)


def fitted_model(
    written: Written,
    origin: tuple[Fraction, Fraction],
    unit: Fraction,
    radicand: int,
    within: Fraction,
) -> Model:
    """Match the coordinates with small numbers; decimals that agree are matched together."""
    columns: list[list[Number | None]] = []
    stand_ins: list[list[Fraction]] = []
    total = 0.0
    for axis in (0, 1):
        exact = [(point[axis] - origin[axis]) / unit for point in written]
        groups = _groups(exact, float(within))
        middle = np.array([float(exact[group[len(group) // 2]]) for group in groups])
        found: list[Match | None] = matches(middle, float(within), radicand)
        column: list[Number | None] = [None] * len(exact)
        stand_in = list(exact)
        for group, match in zip(groups, found, strict=True):
            shortest = min((exact[v] for v in group), key=lambda c: (c.denominator, c))
            for v in group:
                column[v] = None if match is None else match.value
                stand_in[v] = shortest
            total += 0.0 if match is None else match.bits
        columns.append(column)
        stand_ins.append(stand_in)
    places = np.array([[float((p[k] - origin[k]) / unit) for k in (0, 1)] for p in written])
    return Model(
        origin,
        unit,
        radicand,
        places,
        list(zip(*columns, strict=True)),
        list(zip(*stand_ins, strict=True)),
        float(within),
        total,
    )


def _groups(values: Sequence[Fraction], within: float) -> list[list[int]]:
    """Indices of values that agree to within the tolerance, none further apart."""
    floats = [float(value) for value in values]
    order = sorted(range(len(values)), key=floats.__getitem__)
    groups: list[list[int]] = []
    for v in order:
        last = groups[-1] if groups else None
        if last is not None and floats[v] - floats[last[0]] <= within:
            last.append(v)
        else:
            groups.append([v])
    return groups


def frames(
    written: Written,
) -> list[tuple[tuple[Fraction, Fraction], Fraction]]:
    """As written; from the lower left corner in units of the width; and of the height."""
    xs, ys = zip(*written, strict=True)
    corner = (min(xs), min(ys))
    zero = (Fraction(0), Fraction(0))
    frames = [(zero, Fraction(1))]
    for unit in (max(xs) - min(xs), max(ys) - min(ys)):
        if unit and (corner, unit) not in frames:
            frames.append((corner, unit))
    return frames
