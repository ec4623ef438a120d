"""`find_driven`: the branch along which chosen folds start with angles in a given ratio."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from exactfold.arrays import FloatArray
from exactfold.branches.branch import Branch
from exactfold.count.find import BranchFinder, Rim, Signs, branch_finder
from exactfold.errors import BadDriveError, NotDrivenError
from exactfold.motion.drive import Drive, fold_text
from exactfold.motion.framework import Framework
from exactfold.motion.rim_path import problem_of, ties_of
from exactfold.motion.start import blown_up, blown_up_jacobian, heights_above_the_pin
from exactfold.pattern.crease_pattern import CreasePattern, Edge, Triangle
from exactfold.pattern.loading import PatternLike, as_pattern
from exactfold.problem.problem import Problem
from exactfold.progress import Progress
from exactfold.rigidity.functionals import fold_functional, vertex_sign_functional
from exactfold.wording import counted

if TYPE_CHECKING:
    from scipy.sparse import csc_array

_RIM_BITS = 48
_TRIED = 8
"""Vertices up to which all signs are tried where none are given."""
_NEWTON = 12
_SHORTEST = 1e-3
_DEPENDENT = 1e-9
_STILL = 1e-9
_ROUND = 10**6
_OFF = 1e-6


@dataclass(frozen=True, repr=False)
class Driven:
    """A branch on which driven folds start in their ratio, and the side on which they do.

    `branch` is proved. With more than four corners its border has the heights of the way the driven
    motion starts, rounded: it shows this start with an error of about 1e-12.
    """

    branch: Branch
    side: int
    drive: Drive

    def __repr__(self) -> str:
        return f"<Driven: branch {self.branch.sign_text}, {self.drive.text}>"


def find_driven(
    pattern: PatternLike,
    angles: Mapping[Edge, float | None],
    signs: Signs | None = None,
    *,
    rim: Rim | None = None,
    side: int | None = None,
    progress: Progress | None = None,
) -> Driven:
    """The branch with given vertex signs on which chosen folds start to fold in a given ratio.

    `angles`: by fold the angle in degrees to which it is driven, positive for a valley; D = Ve - 3
    folds of a sheet with Ve boundary vertices. To first order their angles are in the ratio of the
    sines of half of these (`Drive`). None for an angle: the one that the fold has beside the others
    on the branch with the border heights `rim`, by default those of `find_branch`. `signs`: as in
    `find_branch`, of the branch as it is driven; if not given, the first found. With more than four
    corners the branch is found from that with the rim, by Newton's method; others with these signs
    and this ratio are not looked for. With four corners there is one fold to drive, and `side` may
    be asked for as in `follow`.

    Raises `BadDriveError` for folds or angles that cannot be driven, `NotDrivenError` where no
    branch is found, which does not say that there is none, and the errors of `find_branch`.

    >>> from exactfold.pattern.families import single_vertex
    >>> driven = find_driven(single_vertex(5), {(0, 5): 90, (2, 5): 60})
    >>> driven, driven.branch.status
    (<Driven: branch +, 0-5 to 90, 2-5 to 60 degrees>, <Verdict.PROVED: 'proved'>)
    """
    sheet = as_pattern(pattern)
    finder = branch_finder(sheet, rim)
    asked = None if signs is None else finder.signs(signs, None)
    search = _Search(finder, angles, side, rim is not None, progress)
    search.check()
    for each in [asked] if asked is not None else _all_signs(finder):
        found = search.found(each)
        if found is not None:
            return found
    raise search.failure(asked)


def off_the_ratio(branch: Branch, side: int, drive: Drive) -> float:
    """How far first-order fold angles of a branch are from the ratio of a drive, of the largest.

    0 if they are, 1 or more if some fold goes the other way.
    """
    angles = branch.fold_angles.degrees(1.0)
    there = side * np.array([angles[fold] for fold in drive.folds])
    wanted = np.array(drive.sines)
    factor = float(there @ wanted) / float(wanted @ wanted)
    if not factor > 0:
        return 1.0
    return float(np.abs(there / factor - wanted).max() / np.abs(wanted).max())


def require_driven(branch: Branch, side: int, drive: Drive) -> None:
    """Raise `BadDriveError` unless the folds of a drive start in its ratio on a half-branch."""
    unknown = [fold for fold in drive.folds if fold not in branch.pattern.folds]
    if unknown:
        raise BadDriveError(f"there is no fold {fold_text(unknown[0])} to drive", unknown)
    number = problem_of(branch).sheet.Ve - 3
    if len(drive.folds) != number or not off_the_ratio(branch, side, drive) < _OFF:
        raise BadDriveError(
            f"the folds {', '.join(map(fold_text, drive.folds))} do not start in the ratio of "
            "their angles on this branch, or are not as many as can be driven: find one by "
            "`find_driven`",
            drive.folds,
        )


def framework_of(
    problem: Problem, pinned: Triangle | None = None, drive: Drive | None = None
) -> Framework:
    """The framework of a problem, with a drive or else with the ties of the rim path."""
    if drive is None:
        return Framework.of(problem.sheet, pinned, ties_of(problem))
    place = {label: v for v, label in enumerate(problem.labels)}
    coupling = drive.coupling(problem.sheet, place)
    return Framework.of(problem.sheet, pinned, coupling=coupling)


def _all_signs(finder: BranchFinder) -> Iterator[dict[int, int]]:
    """All up first, then all down; for few vertices all others after them."""
    names = finder.poppable
    first = [(1,) * len(names), (-1,) * len(names)]
    others = product((1, -1), repeat=len(names)) if len(names) <= _TRIED else iter(())
    for values in [*first, *(v for v in others if v not in first)]:
        yield dict(zip(names, values, strict=True))


@dataclass
class _Search:
    finder: BranchFinder
    angles: Mapping[Edge, float | None]
    side: int | None
    rim_given: bool
    progress: Progress | None
    farthest: FloatArray | None = None

    @property
    def pattern(self) -> CreasePattern:
        return self.finder.pattern

    @cached_property
    def problem(self) -> Problem:
        return self.finder.problem

    @cached_property
    def framework(self) -> Framework:
        return Framework.of(self.problem.sheet)

    @property
    def folds(self) -> tuple[Edge, ...]:
        return tuple(self.angles)

    @cached_property
    def place(self) -> dict[int, int]:
        return {label: v for v, label in enumerate(self.problem.labels)}

    def check(self) -> None:
        """Raise `BadDriveError` for folds that are not there, or cannot be driven."""
        sheet = self.problem.sheet
        own = {tuple(sorted(self.problem.labels[v] for v in fold)) for fold in sheet.folds}
        for fold in self.folds:
            if fold not in self.pattern.folds:
                raise BadDriveError(f"there is no fold {fold_text(fold)} to drive", [fold])
            if fold not in own:
                raise BadDriveError(
                    f"fold {fold_text(fold)} lies in a triangulated triangle, which stays flat",
                    [fold],
                )
        given = {fold: angle for fold, angle in self.angles.items() if angle is not None}
        Drive.of(given)
        freedom = sheet.Ve - 3
        if len(self.folds) > freedom:
            raise BadDriveError(
                f"{counted(len(self.folds), 'fold')} to drive: this sheet has {sheet.Ve} border "
                f"vertices, and {counted(freedom, 'fold')} can be driven at once",
                self.folds[freedom:],
            )

    def found(self, signs: Mapping[int, int]) -> Driven | None:
        """The branch with these signs, if it is found."""
        if self.problem.sheet.Ve == 4:
            return self._of_two_sides(signs)
        for start in self._starts:
            found = self._from(start, signs)
            if found is not None:
                return found
        return None

    @property
    def _starts(self) -> Iterator[BranchFinder]:
        """With the rim that is given, or with the one that was chosen and with its mirror image."""
        yield self.finder
        if not self.rim_given and self.finder.rim is not None:
            opposite = {v: -Fraction(h) for v, h in self.problem.gauge.rim.items()}
            yield BranchFinder(self.pattern, opposite)

    def _from(self, finder: BranchFinder, signs: Mapping[int, int]) -> Driven | None:
        """The branch found from that of a finder."""
        branch = finder.find(signs, progress=self.progress)
        if not branch.approx_heights:
            return None
        heights = branch.approx_heights
        start = self._unknowns(np.array([heights[v] for v in self.problem.labels]))
        self._require_independent(start)
        drive = self._completed(start)
        if drive is None:
            return None
        reached = self._reached(start, np.array(drive.sines))
        if reached is None or self._signs_at(reached) != self._signs_of(signs):
            return None
        rim = self._rim_of(reached)
        near = BranchFinder(self.pattern, rim).find(signs, progress=self.progress)
        if not near.approx_heights or off_the_ratio(near, 1, drive) > _OFF:
            return None
        return Driven(near, 1, drive)

    def failure(self, signs: Mapping[int, int] | None) -> NotDrivenError:
        """Why nothing was found, with what the branch of the rim does."""
        names = ", ".join(map(fold_text, self.folds))
        which = "any signs that were tried" if signs is None else "these signs"
        text = f"no branch with {which} was found on which the folds {names} start in this ratio"
        if signs is not None and self.farthest is not None:
            largest = np.abs(self.farthest).max()
            there = ", ".join(f"{x:.4g}" for x in (self.farthest / largest).tolist())
            text += f"; the nearest that was met is {there}"
        elif signs is not None and self.problem.sheet.Ve == 4:
            text += ": the fold goes the other way, or stays flat"
        return NotDrivenError(text, self.folds)

    # --- four corners ----------------------------------------------------------------------------

    def _of_two_sides(self, signs: Mapping[int, int]) -> Driven | None:
        """The half-branch with these signs on which the one fold goes the right way.

        There are two: that of the branch with these signs, and the mirror image of the opposite.
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
                return Driven(branch, side, Drive.of({fold: angle or 180 * way}))
        return None

    # --- more corners ----------------------------------------------------------------------------

    @cached_property
    def _bends(self) -> FloatArray:
        """First-order angles of all folds of the sheet of the framework, rows on its unknowns.

        In the order of `sheet.folds`, from the heights above the pinned triangle.
        """
        sheet, framework = self.problem.sheet, self.framework
        unit = float(framework.unit)
        column = {int(v): 3 * k + 2 for k, v in enumerate(framework.free)}
        rows = np.zeros((len(sheet.folds), framework.size))
        for row, (i, j) in zip(rows, sheet.folds, strict=True):
            bend = fold_functional(sheet, (i, j))
            left = sheet.opposite((i, j))[0]
            (ax, ay), (bx, by), (px, py) = (
                tuple(float(c) / unit for c in sheet.vertices[v]) for v in (i, j, left)
            )
            area = (bx - ax) * (py - ay) - (by - ay) * (px - ax)
            scale = np.hypot(bx - ax, by - ay) / abs(area) / float(bend[left])
            for v, c in bend.items():
                if v in column:
                    row[column[v]] = c * scale
        return rows

    @cached_property
    def _driven_rows(self) -> FloatArray:
        folds = self.problem.sheet.folds
        place = self.place
        at = [folds.index((min(place[i], place[j]), max(place[i], place[j]))) for i, j in self.folds]
        return np.asarray(self._bends[at])

    def _unknowns(self, heights: FloatArray) -> FloatArray:
        """(u, h) with second-order plane displacements, by Newton's method in u alone."""
        framework = self.framework
        y = np.zeros((len(framework.free), 3))
        above = heights_above_the_pin(framework, heights)
        y[:, 2] = (above / np.abs(above).max())[framework.free]
        return y.reshape(-1)

    def _require_independent(self, y: FloatArray) -> None:
        """Raise where the driven folds do not determine the others, to first order, at y."""
        freedom = self.problem.sheet.Ve - 3
        tangents = self._tangents(y)
        rates = self._driven_rows @ tangents
        rates = rates / np.maximum(np.linalg.norm(rates, axis=1, keepdims=True), 1e-300)
        for k in range(1, len(rates) + 1):
            if np.linalg.svd(rates[:k], compute_uv=False)[-1] < _DEPENDENT:
                raise BadDriveError(
                    f"fold {fold_text(self.folds[k - 1])} cannot be driven with "
                    f"{', '.join(map(fold_text, self.folds[: k - 1]))}: to first order its angle "
                    "depends on theirs",
                    [self.folds[k - 1]],
                )
        if len(rates) < freedom:
            more = ", ".join(map(fold_text, self._others(tangents, rates)))
            raise BadDriveError(
                f"{counted(len(rates), 'fold')} to drive: this sheet has "
                f"{counted(freedom, 'degree')} of freedom, and as many folds have to be named; "
                f"for instance also {more} (a fold without an angle goes along in the ratio that "
                "it has on the branch)",
                self.folds,
            )

    def _tangents(self, y: FloatArray) -> FloatArray:
        """The directions (u, h) of all solutions at y, shape (unknowns, D)."""
        jacobian = blown_up_jacobian(self.framework, y).toarray()
        freedom = self.problem.sheet.Ve - 3
        return np.asarray(np.linalg.svd(jacobian)[2][-freedom:].T)

    def _others(self, tangents: FloatArray, rates: FloatArray) -> list[Edge]:
        """Folds to drive as well, each the one that is farthest from depending on those before."""
        basis = np.linalg.svd(rates, full_matrices=True)[2]
        free = basis[len(rates) :]
        folds, labels, found = self.problem.sheet.folds, self.problem.labels, []
        moves = self._bends @ tangents
        while len(free):
            best = int(np.argmax(np.linalg.norm(moves @ free.T, axis=1)))
            i, j = sorted(labels[v] for v in folds[best])
            found.append((i, j))
            direction = free @ moves[best]
            free = np.linalg.svd(direction[None])[2][1:] @ free
        return found

    def _completed(self, y: FloatArray) -> Drive | None:
        """The drive, with the angles of the branch at y for folds that have none.

        None where a fold is still on that branch, or would go farther than 180 degrees.
        """
        there = self._driven_rows @ y
        given = {fold: a for fold, a in self.angles.items() if a is not None}
        own = Drive.of(given)
        wanted = dict(zip(own.folds, own.sines, strict=True))
        if len(given) == len(self.folds):
            return own
        if np.abs(there).min() < _STILL * np.abs(there).max():
            return None
        beside = [(there[k], wanted[f]) for k, f in enumerate(self.folds) if f in wanted]
        factor = 1 / float(np.abs(there).max())
        if beside:
            factor = sum(a * s for a, s in beside) / sum(a * a for a, _ in beside)
        if not factor > 0:
            return None
        squares = []
        for fold, angle in zip(self.folds, there.tolist(), strict=True):
            if fold in wanted:
                squares.append(own.squares[own.folds.index(fold)])
                continue
            sine = factor * angle
            square = Fraction(min(sine * sine, 2.0)).limit_denominator(_ROUND)
            if not 0 < square <= 1:
                return None
            squares.append(square if sine > 0 else -square)
        return Drive(self.folds, tuple(squares))

    def _reached(self, y: FloatArray, wanted: FloatArray) -> FloatArray | None:
        """The solution in which the driven folds are `wanted`, followed from that at y."""
        there = self._driven_rows @ y
        factor = np.linalg.norm(wanted) / np.linalg.norm(there)
        y, there = y * factor, there * factor
        y = self._solved(y, there)
        if y is None:
            return None
        signs, at, step = self._signs_at(y), 0.0, 0.25
        self.farthest = there
        while at < 1.0:
            until = min(1.0, at + step)
            tried = self._solved(y, (1 - until) * there + until * wanted)
            if tried is None or self._signs_at(tried) != signs:
                step /= 2
                if step < _SHORTEST:
                    return None
                continue
            y, at, step = tried, until, 2 * step
            self.farthest = self._driven_rows @ y
        return y

    def _solved(self, y: FloatArray, goal: FloatArray) -> FloatArray | None:
        from scipy.sparse import csc_array, vstack
        from scipy.sparse.linalg import splu

        framework, rows = self.framework, csc_array(self._driven_rows)
        for k in range(_NEWTON):
            jacobian: csc_array = vstack([blown_up_jacobian(framework, y), rows], format="csc")
            right = np.append(-blown_up(framework, y), goal - self._driven_rows @ y)
            try:
                step = splu(jacobian).solve(right)
            except RuntimeError:
                return None
            size = float(np.abs(step).max() / max(1.0, np.abs(y).max()))
            if not size < 10:
                return None
            y = y + step
            if size < 1e-14 or (k > 3 and size < 1e-12):
                return y
        return None

    def _signs_at(self, y: FloatArray) -> tuple[bool, ...]:
        heights = self.framework.displacement(y)[:, 2]
        return tuple(
            sum(float(c) * heights[w] for w, c in row.items()) > 0 for row in self._sign_rows
        )

    @cached_property
    def _sign_rows(self) -> list[dict[int, int]]:
        sheet = self.problem.sheet
        return [vertex_sign_functional(sheet, v) for v in sheet.interior]

    def _signs_of(self, signs: Mapping[int, int]) -> tuple[bool, ...]:
        return tuple(signs[self.problem.labels[v]] > 0 for v in self.problem.sheet.interior)

    def _rim_of(self, y: FloatArray) -> dict[int, Fraction]:
        """The heights of the border at a solution, rounded, the largest 1."""
        heights = self.framework.displacement(y)[:, 2]
        border = {self.problem.labels[v]: heights[v] for v in self.problem.sheet.boundary}
        largest = max(abs(h) for h in border.values())
        one = 1 << _RIM_BITS
        return {v: Fraction(round(h / largest * one), one) for v, h in border.items()}
