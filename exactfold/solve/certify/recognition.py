"""Finds the exact form of isolated roots: rebuilds their parametrisation, and verifies it."""

from __future__ import annotations

from collections.abc import Sequence

from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.from_roots import parametrisation_of_some
from exactfold.solve.certify.box import IsolatingBox


def recognise(system: QuadraticSystem, boxes: Sequence[IsolatingBox]) -> list[RootClass] | None:
    """The zeros in real boxes, exactly, as classes of conjugate algebraic points.

    The zeros have a rational parametrisation if they are all zeros of some rational system, such as
    all zeros at which given folds are flat (see `parametrisation_of_some`). The result has passed
    `RootClass.verify` and has exactly one zero in each of the boxes. The result None means that no
    rational coefficients were found, which decides nothing.

    >>> from exactfold.solve.certify.exact_krawczyk import krawczyk
    >>> system = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> [c.polynomial for c in recognise(system, krawczyk(system, [[1.4142], [-1.4142]]))]
    [(-2, 0, 1)]
    """
    whole = parametrisation_of_some(system, boxes)
    if whole is None:
        return None
    classes = whole.factors()
    return classes if _is_spread(classes, boxes) else None


def _is_spread(classes: Sequence[RootClass], boxes: Sequence[IsolatingBox]) -> bool:
    """Whether each box holds exactly one real zero of the classes."""
    bits = max(box.bits - box.radius.bit_length() for box in boxes) + 8
    points = [point for root_class in classes for point in root_class.real_points(min(bits, 256))]
    counts = [
        sum(
            all(
                low <= interval[1] and interval[0] <= high
                for (low, high), interval in zip(
                    point, (box.interval(k) for k in range(len(point))), strict=True
                )
            )
            for point in points
        )
        for box in boxes
    ]
    return len(points) == len(boxes) and all(count == 1 for count in counts)
