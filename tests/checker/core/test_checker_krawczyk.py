"""Krawczyk's test of the checker against the inequalities that it states, and signs on a box."""

from __future__ import annotations

import random
from fractions import Fraction
from itertools import product

import pytest
from forge import given, refused, verified

from exactfold.checker.branches.listing import agrees, digit
from exactfold.checker.core.krawczyk import Krawczyk, inverse
from exactfold.checker.core.reading import CertificateError
from exactfold.checker.sheets.boxes import Box
from exactfold.checker.sheets.equations import BranchSystem
from exactfold.checker.sheets.sheet import read_sheet

Matrix = list[list[Fraction]]


Matrix = list[list[Fraction]]


def fractions(*rows: list[object]) -> Matrix:
    return [[Fraction(x) for x in row] for row in rows]  # type: ignore[arg-type]


class Quadrics:
    """F_p = (1/2) z^T S_p z with symmetric integer matrices."""

    def __init__(self, *matrices: list[list[int]]) -> None:
        self.size, self.matrices = len(matrices), matrices
        self.quadrics = [
            {(i, j): w for i, row in enumerate(s) for j, w in enumerate(row) if w} for s in matrices
        ]


def holds(system: Quadrics, y: Matrix, m: list[Fraction], r: Fraction) -> bool:
    """k0 + r M < 1 and eta + (k0 + r M) r < r, as stated, for Y of the quadrics as given."""
    n, z = system.size, [*m, Fraction(1)]
    jacobian = [
        [sum((w * x for w, x in zip(row, z, strict=True)), Fraction(0)) for row in s][:n]
        for s in system.matrices
    ]
    values = [
        sum((z[i] * s[i][j] * z[j] for i, j in product(range(n + 1), repeat=2)), Fraction(0)) / 2
        for s in system.matrices
    ]
    size = [sum(abs(s[i][j]) for i, j in product(range(n), repeat=2)) for s in system.matrices]
    k0 = max(
        sum(abs((i == k) - sum(y[i][p] * jacobian[p][k] for p in range(n))) for k in range(n))
        for i in range(n)
    )
    most = max(sum(abs(y[i][p]) * size[p] for p in range(n)) for i in range(n))
    eta = max(abs(sum(y[i][p] * values[p] for p in range(n))) for i in range(n))
    return k0 + r * most < 1 and eta + (k0 + r * most) * r < r


class Given(Krawczyk):
    """The test with a matrix Y that is given."""

    def propose(self, y: Matrix) -> None:
        scale = [self.quadrics[p] for p in range(self.n)]
        self.given = y, scale

    def _preconditioners(self, gradients, bits):  # type: ignore[no-untyped-def]
        yield self.integers, self.shift


def accepts(system: Quadrics, y: Matrix, center: list[int], radius: int, bits: int) -> bool:
    """Whether the checker accepts the box with this Y, of the quadrics as given."""
    test = Given(system)
    # The checker scales quadric p by a power of two; Y takes it back.
    factors = [
        Fraction(next(iter(test.quadrics[p].values())), next(iter(system.quadrics[p].values())))
        for p in range(test.n)
    ]
    scaled = [[x / f for x, f in zip(row, factors, strict=True)] for row in y]
    test.shift = 0
    while any((x * (1 << test.shift)).denominator > 1 for row in scaled for x in row):
        test.shift += 1
    test.integers = [[int(x * (1 << test.shift)) for x in row] for row in scaled]
    try:
        test.check(center, radius, bits)
    except CertificateError:
        return False
    return True


@pytest.mark.slow
def test_the_inequalities_are_those_that_are_stated() -> None:
    """Whatever Y: for a few thousand small systems and boxes, many at the limit."""
    source, seen = random.Random(3), {True: 0, False: 0}
    for _ in range(2500):
        n = source.randint(1, 2)
        matrices = []
        for _ in range(n):
            s = [[0] * (n + 1) for _ in range(n + 1)]
            for i, j in product(range(n + 1), repeat=2):
                if i <= j:
                    s[i][j] = s[j][i] = source.choice((0, 0, 1, -1, 2, 5))
            s[0][n] += 1
            s[n][0] = s[0][n]
            if not any(map(any, s)):
                s[0][0] = 1
            matrices.append(s)
        system = Quadrics(*matrices)
        bits = source.randint(0, 3)
        center = [source.randint(-3, 3) for _ in range(n)]
        m = [Fraction(c, 1 << bits) for c in center]
        radius = source.randint(1, 4)
        jacobian = [
            [sum(w * x for w, x in zip(row, [*m, 1], strict=True)) for row in s][:n]
            for s in matrices
        ]
        try:
            y = inverse([[Fraction(x) for x in row] for row in jacobian])
        except ZeroDivisionError:
            continue
        wobble = Fraction(source.choice((0, 0, 1, 3)), 16)
        y = [
            [Fraction(round((x + source.choice((-1, 0, 1)) * wobble) * 64), 64) for x in row]
            for row in y
        ]
        expected = holds(system, y, m, Fraction(radius, 1 << bits))
        assert accepts(system, y, center, radius, bits) == expected
        seen[expected] += 1
    assert min(seen.values()) > 50


IDENTITY = fractions([1, 0], [0, 1])
LINEAR = Quadrics([[0, 0, 1], [0, 0, 0], [1, 0, 0]], [[0, 0, 0], [0, 0, 1], [0, 1, 0]])


def test_deviations_add_up_along_rows() -> None:
    """x = 0 and y = 0: no entry of I - Y is 1, but the box about (5, 5) / 4 holds no zero."""
    y = fractions(["3/8", "-5/8"], ["-5/8", "3/8"])
    assert not accepts(LINEAR, y, [5, 5], 4, 2)
    assert accepts(LINEAR, IDENTITY, [3, 3], 4, 2)


def test_a_zero_on_the_side_of_a_box_is_not_in_it() -> None:
    for center, expected in (([3, 0], True), ([4, 0], False), ([5, 0], False), ([7, 0], False)):
        assert accepts(LINEAR, IDENTITY, center, 4, 2) == expected
        assert accepts(LINEAR, IDENTITY, [-x for x in center[::-1]], 4, 2) == expected


def test_any_small_box_about_a_zero_passes() -> None:
    """The checker's own Y: also where doubles are too coarse, and where a quadric is linear."""
    circle = [[2, 0, 0], [0, 2, 0], [0, 0, -50]]  # x^2 + y^2 = 25
    steep = [[2 * 10**40, 0, 0], [0, -2, 0], [0, 0, 32 - 18 * 10**40]]
    line = [[0, 0, 4], [0, 0, -3], [4, -3, 0]]
    for system in (Quadrics(circle, line), Quadrics(circle, steep), Quadrics(line, circle)):
        for bits in (4, 64, 500):
            Krawczyk(system).check([3 << bits, 4 << bits], 1, bits)
            with pytest.raises(CertificateError):
                Krawczyk(system).check([3 << bits, 5 << bits], 1, bits)
    singular = Quadrics(circle, circle)
    with pytest.raises(CertificateError, match="Krawczyk's test fails"):
        Krawczyk(singular).check([3 << 64, 4 << 64], 1, 64)
    lines = Quadrics(line, line)
    with pytest.raises(CertificateError, match="Krawczyk's test fails"):
        Krawczyk(lines).check([3 << 64, 4 << 64], 1, 64)


@pytest.mark.parametrize("name", ["listing-one-vertex", "listing-two-vertices", "listing-isolated"])
def test_boxes_that_miss_their_zero_by_little_are_refused(name: str) -> None:
    """The zero known to 300 bits, boxes of radius 2^-200 beside it and about it."""
    document = given(name)
    system = BranchSystem(read_sheet(document["pattern"])[0], None)
    n, bits, unit = system.size, 300, 1 << 100
    for number, root in enumerate(document["evidence"]["roots"]):
        x = [Fraction(int(m), 1 << root["bits"]) for m in root["center"]]
        for _ in range(4):  # Newton's method
            z = [*x, Fraction(1)]
            gradients = [[Fraction(0)] * (n + 1) for _ in range(n)]
            for row, quadric in zip(gradients, system.quadrics, strict=True):
                for (i, j), w in quadric.items():
                    row[i] += w * z[j]
            values = [sum(a * b for a, b in zip(row, z, strict=True)) / 2 for row in gradients]
            y = inverse([row[:n] for row in gradients])
            x = [
                Fraction(
                    round((a - sum(b * v for b, v in zip(row, values, strict=True))) * 2**400),
                    2**400,
                )
                for a, row in zip(x, y, strict=True)
            ]
        for place in range(n):
            for off, right in (
                (99, True),
                (-99, True),
                (101, False),
                (-101, False),
                (150, False),
                (199, False),
                (-399, False),
            ):
                center = [int(a * 2**bits) for a in x]
                center[place] += off * unit // 100
                box = Box(center, unit, bits)
                changed = given(name)
                changed["evidence"]["roots"][number] = {
                    "bits": bits,
                    "radius": str(box.radius),
                    "center": [str(m) for m in center],
                }
                if right:
                    verified(changed)
                else:
                    about = f"{center[:2]}.../2^{bits}"
                    refused(changed, f"Krawczyk's test fails for the box about {about}")


# --- signs on a box ------------------------------------------------------------------------------


def test_signs_on_a_box() -> None:
    for row, expected in (
        ([1, 0, 0], 1),
        ([-1, 0, 0], -1),
        ([0, 1, 0], None),
        ([1, 0, -2], None),  # it touches 0
        ([1, 0, -1], 1),
        ([1, 1, -2], None),
        ([0, 0, 0], 0),
        ([0, 0, 3], 1),
        ([0, 0, -3], -1),
        ([1, 0, -5], -1),
        ([-1, 0, 2], None),
        ([1, -1, -4], None),
        ([1, -1, -7], -1),
    ):
        assert Box([12, 1], 4, 2).sign(row) == expected
    assert [digit(x) for x in (-1, 0, 1, None)] == [-1, 0, 1, 2]
    assert agrees("MUFV", "MVFV")
    assert agrees("", "")
    for claimed, letters in (("M", "V"), ("M", "U"), ("MM", "M"), ("M", "MM"), ("", "M")):
        assert not agrees(claimed, letters)
