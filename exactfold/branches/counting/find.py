"""`find_branch`: finds and proves the branch with given vertex signs, without the others."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.branches.values import reasons
from exactfold.branches.values.branch import Branch
from exactfold.branches.values.enclosed import not_enclosed, of_enclosure
from exactfold.branches.values.letters import sign_value
from exactfold.errors import UsageError
from exactfold.exact.numbers import RationalLike
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.rigidity.equations.boundary_heights import default_boundary_heights
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.sheet import VertexEquations
from exactfold.solve.certify.enclosed import enclosed
from exactfold.solve.certify.enclosure import Enclosure
from exactfold.solve.numeric.sparse_newton import End, solve
from exactfold.solve.numeric.sparse_sheet import FloatSheet

_NAMED: Final = 12
"""At most this many vertices are named in a message."""
Signs = str | Mapping[int, int] | Sequence[int]
BoundaryHeights = Mapping[int, RationalLike]
Deficits = Mapping[int, RationalLike]


def find_branch(
    pattern: PatternLike,
    signs: Signs | None = None,
    *,
    up: Iterable[int] | None = None,
    boundary_heights: BoundaryHeights | None = None,
    curvature: Deficits | None = None,
    progress: Progress | None = None,
) -> Branch:
    """Find and prove the one branch with given vertex signs, without enumerating the others.

    `signs` is a text such as "+-+" in the order of the interior vertices, a sequence of +1 and -1,
    or a mapping from vertex to sign. Vertices in triangulated triangles stay flat: their signs are
    0 or are left out. Instead of `signs`, `up` gives the vertices that pop up; the others pop down.

    Newton's method on the nappes proposes heights (docs/mathematics.md, Nappes). Exact arithmetic
    refines them, and a theorem that needs no factorisation encloses them (docs/branch.md,
    `enclose`), so that the cost of the proof grows like the number of folds. `Branch` explains the
    gauge. `boundary_heights` gives the heights of all boundary vertices of a convex boundary of any
    length; the result is the branch with these boundary heights. A convex sheet with more than four
    boundary vertices has the heights `default_boundary_heights` if `boundary_heights` is not given.
    `curvature` gives angle deficits K_v > 0 of interior vertices, 0 for vertices that it does not
    name; the result is then the one shape with these signs (docs/branch.md, Angle deficits), and
    the boundary has height 0 if `boundary_heights` is not given. A vertex that is proved flat on
    the branch gets the sign 0. The signs +, - and 0 of such a vertex all lead to this branch.

    Raises `UsageError` for signs that do not fit the pattern, also for a sign 0 if the vertex is
    not flat on the branch with the other signs; `BoundaryHeightsError` and `BadCurvatureError`,
    which name the vertex; `NotApplicableError` for `boundary_heights` if the boundary is not
    convex; `NotCountedError` if signs name no branch or no vertex can pop. UNDECIDED does not mean
    that the branch does not exist.

    >>> from exactfold.pattern.triangulating.random_squares import random_square
    >>> branch = find_branch(random_square(8, seed=1), "+-++--+-")
    >>> branch.status, branch.assignment_text, float(branch.radius) < 1e-9
    (<Verdict.PROVED: 'proved'>, 'MMMVMVVMMVVMMVMVMMVVMVVVM', True)
    """
    finder = branch_finder(as_pattern(pattern), boundary_heights, curvature)
    return finder.find(finder.signs(signs, up), progress=progress)


def find_branches(
    pattern: PatternLike,
    many: Iterable[Signs],
    *,
    boundary_heights: BoundaryHeights | None = None,
    curvature: Deficits | None = None,
    progress: Progress | None = None,
) -> Iterator[Branch]:
    """`find_branch` for many sign vectors, one after the other; the setup is done once.

    >>> from exactfold.pattern.triangulating.random_squares import random_square
    >>> [b.sign_text for b in find_branches(random_square(3, seed=0), ["+-+", "---"])]
    ['+-+', '---']
    """
    finder = branch_finder(as_pattern(pattern), boundary_heights, curvature)
    for signs in many:
        yield finder.find(finder.signs(signs, None), progress=progress)


def neighbours(
    pattern: PatternLike,
    signs: Signs,
    vertices: Iterable[int] | None = None,
    *,
    boundary_heights: BoundaryHeights | None = None,
    curvature: Deficits | None = None,
    progress: Progress | None = None,
) -> dict[int, Branch]:
    """For each vertex, the branch that is reached by popping this vertex through.

    The sign vector of this branch differs from `signs` at the vertex only. The heights of the
    branch with `signs` are the start of the search. `vertices` are by default all vertices that can
    pop. Raises the errors of `find_branch`.

    >>> from exactfold.pattern.triangulating.random_squares import random_square
    >>> {v: b.sign_text for v, b in neighbours(random_square(3, seed=0), "+-+").items()}
    {4: '--+', 5: '+++', 6: '+--'}
    """
    finder = branch_finder(as_pattern(pattern), boundary_heights, curvature)
    return finder.neighbours(finder.signs(signs, None), vertices, progress=progress)


def has_graphs(pattern: CreasePattern) -> bool:
    """Whether the ways of a sheet are graphs over the boundary heights, one for each sign vector.

    >>> from exactfold.pattern.families import single_vertex, two_vertex
    >>> has_graphs(single_vertex(5)), has_graphs(two_vertex())
    (True, False)
    """
    return pattern.Ve > 4 and pattern.is_convex and bool(pattern.foldable_vertices)


def signs_of_way(pattern: CreasePattern, way: int) -> dict[int, int]:
    """The vertex signs of the graph with the number `way`, from 1, of a sheet that `has_graphs`.

    The opposite signs belong to its mirror image. So the first vertex that can pop is up, and the
    others are up or down in the order +++, ++-, +-+, and so on. Raises `UsageError` for a number
    beyond the last.

    >>> from exactfold.pattern.triangulating.random_squares import random_square
    >>> signs_of_way(random_square(3, seed=0), 3)
    {4: 1, 5: -1, 6: 1}
    """
    first, *others = pattern.foldable_vertices
    number = 1 << len(others)
    if not 1 <= way <= number:
        raise UsageError(f"there is no way {way}: this sheet has the ways 1 to {number}")
    bits = f"{way - 1:0{len(others)}b}" if others else ""
    return {first: 1, **{v: -1 if bit == "1" else 1 for v, bit in zip(others, bits, strict=True)}}


def branch_finder(
    pattern: CreasePattern,
    boundary_heights: BoundaryHeights | None = None,
    curvature: Deficits | None = None,
) -> BranchFinder:
    """The finder of a pattern, with `default_boundary_heights` if it needs boundary heights.

    >>> from exactfold.pattern.families import single_vertex
    >>> branch_finder(single_vertex(5)).problem.gauge
    <Gauge: rim, 5 boundary vertices>
    """
    if boundary_heights is None and curvature is None and pattern.Ve > 4 and pattern.is_convex:
        boundary_heights = default_boundary_heights(pattern)
    return BranchFinder(pattern, boundary_heights, curvature)


@dataclass(frozen=True)
class BranchFinder:
    """Finds branches of one pattern; whatever does not depend on the signs is computed once.

    `boundary_heights` and `curvature` have the same meaning as in `find_branch`, but
    `boundary_heights` has no default.
    """

    pattern: CreasePattern
    boundary_heights: BoundaryHeights | None = None
    curvature: Deficits | None = None

    @cached_property
    def problem(self) -> Problem:
        """The problem, in the gauge that `boundary_heights` and `curvature` ask for."""
        problem = Problem.of(
            self.pattern, boundary_heights=self.boundary_heights, curvature=self.curvature
        )
        problem.require_foldable()
        return problem

    @cached_property
    def sheet(self) -> VertexEquations:
        """The exact equations, fold by fold."""
        return VertexEquations(self.problem)

    @cached_property
    def _floats(self) -> FloatSheet:
        return FloatSheet.of(self.sheet)

    @cached_property
    def poppable(self) -> tuple[int, ...]:
        """The interior vertices outside triangulated triangles."""
        return self.problem.foldable

    def cannot_pop(self, vertex: object) -> str:
        """The reason why a vertex cannot have a sign."""
        if vertex in self.problem.rigid:
            return f"vertex {vertex} lies in a triangulated triangle and stays flat"
        return f"vertex {vertex} is not an interior vertex"

    def signs(self, signs: Signs | None, up: Iterable[int] | None) -> dict[int, int]:
        """The signs of all vertices that can pop, from vertex signs or from vertices that pop up.

        Raises `UsageError` for signs or vertices that do not fit the pattern.
        """
        names = self.poppable
        if (signs is None) == (up is None):
            raise UsageError("give either the vertex signs or the vertices that pop up")
        if up is not None:
            chosen = set(up)
            for v in sorted(chosen.difference(names)):
                raise UsageError(self.cannot_pop(v))
            return {v: 1 if v in chosen else -1 for v in names}
        if isinstance(signs, Mapping):
            given = dict(signs)
        else:
            values = [_value(s) for s in (() if signs is None else signs)]
            keys = names if len(values) == len(names) else self.pattern.interior
            if len(values) != len(keys):
                inside = self.pattern.Vi - len(names)
                also = f" (or {self.pattern.Vi}, 0 for those that stay flat)" if inside else ""
                some, wanted = counted(len(values), "sign"), counted(len(names), "vertex")
                first = ", ".join(map(str, names[:_NAMED])) + ", ..." * (len(names) > _NAMED)
                raise UsageError(
                    f"{some} for {wanted}{also}: give + or - for each, in the order {first}"
                )
            given = dict(zip(keys, values, strict=True))
        for v, sign in given.items():
            if v in self._names:
                if sign not in (1, -1, 0):
                    raise UsageError(f"the sign of vertex {v} is {sign!r}, not +1, -1 or 0")
            elif sign != 0 or v not in self.problem.rigid:
                raise UsageError(self.cannot_pop(v))
        missing = [v for v in names if v not in given]
        if missing:
            raise UsageError(f"vertex {missing[0]} has no sign")
        return {v: int(given[v]) for v in names}

    @cached_property
    def _names(self) -> frozenset[int]:
        return frozenset(self.poppable)

    def propose(
        self, signs: Mapping[int, int], start: FloatArray | None, progress: Progress | None
    ) -> End:
        """Float heights of the unknowns; `start` may be the heights found for other signs."""
        steps = None if progress is None else lambda k: progress("Newton steps", k, 0)
        return solve(self._floats, self._vector(signs), start, steps)

    def find(
        self,
        signs: Mapping[int, int],
        *,
        start: FloatArray | None = None,
        progress: Progress | None = None,
    ) -> Branch:
        """The branch with the signs that `signs` returned.

        A vertex with the sign 0 must be proved flat on the branch. The branches with the signs
        (s, 0) and (s, +1) both lie in the closed nappes of (s, +1), which hold only one branch
        (docs/theorem.md, Four boundary vertices). So if the branch that is proved there does not
        have the given signs, no branch has them: this raises `UsageError`.
        """
        flat = [v for v, sign in signs.items() if sign == 0]
        branch = self._found({**signs, **dict.fromkeys(flat, 1)}, start, progress)
        missed = [v for v in flat if branch.vertex_signs[v] != 0]
        if missed and branch.status is PROVED:
            raise UsageError(
                f"no branch has these signs: vertex {missed[0]} is not flat with the others as "
                "given; give it + or -"
            )
        return branch

    def _found(
        self, signs: Mapping[int, int], start: FloatArray | None, progress: Progress | None
    ) -> Branch:
        """The branch in the closed nappes of `signs`, each of which is +1 or -1."""
        begin = time.perf_counter()
        steps = 0
        reason = ""
        try:
            with np.errstate(all="ignore"):  # points that are not finite are dropped below
                end = self.propose(signs, start, progress)
                if end.failure and start is not None:
                    end = self.propose(signs, None, progress)
                steps = end.steps
                best: Enclosure | None = None
                if np.isfinite(end.x).all():
                    best, failed = enclosed(
                        self.sheet, self._floats, self._vector(signs), end.x, progress
                    )
                    reason = reasons.not_found([self.sheet.labels[v] for v in failed])
            if best is not None:
                return of_enclosure(
                    self.sheet, best, signs, steps=steps, seconds=time.perf_counter() - begin
                )
            if end.failure:
                reason = end.failure
                if end.worst is not None:
                    worst = self.sheet.labels[self.sheet.unknowns[end.worst]]
                    reason += f", worst at {reasons.named([worst])}"
        except OverflowError:
            reason = "a length or a form is beyond the range of floats"
        seconds = time.perf_counter() - begin
        return not_enclosed(self.problem, signs, reason, steps=steps, seconds=seconds)

    def neighbours(
        self,
        signs: Mapping[int, int],
        vertices: Iterable[int] | None = None,
        *,
        progress: Progress | None = None,
    ) -> dict[int, Branch]:
        """By vertex of `vertices`, the branch that differs from `signs` there; see `neighbours`."""
        return dict(self.each_neighbour(signs, vertices, progress=progress))

    def each_neighbour(
        self,
        signs: Mapping[int, int],
        vertices: Iterable[int] | None = None,
        *,
        progress: Progress | None = None,
    ) -> Iterator[tuple[int, Branch]]:
        """The same branches one by one, for patterns whose neighbours would fill the memory."""
        flat = [v for v, sign in signs.items() if sign == 0]
        if flat:
            raise UsageError(
                f"the sign of vertex {flat[0]} is 0: neighbours differ from a branch whose vertex "
                "signs are all + or -"
            )
        chosen = self.poppable if vertices is None else tuple(dict.fromkeys(vertices))
        for v in chosen:
            if v not in self._names:
                raise UsageError(self.cannot_pop(v))
        first = None  # the heights of the branch with `signs`, if Newton's method finds them
        with suppress(OverflowError), np.errstate(all="ignore"):
            base = self.propose(signs, None, progress)
            first = None if base.failure else base.x
        for k, v in enumerate(chosen):
            if progress is not None:
                progress("neighbours", k, len(chosen))
            yield v, self.find({**signs, v: -signs[v]}, start=first)

    # --- the proof, and what it means ------------------------------------------------------------

    def _vector(self, signs: Mapping[int, int]) -> FloatArray:
        """The signs in the order of the unknowns; a reflex corner counts as popping up."""
        labels, corner = self.sheet.labels, self.sheet.corner
        return np.array(
            [1.0 if v == corner else float(signs[labels[v]]) for v in self.sheet.unknowns]
        )


def _value(sign: object) -> int:
    """The integer for a sign that is given as a character or as a number."""
    value = sign_value(sign)
    if value is None:
        raise UsageError(f"{sign!r} is not a vertex sign: use + or 1, - or -1, or 0 for flat")
    return value
