"""`find_branch`: the branch with given vertex signs, alone and proved."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass
from functools import cached_property

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
    """The one branch with given vertex signs, proved, without enumerating the others.

    `signs`: text such as "+-+" in the order of the interior vertices ("0", or nothing at all, for
    those in triangulated triangles, which stay flat), a sequence of +1 and -1, or a mapping from
    vertex to sign. `up`: instead, the vertices that pop up; the others pop down. Newton's method on
    the nappes proposes heights (docs/mathematics.md, Nappes); they are refined in exact arithmetic
    and enclosed by a theorem that needs no factorisation (docs/branch.md, `enclose`), so that the
    cost of the proof grows like the number of folds. Gauge: see `Branch`. With `boundary_heights`,
    heights of all boundary vertices of a convex boundary of any length, the branch of that rim; a
    convex sheet with more than four boundary vertices has the rim `default_boundary_heights` if
    none is given. `curvature`: angle deficits K_v > 0 of interior vertices, 0 where none is given;
    then the one shape with these signs (docs/branch.md, Angle deficits), whose rim has height 0 if
    none is given. A vertex that is proved flat on the branch gets the sign 0: either sign leads to
    it, and so does 0.

    Raises `UsageError` for signs that do not fit the pattern, among them a 0 where no branch with
    the other signs is proved flat; `BoundaryHeightsError` and `BadCurvatureError`, which name the
    vertex; `NotApplicableError` for a rim of a boundary that is not convex; `NotCountedError` where
    signs name no branch, or if no vertex can pop. An `UNDECIDED` result does not say that the
    branch does not exist.

    >>> from exactfold.pattern.random_squares import random_square
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
    """`find_branch` for each of many sign vectors, one after the other, the setup shared.

    >>> from exactfold.pattern.random_squares import random_square
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
    """The branches reached by popping one vertex through, by vertex.

    For each vertex of `vertices` (by default all that can pop) the branch whose sign vector differs
    from `signs` there only, found from the branch with `signs` as a start. Raises as `find_branch`.

    >>> from exactfold.pattern.random_squares import random_square
    >>> {v: b.sign_text for v, b in neighbours(random_square(3, seed=0), "+-+").items()}
    {4: '--+', 5: '+++', 6: '+--'}
    """
    finder = branch_finder(as_pattern(pattern), boundary_heights, curvature)
    return finder.neighbours(finder.signs(signs, None), vertices, progress=progress)


def branch_finder(
    pattern: CreasePattern,
    boundary_heights: BoundaryHeights | None = None,
    curvature: Deficits | None = None,
) -> BranchFinder:
    """The finder for a convex boundary of any length.

    Where it needs boundary heights and has none, these are the `default_boundary_heights`.

    >>> from exactfold.pattern.families import single_vertex
    >>> branch_finder(single_vertex(5)).problem.gauge
    <Gauge: rim, 5 boundary vertices>
    """
    if boundary_heights is None and curvature is None and pattern.Ve > 4 and pattern.is_convex:
        boundary_heights = default_boundary_heights(pattern)
    return BranchFinder(pattern, boundary_heights, curvature)


@dataclass(frozen=True)
class BranchFinder:
    """Finds branches of one pattern; what does not depend on the signs is computed once.

    `boundary_heights` and `curvature` as in `find_branch`, but that no rim is chosen.
    """

    pattern: CreasePattern
    boundary_heights: BoundaryHeights | None = None
    curvature: Deficits | None = None

    @cached_property
    def problem(self) -> Problem:
        """The problem in the gauge asked for."""
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
        """Why a vertex has no sign."""
        if vertex in self.problem.rigid:
            return f"vertex {vertex} lies in a triangulated triangle and stays flat"
        return f"vertex {vertex} is not an interior vertex"

    def signs(self, signs: Signs | None, up: Iterable[int] | None) -> dict[int, int]:
        """The signs of all vertices that can pop, from either way to give them.

        Raises `UsageError`.
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
                raise UsageError(f"{some} for {wanted}{also}")
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
        """Float heights of the sheet's unknowns; `start` as found for other signs."""
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

        A vertex with the sign 0 has to be proved flat on it. The branches with (s, 0) and with (s,
        +1) both lie in the closed nappes of (s, +1), which hold one branch only (docs/theorem.md,
        Four boundary vertices): if the one proved there has not the signs asked for, none has,
        which is a `UsageError`.
        """
        flat = [v for v, sign in signs.items() if sign == 0]
        found = self._found({**signs, **dict.fromkeys(flat, 1)}, start, progress)
        missed = [v for v in flat if found.vertex_signs[v] != 0]
        if missed and found.status is PROVED:
            raise UsageError(
                f"no branch has these signs: vertex {missed[0]} is not flat with the others as "
                "given; give it + or -"
            )
        return found

    def _found(
        self, signs: Mapping[int, int], start: FloatArray | None, progress: Progress | None
    ) -> Branch:
        """The branch in the closed nappes of signs that are +1 or -1."""
        begin = time.perf_counter()
        steps = 0
        reason = ""
        try:
            with np.errstate(all="ignore"):  # what leaves the range of floats is no proposal
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
        """The branches that differ from `signs`, as returned by `signs`, at one of `vertices`."""
        return dict(self.each_neighbour(signs, vertices, progress=progress))

    def each_neighbour(
        self,
        signs: Mapping[int, int],
        vertices: Iterable[int] | None = None,
        *,
        progress: Progress | None = None,
    ) -> Iterator[tuple[int, Branch]]:
        """`neighbours` one by one, for patterns where all of them would fill the memory."""
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
        first = None  # the branch with `signs` as a start, if it is found
        with suppress(OverflowError), np.errstate(all="ignore"):
            base = self.propose(signs, None, progress)
            first = None if base.failure else base.x
        for k, v in enumerate(chosen):
            if progress is not None:
                progress("neighbours", k, len(chosen))
            yield v, self.find({**signs, v: -signs[v]}, start=first)

    # --- the proof, and what it means ------------------------------------------------------------

    def _vector(self, signs: Mapping[int, int]) -> FloatArray:
        """Signs in the order of the unknowns; a reflex corner pops up."""
        labels, corner = self.sheet.labels, self.sheet.corner
        return np.array(
            [1.0 if v == corner else float(signs[labels[v]]) for v in self.sheet.unknowns]
        )


def _value(sign: object) -> int:
    """A sign, as a character or a number, as an integer."""
    value = sign_value(sign)
    if value is None:
        raise UsageError(f"{sign!r} is not a vertex sign: + or 1, - or -1, 0 where it is flat")
    return value
