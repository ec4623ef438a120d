"""Components of the motions of a large part, found one by one and proved; there may be others."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from exactfold.errors import TooManyModesError
from exactfold.panels.kernel import Entry, Rows, imposed
from exactfold.panels.proposals import Proposal, Proposals
from exactfold.panels.regular import (
    Balls,
    Forms,
    in_balls,
    is_component,
    outside,
    parameter_folds,
    regular_point,
    truly_folds,
)
from exactfold.panels.stars import Star
from exactfold.panels.subspaces import (
    MOST_ROOTS,
    Leaf,
    factors,
    is_semidefinite,
    made_leaf,
    squares_of,
)


@dataclass(frozen=True)
class FoundComponent:
    """A component that was found: the leaf it lies in, its dimension, and a regular motion of it.

    The space of `leaf` holds it; `folds` says whether it is known to fold truly.
    """

    leaf: Leaf
    dimension: int
    motion: Balls
    folds: bool

    def __repr__(self) -> str:
        return f"<FoundComponent: dimension {self.dimension}, {self.leaf!r}>"


def found_components(
    moving: Mapping[int, Star],
    rows: Rows,
    size: int,
    most: int,
    extends: Callable[[Leaf], bool],
) -> tuple[list[FoundComponent], bool]:
    """Components in the space of these rows, each proved to be one and to differ from the others.

    `rows` is a space that holds all real motions. `Proposals` suggests motions w and the steps to
    them; the steps are taken again exactly, which gives a space on which all forms but some vanish.
    Where these have a common zero near w with independent derivatives on the space, and the
    derivatives of all forms leave no more room in the space of `rows`, w lies on exactly one
    component (docs/panels.md, Regular points). The work is limited to `most` steps, as in `leaves`.
    The second value says whether the search in floating point came to its end, which proves
    nothing.
    """
    forms = Forms(moving)
    whole = in_balls(rows)
    search = Proposals(moving, rows, size)
    found: list[FoundComponent] = []
    work = 0
    for proposal in search:
        work += (len(proposal.steps) + 1) * len(rows) * size
        if work > most:
            return found, False
        leaf = exact_leaf(moving, rows, size, proposal)
        if leaf is None:
            continue
        dimension = leaf.size - len(leaf.vertices)
        w = regular_point(forms, leaf, proposal.densities)
        if w is None or not is_component(forms, whole, size, w, dimension):
            continue
        if any(not outside(w, f.leaf) and not outside(f.motion, leaf) for f in found):
            continue
        folds = (not leaf.vertices and extends(leaf)) or truly_folds(moving, w)
        found.append(FoundComponent(leaf, dimension, w, folds))
    return found, search.complete


def exact_leaf(
    moving: Mapping[int, Star],
    rows: Rows,
    size: int,
    proposal: Proposal,
    most_roots: int = MOST_ROOTS,
) -> Leaf | None:
    """The exact space that the steps of a proposal lead to.

    None if they lead elsewhere, or need more square roots.
    """
    for v, inside in proposal.steps:
        if isinstance(v, tuple):
            rows, size = imposed(rows, size, rows[v]) if v in rows else (rows, size)
            continue
        squares = squares_of(moving[v], rows, size)
        if not squares:
            continue
        if is_semidefinite(squares):
            rows, size = imposed(rows, size, *(functional for _, functional in squares))
        elif len(squares) == 2:
            try:
                both = factors([squares], rows, most_roots)
            except TooManyModesError:
                return None
            near = proposal.densities if inside is None else inside
            at = [near[edge] for edge in parameter_folds(rows, size)]
            rows, size = imposed(rows, size, min(both, key=lambda row: _relative(row, at)))
        else:
            return None
    left = [
        v
        for v in sorted({v for edge in rows for v in edge if v in moving})
        if squares_of(moving[v], rows, size)
    ]
    if size != proposal.size or left != sorted(proposal.vertices):
        return None
    return made_leaf(rows, size, left)


def _relative(functional: Sequence[Entry], at: Sequence[float]) -> float:
    """How large a functional is at a point, for its size."""
    weights = [float(x) for x in functional]
    total = sum(x * y for x, y in zip(weights, at, strict=True))
    return abs(total) / max(map(abs, weights))
