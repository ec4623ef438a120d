"""`tolerance_of_branches` and `tolerance_of_panels`: how far vertices may move, with proof."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from math import inf, isfinite

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import Clock
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.counting.find import find_branch
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.branches.values.result import BranchCount
from exactfold.design.tolerance.closing import Closing
from exactfold.design.tolerance.distinct import all_distinct
from exactfold.design.tolerance.nearest import Candidate, candidates
from exactfold.design.tolerance.parts import (
    PanelParts,
    TrackedPart,
    branch_part,
    panel_parts,
)
from exactfold.design.tolerance.radius import Radii, proved_radii
from exactfold.design.tolerance.result import Changed, Tolerance
from exactfold.design.tolerance.sampling import (
    SAMPLES,
    SHARE,
    Estimate,
    first_changes,
    pinching,
    random_moves,
)
from exactfold.design.tolerance.shape import Shape, shape_of
from exactfold.errors import (
    ExactfoldError,
    NotCountedError,
    PatternError,
    TooManyModesError,
    UndecidedBranchError,
)
from exactfold.exact.surds import Number, rational
from exactfold.motion.panels.listing import (
    MOST_WAYS,
    PanelWay,
    is_too_many,
    panel_ways,
    require_listed,
)
from exactfold.panels.decomposition import decompose
from exactfold.panels.result import Decomposition
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.panel_pattern import Edge, EnclosedPattern, PanelPattern

MOST_FOLDABLE = 12
"""The most foldable vertices if all branches are asked for."""
_TRIED = 6
_SECONDS = 20.0
_DOWN = 1.0 - 2.0**-40

Confirm = Callable[[Candidate], str]
"""What is proved to be different on the sheet of a candidate; empty if nothing is."""


def tolerance_of_branches(
    count: BranchCount | None,
    chosen: Branch | None = None,
    *,
    seed: int = 0,
    progress: Progress | None = None,
) -> Tolerance:
    """How far the vertices of a triangulated sheet with four corners may move.

    All sheets whose vertices move by less than the radius have as many branches with the same
    letters (docs/tolerance.md, 1), or, if one is `chosen`, this branch with its letters; then
    `count` may be None. Gradients of the faces are followed by Krawczyk's test with the vertices
    as parameters. `seed` is that of the random moves.

    Raises `UndecidedBranchError` if a branch is not proved, `NotCountedError` for more than 12
    foldable vertices without a chosen branch and for a sheet without branches.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> tolerance_of_branches(count_branches("two-vertex"))
    <Tolerance: proved, 0.0091 of at most 0.0339>
    """
    start = time.perf_counter()
    branches = [chosen] if chosen is not None else _all_branches(count)
    pattern = branches[0].pattern
    open_ = [branch for branch in branches if branch.undecided_folds]
    if open_:
        i, j = open_[0].undecided_folds[0]
        raise UndecidedBranchError(
            f"on branch {open_[0].sign_text} the letter of fold {i}-{j} is undecided: there is no "
            "answer whose tolerance could be asked for"
        )
    frame = _Frame.of(pattern, [*pattern.triangles, pattern.boundary])
    way = "" if chosen is None else f"branch {chosen.sign_text}"
    lost = _flat(branches)
    if lost:
        generic = 0 not in pattern.boundary_turns
        reason = (
            f"{lost}, which sheets as near as one likes do not have (docs/theorem.md, Theorem 6)"
            if generic
            else f"{lost}; the boundary has a straight corner, so that it is not known whether "
            "other sheets nearby share this"
        )
        status = PROVED if generic else UNDECIDED
        return replace(
            frame.nothing(status, reason, way, len(branches), lost),
            seconds=time.perf_counter() - start,
        )
    if not pattern.foldable_vertices:
        found = frame.of_shape("the sheet folds along a side of two triangles only", way, 1)
        return replace(found, seconds=time.perf_counter() - start)
    part = branch_part(branches)
    search = _Search(frame, [part], way, seed, progress)

    def confirm(candidate: Candidate) -> str:
        branch = branches[candidate.zero]
        try:
            moved = CreasePattern(_rational(frame.moved(candidate)), pattern.triangles)
            if moved.is_convex and pattern.is_convex:
                return _other_letters(branch, find_branch(moved, branch.sign_text))
            other = count_branches(moved)
        except (PatternError, UndecidedBranchError):
            return ""
        if other.status is not PROVED or any(b.undecided_folds for b in other.branches):
            return ""
        return _missing(branch, [b.assignment for b in other.branches], way)

    found = search.found(len(branches), confirm, chosen is None)
    return replace(found, seconds=time.perf_counter() - start)


def check_size(pattern: CreasePattern) -> None:
    """Raise `NotCountedError` if too many vertices can pop to ask for all branches."""
    foldable = len(pattern.foldable_vertices)
    if foldable > MOST_FOLDABLE:
        raise NotCountedError(
            f"{foldable} vertices can pop, and there are 2^{foldable} branches: name one way, or "
            f"take a sheet in which at most {MOST_FOLDABLE} can pop"
        )


def proved_radius(branches: Sequence[Branch], *, everything: bool) -> float:
    """The radius of `tolerance_of_branches` alone, for branches without flat folds.

    `everything` says that these are all branches, which have to stay distinct.
    """
    pattern = branches[0].pattern
    frame = _Frame.of(pattern, [*pattern.triangles, pattern.boundary])
    search = _Search(frame, [branch_part(branches)], "", 0, None)
    return 0.0 if everything and search.not_distinct() else search.radius()


def _all_branches(count: BranchCount | None) -> list[Branch]:
    if count is None or count.pattern.Ve != 4 or not count.branches:
        reason = "" if count is None else f": {count.reason}"
        raise NotCountedError(
            f"no list of branches is known whose tolerance could be given{reason}"
        )
    check_size(count.pattern)
    if count.status is not PROVED:
        raise UndecidedBranchError(f"not all branches are proved: {count.reason}")
    return list(count.branches)


def _flat(branches: Sequence[Branch]) -> str:
    """The star or the fold that is flat on some branch although its sheet need not have it."""
    for branch in branches:
        rigid = branch.pattern.rigid_vertices
        for v, one in sorted(branch.vertex_signs.items()):
            if one == 0 and v not in rigid:
                return f"on branch {branch.sign_text} the star of vertex {v} is flat"
        for (i, j), letter in sorted(branch.assignment.items()):
            if letter == "F" and not rigid.intersection((i, j)):
                return f"on branch {branch.sign_text} fold {i}-{j} is flat"
    return ""


def _other_letters(branch: Branch, other: Branch) -> str:
    if other.status is not PROVED or other.sign_text != branch.sign_text:
        return ""
    for (i, j), letter in sorted(branch.assignment.items()):
        now = other.assignment[i, j]
        if {letter, now} == {"M", "V"}:
            return f"on branch {branch.sign_text} fold {i}-{j} has the letter {now}, not {letter}"
    return ""


def _canonical(letters: Mapping[Edge, str]) -> str:
    text = "".join(letters[fold] for fold in sorted(letters))
    return min(text, text.translate(UPSIDE_DOWN))


def _missing(branch: Branch, others: Sequence[Mapping[Edge, str]], way: str) -> str:
    """What is missing on another sheet: the letters of a branch."""
    own = _canonical(branch.assignment)
    if own not in {_canonical(letters) for letters in others}:
        return f"no way has the letters of branch {branch.sign_text}"
    return ""


def tolerance_of_panels(
    result: Decomposition,
    way: int | None = None,
    *,
    seed: int = 0,
    progress: Progress | None = None,
) -> Tolerance:
    """How far the vertices of a sheet of rigid panels may move before its ways change.

    All sheets whose vertices move by less than the radius have as many ways with the same letters,
    or the way with the number `way`. This is so only of isolated ways without loops that must
    close: the radius of other ways is 0, and `closings` has the relations that they need, with the
    compliance of each (docs/tolerance.md, 3).

    Raises `UsageError` for a number that no way has, `NotFollowedError` for a way that is not
    proved to fold, `UndecidedBranchError` if not all ways are known, `NotCountedError` for
    families, for a sheet without ways and for one whose vertices are known only nearly.

    >>> from exactfold.branches.counting.ways import count_ways
    >>> found = tolerance_of_panels(count_ways("square-twist"), 1)
    >>> found, found.limit
    (<Tolerance of way 1: proved, 0 of at most 0>, 'the folds round the loop 4-5-6-7 agree')
    """
    start = time.perf_counter()
    known = result.known
    pattern = known.pattern
    if isinstance(pattern, EnclosedPattern):
        raise NotCountedError(
            "the vertices of this sheet are only known within a radius: give a drawing with exact "
            "coordinates"
        )
    if is_too_many(known):
        raise NotCountedError(
            f"the sheet has more than {MOST_WAYS} ways: hold some creases flat, or take a smaller "
            "sheet"
        )
    ways = panel_ways(known)
    chosen = None
    if way is not None:
        require_listed(ways, way)
        chosen = ways[way - 1]
        chosen.require_folding()
    folding = [one for one in ways if one.verdict is PROVED]
    if not folding:
        raise NotCountedError("no way is proved to fold whose tolerance could be given")
    if chosen is None and known.second_order is None:
        raise UndecidedBranchError(f"not all ways are known: {known.reason}")
    if chosen is not None and any(s.dimension > 1 for s in chosen.spaces):
        raise NotCountedError(
            f"way {chosen.number} is a family in a space of motions, in which letters change with "
            "the motion: a tolerance is known for isolated ways"
        )
    parts = panel_parts(known, folding, chosen)
    frame = _Frame.of(pattern, [*pattern.faces, _border(pattern)])
    name = "" if chosen is None else f"way {chosen.number}"
    number = 1 if chosen is not None else len(folding)
    found = _of_parts(known, frame, parts, name, number, chosen, seed, progress)
    return replace(found, seconds=time.perf_counter() - start)


def _of_parts(
    known: Decomposition,
    frame: _Frame,
    parts: PanelParts,
    name: str,
    number: int,
    chosen: PanelWay | None,
    seed: int,
    progress: Progress | None,
) -> Tolerance:
    if parts.closings:
        order = sorted(_distinct(parts.closings), key=lambda one: -one[1].total)
        first = next((one for one in order if one[1].is_needed), None)
        if first is None:
            return frame.nothing(
                UNDECIDED,
                "the loops of the way close by relations whose first derivatives may all be 0",
                name,
                number,
                "",
                tuple(order),
            )
        which = name or f"way {first[0]}"
        return frame.nothing(
            PROVED,
            f"{which} folds only while {first[1].text}, and sheets as near as one likes break this",
            name,
            number,
            first[1].text,
            tuple(order),
        )
    if parts.unknown:
        return frame.nothing(UNDECIDED, parts.unknown, name, number, "")
    guarded = replace(
        frame, guard=parts.guard, guards=tuple(parts.guards[v] for v in sorted(parts.guards))
    )
    if not parts.tracked:
        return guarded.of_shape("only folds from boundary to boundary bend", name, number)
    pattern = known.pattern

    def letters(result: Decomposition) -> Counter[str] | None:
        if result.second_order is None:
            return None
        return Counter(
            _canonical({fold: one.letters.get(fold, "F") for fold in result.pattern.folds})
            for one in panel_ways(result)
            if one.verdict is PROVED
        )

    here = letters(known)

    def confirm(candidate: Candidate) -> str:
        try:
            moved = PanelPattern(guarded.moved(candidate), pattern.edges)
            other = letters(decompose(moved, flat=known.held, clock=Clock(_SECONDS)))
        except (ExactfoldError, TooManyModesError):
            return ""
        if other is None or here is None or moved.faces != pattern.faces:
            return ""
        if chosen is not None:
            own = _canonical({f: chosen.letters.get(f, "F") for f in pattern.folds})
            return "" if own in other else f"no way has the letters of way {chosen.number}"
        i, j = candidate.fold
        return f"the letters of the ways differ, first at fold {i}-{j}" if other != here else ""

    search = _Search(guarded, parts.tracked, name, seed, progress)
    return search.found(number, confirm, chosen is None)


def _distinct(closings: Sequence[tuple[int, Closing]]) -> list[tuple[int, Closing]]:
    """The relations without those that a later way needs in the same form."""
    seen: dict[tuple[object, ...], tuple[int, Closing]] = {}
    for way, one in sorted(closings, key=lambda pair: pair[0]):
        sizes = tuple(f"{c:.9e}" for c in one.compliance.values())
        vertices = min(one.vertices, one.vertices[::-1])
        seen.setdefault((one.kind, vertices, sizes), (way, one))
    return list(seen.values())


def _border(pattern: PanelPattern) -> list[int]:
    """The boundary vertices in order."""
    after = {}
    for i, j in pattern.boundary_edges:
        a, b = (i, j) if (i, j) in pattern.sides else (j, i)
        after[a] = b
    order = [min(after)]
    while (following := after[order[-1]]) != order[0]:
        order.append(following)
    return order


def _rational(points: Sequence[tuple[Number, Number]]) -> list[tuple[Fraction, Fraction]]:
    return [(rational(x), rational(y)) for x, y in points]


# --- what both kinds of sheets share -------------------------------------------------------------


@dataclass(frozen=True, eq=False)
class _Frame:
    """The sheet as doubles, how far these are off, and how far its shape allows moves."""

    pattern: CreasePattern | PanelPattern
    points: FloatArray
    off: float
    shape: Shape
    shortest: float
    guard: float = inf
    guards: tuple[float, ...] = ()

    @classmethod
    def of(cls, pattern: CreasePattern | PanelPattern, polygons: Sequence[Sequence[int]]) -> _Frame:
        points = np.array([[float(x), float(y)] for x, y in pattern.vertices])
        edges = np.array(pattern.edges)
        lengths = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
        off = max(_off(x, y, p) for (x, y), p in zip(pattern.vertices, points, strict=True))
        return cls(pattern, points, off, shape_of(points, polygons), float(lengths.min()))

    @property
    def largest(self) -> float:
        """The radius that the shape of the sheet and its flat folds allow."""
        return max(0.0, min(self.shape.all_move, self.guard) - 2 * self.off) * _DOWN

    def alone(self, vertex: int) -> float:
        """The same for moves of one vertex."""
        guard = self.guards[vertex] if self.guards else inf
        return max(0.0, min(self.shape.one_moves[vertex], guard) - 2 * self.off) * _DOWN

    def moved(self, candidate: Candidate) -> list[tuple[Number, Number]]:
        """The exact vertices of the sheet of a candidate."""
        pairs = zip(self.pattern.vertices, candidate.moves, strict=True)
        return [(x + dx, y + dy) for (x, y), (dx, dy) in pairs]

    def nothing(
        self,
        status: Verdict,
        reason: str,
        way: str,
        ways: int,
        limit: str,
        closings: tuple[tuple[int, Closing], ...] = (),
    ) -> Tolerance:
        """The result with the radius 0."""
        return Tolerance(
            self.pattern,
            status,
            reason,
            way,
            ways,
            0.0,
            0.0 if status is PROVED else None,
            None,
            limit,
            None,
            dict.fromkeys(range(len(self.points)), 0.0),
            closings,
            self.shortest,
        )

    def of_shape(self, reason: str, way: str, ways: int) -> Tolerance:
        """The result if nothing but the shape of the panels limits the radius."""
        return replace(
            self.nothing(PROVED, reason, way, ways, self.pinched),
            radius=self.largest,
            upper=self.upper,
            vertices={v: self.alone(v) for v in range(len(self.points))},
        )

    @property
    def upper(self) -> float:
        """A radius within which panels lose their shape, rounded up."""
        return (self.shape.all_move + self.off) * (1 + 2.0**-40)

    @property
    def pinched(self) -> str:
        """What happens at `upper`."""
        v, (a, b) = self.shape.pinched, sorted(self.shape.edge)
        return f"vertex {v} comes to lie on the line of edge {a}-{b}, and a panel has no shape"


def _off(x: Number, y: Number, point: FloatArray) -> float:
    """How far an exact point lies from its double, rounded up."""
    if isinstance(x, Fraction | int) and isinstance(y, Fraction | int):
        dx, dy = x - Fraction(float(point[0])), y - Fraction(float(point[1]))
        return float(abs(dx) + abs(dy)) * (1 + 2.0**-40)
    return float(np.abs(point).max()) * 2.0**-48


class _Search:
    """Radii, upper bound and estimate of the zeros of parts."""

    def __init__(
        self,
        frame: _Frame,
        parts: Sequence[TrackedPart],
        way: str,
        seed: int,
        progress: Progress | None,
    ) -> None:
        self.frame, self.parts, self.way, self.seed = frame, parts, way, seed
        self.progress = progress
        self.radii = [self._radii(part) for part in parts]

    def _radii(self, part: TrackedPart) -> Radii:
        lettered = np.array([bool(name) for name in part.names])
        return proved_radii(part.conditions, part.zeros, self.frame.off, lettered, self.progress)

    def found(self, ways: int, confirm: Confirm, everything: bool) -> Tolerance:
        """The result for the zeros that were asked for."""
        radius, vertices = self.radius(), self._vertices()
        status, reason, limit = PROVED, self._kept(ways, everything), self.frame.pinched
        upper: float | None = self.frame.upper
        changed = None
        if flat := self._bending():
            return self.frame.nothing(
                PROVED, f"{flat}, but not on sheets nearby", self.way, ways, flat
            )
        if self.progress is not None:
            self.progress("other sheets", 0, 0)
        if (nearest := self._nearest(confirm)) is not None:
            candidate, what = nearest
            if candidate.distance < self.frame.upper:
                upper, changed, limit = candidate.distance, Changed(what, candidate.moves), what
        if everything and radius > 0 and (same := self.not_distinct()):
            radius, vertices = 0.0, dict.fromkeys(vertices, 0.0)
            status, reason = UNDECIDED, same
        elif radius == 0:
            status, reason = UNDECIDED, self._unproved()
        return Tolerance(
            self.frame.pattern,
            status,
            reason,
            self.way,
            ways,
            radius,
            upper,
            changed,
            limit,
            self._estimate(),
            vertices,
            (),
            self.frame.shortest,
        )

    def _used(self, part: TrackedPart) -> list[int]:
        """The zeros on which the answer depends."""
        return list(part.of_way)

    def radius(self) -> float:
        """The proved radius of all zeros on which the answer depends."""
        radius = self.frame.largest
        for part, radii in zip(self.parts, self.radii, strict=True):
            radius = min(radius, float(radii.all_move[self._used(part)].min()) * _DOWN)
        return radius

    def _vertices(self) -> dict[int, float]:
        alone = {v: self.frame.alone(v) for v in range(len(self.frame.points))}
        for part, radii in zip(self.parts, self.radii, strict=True):
            least = radii.one_moves[self._used(part)].min(axis=0) * _DOWN
            alone = {v: min(radius, float(least[v])) for v, radius in alone.items()}
        return alone

    def _kept(self, ways: int, everything: bool) -> str:
        if everything:
            return (
                "all sheets whose vertices move by less than the radius, each in its disk, have "
                f"{counted(ways, 'way')} with the same letters"
            )
        return (
            "all sheets whose vertices move by less than the radius, each in its disk, have this "
            "way with the same letters"
        )

    def _unproved(self) -> str:
        for part, radii in zip(self.parts, self.radii, strict=True):
            for k in self._used(part):
                if not radii.all_move[k] > 0:
                    return (
                        f"{part.names[k] or 'a motion that is not real'} is too nearly singular, "
                        "or a letter too nearly flat, for the test in doubles"
                    )
        return "the panels are too thin for their shape in doubles"

    def _bending(self) -> str:
        """A fold that is flat on a way, and proved to bend on sheets nearby."""
        for part, radii in zip(self.parts, self.radii, strict=True):
            for k in self._used(part):
                if not part.names[k]:
                    continue
                sizes = np.abs(radii.densities[k])
                for e in np.flatnonzero(sizes < 1e-12 * sizes.max()).tolist():
                    if radii.is_sloping[k, e] and radii.errors[k] < 1e-9:
                        i, j = part.conditions.folds[e]
                        return f"on {part.names[k]} fold {i}-{j} is flat"
        return ""

    def not_distinct(self) -> str:
        """Why the ways are not proved to be different; empty if they are."""
        for part, radii in zip(self.parts, self.radii, strict=True):
            if not part.is_complete:
                return "not all complex motions are listed, so that others may become real"
            if not all_distinct(part, radii):
                return "the boxes of two ways are not proved to be distinct"
        return ""

    def _nearest(self, confirm: Confirm) -> tuple[Candidate, str] | None:
        found: list[tuple[Candidate, TrackedPart]] = []
        for part, radii in zip(self.parts, self.radii, strict=True):
            chosen = np.array([k for k in self._used(part) if part.names[k]], dtype=np.intp)
            real = np.asarray(part.zeros.real)
            plain = replace(
                radii,
                densities=np.asarray(radii.densities.real),
                slopes=np.asarray(radii.slopes.real),
            )
            if len(chosen):
                found += [
                    (one, part) for one in candidates(part.conditions, real, plain, chosen, _TRIED)
                ]
        for candidate, _ in sorted(found, key=lambda pair: pair[0].distance)[:_TRIED]:
            if what := confirm(candidate):
                return candidate, what
        return None

    def _estimate(self) -> Estimate | None:
        if self.progress is not None:
            self.progress("random moves", 0, 0)
        moves = random_moves(np.random.default_rng(self.seed), SAMPLES, len(self.frame.points))
        pattern = self.frame.pattern
        faces = pattern.triangles if isinstance(pattern, CreasePattern) else pattern.faces
        ends = pinching(self.frame.points, faces, moves)
        for part, radii in zip(self.parts, self.radii, strict=True):
            chosen = np.array([k for k in self._used(part) if part.names[k]], dtype=np.intp)
            if len(chosen):
                plain = replace(
                    radii,
                    densities=np.asarray(radii.densities.real),
                    slopes=np.asarray(radii.slopes.real),
                )
                real = np.asarray(part.zeros.real)
                ends = np.minimum(ends, first_changes(part.conditions, real, plain, chosen, moves))
        radius = float(np.sort(ends)[int(SHARE * SAMPLES) - 1])
        return Estimate(radius, SAMPLES, self.seed) if isfinite(radius) else None
