"""Sets of folds that show that no space of motions holds one with given letters."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, Final

import numpy as np
from scipy.optimize import linprog

from exactfold._support.arrays import FloatArray
from exactfold.checker.core.reading import CertificateError, LimitError
from exactfold.checker.letters.panels_refuted import SIDES
from exactfold.checker.letters.panels_spaces import Exclusion
from exactfold.checker.panels.motions import Space
from exactfold.checker.sheets.panels import read_panels
from exactfold.design.refutations.refutation import Letters
from exactfold.errors import NotApplicableError
from exactfold.pattern.panel_entries import panels_document
from exactfold.pattern.panel_pattern import Edge, PanelPattern

_TINY: Final = 1e-9
_BITS: Final = 128


def excluded(
    pattern: PanelPattern, letters: Letters, vertices: Iterable[int], *, truly: bool
) -> list[Any]:
    """The step of a certificate: some vertices have no motion to second order with the letters.

    If `truly`, the step also shows that no motion but 0 has no fold against its letter.

    The checker's own search through the spaces is run, and each space that it cannot exclude with
    the sets found so far gets new ones. Raises `NotApplicableError` if no sets exclude a space.
    """
    sheet, _ = read_panels(panels_document(pattern))
    near = sheet.live(fold for fold, letter in letters.items() if letter == "F")
    sides = {fold: SIDES[letter] for fold, letter in letters.items() if letter in SIDES}
    search = _Excluding(sheet, {v: near[v] for v in vertices}, sides, [])
    try:
        shown = search.shown() and (not truly or search.still())
    except (CertificateError, LimitError) as error:
        raise NotApplicableError(f"no certificate can be written: {error}") from None
    if not shown:
        raise NotApplicableError(
            "no certificate can be written: the complete list of motions refutes the letters, and "
            "no sets of folds were found that exclude each space of the list"
        )
    folds = [[list(fold) for fold in some] for some in search.sets]
    return ["spaces", list(search.spaces.near), folds]


class _Excluding(Exclusion):
    """The search of the checker, which finds sets of folds where those known are not enough."""

    def flat(self, space: Space, own: set[Edge], *, every: bool = False) -> set[Edge]:
        found = super().flat(space, own, every=every)
        if self._enough(space, found, every):
            return found
        edges, turned = self._turned(space, own)
        for k, edge in enumerate(edges):
            if edge in found:
                continue
            solution = linprog(
                -np.eye(len(edges))[k],
                A_eq=np.vstack([turned.T, np.ones(len(edges))]),
                b_eq=np.append(np.zeros(len(space)), 1.0),
                method="highs-ds",
            )
            if solution.status != 0:
                return found
            if solution.x[k] < _TINY:
                continue
            some = [edges[i] for i in np.flatnonzero(solution.x > _TINY)]
            flat = self.related(space, some)
            if flat:
                self.sets.append(some)
                found.update(flat)
                if self._enough(space, found, every):
                    return found
        return found

    def _enough(self, space: Space, found: set[Edge], every: bool) -> bool:
        """Whether the folds that are flat exclude the space, or all of it but 0."""
        return self.rank(space, found) == len(space) if every else bool(found)

    def _turned(self, space: Space, own: set[Edge]) -> tuple[list[Edge], FloatArray]:
        """The folds, and their densities on the basis nearly, turned to the sides of their letters
        and scaled to size 1."""
        edges = sorted(own)
        matrix = np.array([[_float(motion.get(edge)) for motion in space] for edge in edges])
        matrix = matrix.reshape(len(edges), len(space))
        sizes = np.abs(matrix).max(axis=1, initial=0.0)
        sizes[sizes == 0] = 1.0
        return edges, matrix * (np.array([self.sides[edge] for edge in edges]) / sizes)[:, None]


def _float(value: Any) -> float:
    """A number of the checker, nearly; None stands for 0."""
    if value is None:
        return 0.0
    around = value.enclosed(_BITS)
    return float((around.low + around.high) / (2 << _BITS))
