"""Proofs by unit propagation, for certificates: clauses with hints, found by conflict analysis."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from typing import TypeAlias

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.errors import SolverError

Clause: TypeAlias = tuple[int, ...]
_HIGH = 1e200


class Prover:
    """Clauses, what follows from them, and how: conflict-driven clause learning.

    Literals are integers, as in DIMACS files, and `known` are those that hold by themselves.
    `clauses` are numbered in the order in which they are added or found. `hints` has, for each
    clause that was found, the numbers of those from which it follows: if none of its literals
    holds, each of them, in turn, has one literal left, and the last one none. Clauses with one
    literal are used without a hint.

    `grow` is called with each literal that is found to hold in any case; it returns more clauses.

    >>> prover = Prover(2)
    >>> _ = [prover.add(clause) for clause in ((1, 2), (1, -2), (-1, 2), (-1, -2))]
    >>> prover.refute([1, 2])
    >>> prover.clauses[4:], prover.hints
    ([(-1,), (2,), ()], {4: (2, 3), 5: (0,), 6: (1,)})
    """

    def __init__(
        self,
        variables: int,
        known: Iterable[int] = (),
        grow: Callable[[Prover, int], Iterable[Clause]] = lambda prover, literal: (),
        clock: Clock = UNLIMITED,
    ) -> None:
        self.clauses: list[Clause] = []
        self.hints: dict[int, tuple[int, ...]] = {}
        self.conflict: int | None = None
        self._grow, self._clock = grow, clock
        self._value = [0] * (2 * variables + 1)  # of literal x at place x, also if x < 0
        self._level = [0] * (variables + 1)
        self._reason = [-1] * (variables + 1)
        self._score = [0.0] * (variables + 1)
        self._bump = 1.0
        self._trail: list[int] = []
        self._starts: list[int] = []
        self._done = self._grown = 0
        self._watched: list[list[int]] = []
        self._watching: list[list[int]] = [[] for _ in self._value]
        for literal in known:
            self._set(literal, -1)

    def holds(self, literal: int) -> bool:
        """Whether a literal holds in any case, as far as was found."""
        return self._value[literal] > 0 and self._level[abs(literal)] == 0

    def add(self, clause: Clause, hints: tuple[int, ...] | None = None) -> int:
        """Take in a clause, and return its number; only where nothing is assumed."""
        number = self._record(clause, hints)
        left = [x for x in clause if self._value[x] >= 0]
        if any(self._value[x] > 0 for x in left):
            return number
        if not left and self.conflict is None:
            self.conflict = number
        elif len(left) == 1:
            self._set(left[0], number)
        elif left:
            self._watch(number, left)
        return number

    def refute(self, decide: Sequence[int]) -> None:
        """Find the empty clause; raises `SolverError` if the variables `decide` can be chosen."""
        while self._step(decide, 0):
            pass

    def settle(self, literal: int, decide: Sequence[int]) -> None:
        """Find that a literal holds in any case, or the empty clause; raises `SolverError`."""
        while not self.holds(literal) and self._step(decide, -literal):
            pass

    def propagate(self) -> int | None:
        """Find what follows by itself; return the number of a clause that fails, if any does."""
        while self.conflict is None:
            while self._done < len(self._trail):
                self._done += 1
                failed = self._follow(-self._trail[self._done - 1])
                if failed is not None:
                    return failed
            if self._starts or self._grown == len(self._trail):
                return None
            self._grown += 1
            for clause in self._grow(self, self._trail[self._grown - 1]):
                self.add(clause)
        return self.conflict

    # --- search ----------------------------------------------------------------------------------

    def _step(self, decide: Sequence[int], first: int) -> bool:
        """Propagate, and learn from a conflict or assume one more literal; False at the end."""
        self._clock.check()
        conflict = self.propagate()
        if conflict is not None:
            if self._starts:
                self._learn(conflict)
                return True
            self.conflict = conflict
            if self.clauses[conflict]:
                self._record((), (conflict,))
            return False
        if first and not self._value[first]:
            self._assume(first)
            return True
        left = [v for v in decide if not self._value[v]]
        if not left:
            raise SolverError("an order of layers fulfils what was to be refuted")
        self._assume(max(left, key=self._score.__getitem__))
        return True

    def _assume(self, literal: int) -> None:
        self._starts.append(len(self._trail))
        self._set(literal, -1)

    def _set(self, literal: int, reason: int) -> None:
        """Note that a literal holds; one that holds in any case becomes a clause of its own."""
        if self._value[literal]:
            return
        self._value[literal], self._value[-literal] = 1, -1
        self._level[abs(literal)] = len(self._starts)
        self._reason[abs(literal)] = reason
        self._trail.append(literal)
        if not self._starts and reason >= 0 and len(self.clauses[reason]) > 1:
            self._record((literal,), (reason,))

    def _follow(self, false: int) -> int | None:
        """Look at the clauses that watch a literal which fails now."""
        watching, self._watching[false] = self._watching[false], []
        for place, number in enumerate(watching):
            literals = self._watched[number]
            if literals[0] == false:
                literals[0], literals[1] = literals[1], literals[0]
            other = literals[0]
            if self._value[other] > 0:
                self._watching[false].append(number)
                continue
            for k in range(2, len(literals)):
                if self._value[literals[k]] >= 0:
                    literals[1], literals[k] = literals[k], false
                    self._watching[literals[1]].append(number)
                    break
            else:
                self._watching[false].append(number)
                if self._value[other] < 0:
                    self._watching[false] += watching[place + 1 :]
                    return number
                self._set(other, number)
        return None

    def _learn(self, conflict: int) -> None:
        """Find the clause of the first unique implication point, and go back to its level."""
        level, seen, open_ = len(self._starts), set[int](), 0
        learned: list[int] = []
        used: list[int] = []
        place, reason = len(self._trail) - 1, conflict
        while True:
            used.append(reason)
            for literal in self.clauses[reason]:
                variable = abs(literal)
                if variable not in seen and self._level[variable]:
                    seen.add(variable)
                    self._score[variable] += self._bump
                    if self._level[variable] == level:
                        open_ += 1
                    else:
                        learned.append(literal)
            while abs(self._trail[place]) not in seen:
                place -= 1
            literal = self._trail[place]
            place, open_ = place - 1, open_ - 1
            if not open_:
                break
            reason = self._reason[abs(literal)]
        self._bump *= 1.05
        if self._bump > _HIGH:
            self._score = [score / self._bump for score in self._score]
            self._bump = 1.0
        learned.sort(key=lambda x: -self._level[abs(x)])
        self._back(self._level[abs(learned[0])] if learned else 0)
        clause = (-literal, *learned)
        number = self._record(clause, tuple(reversed(used)))
        if learned:
            self._watch(number, list(clause))
        self._set(-literal, number)

    def _back(self, level: int) -> None:
        start = self._starts[level]
        for literal in self._trail[start:]:
            self._value[literal] = self._value[-literal] = 0
        del self._trail[start:], self._starts[level:]
        self._done = start

    def _record(self, clause: Clause, hints: tuple[int, ...] | None) -> int:
        self.clauses.append(clause)
        self._watched.append([])
        if hints is not None:
            self.hints[len(self.clauses) - 1] = hints
        return len(self.clauses) - 1

    def _watch(self, number: int, literals: list[int]) -> None:
        self._watched[number] = literals
        for literal in literals[:2]:
            self._watching[literal].append(number)


def needed(prover: Prover, wanted: Iterable[int]) -> list[int]:
    """The numbers of the clauses from which some clauses were found, with these, in order."""
    single = {
        clause[0]: k for k, clause in reversed([*enumerate(prover.clauses)]) if len(clause) == 1
    }
    marked, waiting = set[int](), list(wanted)
    while waiting:
        number = waiting.pop()
        if number in marked:
            continue
        marked.add(number)
        for hint in prover.hints.get(number, ()):
            waiting.append(hint)
            for literal in prover.clauses[hint]:
                known = single.get(-literal)
                if known is not None and known < number:
                    waiting.append(known)
    return sorted(marked)
