"""Which folds are to blame: sets of folds such that every branch differs at one of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence, Set
from dataclasses import dataclass

from exactfold.design.refutations.refutation import Letters, Refutation, refuted_at
from exactfold.pattern.crease_pattern import CreasePattern, Edge

Folds = frozenset[Edge]


@dataclass(frozen=True)
class Clause:
    """A claim: every ray with all these signs has another letter than asked at one of these folds.

    Only rays that are already known may be exceptions. `signs` is a set of pairs of a vertex and
    its sign.
    """

    signs: frozenset[tuple[int, int]]
    folds: Folds


def clause_of(refutation: Refutation, labels: Sequence[int]) -> Clause:
    """What a refutation implies for letters that agree with the refuted ones at some folds only.

    In the sum of docs/assignment.md, Theorem 1, a fold whose two heights cancel does not occur, so
    its letter is irrelevant. The sign of a vertex whose heights are all 0 is irrelevant, too.
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
    """What the stars of single vertices imply for letters when some folds are freed.

    `letters` are those of all folds of `sheet`, whose vertex v is vertex `labels[v]` of the
    pattern. The folds that are freed have the pattern's names. Each star is examined once for each
    set of its folds that is freed.

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
        """The clauses of all signs that the star of their vertex refutes by itself."""
        return [clause for v in self.sheet.interior for clause in self._at(v, freed)]

    def conflicts(self, freed: Set[Edge]) -> dict[int, Folds]:
        """Folds at one of which every ray differs, for each vertex whose letters leave it
        no sign.
        """
        conflicts: dict[int, Folds] = {}
        for v in self.sheet.interior:
            clauses = self._at(v, freed)
            if len(clauses) == 2:
                conflicts[self.labels[v]] = clauses[0].folds | clauses[1].folds
        return conflicts

    def _at(self, vertex: int, freed: Set[Edge]) -> list[Clause]:
        around = self._around[vertex]
        key = vertex, frozenset(fold for fold in around.values() if fold in freed)
        if key not in self._known:
            free = {pair: "U" for pair, fold in around.items() if fold in freed}
            self._known[key] = self._looked_at(vertex, {**self.letters, **free})
        return self._known[key]

    def _looked_at(self, vertex: int, letters: Letters) -> list[Clause]:
        clauses = []
        for sign in (1, -1):
            reason = refuted_at(self.sheet, letters, vertex, sign)
            if isinstance(reason, str):
                star = frozenset(self._around[vertex].values())
                clauses.append(Clause(frozenset({(self.labels[vertex], sign)}), star))
            elif reason is not None and reason.holds(self.sheet, letters):
                clauses.append(clause_of(reason, self.labels))
        return clauses


def to_blame(clauses: Iterable[Clause]) -> Folds:
    """Folds such that every unknown ray has another letter than asked at one of them.

    The clauses together leave no vector of signs. Signs are derived from one clause after the other
    until they contradict a clause; then only the folds of the clauses used are returned. If no such
    contradiction is met, the folds of all clauses are returned.
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
    """The size of a collection of pairwise disjoint sets among these sets, chosen greedily.

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
    """The folds of a clause and of all clauses from which its signs were derived."""
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
