"""`find_driven`: the branch along which chosen folds start with angles in a given ratio."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from itertools import product
from typing import TypedDict

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.documents import ProvedOrNot, Side
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.counting.find import BoundaryHeights, BranchFinder, Signs, branch_finder
from exactfold.branches.values.branch import Branch, BranchDocument
from exactfold.errors import BadDriveError, NotFollowedError, NotProvedAtTheFlatStateError
from exactfold.motion.curves.boundary_path import framework_of, problem_of
from exactfold.motion.curves.drive import Goals, PrescribedAngles, fold_text, not_a_fold
from exactfold.motion.curves.driven_folds import DrivenFolds
from exactfold.motion.tubes.tube_start import prove_start
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.rigidity.equations.boundary_heights import saddle_boundary_heights
from exactfold.rigidity.equations.problem import Problem

_TRIED = 8
"""If no signs are given, all signs are tried on sheets with up to this many vertices."""
_SMALL = 200
"""Several starts are tried on sheets with up to this many unknowns."""
_SAME = 1e-6
_OFF = 1e-6
"""The first-order angles of a branch may miss the ratio of a drive by this share of the largest."""


class DriveDocument(TypedDict):
    """The folds by which a branch was found."""

    folds: Goals
    """By driven fold i-j the angle to which it would be driven."""
    side: Side
    """With four corners, on which side of the branch the fold goes so."""
    status: ProvedOrNot
    """Whether a solution with exactly this ratio of first-order angles is proved, with these
    vertex signs."""


class DrivenBranchDocument(BranchDocument):
    """A branch that was found by the folds that are driven."""

    drive: DriveDocument


@dataclass(frozen=True, repr=False)
class Driven:
    """A branch on which driven folds start in their ratio, and the side on which they do.

    `branch` is proved. With more than four corners, its boundary heights are those with which the
    driven motion starts, rounded to nine places; so the branch shows this start approximately.
    `others` is the number of further solutions that were found with the same signs; their folds
    bend more.
    """

    branch: Branch
    side: int
    drive: PrescribedAngles
    others: int = 0

    @cached_property
    def status(self) -> Verdict:
        """Whether a solution with exactly this ratio and these vertex signs is proved.

        Floating point says that this solution is the one that `branch` approximates.
        """
        branch = self.branch
        if branch.status is not PROVED or len(self.drive.folds) == 1:
            return branch.status
        problem, heights = problem_of(branch), branch.approx_heights
        try:
            start = prove_start(
                framework_of(problem, None, self.drive),
                problem.gauge,
                self.side * np.array([heights[v] for v in problem.labels]),
                ways=self.drive.ways(problem.labels),
            )
        except NotProvedAtTheFlatStateError:
            return UNDECIDED
        signs = tuple(self.side * branch.vertex_signs[v] for v in problem.foldable)
        return PROVED if start.vertex_signs == signs else UNDECIDED

    def to_dict(self, name: str | None = None) -> DrivenBranchDocument:
        """The object printed by `exactfold branch --drive --json`: `schema("branch")`."""
        return {
            **self.branch.to_dict(name),
            "drive": {
                "folds": self.drive.to_dict(),
                "side": self.side,
                "status": str(self.status),
            },
        }

    def __repr__(self) -> str:
        return f"<Driven: branch {self.branch.sign_text}, {self.drive.text}>"


def find_driven(
    pattern: PatternLike,
    angles: Mapping[Edge, float | None],
    signs: Signs | None = None,
    *,
    boundary_heights: BoundaryHeights | None = None,
    side: int | None = None,
    progress: Progress | None = None,
) -> Driven:
    """The branch with given vertex signs on which chosen folds start to fold in a given ratio.

    `angles` gives, for each of D = Ve - 3 folds of a sheet with Ve boundary vertices, the angle in
    degrees to which it is driven, positive for a valley. To first order the angles of the folds are
    in the ratio of the sines of half of these angles (`PrescribedAngles`). If an angle is None, it
    is the angle that the fold has, relative to the other folds, on the branch with the boundary
    heights `boundary_heights`, by default those of `find_branch`. `signs` are given as in
    `find_branch`, for the branch as it is driven; without them, the first branch found is taken.

    With more than four corners, Newton's method finds the branch from the branch over
    `boundary_heights`. There may be several branches with these signs and this ratio, because a
    line meets a cone in two points. Without a `boundary_heights`, and with up to 200 unknowns,
    eight starts are used. Among the branches found, the one whose folds together bend least, by the
    sum of squares, is taken. With four corners a single fold is driven, and `side` may be
    prescribed as in `follow`.

    Raises `BadDriveError` for folds or angles that cannot be driven, `NotFollowedError` if no
    branch is found (which does not show that there is none), and the errors of `find_branch`.

    >>> from exactfold.pattern.families import single_vertex
    >>> driven = find_driven(single_vertex(5), {(0, 5): 90, (2, 5): 60})
    >>> driven, driven.branch.status
    (<Driven: branch +, 0-5 to 90, 2-5 to 60 degrees>, <Verdict.PROVED: 'proved'>)
    """
    sheet = as_pattern(pattern)
    finder = branch_finder(sheet, boundary_heights)
    asked = None if signs is None else finder.signs(signs, None)
    search = _DrivenSearch(finder, angles, side, boundary_heights is not None, progress)
    search.check()
    for each in [asked] if asked is not None else _all_signs(finder):
        driven = search.found(each)
        if driven is not None:
            return driven
    raise search.failure(asked)


def off_the_ratio(branch: Branch, side: int, drive: PrescribedAngles) -> float:
    """How far the first-order fold angles of a branch miss the ratio of a drive, over the largest.

    The result is 0 if they have the ratio, and 1 or more if some fold goes the other way.
    """
    angles = branch.fold_angles.degrees(1.0)
    there = side * np.array([angles[fold] for fold in drive.folds])
    wanted = np.array(drive.sines)
    factor = float(there @ wanted) / float(wanted @ wanted)
    if not factor > 0:
        return 1.0
    return float(np.abs(there / factor - wanted).max() / np.abs(wanted).max())


def require_driven(branch: Branch, side: int, drive: PrescribedAngles) -> None:
    """Raise `BadDriveError` unless the folds of a drive start in its ratio on a ray."""
    unknown = [fold for fold in drive.folds if fold not in branch.pattern.folds]
    if unknown:
        raise BadDriveError(not_a_fold(branch.pattern.edges, unknown[0], "to drive"), unknown)
    number = problem_of(branch).sheet.Ve - 3
    if len(drive.folds) != number or not off_the_ratio(branch, side, drive) < _OFF:
        raise BadDriveError(
            f"the folds {', '.join(map(fold_text, drive.folds))} cannot be driven on this branch: "
            f"this sheet needs {counted(number, 'driven fold')}, and they have to start in the "
            "ratio of their angles; `find_driven` finds a branch on which they do",
            drive.folds,
        )


def _all_signs(finder: BranchFinder) -> Iterator[dict[int, int]]:
    """All vertices up, then all down; with few vertices, all other signs after these."""
    names = finder.poppable
    first = [(1,) * len(names), (-1,) * len(names)]
    others = product((1, -1), repeat=len(names)) if len(names) <= _TRIED else iter(())
    for values in [*first, *(v for v in others if v not in first)]:
        yield dict(zip(names, values, strict=True))


@dataclass
class _DrivenSearch:
    finder: BranchFinder
    angles: Mapping[Edge, float | None]
    side: int | None
    boundary_given: bool
    progress: Progress | None

    @property
    def pattern(self) -> CreasePattern:
        return self.finder.pattern

    @cached_property
    def problem(self) -> Problem:
        return self.finder.problem

    @cached_property
    def on(self) -> DrivenFolds:
        return DrivenFolds(self.finder.problem, self.angles)

    @property
    def folds(self) -> tuple[Edge, ...]:
        return tuple(self.angles)

    def check(self) -> None:
        """Raise `BadDriveError` for folds that do not exist or cannot be driven."""
        sheet = self.problem.sheet
        own = {tuple(sorted(self.problem.labels[v] for v in fold)) for fold in sheet.folds}
        for fold in self.folds:
            if fold not in self.pattern.folds:
                raise BadDriveError(not_a_fold(self.pattern.edges, fold, "to drive"), [fold])
            if fold not in own:
                raise BadDriveError(
                    f"fold {fold_text(fold)} lies inside a triangulated triangle and stays flat",
                    [fold],
                )
        given = {fold: angle for fold, angle in self.angles.items() if angle is not None}
        PrescribedAngles.of(given)
        freedom = sheet.Ve - 3
        if len(self.folds) > freedom:
            raise BadDriveError(
                f"{counted(len(self.folds), 'fold')} cannot be driven at once: this sheet has "
                f"{sheet.Ve} boundary vertices, so give at most {counted(freedom, 'fold')}",
                self.folds[freedom:],
            )

    def found(self, signs: Mapping[int, int]) -> Driven | None:
        """The driven branch with these signs, or None if it is not found."""
        if self.problem.sheet.Ve == 4:
            return self._of_two_sides(signs)
        solutions: list[FloatArray] = []
        drive: PrescribedAngles | None = None
        dependent: list[BadDriveError] = []
        for start in self._starts:
            try:
                solution = self._from(start, signs, drive)
            except BadDriveError as error:  # on one branch by chance, or on all
                dependent.append(error)
                continue
            if solution is None:
                continue
            drive, y = solution
            if all(np.abs(y - x).max() > _SAME * np.abs(x).max() for x in solutions):
                solutions.append(y)
            if self.on.framework.size > _SMALL:
                break
        if len(dependent) == len(self._starts):
            raise dependent[0]
        if drive is None:
            return None
        best = min(solutions, key=self.on.bending)
        near = BranchFinder(self.pattern, self.on.boundary_of(best)).find(
            signs, progress=self.progress
        )
        if not near.approx_heights or off_the_ratio(near, 1, drive) > _OFF:
            return None
        return Driven(near, 1, drive, len(solutions) - 1)

    @cached_property
    def _starts(self) -> list[BranchFinder]:
        """Finders with the given boundary heights; if none are given, with several choices."""
        if self.boundary_given:
            return [self.finder]
        return [self.finder] + [
            BranchFinder(self.pattern, boundary_heights)
            for boundary_heights in saddle_boundary_heights(self.pattern)[1:]
        ]

    def _from(
        self, finder: BranchFinder, signs: Mapping[int, int], drive: PrescribedAngles | None
    ) -> tuple[PrescribedAngles, FloatArray] | None:
        """The drive, and a solution that Newton's method finds from the branch of a finder.

        `drive` is completed if it is not known yet.
        """
        branch = finder.find(signs, progress=self.progress)
        if not branch.approx_heights:
            return None
        heights = branch.approx_heights
        start = self.on.unknowns(np.array([heights[v] for v in self.problem.labels]))
        self.on.require_independent(start)
        drive = drive or self.on.completed(start)
        if drive is None:
            return None
        reached = self.on.reached(start, np.array(drive.sines))
        if reached is None or self.on.signs_at(reached) != self.on.signs_of(signs):
            return None
        return drive, reached

    def failure(self, signs: Mapping[int, int] | None) -> NotFollowedError:
        """The error that says why nothing was found, and which ratio came closest if that
        is known.
        """
        names = ", ".join(map(fold_text, self.folds))
        which = "any signs that were tried" if signs is None else "these signs"
        text = f"no branch with {which} was found on which the folds {names} start in this ratio"
        if signs is not None and self.on.farthest is not None:
            largest = np.abs(self.on.farthest).max()
            there = ", ".join(f"{x:.4g}" for x in (self.on.farthest / largest).tolist())
            text += f"; the nearest ratio that was found is {there}"
        elif signs is not None and self.problem.sheet.Ve == 4:
            text += ": the fold goes the other way, or stays flat"
        return NotFollowedError(text, self.folds)

    # --- four corners ----------------------------------------------------------------------------

    def _of_two_sides(self, signs: Mapping[int, int]) -> Driven | None:
        """The ray with these signs on which the single fold goes the right way.

        There are two candidates: a ray of the branch with these signs, and the mirror image of a
        ray of the branch with the opposite signs.
        """
        if not self.folds:
            raise BadDriveError("name a fold to drive")
        [(fold, angle)] = self.angles.items()
        for side in (1, -1) if self.side is None else (self.side,):
            branch = self.finder.find({v: side * s for v, s in signs.items()})
            letter = branch.assignment[fold]
            if letter not in "MV" or not branch.approx_heights:
                continue
            way = side if letter == "V" else -side
            if angle is None or way * angle > 0:
                return Driven(branch, side, PrescribedAngles.of({fold: angle or 180 * way}))
        return None
