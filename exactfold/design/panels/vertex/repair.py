"""A small change of letters after which the vertices of a sheet start to fold by themselves."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Final

from exactfold.design.refutations.refutation import Letters
from exactfold.panels.vertex.stars import Star
from exactfold.panels.vertex.vertex_motions import Fan
from exactfold.pattern.panel_pattern import Edge

_OTHER: Final = {"M": "V", "V": "M"}
_SECONDS: Final = 5.0
"""The search for the smallest change ends after this time, with the best that it has found."""

Terms = dict[object, float]
"""A linear form in unknowns that are 0 or 1."""


@dataclass(frozen=True)
class Repair:
    """Folds whose letters M and V are exchanged so that vertices start to fold by themselves.

    It is exact that all vertices but `stuck` start then. That no smaller change does as much is the
    result of a search in floating point, which may have ended early.
    """

    folds: tuple[Edge, ...]
    stuck: tuple[int, ...]


def repaired(
    fans: Mapping[int, tuple[Star, Fan]], letters: Letters, seconds: float = _SECONDS
) -> Repair:
    """Look for few folds whose letters M and V can be exchanged so that every vertex starts.

    As few vertices as possible stay as they are. An integer linear program proposes the folds. A
    vertex with all its letters pops up if every open half-plane of its folds holds a mountain, and
    some fold is a valley (docs/vertices.md, Theorem 1). So its unknowns are whether each fold is
    exchanged and whether the vertex pops up, and all conditions are linear.
    """
    program = _Program()
    for star, fan in fans.values():
        _conditions(program, star, fan, letters)
    exchanged = program.solution(seconds)
    changed = {e: _OTHER[x] if e in exchanged else x for e, x in letters.items()}
    stuck = [
        v
        for v, (star, fan) in fans.items()
        if {"M", "V"} & set(given := [changed[e] for e in star.folds]) and not fan.folds(given)
    ]
    return Repair(tuple(sorted(e for e in letters if e in exchanged)), tuple(sorted(stuck)))


class _Program:
    """An integer linear program: conditions sum >= least in unknowns that are 0 or 1."""

    def __init__(self) -> None:
        self.places: dict[object, int] = {}
        self.costs: list[float] = []
        self.rows: list[tuple[Terms, float]] = []

    def unknown(self, key: object, cost: float = 0.0) -> object:
        """An unknown with a cost; the same key is the same unknown."""
        if key not in self.places:
            self.places[key] = len(self.costs)
            self.costs.append(cost)
        return key

    def solution(self, seconds: float) -> set[object]:
        """The unknowns that are 1 in the best solution found; none if there is none."""
        if not self.rows:
            return set()
        import numpy as np  # imported here: commands that only ask which vertices start go on fast
        from scipy.optimize import Bounds, LinearConstraint, milp
        from scipy.sparse import csr_array

        entries = [
            (k, self.places[key], x)
            for k, (terms, _) in enumerate(self.rows)
            for key, x in terms.items()
        ]
        rows, columns, values = zip(*entries, strict=True)
        matrix = csr_array((values, (rows, columns)), shape=(len(self.rows), len(self.costs)))
        found = milp(
            np.array(self.costs),
            integrality=np.ones(len(self.costs)),
            bounds=Bounds(0, 1),
            constraints=LinearConstraint(matrix, [least for _, least in self.rows], np.inf),
            options={"time_limit": seconds},
        )
        if found.x is None:
            return set()
        return {key for key, k in self.places.items() if found.x[k] > 0.5}


def _conditions(program: _Program, star: Star, fan: Fan, letters: Letters) -> None:
    """The conditions of one vertex, which may be given up at a cost above that of all changes."""
    given = [letters[fold] for fold in star.folds]
    if {"M", "V"}.isdisjoint(given):
        return
    v = star.vertex
    given_up = program.unknown(("stuck", v), len(letters) + 1.0)
    up = program.unknown(("up", v))
    kept = [k for k, x in enumerate(given) if x != "F"]
    pair = _pair(program, star, fan, letters)
    # up = 1: each half-plane has a mountain, and there is a valley; up = 0: letters exchanged
    for letter, chosen in (("M", 1.0), ("V", -1.0)):
        for side in (*_half_planes(fan, kept), None):
            terms: Terms = {given_up: 1.0, up: -chosen}
            if pair is not None:
                terms[pair] = 1.0
            wanted = letter if side is not None else _OTHER[letter]
            among = kept if side is None else side
            constant = _count(program, star, given, among, wanted, terms)
            program.rows.append((terms, (0.0 if chosen > 0 else 1.0) - constant))


def _count(
    program: _Program, star: Star, given: list[str], side: list[int], wanted: str, terms: Terms
) -> float:
    """Add the number of folds with a letter to a linear form, and return its constant part."""
    constant = 0.0
    for k in side:
        if given[k] == "U":
            mine = program.unknown((star.vertex, k, wanted))
            terms[mine] = 1.0
            other = program.unknown((star.vertex, k, _OTHER[wanted]))
            program.rows.append(({mine: -1.0, other: -1.0}, -1.0))
            continue
        exchanged = program.unknown(star.folds[k], 1.0)
        same = given[k] == wanted
        constant += same
        terms[exchanged] = -1.0 if same else 1.0
    return constant


def _half_planes(fan: Fan, kept: list[int]) -> Iterator[list[int]]:
    """The folds in the smallest open half-planes: those on either side of the line of a fold."""
    for k in kept:
        left = {(k + step) % fan.count for step in range(1, fan.reach[k] + 1)}
        yield [j for j in kept if j in left]
        yield [j for j in kept if j not in left and j not in (k, fan.opposite[k])]


def _pair(program: _Program, star: Star, fan: Fan, letters: Letters) -> object | None:
    """The unknown that two folds on a straight line have the same letter; None if others move."""
    given = [letters[fold] for fold in star.folds]
    moving = [k for k, x in enumerate(given) if x in _OTHER]
    other = fan.opposite[moving[0]]
    if other is None or given[other] == "F" or not {*moving} <= {moving[0], other}:
        return None
    key = program.unknown(("pair", star.vertex))
    if given[other] != "U":
        one, two = (program.unknown(star.folds[k], 1.0) for k in (moving[0], other))
        if given[moving[0]] == given[other]:  # both or none exchanged
            program.rows += [({key: -1.0, one: 1.0, two: -1.0}, -1.0)]
            program.rows += [({key: -1.0, one: -1.0, two: 1.0}, -1.0)]
        else:
            program.rows += [({key: -1.0, one: 1.0, two: 1.0}, 0.0)]
            program.rows += [({key: -1.0, one: -1.0, two: -1.0}, -2.0)]
    return key
