"""Projective maps of sheets: they also map curvature forms, and so branches."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction

from exactfold.errors import NotApplicableError, UsageError
from exactfold.exact.numbers import RationalLike, as_rational
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.pattern.loading import PatternLike, as_pattern


@dataclass(frozen=True)
class ProjectiveImage:
    """A sheet and its image under a projective map of the plane (docs/generic.md, Theorem 10).

    `factors` are the numbers mu_v > 0 with (1, U_v) L = mu_v (1, U'_v), by vertex, and
    `determinant` is |det L| > 0. Heights h of `source` become heights h_v / mu_v of `pattern`. The
    curvature forms then satisfy K'_v(h') = mu_v K_v(h) / determinant. All numbers are rational.
    """

    source: CreasePattern
    pattern: CreasePattern
    factors: tuple[Fraction, ...]
    determinant: Fraction

    def __repr__(self) -> str:
        return f"<ProjectiveImage: {self.pattern!r}>"

    def heights(self, heights: Mapping[int, Fraction]) -> dict[int, Fraction]:
        """The heights h_v / mu_v of the image, by vertex.

        >>> image = project("flat-vertex", [(1, 0, 0), ("1/8", 1, 0), (0, 0, 1)])
        >>> image.heights({1: Fraction(1)})
        {1: Fraction(8, 9)}
        """
        return {v: height / self.factors[v] for v, height in heights.items()}


def project(pattern: PatternLike, matrix: Sequence[Sequence[RationalLike]]) -> ProjectiveImage:
    """The image of a sheet under the projective map of a rational matrix L with three rows.

        (1, x, y) L = mu (1, x', y')

    (docs/generic.md, Theorem 10). The image has the same triangles and the same branches, with
    equal vertex signs, letters and multiplicities. Raises `UsageError` unless the matrix is an
    invertible 3 x 3 matrix, and `NotApplicableError` if the line that the map sends to infinity
    meets the sheet, as then the image is not a sheet.

    >>> image = project("flat-vertex", [(1, 0, 0), ("1/8", 1, 0), (0, 0, 1)])
    >>> image.determinant, [str(mu) for mu in image.factors]
    (Fraction(1, 1), ['1', '9/8', '9/8', '1', '17/16', '87/80'])
    >>> from exactfold.branches import count_branches
    >>> [branch.multiplicity for branch in count_branches(image.pattern)]
    [1, 1, 2]
    """
    pattern = as_pattern(pattern)
    rows = [[as_rational(entry) for entry in row] for row in matrix]
    if [len(row) for row in rows] != [3, 3, 3]:
        raise UsageError("the matrix of a projective map must have three rows of three numbers")
    determinant = sum(
        rows[0][i] * (rows[1][i - 2] * rows[2][i - 1] - rows[1][i - 1] * rows[2][i - 2])
        for i in range(3)
    )
    if determinant == 0:
        raise UsageError("the matrix of a projective map must be invertible")
    images = [
        tuple(rows[0][k] + x * rows[1][k] + y * rows[2][k] for k in range(3))
        for x, y in pattern.vertices
    ]
    side = 1 if images[0][0] > 0 else -1
    for v, image in enumerate(images):
        if side * image[0] <= 0:
            raise NotApplicableError(
                f"the line that the map sends to infinity passes vertex {v} or separates it from "
                "vertex 0"
            )
    mapped = CreasePattern([(a / mu, b / mu) for mu, a, b in images], pattern.triangles)
    factors = tuple(side * image[0] for image in images)
    return ProjectiveImage(pattern, mapped, factors, abs(determinant))
