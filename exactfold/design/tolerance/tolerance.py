"""`tolerance_of_branches` and `tolerance_of_panels`: how far vertices may move, with proof."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Mapping, Sequence
from dataclasses import replace
from fractions import Fraction

from exactfold._support.clock import Clock
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.counting.find import find_branch
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.letters import UPSIDE_DOWN
from exactfold.branches.values.result import BranchCount
from exactfold.design.tolerance.closing import Closing
from exactfold.design.tolerance.frame import Frame, check_extent
from exactfold.design.tolerance.nearest import Candidate
from exactfold.design.tolerance.parts import (
    PanelParts,
    branch_part,
    panel_parts,
)
from exactfold.design.tolerance.result import Tolerance
from exactfold.design.tolerance.search import Search
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
_SECONDS = 20.0
"""How long the ways of a sheet of panels nearby are looked for."""


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
    foldable vertices without a chosen branch and for a sheet without branches,
    `NotApplicableError` for a sheet too large, too small or too far off for doubles.

    >>> from exactfold.branches.counting.collect import count_branches
    >>> tolerance_of_branches(count_branches("two-vertex"))
    <Tolerance: proved, 0.0091 of at most 0.0339>
    """
    start = time.perf_counter()
    branches = [chosen] if chosen is not None else _all_branches(count)
    pattern = branches[0].pattern
    check_extent(pattern)
    open_ = [branch for branch in branches if branch.undecided_folds]
    if open_:
        i, j = open_[0].undecided_folds[0]
        raise UndecidedBranchError(
            f"on branch {open_[0].sign_text} the letter of fold {i}-{j} is undecided: there is no "
            "answer whose tolerance could be asked for"
        )
    frame = Frame.of(pattern, [*pattern.triangles, pattern.boundary])
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
    search = Search(frame, [part], way, seed, progress)

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
    frame = Frame.of(pattern, [*pattern.triangles, pattern.boundary])
    search = Search(frame, [branch_part(branches)], "", 0, None)
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
    families, for a sheet without ways and for one whose vertices are known only nearly,
    `NotApplicableError` for a sheet too large, too small or too far off for doubles.

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
    check_extent(pattern)
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
    frame = Frame.of(pattern, [*pattern.faces, _border(pattern)])
    name = "" if chosen is None else f"way {chosen.number}"
    number = 1 if chosen is not None else len(folding)
    found = _of_parts(known, frame, parts, name, number, chosen, seed, progress)
    return replace(found, seconds=time.perf_counter() - start)


def _of_parts(
    known: Decomposition,
    frame: Frame,
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
        ways = panel_ways(result)
        if any(one.verdict is UNDECIDED for one in ways):
            return None
        return Counter(
            _canonical({fold: one.letters.get(fold, "F") for fold in result.pattern.folds})
            for one in ways
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

    flat = {
        (f"way {one.number}", fold)
        for one in panel_ways(known)
        for fold in pattern.folds
        if one.letters.get(fold, "F") == "F"
    }
    search = Search(guarded, parts.tracked, name, seed, progress, flat)
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
