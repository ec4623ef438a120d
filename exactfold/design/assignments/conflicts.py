"""Which folds are to blame: sets of folds of which every branch has one with another letter."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass

from exactfold.design.refutations.refutation import Letters, Refutation, refuted_at
from exactfold.pattern.crease_pattern import CreasePattern, Edge

Folds = frozenset[Edge]


@dataclass(frozen=True)
class Clause:
    """A half of a branch with all these signs has another letter at one of these folds.

    Only a half that is known may have none. `signs` are pairs of a vertex and its sign.
    """

    signs: frozenset[tuple[int, int]]
    folds: Folds


def clause_of(refutation: Refutation, labels: Sequence[int]) -> Clause:
    """What a refutation says of letters that agree with those refuted at some folds only.

    In the sum of docs/assignment.md, Theorem 1, a fold whose two heights cancel has no part: its
    letter may be any. A vertex whose heights are all 0 may have either sign.
    """
    sums: dict[tuple[int, int], object] = {}
    for v, w in refutation.heights:
        pair = (min(v, w), max(v, w))
        total = refutation.heights.get(pair, 0) + refutation.heights.get(pair[::-1], 0)
        if total:
            sums[pair] = total
    bent = {v for (v, _), z in refutation.heights.items() if z}
    return Clause(
        frozenset((labels[v], sign) for v, sign in refutation.signs.items() if v in bent),
        frozenset(_named(labels, pair) for pair in sums),
    )


class Stars:
    """What the stars of single vertices say of letters, some of which are freed.

    `letters` of all folds of `sheet`, whose vertex v is `labels[v]` of the pattern; the folds that
    are freed have the names of the pattern. Each star is looked at once for each set freed in it.

    >>> from exactfold.pattern.families import single_vertex
    >>> sheet = single_vertex(4)
    >>> stars = Stars(sheet, dict.fromkeys(sheet.folds, "M"), range(5))
    >>> stars.conflicts(frozenset())[4] == set(sheet.folds), stars.conflicts({(0, 4)})
    (True, {})
    """

    def __init__(self, sheet: CreasePattern, letters: Letters, labels: Sequence[int]) -> None:
        self.sheet, self.letters, self.labels = sheet, letters, labels
        self._around = {
            v: {(min(v, w), max(v, w)): _named(labels, (v, w)) for w in sheet.star(v)}
            for v in sheet.interior
        }
        self._known: dict[tuple[int, Folds], list[Clause]] = {}

    def clauses(self, freed: Set[Edge]) -> list[Clause]:
        """For each sign that the star of its vertex alone refutes, what it says."""
        return [clause for v in self.sheet.interior for clause in self._at(v, freed)]

    def conflicts(self, freed: Set[Edge]) -> dict[int, Folds]:
        """By vertex whose letters leave it no sign: folds of which one has another letter."""
        found: dict[int, Folds] = {}
        for v in self.sheet.interior:
            clauses = self._at(v, freed)
            if len(clauses) == 2:
                found[self.labels[v]] = clauses[0].folds | clauses[1].folds
        return found

    def _at(self, vertex: int, freed: Set[Edge]) -> list[Clause]:
        around = self._around[vertex]
        key = vertex, frozenset(fold for fold in around.values() if fold in freed)
        if key not in self._known:
            free = {pair: "U" for pair, fold in around.items() if fold in freed}
            self._known[key] = self._looked_at(vertex, {**self.letters, **free})
        return self._known[key]

    def _looked_at(self, vertex: int, letters: Letters) -> list[Clause]:
        found = []
        for sign in (1, -1):
            reason = refuted_at(self.sheet, letters, vertex, sign)
            if isinstance(reason, str):
                star = frozenset(self._around[vertex].values())
                found.append(Clause(frozenset({(self.labels[vertex], sign)}), star))
            elif reason is not None and reason.holds(self.sheet, letters):
                found.append(clause_of(reason, self.labels))
        return found


def to_blame(clauses: Iterable[Clause]) -> Folds:
    """Folds of which every half that is not known has one with another letter.

    The clauses leave no vector of signs. Signs that follow from one clause after the other lead to
    one that they contradict, and only the clauses on the way are needed; if none is met so, all.
    """
    known = sorted(clauses, key=lambda clause: len(clause.folds))
    signs: dict[int, int] = {}
    origin: dict[int, Clause] = {}
    while True:
        forced = False
        for clause in known:
            open_ = [pair for pair in clause.signs if signs.get(pair[0]) != pair[1]]
            if not open_:
                return _behind(clause, origin)
            if len(open_) == 1 and open_[0][0] not in signs:
                vertex, sign = open_[0]
                signs[vertex], origin[vertex] = -sign, clause
                forced = True
        if not forced:
            return frozenset().union(*(clause.folds for clause in known))


def disjoint(conflicts: Mapping[int, Folds]) -> int:
    """How many of some sets of folds, taken greedily, have no fold in common.

    >>> disjoint({4: frozenset({(0, 4)}), 5: frozenset({(0, 4), (0, 5)})})
    1
    """
    taken: set[Edge] = set()
    count = 0
    for folds in sorted(conflicts.values(), key=len):
        if taken.isdisjoint(folds):
            taken |= folds
            count += 1
    return count


def _behind(last: Clause, origin: Mapping[int, Clause]) -> Folds:
    """The folds of a clause and of those from which its signs follow."""
    folds: set[Edge] = set()
    stack, seen = [last], {last}
    while stack:
        clause = stack.pop()
        folds |= clause.folds
        for vertex, _ in clause.signs:
            before = origin.get(vertex)
            if before is not None and before not in seen:
                seen.add(before)
                stack.append(before)
    return frozenset(folds)


def _named(labels: Sequence[int], pair: tuple[int, int]) -> Edge:
    i, j = labels[pair[0]], labels[pair[1]]
    return (i, j) if i < j else (j, i)
