"""Makes disjoint isolating boxes from candidates, and decides whether they hold all zeros."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from exactfold._support.arrays import ComplexArray
from exactfold._support.progress import Steps
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.rigidity.equations.quadratic import QuadraticSystem
from exactfold.solve.certify.box import IsolatingBox, Uncertified
from exactfold.solve.certify.exact_krawczyk import krawczyk
from exactfold.solve.numeric.candidates import Candidates

_BLOCK = 512
_FIRST = (64,)
_RISING = (64, 128, 256, 512)
_INTERVAL = (106, 424)


@dataclass(frozen=True)
class Isolation:
    """Pairwise disjoint isolating boxes of a system, and what they prove.

    Refined Bezout (Fulton, Intersection Theory, 8.4.6): the degrees of the components of the common
    zero set of n quadrics in P^n add up to at most 2^n. So if there are 2^n disjoint boxes, they
    contain all zeros; all are simple, none is at infinity, and there is no component of positive
    dimension (docs/mathematics.md, Completeness). Exactly in this case `complete` is PROVED.
    Otherwise it is UNDECIDED, and `failures` lists the candidates for which no box was found.
    """

    system: QuadraticSystem
    boxes: tuple[IsolatingBox, ...]
    failures: tuple[Uncertified, ...]

    def __repr__(self) -> str:
        return (
            f"<Isolation: {self.complete}, {len(self.boxes)} boxes, {self.real} real, "
            f"{len(self.failures)} failures>"
        )

    @property
    def complete(self) -> Verdict:
        """Whether the boxes are proved to contain all zeros in projective space."""
        return PROVED if self._total == self.system.bezout_number else UNDECIDED

    @property
    def _total(self) -> int:
        return sum(1 if box.is_real or box.is_nonreal else 0 for box in self.boxes)

    @property
    def real(self) -> int:
        """The number of zeros that are proved real."""
        return sum(box.is_real for box in self.boxes)

    @property
    def nonreal(self) -> int:
        """The number of zeros that are proved non-real."""
        return sum(box.is_nonreal for box in self.boxes)


def isolate(
    system: QuadraticSystem, candidates: Candidates, *, progress: Steps | None = None
) -> Isolation:
    """Certifies every candidate: first by exact Krawczyk, then, if that fails, by interval Newton.

    Candidates that lead to the same zero count once.

    >>> import numpy as np
    >>> system = QuadraticSystem.from_rational([[[1, 0], [0, -2]]])
    >>> guesses = np.array([[1.4], [-1.4], [1.5]], dtype=complex)
    >>> isolation = isolate(system, Candidates("guess", guesses))
    >>> isolation.real, str(isolation.complete)
    (2, 'proved')
    """
    boxes: list[IsolatingBox] = []
    unproved: list[ComplexArray] = []
    total = len(candidates.points)
    for start in range(0, total, _BLOCK):
        block = candidates.points[start : start + _BLOCK]
        # Any zero to which a candidate leads is accepted.
        results = krawczyk(system, block, precisions=_FIRST, reach=None)
        for point, result in zip(block, results, strict=True):
            if isinstance(result, IsolatingBox):
                boxes.append(result)
            else:
                unproved.append(point)
        if progress is not None:
            progress(min(start + _BLOCK, total), total)
    failures: list[Uncertified] = []
    for group in _clusters(unproved):
        more, failure = _prove_meeting(system, group)
        boxes += more
        if failure is not None:
            failures.append(failure)
    return Isolation(system, tuple(disjoint(boxes)), tuple(failures))


def _clusters(points: list[ComplexArray]) -> list[list[ComplexArray]]:
    """Groups of points that agree to about five digits; the groups only choose what to try."""
    groups: dict[tuple[complex, ...], list[ComplexArray]] = {}
    for point in points:
        scale = float(np.abs(point).max(initial=0.0)) or 1.0
        groups.setdefault(tuple(np.round(point / scale, 5).tolist()), []).append(point)
    return list(groups.values())


def _prove_meeting(
    system: QuadraticSystem, group: list[ComplexArray]
) -> tuple[list[IsolatingBox], Uncertified | None]:
    """Tries higher precision and the second certifier on a group; stops at the first failure."""
    boxes: list[IsolatingBox] = []
    for point in group:
        (result,) = krawczyk(system, [point], precisions=_RISING, reach=None)
        if isinstance(result, Uncertified):
            from exactfold.solve.certify.ball_newton import interval_newton  # loads mpmath

            (result,) = interval_newton(system, [point.tolist()], precisions=_INTERVAL)
        if isinstance(result, Uncertified):
            left = len(group) - len(boxes)
            many = f"{left} candidates meet here; " if left > 1 else ""
            return boxes, Uncertified(result.point, many + result.reason)
        boxes.append(result)
    return boxes, None


def disjoint(boxes: Iterable[IsolatingBox]) -> list[IsolatingBox]:
    """The boxes in order, without boxes that meet an earlier one.

    Boxes are sorted by a fixed integer functional. Only boxes whose values may coincide are
    compared in all coordinates. Two boxes that meet may contain the same zero, so one is dropped.
    """
    boxes = list(boxes)
    if not boxes:
        return []
    top = max(box.bits for box in boxes)
    keyed = []
    for index, box in enumerate(boxes):
        weights = [2 * k * k + 3 * k + 5 for k in range(len(box.real) + len(box.imag))]
        value = sum(w * m for w, m in zip(weights, (*box.real, *box.imag), strict=True))
        reach = box.radius * sum(weights)
        shift = top - box.bits
        keyed.append(((value - reach) << shift, (value + reach) << shift, index))
    keyed.sort()
    dropped: set[int] = set()
    active: list[tuple[int, int]] = []
    for low, high, index in keyed:
        active = [(end, other) for end, other in active if end >= low]
        for _, other in active:
            if not boxes[index].is_disjoint_from(boxes[other]):
                dropped.add(max(index, other))
        active.append((high, index))
    return [box for index, box in enumerate(boxes) if index not in dropped]
