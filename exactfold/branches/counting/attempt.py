"""One attempt at a count in one chart: what every way of proving it shares."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.registry import Choice
from exactfold.branches.values.result import BranchCount, Proof
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.chart_change import from_chart, to_chart
from exactfold.rigidity.equations.problem import Problem
from exactfold.solve.certify.algebraic import AlgebraicProof
from exactfold.solve.numeric.candidates import Candidates


@dataclass(frozen=True)
class Attempt:
    """A problem, a chart of its sheet, and the method that was chosen."""

    problem: Problem
    chart: Chart
    choice: Choice
    progress: Progress | None

    @property
    def total(self) -> int:
        """2^n, what the solutions in the chart must add up to."""
        return self.chart.system.bezout_number

    def stage(self, name: str) -> Callable[[int, int], None]:
        """Progress of one stage."""
        report = self.progress
        return lambda done, total: None if report is None else report(name, done, total)

    def in_chart(self, candidates: Candidates) -> Candidates:
        """Candidates found in the chart of the problem as points of this one."""
        candidates = candidates.finite()
        if self.chart == self.problem.chart:
            return candidates
        heights = from_chart(self.problem.chart, candidates.points.real)
        points = to_chart(self.chart, heights).astype(candidates.points.dtype)
        return replace(candidates, points=points)

    def undecided(self, reason: str, **known: Any) -> BranchCount:
        """An undecided count, with what is known."""
        choice = self.choice
        return BranchCount(
            self.problem.pattern, UNDECIDED, choice.method, reason=reason, why=choice.why, **known
        )

    def isolated(
        self, found: BranchCount, *, lines: tuple[str, ...] = (), **counts: Any
    ) -> BranchCount:
        """The same count, proved: 2^n disjoint boxes are all zeros, by refined Bezout.

        `lines` are those of the certificate, where the conveyor has written them.
        """
        reason = (
            f"{counted(self.total, 'solution')} isolated; by refined Bezout there are no others"
        )
        distinct = counts["real"] + counts["nonreal"]
        kind = "chambers" if lines else "isolated"
        counts |= {"distinct": distinct, "true_branches": PROVED}
        return self.proved(found, reason, kind, None, lines=lines, **counts)

    def proved(
        self,
        found: BranchCount,
        reason: str,
        kind: str,
        algebraic: AlgebraicProof | None,
        *,
        lines: tuple[str, ...] = (),
        **counts: Any,
    ) -> BranchCount:
        """The same count, proved."""
        problem, triangles = self.problem, self.problem.triangles or ()
        return replace(
            found,
            status=PROVED,
            reason=reason,
            with_multiplicity=self.total << problem.pattern.Vt,
            proof=Proof(kind, triangles, problem.labels, self.chart, algebraic, lines),
            **counts,
        )
