"""The equations K_v = 0 of a sheet with four boundary vertices, in an affine chart."""

from __future__ import annotations

from fractions import Fraction
from math import gcd, lcm
from typing import Any

from ..core.reading import CertificateError, parse_integer, parse_rational, require
from .sheet import Form, Sheet, turn


class BranchSystem:
    """K_v = 0 with three boundary vertices at height 0, in an affine chart.

    By default the fourth boundary vertex, `unit`, has height 1. It is the first vertex, in cyclic
    order from the smallest index, at which the affine dependency of the four (the boundary saddle)
    does not vanish. So the saddle is positive. If a functional is given, `unit` is the reflex
    corner, and its height is chosen so that the functional is 1.
    """

    def __init__(self, sheet: Sheet, functional: dict[int, Fraction] | None) -> None:
        self.sheet, b = sheet, sheet.boundary
        corners = [sheet.points[v] for v in b]
        saddle = [turn(*(corners[:k] + corners[k + 1 :])) * (-1) ** k for k in range(4)]
        first = next(k for k in range(4) if saddle[k])
        self.saddle = {v: weight / saddle[first] for v, weight in zip(b, saddle, strict=True)}
        self.unit = b[first]
        if functional is not None:
            turns = [turn(corners[k - 1], corners[k], corners[(k + 1) % 4]) for k in range(4)]
            reflex = [v for v, t in zip(b, turns, strict=True) if t < 0]
            require(reflex, "a chart other than the saddle's needs a reflex corner")
            self.unit = reflex[0]  # the other three corners span a triangle
            known = set(functional) <= {self.unit, *sheet.interior}
            require(
                known, "the chart functional uses a vertex that is neither its corner nor interior"
            )
        functional = functional or {self.unit: Fraction(1)}
        lead = functional.get(self.unit)
        require(lead, "the chart functional does not fix the height of its corner")
        self.size = len(sheet.interior)
        self.lifts: dict[int, dict[int, Fraction]] = {v: {} for v in b}  # heights by (x, 1)
        self.lifts |= {v: {k: Fraction(1)} for k, v in enumerate(sheet.interior)}
        weights = {k: -functional.get(v, Fraction(0)) for k, v in enumerate(sheet.interior)}
        weights[self.size] = Fraction(1)
        self.lifts[self.unit] = {k: w / Fraction(lead or 1) for k, w in weights.items() if w}
        self.quadrics = [self._quadric(sheet.curvature(v)) for v in sheet.interior]

    def _quadric(self, form: Form) -> dict[tuple[int, int], int]:
        """A form of the heights as a form in (x, 1), with coprime integer coefficients."""
        rows: Form = {}
        for (i, j), w in form.items():
            for p, x in self.lifts[i].items():
                for q, y in self.lifts[j].items():
                    rows[p, q] = rows.get((p, q), Fraction(0)) + w * x * y
        scale = lcm(*(w.denominator for w in rows.values()))
        whole = {pq: int(w * scale) for pq, w in rows.items() if w}
        common = gcd(*whole.values())
        return {pq: w // common for pq, w in whole.items()}

    def row(self, functional: dict[int, Fraction]) -> list[int]:
        """A linear functional of the heights as integers (c_1, ..., c_n, c_0).

        It is multiplied by a positive number, so that it keeps its sign.
        """
        row = [Fraction(0)] * (self.size + 1)
        for v, weight in functional.items():
            for place, x in self.lifts[v].items():
                row[place] += weight * x
        scale = lcm(*(w.denominator for w in row))
        return [int(w * scale) for w in row]


def read_chart(evidence: Any) -> dict[int, Fraction] | None:
    """The functional of the chart, or None if the evidence names none."""
    if evidence is None:
        return None
    if not isinstance(evidence, dict):
        raise CertificateError("the chart is neither null nor a functional")
    chart = {parse_integer(v): parse_rational(c) for v, c in evidence.items()}
    require(len(chart) == len(evidence), "a vertex appears twice in the chart")
    return chart
