"""Equations that are reduced one after another agree with elimination at once."""

from __future__ import annotations

import random
from fractions import Fraction

from exactfold.exact.linalg import rank
from exactfold.pattern.drawing.meant.system import System


def test_the_rank_and_the_solution_agree_with_elimination() -> None:
    source = random.Random(5)
    for _ in range(40):
        rows = [
            {
                k: source.choice([-2, -1, 1, 2])
                for k in source.sample(range(8), source.randint(1, 4))
            }
            for _ in range(10)
        ]
        solution = [Fraction(source.randint(-9, 9), source.randint(1, 9)) for _ in range(8)]
        values = [sum((c * solution[k] for k, c in row.items()), Fraction(0)) for row in rows]
        system: System[int] = System(float)
        for row, value in zip(rows, values, strict=True):
            system.add(row, value)
        assert system.rank == rank([[row.get(k, 0) for k in range(8)] for row in rows])
        for row, value in zip(rows, values, strict=True):
            assert system.rest(row, value) == ({}, 0)
            assert system.rest(row, value + 1) == ({}, 1)
        for k in range(8):
            terms, constant = system.expression(k)
            assert not any(system.is_solved(free) for free in terms)
            assert solution[k] == constant + sum(c * solution[free] for free, c in terms.items())


def test_the_lightest_unknown_is_solved_for_and_those_without_weight_never() -> None:
    system: System[str] = System({"light": 1.0, "heavy": 2.0}.get)
    assert system.add({"heavy": 1, "light": 1, "tag": 1}, Fraction(3))
    assert system.is_solved("light")
    assert not system.is_solved("heavy")
    assert not system.add({"tag": 1}, Fraction(1))
