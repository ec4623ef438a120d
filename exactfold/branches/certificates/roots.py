"""Reads roots from the entries of a certificate that lists them one by one."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import Any

from exactfold.branches.values.roots import AlgebraicRoot, BoxRoot, ChartRoot, FlatBoxRoot
from exactfold.certificates.entries import Document, chart_evidence
from exactfold.checker.core.reading import (
    CertificateError,
    parse_integer,
    parse_rational,
    require,
    text_of,
)
from exactfold.checker.sheets.boxes import read_box
from exactfold.checker.sheets.equations import read_chart
from exactfold.rigidity.equations.branch_system import BranchSystem, Chart, notch_chart
from exactfold.rigidity.equations.flat_sheets import FlatSheets, flat_sheets
from exactfold.rigidity.equations.problem import Problem
from exactfold.rigidity.equations.sign_rows import Functionals, Row
from exactfold.solve.algebraic.exact_solution import RootClass
from exactfold.solve.certify.box import IsolatingBox

_MOST_BITS = 1 << 12


@dataclass(frozen=True)
class Roots:
    """Reads the roots of one certificate, in its chart.

    A root with negative saddle is replaced by its reflection, which has positive saddle.
    """

    problem: Problem
    chart: Chart
    saddle: Row
    classes: tuple[RootClass, ...]
    _sheets: dict[tuple[int, ...], FlatSheets] = field(default_factory=dict)

    @classmethod
    def of(cls, problem: Problem, evidence: Document) -> Roots:
        """The reader; raises `CertificateError` for a chart that exactfold does not write."""
        chart = _chart(problem, evidence["chart"])
        classes = [_root_class(evidence["separating"], c) for c in evidence.get("classes", ())]
        return cls(problem, chart, Functionals(chart).saddle, tuple(classes))

    def root(self, entry: Document) -> ChartRoot:
        """The root of an entry."""
        root = self._root(entry)
        return root.mirrored() if root.sign(self.saddle) == -1 else root

    def _root(self, entry: Document) -> ChartRoot:
        if "class" in entry:
            root_class = self.classes[entry["class"]]
            low, high = map(parse_rational, entry["interval"])
            return AlgebraicRoot(root_class, _index(root_class, low, high))
        if "flat" not in entry:
            system = self.chart.system
            return BoxRoot(_box(entry, system.size), system=system)
        box = {key: value for key, value in entry.items() if key != "flat"}
        sheets = self._flat_sheets(tuple(entry["flat"]))
        return FlatBoxRoot(sheets, _box(box, len(sheets.free)))

    def _flat_sheets(self, flat: tuple[int, ...]) -> FlatSheets:
        if flat not in self._sheets:
            sheets = flat_sheets(self.chart, map(self.problem.labels.index, flat))
            if sheets is None:
                raise CertificateError("no heights in the chart are flat at the flat vertices")
            self._sheets[flat] = sheets
        return self._sheets[flat]


def _chart(problem: Problem, evidence: Any) -> Chart:
    """The chart that the evidence names."""
    charts = [BranchSystem(problem.sheet).chart]
    if problem.sheet.reflex_corner is not None:
        charts.append(notch_chart(problem.sheet))
    for chart in charts:
        if read_chart(chart_evidence(chart, problem.labels)) == read_chart(evidence):
            return chart
    raise CertificateError("exactfold writes no branches in the chart of this certificate")


def _root_class(separating: list[int], entry: Document) -> RootClass:
    polynomial = tuple(parse_integer(text_of(c)) for c in entry["polynomial"])
    numerators = tuple(tuple(map(parse_rational, w)) for w in entry["numerators"])
    return RootClass(polynomial, numerators, 1 << len(entry["flat"]), tuple(separating))


def _index(root_class: RootClass, low: Fraction, high: Fraction) -> int:
    """The index of the one real root of the class that lies in the interval."""
    bits = 64
    while bits <= _MOST_BITS:
        near = [k for k, (a, b) in enumerate(root_class.real_roots(bits)) if a <= high and low <= b]
        require(near, "an interval shows no root")
        if len(near) == 1:
            return near[0]
        bits *= 2
    raise CertificateError("an interval holds more than one root")


def _box(entry: Document, size: int) -> IsolatingBox:
    box = read_box(entry, size)
    return IsolatingBox(tuple(box.center), (), box.radius, box.bits)
