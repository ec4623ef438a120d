"""The bounds behind tubes, against exact rationals and known curves."""

from __future__ import annotations

import math
import random
from fractions import Fraction

import numpy as np
import pytest

from exactfold.branches.counting.find import find_branch
from exactfold.motion.tubes import contraction as module
from exactfold.motion.tubes import tube as tube_module
from exactfold.motion.tubes.arclength import length_between, shifted
from exactfold.motion.tubes.contraction import (
    INVERSE_BITS,
    ONE,
    SCALE,
    WEIGHT_BITS,
    Contraction,
    polynomial,
)
from exactfold.motion.tubes.float_bounds import contraction_in_floats, series_at
from exactfold.motion.tubes.length_equations import LengthEquations, squared
from exactfold.motion.tubes.piece import PARAMETER_BITS, evaluated
from exactfold.motion.tubes.tracks import follow_proved, ray
from exactfold.motion.tubes.tube import _bounds, _residuals, _stretch
from exactfold.pattern.triangulating.random_squares import random_square


def exact_bounds(equations, curve, row, weights, inverse, whole=True):  # type: ignore[no-untyped-def]
    """b_k, q_k and kappa of Theorem 1 in rationals, from dense matrices.

    P is `inverse`, rounded if `whole`.
    """
    framework, one = equations.framework, 1 << equations.bits
    n, scale = framework.size, 1 << INVERSE_BITS
    p = [[Fraction(round(x * scale), scale) if whole else Fraction(x) for x in r] for r in inverse]
    w = [Fraction(x, 1 << WEIGHT_BITS) for x in weights]
    place = {int(v): 3 * k for k, v in enumerate(framework.free)}
    flat = [[Fraction(x, 1 << framework.bits) for x in (*q, 0)] for q in framework.points]

    def along(a):  # type: ignore[no-untyped-def]
        d = {v: a[k : k + 3] for v, k in place.items()}
        zero = [Fraction(0)] * 3
        pairs = framework.edges.tolist()
        return [
            [x - y for x, y in zip(d.get(i, zero), d.get(j, zero), strict=True)] for i, j in pairs
        ]

    def matrix(rows, last):  # type: ignore[no-untyped-def]
        found = [[Fraction(0)] * n for _ in range(n)]
        for e, (i, j) in enumerate(framework.edges.tolist()):
            for v, sign in ((i, 1), (j, -1)):
                for a in range(3):
                    if v in place:
                        found[e][place[v] + a] += sign * rows[e][a]
        found[n - 1] = last
        return found

    def norm(values):  # type: ignore[no-untyped-def]
        return max(abs(x) / y for x, y in zip(values, w, strict=True))

    a = [[Fraction(x, one) for x in r] for r in curve]
    t = [Fraction(x, 1 << 20) for x in row]
    e = [along(x) for x in a]
    u = [
        [x - y for x, y in zip(flat[i], flat[j], strict=True)] for i, j in framework.edges.tolist()
    ]
    residual, slope = [], []
    for k in range(2 * len(a) - 1):
        g = []
        for m in range(len(u)):
            value = sum(
                (
                    x * y / 2
                    for i in range(len(a))
                    if 0 <= k - i < len(a)
                    for x, y in zip(e[i][m], e[k - i][m], strict=True)
                ),
                Fraction(0),
            )
            if k < len(a):
                value += sum(x * y for x, y in zip(u[m], e[k][m], strict=True))
            g.append(value)
        last = sum(x * y for x, y in zip(t, a[k], strict=True)) if 0 < k < len(a) else Fraction(0)
        g.append(last - (k == 1))
        residual.append(norm([sum(x * y for x, y in zip(r, g, strict=True)) for r in p]))
    for k in range(len(a)):
        rows = [
            [x + (y if k == 0 else 0) for x, y in zip(*q, strict=True)]
            for q in zip(e[k], u, strict=True)
        ]
        m = matrix(rows, t if k == 0 else [Fraction(0)] * n)
        values = []
        for i in range(n):
            total = Fraction(0)
            for j in range(n):
                x = sum(p[i][q] * m[q][j] for q in range(n)) - (k == 0 and i == j)
                total += abs(x) * w[j]
            values.append(total)
        slope.append(norm(values))
    sums = [
        sum(
            (
                sum((w[place[v] + c] for v in pair if v in place), Fraction(0)) ** 2
                for c in range(3)
            ),
            Fraction(0),
        )
        for pair in framework.edges.tolist()
    ]
    kappa = norm([sum(abs(x) * y for x, y in zip(r, sums, strict=False)) for r in p])
    return residual, slope, kappa


@pytest.mark.parametrize(("n", "bits"), [(1, 64), (2, 64), (2, 90)])
def test_bounds_are_above_the_exact_values_and_close(n: int, bits: int) -> None:
    track = follow_proved(find_branch(random_square(n, seed=n), "+-"[:n]), most=3, bits=bits)
    equations = LengthEquations.of(track.framework, bits)
    for tube in (track.links[0].tube, track.links[-1].tube):
        curve = tube.coefficients
        edges = track.framework.flat_edges + track.framework.along(equations.floats(curve[0]))
        row = np.array([float(t) for t in tube.row]) / (1 << 20)
        inverse = np.linalg.inv(np.vstack([equations.places.dense(edges), row]))
        # A poor P makes all terms large.
        for off in (0.0, 1e-4):
            p = inverse * (1 + off)
            found = _bounds(
                equations, curve, _residuals(equations, curve, tube.row), tube.row, tube.weights, p
            )
            residual, slope, kappa = exact_bounds(equations, curve, tube.row, tube.weights, p)
            for above, true in (
                *zip(found.residual, residual, strict=True),
                *zip(found.slope, slope, strict=True),
                (found.quadratic[0], kappa),
            ):
                assert true <= Fraction(above, ONE)
                assert Fraction(above, ONE) <= true * Fraction(101, 100) + Fraction(1, 10**6) * max(
                    residual[-1], Fraction(1, 10**4)
                )


@pytest.mark.parametrize("size", [0, 1 << 30, 1 << 56])
def test_bounds_in_doubles_are_above_the_exact_values_and_close(size: int) -> None:
    """Also for a curve that is moved, so that no coefficient of the equations is 0."""
    rng = random.Random(size)
    track = follow_proved(find_branch(random_square(1, seed=1), "+"), most=5)
    equations = LengthEquations.of(track.framework)
    for tube in (track.links[0].tube, track.links[-1].tube):
        centre, *rows = tube.coefficients
        centre = tuple(x + rng.randint(-size, size) for x in centre)
        near = equations.floats(centre)
        edges = track.framework.flat_edges + track.framework.along(near)
        row = np.array([float(t) for t in tube.row]) / (1 << 20)
        inverse = equations.inverse(edges, row)
        series, parts = series_at(equations, inverse, 8)
        assert np.abs(series - [equations.floats(a) for a in rows]).max() < 1e-6 + 2.0**-62 * size
        if size:
            series += np.rint(rng.random() * size * np.ones(series.shape)) * 2.0**-64
            series = np.rint(series * 2.0**60) * 2.0**-60
            parts = (series @ equations.incidence.T).reshape(parts.shape)
        stretch = _stretch(equations, centre, 0)
        found = contraction_in_floats(equations, inverse, centre, stretch, row, series, parts)
        assert found is not None
        proof, weights = found
        curve = (centre, *(equations.nearest(a) for a in series))
        residual, slope, kappa = exact_bounds(
            equations, curve, tube.row, weights, inverse, whole=False
        )
        rounding = Fraction(1, 1 << 38)
        for above, true in (
            *zip(proof.residual, residual, strict=True),
            *zip(proof.slope, slope, strict=True),
            (proof.quadratic[0], kappa),
        ):
            assert true <= Fraction(above, ONE) <= true * (1 + rounding) + rounding
        assert proof.residual[1] / ONE < 1e-9 + size * 2.0**-55


def test_numbers_that_are_too_large_are_left_to_integers() -> None:
    track = follow_proved(find_branch(random_square(1, seed=1), "+"), most=1)
    equations, tube = LengthEquations.of(track.framework), track.links[0].tube
    centre, size = tube.coefficients[0], track.framework.size
    inverse, row = np.eye(size), np.ones(size)
    for scale, bounded in ((1.0, True), (2.0**60, False), (np.inf, False), (np.nan, False)):
        series, parts = series_at(equations, inverse, 8)
        with np.errstate(all="ignore"):
            found = contraction_in_floats(
                equations, inverse * scale, centre, [0] * size, row, series, parts * scale
            )
        assert (found is not None) == bounded


@pytest.mark.parametrize(
    ("denominator", "bits", "doubles"), [(1 << 52, 64, True), (1 << 58, 64, False), (64, 70, False)]
)
def test_coordinates_that_are_no_doubles_are_left_to_integers(
    denominator: int, bits: int, doubles: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    used = []

    def told(*given: object) -> object:
        used.append(1)
        return contraction_in_floats(*given)  # type: ignore[arg-type]

    monkeypatch.setattr(tube_module, "contraction_in_floats", told)
    sheet = random_square(1, seed=1, denominator=denominator)
    track = follow_proved(find_branch(sheet, "+"), most=2, bits=bits)
    assert len(track.links) == 2
    assert (track.framework.bits > 53) == (denominator > 1 << 53)
    assert bool(used) == doubles


def test_radii_and_uniqueness_are_those_of_the_theorem() -> None:
    source = random.Random(1)
    held = 0
    for _ in range(300):
        b = source.randrange(1, ONE >> source.randrange(1, 60))
        q = source.randrange(0, ONE * 5 // 4)
        kappa = source.randrange(1, ONE << source.randrange(1, 20))
        proof = Contraction((b,), (q,), (kappa,))
        r = proof.radius(ONE)
        room, exact = Fraction(ONE - q, ONE), [Fraction(x, ONE) for x in (b, q, kappa)]
        if r is None:
            # No radius, or hardly any.
            assert room <= 0 or room**2 < 2 * exact[0] * exact[2] * Fraction(1001, 1000)
            continue
        held += 1
        radius = Fraction(r, ONE)
        assert exact[0] + exact[1] * radius + exact[2] * radius**2 / 2 < radius
        assert exact[1] + exact[2] * radius < 1
        unique = Fraction(proof.uniqueness(ONE), ONE)
        assert unique == 0 or exact[1] + exact[2] * unique < 1
    assert held > 30


def test_polynomials_are_rounded_up() -> None:
    source = random.Random(2)
    for _ in range(50):
        coefficients = [source.randrange(ONE) for _ in range(6)]
        h = source.randrange(4 * ONE)
        true = sum(Fraction(c, ONE) * Fraction(h, ONE) ** k for k, c in enumerate(coefficients))
        assert 0 <= Fraction(polynomial(coefficients, h), ONE) - true < Fraction(10**4, ONE)


def test_products_are_exact_in_words_and_beyond() -> None:
    source = random.Random(3)
    for size in (20, 31, 45, 80):
        a, b = (
            np.array(
                [[source.randrange(-(1 << size), 1 << size) for _ in range(5)] for _ in range(5)],
                dtype=object,
            )
            for _ in range(2)
        )
        assert (module._dot(a, b) == a @ b).all()
        v = [source.randrange(1 << size) for _ in range(5)]
        true = abs(a) @ np.array(v, dtype=object)
        for above, x in zip(module._above(abs(a), v), true, strict=True):
            assert x <= above <= x + max(true) / 1000 + 1


def test_squares_of_curves() -> None:
    source = random.Random(4)
    e = np.array(
        [[[source.randrange(-99, 99) for _ in range(3)] for _ in range(2)] for _ in range(4)],
        dtype=object,
    )
    for s in (1, -2, 7):
        value = sum(part * s**k for k, part in enumerate(e))
        total = sum(part * s**k for k, part in enumerate(squared(e)))
        assert (total == (value**2).sum(axis=1)).all()


def test_the_curve_at_a_parameter_is_rounded_down() -> None:
    source = random.Random(5)
    curve = [[source.randrange(-(1 << 64), 1 << 64) for _ in range(3)] for _ in range(5)]
    for s in (0, 1, -1, 3 << 38, -5 << 30, 1 << 40, 7 << 41, (1 << 40) - 1):
        at = Fraction(s, 1 << PARAMETER_BITS)
        exact = [sum(row[i] * at**k for k, row in enumerate(curve)) for i in range(3)]
        assert evaluated(curve, s) == tuple(math.floor(x) for x in exact)


def test_lengths_of_known_curves() -> None:
    """A straight line, a parabola, and a curve that stands still at one point."""
    one = 1 << 40

    def parabola(x: float) -> float:
        return x * math.sqrt(1 + 4 * x * x) / 2 + math.asinh(2 * x) / 4

    for low, high in ((0.0, 0.25), (-0.5, 0.75), (-3.0, 3.0)):
        ends = int(low * one), int(high * one)
        least, most = length_between([(one, 0), (0, 2 * one)], 40, (0, 0), 40, *ends)
        true = parabola(high) - parabola(low)
        assert float(least) - 1e-12 <= true <= float(most) + 1e-12
        assert most - least < (1e-6 if high - low < 2 else 1e-4) * true
    least, most = length_between([(0,), (2 * one,)], 40, (0,), 40, -one, one)
    assert least <= 2 <= most
    least, most = length_between([(3 * one, 4 * one)], 40, (one // 100, 0), 40, 0, one)
    assert least <= Fraction(499, 100)
    assert Fraction(501, 100) <= most < Fraction(502, 100)


def test_shifted_polynomials_are_the_same() -> None:
    curve = [(3, 5), (7, -2), (1, 9)]
    rows, more = shifted(curve, 5, 3)
    for s in (Fraction(1, 7), Fraction(-3)):
        for axis in range(2):
            one = sum(c[axis] * (s + Fraction(5, 8)) ** k for k, c in enumerate(curve))
            assert one == sum(Fraction(r[axis], 1 << more) * s**k for k, r in enumerate(rows))


def test_the_scale_leaves_room() -> None:
    assert SCALE >= 2 * INVERSE_BITS


def test_integers_on_both_sides_of_a_machine_word() -> None:
    """Bounds of the start of these rays are below and above 2^63 in one array."""
    for signs in ("-+-+", "----"):
        start = ray(find_branch(random_square(4, seed=0), signs)).start
        assert all(type(x) is int for x in start.contraction.slope)


def test_the_integral_of_the_error_of_the_velocity() -> None:
    source = random.Random(5)
    for _ in range(20):
        b, q, kappa = (
            tuple(source.randrange(ONE >> bits) for _ in range(9)) for bits in (30, 6, 5)
        )
        proof, reach, radius = Contraction(b, q, kappa), ONE * 9 // 10, ONE >> 20
        parts = [reach * k // 200 for k in range(201)]
        rates = [proof.velocity(at, radius) for at in parts]
        below, above = (Fraction(sum(rates[k : k + 200]) * reach, 200 * ONE) for k in (0, 1))
        drift = proof.drift(reach, radius)
        assert below < drift < above * 3 / 2  # its denominator is the least one
        top = sum(
            (Fraction(c, ONE) * Fraction(reach, ONE) ** k * size)
            for row, size in zip(
                (b, q, kappa),
                (1, Fraction(radius, ONE), Fraction(radius, ONE) ** 2 / 2),
                strict=True,
            )
            for k, c in enumerate(row)
            if k
        )
        bottom = 1 - sum(
            Fraction(c, ONE) * Fraction(reach, ONE) ** k * size
            for row, size in ((q, 1), (kappa, Fraction(radius, ONE)))
            for k, c in enumerate(row)
        )
        exact = top / bottom
        assert exact <= Fraction(drift, ONE) < exact * (1 + Fraction(1, 1 << 60))
