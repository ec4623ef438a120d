"""Checks files of loops fast: tubes in floats with proved bounds, and in integers where these fail.

The code of `exactfold.checker` reads the file, rebuilds the sheet and its equations, and verifies
every link, landing and length. Only the numbers of Theorem 1 of a tube (docs/motion.md) are those
of `contraction_in_floats`, whose rounding errors are bounded, and no longer sums of integers.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import partial

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray
from exactfold.certificates.sharing import shared
from exactfold.checker.core.lines import read_object
from exactfold.checker.core.parts import Engine
from exactfold.checker.core.reading import CertificateError
from exactfold.checker.motion.bounds import Bounds
from exactfold.checker.motion.equations import ORDER, LengthEquations
from exactfold.checker.motion.loops import LoopVerifier
from exactfold.checker.motion.tubes import ROW_BITS, Piece, Tube
from exactfold.motion.tubes.float_bounds import contraction_in_floats, series_at

_BITS = 64
"""Numbers of tubes with more bits are computed in integers alone."""
_LARGEST = 2.0**40


@dataclass(frozen=True)
class _Bars:
    """The bars of the equations that the checker has rebuilt, in floats."""

    bars: IndexArray
    flat_edges: FloatArray
    size: int


@dataclass(frozen=True)
class _Equations:
    """These equations, as `contraction_in_floats` takes them."""

    framework: _Bars
    bits: int
    incidence: FloatArray

    @classmethod
    def of(cls, equations: LengthEquations) -> _Equations | None:
        """The equations in floats; None if flat coordinates are not exact in them."""
        one, number = 1 << equations.bits, len(equations.bars)
        if equations.bits > _BITS or equations.ties or equations.mixed:
            return None
        if any(int(x / one * one) != x for row in equations.flat for x in row):
            return None
        incidence = np.zeros((number, 3, equations.size))
        for e, ends in enumerate(equations.bars):
            for v, sign in zip(ends, (1.0, -1.0), strict=True):
                if v in equations.place:
                    for axis in range(3):
                        incidence[e, axis, equations.place[v] + axis] = sign
        flat = np.array([[x / one for x in row] for row in equations.flat])
        bars = _Bars(np.array(equations.bars, dtype=np.intp), flat, equations.size)
        return cls(bars, equations.bits, incidence.reshape(3 * number, -1))

    def floats(self, row: Sequence[int]) -> FloatArray:
        """Integers over 2^bits as floats."""
        one = 1 << self.bits
        return np.array([x / one for x in row])


class _TubeInFloats(Tube):
    """A tube whose bounds come from floats where these suffice."""

    def __init__(
        self,
        floats: _Equations,
        equations: LengthEquations,
        centre: list[int],
        row: list[int],
        reach: Fraction,
    ) -> None:
        if not self._is_proved(floats, equations, centre, row, reach):
            super().__init__(equations, centre, row, reach)

    def _is_proved(
        self,
        floats: _Equations,
        equations: LengthEquations,
        centre: list[int],
        row: list[int],
        reach: Fraction,
    ) -> bool:
        self.row, bits, bars = row, equations.bits, floats.framework
        if max(map(abs, row)) >> 53:
            return False
        along = np.array(row) * 2.0**-ROW_BITS
        edges = bars.flat_edges + (floats.incidence @ floats.floats(centre)).reshape(-1, 3)
        rows = np.einsum("ean,ea->en", floats.incidence.reshape(*edges.shape, bars.size), edges)
        try:
            inverse = np.linalg.inv(np.vstack([rows, along]))
        except np.linalg.LinAlgError:
            return False
        if not np.abs(inverse).max() < _LARGEST:
            return False
        with np.errstate(all="ignore"):
            series, parts = series_at(floats, inverse, ORDER)
            stretch = [
                (2 * u + a) * a + (2 * v + b) * b + c * c
                for (u, v, _), (a, b, c) in zip(
                    equations.flat, equations.along(centre), strict=True
                )
            ]
            found = contraction_in_floats(
                floats, inverse, tuple(centre), [*stretch, 0], along, series, parts
            )
        if found is None:
            return False
        proof, weights = found
        bounds = Bounds(*map(list, (proof.residual, proof.slope, proof.quadratic)))
        terms = [[int(x) << bits - 60 for x in a] for a in np.rint(series * 2.0**60).tolist()]
        try:
            Piece.__init__(self, equations, [centre, *terms], list(weights), bounds, reach)
        except CertificateError:
            return False
        self.apart = bounds.uniqueness(reach)
        return True


class _FastVerifier(LoopVerifier):
    """Verifies loops with tubes in floats, and again in integers before it refuses one."""

    def __init__(self, header: str) -> None:
        super().__init__(header)
        self.floats = _Equations.of(self.sheet.equations)

    def refusal(self, text: str, number: int) -> str | None:
        """Verify one loop; say why it does not hold, or None if it holds."""
        if self.floats is not None:
            try:
                self.sheet.check_loop(
                    read_object(text, "a loop"), partial(_TubeInFloats, self.floats)
                )
            except Exception:
                return super().refusal(text, number)
            return None
        return super().refusal(text, number)


TUBES_IN_FLOATS = Engine(_FastVerifier, 1, shared)
"""The engine that proves tubes in floats first."""
