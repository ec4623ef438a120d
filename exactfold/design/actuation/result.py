"""Torques for one branch with all that is proved of them, and the ranking of all branches."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, ClassVar, Literal, TypedDict

import numpy as np

from exactfold._support.documents import (
    Assignment,
    FoldText,
    Natural,
    NotNegative,
    Pair,
    Positive,
    Rational,
    Sign,
    SignsText,
    VerdictText,
    VertexSigns,
)
from exactfold._support.results import Certified
from exactfold._support.verdict import PROVED, REFUTED, Verdict
from exactfold.branches.values.branch import Branch
from exactfold.design.actuation.directions import Directions
from exactfold.design.actuation.hinges import MODEL, Hinges
from exactfold.design.actuation.orthogonal import OrthogonalTorques
from exactfold.design.actuation.powers import Powers
from exactfold.errors import UsageError
from exactfold.exact.numbers import RationalLike, as_rational, format_rational
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.described import PatternDocument, described
from exactfold.pattern.near_degeneracy import WarningDocument, warnings

if TYPE_CHECKING:
    from exactfold.pattern.panel_pattern import PanelPattern

Bounds = tuple[Fraction, Fraction]

_DIGITS = 15
"""Bounds that are shown or stored are rounded outwards to this many digits after the point."""


def outward(bounds: Bounds) -> Bounds:
    """The bounds rounded outwards to decimals with 15 digits after the point.

    >>> outward((Fraction(1, 3), Fraction(1, 2)))
    (Fraction(333333333333333, 1000000000000000), Fraction(1, 2))
    """
    scale = 10**_DIGITS
    low, high = bounds
    return Fraction(low * scale // 1, scale), Fraction(-(-high * scale // 1), scale)


class RankedDocument(TypedDict):
    """One branch in a ranking by power."""

    signs: SignsText
    ray: Sign
    """Which of the two rays has the larger power: 1 as listed, -1 the opposite one, 0 not known."""
    power: Pair[Rational]
    """Bounds of the power along the stronger ray."""
    above_next: bool
    """Proved to exceed all that follow."""


class OrthogonalDocument(TypedDict):
    """Torques that do work on one branch only, as nearly as they were found."""

    torques: dict[FoldText, Rational]
    """By fold i-j."""
    share: Rational
    """The largest power on another branch is at most this share."""


class RivalsDocument(TypedDict):
    """The other ways that torques are compared with."""

    number: Natural
    """The number of the other ways that are known to fold."""
    complete: bool
    """Whether these are proved to be all other ways."""
    unknown: str
    """Why there may be others; empty if all are known."""


class HingesDocument(TypedDict):
    """Torques in N mm, in floating point."""

    model: str
    """What the numbers assume."""
    stiffness: Rational
    """Of 1 mm of hinge, in N mm / rad."""
    width: Rational
    """Of the sheet, in mm."""
    lengths: dict[FoldText, NotNegative]
    """By fold i-j, in mm."""
    torques: dict[FoldText, float]
    """By fold i-j, in N mm, in the flat state."""


class ActuationDocument(TypedDict):
    """Torques for one branch, and what is proved of them."""

    format: Literal["exactfold actuate result"]
    version: Literal[3]
    pattern: PatternDocument
    status: VerdictText
    reason: str
    self_foldable: VerdictText
    """Whether some torques do work on this branch and on no other (Tachi and Hull)."""
    self_foldable_reason: str
    vertex_signs: VertexSigns
    """By interior vertex, on the ray that is driven: 1 up, -1 down, 0 flat."""
    assignment: Assignment
    """By fold i-j: mountain, valley, flat, undecided; seen from +z."""
    torques: dict[FoldText, Rational]
    """By fold i-j; positive towards a valley."""
    given: bool
    """Whether the torques were given, and not found."""
    creases: Positive | None
    """The most creases that may be driven."""
    margin: Pair[Rational]
    """Bounds of the power on the branch less the largest on any other ray."""
    bound: Rational
    """No torques that are allowed have a larger margin."""
    power: Pair[Rational]
    """Bounds of the power along the ray of the branch."""
    largest_rival: Pair[Rational]
    """Bounds of the largest power along another ray."""
    rivals: RivalsDocument
    orthogonal_dimension: Pair[Natural]
    """Bounds of the dimension of the torques that do no work on any other branch."""
    independent: list[SignsText]
    """Other branches that are proved to be linearly independent, by their vertex signs."""
    orthogonal: OrthogonalDocument | None
    ranking: list[RankedDocument]
    springs: Literal["equal", "by length"]
    """The stiffness of the springs that power is measured with."""
    hinges: HingesDocument | None
    warnings: list[WarningDocument]
    certificate: str | None
    """The file with the evidence, if one was written."""
    seconds: NotNegative


@dataclass(frozen=True)
class Ranked:
    """One branch in a ranking by power.

    `signs` name the branch as it is listed. `ray` is 1 if the ray with these signs is proved to
    have the larger power, -1 if the opposite ray is (all signs reversed), and 0 if neither is
    proved. `power` are bounds of the power of the stronger ray. `above_next` says whether this
    power is proved to exceed that of the next branch.
    """

    signs: str
    ray: int
    power: Bounds
    above_next: bool

    def to_dict(self) -> RankedDocument:
        """The object of this branch in `ranking` of the JSON output."""
        return {
            "signs": self.signs,
            "ray": self.ray,
            "power": [format_rational(x) for x in self.power],
            "above_next": self.above_next,
        }


@dataclass(frozen=True, repr=False)
class Actuation(Certified):
    """Torques that drive a sheet along one ray of one branch, and all that is proved of them.

    The power of torques tau along a ray with unit vector u of fold angles is tau . u. The margin is
    the power along the ray of `branch` minus the largest power along any of the other 2B - 1 rays.
    `margin` are proved bounds of the margin. All torques have size at most 1; a positive torque
    folds its crease towards a valley. `bound` is a proved upper bound of the margin of all such
    torques, on at most `creases` folds if that is not None. `given` says whether the torques were
    given or found.

    `self_foldable` says whether some torques do work on this branch and on no other (Tachi and
    Hull). `orthogonal_dimension` are proved bounds of the dimension of the torques that do no work
    on any other branch, modulo the torques that do no work on any motion. `independent` are other
    branches whose fold angles are proved to be linearly independent. If the dimension is proved to
    be positive, `orthogonal` is an example of such torques.

    With `hinges`, power is measured with springs whose stiffness is in proportion to the lengths of
    the folds, and torques are rest angles in radians.

    `status` is PROVED if the margin is proved to be positive, and REFUTED if it is proved not to
    be.
    """

    pattern: CreasePattern
    branch: Branch
    status: Verdict
    reason: str
    torques: Mapping[Edge, Fraction]
    margin: Bounds
    bound: Fraction
    creases: int | None
    given: bool
    self_foldable: Verdict
    orthogonal_dimension: tuple[int, int]
    independent: tuple[str, ...]
    orthogonal: OrthogonalTorques | None
    directions: Directions
    place: int
    signs: tuple[str, ...]
    hinges: Hinges | None = None
    seconds: float = field(default=0.0, compare=False)

    WRITER: ClassVar = "exactfold.design.actuation.certificate:torques_certificate"

    @cached_property
    def driven(self) -> tuple[Edge, ...]:
        """The folds with a torque that is not 0."""
        return tuple(fold for fold, torque in self.torques.items() if torque)

    @cached_property
    def power(self) -> Bounds:
        """Proved bounds of the power along the ray of the branch."""
        return outward(self._powers(self.torques).bounds(self.place))

    @cached_property
    def largest_rival(self) -> Bounds:
        """Proved bounds of the largest power along any other ray."""
        return outward(self._powers(self.torques).largest_rival(self.place))

    def ranking(self, torques: Mapping[Edge, RationalLike] | None = None) -> list[Ranked]:
        """All branches, sorted by the power of their stronger ray, largest first.

        `torques` are exact numbers of any size by fold (i, j), i < j; folds that are missing have
        torque 0. By default they are the torques of this result. Raises `UsageError` for a key that
        is not a fold of the pattern, and `NumberError` for floats.

        >>> from exactfold.design.actuation.actuate import actuate
        >>> actuation = actuate("two-vertex", "+-")
        >>> [(row.signs, row.ray, row.above_next) for row in actuation.ranking()]
        [('+-', 1, True), ('--', 1, True), ('-+', -1, True), ('++', 1, True)]
        """
        powers = self._powers(self.torques if torques is None else self.checked(torques))
        low, high = np.maximum(powers.low, -powers.high), np.maximum(powers.high, -powers.low)
        order = sorted(range(len(low)), key=lambda b: (-low[b] - high[b], b))
        ranked = []
        least_after: list[bool] = []
        largest = None
        for b in reversed(order):
            least_after.append(largest is None or bool(low[b] > largest))
            largest = high[b] if largest is None else max(largest, high[b])
        for b, above in zip(order, reversed(least_after), strict=True):
            ray = 1 if powers.low[b] > 0 else -1 if powers.high[b] < 0 else 0
            bounds = Fraction(max(low[b], 0), powers.unit), Fraction(high[b], powers.unit)
            ranked.append(Ranked(self.signs[b], ray, outward(bounds), above))
        return ranked

    def checked(self, torques: Mapping[Edge, RationalLike]) -> dict[Edge, Fraction]:
        """Torques of all folds from torques of some of them. Raises the errors of `ranking`."""
        return checked_torques(self.pattern, torques)

    def _powers(self, torques: Mapping[Edge, Fraction]) -> Powers:
        return Powers.of(self.directions, [torques[fold] for fold in self.directions.folds])

    def to_dict(self, name: str | None = None, certificate: str | None = None) -> ActuationDocument:
        """The object printed by `exactfold actuate --json`: `schema("actuate")`."""
        low, high = self.orthogonal_dimension
        orthogonal = self.orthogonal
        return {
            "format": "exactfold actuate result",
            "version": 3,
            "pattern": described(self.pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "self_foldable": str(self.self_foldable),
            "self_foldable_reason": self.self_foldable_reason,
            "vertex_signs": {str(v): s for v, s in sorted(self.branch.vertex_signs.items())},
            "assignment": {f"{i}-{j}": a for (i, j), a in sorted(self.branch.assignment.items())},
            "torques": torque_texts(self.torques),
            "given": self.given,
            "creases": self.creases,
            "margin": [format_rational(x) for x in self.margin],
            "bound": format_rational(self.bound),
            "power": [format_rational(x) for x in self.power],
            "largest_rival": [format_rational(x) for x in self.largest_rival],
            "rivals": {"number": len(self.directions) - 1, "complete": True, "unknown": ""},
            "orthogonal_dimension": [low, high],
            "independent": list(self.independent),
            "orthogonal": None if orthogonal is None else orthogonal_document(orthogonal),
            "ranking": [row.to_dict() for row in self.ranking()],
            "springs": "equal" if self.hinges is None else "by length",
            "hinges": None
            if self.hinges is None
            else hinges_document(self.hinges, self.pattern, self.torques),
            "warnings": warnings(self.pattern),
            "certificate": certificate,
            "seconds": round(self.seconds, 3),
        }

    @property
    def self_foldable_reason(self) -> str:
        """Why torques can do work on this branch alone, or cannot, in words."""
        if self.self_foldable is PROVED:
            return "some torques do work on this branch and on no other"
        if self.self_foldable is REFUTED:
            return (
                "torques that do no work on the other branches do none on this one: the other "
                "branches span it"
            )
        return "the rank of the other branches is not known"

    def __repr__(self) -> str:
        signs = self.branch.sign_text
        text = signs if len(signs) <= 32 else f"{signs[:29]}..."
        return (
            f"<Actuation of {text}: {self.status}, margin {float(self.margin[0]):.4g} "
            f"of at most {float(self.bound):.4g}>"
        )


def checked_torques(
    pattern: CreasePattern | PanelPattern, torques: Mapping[Edge, RationalLike]
) -> dict[Edge, Fraction]:
    """Exact torques of all folds from torques of some of them; missing folds have torque 0.

    Raises `UsageError` for a key that is not a fold of the pattern, and `NumberError` for floats.
    """
    folds = set(pattern.folds)
    for fold in torques:
        if fold not in folds:
            raise UsageError(f"{fold!r} is not a fold (i, j), i < j, of the pattern")
    return {fold: as_rational(torques.get(fold, 0)) for fold in pattern.folds}


def check_question(
    pattern: CreasePattern | PanelPattern,
    creases: int | None,
    torques: Mapping[Edge, RationalLike] | None,
    nodes: int,
) -> None:
    """Raise `UsageError` if torques cannot be sought, or judged, as they are asked for."""
    if creases is not None and torques is not None:
        raise UsageError(
            "give either torques to judge or the number of creases to drive, but not both"
        )
    if creases is not None and not 1 <= creases <= len(pattern.folds):
        raise UsageError(
            f"{creases} creases cannot be driven: give a number from 1 to {len(pattern.folds)}, "
            "the number of folds"
        )
    if nodes < 1:
        raise UsageError(
            f"nodes is {nodes}: allow at least one linear program for the choice of creases"
        )
    if torques is not None and not any(checked_torques(pattern, torques).values()):
        raise UsageError("all torques are 0: give at least one fold a torque that is not 0")


def torque_texts(torques: Mapping[Edge, Fraction]) -> dict[str, str]:
    """Torques by fold, as in the JSON output."""
    return {f"{i}-{j}": format_rational(torque) for (i, j), torque in sorted(torques.items())}


def orthogonal_document(orthogonal: OrthogonalTorques) -> OrthogonalDocument:
    """The key `orthogonal` of the JSON output."""
    return {
        "torques": torque_texts(orthogonal.torques),
        "share": format_rational(outward((orthogonal.share, orthogonal.share))[1]),
    }


def hinges_document(
    hinges: Hinges, pattern: CreasePattern | PanelPattern, torques: Mapping[Edge, Fraction]
) -> HingesDocument:
    """The key `hinges` of the JSON output."""
    lengths = hinges.lengths(pattern)
    return {
        "model": MODEL,
        "stiffness": format_rational(hinges.stiffness),
        "width": format_rational(hinges.width),
        "lengths": {f"{i}-{j}": length for (i, j), length in lengths.items()},
        "torques": {
            f"{i}-{j}": float(hinges.stiffness) * lengths[i, j] * float(torque)
            for (i, j), torque in sorted(torques.items())
        },
    }
