"""Components of a part whose vertices form a tree, counted without a list (docs/panels.md, Trees).

If some folds between two vertices, the joints, are held flat, the motions of a vertex are 0, lines,
or a double cone of five folds or more: its pieces. A choice has a piece at each vertex, and the two
pieces at a joint agree whether it folds. The components are the maximal choices. The dimension of a
choice is the sum of those of its pieces, less the number of joints that fold.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Any

from ..core import limits
from ..core.reading import at_most, items, keys, keys_of, natural, require, same
from ..sheets.panels import Edge, Near, PanelSheet, pair
from .claims import TreeClaim
from .leaves import PartComponents
from .lines import lines_at

MOST_JOINTS = limits.TREE_JOINTS
MOST_CASES = limits.TREE_CASES

_SAME, _LARGER = 1, 2
"""Bits: larger or equal pieces fit below if all are the same, or if some of them are larger."""

Growth = tuple[int, int]
"""The bits for the larger choices of a branch, if the joint above stays flat and if it folds."""
States = dict[tuple[bool, Growth], dict[int, int]]
"""The numbers of choices of a branch by dimension, for each answer whether the joint above folds
and for each growth."""


@dataclass(frozen=True)
class Piece:
    """The motions of a vertex on one line, in a double cone, or 0; `folds` are those that fold.

    `line` tells the two lines of four folds apart.
    """

    folds: frozenset[Edge]
    dimension: int
    line: int = 0

    def holds(self, other: Piece) -> bool:
        """Whether all motions of the other piece belong to this one."""
        if self.dimension > 1:
            return other.folds <= self.folds
        return self == other or other.dimension == 0


def verified_trees(
    sheet: PanelSheet, parts: Sequence[Near], given: Sequence[Any]
) -> dict[int, PartComponents]:
    """Verify the components of the parts that the file says are trees, by their first vertices.

    All of them extend to true motions. With at most four folds at each vertex there are no others.
    """
    known = {tuple(part): part for part in parts}
    trees: dict[int, PartComponents] = {}
    for entry in given:
        keys(entry, keys_of(TreeClaim), "a tree")
        vertices = tuple(natural(v, "a vertex") for v in items(entry["vertices"], "vertices"))
        require(vertices in known, "the vertices of a tree are not those of a part")
        require(vertices[0] not in trees, f"the tree of vertex {vertices[0]} appears twice")
        counts = tree_components(sheet, known[vertices])
        fact = {str(dimension): number for dimension, number in counts.items()}
        shown = f"the tree of vertex {vertices[0]} has the components {fact}"
        require(same(entry["components"], fact), shown)
        few = all(len(around) <= 4 for around in known[vertices].values())
        trees[vertices[0]] = PartComponents(counts, counts if few else None, set(counts) != {0})
    return trees


def tree_components(sheet: PanelSheet, near: Near) -> dict[int, int]:
    """The components of a connected part, as {dimension: number}; raises unless it is a tree."""
    joints = {v: [pair(v, u) for u in around if u in near] for v, around in near.items()}
    tree = sum(map(len, joints.values())) == 2 * (len(near) - 1)
    require(tree, f"the vertices of the part of vertex {min(near)} do not form a tree")
    order: list[tuple[int, Edge | None]] = [(min(near), None)]
    seen = {min(near)}
    for v, _ in order:
        after = [(u, pair(v, u)) for u in near[v] if u in near and u not in seen]
        seen.update(u for u, _ in after)
        order += after
    states: dict[Edge | None, States] = {}
    for v, above in reversed(order):
        below = [(joint, states.pop(joint)) for joint in joints[v] if joint in states]
        states[above] = _branch(_pieces(sheet, v, near[v], joints[v]), below, above)
    total: dict[int, int] = {}
    for (_, growth), numbers in states[None].items():
        if not any(bits & _LARGER for bits in growth):
            _add(total, numbers)
    return dict(sorted(total.items()))


def _pieces(sheet: PanelSheet, v: int, around: list[int], joints: list[Edge]) -> list[Piece]:
    """The pieces of a vertex, for all sets of its joints that stay flat."""
    at_most(len(joints), MOST_JOINTS, "the joints of one vertex of a tree", "TREE_JOINTS")
    pieces: dict[Piece, None] = {}
    for number in range(len(joints) + 1):
        for flat in combinations(joints, number):
            kept = sheet.foldable(v, [u for u in around if pair(v, u) not in flat])
            if len(kept) > 4:
                pieces[Piece(frozenset(pair(v, u) for u in kept), len(kept) - 3)] = None
            elif kept:
                for k, line in enumerate(lines_at(sheet, v, kept)):
                    folds = frozenset(pair(v, u) for u in line.densities)
                    pieces[Piece(folds, 1, k if len(folds) == 4 else 0)] = None
            else:
                pieces[Piece(frozenset(), 0)] = None
    return list(pieces)


def _branch(
    pieces: Sequence[Piece], below: Sequence[tuple[Edge, States]], above: Edge | None
) -> States:
    """The states of a vertex with the branches below it."""
    result: States = {}
    for piece in pieces:
        larger = [other for other in pieces if other.holds(piece)]
        cases: dict[tuple[int, ...], dict[int, int]]
        cases = {(_SAME,) * len(larger): {piece.dimension: 1}}
        for joint, states in below:
            moves = joint in piece.folds
            joined: dict[tuple[int, ...], dict[int, int]] = {}
            for bits, numbers in cases.items():
                for (active, growth), more in states.items():
                    if active == moves:
                        both = zip(bits, larger, strict=True)
                        key = tuple(_together(b, growth[joint in q.folds]) for b, q in both)
                        _add(joined.setdefault(key, {}), _times(numbers, more, int(moves)))
            cases = joined
            at_most(len(cases), MOST_CASES, "the cases of a tree of vertices", "TREE_CASES")
        for bits, numbers in cases.items():
            ends = [0, 0]
            for bit, other in zip(bits, larger, strict=True):
                grown = bit if other == piece else _LARGER if bit else 0
                ends[above in other.folds] |= grown
            _add(result.setdefault((above in piece.folds, (ends[0], ends[1])), {}), numbers)
    return result


def _together(first: int, second: int) -> int:
    """The bits of two branches together."""
    if not (first and second):
        return 0
    return (first & second & _SAME) | ((first | second) & _LARGER)


def _add(total: dict[int, int], numbers: dict[int, int]) -> None:
    for dimension, number in numbers.items():
        total[dimension] = total.get(dimension, 0) + number


def _times(numbers: dict[int, int], more: dict[int, int], joints: int) -> dict[int, int]:
    """Dimensions add, less the joints that fold, and numbers multiply."""
    product: dict[int, int] = {}
    for a, m in numbers.items():
        for b, n in more.items():
            product[a + b - joints] = product.get(a + b - joints, 0) + m * n
    return product
