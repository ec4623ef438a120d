"""Motions with given letters in the linear spaces of all motions, found or excluded exactly."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any, Final, TypeAlias

import numpy as np
from flint import fmpq
from scipy.optimize import linprog

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.verdict import PROVED, REFUTED, UNDECIDED, Verdict
from exactfold.design.panels.first_order_program import SIDES, solved
from exactfold.design.refutations.refutation import Letters
from exactfold.exact.surds import Number, ball, common_field, real_root, sign
from exactfold.panels.folding_modes import folding_mode
from exactfold.panels.spaces.kernel import Entry, Rows, entry, first_order, imposed, number
from exactfold.panels.spaces.quadratics import factors, row_rank
from exactfold.panels.spaces.regular import BITS, truly_folds
from exactfold.panels.spaces.subspaces import SubspaceSearch, independent_parts
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge, PanelPattern

Motion: TypeAlias = dict[Edge, Number]
"""The exact density of each fold; folds that are left out stay flat."""

MOST_STEPS: Final = 600_000
_TINY: Final = 1e-9
_PLACES: Final = 30
_POINTS: Final = 24


class LetteredSpaces:
    """A search for motions to second order in the spaces that contain all of them.

    As in `leaves`, the space of first-order motions is split: a semidefinite form leaves its
    kernel, and a form of inertia (1, 1) is a product of two linear forms. A space is left out as
    soon as it is shown to hold no motion with the letters. By Gordan's theorem, some linear
    functions are all positive at no point if and only if a combination of them with weights that
    are not negative, and not all 0, vanishes. So the search is complete if it ends and `open` is 0
    afterwards: then every motion to second order lies in a space that was left out, or was found.

    `open` is the number of spaces of which nothing was shown. Raises `TooManyModesError` if the
    search takes more than `most` steps or the clock has passed, or if it needs more square roots
    than `factors` allows.
    """

    def __init__(
        self,
        stars: Mapping[int, Star],
        letters: Letters,
        most: int = MOST_STEPS,
        clock: Clock = UNLIMITED,
    ) -> None:
        self.stars, self.letters = stars, letters
        self.open = 0
        self._spaces = SubspaceSearch(stars, most, clock)

    def motion(self) -> tuple[Verdict, Motion]:
        """Whether some motion has the letters; if so, an exact one that has them.

        In this motion each mountain and each valley bends its way.
        """
        rows, size = first_order(self.stars)
        wanted = {edge for star in self.stars.values() for edge in star.folds} & self._lettered()
        found = self._found(rows, size, wanted)
        if found is not None:
            return PROVED, found
        return UNDECIDED if self.open else REFUTED, {}

    def moves_weakly(self) -> bool:
        """Whether some motion may have no fold against its letter, some fold being bent.

        False is proved: no motion to second order, except 0, is such that all mountains and valleys
        bend their way or stay flat.
        """
        return self._weakly(*first_order(self.stars))

    def _lettered(self) -> set[Edge]:
        return {edge for edge, letter in self.letters.items() if letter in SIDES}

    def _found(self, rows: Rows, size: int, wanted: set[Edge]) -> Motion | None:
        """A motion of a space in which the wanted folds bend their way; None if none was found."""
        if not wanted:
            return {}
        if not wanted <= rows.keys() or self.excluded(rows, size, wanted):
            return None
        before = size
        rows, size, products, left = self._spaces.reduced(rows, size)
        if not wanted <= rows.keys() or (size < before and self.excluded(rows, size, wanted)):
            return None
        parts = independent_parts(rows, size, self.stars)
        if len(parts) > 1:
            total: Motion = {}
            for part, part_size in parts:
                found = self._found(part, part_size, wanted & part.keys())
                if found is None:
                    return None
                total |= found
            return total
        if products:
            for functional in factors(products, rows):
                found = self._found(*imposed(rows, size, functional), wanted)
                if found is not None:
                    return found
            return None
        found = self.in_leaf(rows, size, wanted, left)
        self.open += found is None
        return found

    def _weakly(self, rows: Rows, size: int) -> bool:
        wanted = self._lettered() & rows.keys()
        if size == 0 or self._still(rows, size, wanted):
            return False
        before = size
        rows, size, products, _ = self._spaces.reduced(rows, size)
        if size == 0 or (size < before and self._still(rows, size, wanted & rows.keys())):
            return False
        parts = independent_parts(rows, size, self.stars)
        if len(parts) > 1:
            return any(self._weakly(*part) for part in parts)
        if products:
            both = factors(products, rows)
            return any(self._weakly(*imposed(rows, size, functional)) for functional in both)
        return True

    # --- linear programs on one space ------------------------------------------------------------

    def _turned(self, rows: Rows, wanted: set[Edge]) -> tuple[list[Edge], FloatArray]:
        """The rows of the wanted folds, times the sides of their letters, scaled to size 1."""
        edges = sorted(wanted)
        floats = np.array([[float(x) for x in rows[edge]] for edge in edges])
        sides = np.array([SIDES[self.letters[edge]] for edge in edges])
        return edges, floats * (sides / np.abs(floats).max(axis=1))[:, None]

    def excluded(self, rows: Rows, size: int, wanted: set[Edge]) -> bool:
        """Whether exact weights show that not all wanted folds can bend their way."""
        edges, turned = self._turned(rows, wanted)
        if inner_point(turned) is not None:
            return False
        solution = linprog(
            np.zeros(len(edges)),
            A_eq=np.vstack([turned.T, np.ones(len(edges))]),
            b_eq=np.append(np.zeros(size), 1.0),
            method="highs",
        )
        if solution.status != 0:
            return False
        weights = self._weights(rows, size, edges, turned, solution.x)
        return any(sign(number(x)) > 0 for x in weights.values())

    def _still(self, rows: Rows, size: int, wanted: set[Edge]) -> bool:
        """Whether exact weights show that only 0 has no wanted fold bend against its letter."""
        if not wanted:
            return False
        edges, turned = self._turned(rows, wanted)
        solution = linprog(
            -np.ones(len(edges)),
            A_eq=turned.T,
            b_eq=np.zeros(size),
            bounds=(0, 1),
            method="highs",
        )
        if solution.status != 0:
            return False
        weights = self._weights(rows, size, edges, turned, solution.x)
        shown = [rows[edge] for edge, x in weights.items() if sign(number(x)) > 0]
        return row_rank(shown, size) == size

    def _weights(
        self, rows: Rows, size: int, edges: Sequence[Edge], turned: FloatArray, near: FloatArray
    ) -> dict[Edge, Entry]:
        """Exact weights, none negative, with which the rows add up to 0; empty if none are found.

        They are near those given, which belong to `turned`.
        """
        self._spaces.count(len(edges) * size)
        kept = [k for k in range(len(edges)) if near[k] > _TINY]
        scales = np.abs(np.array([[float(x) for x in rows[edge]] for edge in edges])).max(axis=1)
        guess = {edges[k]: float(near[k] / scales[k]) for k in kept}
        equations = [
            {
                edges[k]: SIDES[self.letters[edges[k]]] * rows[edges[k]][axis]
                for k in kept
                if rows[edges[k]][axis]
            }
            for axis in range(size)
        ]
        largest = max(guess.values(), default=1.0)
        exact = solved(equations, {edge: x / largest for edge, x in guess.items()})
        if exact is None or any(sign(number(x)) < 0 for x in exact.values()):
            return {}
        return exact

    # --- motions ---------------------------------------------------------------------------------

    def in_leaf(
        self, rows: Rows, size: int, wanted: set[Edge], left: Sequence[int]
    ) -> Motion | None:
        """A motion with the letters in a space on which at most one form is left; None if none is
        found.
        """
        if len(left) > 1:
            return None
        _, turned = self._turned(rows, wanted)
        points = (self._exact(rows, x, wanted) for x in _points(turned, _POINTS if left else 1))
        seen: dict[int, tuple[Motion, Any]] = {}
        for motion in filter(None, points):
            value = self._value(left, motion)
            side = sign(value)
            if side == 0:
                return motion
            seen[side] = motion, value
            if len(seen) == 2:
                return self._between(left, seen[1], seen[-1])
        return None

    def _exact(self, rows: Rows, x: FloatArray, wanted: set[Edge]) -> Motion | None:
        """The motion at a point, rounded to a rational one, if the wanted folds bend their way."""
        point = [fmpq(round(value * (1 << _PLACES)), 1 << _PLACES) for value in x.tolist()]
        motion: Motion = {}
        for edge, row in rows.items():
            terms = (a * b for a, b in zip(row, point, strict=True) if a and b)
            motion[edge] = number(sum(terms, start=fmpq(0)))
        if any(sign(motion[e]) != SIDES[self.letters[e]] for e in wanted):
            return None
        return motion

    def _value(self, left: Sequence[int], motion: Mapping[Edge, Number]) -> Number:
        if not left:
            return Fraction(0)
        star = self.stars[left[0]]
        return star.form([motion.get(edge, Fraction(0)) for edge in star.folds])

    def _between(
        self, left: Sequence[int], one: tuple[Motion, Any], other: tuple[Motion, Any]
    ) -> Motion:
        """The motion a + s b, s > 0, at which the form vanishes; it has one sign at a, and the
        other at b.
        """
        (a, at_a), (b, at_b) = one, other
        both = {edge: x + b[edge] for edge, x in a.items()}
        mixed = self._value(left, both) - at_a - at_b
        square = mixed * mixed - 4 * at_a * at_b
        root = real_root(square, common_field([square, *a.values()]))
        s = (root * sign(at_b) - mixed) / (2 * at_b)  # |root| > |mixed|
        return {edge: x + s * b[edge] for edge, x in a.items()}


def truly_begin(pattern: PanelPattern, stars: Mapping[int, Star], motion: Motion) -> bool:
    """Whether true motions are known to be tangent to an exact motion to second order.

    This is shown for each independent part of the folds that bend: all conditions are independent
    there (`truly_folds`), or the part is a mode that extends. False decides nothing.
    """
    rows: Rows = {edge: [entry(x)] for edge, x in motion.items() if x}
    return all(
        truly_folds(stars, {edge: ball(row[0], BITS) for edge, row in part.items()})
        or folding_mode(pattern, stars, part) is not None
        for part, _ in independent_parts(rows, 1, stars)
    )


def inner_point(turned: FloatArray) -> FloatArray | None:
    """A point at which all linear functions are positive, as far as floating point can tell."""
    count, size = turned.shape
    solution = linprog(
        np.append(np.zeros(size), -1.0),
        A_ub=np.hstack([-turned, np.ones((count, 1))]),
        b_ub=np.zeros(count),
        bounds=[(-1, 1)] * size + [(None, 1)],
        method="highs",
    )
    if solution.status != 0 or not solution.x[-1] > _TINY:
        return None
    inner: FloatArray = solution.x[:-1]
    return inner


def _points(turned: FloatArray, number: int) -> Iterator[FloatArray]:
    """Points at which all linear functions are positive: one well inside, and some far apart."""
    inner = inner_point(turned)
    if inner is None:
        return
    yield inner
    random = np.random.default_rng(1)
    least = 0.01 * float((turned @ inner).min())
    for _ in range(number - 1):
        solution = linprog(
            random.standard_normal(turned.shape[1]),
            A_ub=-turned,
            b_ub=np.full(len(turned), -least),
            bounds=(-1, 1),
            method="highs",
        )
        if solution.status == 0:
            yield solution.x
