"""Polynomials in one integer, against the same polynomials coefficient by coefficient."""

from __future__ import annotations

import itertools
import random
from fractions import Fraction
from typing import Any

import pytest
from forge import given, given_lines, verified

from exactfold.checker.motion import branch_points, equations, packed, tubes
from exactfold.checker.motion.bounds import INVERSE_BITS, Rounded
from exactfold.checker.motion.loops import LoopSheet


@pytest.mark.parametrize("width", [8, 16, 208])
def test_the_largest_coefficients_are_read_back(width: int) -> None:
    rng, most = random.Random(width), (1 << width - 1) - 1
    for _ in range(50):
        given = [rng.choice((-most - 1, most, -1, 0, 1, rng.randint(-most, most))) for _ in "12345"]
        whole = packed.packed(given, width)
        assert whole == sum(c << width * k for k, c in enumerate(given))
        assert packed.unpacked(whole, width, 5) == given
        assert [packed.coefficient(whole, width, k) for k in range(5)] == given
    with pytest.raises(OverflowError):
        packed.unpacked(1 << width * 5 - 1, width, 5)


def test_a_width_holds_coefficients() -> None:
    for size in (1, 9, 255, 1 << 77):
        width = packed.wide_enough(size)
        assert width % 8 == 0
        assert size <= (1 << width - 1) - 1 < size << 11


def random_matrices(rng: random.Random, digits: int, end: bool) -> tuple[Any, Any]:
    """P and M; with `end` the entries of M are as large as allowed, with signs that add up."""
    n, size = 5, (1 << digits) - 1
    p = [
        [rng.choice((-1, 1)) * (1 << 40 if end else rng.randint(0, 1 << 40)) for _ in range(n)]
        for _ in range(n)
    ]
    m = [[rng.choice((-1, 0, 1)) * rng.randint(0, size) for _ in range(n)] for _ in range(n)]
    if end:
        m = [[size if factor > 0 else -size] * n for factor in p[0]]
    return p, m


def columns_of(m: list[list[int]]) -> list[list[tuple[int, int]]]:
    return [[(e, x) for e, x in enumerate(column) if x] for column in zip(*m, strict=True)]


def exact_product(p: list[list[int]], m: list[list[int]]) -> list[list[int]]:
    columns = list(zip(*m, strict=True))
    return [[sum(a * b for a, b in zip(line, c, strict=True)) for c in columns] for line in p]


def assert_sizes(found: Rounded, exact: list[list[int]], most: Fraction) -> None:
    """The sizes differ by at most `off` units, which are together at most `most`."""
    rows, drop, off = found
    unit = Fraction(2) ** drop
    assert off * unit <= most
    for line, right in zip(rows, exact, strict=True):
        for x, y in zip(line, right, strict=True):
            assert x >= 0
            assert abs(x * unit - abs(y)) <= off * unit


@pytest.mark.parametrize("digits", [3, 22, 24, 40, 90, 300])
def test_products_less_one_are_exact_up_to_their_last_words(digits: int) -> None:
    rng = random.Random(digits)
    for trial in range(40):
        p, m = random_matrices(rng, digits, trial < 8)
        one, exact = rng.randint(0, 1 << digits), exact_product(p, m)
        for k, row in enumerate(exact):
            row[k] -= one
        found = packed.near_one(p, columns_of(m), (1 << digits) - 1, one)
        assert_sizes(found, exact, Fraction(5 << digits + 41, 1 << 60))


@pytest.mark.parametrize("digits", [3, 27, 28, 29, 40, 90, 300])
@pytest.mark.parametrize("end", [False, True])
def test_coarse_products_are_off_by_no_more_than_they_say(digits: int, end: bool) -> None:
    rng = random.Random(digits)
    for _ in range(40):
        p, m = random_matrices(rng, digits, end)
        found = packed.Coarse(p).sizes(columns_of(m))
        assert_sizes(found, exact_product(p, m), Fraction(5 << digits + 41, 1 << 26))


def test_a_coarse_product_with_nothing_is_nearly_nothing() -> None:
    p, _ = random_matrices(random.Random(1), 40, False)
    rows, drop, off = packed.Coarse(p).sizes([[], []])
    assert rows == [[0, 0]] * 5
    assert off << max(drop, 0) < 1 << 40


CERTIFICATES = ["motion-drive", "motion-rim", "motion-node", "motion-start"]


@pytest.mark.parametrize("name", [*CERTIFICATES, "loops-one-vertex"])
def test_no_coefficient_outgrows_its_place(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The numbers of real pieces, in places that are much wider, or computed one by one."""
    seen = []

    def wide(curve: Any, p: Any, residual: Any, most: int, degree: int) -> Any:
        found = images(curve, p, residual, most, degree)
        width = 8 * (packed.wide_enough(most) // 8 + 40)
        columns = zip(*curve, strict=True)
        values = residual([packed.packed(column, width) for column in columns], width)
        parts = [packed.unpacked(value, width, degree + 9) for value in values]
        assert all(abs(c) <= most for part in parts for c in part)
        assert not any(c for part in parts for c in part[degree + 1 :])
        for got, g in zip(found, zip(*parts, strict=True), strict=False):
            exact = exact_product(p.p, [[x] for x in g])
            room = max(sum(map(abs, row)) for row in p.p) * max(map(abs, g))
            assert_sizes(got, exact, Fraction(room + (1 << p.drop + 20), 1 << 18))
        seen.append("images")
        return found

    def exactly(p: Any, matrix: Any, size: int, one: int) -> Any:
        assert all(abs(x) <= size for column in matrix for _, x in column)
        assert one >> INVERSE_BITS
        seen.append("slopes")
        return near_one(p, matrix, size, one)

    class Told(packed.Coarse):
        def sizes(self, matrix: Any) -> Any:
            n = len(self.p)
            dense = [[0] * len(matrix) for _ in range(n)]
            for k, column in enumerate(matrix):
                for e, x in column:
                    dense[e][k] += x
            found = super().sizes(matrix)
            most = max(map(abs, itertools.chain([1], *dense)))
            room = max(sum(map(abs, row)) for row in self.p) * most
            assert_sizes(found, exact_product(self.p, dense), Fraction(room, 1 << 18))
            return found

    images = equations.images
    monkeypatch.setattr(tubes, "images", wide)
    monkeypatch.setattr(branch_points, "images", wide)
    near_one = packed.near_one
    for module in (equations, branch_points):
        monkeypatch.setattr(module, "near_one", exactly)
    for module in (tubes, branch_points):
        monkeypatch.setattr(module, "Coarse", Told)
    if name.startswith("loops"):
        header, loop, _ = given_lines(name)
        LoopSheet(header).check_loop(loop)
    else:
        verified(given(name))
    assert {"images", "slopes"} <= set(seen)
