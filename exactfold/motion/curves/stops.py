"""Hard stops: the motion ends where the first fold reaches the angle of its stop."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from math import radians
from types import MappingProxyType
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.errors import UsageError
from exactfold.exact.numbers import format_rational
from exactfold.motion.curves.drive import not_a_fold
from exactfold.motion.curves.events import STOP, Event
from exactfold.motion.curves.zeros import zero_of
from exactfold.pattern.crease_pattern import Edge

_AT_ONCE: Final = 1e-9
_WITHIN: Final = 1e-13


@dataclass(frozen=True)
class Stops:
    """The largest size that fold angles can have, in degrees: of all folds, and of single ones.

    A stop of a single fold replaces that of all folds. Raises `UsageError` for an angle that is not
    between 0 and 180 degrees.

    >>> Stops(Fraction(120), {(0, 4): Fraction(90)}).text
    'all folds 120, 0-4 90 degrees'
    """

    everywhere: Fraction | None
    single: Mapping[Edge, Fraction] = field(default_factory=dict)

    def __post_init__(self) -> None:
        object.__setattr__(self, "single", MappingProxyType(dict(self.single)))
        every = () if self.everywhere is None else (self.everywhere,)
        for angle in (*every, *self.single.values()):
            if not 0 < angle < 180:
                raise UsageError(
                    f"a stop at {format_rational(angle)} degrees: give an angle between 0 and 180"
                )

    def __reduce__(self) -> tuple[object, ...]:
        return Stops, (self.everywhere, dict(self.single))

    @property
    def text(self) -> str:
        """All stops in words."""
        parts = [] if self.everywhere is None else [f"all folds {format_rational(self.everywhere)}"]
        parts += [f"{i}-{j} {format_rational(a)}" for (i, j), a in sorted(self.single.items())]
        return f"{', '.join(parts)} degrees"

    def of(self, folds: tuple[Edge, ...]) -> dict[Edge, Fraction]:
        """The stop of each fold that has one, in degrees; `UsageError` for what is no fold."""
        for fold in self.single:
            if fold not in folds:
                raise UsageError(not_a_fold(folds, fold, "with a stop"))
        angles = {} if self.everywhere is None else dict.fromkeys(folds, self.everywhere)
        return {**angles, **self.single}

    def to_dict(self, folds: tuple[Edge, ...]) -> dict[str, str]:
        """By fold its stop in degrees, exactly."""
        return {f"{i}-{j}": format_rational(a) for (i, j), a in sorted(self.of(folds).items())}

    def first(
        self,
        folds: tuple[Edge, ...],
        times: FloatArray,
        angles_at: Callable[[FloatArray], FloatArray],
    ) -> Event | None:
        """The first fold that reaches its stop among these times, in floats; or None.

        `angles_at` gives all fold angles at many times, in radians.
        """
        angles = self.of(folds)
        limits = np.array([radians(angles[fold]) if fold in angles else np.inf for fold in folds])

        def beyond(time: float) -> float:
            return float((np.abs(angles_at(np.array([time]))[0]) - limits).max())

        over = (np.abs(angles_at(times)) - limits).max(axis=1) >= 0
        if not over.any():
            return None
        k = int(over.argmax())
        time = zero_of(beyond, float(times[k - 1]), float(times[k]))
        low, high = max(time - _WITHIN, 0.0), min(time + _WITHIN, float(times[-1]))
        reached = np.abs(angles_at(np.array([high]))[0]) > limits - _AT_ONCE
        named = tuple(fold for fold, yes in zip(folds, reached, strict=True) if yes)
        return Event(STOP, (low, high), folds=named)
