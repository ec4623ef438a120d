"""Components of the motions of a large part, found and proved one by one; there may be others."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.errors import TooManyModesError
from exactfold.panels.spaces.kernel import Entry, Rows, imposed
from exactfold.panels.spaces.proposals import Proposal, Proposals, is_too_large
from exactfold.panels.spaces.quadratics import (
    MOST_ROOTS,
    factors,
    is_semidefinite,
    squares_of,
)
from exactfold.panels.spaces.regular import (
    Balls,
    Forms,
    in_balls,
    is_component,
    outside,
    parameter_folds,
    regular_point,
    truly_folds,
)
from exactfold.panels.spaces.subspaces import Leaf, made_leaf
from exactfold.panels.vertex.stars import Star, incidence


@dataclass(frozen=True)
class FoundComponent:
    """A component that was found: its dimension, a regular motion of it, and a leaf that holds it.

    `folds` says whether the component is known to fold truly.
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
    clock: Clock = UNLIMITED,
) -> tuple[list[FoundComponent], bool]:
    """Components in a space; each is proved to be one, and to differ from the others.

    `rows` is a space that contains all real motions. `Proposals` suggests motions w and the steps
    that led to them. The steps are repeated exactly; they give a space on which all but some forms
    vanish. Suppose that these forms have a common zero near w with independent derivatives on the
    space, and that the derivatives of all forms leave no larger dimension in the space of `rows`.
    Then w lies on exactly one component (docs/panels.md, Regular points). The work is limited to
    `most` steps, as in `leaves`, and by the clock.

    The second value says whether the floating-point search reached its end, which proves nothing.
    """
    if clock.passed or is_too_large(rows, size):
        return [], False
    forms = Forms(moving)
    whole = in_balls(rows)
    search = Proposals(moving, rows, size, clock=clock)
    components: list[FoundComponent] = []
    work = 0
    for proposal in search:
        work += (len(proposal.steps) + 1) * len(rows) * size
        if work > most or clock.passed:
            return components, False
        leaf = exact_leaf(moving, rows, size, proposal)
        if leaf is None:
            continue
        dimension = leaf.size - len(leaf.vertices)
        w = regular_point(forms, leaf, proposal.densities)
        if w is None or not is_component(forms, whole, size, w, dimension):
            continue
        if any(not outside(w, f.leaf) and not outside(f.motion, leaf) for f in components):
            continue
        folds = (not leaf.vertices and extends(leaf)) or truly_folds(moving, w)
        components.append(FoundComponent(leaf, dimension, w, folds))
    return components, search.complete


def exact_leaf(
    moving: Mapping[int, Star],
    rows: Rows,
    size: int,
    proposal: Proposal,
    most_roots: int = MOST_ROOTS,
) -> Leaf | None:
    """The exact space to which the steps of a proposal lead.

    None if they lead to a different space, or if they need more square roots than allowed.
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
    stars_at = incidence(moving)
    left = [
        v
        for v in sorted({v for edge in rows for v in stars_at[edge]})
        if squares_of(moving[v], rows, size)
    ]
    if size != proposal.size or left != sorted(proposal.vertices):
        return None
    return made_leaf(rows, size, left)


def _relative(functional: Sequence[Entry], at: Sequence[float]) -> float:
    """The size of a functional at a point, relative to the size of the functional."""
    weights = [float(x) for x in functional]
    total = sum(x * y for x, y in zip(weights, at, strict=True))
    return abs(total) / max(map(abs, weights))
