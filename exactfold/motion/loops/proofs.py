"""Loops from the flat state along a ray and back along another ray, and their proofs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from itertools import zip_longest
from typing import Annotated, TypedDict

from exactfold._support.documents import Fold, Keywords, Natural, NotNegative, Pair, ProvedOrNot
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.certificates.entries import CertificateLines, Document
from exactfold.errors import NotCountedError
from exactfold.exact.numbers import format_rational
from exactfold.motion.claims import Claim
from exactfold.motion.contacts.fold_ranges import SLACK, FoldRange, FoldRangeDocument, fold_ranges
from exactfold.motion.contacts.stretches import on_branch_point_tube, on_start_tube, on_tube
from exactfold.motion.curves.boundary_path import boundary_claim
from exactfold.motion.curves.motion_document import RayDocument
from exactfold.motion.loops.certificate import claims_line, header_line, loop_line
from exactfold.motion.loops.rays import Ray
from exactfold.motion.tubes.arclength import Interval, in_floats
from exactfold.motion.tubes.branch_point_tube import BranchPointTube
from exactfold.motion.tubes.certificate import (
    first_document,
    flat_document,
    motion_certificate,
)
from exactfold.motion.tubes.chain import Step, chords, step_documents
from exactfold.motion.tubes.links import Link
from exactfold.motion.tubes.passages import Passage, through_claim
from exactfold.motion.tubes.piece import PARAMETER_BITS, Ball
from exactfold.motion.tubes.tube_start import StartTube
from exactfold.motion.tubes.visits import Visit
from exactfold.rigidity.equations.problem import Problem


class FlatVertices(TypedDict):
    """A branch point on the way, by the vertices that are flat there."""

    flat: list[Natural]


class Winding(TypedDict):
    """A fold that winds."""

    fold: Fold
    turns: Annotated[int, Keywords(**{"not": {"const": 0}})]
    """By how many whole turns the fold angle has grown at the end of the loop, proved."""


_From = TypedDict("_From", {"from": RayDocument})


class LoopDocument(_From):
    """A motion from the flat state back to it."""

    to: RayDocument | None
    through: list[FlatVertices]
    """Branch points on the way."""
    length: Pair[NotNegative]
    """Proved bounds of the length, in the unit of the sheet."""
    status: ProvedOrNot
    reason: str
    tubes: Natural
    windings: list[Winding]
    """None for a loop that is not proved to its end."""
    angles: list[FoldRangeDocument]
    """Of every fold, followed continuously from 0, valley positive; empty for a loop that is not
    proved to its end."""


@dataclass(frozen=True, repr=False)
class Landing:
    """Where a motion comes back to the flat state: a point of the start tube lies on the last tube.

    `start` is the start tube of the ray `to`. At `tau` it passes the last tube in the opposite
    direction, so the motion ends in the flat state along `to`. If `tau` is negative, this is on the
    mirror image of `start`.
    """

    to: Ray
    start: StartTube
    tau: int

    @property
    def ball(self) -> Ball:
        """A box of unknowns of the length equations that contains the configuration at `tau`."""
        return self.start.ball(self.tau)

    def __repr__(self) -> str:
        return f"<Landing: {self.to}>"


@dataclass(frozen=True, repr=False)
class Loop:
    """The true configurations from the flat state along `source` and back to it along `target`.

    `through` are the vertices that are flat at each branch point on the way, in order. `visits` say
    where and when these points are passed. `length` are bounds of the length in the unit of the
    sheet. If `status` is UNDECIDED, `length` is that of the proved part, `target` is None, and
    `reason` says what stopped the proof. `tubes` is the number of pieces of the proof. `folds` are
    the ranges of the angles of all folds; it is empty in an outline, and if the status is UNDECIDED
    or some range was not proved.
    """

    source: Ray
    target: Ray | None
    through: tuple[tuple[int, ...], ...]
    length: Interval
    status: Verdict
    reason: str
    tubes: int
    visits: tuple[Visit, ...] = ()
    folds: tuple[FoldRange, ...] = ()

    @property
    def ends(self) -> set[Ray]:
        """The rays that the loop and its mirror image match."""
        ends = {self.source, self.source.mirrored}
        return ends if self.target is None else ends | {self.target, self.target.mirrored}

    def to_dict(self) -> LoopDocument:
        """The object of this loop in the output of `exactfold motions --json`."""
        return {
            "from": self.source.to_dict(),
            "to": None if self.target is None else self.target.to_dict(),
            "through": [{"flat": list(vertices)} for vertices in self.through],
            "length": list(in_floats(self.length)),
            "status": str(self.status),
            "reason": self.reason,
            "tubes": self.tubes,
            "windings": [
                {"fold": list(fold.fold), "turns": fold.turns} for fold in self.folds if fold.turns
            ],
            "angles": [fold.to_dict() for fold in self.folds],
        }

    def __repr__(self) -> str:
        return f"<Loop: {self.source} to {self.target}, {self.status}>"


@dataclass(frozen=True, repr=False)
class LoopProof:
    """One analytic curve of configurations from `start` through `steps` to `landing`.

    It has no gap. Without a `landing` it ends after the last step, and `reason` says why.
    """

    problem: Problem
    start: StartTube
    steps: tuple[Step, ...]
    landing: Landing | None
    reason: str

    @cached_property
    def loop(self) -> Loop:
        """The loop that is proved."""
        return replace(self.outline, folds=self._folds())

    @cached_property
    def outline(self) -> Loop:
        """The loop without the ranges of the fold angles, which take time to compute."""
        landing, unit = self.landing, self.start.framework.unit
        low, high = self.steps[-1].left if self.steps else self.start.length(0, self.start.last)
        if landing is not None:
            low, high = whole_length(self.steps[-1], landing)
        return Loop(
            named(self.start),
            None if landing is None else landing.to,
            tuple(step.vertices for step in self.steps if isinstance(step, Passage)),
            (low * unit, high * unit),
            UNDECIDED if landing is None else PROVED,
            self.reason,
            len(self.steps) + 1,
            tuple(step.visit(unit) for step in self.steps if isinstance(step, Passage)),
        )

    def _folds(self) -> tuple[FoldRange, ...]:
        """The ranges of the fold angles on the loop; empty without a landing."""
        if self.landing is None:
            return ()
        chain = [on_start_tube(self.start, 0, self.start.last)]
        vague = 0
        for step, after in zip_longest(self.steps, self.steps[1:]):
            if isinstance(step, Passage):
                chain.append(on_branch_point_tube(step.tube, step.entry, step.exit))
                continue
            # The stretch ends at the point that lies on the next piece, known up to its box.
            end = step.exit
            vague = max(vague, step.entry[1] - step.entry[0])
            if not isinstance(after, Link):
                ball = self.landing.ball if after is None else after.tube.ball(after.entry)
                parameters = step.tube.located(ball)
                if parameters is None:
                    raise ArithmeticError("a loop has a gap")
                end = parameters[1]
                vague = max(vague, end - parameters[0])
            chain.append(on_tube(step.tube, step.entry[0], end))
        if vague >= SLACK * (1 << PARAMETER_BITS):
            return ()
        chain.append(on_start_tube(self.landing.start, self.landing.tau, 0))
        framework, labels = self.start.framework, self.problem.labels
        names = [
            (min(labels[i], labels[j]), max(labels[i], labels[j])) for i, j in framework.sheet.folds
        ]
        return fold_ranges(framework, chain, names) or ()

    def line(self) -> str:
        """The line of a loop that is proved to its end, for the checker (docs/motion.md, 15).

        It claims a length slightly smaller than that of the loop, namely what straight chords show.
        Raises `NotCountedError` for a loop without a landing.
        """
        if self.landing is None:
            raise NotCountedError(f"the loop is not proved to its end: {self.reason}")
        landing, loop, unit = self.landing, self.loop, self.start.framework.unit
        length = chords(self.start, self.steps, leaves=False, landing=landing.ball)
        return loop_line(
            self._named(loop.source),
            self._named(landing.to),
            format_rational(length * unit),
            {
                "start": first_document(self.problem.labels, self.start),
                "steps": step_documents(self.steps, leaves=False),
                "landing": self._landed(landing),
            },
            provenance_of(loop),
        )

    def lines(self) -> CertificateLines:
        """A file with this loop alone, for `exactfold.checker`; raises as `line`."""
        pinned = [self.problem.labels[v] for v in self.start.framework.pinned]
        return CertificateLines(
            (
                header_line(self.problem.pattern, pinned, self.start.bits),
                self.line(),
                claims_line(self.problem.pattern, 1, len(self.outline.ends)),
            )
        )

    def certificate(self, boundary_heights: Mapping[int, Fraction]) -> Document:
        """The proof of a motion there and back along the path of `boundary_heights`.

        See docs/motion.md, 9. This is a single motion, not one of the loops that match all rays of
        a sheet. Raises `NotCountedError` as `line` does.
        """
        if self.landing is None:
            raise NotCountedError(f"the motion is not proved to its end: {self.reason}")
        claims = [boundary_claim(boundary_heights), self._return_claim(self.landing)]
        passed = [step for step in self.steps if isinstance(step, Passage)]
        if passed:
            claims.append(through_claim(passed))
        return motion_certificate(
            self.problem.pattern,
            self.problem.labels,
            self.start,
            self.steps,
            claims,
            landing=self.landing.ball,
        )

    def _return_claim(self, landing: Landing) -> Claim:
        """That the motion ends in the flat state, and along which ray."""
        return Claim({"return": self._named(landing.to)}, {"landing": self._landed(landing)})

    def _landed(self, landing: Landing) -> Document:
        return {**flat_document(self.problem.labels, landing.start), "tau": landing.tau}

    def _named(self, ray: Ray) -> Document:
        """A ray, given by the signs of all interior vertices of the pattern."""
        signs = dict(zip(self.problem.foldable, ray.vertex_signs, strict=True))
        interior = self.problem.pattern.interior
        return {"vertex_signs": [signs.get(v, 0) for v in interior], "side": ray.saddle}

    def __repr__(self) -> str:
        return f"<LoopProof: {len(self.steps)} steps, {self.outline!r}>"


@dataclass(frozen=True, repr=False)
class Arc:
    """A curve of regular configurations from a branch point to the next one, or to the flat state.

    It leaves the branch point of the visit `begin` in the direction of this visit. It ends with the
    visit `end` of another branch point, or in the flat state along the ray `end`. If `end` is None,
    it is proved only as far as `length`, for the given `reason`. `length` is in the unit of the
    sheet.
    """

    begin: Visit
    end: Visit | Ray | None
    length: Interval
    reason: str
    tubes: int

    def __repr__(self) -> str:
        return f"<Arc: from {self.begin!r} to {self.end!r}>"


@dataclass(frozen=True, repr=False)
class ArcProof:
    """One analytic curve of configurations from the middle of `begin` through `steps`.

    It has no gap. It ends in the flat state with `landing`, or at the branch point of the last
    step, or for `reason`.
    """

    begin: BranchPointTube
    steps: tuple[Step, ...]
    landing: Landing | None
    reason: str

    @property
    def arc(self) -> Arc:
        """The arc that is proved."""
        unit, last = self.begin.framework.unit, self.steps[-1] if self.steps else None
        begin = Visit.of(self.begin, (Fraction(0), Fraction(0)))
        end: Visit | Ray | None = None
        if last is None:
            low, high = self.begin.length(0, self.begin.longest * 3 // 4)
        elif self.landing is not None:
            (low, high), end = whole_length(last, self.landing), self.landing.to
        elif isinstance(last, Passage):
            end = last.visit(unit)
            return Arc(begin, end, end.time, "", len(self.steps) + 1)
        else:
            low, high = last.left
        return Arc(begin, end, (low * unit, high * unit), self.reason, len(self.steps) + 1)

    def __repr__(self) -> str:
        return f"<ArcProof: {self.arc!r}>"


def provenance_of(loop: Loop) -> Document:
    """What the line of a loop keeps for a run that continues the file; it is not verified."""
    return {
        "length": _texts(loop.length),
        "nodes": [
            {
                "radii": list(visit.branch_point.radii),
                "spread": list(visit.direction.radii),
                "time": _texts(visit.time),
            }
            for visit in loop.visits
        ],
        "folds": [
            [*fold.fold, fold.turns, _texts(fold.least), _texts(fold.greatest)]
            for fold in loop.folds
        ],
    }


def _texts(interval: Interval) -> list[str]:
    return [format_rational(x) for x in interval]


def named(start: StartTube, side: int = 1) -> Ray:
    """The ray of a start tube; if `side` is negative, that of its mirror image."""
    named = Ray(start.vertex_signs, start.side)
    return named if side > 0 else named.mirrored


def whole_length(step: Step, landing: Landing) -> Interval:
    """Bounds of the length of a loop whose last step meets the start tube of the landing."""
    parameters = step.tube.located(landing.ball) if isinstance(step, Link) else None
    if not isinstance(step, Link) or parameters is None or parameters[0] < step.entry[1]:
        raise ArithmeticError("the landing is not on the tube")
    shortest, longest = landing.start.length(0, abs(landing.tau))
    return step.time(parameters[0])[0] + shortest, step.time(parameters[1])[1] + longest
