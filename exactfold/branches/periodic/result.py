"""What a count of a periodic sheet found: branches, spaces of pleats, and how they were proved."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import TYPE_CHECKING, Annotated, ClassVar, Literal, TypeAlias, TypedDict

from exactfold._support.documents import (
    Keywords,
    Natural,
    NotNegative,
    Pair,
    Positive,
    Rational,
    Side,
    SignsText,
)
from exactfold._support.plurals import agreeing, counted
from exactfold._support.results import Certified, Ways
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.errors import UsageError
from exactfold.exact.numbers import format_integer, format_rational
from exactfold.pattern.periodic.periodic_pattern import PeriodicPattern

if TYPE_CHECKING:
    from exactfold.branches.periodic.lines import QuadraticLine
    from exactfold.branches.periodic.rays import Ray
    from exactfold.branches.periodic.spaces import Cover
    from exactfold.rigidity.equations.periodic import PeriodicProblem

Whole: TypeAlias = Annotated[str, Keywords(pattern="^-?[0-9]+$")]


@dataclass(frozen=True)
class PeriodicBranch:
    """One way in which a periodic sheet starts to roll up across the direction n.

    `vertex_signs` has a character for each vertex of the cell: + up, - down, 0 flat. The mirror
    image has all signs and letters reversed; the side shown is that on which the first vertex that
    is not flat pops up. `b` is the sign of b there: heights are w + (b/2) (n . x)^2 with w the same
    at all translates. `letters` has M, V, F or U for each edge of the pattern. `multiplicity` is
    2^(number of flat vertices).
    """

    vertex_signs: str
    b: int
    letters: str
    multiplicity: int

    def to_dict(self) -> PeriodicBranchDocument:
        """The object in the JSON of a count."""
        return {
            "vertex_signs": self.vertex_signs,
            "multiplicity": self.multiplicity,
            "b": self.b,
            "letters": self.letters,
        }


@dataclass(frozen=True)
class HeightSpace:
    """A linear space of solutions of dimension 1 or more, with an exact basis.

    Each row of `basis` has a height w for each vertex, 0 at the first, and then b. A space of
    pleats has b = 0.
    """

    basis: tuple[tuple[Fraction, ...], ...]

    @property
    def dimension(self) -> int:
        """The dimension."""
        return len(self.basis)

    def to_dict(self) -> PeriodicSpaceDocument:
        """The object in the JSON of a count."""
        return {
            "dimension": self.dimension,
            "basis": [[format_rational(x) for x in row] for row in self.basis],
        }


@dataclass(frozen=True)
class AlgebraicLine:
    """A line of pleats that is not rational: its heights are polynomials in a root of another one.

    `polynomial` has integer coefficients, constant term first, and exactly one root t in the
    rational `interval`. `heights` has the coefficients of a polynomial in t for the height w of
    each vertex, 0 at the first.
    """

    polynomial: tuple[int, ...]
    interval: tuple[Fraction, Fraction]
    heights: tuple[tuple[Fraction, ...], ...]

    @property
    def dimension(self) -> int:
        """The dimension: 1."""
        return 1

    def to_dict(self) -> PeriodicLineDocument:
        """The object in the JSON of a count."""
        low, high = self.interval
        row = [[format_rational(c) for c in height] for height in self.heights]
        return {
            "dimension": 1,
            "basis": [[*row, ["0"]]],
            "polynomial": [format_integer(c) for c in self.polynomial],
            "interval": [format_rational(low), format_rational(high)],
        }


class PeriodicBranchDocument(TypedDict):
    """A branch of a periodic sheet: a pair of opposite rays."""

    vertex_signs: SignsText
    """A character for each vertex of the cell, on the side with the first of them that pops up."""
    multiplicity: Positive
    """2^(number of flat vertices)."""
    b: Side
    """The sign of b on this side: the sheet rolls up to +z or to -z."""
    letters: Annotated[str, Keywords(pattern="^[MVFU]*$")]
    """A letter for each of the edges, on this side."""


class PeriodicSpaceDocument(TypedDict):
    """A linear space of solutions."""

    dimension: Positive
    """Its dimension."""
    basis: list[list[Rational]]
    """Each row: the height w of every vertex, 0 at the first, and then b."""


class PeriodicLineDocument(TypedDict):
    """A line of pleats whose heights are algebraic numbers."""

    dimension: Literal[1]
    """Its dimension."""
    basis: list[list[list[Rational]]]
    """One row, as in a rational space; for each number the coefficients of a polynomial in t."""
    polynomial: list[Whole]
    """Integer coefficients, constant term first."""
    interval: Pair[Rational]
    """Bounds of the one root t that is meant."""


class PeriodicDocument(TypedDict):
    """A count of the branches of a periodic sheet for one direction."""

    format: Literal["exactfold periodic result"]
    version: Literal[1]
    name: str | None
    """The file or the name of the cell."""
    status: Annotated[str, Keywords(enum=["proved", "undecided"])]
    """Proved: the branches, pleats and families listed are all solutions."""
    reason: str
    """How it was proved, or what is open."""
    vertices: Positive
    """The number V of vertices in the cell."""
    direction: list[int]
    """The direction n, as the shortest vector of integers."""
    distinct: Natural | None
    """The isolated solutions with b = 1; null if undecided."""
    with_multiplicity: Natural | None
    """The same, with multiplicity."""
    real: Natural | None
    """How many of them are real: all, by theorem."""
    nonreal: Natural | None
    """How many are not: none, by theorem."""
    edges: list[list[int]]
    """The edges [u, v, i, j] in the order of the letters: from vertex u to v moved by (i, j)."""
    branches: list[PeriodicBranchDocument]
    """The isolated solutions, sorted by vertex signs; those found if undecided."""
    pleats: list[PeriodicSpaceDocument | PeriodicLineDocument]
    """The maximal spaces of solutions with b = 0; none if and only if (H) holds."""
    families: list[PeriodicSpaceDocument]
    """The spaces of two or more dimensions in which b is not 0."""
    open: list[str]
    """Sign vectors that are undecided, 1000 at most."""
    certificate: str | None
    """The certificate that was written."""
    seconds: NotNegative
    """The time that the count took."""


@dataclass(frozen=True)
class Evidence:
    """How each sign vector is proved: by a simple ray in a box, by a space, or by a line.

    Spaces are over Q, and lines over quadratic fields.
    """

    problem: PeriodicProblem
    rays: tuple[Ray, ...]
    covers: tuple[Cover, ...]
    lines: tuple[QuadraticLine, ...] = ()


@dataclass(frozen=True, repr=False)
class PeriodicCount(Ways[PeriodicBranch], Certified):
    """All second-order solutions of a periodic sheet that rolls up across a direction n.

    The counts are those of the isolated solutions with b = 1; all of them are real
    (docs/tessellations.md). `pleats` are the maximal linear spaces of solutions with b = 0, and
    `families` those of two or more dimensions in which b is not 0. `open` are the sign vectors that
    are undecided; the counts are None if there are any.
    """

    WRITER: ClassVar[str] = "exactfold.branches.periodic.certificate:periodic_certificate"

    pattern: PeriodicPattern
    direction: tuple[int, int]
    status: Verdict
    reason: str
    branches: tuple[PeriodicBranch, ...]
    pleats: tuple[HeightSpace | AlgebraicLine, ...] = ()
    families: tuple[HeightSpace, ...] = ()
    open: tuple[str, ...] = ()
    seconds: float = field(default=0.0, compare=False)
    evidence: Evidence | None = field(default=None, compare=False)

    @property
    def distinct(self) -> int | None:
        """The number of isolated solutions with b = 1; None if undecided."""
        return None if self.open else len(self.branches)

    @property
    def with_multiplicity(self) -> int | None:
        """The same with multiplicity; 2^(V - 1) if there are no pleats."""
        return None if self.open else sum(branch.multiplicity for branch in self.branches)

    @property
    def real(self) -> int | None:
        """How many isolated solutions with b = 1 are real: all of them, by theorem."""
        return self.distinct

    def listed(self) -> tuple[PeriodicBranch, ...]:
        """The branches."""
        return self.branches

    def with_letters(self, letters: str) -> tuple[Verdict, tuple[int, ...]]:
        """Whether the sheet starts to roll up with given letters, and the branches that do so.

        `letters` has M, V, F (flat) or U (free) for each edge. A branch and its mirror image are
        the same; branches are numbered from 1. Pleats and families are not compared: if there are
        any, and no branch has the letters, that is UNDECIDED. Raises `UsageError`.
        """
        if len(letters) != len(self.pattern.edges) or set(letters) - set("MVFU"):
            raise UsageError(
                f"{letters!r}: give one of M, V, F, U for each of the "
                f"{counted(len(self.pattern.edges), 'edge')} of the cell"
            )
        other = letters.translate(str.maketrans("MV", "VM"))
        fits = {
            k + 1: [
                all(a in ("U", b) or b == "U" for a, b in zip(side, branch.letters, strict=True))
                for side in (letters, other)
            ]
            for k, branch in enumerate(self.branches)
        }
        found = tuple(k for k, sides in fits.items() if any(sides))
        sure = tuple(k for k in found if "U" not in self.branches[k - 1].letters)
        if sure:
            return PROVED, sure
        if found or self.status is not PROVED or self.pleats or self.families:
            return UNDECIDED, found
        return REFUTED, ()

    def __repr__(self) -> str:
        pleats, branches = len(self.pleats), counted(len(self.branches), "branch")
        found = f"{branches}, {pleats} {agreeing(pleats, 'space')} of pleats"
        return f"<PeriodicCount: {self.status}, {found}, {self.pattern!r}>"

    def to_dict(self, certificate: str | None = None, name: str | None = None) -> PeriodicDocument:
        """The object printed by `exactfold count CELL --direction X,Y --json`."""
        return {
            "format": "exactfold periodic result",
            "version": 1,
            "name": name,
            "status": str(self.status),
            "reason": self.reason,
            "vertices": self.pattern.V,
            "direction": list(self.direction),
            "distinct": self.distinct,
            "with_multiplicity": self.with_multiplicity,
            "real": self.distinct,
            "nonreal": None if self.open else 0,
            "edges": [list(edge) for edge in self.pattern.edges],
            "branches": [branch.to_dict() for branch in self.branches],
            "pleats": [space.to_dict() for space in self.pleats],
            "families": [space.to_dict() for space in self.families],
            "open": list(self.open),
            "certificate": certificate,
            "seconds": round(self.seconds, 3),
        }
