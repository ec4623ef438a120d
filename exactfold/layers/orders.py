"""All orders of layers of a folded sheet: what is forced, and independent parts of the rest."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field
from typing import Any, Final, TypeAlias

import numpy as np
import numpy.typing as npt
from scipy.sparse import coo_matrix, csr_matrix
from scipy.sparse.csgraph import connected_components

from exactfold._support.clock import UNLIMITED, Clock
from exactfold._support.progress import Progress
from exactfold.errors import TooManyModesError
from exactfold.layers.common import Common
from exactfold.layers.constraints import Constraints, taco_clauses
from exactfold.layers.sides import Indices

Values: TypeAlias = npt.NDArray[np.int8]

LISTED: Final = 1000
"""At most so many states of a component are kept; all are counted."""
_AT_ONCE: Final = 4
_TRIPLES: Final = 3_000_000
_CLASSES: Final = 1_000_000


class ContradictionError(Exception):
    """No order satisfies the constraints; for use in this module."""


@dataclass(frozen=True)
class Component:
    """Pairs whose orders depend on each other, and on no other pair.

    `pairs` are indices of overlapping pairs. Each row of `states` has 1 for a pair whose second
    piece lies above the first, else -1. `count` is the number of all states, None if it is not
    known; `least` of them were found, and `states` has the first ones.
    """

    pairs: Indices
    states: Values
    count: int | None
    least: int


@dataclass(frozen=True)
class Orders:
    """All orders of the layers: `fixed` holds in all; a state takes any one of each component.

    `fixed` has 1 or -1 for a pair with the same order in all states, else 0. `used` are the
    triples whose transitivity was taken in. If there is no state, `refuted` is true, and `fixed`
    and `components` say nothing.
    """

    fixed: Values
    components: tuple[Component, ...]
    used: Indices
    refuted: bool = False
    stopped: str = ""
    triples: int = field(default=0, compare=False)


class Search:
    """The search for all orders, on classes of pairs that are equal or opposite.

    Equalities join literals to classes at once. Other constraints are clauses over the classes.
    Constraints of transitivity are taken in only where they matter: if two known relations imply or
    contradict a third one, or if at least two of three relations are open.
    """

    def __init__(
        self,
        constraints: Constraints,
        clock: Clock = UNLIMITED,
        progress: Progress | None = None,
        most: int = LISTED,
    ) -> None:
        self.constraints = constraints
        self.overlaps = constraints.overlaps
        self.common = Common(self.overlaps)
        self.clock, self.progress, self.most = clock, progress, most
        self._used: list[Indices] = []
        self._apart: Indices = np.zeros(0, dtype=np.int64)
        self._tests = 0

    @property
    def used(self) -> Indices:
        """The triples whose transitivity was taken in."""
        return np.concatenate([np.zeros((0, 3), dtype=np.int64), *self._used])

    def run(self) -> Orders:
        """All orders."""
        try:
            self._classes()
            self._set(self._class(np.array(list(self.constraints.given.values()), dtype=np.int64)))
            self._take(self._class(taco_clauses(self.constraints.tacos)))
            self._propagate()
            self._close()
            self._open()
            return self._components()
        except ContradictionError:
            return Orders(
                np.zeros(self.constraints.variables, dtype=np.int8),
                (),
                self.used,
                refuted=True,
                triples=self._tests,
            )

    # --- classes of pairs ------------------------------------------------------------------------

    def _classes(self) -> None:
        count = self.constraints.variables
        equal = self.constraints.equal
        nodes = 2 * (abs(equal) - 1) + (equal < 0)
        both = np.concatenate([nodes, nodes ^ 1])
        ones = np.ones(len(both), dtype=np.int8)
        graph = coo_matrix((ones, (both[:, 0], both[:, 1])), shape=(2 * count, 2 * count))
        _, labels = connected_components(graph, directed=False)
        plus, minus = labels[0::2], labels[1::2]
        if (plus == minus).any():
            raise ContradictionError
        names, place = np.unique(np.minimum(plus, minus), return_inverse=True)
        if len(names) > _CLASSES:
            raise TooManyModesError(f"more than {_CLASSES} orders of layers are open")
        self._literal: Indices = np.where(plus < minus, place + 1, -place - 1)
        self.size = len(names)
        self._value = np.zeros(2 * self.size + 1, dtype=np.int8)
        self._value[self.size] = -1  # the literal 0 fills short clauses
        self._rows: Indices = np.zeros((0, 3), dtype=np.int64)

    def _class(self, literals: Indices) -> Indices:
        return np.sign(literals) * self._literal[abs(literals) - 1]

    def _take(self, rows: Indices) -> None:
        """Take in clauses of three literals, without those that hold in any case."""
        a, b, c = rows.T
        holds = (a == -b) | (a == -c) | (b == -c)
        for column in (a, b, c):
            holds |= self._value[column + self.size] == 1
        rows = np.concatenate([self._rows, np.sort(rows[~holds], axis=1)])
        _, first = np.unique(self._code(rows), return_index=True)
        self._rows = rows[first]

    def _code(self, rows: Indices) -> Indices:
        """A number for each row of three literals, different for different rows.

        It has 64 bits, which suffices for a million classes.
        """
        a, b, c = rows.T + self.size
        width = 2 * self.size + 1
        code: Indices = (a * width + b) * width + c
        return code

    # --- what is forced --------------------------------------------------------------------------

    def _set(self, literals: Indices) -> None:
        literals = literals[literals != 0]
        self._value[literals + self.size] = 1
        if (self._value[self.size - literals] == 1).any():
            raise ContradictionError
        self._value[self.size - literals] = -1

    def _propagate(self) -> None:
        """Set what clauses force, and drop those that hold."""
        while True:
            values = self._value[self._rows + self.size]
            keep = ~(values == 1).any(axis=1)
            self._rows, values = self._rows[keep], values[keep]
            rows = np.where(values == 0, self._rows, 0)
            rows.sort(axis=1)
            low, middle, high = rows.T
            distinct = 1 + (low != middle) * 1 + (middle != high) * 1 - (values < 0).any(axis=1)
            if (distinct == 0).any():
                raise ContradictionError
            single = distinct == 1
            if not single.any():
                return
            self._set(rows[single].sum(axis=1) // (rows[single] != 0).sum(axis=1))

    def _known(self) -> Values:
        """For each pair 1, -1, or 0 if its order is open."""
        return self._value[self._literal + self.size]

    def _above(self) -> csr_matrix:
        """A matrix with 1 at (i, j) if j is known to lie above i."""
        known, pairs, n = self._known(), self.overlaps.pairs, self.overlaps.count
        up, down = pairs[known > 0], pairs[known < 0]
        rows = np.concatenate([up[:, 0], down[:, 1]])
        columns = np.concatenate([up[:, 1], down[:, 0]])
        return csr_matrix((np.ones(len(rows), dtype=np.int32), (rows, columns)), shape=(n, n))

    def _close(self) -> None:
        """Take in what follows from two relations, until nothing more does."""
        while True:
            self.clock.check()
            above = self._above()
            if self.progress is not None:
                self.progress("layers", above.nnz, self.constraints.variables)
            steps = (above @ above).tocoo()
            lower, upper = steps.row.astype(np.int64), steps.col.astype(np.int64)
            dense = above.toarray().astype(bool)
            keep = self.overlaps.overlapping[lower, upper] & ~dense[lower, upper]
            lower, upper = lower[keep], upper[keep]
            if not len(lower) or not self._step(dense, lower, upper):
                return

    def _step(self, above: npt.NDArray[np.bool_], lower: Indices, upper: Indices) -> bool:
        """Test what lies between the pieces of each pair; whether a relation was found."""
        found = False
        step = max(1, (1 << 24) // self.overlaps.count)
        for start in range(0, len(lower), step):
            a, c = lower[start : start + step], upper[start : start + step]
            row, b = np.nonzero(above[a] & above[:, c].T)
            triples = np.stack([a[row], b, c[row]], axis=1)
            keys = self._key(triples)
            fresh = ~np.isin(keys, self._apart)
            row, triples, keys = row[fresh], triples[fresh], keys[fresh]
            done = self._first_of_each(row, triples)
            found |= bool(done.any())
            none = keys[~done[row]]
            self._apart = np.concatenate([self._apart, none])
        if found:
            self._propagate()
        return found

    def _key(self, triples: Indices) -> Indices:
        some = np.sort(triples, axis=1)
        n = self.overlaps.count
        return (some[:, 0] * n + some[:, 1]) * n + some[:, 2]

    def _test(self, triples: Indices) -> npt.NDArray[np.bool_]:
        """Test triples, and take in the clauses of those with a common open set."""
        have = self.common.have(triples)
        self._tests += len(triples)
        if have.any():
            self._used.append(triples[have])
            rows = self._class(self.constraints.triples(triples[have]))
            self._take(np.concatenate([rows, -rows]))
        return have

    def _open(self) -> None:
        """Take in the triples with two or three open relations.

        Of those with the same clauses, tests end with the first that has a common open set. A
        triple with two relations of one class, in opposite directions, restricts nothing.
        """
        overlapping, n = self.overlaps.overlapping, self.overlaps.count
        pairs = self.overlaps.pairs[self._known() == 0]
        if not len(pairs):
            return
        free = np.zeros((n, n), dtype=bool)
        free[pairs[:, 0], pairs[:, 1]] = free[pairs[:, 1], pairs[:, 0]] = True
        rows: Indices = np.zeros((0, 3), dtype=np.int64)
        triples = rows
        step = max(1, (1 << 24) // n)
        for start in range(0, len(pairs), step):
            self.clock.check()
            a, b = pairs[start : start + step].T
            row, c = np.nonzero(overlapping[a] & overlapping[b] & (free[a] | free[b]))
            some = np.sort(np.stack([a[row], b[row], c], axis=1), axis=1)
            _, first = np.unique(self._key(some), return_index=True)
            some = some[first]
            these = np.sort(self._class(self.constraints.triples(some)), axis=1)
            these[(these > 0).sum(axis=1) < 2] *= -1
            these.sort(axis=1)
            low, middle, high = these.T
            keep = (low != -middle) & (low != -high) & (middle != -high)
            rows = np.concatenate([rows, these[keep]])
            triples = np.concatenate([triples, some[keep]])
            if len(triples) > _TRIPLES:
                raise TooManyModesError("too many triples of pieces have an open order")
        _, group = np.unique(self._code(rows), return_inverse=True)
        order = np.argsort(group, kind="stable")
        self._first_of_each(group.ravel()[order], triples[order])
        self._propagate()

    def _first_of_each(self, group: Indices, triples: Indices) -> npt.NDArray[np.bool_]:
        """Test triples, group by group, some at once; those groups of which one is common."""
        done = np.zeros(int(group.max(initial=-1)) + 1, dtype=bool)
        tested = 0
        while len(group):
            self.clock.check()
            if self.progress is not None:
                self.progress("common parts", tested, 0)
            starts = np.concatenate([[True], group[1:] != group[:-1]])
            first = np.maximum.accumulate(np.where(starts, np.arange(len(group)), 0))
            now = np.arange(len(group)) - first < _AT_ONCE
            have = self._test(triples[now])
            tested += int(now.sum())
            done[group[now][have]] = True
            rest = ~now & ~done[group]
            group, triples = group[rest], triples[rest]
        return done

    # --- what is left ----------------------------------------------------------------------------

    def _components(self) -> Orders:
        known = self._known()
        free = np.nonzero(self._value[self.size + 1 :] == 0)[0] + 1
        rows = np.where(self._value[self._rows + self.size] == 0, self._rows, 0)
        ends = [
            abs(rows[:, [i, j]])[(rows[:, i] != 0) & (rows[:, j] != 0)]
            for i, j in ((0, 1), (1, 2), (0, 2))
        ]
        links = np.concatenate(ends)
        ones = np.ones(len(links), dtype=np.int8)
        graph = coo_matrix((ones, (links[:, 0], links[:, 1])), shape=(self.size + 1,) * 2)
        _, labels = connected_components(graph, directed=False)
        pairs_of: dict[int, list[int]] = {}
        for pair in np.nonzero(known == 0)[0].tolist():
            pairs_of.setdefault(int(labels[abs(self._literal[pair])]), []).append(pair)
        clauses_of: dict[int, list[list[int]]] = {}
        for row in rows.tolist():
            clause = sorted({x for x in row if x})
            clauses_of.setdefault(int(labels[abs(clause[0])]), []).append(clause)
        variables_of: dict[int, list[int]] = {}
        for variable in free.tolist():
            variables_of.setdefault(int(labels[variable]), []).append(variable)
        made, stopped = [], ""
        order = sorted(variables_of, key=lambda name: (len(variables_of[name]), name))
        for done, name in enumerate(order):
            if self.progress is not None:
                self.progress("components", done, len(order))
            component, why = self._component(
                variables_of[name], clauses_of.get(name, []), np.array(pairs_of[name])
            )
            made.append(component)
            stopped = stopped or why
        return Orders(known, tuple(made), self.used, False, stopped, self._tests)

    def _component(
        self, variables: Sequence[int], clauses: Sequence[Sequence[int]], pairs: Indices
    ) -> tuple[Component, str]:
        kept: list[Values] = []
        count, stopped = 0, ""
        literal = self._literal[pairs]
        try:
            for model in models(variables, clauses, self.clock):
                count += 1
                if len(kept) < self.most:
                    value = np.zeros(2 * self.size + 1, dtype=np.int8)
                    value[np.array(model) + self.size] = 1
                    value[self.size - np.array(model)] = -1
                    kept.append(value[literal + self.size])
        except TooManyModesError as error:
            stopped = str(error)
        if not count and not stopped:
            raise ContradictionError
        states = np.array(kept, dtype=np.int8).reshape(len(kept), len(pairs))
        return Component(pairs, states, None if stopped else count, count), stopped


def models(
    variables: Sequence[int], clauses: Sequence[Sequence[int]], clock: Clock = UNLIMITED
) -> Iterator[list[int]]:
    """All assignments of variables that satisfy clauses, each as a list of literals.

    A solver looks for one at each branch of a tree of decisions, and its unit propagation for what
    follows. Raises `TooManyModesError` if the time is over.

    >>> sorted(models([1, 2], [[1, 2]]))
    [[-1, 2], [1, -2], [1, 2]]
    """
    if not clauses and len(variables) == 1:
        yield from ([variables[0]], [-variables[0]])
        return
    with solver(clauses) as found:
        stack: list[tuple[list[int], list[int] | None]] = [([], None)]
        while stack:
            clock.check()
            decided, model = stack.pop()
            if model is None:
                if not found.solve(decided):
                    continue
                model = found.get_model()
            _, forced = found.propagate(decided)
            known = set(forced) | set(decided)
            open_ = [v for v in variables if v not in known and -v not in known]
            if not open_:
                yield [v if v in known else -v for v in variables]
                continue
            value = model[open_[0] - 1] if open_[0] <= len(model) else open_[0]
            stack += [([*decided, -value], None), ([*decided, value], model)]


def solver(clauses: Sequence[Sequence[int]]) -> Any:
    """A solver for clauses."""
    from pysat.solvers import Solver  # loaded where it is used

    return Solver("glucose4", bootstrap_with=clauses)
