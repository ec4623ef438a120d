"""Exact Krawczyk test for quadratic systems, in integers over a power of two."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
import numpy.typing as npt
from flint import fmpq, fmpq_mat, fmpz, fmpz_mat

from exactfold.certify.box import IsolatingBox, Uncertified
from exactfold.system.quadratic import QuadraticSystem

FloatArray = npt.NDArray[np.float64]

_PRECISIONS = (64, 128, 256, 512, 1024)
_Y_BITS = 56
_NEGLIGIBLE = 1e-8
_NEWTON_STEPS = 12
_WIDE = 1 << 16
_SLOW = "Newton's steps do not shrink quadratically: the zero is multiple or the candidate far off"


def krawczyk(
    system: QuadraticSystem,
    points: npt.ArrayLike,
    *,
    precisions: Sequence[int] = _PRECISIONS,
) -> list[IsolatingBox | Uncertified]:
    r"""An isolating box around each candidate, proved in exact integer arithmetic, or a reason.

    With m dyadic, Y any dyadic matrix, r > 0 and sup norms let eta = |Y F(m)|,
    k0 = |I - Y F'(m)| and M = max_i sum_jk |sum_p Y_ip (H_p)_jk|. If k0 + r M < 1 and
    eta + (k0 + r M) r < r, then x -> x - Y F(x) maps the box |x - m| <= r into its interior and
    contracts: the box holds exactly one zero, a regular one (Krawczyk 1969; statement 3 of
    docs/mathematics.md).

    `points` has shape (m, n). A candidate whose imaginary parts are negligible is tried as a real
    point, which then proves the zero real; the others are treated as points of R^2n. Floating
    point only chooses m and Y. Precision rises through `precisions` (bits after the point).

    Failure does not mean that there is no zero nearby: the zero may be multiple, the candidate
    too far off, or the precision too low.

    >>> line_pair = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> box, = krawczyk(line_pair, [[1.41421356]])
    >>> [float(bound) for bound in box.interval(0)]
    [1.4142135623730951, 1.4142135623730951]
    """
    array = np.atleast_2d(np.asarray(points, dtype=np.complex128))
    if system.size == 0:  # no equation, no unknown: the one point there is
        return [IsolatingBox((), (), 1, 0) for _ in array]
    results: list[IsolatingBox | Uncertified | None] = [None] * len(array)
    finite = np.isfinite(array).all(axis=1)
    scale = np.maximum(1.0, np.abs(array).max(axis=1, initial=0.0))
    small = np.abs(array.imag).max(axis=1, initial=0.0) <= _NEGLIGIBLE * scale
    for index in np.flatnonzero(~finite):
        results[index] = Uncertified(tuple(array[index].tolist()), "the candidate is not finite")
    real, nonreal = np.flatnonzero(finite & small), np.flatnonzero(finite & ~small)
    if real.size:
        kernel = _Kernel(system)
        for index, box in zip(real, kernel.run(array[real].real, precisions), strict=True):
            results[index] = box if isinstance(box, IsolatingBox) else _named(array[index], box)
    if nonreal.size:
        kernel = _Kernel(system.realification)
        both = np.hstack([array[nonreal].real, array[nonreal].imag])
        for index, box in zip(nonreal, kernel.run(both, precisions), strict=True):
            n = system.size
            results[index] = (
                IsolatingBox(box.real[:n], box.real[n:], box.radius, box.bits)
                if isinstance(box, IsolatingBox)
                else _named(array[index], box)
            )
    return [result for result in results if result is not None]


def krawczyk_at(system: QuadraticSystem, box: IsolatingBox, bits: int) -> IsolatingBox | str:
    """The same zero in a sharper real box, with `bits` bits after the point, or a reason.

    Newton steps start from the centre of `box`; the result is returned only if it lies inside it,
    so that both hold the same zero.
    """
    shift = bits - box.bits
    centre = [m << shift if shift >= 0 else m >> -shift for m in box.real]
    result = _Kernel(system)._attempt_exactly(centre, bits)
    if isinstance(result, IsolatingBox) and not result.is_inside(box):
        return f"the Newton steps at {bits} bits left the box"
    return result


def _named(point: npt.NDArray[np.complex128], reason: str) -> Uncertified:
    return Uncertified(tuple(point.tolist()), reason)


@dataclass(frozen=True)
class _Kernel:
    """The test for one system at real candidates."""

    system: QuadraticSystem

    @cached_property
    def shifted(self) -> tuple[list[list[list[int]]], int]:
        """S_p times a power of two each, so that all have entries of `K` bits at most."""
        largest = [
            max((abs(x) for row in matrix for x in row), default=0).bit_length()
            for matrix in self.system.matrices
        ]
        bits = max(largest)
        matrices = [
            [[x << (bits - own) for x in row] for row in matrix]
            for matrix, own in zip(self.system.matrices, largest, strict=True)
        ]
        return matrices, bits

    @cached_property
    def stacked(self) -> fmpz_mat:
        """All S_p below each other: n (n + 1) rows, n + 1 columns."""
        matrices, _ = self.shifted
        n = self.system.size
        return fmpz_mat(n * (n + 1), n + 1, [x for m in matrices for row in m for x in row])

    @cached_property
    def float_stack(self) -> FloatArray:
        """The same divided by 2^K, as floats of shape (n, n + 1, n + 1)."""
        matrices, bits = self.shifted
        # Dropping the low bits first keeps every conversion in range; Y only needs to be near.
        drop = max(0, bits - 1000)
        scaled = np.array([[[float(x >> drop) for x in row] for row in m] for m in matrices])
        return np.asarray(scaled * 2.0 ** (drop - bits))

    @cached_property
    def hessian_norms(self) -> list[int]:
        """sum_jk |(H_p)_jk| for each p."""
        matrices, _ = self.shifted
        return [sum(abs(x) for row in m[:-1] for x in row[:-1]) for m in matrices]

    def run(self, points: FloatArray, precisions: Sequence[int]) -> list[IsolatingBox | str]:
        """A box or a reason for each row of `points`."""
        first, *rising = precisions
        results: list[IsolatingBox | str] = []
        inverses = self._float_inverses(points)
        for point, inverse in zip(points, inverses, strict=True):
            start = [_dyadic(x, first) for x in point.tolist()]
            result: IsolatingBox | str = "the Jacobian is singular in double precision"
            if np.isfinite(inverse).all():
                result = self._attempt(start, first, inverse)
            if isinstance(result, IsolatingBox) and result.radius > _WIDE:
                sharper = self._attempt_exactly(list(result.real), first)
                if isinstance(sharper, IsolatingBox) and sharper.is_inside(result):
                    result = sharper
            for bits in rising:
                if isinstance(result, IsolatingBox) or result == _SLOW:
                    break
                result = self._attempt_exactly([_dyadic(x, bits) for x in point.tolist()], bits)
            results.append(result)
        return results

    def _float_inverses(self, points: FloatArray) -> FloatArray:
        n = self.system.size
        z = np.hstack([points, np.ones((len(points), 1))])
        jacobians = np.einsum("pij,bj->bpi", self.float_stack, z)[:, :, :n]
        try:
            inverses = np.linalg.inv(jacobians)
        except np.linalg.LinAlgError:
            inverses = np.full_like(jacobians, np.nan)
            for k, jacobian in enumerate(jacobians):
                try:
                    inverses[k] = np.linalg.inv(jacobian)
                except np.linalg.LinAlgError:
                    continue
        return np.asarray(inverses)

    def _attempt(self, m: list[int], bits: int, inverse: FloatArray) -> IsolatingBox | str:
        """Newton steps with a fixed Y from floating point, then the test."""
        largest = float(np.abs(inverse).max())
        if largest == 0.0:
            return "the Jacobian has no usable inverse in double precision"
        q = _Y_BITS - int(np.ceil(np.log2(largest)))
        n = self.system.size
        entries = [_dyadic(x, q) for x in inverse.ravel().tolist()]
        y = fmpz_mat(n, n, entries)
        shift = q + self.shifted[1]
        for _ in range(_NEWTON_STEPS):
            before, m = m, self._newton(m, bits, y, shift)
            if _settled(before, m):
                break
        return self._test(m, bits, y, entries, shift)

    def _attempt_exactly(self, m: list[int], bits: int) -> IsolatingBox | str:
        """Newton with the exact inverse, rounded; for clusters that doubles cannot tell apart."""
        n = self.system.size
        result: IsolatingBox | str = "no Newton step was possible"
        length: int | None = None
        last: int | None = None
        for _ in range(_NEWTON_STEPS):
            jacobian, _values = self._evaluate(m, bits)
            try:
                inverse = fmpq_mat(jacobian).inv()
            except ZeroDivisionError:
                return f"the Jacobian is singular at {bits} bits"
            # jacobian = 2^(bits) F'(m); keep about `bits` significant bits of its inverse.
            cells = (inverse[i, j] for i in range(n) for j in range(n))
            size = max(_magnitude(cell) for cell in cells if cell != 0)
            q = bits + 8 - size - self.shifted[1] - bits
            shift = q + self.shifted[1]
            entries = [
                _round_shift(inverse[i, j], shift + bits) for i in range(n) for j in range(n)
            ]
            y = fmpz_mat(n, n, entries)
            before, m = m, self._newton(m, bits, y, shift)
            result = self._test(m, bits, y, entries, shift)
            sharp = isinstance(result, IsolatingBox) and result.radius <= _WIDE
            if sharp or _settled(before, m):
                return result
            length, last = _distance(before, m), length
        slow = last is not None and length is not None and 8 * length > last
        return _SLOW if slow and not isinstance(result, IsolatingBox) else result

    def _evaluate(self, m: list[int], bits: int) -> tuple[fmpz_mat, fmpz_mat]:
        """2^bits F'(m) as an n x n matrix, and 2^(2 bits + 1) F(m) as a column."""
        n = self.system.size
        z = fmpz_mat(n + 1, 1, [*m, 1 << bits])
        products = (self.stacked * z).entries()
        rows = fmpz_mat(n, n + 1, products)
        values = rows * z
        jacobian = fmpz_mat(n, n, [products[p * (n + 1) + k] for p in range(n) for k in range(n)])
        return jacobian, values

    def _newton(self, m: list[int], bits: int, y: fmpz_mat, shift: int) -> list[int]:
        _, values = self._evaluate(m, bits)
        step = (y * values).entries()
        down = shift + bits + 1
        return [a - int(_shift_round(s, down)) for a, s in zip(m, step, strict=True)]

    def _test(
        self, m: list[int], bits: int, y: fmpz_mat, entries: list[int], shift: int
    ) -> IsolatingBox | str:
        """The Krawczyk inequalities at m, Y = y / 2^shift, for the smallest radius that fits."""
        n = self.system.size
        jacobian, values = self._evaluate(m, bits)
        unit = 1 << (shift + bits)
        product = (y * jacobian).entries()
        k0 = 0
        for i in range(n):
            row = product[i * n : (i + 1) * n]
            row[i] = row[i] - unit
            k0 = max(k0, int(sum(abs(x) for x in row)))
        if k0 >= unit:
            return f"|I - Y F'(m)| is not below 1 at {bits} bits: the zero may be multiple"
        eta = max(abs(int(x)) for x in (y * values).entries())
        norms = self.hessian_norms
        bound = max(
            sum(abs(e) * w for e, w in zip(entries[i * n : (i + 1) * n], norms, strict=True))
            for i in range(n)
        )
        radius = max(1, eta // (2 * (unit - k0)) + 1)
        for _ in range(3):
            contraction = k0 + radius * bound
            if contraction < unit and eta < 2 * radius * (unit - contraction):
                return IsolatingBox(tuple(m), (), radius, bits)
            radius *= 2
        return f"no contraction at {bits} bits: the zero may be multiple or too far off"


def _distance(before: list[int], after: list[int]) -> int:
    return max(abs(a - b) for a, b in zip(before, after, strict=True))


def _settled(before: list[int], after: list[int]) -> bool:
    return _distance(before, after) <= 2


def _dyadic(value: float, bits: int) -> int:
    """The integer nearest to value * 2^bits, exactly rounded from the double."""
    numerator, denominator = value.as_integer_ratio()
    return (
        _divide_round(numerator << bits, denominator)
        if bits >= 0
        else _divide_round(numerator, denominator << -bits)
    )


def _divide_round(a: int, b: int) -> int:
    return (2 * a + b) // (2 * b)


def _shift_round(value: fmpz, bits: int) -> fmpz:
    return (value + (fmpz(1) << (bits - 1))) >> bits if bits > 0 else value << -bits


def _magnitude(value: fmpq) -> int:
    """Bit length of |value| within one, for value != 0."""
    return int(value.p).bit_length() - int(value.q).bit_length()


def _round_shift(value: fmpq, bits: int) -> int:
    a, b = int(value.p), int(value.q)
    return _divide_round(a << bits, b) if bits >= 0 else _divide_round(a, b << -bits)
