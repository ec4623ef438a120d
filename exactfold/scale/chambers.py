"""One block of sign vectors at a time: solve, prove, classify (docs/mathematics.md, 4 and 12)."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np
import numpy.typing as npt

from exactfold.branches.functionals import Functionals
from exactfold.certify.certificate import Document, chart_evidence, triangle_evidence
from exactfold.certify.float_krawczyk import UNPROVED, FloatBoxes, FloatKrawczyk, FloatSigns
from exactfold.certify.rigid_triangles import RigidTriangle, certify_rigid_triangles
from exactfold.checker.formats import MOST_UNKNOWNS
from exactfold.errors import NotApplicableError
from exactfold.pattern.crease_pattern import CreasePattern
from exactfold.scale.settle import ExactRoot, OpenEnd, Settler
from exactfold.solve.nappes import NappeSystem, chamber_chart, sign_vectors
from exactfold.system.branch_system import Chart

BLOCK = 1024
"""Sign vectors in a block, and the most that an interruption loses."""

_BITS = 40
_WIDEST = 52


@dataclass(frozen=True)
class ProvedBlock:
    """Block `index`: row j is sign vector number index * count + j (`sign_vectors`).

    A row is proved by its float box, with `valleys` telling the folds of the emptied pattern that
    are valleys, the others being mountains; or by an entry of `exact`; or it is open, with a
    reason. `seconds` is processor time by stage; `steps` counts Newton steps.
    """

    index: int
    boxes: FloatBoxes
    valleys: npt.NDArray[np.bool_]
    exact: Mapping[int, ExactRoot]
    open: Mapping[int, OpenEnd]
    steps: int = 0
    seconds: Mapping[str, float] = field(default_factory=dict)


@dataclass(frozen=True)
class Chambers:
    """A pattern with D = 1 whose 2^n branches are proved chamber by chamber, n = Vi - Vt > 0.

    In the chart of `chamber_chart` zeros with different vertex signs are different, so a proved
    zero with the signs asked for in each of the 2^n chambers is the proof that these are all.
    """

    pattern: CreasePattern
    triangles: tuple[RigidTriangle, ...]
    emptied: CreasePattern
    labels: tuple[int, ...]
    chart: Chart
    block_size: int

    @classmethod
    def of(cls, pattern: CreasePattern, block_size: int | None = None) -> Chambers:
        """Blocks of `block_size` sign vectors, a power of two, 1024 by default.

        Raises `NotApplicableError` unless D = 1 and some vertex is foldable, 40 at most.

        >>> from exactfold.pattern.random_squares import random_square
        >>> chambers = Chambers.of(random_square(3, seed=0))
        >>> block = chambers.prove(0)
        >>> bool(block.boxes.proved.all()), len(block.open)
        (True, 0)
        """
        emptied, labels = pattern.emptied()
        chart = chamber_chart(emptied)
        triangles = certify_rigid_triangles(pattern)
        if triangles is None:
            raise NotApplicableError("no definite stress was found for a triangulated triangle")
        if not emptied.interior:
            raise NotApplicableError("no vertex of the pattern is foldable")
        if emptied.Vi > MOST_UNKNOWNS:
            raise NotApplicableError(f"2^{emptied.Vi} branches are too many to list")
        size = min(block_size or BLOCK, 1 << emptied.Vi)
        return cls(pattern, triangles, emptied, labels, chart, size)

    @property
    def size(self) -> int:
        """n, the number of foldable vertices."""
        return self.emptied.Vi

    @property
    def blocks(self) -> int:
        """Number of blocks."""
        return (1 << self.size) // self.block_size

    @cached_property
    def functionals(self) -> Functionals:
        """The exact sign functionals."""
        return Functionals(self.chart)

    @cached_property
    def _nappes(self) -> NappeSystem:
        return NappeSystem(self.chart)

    @cached_property
    def _settler(self) -> Settler:
        return Settler(self._nappes, self.functionals, self.labels)

    @cached_property
    def _test(self) -> FloatKrawczyk:
        return FloatKrawczyk(self.chart.system)

    @cached_property
    def _vertices(self) -> FloatSigns:
        return FloatSigns(tuple(self.functionals.vertices.values()))

    @cached_property
    def _folds(self) -> FloatSigns:
        return FloatSigns(tuple(self.functionals.folds.values()))

    def evidence(self) -> Document:
        """The evidence in the header of a compact certificate."""
        return {
            "kind": "chambers",
            "triangles": triangle_evidence(self.triangles),
            "chart": chart_evidence(self.chart, self.labels),
            "block": self.block_size,
        }

    def claims(self) -> Document:
        """What a certificate without open roots proves."""
        return {
            "interior": self.pattern.Vi,
            "boundary": self.pattern.Ve,
            "folds": len(self.pattern.folds),
            "degrees_of_freedom": self.pattern.degrees_of_freedom,
            "sha256": self.pattern.sha256,
            "distinct": 1 << self.size,
            "with_multiplicity": 1 << self.pattern.Vi,
            "real": 1 << self.size,
            "nonreal": 0,
            "true_branches": "proved",
        }

    def prove(self, index: int) -> ProvedBlock:
        """Solve and prove the sign vectors of block `index`."""
        count = self.block_size
        start = time.process_time()
        ends = self._nappes.ends_of_block(index * count, count)
        middle = time.process_time()
        boxes = self._test.isolate(ends.points, _BITS)
        signs = sign_vectors(index * count, count, self.size)
        vertices, folds = self._vertices.on(boxes), self._folds.on(boxes)
        good = boxes.proved & (vertices == signs).all(axis=1) & (folds != 0).all(axis=1)
        good &= boxes.exponents <= _WIDEST
        certified = time.process_time()
        exact: dict[int, ExactRoot] = {}
        unproved: dict[int, OpenEnd] = {}
        for j in np.flatnonzero(~good).tolist():
            found = self._settler.settle([int(sign) for sign in signs[j]], ends.points[j])
            if isinstance(found, ExactRoot):
                exact[j] = found
            else:
                unproved[j] = found
        settled = time.process_time()
        return ProvedBlock(
            index,
            FloatBoxes(
                boxes.bits,
                np.where(good[:, None], boxes.centers, 0),
                np.where(good, boxes.exponents, UNPROVED),
            ),
            (folds > 0) & good[:, None],
            exact,
            unproved,
            ends.steps,
            {
                "solve": middle - start,
                "certify": certified - middle,
                "settle": settled - certified,
            },
        )
