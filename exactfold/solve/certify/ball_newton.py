"""The interval Newton test in mpmath interval arithmetic, at rising precision."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, TypeAlias

import mpmath
from flint import arb, arb_mat, ctx

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox, Uncertified
from exactfold.solve.certify.points import (
    REACH,
    Candidate,
    Point,
    Points,
    exact_candidates,
    largest,
    to_arb,
)

_PRECISIONS = (106, 212, 424, 848, 1696)
_NEWTON_STEPS = 128
_SLOW_STEPS = 20  # so many steps in a row that hardly shrink show a multiple zero
_INFLATIONS = (1, 4, 64)
_GUARD = 16

Interval: TypeAlias = Any  # an mpmath interval, closed, with dyadic end points
Column: TypeAlias = Any  # an arb_mat of one column with exact entries


def interval_newton(
    system: QuadraticSystem,
    points: Points,
    *,
    precisions: Sequence[int] = _PRECISIONS,
    reach: Fraction | None = REACH,
) -> list[IsolatingBox | Uncertified]:
    r"""An isolating box around each candidate, proved in interval arithmetic, or a reason.

    For a box X with dyadic centre m let N(X) = m - F'(X)^-1 F(m). This linear interval system is
    multiplied with an approximate inverse and solved by Gaussian elimination. If the elimination
    succeeds and N(X) lies in the interior of X, then X contains exactly one zero; it is regular and
    lies in N(X) (Neumaier, Interval Methods for Systems of Equations, 1990, theorem 5.1.7). The
    result is a cube around N(X) of about twice its width, if that cube lies in X, and otherwise X.

    Not all elementary functions of mpmath are correctly rounded (its `iv.exp` has missed values,
    mpmath issue 1181), and the proof uses none of them. It uses only this part of mpmath's public
    interface: an interval context of its own, intervals with exactly given dyadic ends
    (`mpmath.ldexp`, which does not round), their sums, differences and products, quotients by 2 and
    by intervals without zero, comparisons, and end points as integers.
    tests/solve/certify/test_interval_newton.py compares each of these operations with Fractions,
    for enclosure and for width. FLINT's Newton steps and inverses only choose m, r and Y.

    `points` has shape (m, n), with coordinates as in `exact_candidates`. If imaginary parts are
    negligible, the real system is tried first, which proves the zero real. Otherwise, and if that
    fails, the 2n real equations in real and imaginary parts are used. Newton's method in floating
    point chooses m within `reach` max(1, |candidate|) of the candidate (None: anywhere).
    `precisions` are bits of the significand, tried in turn. The precision of mpmath's global
    contexts is neither read nor changed, and that of python-flint's context is restored.

    Raises `UsageError` if a candidate does not have n coordinates. `Uncertified` does not mean that
    there is no zero nearby: it may be multiple, the candidate too far off, the precision too low.

    >>> line_pair = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> box, = interval_newton(line_pair, [[1.4142]])
    >>> low, high = box.interval(0)
    >>> low**2 < 2 < high**2, high - low < Fraction(1, 10**29)
    (True, True)
    """
    workers: dict[bool, _Worker] = {}

    def worker(real: bool) -> _Worker:
        if real not in workers:
            workers[real] = _Worker(system if real else system.realification, reach)
        return workers[real]

    return [
        candidate if isinstance(candidate, Uncertified) else _certify(worker, candidate, precisions)
        for candidate in exact_candidates(points, system.size)
    ]


def decide_contains_one_zero(system: QuadraticSystem, box: IsolatingBox) -> Verdict:
    """Whether a given box contains exactly one zero, a regular one, by the interval Newton test.

    The answer is PROVED if N(X) lies in the interior of the box, and REFUTED if some quadric has no
    zero in it. Otherwise it is UNDECIDED, for example for a box that is too wide, even if it does
    contain exactly one zero. A box with imaginary parts is a box of R^2n. Uses only the operations
    that `interval_newton` names.

    >>> line_pair = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> boxes = [IsolatingBox((m,), (), r, 3) for m, r in ((11, 1), (11, 12), (20, 1))]
    >>> [str(decide_contains_one_zero(line_pair, box)) for box in boxes]
    ['proved', 'undecided', 'refuted']
    """
    if system.size == 0:
        return PROVED
    worker = _Worker(system if box.is_real else system.realification, None)
    return worker.decide(_Cube((*box.real, *box.imag), box.radius, box.bits))


def _certify(
    worker: Callable[[bool], _Worker], candidate: Candidate, precisions: Sequence[int]
) -> IsolatingBox | Uncertified:
    n = len(candidate.real)
    if n == 0:  # no equation and no unknown: there is exactly one point
        return IsolatingBox((), (), 1, 0)
    reasons = []
    if candidate.is_nearly_real:
        outcome = worker(True).run(candidate.real, precisions)
        if isinstance(outcome, _Cube):
            return IsolatingBox(outcome.centre, (), outcome.radius, outcome.bits)
        reasons.append(outcome)
    if any(candidate.imag):
        outcome = worker(False).run((*candidate.real, *candidate.imag), precisions)
        if isinstance(outcome, _Cube):
            box = IsolatingBox(outcome.centre[:n], outcome.centre[n:], outcome.radius, outcome.bits)
            if not reasons or box.is_nonreal:
                return box
            outcome = "the zero is proved neither real nor non-real"
        reasons.append(f"as a complex point: {outcome}" if reasons else outcome)
    return Uncertified(candidate.shown, "; ".join(reasons))


@dataclass(frozen=True)
class _Cube:
    """The points x with |x_k - centre_k / 2^bits| <= radius / 2^bits for every k."""

    centre: tuple[int, ...]
    radius: int
    bits: int


class _LeftError(Exception):
    """Newton's method moved too far from the candidate; more bits will not change that."""


class _Worker:
    """The test for one real system, in its own interval context."""

    def __init__(self, system: QuadraticSystem, reach: Fraction | None = REACH) -> None:
        self.reach = reach
        self.iv = mpmath.MPIntervalContext()
        self.size = n = system.size
        self.exact = system.matrices
        entries = [s for matrix in system.matrices for row in matrix for s in row]
        self.stacked = arb_mat(n * (n + 1), n + 1, entries)
        self.intervals = [
            [[self._dyadic(s, s, 0) for s in row] for row in matrix] for matrix in system.matrices
        ]

    def run(self, start: Point, precisions: Sequence[int]) -> _Cube | str:
        """A proved cube near `start`, or the reason why none was found."""
        reason = "no precision was given"
        for precision in precisions:
            self.iv.prec = precision
            try:
                # Start again each time: a lower precision may have led to a wrong zero.
                with ctx.workprec(precision + _GUARD):
                    bits, centre = _rounded(self._newton(start, precision), precision)
                outcome = self._enclose(centre, bits, precision)
            except ZeroDivisionError:
                reason = f"the Jacobian is singular at {precision} bits"
                continue
            except _LeftError as error:
                return f"{error} at {precision} bits"
            if isinstance(outcome, _Cube):
                return outcome
            reason = outcome
        return reason

    def decide(self, box: _Cube) -> Verdict:
        """Applies the test to a given cube, at rising precision."""
        length = max(abs(c) + box.radius for c in box.centre).bit_length()
        for precision in (length + 64, 2 * length + 256, 4 * length + 1024):
            self.iv.prec = precision
            cube = [self._dyadic(c - box.radius, c + box.radius, box.bits) for c in box.centre]
            if any((v > 0) is True or (v < 0) is True for v in self._values(cube)):
                return REFUTED
            point = [self._dyadic(c, c, box.bits) for c in box.centre]
            try:
                factors = self._inverse(box.centre, box.bits)
            except ZeroDivisionError:
                continue
            residual = self._product(factors, [[v] for v in self._values(point)])
            matrix = self._product(factors, self._jacobian(cube))
            solution = _eliminate(matrix, [row[0] for row in residual])
            if solution is None:
                continue
            image = [m - y for m, y in zip(point, solution, strict=True)]
            if all(_inside(a, b) for a, b in zip(image, cube, strict=True)):
                return PROVED
        return UNDECIDED

    # --- FLINT: chooses what to try ---

    def _newton(self, candidate: Point, precision: int) -> Column:
        """Newton's method on midpoints, at the precision of FLINT's context."""
        start = x = arb_mat(self.size, 1, [to_arb(c).mid() for c in candidate])
        allowed = None
        if self.reach is not None:
            allowed = (max([arb(1), *map(abs, start.entries())]) * to_arb(self.reach)).mid()
        slow, last = 0, arb("inf")
        for _ in range(_NEWTON_STEPS):
            jacobian, values = self._approx_derivatives(x)
            step = (jacobian.inv().mid() * values).mid()
            x = (x - step).mid()
            if allowed is not None and not largest(x - start) <= allowed:
                raise _LeftError("Newton's method left the candidate")
            length = largest(step)
            slow, last = slow + 1 if 8 * length > last else 0, length
            if slow > _SLOW_STEPS or length <= largest(x) * arb((1, 4 - precision)):
                break
        return x

    def _approx_derivatives(self, x: Column) -> tuple[arb_mat, Column]:
        n = self.size
        z = arb_mat(n + 1, 1, [*x.entries(), 1])
        rows = arb_mat(n, n + 1, (self.stacked * z).entries()).mid()
        jacobian = arb_mat(n, n, [rows[p, k] for p in range(n) for k in range(n)])
        return jacobian, (rows * z * arb((1, -1))).mid()

    def _inverse(self, centre: Sequence[int], bits: int) -> list[list[Interval]]:
        """An approximate inverse of F'(centre / 2^bits), as intervals of width 0.

        Raises `ZeroDivisionError` if F' may be singular at this point.
        """
        n = self.size
        with ctx.workprec(self.iv.prec + _GUARD):
            point = arb_mat(n, 1, [arb((c, -bits)) for c in centre])
            inverse = self._approx_derivatives(point)[0].inv()
            middles = [tuple(map(int, x.mid().man_exp())) for x in inverse.entries()]
        values = [self._dyadic(m, m, -e) for m, e in middles]
        return [values[k * n : (k + 1) * n] for k in range(n)]

    # --- interval arithmetic: proves ---

    def _dyadic(self, low: int, high: int, bits: int) -> Interval:
        """The interval [low, high] / 2^bits, exactly."""
        return self.iv.mpf([mpmath.ldexp(low, -bits), mpmath.ldexp(high, -bits)])

    def _enclose(self, centre: list[int], bits: int, precision: int) -> _Cube | str:
        """Applies the interval Newton test to cubes around a point, for the smallest radius."""
        point = [self._dyadic(c, c, bits) for c in centre]
        factors = self._inverse(centre, bits)
        residual = self._product(factors, [[v] for v in self._values(point)])
        shift = max(_magnitude(row[0], bits) for row in residual)
        reason = ""
        for inflation in _INFLATIONS:
            radius = (2 * shift + 1) * inflation
            cube = [self._dyadic(c - radius, c + radius, bits) for c in centre]
            matrix = self._product(factors, self._jacobian(cube))
            solution = _eliminate(matrix, [row[0] for row in residual])
            if solution is None:
                return f"F'(X) may be singular at {precision} bits: an interval pivot contains 0"
            image = [m - y for m, y in zip(point, solution, strict=True)]
            if all(_inside(a, b) for a, b in zip(image, cube, strict=True)):
                return _tighten(image, _Cube(tuple(centre), radius, bits))
            reach = max(_magnitude(y, bits) for y in solution)
            reason = (
                f"no contraction at {precision} bits: |N(X) - m| = {_text(reach, bits)} "
                f"for radius {_text(radius, bits)}"
            )
        return reason

    def _gradients(self, x: list[Interval]) -> list[list[Interval]]:
        """The vectors S_p (x, 1) for all p."""
        result = []
        for p, matrix in enumerate(self.exact):
            rows = []
            for i, row in enumerate(matrix):
                total = self.intervals[p][i][-1]
                for j, coordinate in enumerate(x):
                    if row[j]:
                        total = total + self.intervals[p][i][j] * coordinate
                rows.append(total)
            result.append(rows)
        return result

    def _jacobian(self, x: list[Interval]) -> list[list[Interval]]:
        return [row[:-1] for row in self._gradients(x)]

    def _values(self, x: list[Interval]) -> list[Interval]:
        result = []
        for row in self._gradients(x):
            total = row[-1]
            for entry, coordinate in zip(row[:-1], x, strict=True):
                total = total + entry * coordinate
            result.append(total / 2)
        return result

    def _product(self, a: list[list[Interval]], b: list[list[Interval]]) -> list[list[Interval]]:
        columns = list(zip(*b, strict=True))
        result = []
        for row in a:
            entries = []
            for column in columns:
                total = self.iv.zero
                for left, right in zip(row, column, strict=True):
                    total = total + left * right
                entries.append(total)
            result.append(entries)
        return result


def _eliminate(matrix: list[list[Interval]], right: list[Interval]) -> list[Interval] | None:
    """An enclosure of {A^-1 b : A in matrix, b in right}; None if a pivot contains zero.

    This is Gaussian elimination without pivoting. It succeeds only if every A in the interval
    matrix is nonsingular (Neumaier 1990, section 4.5).
    """
    n = len(matrix)
    rows = [[*row, b] for row, b in zip(matrix, right, strict=True)]
    for k in range(n):
        pivot = rows[k][k]
        if not ((pivot > 0) is True or (pivot < 0) is True):
            return None
        for i in range(k + 1, n):
            factor = rows[i][k] / pivot
            for j in range(k + 1, n + 1):
                rows[i][j] = rows[i][j] - factor * rows[k][j]
    solution: list[Interval] = [None] * n
    for k in reversed(range(n)):
        total = rows[k][n]
        for j in range(k + 1, n):
            total = total - rows[k][j] * solution[j]
        solution[k] = total / rows[k][k]
    return solution


def _inside(inner: Interval, outer: Interval) -> bool:
    """Whether `inner` lies in the interior of `outer`; end points are compared exactly."""
    return (inner.a > outer.a) is True and (inner.b < outer.b) is True


def _tighten(image: list[Interval], proved: _Cube) -> _Cube:
    """A cube that contains `image` and lies in `proved`, so that it contains the same single zero.

    It is twice as wide as necessary, so that the zero is well inside and other tests can repeat the
    proof.
    """
    ends = [_outward(entry, proved.bits) for entry in image]
    centre = tuple((low + high) // 2 for low, high in ends)
    hull = max(max(high - c, c - low) for (low, high), c in zip(ends, centre, strict=True))
    radius = 2 * hull + 1
    drift = max(abs(a - b) for a, b in zip(centre, proved.centre, strict=True))
    return _Cube(centre, radius, proved.bits) if drift + radius <= proved.radius else proved


def _outward(value: Interval, bits: int) -> tuple[int, int]:
    """The smallest interval of multiples of 2^-bits that contains `value`, as integers.

    The product is exact if the end points of `value` fit the working precision, as those of all
    results do. Otherwise it is rounded outward.
    """
    scaled = value * (1 << bits)
    low, high = int(scaled.a), int(scaled.b)  # truncated towards zero
    return low - ((scaled.a < low) is True), high + ((scaled.b > high) is True)


def _magnitude(value: Interval, bits: int) -> int:
    return max(map(abs, _outward(value, bits)))


def _text(value: int, bits: int) -> str:
    """The approximate value / 2^bits as a power of two, so that nothing overflows."""
    return f"2^{value.bit_length() - bits}" if value else "0"


def _rounded(x: Column, precision: int) -> tuple[int, list[int]]:
    """A number of bits after the binary point, and x rounded to it as integers.

    The largest entry then has about `precision` bits.
    """
    values = []
    for entry in x.entries():
        mantissa, exponent = map(int, entry.man_exp())
        values.append((mantissa, exponent))
    lengths = [abs(m).bit_length() + e for m, e in values if m]
    bits = max(0, precision - max(-precision, *lengths)) if lengths else precision
    return bits, [round(Fraction(m) * Fraction(2) ** (e + bits)) for m, e in values]
