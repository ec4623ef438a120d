"""Krawczyk's operator in Arb's ball arithmetic, with a radius of its own for every entry."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import ceil
from typing import Any, TypeAlias

from flint import acb, acb_mat, arb, arb_mat, ctx

from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox, Uncertified
from exactfold.solve.certify.points import (
    REACH,
    Candidate,
    Points,
    exact_candidates,
    is_within_reach,
    largest,
    to_arb,
)

_PRECISIONS = (106, 212, 424, 848, 1696)
_NEWTON_STEPS = 40
_INFLATIONS = (1, 4, 64)

Ball: TypeAlias = Any  # an arb or acb
Matrix: TypeAlias = Any  # an arb_mat or acb_mat
Ends: TypeAlias = tuple[Fraction, Fraction]


def arb_krawczyk(
    system: QuadraticSystem,
    points: Points,
    *,
    precisions: Sequence[int] = _PRECISIONS,
    reach: Fraction | None = REACH,
) -> list[IsolatingBox | Uncertified]:
    r"""An isolating box around each candidate, proved in ball arithmetic, or a reason.

    For a cube X of radius r about a dyadic m and any matrix Y let C be a matrix of balls that
    holds I - Y F'(x) for all x in X, and K(X) = m - Y F(m) + C (X - m). If K(X) lies in the
    interior of X, then |C| r < r in every row, so that x -> x - Y F(x) maps X into its interior and
    contracts in the norm max |x_k| / r_k: X holds exactly one zero, and it is regular (Krawczyk
    1969; Neumaier, Interval Methods for Systems of Equations, 1990, theorem 5.1.8). Over C the
    balls are rectangles and K(X) is the same operator for the 2n real and imaginary parts,
    since a product of rectangles holds the product of the real matrices they stand for.

    Of Arb only exact numbers, + - * of numbers and matrices are used (Johansson, Arb, 2017), and
    the end points of balls, which are compared as Fractions; tests compare these with Fractions at
    random. Inverses and Newton's method only choose m, r and Y. The precision of python-flint's
    context is restored.

    `points` has shape (m, n); coordinates as in `exact_candidates`. Where imaginary parts are
    negligible the real system is tried first, which proves the zero real; otherwise, and if that
    fails, the complex one. `precisions` are bits of the midpoints, tried in turn. Newton's
    method stays within `reach` max(1, |candidate|) of the candidate (None: anywhere).

    Raises `UsageError` if a candidate does not have n coordinates. `Uncertified` does not mean that
    there is no zero nearby: it may be multiple, the candidate too far off, the precision too low.

    >>> line_pair = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> box, = arb_krawczyk(line_pair, [[1.4142]])
    >>> low, high = box.interval(0)
    >>> low**2 < 2 < high**2, high - low < Fraction(1, 10**29)
    (True, True)
    """
    real, nonreal = _Balls(system, arb, arb_mat), _Balls(system, acb, acb_mat)
    results: list[IsolatingBox | Uncertified] = []
    for candidate in exact_candidates(points, system.size):
        if isinstance(candidate, Uncertified):
            results.append(candidate)
            continue
        if system.size == 0:  # no equation, no unknown: the one point there is
            results.append(IsolatingBox((), (), 1, 0))
            continue
        reasons = []
        if candidate.is_nearly_real:
            found = real.run(candidate, precisions, reach)
            if isinstance(found, IsolatingBox):
                results.append(found)
                continue
            reasons.append(found)
        if any(candidate.imag):
            found = nonreal.run(candidate, precisions, reach)
            if isinstance(found, IsolatingBox) and (not reasons or found.is_nonreal):
                results.append(found)
                continue
            if isinstance(found, IsolatingBox):
                found = "the zero was not proved real, nor not real"
            reasons.append(f"as a complex point: {found}" if reasons else found)
        results.append(Uncertified(candidate.shown, "; ".join(reasons)))
    return results


def decide_contains_one_zero(system: QuadraticSystem, box: IsolatingBox) -> Verdict:
    """Whether a given box holds exactly one zero and a regular one, by Krawczyk's operator.

    PROVED if K(X) lies in the interior of the box; REFUTED if some quadric has no zero in it;
    otherwise UNDECIDED, as for a box that is too wide, even if it does hold exactly one zero. A box
    with imaginary parts is a box of R^2n.

    >>> line_pair = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> boxes = [IsolatingBox((m,), (), r, 3) for m, r in ((11, 1), (11, 12), (20, 1))]
    >>> [str(decide_contains_one_zero(line_pair, box)) for box in boxes]
    ['proved', 'undecided', 'refuted']
    """
    if system.size == 0:
        return PROVED
    balls = _Balls(system, arb, arb_mat) if box.is_real else _Balls(system, acb, acb_mat)
    length = max(abs(c) + box.radius for c in (*box.real, *box.imag)).bit_length()
    for precision in (length + 64, 2 * length + 256, 4 * length + 1024):
        with ctx.workprec(precision):
            verdict = balls.decide(box)
        if verdict is not UNDECIDED:
            return verdict
    return UNDECIDED


@dataclass(frozen=True)
class _Balls:
    """The operator over R (arb, arb_mat) or C (acb, acb_mat), at the precision of the context."""

    system: QuadraticSystem
    ball: Callable[..., Ball]
    matrix: Callable[..., Matrix]

    @cached_property
    def stacked(self) -> Matrix:
        """All S_p below each other, exactly: n (n + 1) rows, n + 1 columns."""
        n = self.system.size
        entries = [self.ball(s) for matrix in self.system.matrices for row in matrix for s in row]
        return self.matrix(n * (n + 1), n + 1, entries)

    def run(
        self, candidate: Candidate, precisions: Sequence[int], reach: Fraction | None
    ) -> IsolatingBox | str:
        """A proved box near the candidate, or the reason why there is none."""
        found: IsolatingBox | str = "no precision was given"
        start = candidate.real if self.ball is arb else (*candidate.real, *candidate.imag)
        for precision in precisions:
            with ctx.workprec(precision):
                try:
                    # Afresh each time: lower precision may have gone to another zero of a cluster.
                    found = self._enclose(self._newton(candidate), precision)
                except ZeroDivisionError:
                    found = f"the Jacobian is singular at {precision} bits"
            if isinstance(found, IsolatingBox):
                if is_within_reach(found, start, reach):
                    return found
                found = f"Newton's method left the candidate at {precision} bits"
        return found

    # --- chooses what to try ---

    def _newton(self, candidate: Candidate) -> Matrix:
        """Newton's method on midpoints, until the steps vanish to the working precision."""
        n = self.system.size
        entries = [
            self._number(to_arb(x), to_arb(y)).mid()
            for x, y in zip(candidate.real, candidate.imag, strict=True)
        ]
        x = self.matrix(n, 1, entries)
        for _ in range(_NEWTON_STEPS):
            jacobian, values = self._derivatives(x)
            step = (jacobian.mid().inv() * values).mid()
            x = (x - step).mid()
            if not all(entry.is_finite() for entry in x.entries()):
                raise ZeroDivisionError
            if largest(step) <= largest(x) * arb((1, 4 - ctx.prec)):
                break
        return x

    # --- proves ---

    def _number(self, real: arb, imag: arb) -> Ball:
        return real if self.ball is arb else acb(real, imag)

    def _cube(self, centre: Sequence[int], radius: int, bits: int) -> Matrix:
        """A column of balls that holds the cube; it is exact for radius 0."""
        n = self.system.size
        balls = [arb((c, -bits), (radius, -bits)) for c in centre]
        parts = zip(balls, balls[n:] or balls, strict=False)
        return self.matrix(n, 1, [self._number(x, y) for x, y in parts])

    def _derivatives(self, x: Matrix) -> tuple[Matrix, Matrix]:
        """F'(x) and F(x) for a column x of balls."""
        n = self.system.size
        z = self.matrix(n + 1, 1, [*x.entries(), 1])
        rows = self.matrix(n, n + 1, (self.stacked * z).entries())
        jacobian = self.matrix(n, n, [rows[p, k] for p in range(n) for k in range(n)])
        return jacobian, rows * z * arb((1, -1))

    def _image(self, centre: Matrix, cube: Matrix, inverse: Matrix) -> tuple[Matrix, Matrix]:
        """Y F(m) and the balls C (X - m) for a column X of balls about m."""
        n = self.system.size
        one = self.matrix(n, n, [int(i == j) for i in range(n) for j in range(n)])
        _, values = self._derivatives(centre)
        jacobian, _ = self._derivatives(cube)
        return inverse * values, (one - inverse * jacobian) * (cube - centre)

    def _enclose(self, x: Matrix, precision: int) -> IsolatingBox | str:
        """The test on cubes about x, for the smallest radius that fits."""
        n = self.system.size
        middle = [(low + high) / 2 for entry in x.entries() for low, high in _ends(entry)]
        if self.ball is not arb:
            middle = middle[::2] + middle[1::2]
        extent = max(map(abs, middle))
        exponent = extent.numerator.bit_length() - extent.denominator.bit_length()
        bits = max(0, precision - max(exponent, -precision)) if extent else precision
        centre = [round(value * (1 << bits)) for value in middle]
        point = self._cube(centre, 0, bits)
        inverse = self._derivatives(point)[0].mid().inv().mid()
        residual = inverse * self._derivatives(point)[1]
        shift = max(max(map(abs, e)) for entry in residual.entries() for e in _ends(entry))
        radius = 0
        for inflation in _INFLATIONS:
            radius = (2 * ceil(shift * (1 << bits)) + 1) * inflation
            box = IsolatingBox(tuple(centre[:n]), tuple(centre[n:]), radius, bits)
            if self._is_proved(box, inverse):
                return box
        size = radius.bit_length() - bits
        return f"no contraction at {precision} bits on a cube of radius 2^{size}"

    def _is_proved(self, box: IsolatingBox, inverse: Matrix) -> bool:
        """Whether K of a cube of balls that holds the box lies in the interior of the box."""
        centre, scale = (*box.real, *box.imag), 1 << box.bits
        point, cube = self._cube(centre, 0, box.bits), self._cube(centre, box.radius, box.bits)
        change, spread = self._image(point, cube, inverse)
        image = (point - change + spread).entries()
        if not all(entry.is_finite() for entry in image):
            return False
        parts = [_ends(entry) for entry in image]
        ends = [entry[k] for k in range(len(parts[0])) for entry in parts]
        return all(
            c - box.radius < low * scale and high * scale < c + box.radius
            for c, (low, high) in zip(centre, ends, strict=True)
        )

    def decide(self, box: IsolatingBox) -> Verdict:
        """The test on a given box at the precision of the context."""
        centre = (*box.real, *box.imag)
        point, cube = self._cube(centre, 0, box.bits), self._cube(centre, box.radius, box.bits)
        jacobian, values = self._derivatives(point)
        slopes, _ = self._derivatives(cube)
        for entry in (values + slopes * (cube - point)).entries():  # mean value form
            if entry.is_finite() and any(low > 0 or high < 0 for low, high in _ends(entry)):
                return REFUTED
        try:
            inverse = jacobian.mid().inv().mid()
        except ZeroDivisionError:
            return UNDECIDED
        return PROVED if self._is_proved(box, inverse) else UNDECIDED


def _ends(value: Ball) -> list[Ends]:
    """The exact end points of a finite ball: one pair for an arb, two for an acb."""
    found = []
    for part in (value,) if isinstance(value, arb) else (value.real, value.imag):
        middle, radius = _fraction(part.mid()), _fraction(part.rad())
        found.append((middle - radius, middle + radius))
    return found


def _fraction(value: arb) -> Fraction:
    mantissa, exponent = (int(x) for x in value.man_exp())
    return Fraction(mantissa << exponent) if exponent >= 0 else Fraction(mantissa, 1 << -exponent)
