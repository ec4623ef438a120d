"""The start of Newton's method and of popping: the linear equations l_v = e_v c."""

from __future__ import annotations

from collections.abc import Iterable


def start_size(rest: Iterable[float]) -> float:
    """The number c: a quarter of the largest height of the sheet with all l_v = 0, or else 1.

    `rest` are the heights of this sheet. They are 0, and c is 1, if the boundary is flat, as with a
    reflex corner. With this c the vertices pop about as far as the boundary heights require.
    >>> start_size([0.5, -2.0]), start_size([0.0, 0.0])
    (0.5, 1.0)
    """
    largest = max(map(abs, rest), default=0.0)
    return max(float(largest), 1e-3) / 4 if largest else 1.0
