"""What is known of the pieces of the solutions of a sheet."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import Annotated, TypeAlias, TypedDict

from exactfold._support.documents import (
    FoldText,
    Keywords,
    Natural,
    Pair,
    Positive,
    ProvedOrNot,
    Rational,
    VertexSigns,
    VertexText,
)
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import Edge
from exactfold.solve.certify.box import IsolatingBox

_BY_SIGN = {1: "+", 0: "0", -1: "-"}

Number: TypeAlias = Positive | Annotated[str, Keywords(pattern="^[1-9][0-9]*$")]
"""Beyond 2^53 as text."""


class JointDocument(TypedDict):
    """A solution with flat stars."""

    vertex_signs: VertexSigns
    flat: list[Natural]
    by: Annotated[str, Keywords(enum=["space", "isolated", "regular"])]
    folds: bool
    """Whether it is proved to be tangent to true motions with the same flat stars."""
    densities: dict[FoldText, Pair[Rational]]
    """Lower and upper bound of fold angle / length by fold, up to a common factor."""


class PiecesDocument(TypedDict):
    """The connected components of the solutions of a sheet with more than four corners."""

    status: ProvedOrNot
    graphs: Number
    at_least: Number
    at_most: Number
    true_at_most: Number
    joints: list[JointDocument]
    never_flat: dict[VertexText, str]
    """By vertex: why its star is flat in no solution."""
    complete: list[Natural]
    open: dict[VertexText, str]
    """By vertex: why it is not known in which solutions its star is flat."""
    chord: FoldText | None


@dataclass(frozen=True)
class Joint:
    """A non-zero solution with flat stars, which joins all sign vectors that agree with its signs.

    `signs` has the sign of each foldable vertex, 0 where its star is flat. `densities` are bounds
    of fold angle / length of the folds that are not flat, up to a common factor; they are equal
    where the density is a rational number. `by` says what proves that it is a solution: "space"
    (all curvature forms vanish on a linear space, found exactly), "isolated" (one of finitely many,
    in a box) or "regular" (a point at which the forms have independent derivatives, in a box).
    `folds` says whether it is proved to be tangent to true motions with the same flat stars.
    """

    signs: Mapping[int, int]
    densities: Mapping[Edge, tuple[Fraction, Fraction]]
    by: str
    folds: bool = False

    @property
    def sign_text(self) -> str:
        """The signs in the order of the foldable vertices, as in "+0-"."""
        return "".join(_BY_SIGN[sign] for sign in self.signs.values())

    @property
    def flat(self) -> tuple[int, ...]:
        """The vertices whose stars are flat."""
        return tuple(v for v, sign in self.signs.items() if not sign)

    def to_dict(self) -> JointDocument:
        """The joint as it stands in JSON."""
        return {
            "vertex_signs": {str(v): sign for v, sign in self.signs.items()},
            "flat": list(self.flat),
            "by": self.by,
            "folds": self.folds,
            "densities": {
                f"{i}-{j}": [format_rational(low), format_rational(high)]
                for (i, j), (low, high) in self.densities.items()
            },
        }

    def __repr__(self) -> str:
        return f"<Joint: {self.sign_text}, {self.by}>"


@dataclass(frozen=True)
class RegularPoint:
    """A zero of the forms of a part: near these `coordinates`, those that are not `free` exact."""

    coordinates: tuple[float, ...]
    free: tuple[int, ...]


@dataclass(frozen=True)
class PartProof:
    """What shows the solutions on a part of a sheet some of whose stars are flat.

    The densities p of `folds` are coordinates. `boxes` hold all complex zeros of the forms in the
    chart p_last + sum_k chart_k p_k = 1, in all coordinates but the last; or `points` are some.
    """

    folds: tuple[Edge, ...]
    chart: tuple[Fraction, ...] = ()
    boxes: tuple[IsolatingBox, ...] = ()
    points: tuple[RegularPoint, ...] = ()


@dataclass(frozen=True)
class FlatStars:
    """What is known with the stars of `held` flat: all joints at each vertex of `complete`."""

    held: tuple[int, ...]
    complete: tuple[int, ...]
    parts: tuple[PartProof, ...]


@dataclass(frozen=True)
class Pieces:
    """The pieces of the solutions without the flat state (docs/any_border.md, Theorem 7).

    `low` and `high` are bounds of their number, `number` where these are equal. The true
    configurations near the flat state fall into at least `low` and at most `true_high` pieces
    (Theorem 8 there). `vertices` are the foldable vertices. `joints` are solutions with flat stars,
    up to reflection; of two with comparable signs the one that joins more. `never_flat` says of a
    vertex why its star is flat in no solution but the flat state. At the vertices of `complete` all
    joints are known. `open` says of each other vertex why its joints are UNDECIDED. `chord` is a
    fold from border to border, which joins everything. `proofs` are what a certificate is made of.
    """

    vertices: tuple[int, ...]
    dimension: int
    low: int
    high: int
    true_high: int
    joints: tuple[Joint, ...] = ()
    never_flat: Mapping[int, str] | None = None
    complete: tuple[int, ...] = ()
    open: Mapping[int, str] | None = None
    chord: Edge | None = None
    proofs: tuple[FlatStars, ...] = field(default=(), repr=False)

    @property
    def graphs(self) -> int:
        """2^n, one graph over the rim heights for each sign vector."""
        return 1 << len(self.vertices)

    @property
    def number(self) -> int | None:
        """The number of pieces, None if only bounds are known."""
        return self.low if self.low == self.high else None

    @property
    def status(self) -> Verdict:
        """PROVED if the number is known."""
        return PROVED if self.low == self.high else UNDECIDED

    def to_dict(self) -> PiecesDocument:
        """The pieces as they stand in JSON."""
        return {
            "status": str(self.status),
            "graphs": _number(self.graphs),
            "at_least": _number(self.low),
            "at_most": _number(self.high),
            "true_at_most": _number(self.true_high),
            "joints": [joint.to_dict() for joint in self.joints],
            "never_flat": {str(v): why for v, why in (self.never_flat or {}).items()},
            "complete": list(self.complete),
            "open": {str(v): why for v, why in (self.open or {}).items()},
            "chord": None if self.chord is None else f"{self.chord[0]}-{self.chord[1]}",
        }

    def __repr__(self) -> str:
        number = self.low if self.low == self.high else f"{self.low} to {self.high}"
        return f"<Pieces: {self.status}, {number} of {self.graphs} graphs>"


def _number(value: int) -> int | str:
    """As JSON: beyond what all programs read exactly as text."""
    return value if value < 1 << 53 else str(value)
