"""Perturbed quadrics: exact and repeatable, and their non-real zeros are proved to be such."""

from __future__ import annotations

from fractions import Fraction

import pytest
from rivals.ball_krawczyk import arb_krawczyk
from sheets import SQUARE, scrambled

from exactfold import PROVED, CreasePattern, random_square
from exactfold.errors import FloatRefusedError, UsageError
from exactfold.rigidity import BranchSystem
from exactfold.rigidity.equations.perturbation import perturbed
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve import groebner, homotopy, isolate
from exactfold.solve.certify.box import IsolatingBox


def system_of(pattern: CreasePattern) -> QuadraticSystem:
    return BranchSystem(pattern).chart.system


@pytest.mark.parametrize("size", ["1/1000", "1/10", "1"])
def test_factors_are_in_range_and_zeros_stay_zero(size: str) -> None:
    before = system_of(random_square(5, 2))
    after = perturbed(before, size, seed=3)
    assert after == perturbed(before, size, seed=3) != perturbed(before, size, seed=4)
    bound = Fraction(size)
    for old, new in zip(before.matrices, after.matrices, strict=True):
        assert [[x != 0 for x in row] for row in old] == [[x != 0 for x in row] for row in new]
        ratios = [
            Fraction(y, x)
            for row, fresh in zip(old, new, strict=True)
            for x, y in zip(row, fresh, strict=True)
            if x
        ]
        # `new` is primitive: the factors are known up to one positive scale for each quadric.
        assert min(ratios) > 0
        assert max(ratios) * (1 - bound) <= min(ratios) * (1 + bound)
        assert len(set(ratios)) > 1


def test_size_zero_changes_nothing() -> None:
    system = system_of(random_square(4, 1))
    assert perturbed(system, 0, seed=5) == system


def test_wrong_arguments() -> None:
    system = system_of(random_square(1, 1))
    with pytest.raises(UsageError, match="must not be negative"):
        perturbed(system, -1, seed=0)
    with pytest.raises(UsageError, match="must not be negative"):
        perturbed(system, 1, seed=-1)
    with pytest.raises(FloatRefusedError):
        perturbed(system, 0.1, seed=0)  # type: ignore[arg-type]


@pytest.mark.parametrize(("interior", "seed"), [(2, 0), (2, 1), (2, 2), (3, 0), (3, 1), (3, 2)])
def test_real_and_nonreal_zeros_by_boxes_and_by_the_exact_engine(interior: int, seed: int) -> None:
    """Two independent ways: boxes of homotopy ends, and Sturm's count on a Groebner basis."""
    system = perturbed(system_of(random_square(interior, seed)), "1/2", seed)
    found = isolate(system, homotopy(system))
    exact = groebner(system)
    assert found.complete is PROVED
    assert exact.dimension == exact.distinct == 1 << interior == found.real + found.nonreal
    assert found.real == len(exact.real_points(8))
    again = arb_krawczyk(system, exact.approx_points())
    assert all(isinstance(box, IsolatingBox) for box in again)
    assert sum(box.is_real for box in again if isinstance(box, IsolatingBox)) == found.real
    assert sum(box.is_nonreal for box in again if isinstance(box, IsolatingBox)) == found.nonreal


def test_nonreal_zeros_come_in_conjugate_pairs() -> None:
    system = perturbed(system_of(scrambled(3, SQUARE, 4)), "1/2", seed=1)
    boxes = [box for box in isolate(system, homotopy(system)).boxes if box.is_nonreal]
    assert boxes
    assert len(boxes) % 2 == 0
    for box in boxes:
        mirrored = IsolatingBox(box.real, tuple(-y for y in box.imag), box.radius, box.bits)
        assert mirrored.is_disjoint_from(box)
        assert sum(not mirrored.is_disjoint_from(other) for other in boxes) == 1
