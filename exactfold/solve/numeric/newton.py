"""Candidates by Newton's method on the nappes: the ends of all popping paths, without the paths."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from exactfold._support.progress import Steps
from exactfold.rigidity.equations.branch_system import Chart, chamber_chart
from exactfold.rigidity.equations.chart_change import between
from exactfold.solve.numeric.candidates import Candidates
from exactfold.solve.numeric.dense_newton import NappeSystem, SweptPoints
from exactfold.solve.numeric.nappe_newton import sign_vectors

_BLOCK = 1024


def newton(chart: Chart, *, progress: Steps | None = None) -> Candidates:
    """Candidates for all 2^Vi branches (Ve = 4), each by Newton's method on the nappes.

    For each vector e of vertex signs the equations l_v = e_v |A_v h| of `NappeSystem` have one
    solution (docs/mathematics.md, Nappes). Damped Newton steps find it, for a block of sign vectors
    at a time. Flat stars do not slow them down. If branches coincide, so do their candidates.
    `lost` names the sign vectors for which the steps did not converge; their last point is still a
    candidate. This is floating point throughout: nothing here is proved.

    Raises `NotApplicableError` unless the pattern has four boundary vertices.

    >>> from exactfold.pattern.families import single_vertex
    >>> from exactfold.rigidity.equations.branch_system import BranchSystem
    >>> newton(BranchSystem(single_vertex(4)).chart).points.shape
    (2, 1)
    """
    natural = chamber_chart(chart.branch_system.pattern)
    system, size = NappeSystem(natural), natural.system.size
    total = 1 << size
    block = min(_BLOCK, total)
    swept = []
    for first in range(0, total, block):
        swept.append(system.ends_of_block(first, block))
        if progress is not None:
            progress(first + block, total)
    candidates = candidates_of(swept, size)
    points = between(natural, chart, candidates.points.real)
    return replace(candidates, points=points.astype(np.complex128))


def candidates_of(blocks: Sequence[SweptPoints], size: int) -> Candidates:
    """Blocks of zeros, in the order of their sign vectors, as candidates."""
    lost, first = [], 0
    for ends in blocks:
        for signs in sign_vectors(first, len(ends.points), size)[~ends.converged]:
            text = "".join("+" if e > 0 else "-" for e in signs)
            lost.append(f"Newton's steps for the signs {text} did not converge")
        first += len(ends.points)
    return Candidates(
        method="newton",
        points=np.concatenate([ends.points for ends in blocks]).astype(np.complex128),
        lost=tuple(lost),
        settings={"ends": first, "steps": sum(ends.steps for ends in blocks)},
    )
