"""Why no order of layers exists: a small set of constraints that cannot hold together."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.errors import SolverError
from exactfold.layers.constraints import Constraint, Constraints, taco_clauses
from exactfold.layers.orders import solver
from exactfold.layers.sides import Indices

_ROUNDS = 20


class ConflictSearch:
    """Looks for constraints that contradict each other, such that all are needed.

    `used` are the triples whose transitivity the search took in. A selector switches each
    constraint on: those that a solver names for a contradiction are asked again, and at last each
    is left out if the others contradict each other without it.
    """

    def __init__(self, constraints: Constraints, used: Indices) -> None:
        self.constraints = constraints
        self.used = used
        self.edges = list(constraints.given)
        given = np.array([[constraints.given[edge]] for edge in self.edges], dtype=np.int64)
        x, y = constraints.equal.T
        equal = np.stack([np.stack([x, -y], 1), np.stack([-x, y], 1)], 1).reshape(-1, 2)
        rows = constraints.triples(used)
        three = np.stack([rows, -rows], axis=1).reshape(-1, 3)
        self.sizes = (len(self.edges), len(x), len(constraints.tacos), len(used))
        self._clauses: list[list[int]] = []
        self._of: list[int] = []
        first = 0
        tacos = taco_clauses(constraints.tacos)
        blocks = ((given.reshape(-1, 1), 1), (equal, 2), (tacos, 8), (three, 2))
        for size, (block, each) in zip(self.sizes, blocks, strict=True):
            self._clauses += block.tolist()
            self._of += np.repeat(np.arange(first, first + size), each).tolist()
            first += size

    def find(self, clock: Clock = UNLIMITED) -> tuple[Constraint, ...]:
        """The constraints; if the time is over, some may be left that are not needed."""
        first = self.constraints.variables + 1
        with solver([]) as found:
            for clause, one in zip(self._clauses, self._of, strict=True):
                found.add_clause([*clause, -(first + one)])
            known = self._core(found, list(range(first, first + sum(self.sizes))))
            for _ in range(_ROUNDS):
                fewer = self._core(found, known[::-1])
                if len(fewer) >= len(known):
                    break
                known = fewer
            kept: list[int] = []
            while known and not clock.passed:
                *known, last = known
                if found.solve([*kept, *known]):
                    kept.append(last)
                else:
                    core = set(found.get_core())
                    known = [one for one in known if one in core]
        return tuple(self.constraint(one - first) for one in sorted([*known, *kept]))

    def _core(self, found: Any, some: Sequence[int]) -> list[int]:
        if found.solve(some):
            raise SolverError("constraints that were refuted can be satisfied")
        return sorted(found.get_core())

    def constraint(self, number: int) -> Constraint:
        """The constraint with a number: letters first, then the rows of the others."""
        kind = 0
        while number >= self.sizes[kind]:
            number -= self.sizes[kind]
            kind += 1
        if kind == 0:
            return self.constraints.letter(self.edges[number])
        if kind == 1:
            return self.constraints.equality(number)
        if kind == 2:
            return self.constraints.taco(number)
        pieces = tuple(sorted(self.used[number].tolist()))
        return Constraint("transitivity", (), pieces)
