"""Pairs a < b with f(a) = f(b), for a function f on the line with limit infinity at both ends."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise, permutations


def partners(values: Sequence[int]) -> list[int | None]:
    """For each critical point, the other end of the curve of pairs that starts there.

    `values` are the critical values of f from left to right, all different: a minimum, a maximum,
    ..., a minimum. The pairs a < b with f(a) = f(b) form curves. One curve ends at each critical
    point, where a = b. The result has the critical point at its other end, or None if that end is
    at infinity.

    >>> partners([0, 5, 1])
    [None, 2, 1]
    """
    count = len(values)

    def end(piece: int, up: bool) -> int:
        """The critical point at the end of piece k, which goes from point k - 1 to point k.

        -1 and `count` stand for infinity.
        """
        return piece - 1 if up == (piece % 2 == 0) else piece

    found: list[int | None] = []
    for start in range(count):
        a, b, up = start, start + 1, start % 2 == 0
        while True:
            first, second = end(a, up), end(b, up)
            if first == second:  # a and b meet
                found.append(first)
                break
            open_ends = [p for p in (first, second) if 0 <= p < count]
            if not open_ends:
                found.append(None)
                break
            turning = min(open_ends, key=lambda p: values[p] if up else -values[p])
            if turning == first:  # a or b passes a critical point, and both turn round
                a = 2 * turning + 1 - a
            else:
                b = 2 * turning + 1 - b
            up = not up
    return found


def alternating(count: int) -> Iterator[tuple[int, ...]]:
    """Yield all orders of `count` critical values in which even places are below their neighbours.

    >>> list(alternating(3))
    [(0, 2, 1), (1, 2, 0)]
    """
    for values in permutations(range(count)):
        if all((x < y) == (k % 2 == 0) for k, (x, y) in enumerate(pairwise(values))):
            yield values
