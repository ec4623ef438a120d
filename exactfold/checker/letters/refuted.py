"""Refuted sets: signs of some vertices that no solution with given letters has.

The proof is docs/assignment.md, Theorem 1. The curvature forms are computed from the bends of the
folds; the program that writes the certificates uses another formula.
"""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import Any

from ..core.reading import items, keys, natural, parse_integer, require
from ..sheets.sheet import Edge, Sheet, turn

Signs = dict[int, int]
Heights = Mapping[int, int]


class Stars:
    """The stars of one sheet and the letters of all its folds."""

    def __init__(self, sheet: Sheet, letters: Mapping[Edge, str]) -> None:
        self.sheet, self.letters = sheet, letters
        self._sides: dict[int, dict[int, Fraction]] = {}
        self._bends: dict[int, list[tuple[int, dict[int, Fraction], Fraction]]] = {}

    def refuted(self, entry: Any, name: str) -> Signs:
        """Verify that no solution with the letters has the signs of an entry; return the signs.

        An entry without heights has one vertex, whose folds all bend to one side or stay flat. This
        is a contradiction if they bend along two lines, because then K_v > 0.
        """
        keys(entry, "signs heights", name)
        signs: Signs = {}
        for v, sign in items(entry["signs"], "signs"):
            require(type(sign) is int and abs(sign) == 1, f"{name}: {sign!a} is not a sign")
            signs[natural(v, "a vertex")] = sign
        if entry["heights"] is None:
            ((v, sign),) = signs.items()
            bowl = self._is_bowl(v, sign)
            require(bowl, f"{name}: the letters round vertex {v} do not contradict its sign")
        else:
            self._check(signs, self._heights(entry["heights"]), name)
        return signs

    def _is_bowl(self, v: int, sign: int) -> bool:
        """Whether a star that pops up has only mountains, or only valleys if it pops down.

        Flat folds are allowed. The bent folds must not all lie on one line.
        """
        held = {1: "M", -1: "V"}[sign]
        points = self.sheet.points
        bent = []
        for w in self.sheet.star(v):
            letter = self.letters[_fold(v, w)]
            if letter not in (held, "F"):
                return False
            if letter == held:
                bent.append(points[w])
        return any(turn(points[v], bent[0], other) != 0 for other in bent)

    def _heights(self, entries: Any) -> dict[int, dict[int, int]]:
        """Read the heights of stars, as {hub: {neighbour: height}}.

        Each star may be multiplied by a positive number, so that the heights are integers.
        """
        heights: dict[int, dict[int, int]] = {}
        for v, star in items(entries, "heights"):
            ring = self.sheet.star(natural(v, "a vertex"))  # raises KeyError at the boundary
            texts = items(star, "heights of a star", len(ring))
            heights[v] = {w: parse_integer(z) for w, z in zip(ring, texts, strict=True)}
        return heights

    def _check(self, signs: Signs, heights: dict[int, dict[int, int]], name: str) -> None:
        for v, star in heights.items():
            if v in signs:
                self._check_nappe(v, signs[v], star, name)
            else:
                affine = not any(bend for _, bend, _ in self._bent(v, star))
                require(affine, f"{name}: the star of {v} has no sign, but is not flat")
        strict = False
        for fold in {_fold(v, w) for v, star in heights.items() for w in star}:
            i, j = fold
            total = heights.get(i, {}).get(j, 0) + heights.get(j, {}).get(i, 0)
            letter = self.letters[fold]
            fits = {"M": total >= 0, "V": total <= 0, "U": total == 0, "F": True}[letter]
            require(fits, f"{name}: the sum at fold {fold} has the wrong sign")
            strict = strict or (total != 0 and letter != "F")
        require(strict, f"{name}: no fold contradicts its letter")

    def _check_nappe(self, v: int, sign: int, star: Heights, name: str) -> None:
        require(self.form(v, star) >= 0, f"{name}: K is negative at vertex {v}")
        if v not in self._sides:
            self._sides[v] = self.sheet.sign_of_vertex(v)
        side = sum(c * star[w] for w, c in self._sides[v].items() if w != v)
        require(sign * side >= 0, f"{name}: the star of {v} does not have the sign {sign}")

    def form(self, v: int, star: Heights) -> Fraction:
        """The value of 2 K_v for a star in which v has height 0.

        It is a sum over the neighbours of v: the jump of the slope times the height.
        """
        return sum((bend * star[w] / area for w, bend, area in self._bent(v, star)), Fraction(0))

    def _bent(self, v: int, star: Heights) -> list[tuple[int, Fraction, Fraction]]:
        """For each neighbour w: the bend of the fold vw, and the product of the areas beside it."""
        if v not in self._bends:
            points, rows = self.sheet.points, []
            for w in self.sheet.star(v):
                left, right = self.sheet.next[v][w], self.sheet.next[w][v]
                beside = turn(points[v], points[w], points[left])
                beside *= turn(points[w], points[v], points[right])
                rows.append((w, self.sheet.bend((v, w)), Fraction(beside)))
            self._bends[v] = rows
        return [
            (w, Fraction(sum(c * star[u] for u, c in row.items() if u != v)), area)
            for w, row, area in self._bends[v]
        ]


def _fold(v: int, w: int) -> Edge:
    return (v, w) if v < w else (w, v)
