"""Proofs by unit propagation that some clauses contradict each other (RUP, with hints).

A step is a clause and the numbers of earlier clauses. Suppose that none of its orders holds. Each
of the earlier clauses, in turn, has then at most one order that is not known to fail, and this one
holds; the last has none, which is a contradiction. So the clause of the step follows. What is known
from clauses with one order needs no number. (E. Goldberg and Y. Novikov, Verification of proofs of
unsatisfiability for CNF formulas, 2003.)
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import Any

from ..core.limits import FLAT_STEPS
from ..core.reading import at_most, items, natural, require
from .orders import Order
from .places import Clause, read_orders, told


class Refutation:
    """Clauses that are known to hold, and what follows from them.

    `known` has the orders that hold by themselves, and those that clauses with one order say. The
    clauses are numbered in the order in which they are added.
    """

    def __init__(self, pieces: int, known: Iterable[Order]) -> None:
        self.pieces, self.known = pieces, set(known)
        self.clauses: list[Clause] = []
        self._read = 0

    def add(self, clause: Clause) -> None:
        """Take in a clause that is true."""
        self.clauses.append(clause)
        if len(clause) == 1:
            self.known.add(clause[0])

    def follow(self, steps: Any) -> None:
        """Take in the clauses of steps; raises at the first that does not follow."""
        for entry in items(steps, "steps"):
            orders, hints = items(entry, "a step", 2)
            clause = read_orders(orders, self.pieces)
            numbers = [natural(number, "a hint") for number in items(hints, "hints")]
            require(self._follows(clause, numbers), f"{told(clause)} does not follow")
            self.add(clause)

    def contradict(self, clauses: Sequence[Clause], steps: Any) -> None:
        """Raise unless steps lead from what is known, and more clauses, to a contradiction.

        Afterwards these clauses, and what was found with them, are left out again.
        """
        known, count = self.known.copy(), len(self.clauses)
        for clause in clauses:
            self.add(clause)
        self.follow(steps)
        require(() in self.clauses[count:], "the steps do not lead to a contradiction")
        self.known = known
        del self.clauses[count:]

    def _follows(self, clause: Clause, hints: Iterable[int]) -> bool:
        true = {(b, a) for a, b in clause}
        for number in hints:
            require(number < len(self.clauses), f"there is no clause {number}")
            earlier = self.clauses[number]
            self._read += len(earlier)
            at_most(self._read, FLAT_STEPS, "the orders in steps", "FLAT_STEPS")
            left = [(a, b) for a, b in earlier if not ((b, a) in true or (b, a) in self.known)]
            if not left:
                return True
            require(len(left) == 1, f"clause {number} leaves {len(left)} orders open")
            true.add(left[0])
        return False
