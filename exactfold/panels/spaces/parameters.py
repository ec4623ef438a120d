"""Linear spaces of motions by parameters, each of which is the density of one fold."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from functools import cached_property

from flint import fmpq

from exactfold.panels.spaces.kernel import Rows
from exactfold.panels.spaces.sparse import Form, Row, plain, row_space
from exactfold.panels.spaces.subspaces import Leaf, made_leaf
from exactfold.pattern.panel_pattern import Edge


@dataclass(frozen=True)
class Space:
    """The densities as functions of parameters, each of which is the density of one fold.

    `rows` has the density of each fold as a row of coefficients. Its key is the fold, or (v, -k)
    for a linear factor of the form of vertex v that must not vanish (`is_kept`). `forms` has those
    forms of vertices that are known on this space. `found` are the `users`, if they are known.
    """

    rows: Mapping[Edge, Row]
    forms: Mapping[int, Form]
    found: Mapping[int, frozenset[Edge]] | None = None
    changed: frozenset[int] = frozenset()
    """The vertices whose form may differ from that on the space from which this one was made."""

    @cached_property
    def users(self) -> Mapping[int, frozenset[Edge]]:
        """The folds whose density depends on each parameter."""
        if self.found is not None:
            return self.found
        users: dict[int, list[Edge]] = {}
        for edge, row in self.rows.items():
            for k in row:
                users.setdefault(k, []).append(edge)
        return {k: frozenset(edges) for k, edges in users.items()}

    @property
    def parameters(self) -> list[int]:
        """The parameters on which some density depends, in order."""
        return sorted({k for row in self.rows.values() for k in row})


def is_kept(edge: Edge) -> bool:
    """Whether the row of this key is a factor that must not vanish; folds join two vertices."""
    return edge[1] < 0


def on_folds(rows: Rows, size: int) -> dict[Edge, Row]:
    """The rows of a space as sparse ones, whose parameters are densities of folds."""
    sparse = {edge: {k: plain(x) for k, x in enumerate(row) if x} for edge, row in rows.items()}
    owned = {min(row) for row in sparse.values() if len(row) == 1 and row[min(row)] == 1}
    if len(owned) == size:
        return sparse
    return dict(zip(sparse, row_space(list(sparse.values()))[1], strict=True))


def leaf_of(space: Space, left: Iterable[int]) -> Leaf:
    """The space as a leaf, on which the forms of the vertices `left` remain."""
    names = space.parameters
    zero = fmpq(0)
    folds = ((edge, row) for edge, row in space.rows.items() if not is_kept(edge))
    rows: Rows = {edge: [row.get(k, zero) for k in names] for edge, row in folds}
    return made_leaf(rows, len(names), left)
