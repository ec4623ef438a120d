"""All letters of all folds with which one block of a sheet of panels starts to fold."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from itertools import product
from typing import Final

import numpy as np

from exactfold._support.arrays import FloatArray
from exactfold._support.clock import Clock
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.design.panels.first_order_program import SIDES
from exactfold.design.panels.lettered_spaces import LetteredSpaces, inner_point
from exactfold.design.panels.parts import block_answer
from exactfold.design.panels.regular_motion import regular_motion
from exactfold.errors import TooManyModesError
from exactfold.exact.surds import sign
from exactfold.panels.spaces.kernel import Rows, entry, first_order
from exactfold.panels.spaces.splitting import leaves
from exactfold.panels.spaces.subspaces import Leaf
from exactfold.panels.vertex.stars import Star
from exactfold.panels.vertex.vertex_motions import Fan
from exactfold.pattern.panel_pattern import PanelPattern

MOST_FOLDS: Final = 20
MOST_LETTERS: Final = 50_000
UPSIDE_DOWN: Final = str.maketrans("MV", "VM")
_MOST_STEPS: Final = 600_000
_MOST_SAMPLES: Final = 4_000
_PATIENCE: Final = 300
_TINY: Final = 1e-6


class BlockLetters:
    """The search for all texts of letters M and V of all folds of a block that some motion has.

    `answers` has a verdict for each text that had to be asked for, in the order of `folds`; all
    other texts are refuted. The letters of the first fold are V, because motions can be reversed.

    A single vertex is decided by the theorem of Abel et al. In other blocks, the motions to second
    order are a union of linear spaces and of cones in such spaces (`leaves`). The letters in a
    space are found fold by fold; exact weights exclude the others (`LetteredSpaces.excluded`), and
    an exact motion shows each text that is left. In a cone, each text that the vertices and the
    first order allow is asked for by itself (`block_answer`), unless Newton's method from random
    points, with Krawczyk's test, has found it. Where the spaces are too many, the first-order
    motions are taken as one cone. Raises `TooManyModesError` if there are too many texts, or more
    than 20 folds where texts are asked for one by one, or if the clock has passed.
    """

    def __init__(self, pattern: PanelPattern, stars: Mapping[int, Star], clock: Clock) -> None:
        self.pattern, self.stars, self.clock = pattern, stars, clock
        self.folds = sorted({edge for star in stars.values() for edge in star.folds})
        self.fans = {v: Fan(star) for v, star in stars.items()}
        self.answers: dict[str, Verdict] = {}
        if len(stars) == 1:
            self._at_vertex()
            return
        for leaf in self._leaves():
            if not set(self.folds) <= leaf.rows.keys():
                continue
            rows: Rows = {edge: [entry(x) for x in row] for edge, row in leaf.rows.items()}
            if leaf.size == 1:
                self._on_line(rows)
            elif leaf.vertices:
                self._in_cone(rows, leaf.size)
            else:
                self._in_space(rows, leaf.size)

    def of(self, verdict: Verdict) -> list[str]:
        """The texts with this answer and their mirror images, sorted."""
        half = [text for text, answer in self.answers.items() if answer is verdict]
        return sorted([*half, *(text.translate(UPSIDE_DOWN) for text in half)])

    def _leaves(self) -> list[Leaf]:
        rows, size = first_order(self.stars)
        try:
            return leaves(self.stars, rows, size, _MOST_STEPS, self.clock)
        except TooManyModesError:
            vertices = tuple(v for v, star in self.stars.items() if len(star.folds) > 2)
            numbers = {edge: tuple(row) for edge, row in rows.items()}
            return [Leaf(numbers, size, vertices)]

    def _at_vertex(self) -> None:
        ((v, star),) = self.stars.items()
        self._check_number()
        place = [self.folds.index(fold) for fold in star.folds]
        for number, letters in enumerate(product("VM", repeat=len(self.folds) - 1)):
            if number % 1024 == 0:
                self.clock.check()
            text = "V" + "".join(letters)
            if self.fans[v].folds([text[k] for k in place]):
                self._add(text, PROVED)

    def _on_line(self, rows: Rows) -> None:
        sides = [sign(rows[fold][0]) for fold in self.folds]
        self._add("".join("V" if side == sides[0] else "M" for side in sides), PROVED)

    def _in_space(self, rows: Rows, size: int) -> None:
        def found(text: str) -> Verdict:
            letters = dict(zip(self.folds, text, strict=True))
            search = LetteredSpaces(self.stars, letters)
            return PROVED if search.in_leaf(rows, size, set(letters), ()) else UNDECIDED

        self._each(rows, size, found)

    def _in_cone(self, rows: Rows, size: int) -> None:
        self._check_number()
        for text in self._sampled(rows):
            self._add(text, PROVED)

        def asked(text: str) -> Verdict:
            letters = dict(zip(self.folds, text, strict=True))
            return block_answer(self.pattern, self.stars, letters, self.clock).starts

        self._each(rows, size, asked)

    def _check_number(self) -> None:
        if len(self.folds) > MOST_FOLDS:
            raise TooManyModesError(
                f"{len(self.folds)} folds move together; letters are listed of up to {MOST_FOLDS}"
            )

    def _add(self, text: str, verdict: Verdict) -> None:
        if self.answers.get(text) is not PROVED:
            self.answers[text] = verdict
        if len(self.answers) > MOST_LETTERS:
            raise TooManyModesError(f"more than {2 * MOST_LETTERS} texts of letters occur")

    # --- fold by fold ----------------------------------------------------------------------------

    def _each(self, rows: Rows, size: int, answer: Callable[[str], Verdict]) -> None:
        """Ask for each text that exact weights and single vertices do not exclude in the space."""
        floats = np.array([[float(x) for x in rows[fold]] for fold in self.folds])
        floats /= np.abs(floats).max(axis=1)[:, None]
        waiting: list[tuple[str, FloatArray | None]] = [("", None)]
        steps = 0
        while waiting:
            text, inside = waiting.pop()
            steps += 1
            if steps > MOST_LETTERS:
                raise TooManyModesError("there are too many texts of letters to ask for each")
            self.clock.check()
            if len(text) == len(self.folds):
                if self.answers.get(text) in (None, UNDECIDED):
                    self._add(text, answer(text))
                continue
            for letter in "V" if not text else "MV":
                new = text + letter
                if not self._fits(new):
                    continue
                point = self._inside(floats, new, inside)
                if point is None and self._excluded(rows, size, new):
                    continue
                waiting.append((new, point))

    def _fits(self, text: str) -> bool:
        """Whether the ends of the last fold can have the letters so far."""
        letters = dict(zip(self.folds, text, strict=False))
        return all(
            self.fans[v].folds([letters.get(fold, "U") for fold in self.stars[v].folds])
            for v in self.folds[len(text) - 1]
            if v in self.stars
        )

    def _inside(
        self, floats: FloatArray, text: str, before: FloatArray | None
    ) -> FloatArray | None:
        """A point at which the first folds have these letters; the one before, if it will do."""
        last = len(text) - 1
        if before is not None and SIDES[text[last]] * float(floats[last] @ before) > _TINY:
            return before
        sides = np.array([SIDES[letter] for letter in text])
        return inner_point(floats[: len(text)] * sides[:, None])

    def _excluded(self, rows: Rows, size: int, text: str) -> bool:
        letters = dict.fromkeys(self.folds, "U") | dict(zip(self.folds, text, strict=False))
        search = LetteredSpaces(self.stars, letters)
        return search.excluded(rows, size, set(self.folds[: len(text)]))

    # --- random motions --------------------------------------------------------------------------

    def _sampled(self, rows: Rows) -> Iterator[str]:
        """Letters of motions that Newton's method finds from random points, each proved."""
        basis = np.linalg.qr(np.array([[float(x) for x in rows[fold]] for fold in self.folds]))[0]
        forms = []
        for star in self.stars.values():
            d = np.array([[float(x) for x in direction] for direction in star.directions])
            brackets = np.triu(np.outer(d[:, 0], d[:, 1]) - np.outer(d[:, 1], d[:, 0]), 1)
            inside = basis[[self.folds.index(fold) for fold in star.folds]]
            forms.append(inside.T @ (brackets + brackets.T) @ inside / np.abs(brackets).max())
        random = np.random.default_rng(1)
        seen: set[str] = set()
        idle = 0
        for _ in range(_MOST_SAMPLES):
            idle += 1
            if idle > _PATIENCE or self.clock.passed:
                return
            x = random.standard_normal(basis.shape[1])
            for _ in range(12):
                slopes = np.array([2 * form @ x for form in forms])
                values = np.array([x @ form @ x for form in forms])
                x = x - np.linalg.lstsq(slopes, values, rcond=1e-10)[0]
                x /= np.linalg.norm(x)
            w = basis @ x
            if np.abs(w).min() < _TINY or np.abs(values).max() > _TINY:
                continue
            text = "".join("V" if y * w[0] > 0 else "M" for y in w)
            if text in seen or self.answers.get(text) is PROVED:
                continue
            seen.add(text)
            boxes = regular_motion(self.stars, dict(zip(self.folds, map(float, w), strict=True)))
            if boxes and all(abs(y) > radius for y, radius in boxes.values()):
                idle = 0
                yield text
