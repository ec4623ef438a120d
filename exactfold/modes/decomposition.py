"""All motions of a sheet of rigid panels: the complete decomposition, and what truly folds."""

from __future__ import annotations

import time
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import Any

import networkx as nx

from exactfold.errors import TooManyModesError
from exactfold.exact.surds import Number, exact, rank_at_least
from exactfold.modes.components import components
from exactfold.modes.densities import UndecidedDensityError
from exactfold.modes.elementary import ElementaryMode, ModeSearch, Support
from exactfold.modes.extension import Extension, Loops, extend_together, extension
from exactfold.modes.kernel import Rows, first_order
from exactfold.modes.local import LocalMode
from exactfold.modes.stars import Star, stars
from exactfold.modes.subspaces import Leaf, independent_parts, leaves
from exactfold.pattern.described import described_panels
from exactfold.pattern.panel_pattern import Edge, PanelPattern
from exactfold.progress import Progress
from exactfold.schemas import headed
from exactfold.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.wording import counted

MOST_SUPPORTS = 20_000
MOST_LISTED = 1_000
MOST_DIMENSION = 16
MOST_STEPS = 150_000
MOST_LISTED_VERTICES = 60_000

Counts = Mapping[int, int]
"""{dimension: number of components}."""


@dataclass(frozen=True)
class Mode:
    """One elementary mode: a one-parameter motion, and whether it truly folds.

    `assignment` holds M or V for each active fold, on one side of the sheet; on the other all
    letters are exchanged. `choice` are the local modes it is made of.
    """

    active: tuple[int, ...]
    assignment: Mapping[Edge, str]
    extends: Extension
    choice: tuple[LocalMode, ...] = field(default=(), repr=False)

    def to_dict(self) -> dict[str, Any]:
        """The mode as it stands in JSON."""
        return {
            "active": list(self.active),
            "assignment": {f"{i}-{j}": letter for (i, j), letter in self.assignment.items()},
            "extends": str(self.extends.verdict),
            "by": self.extends.by,
        }


@dataclass(frozen=True)
class Decomposition:
    """The ways in which a sheet of rigid panels starts to fold, and which of them truly fold.

    `true` is {dimension: number} of the components of the true configurations near the flat state,
    None if it is not known. `second_order` is the same for all motions to second order, of which
    some may not fold; `status` is PROVED if it is known. `rigid` says whether the sheet cannot move
    at all. `flat` are folds that stay flat in every real motion, `free` those with both ends on the
    border; `held` are those that were not to fold. `theory` is "modes" if all vertices have at most
    four folds, else "subspaces".
    """

    pattern: PanelPattern
    theory: str
    status: Verdict
    rigid: Verdict
    second_order: Counts | None
    true: Counts | None
    flat: tuple[Edge, ...]
    free: tuple[Edge, ...]
    modes: tuple[Mode, ...] = ()
    modes_count: int | None = None
    reason: str = ""
    parts: tuple[Part, ...] = ()
    near_misses: Mapping[Edge, float] = field(default_factory=dict)
    held: tuple[Edge, ...] = ()
    read: Mapping[str, Any] | None = None
    seconds: float = field(default=0.0, compare=False)

    def to_dict(self, certificate: str | None = None, name: str | None = None) -> dict[str, Any]:
        """The object printed by `exactfold count --json`: `schema("count")`.

        What belongs to branches of triangulated sheets is null.
        """
        counts = (self.second_order, self.true)
        rigid = {PROVED: True, REFUTED: False}.get(self.rigid)
        return {
            **headed("count"),
            "pattern": described_panels(self.pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "by": "enumeration" if self.status is PROVED else None,
            "method": self.theory,
            "why": "",
            **dict.fromkeys(("distinct", "with_multiplicity", "real", "nonreal")),
            "true_branches": str(UNDECIDED if self.true is None else PROVED),
            **dict.fromkeys(("dimension", "degree")),
            "certificate": certificate,
            "warnings": [],
            "seconds": round(self.seconds, 3),
            "open_questions": [part.reason for part in self.parts if part.reason],
            "settings": {},
            "branches": [],
            "theory": self.theory,
            "rigid": rigid,
            "components": {
                key: None if value is None else {str(k): n for k, n in value.items()}
                for key, value in zip(("second_order", "true"), counts, strict=True)
            },
            "modes_count": self.modes_count,
            "modes": [mode.to_dict() for mode in self.modes],
            "flat_folds": [f"{i}-{j}" for i, j in self.flat],
            "free_folds": [f"{i}-{j}" for i, j in self.free],
            "near_misses": [
                {"fold": f"{i}-{j}", "quotient": x} for (i, j), x in self.near_misses.items()
            ],
            "read": None if self.read is None else dict(self.read),
        }

    @property
    def ways(self) -> int | None:
        """The number of components that truly fold, 0 for a rigid sheet; None if not known."""
        if self.true is None:
            return None
        return sum(number for dimension, number in self.true.items() if dimension)

    @property
    def warning(self) -> str | None:
        """What to know of the drawing before the result is read: a loop that nearly closes."""
        if not self.near_misses:
            return None
        (i, j), quotient = next(iter(self.near_misses.items()))
        return (
            f"a loop of folds nearly closes at {i}-{j}, off by {abs(quotient - 1):.1e}: the "
            "drawing may be rounded (try --snap auto)"
        )

    def __repr__(self) -> str:
        counts = "" if self.second_order is None else f", {dict(self.second_order)}"
        return f"<Decomposition: {self.status}{counts}, {self.pattern!r}>"


@dataclass(frozen=True)
class Part:
    """A part of the sheet that moves independently: vertices joined by folds that may fold.

    `spaces` are the leaves where vertices have more than four folds, `folds` says whether some of
    them are known to fold; `dimension` is the number of first-order motions, None where it was not
    needed.
    """

    vertices: tuple[int, ...]
    theory: str
    second_order: Counts | None
    true: Counts | None
    supports: tuple[Support, ...] = ()
    spaces: tuple[Leaf, ...] = ()
    modes: tuple[Mode, ...] = ()
    dimension: int | None = None
    near_misses: Mapping[Edge, float] = field(default_factory=dict)
    folds: bool = False
    reason: str = ""


def decompose(
    pattern: PanelPattern,
    *,
    flat: Iterable[Edge] = (),
    listed: int = MOST_LISTED,
    progress: Progress | None = None,
) -> Decomposition:
    """Every component of the motions of a sheet of rigid panels, to second order and truly.

    First the folds that cannot fold in any real motion are found (`stars`), at any size. What is
    left falls into independent parts. Where all vertices have at most four folds the structure
    theorem gives all components (docs/panels.md, 2); elsewhere linear spaces are split vertex by
    vertex (`leaves`), if the first-order motions have dimension 16 or less. A motion of true
    configurations has its lowest order in the second-order motions, so a sheet without these is
    rigid. `flat` holds folds flat that are in the drawing but are not to fold; up to `listed` modes
    are listed one by one.

    UNDECIDED means that a part is too large or needs too many square roots; `reason` says which.

    >>> from exactfold.pattern.panel_pattern import PanelPattern
    >>> cross = PanelPattern([(-1, -1), (1, -1), (1, 1), (-1, 1), (0, 0), (0, -1), (1, 0),
    ...                       (0, 1), (-1, 0)],
    ...                      [(0, 5), (5, 1), (1, 6), (6, 2), (2, 7), (7, 3), (3, 8), (8, 0),
    ...                       (4, 5), (4, 6), (4, 7), (4, 8)])
    >>> result = decompose(cross)
    >>> dict(result.second_order), dict(result.true)
    ({1: 2}, {1: 2})
    """
    start = time.perf_counter()
    held = frozenset(flat)
    moving = stars(pattern, held)
    interior = set(pattern.interior)
    free = tuple(e for e in pattern.folds if not interior.intersection(e) and e not in held)
    active = {edge for star in moving.values() for edge in star.folds}
    rest = tuple(e for e in pattern.folds if e not in active and e not in free)
    groups = groups_of(moving)
    found: list[Part] = []
    for number, group in enumerate(groups):
        if progress is not None:
            progress("decomposing", number, len(groups))
        found.append(_part(pattern, {v: moving[v] for v in group}, listed))
    result = Decomposition(
        pattern,
        "subspaces" if any(part.theory == "subspaces" for part in found) else "modes",
        PROVED,
        UNDECIDED,
        _product((part.second_order for part in found), len(free)),
        _product((part.true for part in found), len(free)),
        rest,
        free,
        modes=tuple(mode for part in found for mode in part.modes),
        modes_count=_modes_count(found),
        parts=tuple(found),
        near_misses={edge: x for part in found for edge, x in part.near_misses.items()},
        held=tuple(sorted(held)),
        seconds=time.perf_counter() - start,
    )
    if result.second_order is None:
        reasons = [part.reason for part in found if part.second_order is None]
        result = replace(result, status=UNDECIDED, reason="; ".join(dict.fromkeys(reasons)))
    return replace(result, rigid=_rigidity(result))


def _rigidity(result: Decomposition) -> Verdict:
    """Rigid if nothing moves to second order; not rigid if something truly folds."""
    if result.second_order is not None and set(result.second_order) == {0}:
        return PROVED
    if result.free or any(mode.extends.verdict is PROVED for mode in result.modes):
        return REFUTED
    if any(part.folds or set(part.true or {0: 1}) - {0} for part in result.parts):
        return REFUTED
    known = all(part.true is not None and set(part.true) == {0} for part in result.parts)
    return PROVED if known else UNDECIDED


def _modes_count(found: Iterable[Part]) -> int | None:
    total = 0
    for part in found:
        if part.theory != "modes" or part.second_order is None:
            return None
        total += sum(support.count for support in part.supports)
    return total


def groups_of(moving: Mapping[int, Star]) -> list[tuple[int, ...]]:
    """Vertices joined by folds that may fold, smallest first."""
    graph = nx.Graph()
    graph.add_nodes_from(moving)
    for v, star in moving.items():
        graph.add_edges_from((v, u) for edge in star.folds for u in edge if u != v and u in moving)
    return sorted(tuple(sorted(group)) for group in nx.connected_components(graph))


def _part(pattern: PanelPattern, moving: Mapping[int, Star], listed: int) -> Part:
    vertices = tuple(moving)
    few = all(len(star.folds) <= 4 for star in moving.values())
    try:
        if few:
            return _by_modes(pattern, moving, listed)
        return _by_spaces(pattern, moving)
    except (TooManyModesError, UndecidedDensityError) as error:
        where = f"the part of {counted(len(vertices), 'vertex')} with vertex {vertices[0]}"
        theory = "modes" if few else "subspaces"
        return Part(vertices, theory, None, None, reason=f"{where}: {error}")


def _by_modes(pattern: PanelPattern, moving: Mapping[int, Star], listed: int) -> Part:
    """The structure theorem: elementary modes, and which of them extend."""
    search = ModeSearch(moving, pattern.field)
    supports = search.supports(MOST_SUPPORTS)
    modes: list[Mode] = []
    extending: list[Support] = []
    decided = True
    loops: Loops = {}
    for support in supports:
        verdict = extend_together(moving, search.modes, support.vertices)
        room = listed - len(modes)
        each: list[ElementaryMode] = []
        most = min(MOST_LISTED, MOST_LISTED_VERTICES // len(support.vertices))
        if support.count <= (min(room, most) if verdict is not None else most):
            each = search.listed(support)
        results = [verdict or extension(pattern, moving, mode.choice, loops) for mode in each]
        if verdict is not None:
            extending.append(support)
        elif each:
            good = sum(result.verdict is PROVED for result in results)
            decided = decided and all(result.verdict is not UNDECIDED for result in results)
            if good:
                extending.append(replace(support, count=good))
        else:
            decided = False
        if each and support.count <= room:
            pairs = zip(each, results, strict=True)
            modes += [_mode(support, mode, result) for mode, result in pairs]
    return Part(
        tuple(moving),
        "modes",
        components(supports, 0),
        components(extending, 0) if decided else None,
        supports=tuple(supports),
        modes=tuple(modes),
        near_misses=search.near_misses,
        reason="" if decided else "for some modes it is not known whether they truly fold",
    )


def _mode(support: Support, mode: ElementaryMode, result: Extension) -> Mode:
    letters = {edge: "V" if s > 0 else "M" for edge, s in mode.signs.items()}
    return Mode(support.vertices, letters, result, mode.choice)


def _by_spaces(pattern: PanelPattern, moving: Mapping[int, Star]) -> Part:
    """Linear spaces, split where a form is a product."""
    vertices = tuple(moving)
    folds = len({edge for star in moving.values() for edge in star.folds})
    least = folds - 2 * len(vertices)  # each vertex has two conditions
    if least > MOST_DIMENSION:
        return _too_many(vertices, None, f"{least} or more")
    rows, size = first_order(moving)
    if size == 0:
        return Part(vertices, "subspaces", {0: 1}, {0: 1}, dimension=0)
    if size > MOST_DIMENSION:
        return _too_many(vertices, size, str(size))
    spaces = leaves(moving, rows, size, MOST_STEPS)
    counts: dict[int, int] = {}
    for leaf in spaces:
        if leaf.dimension is None:
            raise TooManyModesError(
                f"in a space of dimension {leaf.size} the conditions of vertices "
                f"{', '.join(map(str, leaf.vertices))} are left, and are not solved yet"
            )
        counts[leaf.dimension] = counts.get(leaf.dimension, 0) + 1
    if not counts:
        return Part(vertices, "subspaces", {0: 1}, {0: 1}, dimension=size)
    ordered = dict(sorted(counts.items()))
    folding = [_extends(pattern, moving, leaf) for leaf in spaces]
    alone = len(moving) == 1 or all(_is_regular(moving, rows, size, leaf) for leaf in spaces)
    known = all(folding) and alone
    return Part(
        vertices,
        "subspaces",
        ordered,
        ordered if known else None,
        spaces=tuple(spaces),
        dimension=size,
        folds=any(folding),
        reason=""
        if known
        else "whether motions of vertices with more than four folds truly fold is not decided",
    )


def _too_many(vertices: tuple[int, ...], size: int | None, said: str) -> Part:
    reason = (
        f"the first-order motions of {counted(len(vertices), 'vertex')} round vertex "
        f"{vertices[0]} have dimension {said}; they are decomposed up to {MOST_DIMENSION}"
    )
    return Part(vertices, "subspaces", None, None, dimension=size, reason=reason)


def _extends(pattern: PanelPattern, moving: Mapping[int, Star], leaf: Leaf) -> bool:
    """Whether a space of motions is tangent to true ones: modes that fold apart from each other.

    One vertex alone has true motions near the flat state as its motions to second order, by Morse's
    lemma. Other folds are held flat, so this can prove that a space extends and never that it does
    not: a motion might use them at a higher order.
    """
    for rows, size in independent_parts(dict(leaf.rows), leaf.size, moving):
        active = [star.vertex for star in moving.values() if set(star.folds) & set(rows)]
        if len(active) == 1 and size == len(rows) - 2:
            continue
        if set(active) & set(leaf.vertices):
            return False
        modes = [_local(star, rows) for star in moving.values() if set(star.folds) & set(rows)]
        if size != 1 or any(len(mode.folds) > 4 for mode in modes):
            return False
        stars = {mode.vertex: moving[mode.vertex].only(mode.folds) for mode in modes}
        if extension(pattern, stars, modes).verdict is not PROVED:
            return False
    return True


def _is_regular(moving: Mapping[int, Star], rows: Rows, size: int, leaf: Leaf) -> bool:
    """Whether a leaf is a line at which the conditions have full rank.

    At w on the line the derivatives `dK_v(w)` of all vertices leave in the space of first-order
    motions that line alone, shown by balls; then one curve of true motions at most is tangent to it
    (docs/panels.md, 5).
    """
    if leaf.size != 1 or leaf.vertices:
        return False
    found: list[list[Number]] = []
    for star in moving.values():
        w = [leaf.rows[edge][0] if edge in leaf.rows else Fraction(0) for edge in star.folds]
        weights = star.derivative(w)
        row: list[Number] = [Fraction(0)] * size
        for weight, edge in zip(weights, star.folds, strict=True):
            if weight != 0 and edge in rows:
                row = [x + weight * y for x, y in zip(row, rows[edge], strict=True)]
        found.append(row)
    return rank_at_least(found) >= size - 1


def _local(star: Star, rows: Rows) -> LocalMode:
    """The motion of one vertex on a space with one parameter."""
    folds = tuple(edge for edge in star.folds if edge in rows)
    scale = exact(rows[folds[0]][0])
    return LocalMode(star.vertex, 0, folds, tuple(rows[edge][0] / scale for edge in folds))


def _product(counts: Iterable[Counts | None], free: int) -> Counts | None:
    """The components of independent parts: dimensions add, numbers multiply."""
    total: dict[int, int] = {free: 1}
    for part in counts:
        if part is None:
            return None
        product: dict[int, int] = {}
        for a, m in total.items():
            for b, n in part.items():
                product[a + b] = product.get(a + b, 0) + m * n
        total = product
    return dict(sorted(total.items()))
