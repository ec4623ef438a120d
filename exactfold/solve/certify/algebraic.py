"""Proves exact roots with exact multiplicities, and that there are no others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.rigidity.definite_stresses import definite_stress
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.flat_sheets import FlatSheets
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.algebraic.flat_zeros import flat_equations
from exactfold.solve.certify.box import IsolatingBox

FlatBox = tuple[FlatSheets, IsolatingBox]
"""Sheets that are flat at given vertices, and a box in the unknowns of these sheets."""


@dataclass(frozen=True)
class AlgebraicProof:
    """Root classes with their flat vertices, boxes, and the multipliers of a definite stress.

    The stress leaves no zero on a hyperplane of P^n (docs/mathematics.md, Multiple solutions). So
    there are finitely many zeros, and their multiplicities add up to 2^n. The multiplicity of an
    isolated zero is at least the product of the orders of the equations, hence at least 2^f if f
    vertices are flat. Each box contains one regular zero. If these bounds and the boxes add up to
    2^n, the bounds are exact and no zero is missing.
    """

    classes: tuple[tuple[RootClass, tuple[int, ...]], ...]
    boxes: tuple[IsolatingBox, ...]
    flat_boxes: tuple[FlatBox, ...]
    multipliers: tuple[Fraction, ...]
    complete: Verdict
    reason: str

    @property
    def roots(self) -> list[tuple[RootClass, int, int]]:
        """(class, index among its real roots, multiplicity) of each real zero outside the boxes."""
        return [
            (root_class, index, 1 << len(flat))
            for root_class, flat in self.classes
            for index in range(len(root_class.real_roots(8)))
        ]

    @property
    def distinct(self) -> int:
        """The number of different zeros, real or not."""
        boxes = len(self.boxes) + len(self.flat_boxes)
        return sum(root_class.degree for root_class, _ in self.classes) + boxes


def prove_algebraic(
    chart: Chart,
    classes: Sequence[RootClass],
    boxes: Sequence[IsolatingBox] = (),
    flat_boxes: Sequence[FlatBox] = (),
) -> AlgebraicProof:
    """Proves that these classes and boxes are all zeros of the system of a chart.

    The classes must have different irreducible polynomials in one separating form. The boxes of
    each kind must be disjoint, and the caller must make sure that no zero is in two kinds.
    `complete` is UNDECIDED, with a reason, if a stress is missing or the multiplicities do not add
    up to 2^n; that does not mean that roots are missing. Raises `SolverError` if a root
    fails its check.
    """
    closed = chart.branch_system.pattern.with_notch_closed()
    stress = definite_stress(closed)
    proved = []
    for root_class in classes:
        root_class.verify(chart.system)
        proved.append((root_class, flat_equations(chart, root_class)))
    total = sum(c.degree << len(flat) for c, flat in proved) + len(boxes)
    total += sum(1 << len(sheets.vertices) for sheets, _ in flat_boxes)
    if stress is None:
        verdict, reason = UNDECIDED, "no definite stress was found: finiteness is not proved"
    elif len({c.separating for c in classes}) > 1 or len({c.polynomial for c in classes}) < len(
        classes
    ):
        verdict, reason = UNDECIDED, "two classes of zeros may share a root"
    elif total != chart.system.bezout_number:
        verdict = UNDECIDED
        reason = f"the proved multiplicities add up to {total}, not {chart.system.bezout_number}"
    else:
        verdict, reason = PROVED, "the multiplicities 2^(flat vertices) add up to the Bezout number"
    multipliers = () if stress is None else tuple(stress[v] for v in closed.interior)
    return AlgebraicProof(
        tuple(proved), tuple(boxes), tuple(flat_boxes), multipliers, verdict, reason
    )
