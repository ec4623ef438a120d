"""Torques for one way of rigid panels with all that is proved of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar, Literal, TypedDict

from exactfold._support.documents import (
    Assignment,
    FoldText,
    Natural,
    NotNegative,
    Pair,
    Positive,
    Rational,
    Sign,
    VerdictText,
)
from exactfold._support.results import Certified
from exactfold._support.verdict import Verdict
from exactfold.design.actuation.directions import Springs
from exactfold.design.actuation.hinges import Hinges
from exactfold.design.actuation.orthogonal import OrthogonalTorques
from exactfold.design.actuation.panels.motions import WayMotions
from exactfold.design.actuation.panels.rays import Recipe, WayPower
from exactfold.design.actuation.result import (
    HingesDocument,
    OrthogonalDocument,
    RivalsDocument,
    hinges_document,
    orthogonal_document,
    torque_texts,
)
from exactfold.exact.numbers import format_rational
from exactfold.motion.panels.listing import PanelWay
from exactfold.panels.result import Decomposition
from exactfold.pattern.described import PanelsDocument, described_panels
from exactfold.pattern.panel_pattern import Edge, PanelPattern

Bounds = tuple[Fraction, Fraction]


class RankedWayDocument(TypedDict):
    """One way in a ranking by power."""

    way: Positive
    """Its number in the list of `count`."""
    dimension: Positive
    ray: Sign
    """Of an isolated way the ray with the larger power: 1 as listed, -1 the opposite one, 0 not
    known. 0 for a family.
    """
    power: Pair[Rational]
    """Bounds of the largest power along the way."""
    above_next: bool
    """Proved to exceed all that follow."""


class RankedFoldDocument(TypedDict):
    """One fold in a ranking of the folds."""

    fold: FoldText
    without: Rational
    """If this fold is not driven, no torques have a larger margin."""


class PanelActuationDocument(TypedDict):
    """Torques for one way of rigid panels, and what is proved of them."""

    format: Literal["exactfold actuate result"]
    version: Literal[3]
    pattern: PanelsDocument
    status: VerdictText
    reason: str
    way: Positive
    """The number of the way in the list of `count`."""
    dimension: Positive
    assignment: Assignment
    """By fold i-j, on the ray that is driven."""
    self_foldable: VerdictText
    """Whether some torques do work on this way and on no other (Tachi and Hull)."""
    self_foldable_reason: str
    torques: dict[FoldText, Rational]
    """By fold i-j; positive towards a valley."""
    given: bool
    """Whether the torques were given, and not found."""
    creases: Positive | None
    """The most creases that may be driven."""
    springs: Literal["equal", "by length"]
    """The stiffness of the springs that power is measured with."""
    margin: Pair[Rational]
    """Bounds of the power on the ray that is driven less the largest on a rival."""
    bound: Rational
    """No torques that are allowed have a larger margin."""
    power: Pair[Rational]
    """Bounds of the power along the ray that is driven."""
    largest_rival: Pair[Rational]
    """Bounds of the largest power along a rival."""
    rivals: RivalsDocument
    ranking: list[RankedWayDocument]
    folds: list[RankedFoldDocument]
    """The folds, the one first whose loss costs most."""
    orthogonal: OrthogonalDocument | None
    hinges: HingesDocument | None
    certificate: str | None
    """The file with the evidence, if one was written."""
    seconds: NotNegative


@dataclass(frozen=True, repr=False)
class PanelActuation(Certified):
    """Torques that drive a sheet of rigid panels along one way, and all that is proved of them.

    The ray that is driven turns all motions of the way by the same share, to the sides that
    `assignment` shows. The power of torques along a ray is as in `Actuation`, and on a family it is
    the largest of its rays. The margin is the power along this ray minus the largest on a rival:
    on any other way, or on a ray of the way that turns one of its motions to the other side.
    `margin` are proved bounds of the margin, and `bound` bounds that of all torques of size at most
    1, on at most `creases` folds if that is not None. `without` has for each fold such a bound for
    torques that do not drive this fold.

    `self_foldable` says whether some torques do work on this way and on no other, and
    `self_foldable_reason` why (docs/actuation.md, 8). If it is proved, `orthogonal` are such
    torques, as nearly as rational numbers come. `unknown` says why there may be rivals that are not
    known; the bounds `margin` then hold for the known ones, and `bound` for all.

    `status` is PROVED if the margin is proved to be positive, and REFUTED if it is proved not to
    be. The rivals and weights of `proof` show that no margin exceeds `shown`, which is `bound`
    unless branch and bound shows more of few folds.
    """

    pattern: PanelPattern
    decomposition: Decomposition = field(repr=False)
    way: PanelWay
    assignment: Mapping[Edge, str]
    status: Verdict
    reason: str
    self_foldable: Verdict
    self_foldable_reason: str
    torques: Mapping[Edge, Fraction]
    margin: Bounds
    bound: Fraction
    creases: int | None
    given: bool
    springs: Springs
    power: Bounds
    largest_rival: Bounds
    ranking: tuple[WayPower, ...]
    without: Mapping[Edge, Fraction]
    orthogonal: OrthogonalTorques | None
    motions: WayMotions = field(repr=False)
    sides: tuple[int, ...]
    proof: tuple[tuple[Recipe, Fraction], ...] = field(repr=False)
    shown: Fraction = field(repr=False)
    hinges: Hinges | None = None
    seconds: float = field(default=0.0, compare=False)

    WRITER: ClassVar = "exactfold.design.actuation.panels.certificate:panel_torques_certificate"

    @property
    def driven(self) -> tuple[Edge, ...]:
        """The folds with a torque that is not 0."""
        return tuple(fold for fold, torque in self.torques.items() if torque)

    @property
    def unknown(self) -> str:
        """Why there may be rivals that are not known; empty if all are known."""
        return self.motions.unknown

    @property
    def above_next(self) -> tuple[bool, ...]:
        """For each way of `ranking`, whether it is proved to have more power than all below it."""
        above = []
        most: Fraction | None = None
        for row in reversed(self.ranking):
            above.append(most is None or row.power[0] > most)
            most = row.power[1] if most is None else max(most, row.power[1])
        return tuple(reversed(above))

    def to_dict(
        self, name: str | None = None, certificate: str | None = None
    ) -> PanelActuationDocument:
        """The object printed by `exactfold actuate --json`: `schema("actuate")`."""
        return {
            "format": "exactfold actuate result",
            "version": 3,
            "pattern": described_panels(self.pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "way": self.way.number,
            "dimension": self.way.dimension,
            "assignment": {
                f"{i}-{j}": self.assignment.get((i, j), "F") for i, j in self.pattern.folds
            },
            "self_foldable": str(self.self_foldable),
            "self_foldable_reason": self.self_foldable_reason,
            "torques": torque_texts(self.torques),
            "given": self.given,
            "creases": self.creases,
            "springs": self.springs,
            "margin": [format_rational(x) for x in self.margin],
            "bound": format_rational(self.bound),
            "power": [format_rational(x) for x in self.power],
            "largest_rival": [format_rational(x) for x in self.largest_rival],
            "rivals": {
                "number": self._rivals,
                "complete": not self.unknown,
                "unknown": self.unknown,
            },
            "ranking": [
                {
                    "way": row.number,
                    "dimension": row.dimension,
                    "ray": row.side,
                    "power": [format_rational(x) for x in row.power],
                    "above_next": above,
                }
                for row, above in zip(self.ranking, self.above_next, strict=True)
            ],
            "folds": [
                {"fold": f"{i}-{j}", "without": format_rational(bound)}
                for (i, j), bound in self.without.items()
            ],
            "orthogonal": None if self.orthogonal is None else orthogonal_document(self.orthogonal),
            "hinges": None
            if self.hinges is None
            else hinges_document(self.hinges, self.pattern, self.torques),
            "certificate": certificate,
            "seconds": round(self.seconds, 3),
        }

    @property
    def _rivals(self) -> Natural:
        """The number of other ways that are known to fold."""
        return len(self.motions.ways) - 1

    def __repr__(self) -> str:
        return (
            f"<PanelActuation of way {self.way.number}: {self.status}, margin "
            f"{float(self.margin[0]):.4g} of at most {float(self.bound):.4g}>"
        )
