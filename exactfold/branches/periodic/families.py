"""The directions in which a periodic sheet with pleats has families, for all n together.

A family is a linear space of solutions for one n on which b is not 0; where b is 0 it holds a pleat
p. Let F be the flat vertices of p, and T the space of all z = w + x^T B x / 2, with any B, that
have K_u(p, z) = 0 for all u that are not in F. By (L) these K_u are <= 0 on T, so that solutions in
T lie in their radicals. If F is empty, the radicals are a linear space of solutions, on which
det B = 0 by Lemma 1, so that all B are multiples of one n n^T. Pleats with the same flat vertices
and, elsewhere, the same signs have the same families (docs/tessellations.md, Theorem 21).
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, pairwise

from exactfold._support.clock import Clock
from exactfold.branches.periodic.counting import pleat_spaces
from exactfold.branches.periodic.crossings import MOST_UNKNOWNS, Place
from exactfold.branches.periodic.directions_result import ExactDirection
from exactfold.branches.periodic.lines import polar
from exactfold.branches.periodic.result import PeriodicCount
from exactfold.branches.periodic.spaces import chart_where_one, combined, dot, echelon, image
from exactfold.exact.linalg import nullspace
from exactfold.rigidity.equations.all_directions import AllDirections, FlatStar
from exactfold.rigidity.equations.periodic import Row, direction_of
from exactfold.rigidity.equations.quadratic import QuadraticSystem, primitive_matrices
from exactfold.solve.algebraic.groebner_bases import UNDER_LIMIT, classes_of_ideal
from exactfold.solve.algebraic.quotient import sparse_quadrics

_ZEROS = (Fraction(0),) * 3


class OpenFamiliesError(Exception):
    """The directions with families are not known; the text says why."""


@dataclass(frozen=True)
class Families:
    """Finds the directions with families, from a proved count for any direction."""

    problem: AllDirections
    base: PeriodicCount
    clock: Clock

    def directions(self) -> tuple[ExactDirection, ...]:
        """All directions in which there are families, counter-clockwise; (1, 0) is the last.

        Raises `OpenFamiliesError`.
        """
        evidence = self.base.evidence
        if evidence is None:
            raise OpenFamiliesError("a pleat lies in no quadratic field")
        found: list[ExactDirection] = []
        for basis in pleat_spaces(dict.fromkeys(cover.space for cover in evidence.covers)):
            for pleat in self._patterns([(*row[:-1], *_ZEROS) for row in basis]):
                found += self._of(pleat, 0)
        for line in evidence.lines:
            if not line.ray.b:
                parts = ([pair[k] for pair in line.point[:-1]] for k in (0, 1))
                found += self._of([*chain(*((*part, *_ZEROS) for part in parts))], line.radicand)
        return tuple(sorted(dict.fromkeys(found), key=lambda direction: direction.angle))

    def _patterns(self, basis: Sequence[Row]) -> Iterator[Row]:
        """A pleat for each pattern of signs and flat vertices in a space of pleats, up to its sign.

        The row of a vertex is 0 exactly where the pleat is flat there.
        """
        if len(basis) > 2:
            raise OpenFamiliesError(
                f"pleats form a space of dimension {len(basis)}; 2 is the most that is treated"
            )
        yield basis[0]
        if len(basis) == 1:
            return
        rows = [[*map(Fraction, row)] for row in self.problem.vertices]
        values = [(dot(row, basis[0]), dot(row, basis[1])) for row in rows]
        walls = sorted({-b / a for a, b in values if a})  # x basis[0] + basis[1] is flat somewhere
        ends = [walls[0] - 1, walls[-1] + 1] if walls else [Fraction(0)]
        for x in (*walls, *ends, *((a + b) / 2 for a, b in pairwise(walls))):
            yield combined([x, Fraction(1)], basis)

    def _of(self, pleat: Sequence[Fraction], radicand: int) -> list[ExactDirection]:
        """The directions with families that hold a pleat (p, q), which is p + q sqrt(radicand)."""
        if self.clock.passed:
            raise OpenFamiliesError(self.clock.said)
        width = self.problem.size + 3
        parts = [pleat[k : k + width] for k in range(0, len(pleat), width)]
        rows = [[*map(Fraction, row)] for row in self.problem.vertices]
        forms = [star.form for star in self.problem.stars]
        flat = [v for v, row in enumerate(rows) if not any(dot(row, part) for part in parts)]
        rest = [form for v, form in enumerate(forms) if v not in flat]
        space = nullspace([row for form in rest for row in polar(form, pleat, radicand)])
        radicals = [
            [dot(row, a) for a in space]
            for form in rest
            for z in space
            for row in polar(form, z, radicand)
        ]
        space = [[*combined(w, space)] for w in nullspace(radicals)]
        bent = [z for z in space if any(any(z[k - 3 : k]) for k in range(width, len(z) + 1, width))]
        if not bent:
            return []
        if radicand:
            raise OpenFamiliesError("a pleat over a quadratic field may belong to families")
        left = [forms[v] for v in flat]
        if all(not dot(image(form, z), a) for form in left for z in space for a in space):
            c_11, c_12, _ = bent[0][-3:]
            n = direction_of((c_11, c_12) if c_11 else (0, 1))
            return [ExactDirection.of((0, 1), (_ZEROS[0],) * 2, n[:1], n[1:])]
        return self._solved(space, left)

    def _solved(
        self, space: Sequence[Sequence[Fraction]], forms: Sequence[Sequence[Row]]
    ) -> list[ExactDirection]:
        """The directions of all solutions in a space, of which some forms are left, with B not 0.

        What changes neither the forms nor B is left out.
        """
        kernel = nullspace(
            [
                *([dot(row, z) for z in space] for row in self.problem.bend_rows()),
                *([dot(image(form, z), a) for a in space] for form in forms for z in space),
            ]
        )
        pivots = {next(k for k, c in enumerate(row) if c) for row in echelon(kernel)}
        kept = [z for k, z in enumerate(space) if k not in pivots]
        columns = chart_where_one(kept, self.problem.level)
        if columns is None or len(kept) == 1:  # B is indefinite, or some form is not 0
            return []
        size = len(columns) - 1
        star = FlatStar(
            tuple(zip(*columns, strict=True)),
            tuple(
                tuple(tuple(dot(image(form, a), c) for c in columns) for a in columns)
                for form in forms
            ),
        )
        system = QuadraticSystem(primitive_matrices(star.forms))
        if size > MOST_UNKNOWNS:
            raise OpenFamiliesError(f"{size} unknowns are too many for a Groebner basis")
        if size > UNDER_LIMIT and self.clock.limit is not None:
            raise OpenFamiliesError(f"{size} unknowns are too many under a limit of time")
        classes = classes_of_ideal(sparse_quadrics(system), size)
        if classes is None:
            raise OpenFamiliesError("a pleat with flat vertices has families along a whole curve")
        for zeros in classes:
            zeros.verify(system)
        return [
            real.direction(self.problem)
            for zeros in classes
            for real in Place(star, zeros, (), flips=False).real()
        ]
