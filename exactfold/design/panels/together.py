"""Which creases can bend their way together to first order, and which never can."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.design.panels.first_order_program import SIDES, FirstOrderProgram, solved
from exactfold.design.refutations.refutation import Letters
from exactfold.exact.surds import Number, sign
from exactfold.panels.spaces.kernel import entry, number
from exactfold.panels.vertex.stars import Star
from exactfold.pattern.panel_pattern import Edge, Point

Planes = Mapping[int, Point]
"""A vector at each of some vertices."""

_ROUNDS: Final = 12
_MOST_FOLDS: Final = 6_000


@dataclass(frozen=True, repr=False)
class Together:
    """Which folds with letters can bend their way together to first order, and which never can.

    Consider the first-order motions sum_k w_k d_k = 0 in which no fold bends against its letter.
    `motion` is one of them in which all folds of `together` bend their way. In all of them the
    folds of `never` stay flat, as `steps` show one after the other (`FlatByLetters`). `undecided`
    are the folds of which neither is proved. `motion` holds densities of the folds that the flat
    closure leaves. Other folds with letters are among `never`, except folds from boundary to
    boundary, which are among `together`.
    """

    together: tuple[Edge, ...]
    never: tuple[Edge, ...]
    undecided: tuple[Edge, ...]
    motion: Mapping[Edge, Number]
    steps: tuple[Planes, ...]

    def __repr__(self) -> str:
        return f"<Together: {len(self.together)}, never {len(self.never)}>"


def going_together(
    stars: Mapping[int, Star], letters: Letters, clock: Clock = UNLIMITED
) -> Together | None:
    """Which folds of these stars can bend their way together, and which never; None if too many.

    Single vertices come first. Then linear programs propose motions and vectors, which are made
    exact. When the clock has passed, folds are left undecided.

    >>> star = Star(0, ((0, 1), (0, 2), (0, 3), (0, 4)), ((1, 0), (0, 1), (-1, 0), (0, -1)))
    >>> answer = going_together({0: star}, dict(zip(star.folds, "MVVV")))
    >>> answer.together, answer.never, answer.undecided
    (((0, 2), (0, 4)), ((0, 1), (0, 3)), ())
    """
    folds = {edge for star in stars.values() for edge in star.folds}
    if len(folds) > _MOST_FOLDS:
        return None
    asked = sorted(edge for edge in folds if letters[edge] in SIDES)
    flat = FlatByLetters(stars, letters)
    for _ in range(_ROUNDS):
        program = FirstOrderProgram(flat.left(), letters, clock)
        if not program.lettered:
            return _result(asked, flat, {}, letters)
        near, rest = program.going_together()
        planes = program.holding_flat(rest) if rest and not clock.passed else None
        if planes is None or not flat.add(planes):
            break
    motion = _motion(program, letters, near, rest)
    return _result(asked, flat, motion, letters)


def _result(
    asked: Iterable[Edge], flat: FlatByLetters, motion: Mapping[Edge, Number], letters: Letters
) -> Together:
    going = [edge for edge in asked if motion.get(edge)]
    left = [edge for edge in asked if edge not in flat.flat and not motion.get(edge)]
    return Together(tuple(going), tuple(sorted(flat.flat)), tuple(left), motion, tuple(flat.steps))


def _motion(
    program: FirstOrderProgram, letters: Letters, near: Mapping[Edge, float], rest: Iterable[Edge]
) -> dict[Edge, Number]:
    """An exact motion near a floating-point motion in which the folds of `rest` stay flat.

    If rounded coordinates make some folds bend against their letters, these are held flat as well.
    The result is empty if no exact motion is found.
    """
    held = set(rest)
    order = sorted(program.stars, key=lambda v: min(program.stars[v].folds))
    for _ in range(_ROUNDS):
        rows = [
            {
                edge: entry(d[axis])
                for edge, d in zip(star.folds, star.directions, strict=True)
                if edge not in held
            }
            for star in (program.stars[v] for v in order)
            for axis in (0, 1)
        ]
        values = solved(rows, {edge: x for edge, x in near.items() if edge not in held})
        if values is None:
            return {}
        exact = {edge: number(x) for edge, x in values.items()}
        against = {e for e, x in exact.items() if sign(x) == -SIDES.get(letters[e], 0) != 0}
        if not against:
            return {edge: x for edge, x in exact.items() if x}
        held |= against
    return {}


class FlatByLetters:
    """Folds with letters that stay flat in all motions in which no fold bends against its letter.

    The motions are those to first order. Consider the sum 0 = sum_v y_v . sum_k w_k d_k = sum_f w_f
    s_f. If w_f s_f is at most 0 for all folds that are not known to be flat, and 0 for free ones,
    then w_f = 0 wherever s_f is not 0 (docs/assignment.md, Theorem 1). `flat` are the folds shown
    to be flat. `steps` are the vectors that show it; each step uses the folds that earlier steps
    showed to be flat.
    """

    def __init__(self, stars: Mapping[int, Star], letters: Letters) -> None:
        self.stars, self.letters = stars, letters
        self.flat: set[Edge] = set()
        self.steps: list[Planes] = []
        self._spread(stars)

    def left(self) -> dict[int, Star]:
        """The stars, restricted to the folds that are not known to stay flat."""
        restricted = {
            v: star.only(edge for edge in star.folds if edge not in self.flat)
            for v, star in self.stars.items()
        }
        return {v: star for v, star in restricted.items() if star.folds}

    def add(self, planes: Planes) -> bool:
        """Add the folds that these vectors show to be flat, and all that follow at single vertices.

        Return False if the vectors show nothing.
        """
        shown = self._shown(planes)
        if not shown:
            return False
        self._take(planes, shown)
        self._spread({v for fold in shown for v in fold if v in self.stars})
        return True

    def _take(self, planes: Planes, folds: Iterable[Edge]) -> None:
        self.steps.append(planes)
        self.flat.update(folds)

    def _shown(self, planes: Planes) -> list[Edge]:
        total: dict[Edge, Number] = {}
        for v, (x, y) in planes.items():
            star = self.stars[v]
            for edge, (a, b) in zip(star.folds, star.directions, strict=True):
                if edge not in self.flat:
                    value = x * a + y * b
                    total[edge] = total[edge] + value if edge in total else value
        sides = {edge: sign(value) for edge, value in total.items()}
        against = (side not in (0, -SIDES.get(self.letters[e], 0)) for e, side in sides.items())
        return [] if any(against) else [edge for edge, side in sides.items() if side]

    def _spread(self, vertices: Iterable[int]) -> None:
        waiting = dict.fromkeys(vertices)
        while waiting:
            v, _ = waiting.popitem()
            for y in _candidates(self.stars[v], self.flat):
                shown = self._shown({v: y})
                if shown:
                    self._take({v: y}, shown)
                    waiting |= {u: None for edge in shown for u in edge if u in self.stars}
                    break


def _candidates(star: Star, flat: set[Edge]) -> Iterator[Point]:
    for edge, (x, y) in zip(star.folds, star.directions, strict=True):
        if edge not in flat:
            yield -y, x
            yield y, -x
            yield x, y
            yield -x, -y
