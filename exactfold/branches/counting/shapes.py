"""Counts the shapes of a sheet whose vertices have angle deficits."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from itertools import product
from typing import Annotated, Literal, TypedDict

from exactfold._support.documents import (
    Keywords,
    Pair,
    Positive,
    Rational,
    VerdictText,
    VertexText,
)
from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.counting.find import BoundaryHeights, BranchFinder, Deficits
from exactfold.exact.numbers import format_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.described import PatternDocument, described
from exactfold.pattern.loading import PatternLike, as_pattern

MOST_LISTED = 10
"""With at most this many vertices, shapes that may coincide are found one by one."""


class ShapesDocument(TypedDict):
    """The shapes of a sheet with given angle deficits and given boundary heights."""

    format: Literal["exactfold shapes result"]
    version: Literal[1]
    pattern: PatternDocument
    status: VerdictText
    reason: str
    distinct: Positive | None
    bounds: Pair[Positive]
    """The least and the greatest number that `distinct` can be."""
    with_multiplicity: Annotated[int, Keywords(minimum=2)]
    curvature: dict[VertexText, Rational]
    """Angle deficits that are not 0, by interior vertex."""
    rim: dict[VertexText, Rational]
    """Heights of the boundary vertices."""
    signs: list[Annotated[str, Keywords(pattern="^[-+0]+$")]]
    """Vertex signs of each shape, if the shapes were found one by one."""


@dataclass(frozen=True, repr=False)
class ShapeCount:
    """The number of shapes with given angle deficits and boundary heights, PROVED or UNDECIDED.

    `distinct` lies between the two `bounds`, which agree if the status is PROVED.
    `with_multiplicity` is 2^n for n vertices that can pop. `signs` has the vertex signs of each
    different shape (0 for a flat star) if the shapes were found one by one; otherwise it is empty.
    """

    pattern: CreasePattern
    curvature: Mapping[int, Fraction]
    boundary_heights: Mapping[int, Fraction]
    status: Verdict
    reason: str
    bounds: tuple[int, int]
    with_multiplicity: int
    signs: tuple[str, ...] = ()

    @property
    def distinct(self) -> int | None:
        """The number of different shapes; None if it is not known."""
        return self.bounds[0] if self.status is PROVED else None

    def to_dict(self, name: str | None = None) -> ShapesDocument:
        """The object printed by `exactfold count --curvature --json`: `schema("shapes")`."""
        return {
            "format": "exactfold shapes result",
            "version": 1,
            "pattern": described(self.pattern, name),
            "status": str(self.status),
            "reason": self.reason,
            "distinct": self.distinct,
            "bounds": list(self.bounds),
            "with_multiplicity": self.with_multiplicity,
            "curvature": {str(v): format_rational(k) for v, k in sorted(self.curvature.items())},
            "rim": {str(v): format_rational(h) for v, h in sorted(self.boundary_heights.items())},
            "signs": list(self.signs),
        }

    def __repr__(self) -> str:
        low, high = self.bounds
        number = counted(low, "shape") if low == high else f"{low} to {high} shapes"
        return f"<ShapeCount: {self.status}, {number} of {self.pattern!r}>"


def count_shapes(
    pattern: PatternLike,
    curvature: Deficits,
    *,
    boundary_heights: BoundaryHeights | None = None,
    progress: Progress | None = None,
) -> ShapeCount:
    """Count the shapes of a convex sheet with given angle deficits and boundary heights.

    If n vertices can pop and each has a positive deficit, there are exactly 2^n shapes, one for
    each sign vector (docs/branch.md, Angle deficits). If some deficits are 0, there are 2^n shapes
    with multiplicity, and shapes coincide only if stars are flat. For at most ten vertices, all
    shapes are found and proved. For more vertices, the number lies between 2^p, for p positive
    deficits, and 2^n. `boundary_heights` gives the boundary heights, which are 0 by default. Raises
    the errors of `find_branch`.

    >>> from exactfold.pattern.families import single_vertex
    >>> count_shapes(single_vertex(5), {5: "1/10"})
    <ShapeCount: proved, 2 shapes of <CreasePattern: 1 interior and 5 boundary vertices>>
    """
    finder = BranchFinder(as_pattern(pattern), boundary_heights, curvature)
    problem = finder.problem
    gauge, size = problem.gauge, problem.size
    curved = {problem.labels[v]: k for v, k in gauge.curvature.items()}
    heights = {problem.labels[v]: h for v, h in gauge.boundary_heights.items()}

    def made(
        status: Verdict, reason: str, bounds: tuple[int, int], signs: tuple[str, ...] = ()
    ) -> ShapeCount:
        return ShapeCount(finder.pattern, curved, heights, status, reason, bounds, 1 << size, signs)

    least, most = 1 << len(curved), 1 << size
    if least == most:
        return made(PROVED, "every deficit is positive: one for each sign vector", (most, most))
    if size > MOST_LISTED:
        reason = f"stars may be flat at the {size - len(curved)} vertices without a deficit"
        return made(UNDECIDED, reason, (least, most))
    texts = set()
    for k, signs in enumerate(product((-1, 1), repeat=size)):
        if progress is not None:
            progress("shapes", k, most)
        shape = finder.find(dict(zip(finder.poppable, signs, strict=True)))
        if shape.status is not PROVED:
            return made(UNDECIDED, shape.reason, (least, most))
        texts.add("".join("0+-"[shape.vertex_signs[v]] for v in finder.poppable))
    ordered = tuple(sorted(texts))
    return made(PROVED, "found one by one", (len(texts), len(texts)), ordered)
