"""Which of many boxes meet which others, by walking two trees of boxes level by level."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from exactfold._support.arrays import FloatArray, IndexArray

Corners: TypeAlias = tuple[FloatArray, FloatArray]
"""The lower and the upper corners of boxes, shape (n, 3) each."""


@dataclass(frozen=True, repr=False)
class BoxTree:
    """An order of n things in which neighbours are close to each other in the flat sheet.

    A binary tree over that order stays good while the sheet folds, because its parts stay together.
    """

    order: IndexArray

    @classmethod
    def of(cls, places: FloatArray) -> BoxTree:
        """The tree of things at these places in the plane, shape (n, 2)."""
        low, high = places.min(axis=0), places.max(axis=0)
        cells = ((places - low) / np.maximum(high - low, 1e-300) * 65535).astype(np.uint64)
        code = np.zeros(len(places), dtype=np.uint64)  # bits of x and y alternate (Morton order)
        for bit in range(16):
            for axis in range(2):
                code |= ((cells[:, axis] >> np.uint64(bit)) & np.uint64(1)) << np.uint64(
                    2 * bit + axis
                )
        return cls(np.argsort(code, kind="stable"))

    def levels(self, corners: Corners, depth: int) -> list[FloatArray]:
        """The boxes of the nodes, from the root down to single things, shape (6, 2^k) each.

        `corners` are those of the boxes of the things. A column holds the three lower and the three
        upper bounds of a node. If there are fewer than 2^depth things, the others have empty boxes.
        """
        low, high = corners
        boxes = np.full((6, 1 << depth), np.inf)
        boxes[3:] = -np.inf
        boxes[:3, : len(self.order)] = low[self.order].T
        boxes[3:, : len(self.order)] = high[self.order].T
        levels = [boxes]
        for _ in range(depth):
            even, odd = levels[-1][:, 0::2], levels[-1][:, 1::2]
            levels.append(np.vstack([np.minimum(even, odd)[:3], np.maximum(even, odd)[3:]]))
        return levels[::-1]

    def __repr__(self) -> str:
        return f"<BoxTree: {len(self.order)} boxes>"


def meeting(one: BoxTree, two: BoxTree, corners: Corners, others: Corners) -> IndexArray:
    """All pairs (k, m) such that box k of the first tree meets box m of the second.

    `corners` and `others` are those of their boxes. The result has shape (pairs, 2); its order has
    no meaning.

    >>> places = np.array([[0.0, 0.0], [1.0, 0.0], [5.0, 5.0]])
    >>> low = np.column_stack([places, np.zeros(3)])
    >>> tree = BoxTree.of(places)
    >>> sorted(map(tuple, meeting(tree, tree, (low, low + 1), (low, low + 1)).tolist()))
    [(0, 0), (0, 1), (1, 0), (1, 1), (2, 2)]
    """
    depth = int(max(len(one.order), len(two.order)) - 1).bit_length()
    first, second = one.levels(corners, depth), two.levels(others, depth)
    one_at = two_at = np.zeros(1, dtype=np.intp)
    for k in range(depth + 1):
        if k:
            one_at = (2 * one_at + np.array([[0], [0], [1], [1]])).reshape(-1)
            two_at = (2 * two_at + np.array([[0], [1], [0], [1]])).reshape(-1)
        a, b = first[k], second[k]
        for axis in range(3):  # one axis after the other: the first removes most pairs
            kept = np.flatnonzero(
                (a[axis][one_at] <= b[axis + 3][two_at]) & (b[axis][two_at] <= a[axis + 3][one_at])
            )
            one_at, two_at = one_at[kept], two_at[kept]
    return np.column_stack([one.order[one_at], two.order[two_at]])
