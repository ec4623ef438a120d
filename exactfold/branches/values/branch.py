"""A branch: one line of second-order foldings through the unfolded state, and its names."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from typing import Annotated, Any, ClassVar, Literal, TypeAlias, TypedDict

from exactfold._support.documents import (
    Assignment,
    Keywords,
    Natural,
    NotNegative,
    NotNegativeRational,
    Pair,
    Rational,
    Sign,
    VerdictText,
    VertexSigns,
    VertexText,
)
from exactfold._support.notebook import Picture
from exactfold._support.results import Certified
from exactfold._support.verdict import PROVED, Verdict
from exactfold.branches.values.angles import FoldAngles, fold_angles
from exactfold.branches.values.letters import SIGNS, UPSIDE_DOWN
from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot, EnclosedRoot, FlatBoxRoot, Root
from exactfold.errors import NotApplicableError
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern, Edge
from exactfold.pattern.described import PatternDocument, described
from exactfold.pattern.near_degeneracy import WarningDocument, warnings

Row = tuple[Fraction, ...]
Bounds = tuple[Fraction, Fraction]

GaugeText: TypeAlias = Annotated[str, Keywords(enum=["saddle", "notch", "corner", "rim"])]


class ListedBranch(TypedDict):
    """A branch as a count lists it."""

    vertex_signs: VertexSigns
    """By interior vertex: 1 up, -1 down, 0 flat."""
    assignment: Assignment
    """By fold i-j: mountain, valley, flat, undecided; seen from +z."""
    # Any, as an undecided branch has None; no count lists one.
    multiplicity: Annotated[Any, Keywords(type="integer", minimum=1)]
    """That of the solution of the branch system."""
    representative: Annotated[str, Keywords(enum=["saddle", "either"])]
    heights: dict[VertexText, Pair[Rational]]
    """Lower and upper bound by vertex."""


class BranchDocument(TypedDict):
    """A branch that was asked for by its signs."""

    format: Literal["exactfold branch result"]
    version: Literal[2]
    pattern: PatternDocument
    status: VerdictText
    reason: str
    vertex_signs: VertexSigns
    """By interior vertex: 1 up, -1 down, 0 flat."""
    undecided_vertices: list[Natural]
    """Vertices whose sign is not proved."""
    assignment: Assignment
    """By fold i-j: mountain, valley, flat, undecided; seen from +z."""
    gauge: GaugeText
    """What of the heights is given."""
    curvature: dict[VertexText, NotNegativeRational]
    """Angle deficits that are not 0, by interior vertex."""
    straight_border: list[Natural]
    """With the gauge "rim": boundary vertices on a straight side."""
    saddle: Sign
    """The sign of the boundary saddle."""
    centres: dict[VertexText, Rational]
    """Each height lies within `radius` of its centre."""
    radius: Rational | None
    """Null if nothing is proved."""
    squared_distance: Rational | None
    """A proved bound of the distance to the branch."""
    steps: Natural
    """Of Newton's method."""
    warnings: list[WarningDocument]
    seconds: NotNegative


@dataclass(frozen=True, repr=False)
class Branch(Picture, Certified):
    """One branch of a pattern, represented by one of its two rays (docs/mathematics.md, Branch).

    `vertex_signs` gives, for each interior vertex, +1 popped up, -1 popped down, or 0 proved flat.
    `assignment` gives, for each fold (i, j), i < j, "M" mountain, "V" valley, "F" proved flat, or
    "U" undecided, seen from +z. `multiplicity` is that of the solution of the branch system of the
    whole pattern, or None if it is not known. `root` is the proved place of the branch, or None if
    nothing is proved.

    `status` is PROVED if exactly one branch has these vertex signs, and `reason` says what was
    proved or what is missing. All branches of a proved count are PROVED. The stars of
    `undecided_vertices` are flat within the error, so the sign asked for may be 0.

    A branch is a line, and `gauge` says which of its points has the given heights. "saddle": one
    boundary vertex has height 1 and the three others 0 (`saddle_functional` is 1). "notch", used if
    this is not known to be possible: the sign functional of the reflex corner is 1 in the closed
    sheet. "corner", for a single branch: the curvature of the reflex corner is
    `Gauge.corner_curvature`. "rim": the boundary heights are given (`boundary_heights`).
    `curvature` gives the nonzero angle deficits of vertices; if there are any, this is a single
    shape, not a line, and its opposite is another shape.

    Heights are the values of `height_rows` at the root, divided by the value of `unit_row` if there
    is one. `saddle` is the proved sign of the boundary saddle; it is 0 if it is not proved or there
    are more than four boundary vertices. In a count, every branch with a proved saddle is shown
    from the side of positive saddle. Opposite heights are the other ray, with all signs and letters
    reversed.
    """

    pattern: CreasePattern
    vertex_signs: Mapping[int, int]
    assignment: Mapping[Edge, str]
    root: Root | None
    multiplicity: int | None
    gauge: str
    saddle: int
    height_rows: Mapping[int, Row] = field(default_factory=dict)
    unit_row: Row = ()
    status: Verdict = PROVED
    reason: str = ""
    undecided_vertices: tuple[int, ...] = ()
    steps: int = 0
    seconds: float = field(default=0.0, compare=False)
    curvature: Mapping[int, Fraction] = field(default_factory=dict)

    WRITER: ClassVar = "exactfold.branches.certificates.single:branch_certificate"

    @cached_property
    def sign_text(self) -> str:
        """The vertex signs in the order of the vertices, as a text such as "+-0"."""
        signs = self.vertex_signs
        return "".join([SIGNS[signs[v]] for v in sorted(signs)])

    @cached_property
    def assignment_text(self) -> str:
        """The mountain-valley letters in the order of the folds, as a text such as "MVVF"."""
        letters = self.assignment
        return "".join([letters[fold] for fold in sorted(letters)])

    @property
    def names(self) -> tuple[str, str]:
        """The signs and letters of the two rays; of each, the smaller text is taken, so both rays
        agree.
        """
        signs, letters = self.sign_text, self.assignment_text
        return (
            min(signs, signs.translate(UPSIDE_DOWN)),
            min(letters, letters.translate(UPSIDE_DOWN)),
        )

    @property
    def undecided_folds(self) -> tuple[Edge, ...]:
        """The folds whose letter is undecided, in order."""
        return tuple(fold for fold, letter in sorted(self.assignment.items()) if letter == "U")

    @property
    def representative(self) -> str:
        """The word "saddle" if the saddle is positive here; "either" if its sign is not proved."""
        return "saddle" if self.saddle else "either"

    @cached_property
    def heights(self) -> dict[int, Bounds]:
        """Rational bounds of the height of every vertex, in `gauge`; empty if nothing is proved."""
        if self.root is None:
            return {}
        if isinstance(self.root, EnclosedRoot):
            return self.root.heights
        if self.unit_row and isinstance(self.root, AlgebraicRoot):
            return {
                v: self.root.quotient(row, self.unit_row) for v, row in self.height_rows.items()
            }
        heights = {v: self.root.enclose(row) for v, row in self.height_rows.items()}
        if not self.unit_row:
            return heights
        unit = self.root.enclose(self.unit_row)
        return {v: _quotient(bounds, unit) for v, bounds in heights.items()}

    def sharpened(self, bits: int = 64) -> Branch:
        """The same branch with its root in a box of `bits` bits after the point.

        The branches of a count have the bounds with which they were proved, about nine digits.
        Roots that are algebraic numbers or exact are returned unchanged. Raises
        `NotApplicableError` if the box cannot be proved, which does not mean that there is no such
        box.

        >>> from exactfold.branches.counting.collect import count_branches
        >>> branch = count_branches("two-vertex")["+-"].sharpened(100)
        >>> low, high = branch.heights[4]
        >>> high - low < Fraction(1, 10**27)
        True
        """
        if not isinstance(self.root, BoxRoot | FlatBoxRoot) or self.root.box.bits >= bits:
            return self
        root = self.root.sharpened(bits)
        if root is None:
            raise NotApplicableError(
                f"no box with {bits} bits could be proved for branch {self.sign_text}"
            )
        return replace(self, root=root)

    @property
    def exact_heights(self) -> dict[int, Any] | None:
        """The height of every vertex as an exact number; None if that is not quickly known.

        A height is a `Fraction` or a sympy number. If it has degree 2 over Q, it is given in
        radicals; for higher degrees it is the root of its minimal polynomial in an isolating
        interval (`CRootOf`). Known are roots that an exact engine found, as in a count with
        `method="groebner"` or with flat vertices. For other branches of a count, the heights are
        computed here if at most four vertices are foldable, or if the heights are rational. For
        `find_branch`, known are heights that it proved to be rational.

        >>> from exactfold.branches.counting.collect import count_branches
        >>> count_branches("single-vertex-4")["+"].exact_heights[4]
        Fraction(1, 2)
        """
        if self.root is None:
            return None
        if isinstance(self.root, EnclosedRoot):
            return self.root.exact_heights
        unit = self.unit_row
        heights = {v: self.root.exact(row, unit) for v, row in self.height_rows.items()}
        return None if None in heights.values() else heights

    @property
    def straight_boundary(self) -> tuple[int, ...]:
        """Boundary vertices on a straight side of a branch with given boundary heights.

        The side may bend there. `pattern.boundary_turns` is 0 at these vertices.
        """
        if self.gauge != "rim":
            return ()
        turns = zip(self.pattern.boundary, self.pattern.boundary_turns, strict=True)
        return tuple(sorted(v for v, turn in turns if not turn))

    @property
    def boundary_heights(self) -> dict[int, Fraction] | None:
        """The boundary heights that were given; None in another gauge, or if nothing is proved.

        >>> from exactfold.branches.counting.find import find_branch
        >>> from exactfold.pattern.families import single_vertex
        >>> branch = find_branch(single_vertex(5), "+")
        >>> sorted(map(str, branch.boundary_heights.values()))
        ['-1', '0', '0', '0', '11/20']
        """
        if self.gauge != "rim" or not isinstance(self.root, EnclosedRoot):
            return None
        return {v: self.root.centres[v] for v in sorted(self.pattern.boundary)}

    @property
    def approx_heights(self) -> dict[int, float]:
        """Heights as floats, for pictures."""
        return {v: float((low + high) / 2) for v, (low, high) in self.heights.items()}

    @cached_property
    def fold_angles(self) -> FoldAngles:
        """The proportions of the angles by which the folds start to bend (`fold_angles`).

        Raises `UsageError` if nothing is proved of the heights.
        """
        return fold_angles(self.pattern, self.heights, self.assignment)

    @property
    def radius(self) -> Fraction | None:
        """A bound of the error of each of `centres`; None unless `find_branch` found the branch."""
        return self.root.radius if isinstance(self.root, EnclosedRoot) else None

    @property
    def squared_distance(self) -> Fraction | None:
        """A bound of the integral of |grad(h - centres)|^2; None unless `find_branch` found the
        branch.
        """
        return self.root.squared_distance if isinstance(self.root, EnclosedRoot) else None

    @property
    def centres(self) -> dict[int, Fraction]:
        """The middles of the bounds of all heights."""
        if isinstance(self.root, EnclosedRoot):
            return dict(self.root.centres)
        return {v: (low + high) / 2 for v, (low, high) in self.heights.items()}

    def sort_key(self) -> tuple[list[int], str]:
        """The vertex signs in the order of the vertices, -1 before 0 before +1, then the
        letters.
        """
        return [self.vertex_signs[v] for v in sorted(self.vertex_signs)], self.assignment_text

    def entry(self) -> ListedBranch:
        """The object of the branch in the list of `exactfold count --json`."""
        return {
            "vertex_signs": {str(v): s for v, s in sorted(self.vertex_signs.items())},
            "assignment": {f"{i}-{j}": a for (i, j), a in sorted(self.assignment.items())},
            "multiplicity": self.multiplicity,
            "representative": self.representative,
            "heights": {
                str(v): [format_rational(low), format_rational(high)]
                for v, (low, high) in sorted(self.heights.items())
            },
        }

    def to_dict(self, name: str | None = None) -> BranchDocument:
        """The object printed by `exactfold branch --json`: `schema("branch")`."""
        radius, squared = self.radius, self.squared_distance
        return {
            "format": "exactfold branch result",
            "version": 2,
            "pattern": described(self.pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "vertex_signs": {str(v): s for v, s in sorted(self.vertex_signs.items())},
            "undecided_vertices": list(self.undecided_vertices),
            "assignment": {f"{i}-{j}": a for (i, j), a in sorted(self.assignment.items())},
            "gauge": self.gauge,
            "curvature": {str(v): format_rational(k) for v, k in sorted(self.curvature.items())},
            "straight_border": list(self.straight_boundary),
            "saddle": self.saddle,
            "centres": {str(v): format_rational(c) for v, c in sorted(self.centres.items())},
            "radius": None if radius is None else format_rational(radius),
            "squared_distance": None if squared is None else format_rational(squared),
            "steps": self.steps,
            "warnings": warnings(self.pattern),
            "seconds": round(self.seconds, 3),
        }

    def __repr__(self) -> str:
        signs, letters = (
            text if len(text) <= 32 else f"{text[:29]}..."
            for text in (self.sign_text, self.assignment_text)
        )
        times = "" if self.multiplicity in (None, 1) else f", multiplicity {self.multiplicity}"
        return f"<Branch {signs}: {self.status}, {letters}{times}>"


def _quotient(top: Bounds, bottom: Bounds) -> Bounds:
    """Bounds of a quotient whose divisor is positive."""
    (a, b), (low, high) = top, bottom
    if low <= 0:
        raise ArithmeticError("the unit of a branch is not proved to be positive")
    return min(a / low, a / high), max(b / low, b / high)
