"""`find_branch`: the branch with given vertex signs, alone and proved."""

from __future__ import annotations

import time
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.branches.branch import Branch
from exactfold.branches.letters import LETTERS, sign_value
from exactfold.branches.roots import EnclosedRoot
from exactfold.certify.enclosed_flat import deduced, rational
from exactfold.certify.enclosure import (
    Enclosure,
    enclose,
    height_radius,
    root_above,
    round_up,
)
from exactfold.certify.refinement import exact, refine
from exactfold.count import reasons
from exactfold.errors import UsageError
from exactfold.exact.numbers import RationalLike
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.load import PatternLike, as_pattern
from exactfold.problem.problem import Problem
from exactfold.problem.sheet import Sheet
from exactfold.progress import Progress
from exactfold.rigidity.functionals import saddle_functional
from exactfold.solve.sparse_newton import End, solve
from exactfold.solve.sparse_sheet import FloatSheet
from exactfold.verdict import PROVED, UNDECIDED
from exactfold.wording import counted

Signs = str | Mapping[int, int] | Sequence[int]
Rim = Mapping[int, RationalLike]
_LEVELS = (80, 160, 320)
"""Excess curvatures 2^-level tried one after the other until every fold is decided."""


def find_branch(
    pattern: PatternLike,
    signs: Signs | None = None,
    *,
    up: Iterable[int] | None = None,
    rim: Rim | None = None,
    progress: Progress | None = None,
) -> Branch:
    """The one branch with given vertex signs, proved, without enumerating the others.

    `signs`: text such as "+-+" in the order of the interior vertices ("0", or nothing at all, for
    those in triangulated triangles, which stay flat), a sequence of +1 and -1, or a mapping from
    vertex to sign. `up`: instead, the vertices that pop up; the others pop down. Newton's method on
    the nappes proposes heights (docs/mathematics.md, 12); they are refined in exact arithmetic and
    enclosed by a theorem that needs no factorisation (docs/branch.md, `enclose`), so that the cost
    of the proof grows like the number of folds. Gauge: see `Branch`. With `rim`, heights of all
    boundary vertices of a convex boundary of any length, the branch of that rim. A vertex that
    is proved flat on the branch gets the sign 0: either sign leads to that branch.

    Raises `UsageError` for signs that do not fit the pattern, `NotApplicableError` if Ve is not 4
    and no rim is given, or if no vertex can pop. An `UNDECIDED` result does not say that the
    branch does not exist.

    >>> from exactfold.pattern.random_squares import random_square
    >>> branch = find_branch(random_square(8, seed=1), "+-++--+-")
    >>> branch.status, branch.assignment_text, float(branch.radius) < 1e-9
    (<Verdict.PROVED: 'proved'>, 'MMMVMVVMMVVMMVMVMMVVMVVVM', True)
    """
    finder = BranchFinder(as_pattern(pattern), rim)
    return finder.find(finder.signs(signs, up), progress=progress)


def find_branches(
    pattern: PatternLike,
    many: Iterable[Signs],
    *,
    rim: Rim | None = None,
    progress: Progress | None = None,
) -> Iterator[Branch]:
    """`find_branch` for each of many sign vectors, one after the other, the setup shared.

    >>> from exactfold.pattern.random_squares import random_square
    >>> [b.sign_text for b in find_branches(random_square(3, seed=0), ["+-+", "---"])]
    ['+-+', '---']
    """
    finder = BranchFinder(as_pattern(pattern), rim)
    for signs in many:
        yield finder.find(finder.signs(signs, None), progress=progress)


def neighbours(
    pattern: PatternLike,
    signs: Signs,
    vertices: Iterable[int] | None = None,
    *,
    rim: Rim | None = None,
    progress: Progress | None = None,
) -> dict[int, Branch]:
    """The branches reached by popping one vertex through, by vertex.

    For each vertex of `vertices` (by default all that can pop) the branch whose sign vector differs
    from `signs` there only, found from the branch with `signs` as a start. Raises as `find_branch`.

    >>> from exactfold.pattern.random_squares import random_square
    >>> {v: b.sign_text for v, b in neighbours(random_square(3, seed=0), "+-+").items()}
    {4: '--+', 5: '+++', 6: '+--'}
    """
    finder = BranchFinder(as_pattern(pattern), rim)
    return finder.neighbours(finder.signs(signs, None), vertices, progress=progress)


@dataclass(frozen=True)
class BranchFinder:
    """Finds branches of one pattern; what does not depend on the signs is computed once.

    `rim` as in `find_branch`.
    """

    pattern: CreasePattern
    rim: Rim | None = None

    @cached_property
    def problem(self) -> Problem:
        """The problem in the gauge asked for."""
        problem = Problem.of(self.pattern, rim=self.rim)
        problem.require_foldable()
        return problem

    @cached_property
    def sheet(self) -> Sheet:
        """The exact equations, fold by fold."""
        return Sheet(self.problem)

    @cached_property
    def _floats(self) -> FloatSheet:
        return FloatSheet.of(self.sheet)

    @cached_property
    def poppable(self) -> tuple[int, ...]:
        """The interior vertices outside triangulated triangles."""
        return self.problem.foldable

    def cannot_pop(self, vertex: object) -> str:
        """Why a vertex has no sign."""
        if vertex in self.pattern.rigid_vertices:
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
                if sign not in (1, -1):
                    raise UsageError(f"the sign of vertex {v} is {sign!r}, not +1 or -1")
            elif sign != 0 or v not in self.pattern.rigid_vertices:
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
        """The branch with the signs that `signs` returned."""
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
                    best, reason = self._prove(signs, end.x, progress)
            if best is not None:
                return self._result(signs, best, steps, time.perf_counter() - begin)
            if end.failure:
                reason = end.failure
                if end.worst is not None:
                    worst = self.sheet.labels[self.sheet.unknowns[end.worst]]
                    reason += f", worst at {reasons.named([worst])}"
        except OverflowError:
            reason = "a length or a form is beyond the range of floats"
        return self._undecided(signs, reason, steps, time.perf_counter() - begin)

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

    # --- the proof -------------------------------------------------------------------------------

    def _vector(self, signs: Mapping[int, int]) -> FloatArray:
        """Signs in the order of the unknowns; a reflex corner pops up."""
        labels, corner = self.sheet.labels, self.sheet.corner
        return np.array(
            [1.0 if v == corner else float(signs[labels[v]]) for v in self.sheet.unknowns]
        )

    def _prove(
        self, signs: Mapping[int, int], x: FloatArray, progress: Progress | None
    ) -> tuple[Enclosure | None, str]:
        """The enclosure of most precision needed or reached, of exactly these signs, or why not."""
        sheet, vector = self.sheet, self._vector(signs)
        wanted = dict(zip(sheet.unknowns, vector.astype(int).tolist(), strict=True))
        heights = exact(sheet, self._floats, x)
        best, failed = None, tuple[int, ...]()
        for k, level in enumerate(_LEVELS):
            if progress is not None:
                progress("proof", k, len(_LEVELS))
            refined = refine(sheet, self._floats, vector, heights, level)
            if refined is None:
                break
            heights = refined
            found = enclose(sheet, heights.values, heights.denominator, heights.bits)
            if isinstance(found, tuple) or found.signs != wanted:
                failed = found if isinstance(found, tuple) else ()
                break
            best = deduced(sheet, found)
            if best.complete:
                break
        if best is not None and not best.complete:
            best = rational(sheet, best, wanted) or best
        if best is None and not failed:
            rough = enclose(sheet, heights.values, heights.denominator, heights.bits)
            failed = rough if isinstance(rough, tuple) else ()
        return best, reasons.not_found([sheet.labels[v] for v in failed])

    def _result(
        self, signs: Mapping[int, int], proof: Enclosure, steps: int, seconds: float
    ) -> Branch:
        """What the enclosure means (`classify`): the signs, letters and heights it proves."""
        sheet, labels = self.sheet, self.sheet.labels
        unit = sheet.height_unit
        squared = round_up(proof.squared_distance * unit**2)
        centres = self.problem.all_heights(
            {v: Fraction(int(h), proof.denominator) * unit for v, h in enumerate(proof.heights)}
        )
        root = EnclosedRoot(centres, height_radius(sheet, squared), squared)
        loose = tuple(labels[v] for v in proof.loose)
        flat = tuple(labels[v] for v in proof.flat_vertices)
        error = root_above(squared) if squared else Fraction(0)
        letters = {
            (labels[i], labels[j]): "F" if k in proof.flat_folds else LETTERS[sign or None]
            for (k, (i, j)), sign in zip(enumerate(sheet.pattern.folds), proof.letters, strict=True)
        }
        return replace(
            self._undecided(signs, reasons.undecided(error, loose), steps, seconds),
            status=UNDECIDED if loose else PROVED,
            reason=reasons.undecided(error, loose)
            if loose
            else reasons.proved(error, flat, self.pattern.Vt > 0),
            vertex_signs=self._all_signs({**signs, **dict.fromkeys(flat, 0)}),
            undecided_vertices=loose,
            assignment=self._assignment(letters),
            root=root,
            multiplicity=None if loose else 1 << (len(flat) + self.pattern.Vt),
            saddle=self._saddle(root),
        )

    def _undecided(
        self, signs: Mapping[int, int], reason: str, steps: int, seconds: float
    ) -> Branch:
        return Branch(
            pattern=self.pattern,
            vertex_signs=self._all_signs(signs),
            assignment=self._assignment({}),
            root=None,
            multiplicity=None,
            gauge=self.problem.gauge.kind,
            saddle=0,
            status=UNDECIDED,
            reason=reason,
            undecided_vertices=self.poppable,
            steps=steps,
            seconds=seconds,
        )

    # --- back to the pattern that was given ------------------------------------------------------

    def _all_signs(self, signs: Mapping[int, int]) -> dict[int, int]:
        return {v: signs.get(v, 0) for v in self.pattern.interior}

    def _assignment(self, letters: Mapping[Edge, str]) -> dict[Edge, str]:
        """Letters of all folds: those with an end in a triangulated triangle are flat."""
        rigid = self.pattern.rigid_vertices
        return {
            fold: letters.get(fold, "U") if rigid.isdisjoint(fold) else "F"
            for fold in self.pattern.folds
        }

    def _saddle(self, root: EnclosedRoot) -> int:
        if self.pattern.Ve != 4:
            return 0
        functional = saddle_functional(self.pattern)
        value = sum((c * root.centres[v] for v, c in functional.items()), Fraction(0))
        error = Fraction(0)
        if self.sheet.corner is not None:
            error = abs(functional[self.sheet.labels[self.sheet.corner]]) * root.radius
        return 0 if abs(value) <= error else 1 if value > 0 else -1


def _value(sign: object) -> int:
    """A sign, as a character or a number, as an integer."""
    value = sign_value(sign)
    if value is None:
        raise UsageError(f"{sign!r} is not a vertex sign: + or 1, - or -1, 0 where none can pop")
    return value
