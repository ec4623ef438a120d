"""Exact arithmetic proves, one by one, the roots that the float test leaves open."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold.branches.values.blocks import ExactRoot, OpenEnd
from exactfold.branches.values.classify import decide_signs
from exactfold.branches.values.letters import LETTERS
from exactfold.branches.values.roots import BoxRoot
from exactfold.rigidity.equations.problem import Problem
from exactfold.solve.certify.box import IsolatingBox
from exactfold.solve.numeric.dense_newton import NappeSystem
from exactfold.solve.numeric.refined_newton import refined_end

_FIRST = (64, 128)
_RISING = (128, 256, 512, 1024)
_FAR = 1e100


@dataclass(frozen=True)
class ExactProver:
    """Proves in integers the zeros with given vertex signs that floats leave open.

    The prover remembers sets of vertices that look flat even in the highest precision. If the same
    vertices look flat in doubles for other signs, it tries nothing more: several paths seem to meet
    there, so their zeros most likely coincide.
    """

    system: NappeSystem
    problem: Problem
    _flat_before: set[tuple[int, ...]] = field(default_factory=set)

    def prove(self, signs: Sequence[int], point: FloatArray) -> ExactRoot | OpenEnd:
        """The proved zero with these vertex signs, or the reason why it is open.

        First `krawczyk`, an exact test, is run at `point`. If it fails or finds a zero with other
        signs, the nappe equations for these signs are solved in rising precision, and the test is
        run at their solution.
        """
        from exactfold.solve.certify.exact_krawczyk import krawczyk, krawczyk_at  # loads FLINT

        if self._flat_before:
            flat = self.system.flat_at_end(signs)
            if flat in self._flat_before:
                return self._multiple(flat, "in double precision")
        system = self.problem.chart.system
        if np.isfinite(point).all() and np.abs(point).max(initial=0.0) < _FAR:
            (isolated,) = krawczyk(system, point[None], precisions=_FIRST)
            if isinstance(isolated, IsolatingBox):
                root = self._classified(signs, isolated)
                if isinstance(root, ExactRoot):
                    return root
        reason = OpenEnd("no end was reached in higher precision")
        for bits in _RISING:
            end = refined_end(self.system, signs, bits)
            if end is None:
                continue
            wide = IsolatingBox(end.point, (), 1 << (bits // 2), bits)
            box = krawczyk_at(system, wide, bits)
            if isinstance(box, IsolatingBox):
                root = self._classified(signs, box)
                if isinstance(root, ExactRoot):
                    return root
                reason = OpenEnd(root)
            elif end.flat:
                reason = self._multiple(end.flat, f"to {bits // 2} bits")
            else:
                reason = OpenEnd(box)
        if reason.flat:
            self._flat_before.add(reason.flat)
        return reason

    def _multiple(self, flat: tuple[int, ...], precision: str) -> OpenEnd:
        names = ", ".join(str(self.problem.foldable[k]) for k in flat)
        which = f"{'vertex' if len(flat) == 1 else 'vertices'} {names} flat {precision}"
        return OpenEnd(f"{which}: {1 << len(flat)} paths seem to meet in a multiple root", flat)

    def _classified(self, signs: Sequence[int], box: IsolatingBox) -> ExactRoot | str:
        """The root in the box if its vertex signs are `signs`, else the reason why they are not."""
        labels = self.problem.labels
        chart = self.problem.chart
        root, vertices, folds = decide_signs(
            chart, self.problem.functionals, BoxRoot(box, system=chart.system)
        )
        for wanted, (vertex, sign) in zip(signs, vertices.items(), strict=True):
            if sign != wanted:
                state = "undecided" if sign is None else "another"
                return f"the sign of vertex {labels[vertex]} is {state}"
        return ExactRoot(root.box, "".join(LETTERS[sign] for _, sign in sorted(folds.items())))
