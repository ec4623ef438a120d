"""Exact roots with exact multiplicities, and the proof that there are no others."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from exactfold.certify.dual_space import DualSpace, dual_space
from exactfold.certify.multiplicity import check_dual_space
from exactfold.exact.numbers import format_integer, format_rational
from exactfold.rigidity.definite_stress import definite_stress
from exactfold.solve.exact_solution import ExactSolution, RootClass
from exactfold.system.branch_system import Chart
from exactfold.verdict import PROVED, UNDECIDED, Verdict


@dataclass(frozen=True)
class AlgebraicProof:
    """Root classes with dual spaces, and multipliers of a definite stress of the closed sheet.

    The stress leaves no zero on a hyperplane of P^n (docs/mathematics.md, 8), so there are
    finitely many zeros and their multiplicities add up to 2^n. Dual spaces bound the multiplicities
    from below; where the bounds add up to 2^n they are exact and no zero is missing.
    """

    classes: tuple[tuple[RootClass, DualSpace], ...]
    multipliers: tuple[Fraction, ...]
    complete: Verdict
    reason: str

    @property
    def roots(self) -> list[tuple[RootClass, int, int]]:
        """(class, index among its real roots, multiplicity) of every real zero."""
        return [
            (root_class, index, dual.dimension)
            for root_class, dual in self.classes
            for index in range(len(root_class.real_roots(8)))
        ]

    @property
    def distinct(self) -> int:
        """Number of different zeros, real or not."""
        return sum(root_class.degree for root_class, _ in self.classes)


def prove_algebraic(chart: Chart, solution: ExactSolution) -> AlgebraicProof:
    """Prove what the exact solver found for the system of a chart.

    `complete` is UNDECIDED, with a reason, if a stress or a sum of multiplicities is missing; that
    does not mean that roots are missing. Raises `DualSpaceError` if a root fails its check.
    """
    closed = chart.branch_system.pattern.with_notch_closed()
    stress = definite_stress(closed)
    classes = []
    for root_class in solution.classes:
        dual = dual_space(chart.system, root_class, root_class.multiplicity)
        check_dual_space(chart.system, root_class, dual)
        classes.append((root_class, dual))
    total = sum(c.degree * dual.dimension for c, dual in classes)
    multipliers = () if stress is None else tuple(stress[v] for v in closed.interior)
    if stress is None:
        verdict, reason = UNDECIDED, "no definite stress was found: finiteness is not proved"
    elif total != chart.system.bezout_number:
        verdict = UNDECIDED
        reason = f"proved multiplicities add up to {total}, not {chart.system.bezout_number}"
    else:
        verdict, reason = PROVED, "multiplicities by dual spaces add up to the Bezout number"
    return AlgebraicProof(tuple(classes), multipliers, verdict, reason)


def algebraic_evidence(
    proof: AlgebraicProof, roots: list[tuple[RootClass, int]], bits: int = 64
) -> dict[str, Any]:
    """The proof as certificate evidence, with the real roots in the order of the branches."""
    position = {id(root_class): k for k, (root_class, _) in enumerate(proof.classes)}
    return {
        "multipliers": [format_rational(m) for m in proof.multipliers],
        "separating": list(proof.classes[0][0].separating),
        "classes": [
            {
                "polynomial": [format_integer(c) for c in root_class.polynomial],
                "numerators": [[format_rational(c) for c in w] for w in root_class.numerators],
                "multiplicity": dual.dimension,
                "functionals": [
                    {
                        "pivot": list(pivot),
                        "terms": [
                            [list(a), [format_rational(c) for c in coefficient]]
                            for a, coefficient in sorted(functional.items())
                        ],
                    }
                    for functional, pivot in zip(dual.functionals, dual.pivots, strict=True)
                ],
            }
            for root_class, dual in proof.classes
        ],
        "roots": [
            {
                "class": position[id(root_class)],
                "interval": [format_rational(x) for x in root_class.real_roots(bits)[index]],
            }
            for root_class, index in roots
        ],
    }
