"""Vertex signs and the boundary saddle read from heights in floats, independent of the proofs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.motion.loops.rays import Ray
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.rigidity.functionals import saddle_functional, vertex_sign_functional


@dataclass(frozen=True)
class HeightSigns:
    """Reads vertex signs and the boundary saddle from heights in floats."""

    sheet: CreasePattern

    @cached_property
    def _rows(self) -> FloatArray:
        sheet = self.sheet
        functionals: list[Mapping[int, Fraction] | Mapping[int, int]] = [
            *(vertex_sign_functional(sheet, v) for v in sheet.interior),
            saddle_functional(sheet),
        ]
        rows = np.zeros((len(functionals), len(sheet.vertices)))
        for row, functional in zip(rows, functionals, strict=True):
            exact = {v: Fraction(c) for v, c in functional.items()}
            largest = max(map(abs, exact.values()))
            for v, c in exact.items():
                row[v] = float(c / largest)
        return rows

    def of(self, heights: FloatArray) -> Ray:
        """The ray whose tangent has these heights of all vertices, shape (V,)."""
        *signs, saddle = (int(s) for s in np.sign(self._rows @ heights))
        return Ray(tuple(signs), saddle)
