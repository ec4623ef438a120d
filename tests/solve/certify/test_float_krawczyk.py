"""The float test accepts a box only if it holds exactly one zero, whatever it is given."""

import random
from fractions import Fraction
from itertools import product
from math import isqrt
from types import SimpleNamespace

import numpy as np
import pytest

from exactfold.checker import CertificateError
from exactfold.checker.core.krawczyk import Krawczyk
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify import float_krawczyk
from exactfold.solve.certify.float_krawczyk import (
    UNPROVED,
    FloatBoxes,
    FloatKrawczyk,
    FloatSigns,
    inverse_each,
    scaled_rows,
)


def forms(system: QuadraticSystem) -> list[dict[tuple[int, int], int]]:
    """The quadrics as the stand-alone checker holds them."""
    return [
        {(i, j): w for i, row in enumerate(matrix) for j, w in enumerate(row) if w}
        for matrix in system.matrices
    ]


Pairs = list[tuple[Fraction, Fraction]]


def known(pairs: Pairs, seed: int, scale: int = 1) -> QuadraticSystem:
    """Mixtures of the equations (x_q - a_q)(x_q - b_q) = 0: the 2^n zeros are known."""
    source, n = random.Random(seed), len(pairs)
    rows = []
    for p in range(n):
        matrix = [[Fraction(0)] * (n + 1) for _ in range(n + 1)]
        for q, (a, b) in enumerate(pairs):
            weight = Fraction(source.randint(-9, 9) + (40 if p == q else 0)) * scale**p
            matrix[q][q] += weight
            matrix[q][n] -= weight * (a + b) / 2
            matrix[n][q] = matrix[q][n]
            matrix[n][n] += weight * a * b
        rows.append(matrix)
    return QuadraticSystem.from_rational(rows)


def zeros(pairs: Pairs) -> list[tuple[Fraction, ...]]:
    return list(product(*pairs))


def inside(zero: tuple[Fraction, ...], boxes: FloatBoxes, row: int) -> bool:
    unit = Fraction(1, 1 << boxes.bits)
    radius = unit * (1 << int(boxes.exponents[row]))
    centers = [int(m) * unit for m in boxes.centers[row]]
    return all(abs(x - m) <= radius for x, m in zip(zero, centers, strict=True))


def random_pairs(seed: int, n: int, gap: Fraction) -> Pairs:
    source = random.Random(seed)
    firsts = [Fraction(source.randint(-999, 999), 256) for _ in range(n)]
    return [(a, a + (gap if q == 0 else 1 + abs(a))) for q, a in enumerate(firsts)]


@pytest.mark.parametrize("scale", [1, 10**7, 3**40])
def test_all_zeros_of_a_known_system_are_isolated(scale: int) -> None:
    pairs = random_pairs(1, 4, Fraction(1, 3))
    points = np.array(zeros(pairs), dtype=np.float64)
    boxes = FloatKrawczyk(known(pairs, 2, scale)).isolate(points, 40)
    assert boxes.proved.all()
    for row in range(len(points)):
        assert [inside(zero, boxes, row) for zero in zeros(pairs)].count(True) == 1
        assert boxes.radii[row] < 1e-9  # right, and narrow


@pytest.mark.parametrize("digits", range(0, 20, 2))
def test_an_accepted_box_holds_exactly_one_zero(digits: int) -> None:
    """Candidates on, beside and between zeros that come as close as 10^-digits."""
    source = random.Random(digits)
    gap = Fraction(1, 10**digits)
    pairs = random_pairs(digits, 3, gap)
    exact = np.array(zeros(pairs), dtype=np.float64)
    shifts = [10.0 ** -source.uniform(0, 17) * source.choice((-1, 1)) for _ in range(60)]
    moved = exact[source.choices(range(len(exact)), k=60)]
    moved[:, source.randrange(3)] += np.array(shifts)
    between = exact.copy()
    between[:, 0] = float((pairs[0][0] + pairs[0][1]) / 2)
    boxes = FloatKrawczyk(known(pairs, digits)).isolate(np.vstack([exact, moved, between]), 44)
    for row in np.flatnonzero(boxes.proved):
        assert sum(inside(zero, boxes, int(row)) for zero in zeros(pairs)) == 1


def test_double_zeros_are_refused_from_wherever_they_are_tried() -> None:
    pairs = random_pairs(3, 3, Fraction(0))
    double = np.array(zeros(pairs), dtype=np.float64)
    tries = [double] + [double + 2.0**-k for k in range(4, 52, 3)]
    boxes = FloatKrawczyk(known(pairs, 5)).isolate(np.vstack(tries), 44)
    for row in np.flatnonzero(boxes.proved):
        assert not any(inside(zero, boxes, int(row)) for zero in zeros(pairs))
    assert not boxes.proved.any()


def test_boxes_that_are_too_wide_or_beside_the_zero_are_refused() -> None:
    test = FloatKrawczyk(QuadraticSystem.from_rational([[[1, 0], [0, -2]]]))
    good = test.isolate(np.array([[2.0**0.5]]), 40)
    assert test.verify(good).all()

    def judged(center: int, exponent: int) -> bool:
        moved = good.centers + center
        return bool(test.verify(FloatBoxes(40, moved, np.array([exponent])))[0])

    assert not judged(0, 42)  # holds both zeros or leaves the range of contraction
    assert not judged(1 << 10, 5)
    assert judged(1 << 10, 12)
    assert not judged(0, UNPROVED)


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf, 1e300, 5e15])
def test_candidates_out_of_range_are_refused(value: float) -> None:
    test = FloatKrawczyk(known(random_pairs(1, 2, Fraction(1)), 1))
    assert not test.isolate(np.array([[value, 1.0], [1.0, value]]), 40).proved.any()


def test_coefficients_out_of_range_are_refused() -> None:
    system = QuadraticSystem((((1 << 1000, 0), (0, -1)),))
    assert scaled_rows(system.matrices[0]) is None
    assert not FloatKrawczyk(system).isolate(np.array([[0.0]]), 40).proved.any()
    assert FloatSigns(((1 << 1000, 1),)).on(FloatBoxes(4, np.ones((1, 1)), np.ones(1))).item() == 0


@pytest.mark.parametrize("seed", range(6))
def test_bounds_are_above_the_exact_values(seed: int, monkeypatch: pytest.MonkeyPatch) -> None:
    """eta, k0 and M, recomputed in rationals with the same Y, on badly conditioned systems."""
    source = random.Random(seed)
    n = 2 + seed % 3
    pairs = random_pairs(seed, n, Fraction(1, 10 ** (2 * seed)))
    system = known(pairs, seed, scale=7**seed)
    used: list[np.ndarray] = []

    def recorded(matrices: np.ndarray) -> np.ndarray:
        used.append(inverse_each(matrices))
        return used[-1]

    monkeypatch.setattr(float_krawczyk, "inverse_each", recorded)
    points = np.array(zeros(pairs), dtype=np.float64)
    points += np.array([[source.gauss(0, 1e-9) for _ in range(n)] for _ in points])
    etas, k0s, bounds = FloatKrawczyk(system)._bounds(points)
    scales = [
        1 << max(abs(x) for row in matrix for x in row).bit_length() for matrix in system.matrices
    ]
    tensor = [
        [[Fraction(x, s) for x in row] for row in matrix]
        for matrix, s in zip(system.matrices, scales, strict=True)
    ]
    for row, point in enumerate(points.tolist()):
        z = [*map(Fraction, point), Fraction(1)]
        y = [[Fraction(x) for x in line] for line in used[0][row].tolist()]
        gradients = [[sum(a * b for a, b in zip(r, z, strict=True)) for r in t] for t in tensor]
        values = [sum(a * b for a, b in zip(g, z, strict=True)) / 2 for g in gradients]
        eta = max(abs(sum(a * f for a, f in zip(line, values, strict=True))) for line in y)
        k0 = max(
            sum(abs((i == k) - sum(y[i][p] * gradients[p][k] for p in range(n))) for k in range(n))
            for i in range(n)
        )
        bound = max(
            sum(
                abs(sum(y[i][p] * tensor[p][j][k] for p in range(n)))
                for j in range(n)
                for k in range(n)
            )
            for i in range(n)
        )
        assert eta <= Fraction(float(etas[row]))
        assert k0 <= Fraction(float(k0s[row]))
        assert bound <= Fraction(float(bounds[row]))
        assert etas[row] < 2 * float(eta) + 1e-12 * 10 ** (2 * seed)  # right, and not useless


@pytest.mark.parametrize("seed", range(5))
def test_signs_are_those_of_the_exact_functional_on_the_box(seed: int) -> None:
    source = random.Random(seed)
    n = 3
    centers = np.array([[source.randint(-(2**45), 2**45) for _ in range(n)] for _ in range(40)])
    exponents = np.array([source.randint(0, 44) for _ in range(40)])
    boxes = FloatBoxes(40, centers, exponents)
    rows = []
    for center in centers[:20].tolist():  # functionals that vanish, or nearly, at some centres
        c = [source.randint(-(10**12), 10**12) for _ in range(n)]
        value = sum(a * b for a, b in zip(c, center, strict=True))
        rows.append((*(a << 40 for a in c), -value + source.choice((0, 1, -1, 10**9, -(10**24)))))
    found = FloatSigns(tuple(rows)).on(boxes)
    assert (found == 0).any()
    assert (found != 0).any()
    for i, center in enumerate(centers.tolist()):
        for j, row in enumerate(rows):
            value = (row[-1] << 40) + sum(a * b for a, b in zip(row[:-1], center, strict=True))
            reach = sum(map(abs, row[:-1])) << int(exponents[i])
            if found[i, j]:
                assert abs(value) > reach
                assert (value > 0) == (found[i, j] > 0)
            else:  # undecided only where the box nearly meets the zero set
                assert abs(value) <= reach * 1.001 + 2.0**-40 * 10 * sum(
                    abs(a * b) for a, b in zip(row, [*center, 1 << 40], strict=True)
                )


def test_integers_accept_what_floats_accept() -> None:
    """Rows of the inverse that differ by 2^70: rounded to one unit, the small ones would vanish."""
    a, b, linear = 2**50, 2**50 + 2**31, 2**60
    system = QuadraticSystem.from_rational(
        [
            [[2, 0, -(a + b)], [0, 0, 0], [-(a + b), 0, 2 * a * b]],
            [[0, 0, 0], [0, 2, linear], [0, linear, 0]],
        ]
    )
    test, exact = FloatKrawczyk(system), Krawczyk(SimpleNamespace(size=2, quadrics=forms(system)))
    exponents = np.arange(36)
    boxes = FloatBoxes(0, np.array([[a, 0]] * len(exponents)), exponents)
    accepted = test.verify(boxes)
    assert accepted[26]
    assert not accepted[31:].any()  # the second zero is not far away
    for e in exponents.tolist():
        try:
            exact.check([a, 0], 1 << e, 0)
        except CertificateError:
            assert e > 29
            assert not accepted[e]


@pytest.mark.parametrize("linear", [False, True])
def test_inverses_to_many_digits_prove_zeros_that_doubles_cannot_tell_apart(linear: bool) -> None:
    """(x - a)(x - b) = 0 with b - a = 2^-300, and a second equation with or without squares."""
    bits, a, b = 700, 1, 1 + Fraction(1, 2**300)
    rows = [[[2, 0, -(a + b)], [0, 0, 0], [-(a + b), 0, 2 * a * b]]]
    rows += [[[0, 0, -1], [0, 0 if linear else 2, 1], [-1, 1, 0]]]  # y = x or y^2 + y = x
    system = QuadraticSystem.from_rational(rows)
    exact = Krawczyk(SimpleNamespace(size=2, quadrics=forms(system)))
    y = (1 << bits) if linear else (isqrt(5 << 2 * bits) - (1 << bits)) // 2
    exact.check([1 << bits, y], 1 << 300, bits)
    for wrong in ([1 << bits, y], 1 << 400), ([(1 << bits) + (1 << 320), y], 1 << 300):
        with pytest.raises(CertificateError):
            exact.check(*wrong, bits)


def test_singular_matrices_spoil_only_their_own_inverse() -> None:
    found = inverse_each(np.array([np.eye(2), np.zeros((2, 2)), 2 * np.eye(2)]))
    assert found[0].tolist() == [[1, 0], [0, 1]]
    assert found[2].tolist() == [[0.5, 0], [0, 0.5]]
    assert np.isnan(found[1]).all()


def test_centres_that_are_no_doubles_are_never_proved() -> None:
    centers = np.array([[2**52], [-(2**52)], [-(2**63)], [2**52 - 1]])
    assert FloatBoxes(40, centers, np.zeros(4, dtype=np.int64)).proved.tolist() == [
        False,
        False,
        False,
        True,
    ]
