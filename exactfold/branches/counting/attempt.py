"""One attempt to prove all branches of a sheet with four corners, in one chart."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from exactfold._support.plurals import counted
from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED
from exactfold.branches.counting.registry import Choice
from exactfold.branches.values.result import BranchCount, Proof
from exactfold.rigidity.equations.branch_system import Chart
from exactfold.rigidity.equations.problem import Problem

if TYPE_CHECKING:
    from exactfold.solve.certify.algebraic import AlgebraicProof


@dataclass(frozen=True)
class Attempt:
    """A problem, a chart of its sheet, and the chosen method."""

    problem: Problem
    chart: Chart
    choice: Choice
    progress: Progress | None

    @property
    def total(self) -> int:
        """2^n, the number of solutions in the chart, with multiplicity."""
        return self.chart.system.bezout_number

    def stage(self, name: str) -> Callable[[int, int], None]:
        """The progress function of one stage."""
        report = self.progress
        return lambda done, total: None if report is None else report(name, done, total)

    def undecided(self, reason: str, **known: Any) -> BranchCount:
        """An undecided count with its reason and the facts that are known."""
        choice = self.choice
        return BranchCount(
            self.problem.pattern, UNDECIDED, choice.method, reason=reason, why=choice.why, **known
        )

    def isolated(
        self, count: BranchCount, *, lines: tuple[str, ...] = (), **counts: Any
    ) -> BranchCount:
        """The `count` as a proved one: 2^n disjoint boxes hold all zeros, by refined Bezout.

        `lines` are the lines of the certificate, if `BranchBlocks` has written them.
        """
        reason = (
            f"{counted(self.total, 'solution')} isolated; by refined Bezout there are no others"
        )
        distinct = counts["real"] + counts["nonreal"]
        kind = "chambers" if lines else "isolated"
        counts |= {"distinct": distinct, "true_branches": PROVED}
        return self.proved(count, reason, kind, None, lines=lines, **counts)

    def proved(
        self,
        count: BranchCount,
        reason: str,
        kind: str,
        algebraic: AlgebraicProof | None,
        *,
        lines: tuple[str, ...] = (),
        **counts: Any,
    ) -> BranchCount:
        """The `count` as a proved one, with its proof."""
        problem, triangles = self.problem, self.problem.triangles or ()
        return replace(
            count,
            status=PROVED,
            reason=reason,
            with_multiplicity=self.total << problem.pattern.Vt,
            proof=Proof(kind, triangles, problem.labels, self.chart, algebraic, lines),
            **counts,
        )
