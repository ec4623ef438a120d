"""Parts of a sheet whose vertices form a tree: all components, counted without a list of them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import Final, TypeAlias

import networkx as nx

from exactfold.errors import TooManyModesError
from exactfold.panels.vertex.local import local_modes
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge

_MOST_JOINTS: Final = 8
_MOST_STATES: Final = 20_000

Reach: TypeAlias = frozenset[tuple[bool, bool]]
"""How a choice of pieces can grow: whether the joint above folds then, and whether something
grew.
"""
_States: TypeAlias = dict[tuple[bool, Reach], Counter[int]]


@dataclass(frozen=True)
class Piece:
    """An irreducible set of local motions in which the other folds are flat.

    It is 0, a line, or the double cone of five folds or more, and `folds` are those that fold on
    it. `line` distinguishes the two lines of four folds.
    """

    folds: frozenset[Edge]
    dimension: int
    line: int = 0

    def holds(self, other: Piece) -> bool:
        """Whether every motion of the other piece is one of this piece."""
        if self.dimension < 2:
            return self == other or not other.folds
        return other.folds <= self.folds


def tree_components(stars: Mapping[int, Star]) -> dict[int, int] | None:
    """{dimension: number} of the components to second order; None unless the vertices form a tree.

    A component is a choice of a piece at each vertex, such that the pieces at both ends of a joint,
    a fold between two vertices, agree whether it folds; no choice of larger pieces may agree, too
    (docs/panels.md, Trees). Each component truly folds. The choices are counted from the leaves of
    the tree to a root, with what is needed to know which of them can grow.

    Raises `TooManyModesError` if a vertex has more than eight joints, or if there are too many
    cases.

    >>> cross = ((1, 0), (0, 1), (-1, 0), (0, -1))
    >>> tree_components({0: Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), cross),
    ...                  1: Star(1, ((1, 5), (1, 6), (0, 1), (1, 7)), cross)})
    {1: 1, 2: 1}
    """
    graph = nx.Graph()
    graph.add_nodes_from(stars)
    for star in stars.values():
        graph.add_edges_from(e for e in star.folds if e[0] in stars and e[1] in stars)
    if not stars or not nx.is_tree(graph):
        return None
    root = next(iter(stars))
    states: dict[int, _States] = {}
    for v in nx.dfs_postorder_nodes(graph, root):
        children = [(_joint(v, u), states.pop(u)) for u in graph[v] if u in states]
        above = next((_joint(v, u) for u in graph[v] if _joint(v, u) not in dict(children)), None)
        joints = [_joint(v, u) for u in graph[v]]
        states[v] = _joined(_pieces(stars[v], joints), children, above)
    total: Counter[int] = Counter()
    for (_, reach), counts in states[root].items():
        if not any(grown for _, grown in reach):
            total.update(counts)
    return dict(sorted(total.items()))


def _joint(v: int, u: int) -> Edge:
    return (v, u) if v < u else (u, v)


def _pieces(star: Star, joints: Sequence[Edge]) -> list[Piece]:
    """The pieces of a vertex, for every set of joints that are flat."""
    if len(joints) > _MOST_JOINTS:
        raise TooManyModesError(f"vertex {star.vertex} has {len(joints)} neighbours that fold")
    pieces: dict[Piece, None] = {}
    for count in range(len(joints) + 1):
        for flat in combinations(joints, count):
            pieces |= dict.fromkeys(_irreducible(star.only(set(star.folds) - set(flat))))
    return list(pieces)


def _irreducible(star: Star) -> Iterator[Piece]:
    """The irreducible components of the motions of one vertex."""
    kept = star.foldable() if star.folds else ()
    star = star.only(star.folds[k] for k in kept)
    if len(star.folds) > 4:
        yield Piece(frozenset(star.folds), len(star.folds) - 3)
    elif star.folds:
        for mode in local_modes(star):
            line = mode.index if len(mode.folds) == 4 else 0
            yield Piece(frozenset(mode.folds), 1, line)
    else:
        yield Piece(frozenset(), 0)


def _joined(
    pieces: Sequence[Piece],
    children: Iterable[tuple[Edge, _States]],
    above: Edge | None,
) -> _States:
    """The states of a vertex with those of the branches of the tree below it."""
    below = list(children)
    result: _States = {}
    for piece in pieces:
        larger = [other for other in pieces if other.holds(piece)]
        # for each larger piece: whether all branches can stay, and whether one of them can grow
        cases: dict[tuple[tuple[bool, bool], ...], Counter[int]] = {
            ((True, False),) * len(larger): Counter({piece.dimension: 1})
        }
        for joint, states in below:
            cases = _with_branch(cases, joint, states, piece, larger)
        for case, counts in cases.items():
            reach: set[tuple[bool, bool]] = set()
            for other, (stays, grows) in zip(larger, case, strict=True):
                folds = above in other.folds
                if stays:
                    reach.add((folds, other != piece))
                if grows:
                    reach.add((folds, True))
            key = above in piece.folds, frozenset(reach)
            result.setdefault(key, Counter()).update(counts)
    return result


def _with_branch(
    cases: Mapping[tuple[tuple[bool, bool], ...], Counter[int]],
    joint: Edge,
    states: _States,
    piece: Piece,
    larger: Sequence[Piece],
) -> dict[tuple[tuple[bool, bool], ...], Counter[int]]:
    """The cases of a piece with one more branch, whose joint folds if it folds on the piece."""
    folds = joint in piece.folds
    joined: dict[tuple[tuple[bool, bool], ...], Counter[int]] = {}
    for case, counts in cases.items():
        for (active, reach), more in states.items():
            if active != folds:
                continue
            new = []
            for other, (stays, grows) in zip(larger, case, strict=True):
                stay = (joint in other.folds, False) in reach
                grow = (joint in other.folds, True) in reach
                new.append((stays and stay, (grows and (stay or grow)) or (stays and grow)))
            total = joined.setdefault(tuple(new), Counter())
            for a, m in counts.items():
                for b, n in more.items():
                    total[a + b - folds] += m * n
    if len(joined) > _MOST_STATES:
        raise TooManyModesError(f"a tree of vertices has more than {_MOST_STATES} cases")
    return joined
