"""Why no order of layers exists: a small set of constraints that cannot hold together."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from exactfold._support.clock import UNLIMITED, Clock
from exactfold.errors import SolverError
from exactfold.layers.constraints import Constraint, Constraints
from exactfold.layers.orders import solver

_ROUNDS = 20


def conflict(
    constraints: Constraints, used: Iterable[Constraint], clock: Clock = UNLIMITED
) -> tuple[Constraint, ...]:
    """Constraints that contradict each other; without any one of them, the others do not.

    `used` are the constraints of transitivity that the search took in. A solver names constraints
    that it needed; then each is left out if the others still contradict each other. If the time is
    over, some may be left that are not needed.
    """
    every = [*constraints.letters, *constraints.same, *constraints.tacos_of, *used]
    known = _needed(constraints, every)
    for _ in range(_ROUNDS):
        fewer = _needed(constraints, known[::-1])
        if len(fewer) == len(known):
            break
        known = fewer
    kept: list[Constraint] = []
    while known and not clock.passed:
        *known, last = known
        if _possible(constraints, [*kept, *known]):
            kept.append(last)
    return (*known, *kept[::-1])


def _needed(constraints: Constraints, some: Sequence[Constraint]) -> list[Constraint]:
    """Those that the solver needed for a contradiction."""
    first = constraints.variables + 1
    with solver([]) as found:
        for k, constraint in enumerate(some):
            for clause in constraints.clauses(constraint):
                found.add_clause([*clause, -(first + k)])
        if found.solve(list(range(first, first + len(some)))):
            raise SolverError("constraints that were refuted can be satisfied")
        return [some[k - first] for k in sorted(found.get_core())]


def _possible(constraints: Constraints, some: Sequence[Constraint]) -> bool:
    clauses = [list(c) for constraint in some for c in constraints.clauses(constraint)]
    with solver(clauses) as found:
        return bool(found.solve())
