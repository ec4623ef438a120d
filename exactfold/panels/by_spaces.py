"""Parts of a sheet with vertices of more than four folds: their spaces of motions, which fold."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from itertools import product
from typing import Final

from exactfold._support.clock import QUICK, UNLIMITED, Clock
from exactfold._support.plurals import counted
from exactfold.errors import TooManyModesError
from exactfold.panels.folding_modes import folding_mode, folding_modes
from exactfold.panels.isolated import isolated_ways
from exactfold.panels.modes.trees import tree_components
from exactfold.panels.result import Part
from exactfold.panels.spaces.cones import cone_motions, is_one_family
from exactfold.panels.spaces.found import FoundComponent, found_components
from exactfold.panels.spaces.freedom import most_first_order, most_freedom
from exactfold.panels.spaces.kernel import Rows, entry, first_order, number
from exactfold.panels.spaces.regular import (
    Balls,
    Forms,
    in_balls,
    is_component,
    outside,
    point,
    truly_folds,
)
from exactfold.panels.spaces.splitting import Splitting
from exactfold.panels.spaces.subspaces import Leaf, independent_parts, reduced
from exactfold.panels.vertex.holes import close_always
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge, PanelPattern

MOST_STEPS = 6_000_000
MOST_REDUCTION = 3_000_000
MOST_FOUND = 20_000_000
_MANY: Final = 64
"""With more conditions of holes, too many forms are left where splitting ends; it ends early."""


def by_spaces(pattern: PanelPattern, moving: Mapping[int, Star], clock: Clock = UNLIMITED) -> Part:
    """The motions of a part with vertices of any degree: linear spaces, and which of them fold.

    The dimension of the first-order motions is exact. The part is not decomposed if several forms
    remain on a space and are not shown to be one component, if splitting the spaces takes more than
    `MOST_STEPS` steps, or if it takes more than nine tenths of the time of the clock. Then the
    components are counted if the vertices form a tree. Otherwise the result contains the components
    that were found, and the folds that stay flat to second order.
    """
    try:
        rows, size = first_order(moving, clock.share(1 / 2).at_least(QUICK))
    except TooManyModesError as error:
        return _without_space(pattern, moving, str(error), clock)
    isolated = _isolated(moving, rows, size, clock.share(1 / 2))
    if isolated is not None:
        return isolated
    small, left, sums = reduced(moving, rows, size, MOST_REDUCTION, clock)
    if left == 0:
        still = tuple(sorted({edge for star in moving.values() for edge in star.folds}))
        return Part(tuple(moving), "subspaces", {0: 1}, {0: 1}, dimension=size, still=still)
    try:
        return _complete(pattern, moving, (rows, size), (small, left), sums, clock)
    except TooManyModesError as error:
        if (tree := by_tree(moving, size)) is not None:
            return tree
        reason = f"{part_text(moving)}: {error}"
        components, _ = _found(pattern, moving, small, left, clock)
        return _partial(pattern, moving, (rows, size), (small, left), components, reason, clock)


def _isolated(moving: Mapping[int, Star], rows: Rows, size: int, clock: Clock) -> Part | None:
    """A part all of whose ways are isolated; None for other parts, or if that is not proved."""
    try:
        found = isolated_ways(moving, rows, size, clock)
    except TooManyModesError:
        return None
    if found is None:
        return None
    ways, leaves = found
    counts = {1: len(leaves)} if leaves else {0: 1}
    return Part(
        tuple(moving),
        "subspaces",
        counts,
        counts,
        spaces=tuple(leaves),
        spaces_fold=(True,) * len(leaves),
        dimension=size,
        still=_still(moving, (edge for leaf in leaves for edge in leaf.rows)),
        isolated=ways,
    )


def by_tree(moving: Mapping[int, Star], size: int) -> Part | None:
    """A part whose vertices form a tree: its components are counted; None for other parts.

    `size` is the dimension of the first-order motions.
    """
    if _has_holes(moving):
        return None
    try:
        counts = tree_components(moving)
    except TooManyModesError:
        return None
    if counts is None:
        return None
    few = all(len(star.folds) <= 4 for star in moving.values())
    return Part(
        tuple(moving),
        "modes" if few else "subspaces",
        counts,
        counts if few else None,
        dimension=size,
        most=max(counts),
        by_tree=True,
        reason=_open(few, True),
    )


def _complete(
    pattern: PanelPattern,
    moving: Mapping[int, Star],
    first: tuple[Rows, int],
    smaller: tuple[Rows, int],
    sums: bool,
    clock: Clock,
) -> Part:
    """All components; raises `TooManyModesError` if this is too much work or forms remain.

    `first` are the first-order motions. `smaller` are those that remain after the semidefinite
    forms; `sums` says whether one of these was a sum of several squares.
    """
    vertices = tuple(moving)
    (rows, size), (small, left) = first, smaller
    many = sum(star.hole is not None for star in moving.values()) > _MANY
    search = Splitting(moving, MOST_STEPS, clock.share(1 / 8 if many else 9 / 10))
    leaves = search.leaves(small, left)
    together = 0
    counts: dict[int, int] = {}
    spaces: list[Leaf] = []
    zeros: list[Sequence[Balls | None]] = []
    for leaf in leaves:
        clock.check()
        number, motions = checked_components(moving, leaf, leaves)
        together = max(together, number)
        zeros += motions
        spaces += [leaf] * len(motions)
        counts[leaf.dimension] = counts.get(leaf.dimension, 0) + len(motions)
    still = _still(moving, (edge for leaf in spaces for edge in leaf.rows))
    if not counts:
        return Part(vertices, "subspaces", {0: 1}, {0: 1}, dimension=size, still=still)
    ordered = dict(sorted(counts.items()))
    folding = [
        not clock.passed and _extends(pattern, moving, leaf, motions)
        for leaf, motions in zip(spaces, zeros, strict=True)
    ]
    alone = (len(moving) == 1 and not _has_holes(moving)) or all(
        not clock.passed and _is_regular(moving, rows, size, leaf) for leaf in spaces
    )
    if len(spaces) == 1:
        alone = alone or is_one_family(moving, size, spaces[0].size, spaces[0].vertices)
    known = all(folding) and alone
    # These are conditions under which no complex motion has more dimensions than a real one
    # (docs/panels.md, Degrees of freedom).
    real = not sums and not search.sums and together < 2
    most = None if known else max(counts) if real else most_freedom(moving, rows, size)
    components: list[FoundComponent] = []
    if not all(folding):
        components, _ = _found(pattern, moving, small, left, clock)
    return Part(
        vertices,
        "subspaces",
        ordered,
        ordered if known else None,
        spaces=tuple(spaces),
        spaces_fold=tuple(folding),
        dimension=size,
        most=most,
        found=tuple(components),
        still=still,
        reason=_open(known, all(folding)),
    )


def checked_components(
    moving: Mapping[int, Star], leaf: Leaf, leaves: Sequence[Leaf]
) -> tuple[int, list[tuple[Balls | None, ...]]]:
    """The largest number of forms that remain together on an independent part of a leaf.

    The second value has an entry for each component of the leaf: a common zero of the forms on each
    part with several. Where there are several components, each has a point that lies in the space
    of no other leaf, so that it lies in no other component.

    Raises `TooManyModesError` unless the components of the leaf are known.
    """
    together = 0
    motions: list[Sequence[Balls | None]] = []
    parts = independent_parts(_entries(leaf), leaf.size, moving)
    for rows, size in parts:
        cones = [v for v in leaf.vertices if set(moving[v].folds) & set(rows)]
        together = max(together, len(cones))
        motions.append(cone_motions(moving, rows, size, cones) if len(cones) > 1 else [None])
        if not motions[-1]:
            raise TooManyModesError(
                f"on a space of dimension {size} the second-order conditions of "
                f"{_named(moving, cones)} remain, and exactfold could not solve them together"
            )
    components = list(product(*motions))
    for each in components if len(components) > 1 else ():
        w: Balls = {}
        for (rows, size), zero in zip(parts, each, strict=True):
            cones = [v for v in leaf.vertices if set(moving[v].folds) & set(rows)]
            if zero is None:
                zero = next(iter(cone_motions(moving, rows, size, cones)), {})
                zero = zero if cones else point(rows, size)
            w = {**w, **zero}
        if not all(other is leaf or outside(w, other) for other in leaves):
            raise TooManyModesError(
                f"on a space of dimension {leaf.size} a component may lie in another space"
            )
    return together, components


def _open(known: bool, fold: bool) -> str:
    """What is undecided about a part whose motions to second order are known."""
    if known:
        return ""
    if fold:
        return "it is proved only to second order that there are no other true motions"
    return "it is undecided whether the motions of vertices with more than four folds truly fold"


def _found(
    pattern: PanelPattern, moving: Mapping[int, Star], rows: Rows, size: int, clock: Clock
) -> tuple[list[FoundComponent], bool]:
    return found_components(
        moving, rows, size, MOST_FOUND, lambda leaf: _extends(pattern, moving, leaf), clock
    )


def _partial(
    pattern: PanelPattern,
    moving: Mapping[int, Star],
    first: tuple[Rows, int],
    smaller: tuple[Rows, int],
    components: list[FoundComponent],
    reason: str,
    clock: Clock,
) -> Part:
    """What is proved of a part that is not decomposed: components, or modes if none of
    them folds.
    """
    folds = any(one.folds for one in components)
    modes = []
    if not folds and not _has_holes(moving):
        modes = folding_modes(pattern, moving, *smaller, MOST_FOUND, clock)
    return Part(
        tuple(moving),
        "subspaces",
        None,
        None,
        dimension=first[1],
        most=most_freedom(moving, *first),
        found=tuple(components),
        modes=tuple(modes),
        still=_still(moving, smaller[0]),
        reason=reason,
    )


def _without_space(
    pattern: PanelPattern, moving: Mapping[int, Star], reason: str, clock: Clock
) -> Part:
    """What is proved of a part whose first-order motions take too long to compute."""
    return Part(
        tuple(moving),
        "subspaces",
        None,
        None,
        most=most_first_order(moving),
        modes=() if _has_holes(moving) else tuple(folding_modes(pattern, moving, {}, 0, 0, clock)),
        reason=f"the first-order motions of {part_text(moving)} are not known: {reason}",
    )


def _has_holes(moving: Mapping[int, Star]) -> bool:
    return any(star.hole is not None for star in moving.values())


def part_text(moving: Mapping[int, Star]) -> str:
    """A part of a sheet in words: the number of its vertices and of its holes."""
    inner = [v for v, star in moving.items() if star.hole is None]
    holes = {star.hole.number for star in moving.values() if star.hole is not None}
    counts = [counted(len(inner), "vertex")] if inner else []
    counts += [counted(len(holes), "hole")] if holes else []
    first = f"vertex {inner[0]}" if inner else f"hole {min(holes)}"
    return f"the part of {' and '.join(counts)} with {first}"


def _named(moving: Mapping[int, Star], some: Sequence[int]) -> str:
    """Vertices and holes in words."""
    inner = [str(v) for v in some if moving[v].hole is None]
    holes = sorted({hole.number for v in some if (hole := moving[v].hole) is not None})
    texts = [f"vertices {', '.join(inner)}"] if inner else []
    texts += [f"holes {', '.join(map(str, holes))}"] if holes else []
    return " and ".join(texts)


def _still(moving: Mapping[int, Star], active: Iterable[Edge]) -> tuple[Edge, ...]:
    """The folds that are flat in all motions to second order."""
    return tuple(sorted({e for star in moving.values() for e in star.folds} - set(active)))


def _extends(
    pattern: PanelPattern,
    moving: Mapping[int, Star],
    leaf: Leaf,
    zeros: Sequence[Balls | None] = (),
) -> bool:
    """Whether a space of motions is proved to be tangent to true motions.

    The space is split into independent parts. By Morse's lemma, a single vertex has true motions
    near the flat state that correspond to its motions to second order. Other parts extend if all
    their conditions are independent at one of their points (`truly_folds`); for cones this is a
    point at which their forms vanish. A part that is a mode extends if the mode does. Other folds
    are held flat, so this can prove that a space extends but never that it does not: a true motion
    might use those folds at a higher order. `zeros` are those of `checked_components`, where they
    are known.
    """
    parts = independent_parts(_entries(leaf), leaf.size, moving)
    for (rows, size), zero in zip(parts, zeros or [None] * len(parts), strict=True):
        active = [star.vertex for star in moving.values() if set(star.folds) & set(rows)]
        holes = any(moving[v].hole is not None for v in active)
        if len(active) == 1 and size == len(rows) - 2 and not holes:
            continue
        cones = [v for v in active if v in leaf.vertices]
        w = zero
        if w is None:
            w = next(iter(cone_motions(moving, rows, size, cones)), None)
            w = w if cones else point(rows, size)
        if w is not None and truly_folds(moving, w):
            continue
        if cones:
            return False
        if holes and size == 1:
            if close_always(moving, {edge: number(row[0]) for edge, row in rows.items()}):
                continue
            return False
        if holes or size != 1 or folding_mode(pattern, moving, rows) is None:
            return False
    return True


def _is_regular(moving: Mapping[int, Star], rows: Rows, size: int, leaf: Leaf) -> bool:
    """Whether a leaf is a line at which the conditions have full rank.

    Let w be on the line. Balls show that the derivatives dK_v(w) of all vertices vanish, within the
    space of first-order motions, only on that line. Then at most one curve of true motions is
    tangent to it (docs/panels.md, Vertices with more folds).
    """
    if leaf.size != 1 or leaf.vertices:
        return False
    return is_component(Forms(moving), in_balls(rows), size, point(leaf.rows, 1), 1)


def _entries(leaf: Leaf) -> Rows:
    return {edge: [entry(x) for x in row] for edge, row in leaf.rows.items()}
