"""Signs, letters and heights of the sheet without rigid parts, as those of the given sheet."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

from exactfold.branches.periodic.exactly import ExactRay
from exactfold.branches.periodic.result import AlgebraicLine, HeightSpace, PeriodicBranch
from exactfold.branches.values.letters import LETTERS, SIGNS, UPSIDE_DOWN
from exactfold.pattern.periodic.cells import Corner
from exactfold.pattern.validate import orientation
from exactfold.rigidity.equations.periodic import PeriodicProblem, Row

_BITS = 40


@dataclass(frozen=True)
class Shown:
    """What a problem found, in the vertices and edges of its given pattern."""

    problem: PeriodicProblem

    @cached_property
    def _edges(self) -> list[int | None]:
        """For each edge of the pattern its place among the edges of the sheet; None inside."""
        places = {v: k for k, v in enumerate(self.problem.labels)}
        known = {edge: k for k, edge in enumerate(self.problem.sheet.edges)}
        return [
            known[places[u], places[v], i, j] if u in places and v in places else None
            for u, v, i, j in self.problem.pattern.edges
        ]

    def signs(self, signs: Sequence[int]) -> str:
        """The signs of all vertices; those in triangulated triangles are 0."""
        at = dict(zip(self.problem.labels, signs, strict=True))
        return "".join(SIGNS[at.get(v, 0)] for v in range(self.problem.pattern.V))

    def branch(self, signs: Sequence[int], b: int, letters: str) -> PeriodicBranch:
        """A branch with these signs and letters of the sheet, on the side that is shown."""
        text = self.signs(signs)
        full = "".join("F" if k is None else letters[k] for k in self._edges)
        if text.strip("0")[:1] == "-":
            text, full, b = text.translate(UPSIDE_DOWN), full.translate(UPSIDE_DOWN), -b
        return PeriodicBranch(text, b, full, 1 << text.count("0"))

    def exact_branch(self, ray: Row) -> PeriodicBranch:
        """The branch of a rational ray."""

        def sign(row: Sequence[int]) -> int:
            value = sum(c * x for c, x in zip(row, ray, strict=True))
            return (value > 0) - (value < 0)

        signs = [sign(row) for row in self.problem.vertices.values()]
        letters = "".join(LETTERS[sign(row)] for row in self.problem.folds.values())
        return self.branch(signs, sign(self.problem.bend), letters)

    def algebraic(self, ray: ExactRay) -> AlgebraicLine:
        """A line of pleats in the heights w of all vertices, each a polynomial.

        The heights are linear in z, so each coefficient is a height for the coefficients of z.
        """
        root_class = ray.root.root_class
        columns = [self._heights(column)[:-1] for column in zip(*ray.entries, strict=True)]
        heights = tuple(zip(*columns, strict=True))
        return AlgebraicLine(root_class.polynomial, ray.root.interval(_BITS), heights)

    def space(self, basis: Sequence[Row]) -> HeightSpace:
        """A space in the heights w of all vertices, 0 at the first, and b."""
        return HeightSpace(tuple(tuple(self._heights(row)) for row in basis))

    def pairs(self, point: Sequence[tuple[Fraction, Fraction]]) -> list[tuple[Fraction, Fraction]]:
        """The heights w and b of a point with two rational parts."""
        one, other = ([pair[k] for pair in point] for k in (0, 1))
        heights = self._heights(tuple(one)), self._heights(tuple(other))
        return list(zip(*heights, strict=True))

    def _heights(self, row: Row) -> list[Fraction]:
        problem = self.problem
        b = row[-1] * problem.unit
        w = dict(zip(problem.labels, (Fraction(0), *row[:-1]), strict=True))
        for ring, inside in problem.parts.triangles:
            for corner in inside:
                w[corner[0]] = self._inside(ring, corner, w, b)
        return [*(w[v] - w[0] for v in range(problem.pattern.V)), b]

    def _inside(
        self, ring: Sequence[Corner], corner: Corner, w: dict[int, Fraction], b: Fraction
    ) -> Fraction:
        """The height w of a vertex in a flat ring, whose plane is that of the three corners."""
        place = self.problem.pattern.place
        spots, point = [place(c) for c in ring], place(corner)
        whole = orientation(*spots)
        total = -b * self._square(point) / 2
        for k, (v, _, _) in enumerate(ring):
            share = orientation(spots[k - 2], spots[k - 1], point) / whole
            total += share * (w[v] + b * self._square(spots[k]) / 2)
        return total

    def _square(self, point: Sequence[Fraction]) -> Fraction:
        """(n . x)^2."""
        p, q = self.problem.direction
        along = p * point[0] + q * point[1]
        return along * along


def sorted_branches(branches: Iterable[PeriodicBranch]) -> tuple[PeriodicBranch, ...]:
    """Branches in the order of their vertex signs: down before flat before up."""
    return tuple(sorted(branches, key=lambda branch: branch.vertex_signs.translate(_ORDER)))


_ORDER = str.maketrans("-0+", "012")
