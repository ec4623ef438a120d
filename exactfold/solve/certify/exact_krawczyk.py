"""Exact Krawczyk test for quadratic systems, in integers over a power of two."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from operator import mul

import numpy as np
from flint import fmpq, fmpq_mat, fmpz, fmpz_mat

from exactfold._support.arrays import FloatArray, inverses
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox, Uncertified
from exactfold.solve.certify.points import (
    REACH,
    Candidate,
    Point,
    Points,
    exact_candidates,
    is_within_reach,
)

_PRECISIONS = (64, 128, 256, 512, 1024)
_Y_BITS = 56
_NEWTON_STEPS = 12
_AT_REST = 2
_WIDE = 1 << 16
_LEFT = "Newton's steps left the candidate"
_SLOW = "Newton's steps do not shrink quadratically: the zero is multiple or the candidate far off"


def krawczyk(
    system: QuadraticSystem,
    points: Points,
    *,
    precisions: Sequence[int] = _PRECISIONS,
    reach: Fraction | None = REACH,
) -> list[IsolatingBox | Uncertified]:
    r"""An isolating box around each candidate, proved in exact integer arithmetic, or a reason.

    Let m be dyadic, Y any dyadic matrix and r > 0. In sup norms let eta = |Y F(m)|,
    k0 = |I - Y F'(m)| and M = max_i sum_jk |sum_p Y_ip (H_p)_jk|. If k0 + r M < 1 and
    eta + (k0 + r M) r < r, then x -> x - Y F(x) maps the box |x - m| <= r into its interior and
    contracts. So the box contains exactly one zero, a regular one (Krawczyk 1969;
    docs/mathematics.md, Krawczyk's test).

    `points` has shape (m, n), with coordinates as in `exact_candidates`; rational coordinates
    separate clusters that doubles cannot. A candidate with negligible imaginary parts is tried as a
    real point, which then proves the zero real. Other candidates, and nearly real ones next to a
    non-real zero, count as points of R^2n. Floating point only chooses m and Y. The precision rises
    through `precisions` (bits after the point). A box further than `reach` max(1, |point|) from its
    candidate is refused; with None, any zero is accepted to which Newton's steps lead.

    Raises `UsageError` if a candidate does not have n coordinates. `Uncertified` does not mean that
    there is no zero nearby: the zero may be multiple, the candidate too far off, or the precision
    too low.

    >>> line_pair = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> box, = krawczyk(line_pair, [[1.41421356]])
    >>> [float(bound) for bound in box.interval(0)]
    [1.4142135623730951, 1.4142135623730951]
    """
    results = list[IsolatingBox | Uncertified | None]()
    real, nonreal = dict[int, Candidate](), dict[int, Candidate]()
    for index, candidate in enumerate(exact_candidates(points, system.size)):
        results.append(candidate if isinstance(candidate, Uncertified) else None)
        if isinstance(candidate, Candidate):
            (real if candidate.is_nearly_real else nonreal)[index] = candidate
    if system.size == 0:  # no equation and no unknown: there is exactly one point
        return [IsolatingBox((), (), 1, 0) for _ in results]
    if real:
        starts = [candidate.real for candidate in real.values()]
        floats = np.array([candidate.shown for candidate in real.values()]).real
        boxes = _Kernel(system).run(starts, floats, precisions, reach)
        for (index, candidate), box in zip(real.items(), boxes, strict=True):
            results[index] = _named(candidate, box)
            if isinstance(box, str) and any(candidate.imag):
                nonreal[index] = candidate
    if nonreal:
        n = system.size
        starts = [(*candidate.real, *candidate.imag) for candidate in nonreal.values()]
        shown = np.array([candidate.shown for candidate in nonreal.values()])
        floats = np.hstack([shown.real, shown.imag])
        boxes = _Kernel(system.realification).run(starts, floats, precisions, reach)
        for (index, candidate), box in zip(nonreal.items(), boxes, strict=True):
            if isinstance(box, IsolatingBox):
                box = IsolatingBox(box.real[:n], box.real[n:], box.radius, box.bits)
            if index not in real or (isinstance(box, IsolatingBox) and box.is_nonreal):
                results[index] = _named(candidate, box)
    return [result for result in results if result is not None]


def decide_contains_one_zero(system: QuadraticSystem, box: IsolatingBox) -> Verdict:
    """Whether a given box contains exactly one zero, a regular one, by the test of `krawczyk`.

    PROVED if the inequalities hold for its centre and radius, with Y the rounded inverse of F'(m);
    REFUTED if some quadric has no zero in the box. Otherwise UNDECIDED, for example if the box is
    too wide, even if it does contain exactly one zero. Imaginary parts make it a box of R^2n.

    >>> line_pair = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> boxes = [IsolatingBox((m,), (), r, 3) for m, r in ((11, 1), (11, 12), (20, 1))]
    >>> [str(decide_contains_one_zero(line_pair, box)) for box in boxes]
    ['proved', 'undecided', 'refuted']
    """
    if system.size == 0:
        return PROVED
    kernel = _Kernel(system if box.is_real else system.realification)
    return kernel.decide([*box.real, *box.imag], box.radius, box.bits)


def krawczyk_at(system: QuadraticSystem, box: IsolatingBox, bits: int) -> IsolatingBox | str:
    """The same zero in a sharper real box, with `bits` bits after the point, or a reason.

    Newton steps start from the centre of `box`. The result is returned only if it lies inside
    `box`, so that both contain the same zero.
    """
    if system.size == 0:  # no equation: there is exactly one point
        return IsolatingBox((), (), box.radius, bits)
    shift = bits - box.bits
    centre = [m << shift if shift >= 0 else m >> -shift for m in box.real]
    result = _Kernel(system)._attempt_exactly(centre, bits)
    if isinstance(result, IsolatingBox) and not result.is_inside(box):
        return f"the Newton steps at {bits} bits left the box"
    return result


def _named(candidate: Candidate, outcome: IsolatingBox | str) -> IsolatingBox | Uncertified:
    return Uncertified(candidate.shown, outcome) if isinstance(outcome, str) else outcome


@dataclass(frozen=True)
class _Kernel:
    """The test for one system at real candidates."""

    system: QuadraticSystem

    @cached_property
    def shifted(self) -> tuple[list[list[list[int]]], int]:
        """Each S_p times a power of two, so that all have entries of at most `K` bits; and K."""
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
    def stacked(self) -> tuple[list[int], fmpz_mat]:
        """The places, among the n (n + 1) rows of all S_p, of the rows that are not 0; these rows.

        Most rows are 0, as a quadric depends only on the heights of one star.
        """
        matrices, _ = self.shifted
        rows = [row for matrix in matrices for row in matrix]
        places = [k for k, row in enumerate(rows) if any(row)]
        cells = [x for k in places for x in rows[k]]
        return places, fmpz_mat(len(places), self.system.size + 1, cells)

    @cached_property
    def float_stack(self) -> FloatArray:
        """All S_p divided by 2^K, as floats of shape (n, n + 1, n + 1)."""
        matrices, bits = self.shifted
        # Dropping low bits first keeps every conversion in range; Y need not be accurate.
        drop = max(0, bits - 1000)
        scaled = np.array([[[float(x >> drop) for x in row] for row in m] for m in matrices])
        return np.asarray(scaled * 2.0 ** (drop - bits))

    @cached_property
    def hessian_norms(self) -> list[int]:
        """The sums over j, k of |(H_p)_jk|, for each p."""
        matrices, _ = self.shifted
        return [sum(abs(x) for row in m[:-1] for x in row[:-1]) for m in matrices]

    def run(
        self,
        points: Sequence[Point],
        floats: FloatArray,
        precisions: Sequence[int],
        reach: Fraction | None,
    ) -> list[IsolatingBox | str]:
        """A box or a reason for each of `points`, which are also given as floats."""
        if not precisions:
            return ["no precision was given" for _ in points]
        first, *rising = precisions
        results: list[IsolatingBox | str] = []
        inverses = self._float_inverses(floats)
        finite = np.isfinite(inverses).all(axis=(1, 2))
        usable = np.asarray(finite & inverses.any(axis=(1, 2)))
        shifts, entries = _fixed_point(np.where(usable[:, None, None], inverses, 1.0))
        for k, (point, row) in enumerate(zip(points, floats.tolist(), strict=True)):
            result: IsolatingBox | str = "the Jacobian has no usable inverse in double precision"
            if usable[k]:
                start = [_dyadic(x, first) for x in row]
                result = self._attempt(start, first, entries[k], shifts[k])
            if isinstance(result, IsolatingBox) and result.radius > _WIDE:
                sharper = self._attempt_exactly(list(result.real), first)
                if isinstance(sharper, IsolatingBox) and sharper.is_inside(result):
                    result = sharper
            if isinstance(result, IsolatingBox) and not is_within_reach(result, point, reach):
                result = f"{_LEFT} at {first} bits"  # perhaps the precision was too low
            for bits in rising:
                if isinstance(result, IsolatingBox) or result in (_SLOW, _LEFT):
                    break
                result = self._attempt_exactly([_dyadic(x, bits) for x in point], bits)
                if isinstance(result, IsolatingBox) and not is_within_reach(result, point, reach):
                    result = _LEFT
            results.append(result)
        return results

    def decide(self, m: list[int], radius: int, bits: int) -> Verdict:
        """Applies the test to the box with the given centre and radius, both over 2^bits."""
        n = self.system.size
        jacobian, values = self._evaluate(m, bits)
        norms = [sum(abs(jacobian[p, k]) for k in range(n)) for p in range(n)]
        for value, norm, curved in zip(values.entries(), norms, self.hessian_norms, strict=True):
            if abs(value) > 2 * radius * norm + radius**2 * curved:
                return REFUTED
        rounded = self._rounded_inverse(jacobian, bits, 2 * max(bits, _Y_BITS))
        if rounded is None:
            return UNDECIDED
        entries, shift = rounded
        y = fmpz_mat(n, n, entries)
        k0, eta, bound, unit = self._norms(jacobian, values, bits, y, entries, shift)
        contraction = k0 + radius * bound
        proved = contraction < unit and eta < 2 * radius * (unit - contraction)
        return PROVED if proved else UNDECIDED

    def _float_inverses(self, points: FloatArray) -> FloatArray:
        n = self.system.size
        z = np.hstack([points, np.ones((len(points), 1))])
        with np.errstate(all="ignore"):
            jacobians = np.einsum("pij,bj->bpi", self.float_stack, z)[:, :, :n]
        return inverses(jacobians)

    def _attempt(self, m: list[int], bits: int, entries: list[int], q: int) -> IsolatingBox | str:
        """Newton steps with a fixed float Y = entries / 2^q, and then the test."""
        y = fmpz_mat(self.system.size, self.system.size, entries)
        shift = q + self.shifted[1]
        if shift + bits < 0:
            return f"the inverse of the Jacobian is too large at {bits} bits"
        jacobian, values = self._evaluate(m, bits)
        for _ in range(_NEWTON_STEPS):
            step = self._step(values, bits, y, shift)
            if max(map(abs, step)) <= _AT_REST:
                break
            m = [a - s for a, s in zip(m, step, strict=True)]
            jacobian, values = self._evaluate(m, bits)
        return self._test(m, jacobian, values, bits, y, entries, shift)

    def _attempt_exactly(self, m: list[int], bits: int) -> IsolatingBox | str:
        """Newton steps with the rounded exact inverse, for clusters that doubles cannot resolve."""
        n = self.system.size
        result: IsolatingBox | str = "no Newton step was possible"
        length: int | None = None
        last: int | None = None
        for _ in range(_NEWTON_STEPS):
            jacobian, values = self._evaluate(m, bits)
            rounded = self._rounded_inverse(jacobian, bits, bits)
            if rounded is None:
                return f"the Jacobian is singular at {bits} bits"
            entries, shift = rounded
            y = fmpz_mat(n, n, entries)
            step = self._step(values, bits, y, shift)
            m = [a - s for a, s in zip(m, step, strict=True)]
            result = self._test(m, *self._evaluate(m, bits), bits, y, entries, shift)
            sharp = isinstance(result, IsolatingBox) and result.radius <= _WIDE
            if sharp or max(map(abs, step)) <= _AT_REST:
                return result
            length, last = max(map(abs, step)), length
        slow = last is not None and length is not None and 8 * length > last
        return _SLOW if slow and not isinstance(result, IsolatingBox) else result

    def _evaluate(self, m: list[int], bits: int) -> tuple[fmpz_mat, fmpz_mat]:
        """The n x n matrix 2^bits F'(m), and the column 2^(2 bits + 1) F(m)."""
        n = self.system.size
        z = fmpz_mat(n + 1, 1, [*m, 1 << bits])
        places, stacked = self.stacked
        products: list[int | fmpz] = [0] * (n * (n + 1))
        for place, product in zip(places, (stacked * z).entries(), strict=True):
            products[place] = product
        values = fmpz_mat(n, n + 1, products) * z
        del products[n :: n + 1]
        return fmpz_mat(n, n, products), values

    def _step(self, values: fmpz_mat, bits: int, y: fmpz_mat, shift: int) -> list[int]:
        """The step Y F(m) that Newton's method subtracts from m, rounded to units of 2^-bits."""
        down = shift + bits + 1
        return [int(_shift_round(s, down)) for s in (y * values).entries()]

    def _rounded_inverse(
        self, jacobian: fmpz_mat, bits: int, significant: int
    ) -> tuple[list[int], int] | None:
        """The entries of 2^shift Y for jacobian = 2^bits F'(m), and shift; None if singular."""
        try:
            cells = fmpq_mat(jacobian).inv().entries()
        except ZeroDivisionError:
            return None
        size = max(_magnitude(cell) for cell in cells if cell != 0)
        shift = significant + 8 - size - bits
        if shift + bits < 0:
            return None
        return [_round_shift(cell, shift + bits) for cell in cells], shift

    def _norms(
        self,
        jacobian: fmpz_mat,
        values: fmpz_mat,
        bits: int,
        y: fmpz_mat,
        entries: list[int],
        shift: int,
    ) -> tuple[int, int, int, int]:
        """k0 and M times `unit`, and eta times 2 `unit` (M and eta in units of 2^-bits)."""
        n = self.system.size
        unit = 1 << (shift + bits)
        product = (y * jacobian).entries()
        k0 = 0
        for i in range(n):
            row = product[i * n : (i + 1) * n]
            row[i] = row[i] - unit
            k0 = max(k0, int(sum(map(abs, row))))
        eta = max(abs(int(x)) for x in (y * values).entries())
        sizes = list(map(abs, entries))
        bound = max(sum(map(mul, sizes[i * n : (i + 1) * n], self.hessian_norms)) for i in range(n))
        return k0, eta, bound, unit

    def _test(
        self,
        m: list[int],
        jacobian: fmpz_mat,
        values: fmpz_mat,
        bits: int,
        y: fmpz_mat,
        entries: list[int],
        shift: int,
    ) -> IsolatingBox | str:
        """Tests the Krawczyk inequalities at m, with Y = y / 2^shift, for the smallest radius."""
        k0, eta, bound, unit = self._norms(jacobian, values, bits, y, entries, shift)
        if k0 >= unit:
            return f"|I - Y F'(m)| is not below 1 at {bits} bits: the zero may be multiple"
        radius = max(1, eta // (2 * (unit - k0)) + 1)
        for _ in range(3):
            contraction = k0 + radius * bound
            if contraction < unit and eta < 2 * radius * (unit - contraction):
                return IsolatingBox(tuple(m), (), radius, bits)
            radius *= 2
        return f"no contraction at {bits} bits: the zero may be multiple or too far off"


def _fixed_point(matrices: FloatArray) -> tuple[list[int], list[list[int]]]:
    """For finite nonzero matrices: shifts q, and entries times 2^q of at most `_Y_BITS` bits."""
    sizes = np.frexp(np.abs(matrices).max(axis=(1, 2)))[1]
    shifts = _Y_BITS - sizes
    entries = np.rint(np.ldexp(matrices, shifts[:, None, None])).astype(np.int64)
    return shifts.tolist(), entries.reshape(len(matrices), -1).tolist()


def _dyadic(value: float | Fraction, bits: int) -> int:
    """The integer nearest to value * 2^bits."""
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
    """The bit length of |value|, up to an error of one, for value != 0."""
    return int(value.p).bit_length() - int(value.q).bit_length()


def _round_shift(value: fmpq, bits: int) -> int:
    a, b = int(value.p), int(value.q)
    return _divide_round(a << bits, b) if bits >= 0 else _divide_round(a, b << -bits)
