"""Control experiment: systems of quadrics that no longer come from a crease pattern."""

from __future__ import annotations

import random
from fractions import Fraction

from exactfold.errors import UsageError
from exactfold.exact.numbers import RationalLike, as_rational
from exactfold.rigidity.equations.quadratic import QuadraticSystem

_STEPS = 1 << 10


def perturbed(system: QuadraticSystem, size: RationalLike, seed: int) -> QuadraticSystem:
    """The system with every coefficient multiplied by a random factor in [1 - size, 1 + size].

    The factors are 1 + size k / 1024, where `random.Random(seed)` draws the integers k uniformly
    from [-1024, 1024]. Coefficients that are zero stay zero, so that the same unknowns meet in each
    equation. This is the paper's test (section "Vertex sign patterns") of whether real solutions
    are to be expected anyway: the quadrics of a pattern have real zeros only (docs/theorem.md), but
    perturbed quadrics in general do not. As the factors are rational, `isolate` can prove all zeros
    of the perturbed system, real or not. Size 0 gives the same system.

    Raises `UsageError` for a negative size or seed, and `FloatRefusedError` for a float.

    >>> circle_and_line_pair = QuadraticSystem.from_rational(
    ...     [[[1, 0, 0], [0, 1, 0], [0, 0, -1]], [[0, 1, 0], [1, 0, 0], [0, 0, 0]]])
    >>> perturbed(circle_and_line_pair, 0, seed=1) == circle_and_line_pair
    True
    >>> [[bool(x) for x in row] for row in perturbed(circle_and_line_pair, "1/10", 1).matrices[0]]
    [[True, False, False], [False, True, False], [False, False, True]]
    """
    ratio = as_rational(size)
    if ratio < 0 or seed < 0:
        raise UsageError("the size of a perturbation and its seed must not be negative")
    source = random.Random(seed)
    matrices = []
    for matrix in system.matrices:
        rows = [[Fraction(x) for x in row] for row in matrix]
        for i, row in enumerate(rows):
            for j in range(i + 1):
                if row[j]:
                    row[j] *= 1 + ratio * Fraction(source.randint(-_STEPS, _STEPS), _STEPS)
                    rows[j][i] = row[j]
        matrices.append(rows)
    return QuadraticSystem.from_rational(matrices)
