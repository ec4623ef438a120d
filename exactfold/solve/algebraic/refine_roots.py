"""Newton's method at rising precision for all zeros of a system at once."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import chain
from typing import Protocol, TypeAlias

from flint import acb, acb_mat, arb, arb_mat, ctx

from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.numeric.candidates import Candidates

_FIRST = 384  # bits after the point for the first steps
_MOST_STEPS = 40  # convergence from double precision takes about five
_GUARD = 32
_REAL = 64  # if the first imaginary parts are below 2^-64, the zero counts as real

Value: TypeAlias = "arb | acb"


class Centre(Protocol):
    """The parts of an isolating box that are read: its centre (real + i imag) / 2^bits.

    `imag` is empty for a real box.
    """

    @property
    def real(self) -> tuple[int, ...]: ...  # noqa: D102

    @property
    def imag(self) -> tuple[int, ...]: ...  # noqa: D102

    @property
    def bits(self) -> int: ...  # noqa: D102


@dataclass
class RefinedRoots:
    """Approximate zeros of a system: the real ones, and one of each pair of conjugate zeros.

    They are numbers of any length, but not enclosures. `accuracy` is the number of bits after the
    point that are believed to be right, from the lengths of the Newton steps. `guard` is the number
    of bits that a step loses. Nothing here is proved.

    >>> import numpy as np
    >>> system = QuadraticSystem((((1, 0), (0, -2)),))
    >>> roots = refined_roots(system, Candidates("guess", np.array([[1.4], [-1.4]], dtype=complex)))
    >>> roots.refine(1000), len(roots.real)
    (True, 2)
    >>> with ctx.workprec(1000):
    ...     abs(roots.real[0][0] ** 2 - 2) < arb(2) ** -900
    True
    """

    system: QuadraticSystem
    real: list[list[arb]]
    upper: list[list[acb]]
    accuracy: int = 0
    guard: int = 32

    def refine(self, bits: int) -> bool:
        """Does Newton steps until `accuracy` is at least `bits`; False if they do not converge."""
        if self.accuracy == 0 and not self._start():
            return False
        while self.accuracy < bits:
            # As few doublings as possible, and each as short as this allows.
            target = bits
            while target > 2 * (self.accuracy - self.guard):
                target = target // 2 + 2 * self.guard
            length = self._step(target + self.guard)
            reached = min(2 * length - self.guard, target)
            if reached <= self.accuracy:
                return False
            self.accuracy = reached
        return True

    def _start(self) -> bool:
        """Does Newton steps from the first guesses until only rounding errors are left.

        The rounding errors show how many bits are lost to the condition of the zeros.
        """
        bits = _FIRST
        for _ in range(_MOST_STEPS):
            length = self._step(bits)
            if length == -_MUCH:
                return False
            if length > bits // 2:
                guard = _GUARD + max(0, bits - self._step(bits))
                if 6 * guard <= bits:
                    self.guard, self.accuracy = guard, bits - guard
                    return True
                bits *= 2
        return False

    def _step(self, bits: int) -> int:
        """Does a Newton step at every zero; returns b if all steps are shorter than 2^-b."""
        return min(self._newton(row, bits) for row in chain(self.real, self.upper))

    def _newton(self, row: list[Value], bits: int) -> int:
        """Does a Newton step at one zero, in place; returns b if the step is shorter than 2^-b.

        The zero is rounded `bits` after the point. The result is -`_MUCH` if no step was possible.
        """
        n = self.system.size
        matrix = acb_mat if isinstance(row[0], acb) else arb_mat
        above = max(0, *(-bits_after_point(x) for x in row))
        with ctx.workprec(bits + above + self.guard):
            z = [*row, arb(1)]
            products = matrix(len(self._pairs), 1, [z[i] * z[j] for i, j in self._pairs])
            twice = matrix(self._weights) * products
        # The step begins `accuracy` bits after the point; only later bits must be right.
        with ctx.workprec(bits - self.accuracy + above + self.guard):
            jacobian = matrix(n, n, (matrix(self._gradients) * matrix(n + 1, 1, z)).entries())
            try:
                change = jacobian.solve(twice, algorithm="approx").entries()
            except ZeroDivisionError:
                return -_MUCH
            change = [x / 2 for x in change]
        if not all(x.is_finite() for x in change):
            return -_MUCH
        with ctx.workprec(bits + above + self.guard):
            for k, x in enumerate(change):
                row[k] = _middle(row[k] - x)
        return min(bits_after_point(x) for x in change)

    @cached_property
    def _pairs(self) -> list[tuple[int, int]]:
        """The pairs (i, j) of the products z_i z_j that occur."""
        indices = range(self.system.size + 1)
        return [(i, j) for i in indices for j in indices[i:] if any(m[i][j] for m in self._forms)]

    @property
    def _forms(self) -> Sequence[Sequence[Sequence[int]]]:
        return self.system.matrices

    @cached_property
    def _weights(self) -> arb_mat:
        """The forms 2 F_p = z^T S_p z as rows of a matrix, on the products z_i z_j."""
        weights = [m[i][j] * (1 + (i != j)) for m in self._forms for i, j in self._pairs]
        return arb_mat(self.system.size, len(self._pairs), weights)

    @cached_property
    def _gradients(self) -> arb_mat:
        """The rows of all S_p that belong to unknowns, below each other."""
        n = self.system.size
        return arb_mat(n * n, n + 1, [x for m in self._forms for row in m[:n] for x in row])


_MUCH = 1 << 30


def refined_roots(
    system: QuadraticSystem, roots: Candidates | Iterable[Centre], *, some: bool = False
) -> RefinedRoots | None:
    """The zeros near the given points, at the first accuracy.

    Points are the rows of `Candidates`, or the centres of isolating boxes. Of two conjugate points,
    the one with a positive first imaginary part is kept. The result is None if Newton's method does
    not converge, or if there are not 2^n points, unless `some` are enough.
    """
    if isinstance(roots, Candidates):
        rows = [[acb(x.real, x.imag) for x in row] for row in roots.points.tolist()]
    else:
        rows = [_centre(box) for box in roots]
    finite = all(x.is_finite() for row in rows for x in row)
    wanted = len(rows) if some else system.bezout_number
    if len(rows) != wanted or not rows or system.size == 0 or not finite:
        return None
    real = [row for row in rows if all(x.imag == 0 for x in row)]
    refined = RefinedRoots(
        system,
        [[x.real for x in row] for row in real],
        [row for row in rows if any(x.imag != 0 for x in row)],
    )
    if not refined.refine(_FIRST // 2):
        return None
    upper = []
    for row in refined.upper:
        heights = [x.imag for x in row if bits_after_point(x.imag) < _REAL]
        if not heights:
            refined.real.append([x.real for x in row])
        elif heights[0] > 0:
            upper.append(row)
    refined.upper = upper
    return refined if len(refined.real) + 2 * len(upper) == wanted else None


def _centre(box: Centre) -> list[acb]:
    scale = arb(2) ** -box.bits
    with ctx.workprec(max((abs(x).bit_length() for x in (*box.real, *box.imag)), default=1) + 2):
        imag = box.imag or (0,) * len(box.real)
        return [acb(x * scale, y * scale) for x, y in zip(box.real, imag, strict=True)]


def _middle(value: Value) -> Value:
    return acb(value.real.mid(), value.imag.mid()) if isinstance(value, acb) else value.mid()


def bits_after_point(value: Value) -> int:
    """The largest b, up to an error of one, with |value| < 2^-b; very large for zero."""
    parts = (value.real, value.imag) if isinstance(value, acb) else (value,)
    sizes = []
    for part in parts:
        mantissa, exponent = part.mid().man_exp()
        sizes.append(-int(mantissa.bit_length() + exponent) if mantissa else _MUCH)
    return min(sizes)
