"""What is known of the connected components of the solutions of a sheet."""

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
    """The vertices whose stars are flat."""
    by: Annotated[str, Keywords(enum=["space", "isolated", "regular"])]
    """What proves that it is a solution."""
    folds: bool
    """Whether it is proved to be tangent to true motions with the same flat stars."""
    densities: dict[FoldText, Pair[Rational]]
    """Lower and upper bound of fold angle / length by fold, up to a common factor."""


class PiecesDocument(TypedDict):
    """The connected components of the solutions of a sheet with more than four corners."""

    status: ProvedOrNot
    graphs: Number
    """Their number."""
    at_least: Number
    """A bound of the number of pieces that they form."""
    at_most: Number
    """A bound of the number of pieces that they form."""
    true_at_most: Number
    """The same for true motions."""
    joints: list[JointDocument]
    """Solutions that join graphs."""
    never_flat: dict[VertexText, str]
    """By vertex: why its star is flat in no solution."""
    complete: list[Natural]
    """Vertices of which all joints are known."""
    open: dict[VertexText, str]
    """By vertex: why it is not known in which solutions its star is flat."""
    chord: FoldText | None
    """A fold from boundary to boundary, which joins everything."""


@dataclass(frozen=True)
class Joint:
    """A nonzero solution with flat stars; it joins all sign vectors that agree with its signs.

    `signs` has the sign of each foldable vertex, 0 where its star is flat. `densities` are bounds
    of fold angle / length of the folds that are not flat, up to a common factor; the two bounds are
    equal if the density is a rational number. `by` says what proves that it is a solution: "space"
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
        """The signs in the order of the foldable vertices, as a text such as "+0-"."""
        return "".join(_BY_SIGN[sign] for sign in self.signs.values())

    @property
    def flat(self) -> tuple[int, ...]:
        """The vertices whose stars are flat."""
        return tuple(v for v, sign in self.signs.items() if not sign)

    def to_dict(self) -> JointDocument:
        """The object of this joint in JSON."""
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
    """A zero of the forms of a part near these `coordinates`; those that are not `free`
    are exact.
    """

    coordinates: tuple[float, ...]
    free: tuple[int, ...]


@dataclass(frozen=True)
class PartProof:
    """The proof of the solutions on a part of a sheet, some of whose stars are flat.

    The densities p of `folds` are coordinates. Either `boxes` contain all complex zeros of the
    forms in the chart p_last + sum_k chart_k p_k = 1, in all coordinates except the last; or
    `points` are some zeros.
    """

    folds: tuple[Edge, ...]
    chart: tuple[Fraction, ...] = ()
    boxes: tuple[IsolatingBox, ...] = ()
    points: tuple[RegularPoint, ...] = ()


@dataclass(frozen=True)
class FlatStars:
    """What is known while the stars of `held` are flat: all joints at each vertex of `complete`."""

    held: tuple[int, ...]
    complete: tuple[int, ...]
    parts: tuple[PartProof, ...]


@dataclass(frozen=True)
class ConnectedComponents:
    """The connected components of the solutions without the flat state.

    See docs/any_border.md, Theorem 7. `low` and `high` are bounds of their number; if these are
    equal, `number` is their number. The true configurations near the flat state have at least `low`
    and at most `true_high` components (Theorem 8 there). `vertices` are the foldable vertices.
    `joints` are solutions with flat stars, up to reflection; if the signs of two are comparable,
    only the one that joins more is kept. `never_flat` gives, for a vertex, the reason why its star
    is flat only in the flat state. At the vertices of `complete` all joints are known. `open`
    gives, for each other vertex, the reason why its joints are UNDECIDED. `chord` is a fold from
    boundary to boundary, which connects everything. `proofs` are written to the certificate.
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
        """2^n: one graph over the boundary heights for each sign vector."""
        return 1 << len(self.vertices)

    @property
    def number(self) -> int | None:
        """The number of components; None if only bounds are known."""
        return self.low if self.low == self.high else None

    @property
    def status(self) -> Verdict:
        """PROVED if the number is known."""
        return PROVED if self.low == self.high else UNDECIDED

    def to_dict(self) -> PiecesDocument:
        """The object of the components in JSON."""
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
    """A number for JSON; a text if it is too large for some programs to read exactly."""
    return value if value < 1 << 53 else str(value)
