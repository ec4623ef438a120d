"""Circles of solutions covered by points, between which the letters of most folds are known.

Such points prove a list of all assignments without algebra. Where some letters are unknown between
two points, every completion of the letters that agrees with the signs of the vertices has to occur
elsewhere (docs/any_border.md, Theorem 14). Newton's method proposes the points. The code of the
stand-alone checker says what they show.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import suppress
from dataclasses import dataclass
from fractions import Fraction
from itertools import chain, pairwise, product
from math import cos, hypot, pi, sin
from typing import Final

from exactfold._support.progress import Progress
from exactfold.certificates.entries import Document, emptied_evidence, pattern_document
from exactfold.checker.core.reading import CertificateError, LimitError
from exactfold.checker.letters.arcs import Arcs, Word
from exactfold.checker.letters.assignments import (
    ASSIGNMENTS,
    MOST_VERTICES,
    AssignmentsClaims,
    free_boundary,
)
from exactfold.checker.sheets.sheet import Sheet
from exactfold.design.circles.nappe_points import NappePoints
from exactfold.exact.numbers import format_integer
from exactfold.pattern.crease_pattern import CreasePattern

_START: Final = 24
_OFF: Final = 0.382
_DEPTHS: Final = (17, 30, 50)
_MOST_POINTS: Final = 20_000
_MOST_SHORT: Final = 64

Heights = tuple[int, ...]


@dataclass(frozen=True)
class Covering:
    """Points on the circle of each sign vector that begins with a plus; heights are integers.

    A point has the heights of two boundary vertices, followed by those of the vertices that can
    pop; all other heights are 0. If a fold runs from boundary to boundary, the corner behind it is
    left out, and only one boundary vertex has a height. `assignments` are the assignments of
    letters to all folds of the pattern that occur.
    """

    circles: tuple[tuple[Heights, ...], ...]
    assignments: tuple[str, ...]

    def __repr__(self) -> str:
        return f"<Covering: {sum(map(len, self.circles))} points on {len(self.circles)} circles>"


class NotCoveredError(Exception):
    """No covering was found."""


def covering(pattern: CreasePattern, progress: Progress | None = None) -> Covering:
    """Points that go round all circles of a convex sheet with five corners.

    Between neighbouring points, the unknown letters have only completions that some points have. If
    a fold runs from boundary to boundary, two points are enough. Raises `NotCoveredError` if no
    such points are found; nothing about the sheet follows from that.
    """
    sheet, labels = pattern.without_rigid_parts()
    if not 0 < sheet.Vi <= MOST_VERTICES:
        raise NotCoveredError(
            f"{sheet.Vi} vertices can pop; points are found only if 1 to {MOST_VERTICES} can"
        )
    chords = {(labels[i], labels[j]) for i, j in sheet.chords}
    if sheet.chords:
        sheet, kept = _without_ear(sheet)
        labels = tuple(labels[v] for v in kept)
    search = _CoveringSearch(sheet, labels, progress)
    circles = search.circles()
    folds = [(labels[i], labels[j]) for i, j in sheet.folds]
    texts = set()
    for word in search.seen:
        own = {fold: "MV"[x > 0] for fold, x in zip(folds, word, strict=True)}
        either = [own.get(f, "MV" if f in chords else "F") for f in pattern.folds]
        texts |= {"".join(letters) for letters in product(*either)}
    return Covering(circles, tuple(sorted(texts)))


def covering_document(pattern: CreasePattern, points: Covering) -> Document:
    """The certificate of the list, not yet verified (docs/any_border.md, Theorem 14)."""
    claims: AssignmentsClaims = {"assignments": list(points.assignments)}
    return {
        "format": ASSIGNMENTS.format,
        "version": ASSIGNMENTS.version,
        "pattern": pattern_document(pattern),
        "claims": claims,
        "evidence": {
            "emptied": emptied_evidence(pattern),
            "circles": [
                [[format_integer(z) for z in heights] for heights in circle]
                for circle in points.circles
            ],
        },
    }


def verified(pattern: CreasePattern, points: Covering) -> Document:
    """The certificate, verified by the checker; raises `NotCoveredError` if the checker
    refuses it.
    """
    document = covering_document(pattern, points)
    try:
        ASSIGNMENTS.check(document)
    except (CertificateError, LimitError) as error:
        raise NotCoveredError(f"the checker refuses the points found: {error}") from None
    return document


def _without_ear(sheet: CreasePattern) -> tuple[CreasePattern, list[int]]:
    """The sheet without the first corner that lies on a single face, and the old vertex numbers."""
    tip = next(v for v in sheet.boundary if sum(v in t for t in sheet.triangles) == 1)
    kept = [v for v in range(len(sheet.vertices)) if v != tip]
    place = {v: k for k, v in enumerate(kept)}
    faces = [[place[v] for v in t] for t in sheet.triangles if tip not in t]
    return CreasePattern([sheet.vertices[v] for v in kept], faces), kept


class _CoveringSearch:
    """The search for points on one sheet."""

    def __init__(
        self, sheet: CreasePattern, labels: Sequence[int], progress: Progress | None
    ) -> None:
        self.sheet, self.labels, self.progress = sheet, labels, progress
        places, _ = sheet.integer_vertices
        points = {v: (Fraction(x), Fraction(y)) for v, (x, y) in enumerate(places)}
        seen_by_checker = Sheet(points, sheet.triangles)
        self.free = tuple(free_boundary(seen_by_checker))
        self.arcs = Arcs(seen_by_checker, [*self.free, *sheet.interior])
        self.solvers = [NappePoints(sheet, self.free, depth) for depth in _DEPTHS]
        self.seen: set[Word] = set()
        self.short: list[tuple[Heights, Heights]] = []

    def circles(self) -> tuple[tuple[Heights, ...], ...]:
        """The points of all circles."""
        vectors = [(1, *rest) for rest in product((1, -1), repeat=self.sheet.Vi - 1)]
        for signs in vectors:
            self._start(signs, self.solvers[0])
        while True:
            circles: dict[Word, tuple[Heights, ...]] = {}
            for signs in vectors:
                self._tell(len(circles), len(vectors))
                with suppress(NotCoveredError):  # points of other circles may show what is missing
                    circles[signs] = self._circle(signs)
            for signs in vectors:
                if signs not in circles:
                    self._tell(len(circles), len(vectors))
                    circles[signs] = self._circle(signs)
            before, self.seen = self.seen, set()
            for a in chain.from_iterable(circles.values()):
                self._look(a)
            if self.seen >= before:
                return tuple(circles[signs] for signs in vectors)

    def _tell(self, done: int, whole: int) -> None:
        if self.progress is not None:
            self.progress("circles", done, whole)

    def _circle(self, signs: Word) -> tuple[Heights, ...]:
        """The points of one circle, as dense as the letters require."""
        reason = ""
        for solver in self.solvers:
            try:
                start = self._start(signs, solver)
                if len(self.free) == 1:
                    for a in start:
                        if not self._is_known(signs, a, a):
                            raise NotCoveredError(self._open(a, a))
                    return tuple(start)
                self.short.clear()
                steps = pairwise([*start, start[0]])
                points = [p for a, b in steps for p in self._between(signs, solver, a, b)]
                for a, b in self.short:
                    if not self._is_known(signs, a, b):
                        raise NotCoveredError(self._open(a, b))
                return tuple(points)
            except NotCoveredError as error:
                reason = str(error)
        text = "".join("+" if s > 0 else "-" for s in signs)
        raise NotCoveredError(f"with the vertex signs {text} {reason}")

    def _start(self, signs: Word, solver: NappePoints) -> list[Heights]:
        """The first points round a circle, or one on each of the two rays if there is only one
        height.
        """
        boundaries: list[tuple[float, ...]] = [(1.0,), (-1.0,)]
        if len(self.free) == 2:
            turns = [2 * pi * (k + _OFF) / _START for k in range(_START)]
            boundaries = [(cos(t), sin(t)) for t in turns]
        return [self._at(signs, solver, boundary_heights) for boundary_heights in boundaries]

    def _at(
        self,
        signs: Word,
        solver: NappePoints,
        boundary_heights: Sequence[float],
        start: Sequence[int] | None = None,
    ) -> Heights:
        heights = solver.solved(signs, boundary_heights, start) if start is not None else None
        heights = heights or solver.solved(signs, boundary_heights)
        if heights is None:
            raise NotCoveredError("no solution was found over some boundary heights")
        self._look(heights)
        return heights

    def _look(self, a: Heights) -> None:
        """Remember the letters of a point and of its reflection, if all of them are known."""
        word = self.arcs.letters(a, a)
        if all(word):
            self.seen |= {word, tuple(-x for x in word)}

    def _between(
        self, signs: Word, solver: NappePoints, a: Heights, b: Heights
    ) -> Iterator[Heights]:
        """The points from a to b, including a but not b."""
        stack = [b]
        number = 0
        while stack:
            b = stack[-1]
            known = self._is_known(signs, a, b)
            apart = max(abs(a[k] - b[k]) for k in (0, 1))
            if known or apart < 1 << solver.bits - solver.depth - 4:
                if not known:
                    self.short.append((a, b))
                yield a
                a = stack.pop()
                continue
            number += 1
            if number > _MOST_POINTS or len(self.short) > _MOST_SHORT:
                raise NotCoveredError(self._open(a, b))
            middle = [x + y for x, y in zip(a, b, strict=True)]
            size = hypot(middle[0] / (1 << solver.bits), middle[1] / (1 << solver.bits))
            near = [round(x / size) for x in middle]
            boundary_heights = [x / (1 << solver.bits) for x in near[:2]]
            stack.append(self._at(signs, solver, boundary_heights, near))

    def _open(self, a: Heights, b: Heights) -> str:
        letters = zip(self.sheet.folds, self.arcs.letters(a, b), strict=True)
        folds = [f"{self.labels[i]}-{self.labels[j]}" for (i, j), x in letters if not x]
        return f"the letters of the folds {', '.join(folds)} could not be decided near one point"

    def _is_known(self, signs: Word, a: Heights, b: Heights) -> bool:
        """Whether all completions of the letters between two points have been seen."""
        try:
            return self.arcs.possible(self.arcs.letters(a, b), signs) <= self.seen
        except LimitError:
            return False
