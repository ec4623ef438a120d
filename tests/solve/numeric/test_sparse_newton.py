"""The sparse Newton solver of one branch."""

import numpy as np
import pytest

from exactfold.solve.numeric.sparse_newton import Point, equations


def test_on_a_regular_cone_a_row_is_that_of_its_line() -> None:
    """N = 0 there, to rounding errors, and its root has no gradient."""
    lines = np.array([0.5, 0.5, -0.5])
    excess = lines**2 * [1, 1 - 1e-15, 1 + 1e-15]
    point = Point(np.zeros(3), np.zeros(0), lines, excess)
    value, of_lines, of_forms = equations(None, point, np.ones(3))  # type: ignore[arg-type]
    assert value == pytest.approx(lines, rel=1e-6)
    assert (of_lines.tolist(), of_forms.tolist()) == ([1] * 3, [0] * 3)
