"""Polynomials in one integer, against the same polynomials coefficient by coefficient."""

from __future__ import annotations

import random
from typing import Any

import pytest
from forge import given, given_lines, verified

from exactfold.checker.motion import branch_points, equations, packed, tubes
from exactfold.checker.motion.bounds import INVERSE_BITS, product
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


def test_a_width_holds_scalar_products() -> None:
    p = [[3, -4, 5], [-7, 0, 0]]
    for size in (1, 9, 255, 1 << 77):
        width = packed.wide_enough(p, size)
        most = 12 * size
        assert width % 8 == 0
        assert most <= (1 << width - 1) - 1 < most << 10


@pytest.mark.parametrize("digits", [3, 40, 90, 300])
def test_the_highest_words_of_a_product_are_read(digits: int) -> None:
    """Each is the floor; the entries that are largest in size do not reach the sign."""
    rng, n = random.Random(digits), 4
    sizes = [1 << digits, 1 << digits // 2, (1 << digits + 9) - 1]
    for trial in range(12):
        end = trial < 4
        p = [[rng.choice((-1, 1)) * (1 << 40 if end else rng.randint(0, 1 << 40)) for _ in range(n)]
             for _ in range(n)]  # fmt: skip
        matrices = [
            [[rng.choice((-1, 1)) * (size if end else rng.randint(0, size)) for _ in range(n)]
             for _ in range(n)] for size in sizes
        ]  # fmt: skip
        if end:  # signs that add up
            for matrix in matrices:
                for row, factor in zip(matrix, p[trial], strict=True):
                    row[:] = [abs(x) if factor > 0 else -abs(x) for x in row]
        lanes = packed.Lanes(p, sizes)
        whole = lanes.table(matrices)
        columns = [list(enumerate(column)) for column in zip(*whole, strict=True)]
        one = 1 << digits
        exact = [
            [
                [
                    sum(a * row[c] for a, row in zip(line, matrix, strict=True))
                    - (one if i == c and not k else 0)
                    for c in range(n)
                ]
                for i, line in enumerate(p)
            ]
            for k, matrix in enumerate(matrices)
        ]
        for (rows, drop), true, size in zip(
            lanes.read(product(p, columns), one), exact, sizes, strict=True
        ):
            unit = 2.0**drop
            assert unit <= n * (size << 40) / (1 << 60)
            for line, right in zip(rows, true, strict=True):
                for x, y in zip(line, right, strict=True):
                    if drop >= 0:
                        assert x << drop <= y < x + 1 << drop
                    else:
                        assert x == y << -drop


CERTIFICATES = ["motion-drive", "motion-rim", "motion-node", "motion-start"]


@pytest.mark.parametrize("name", [*CERTIFICATES, "loops-one-vertex"])
def test_no_coefficient_outgrows_its_place(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    """The numbers of real pieces, in places that are much wider, or computed one by one."""
    seen = []

    def wide(sheet: Any, curve: Any, p: Any, residual: Any, most: int, degree: int) -> Any:
        found = images(sheet, curve, p, residual, most, degree)
        width = 8 * (packed.wide_enough(p, most) // 8 + 40)
        columns = zip(*curve, strict=True)
        values = residual([packed.packed(column, width) for column in columns], width)
        parts = [packed.unpacked(value, width, degree + 9) for value in values]
        assert all(abs(c) <= most for part in parts for c in part)
        assert not any(c for part in parts for c in part[degree + 1 :])
        assert found == [
            [sum(a * b for a, b in zip(line, g, strict=True)) for line in p]
            for g in list(zip(*parts, strict=True))[: degree + 1]
        ]
        seen.append("images")
        return found

    class Told(packed.Lanes):
        def __init__(self, p: Any, sizes: Any) -> None:
            super().__init__(p, sizes)
            self.p, self.sizes = p, sizes

        def table(self, tables: Any) -> Any:
            for size, rows in zip(self.sizes, tables, strict=False):
                assert all(abs(x) <= size for row in rows for x in row)
            return super().table(tables)

        def read(self, product: Any, one: int) -> Any:
            most = max(sum(map(abs, row)) for row in self.p)
            for row in product:
                for whole in row:
                    parts = packed.unpacked(whole, self.width, len(self.sizes))
                    for c, shift, size in zip(parts, self.shifts, self.sizes, strict=True):
                        assert abs(c) <= most * size << shift
            seen.append("slopes")
            assert one >> INVERSE_BITS
            return super().read(product, one)

    images = equations.images
    monkeypatch.setattr(tubes, "images", wide)
    monkeypatch.setattr(branch_points, "images", wide)
    monkeypatch.setattr(equations, "Lanes", Told)
    monkeypatch.setattr(branch_points, "Lanes", Told)
    if name.startswith("loops"):
        header, loop, _ = given_lines(name)
        LoopSheet(header).check_loop(loop)
    else:
        verified(given(name))
    assert {"images", "slopes"} <= set(seen)
