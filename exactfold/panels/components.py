"""Components of the motions of a sheet: maximal sets of elementary modes that share no vertex."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import Final

import networkx as nx

from exactfold.errors import TooManyModesError
from exactfold.panels.elementary import Support

_MOST_CLIQUES: Final = 1_000_000


def components(supports: Sequence[Support], free_folds: int) -> dict[int, int]:
    """{dimension: number} of the components of all motions to second order.

    Let every vertex have at most four folds. Then the motions are a union of linear spaces. Each is
    spanned by elementary modes without a common vertex, and by the folds whose two ends lie on the
    border (docs/panels.md, Structure theorem). The components are the maximal spaces. The dimension
    of a component is its number of modes plus the number of free folds. Maximal sets of supports
    are the maximal cliques of the graph of disjoint supports; each set stands for the product of
    its counts. A sheet that cannot move has one component, the flat state, of dimension 0.

    Raises `TooManyModesError` if there are more than a million maximal sets of supports.

    >>> components([Support((1, 2), 2), Support((3,), 1), Support((2, 3), 1)], 0)
    {1: 1, 2: 2}
    """
    if not supports:
        return {free_folds: 1}
    graph = nx.Graph()
    graph.add_nodes_from(range(len(supports)))
    masks = [sum(1 << v for v in support.vertices) for support in supports]
    for i, mask in enumerate(masks):
        graph.add_edges_from((i, j) for j in range(i) if not mask & masks[j])
    total: Counter[int] = Counter()
    for number, clique in enumerate(nx.find_cliques(graph)):
        if number == _MOST_CLIQUES:
            raise TooManyModesError(
                f"more than {_MOST_CLIQUES} maximal sets of folds can move independently"
            )
        weight = 1
        for k in clique:
            weight *= supports[k].count
        total[len(clique) + free_folds] += weight
    return dict(sorted(total.items()))
