"""The search through the signs of vertices that given letters leave, whatever ends it."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

import numpy as np
import numpy.typing as npt

from exactfold.design.refutations.clauses import Clauses, Refuted
from exactfold.design.refutations.cone_program import Witness
from exactfold.design.refutations.refutation import Letters, Refutation, refuted_at
from exactfold.pattern.crease_pattern import CreasePattern, Edge

_REMEMBERED = 512
"""Sign vectors that seem possible, kept so that no cone program is solved for a part of them."""

SignArray = npt.NDArray[np.int8]

Step = tuple[Any, ...]
"""The kind of a step of a `Tree`, then numbers."""

Leaf = TypeVar("Leaf")


@dataclass(frozen=True)
class Tree(Generic[Leaf]):
    """How the signs of all vertices were covered.

    `steps`, in the order in which the tree is walked: ("force", k, v), v has the opposite of its
    sign in the k-th refuted set, of which all others are there; ("split", v), first all that
    follows with v up, then with v down; ("refuted", k), the signs contain the k-th set; ("leaf",),
    all signs are there, and the next of `leaves` is about them; ("flat", i, j), a mountain or a
    valley is asked for where the sheet stays flat. Vertices are those of the sheet without what
    lies in triangulated triangles, but for "flat".
    """

    refuted: tuple[Refuted, ...]
    steps: tuple[Step, ...]
    leaves: tuple[Leaf, ...]

    @property
    def refutations(self) -> tuple[Refutation, ...]:
        """Those of the refuted sets that are refuted by vectors."""
        return tuple(each.refutation for each in self.refuted if each.refutation is not None)


class Program(Protocol):
    """What proposes refutations: `ConeProgram`, `BendProgram`."""

    def solved(self, signs: Mapping[int, int]) -> Refutation | Witness | None:
        """A verified refutation, else signs that seem possible, None if there is no telling."""


class SignSearch(ABC, Generic[Leaf]):
    """The tree of vertex signs, on a sheet without what lies in triangulated triangles.

    `letters` are by fold of the pattern, of which vertex v of `sheet` is `labels[v]`. What is done
    with all signs of a sheet is `_at_leaf`; `most` of them are left to that. `open` has the signs
    for which the question is open, by vertex of the pattern.
    """

    def __init__(
        self,
        sheet: CreasePattern,
        labels: tuple[int, ...],
        letters: Letters,
        most: int,
    ) -> None:
        self.sheet, self.labels, self.letters, self.most = sheet, labels, letters, most
        self.own = {(i, j): letters[_fold(labels[i], labels[j])] for i, j in sheet.folds}
        self.place = {v: k for k, v in enumerate(sheet.interior)}
        self.clauses = Clauses()
        self.possible: deque[SignArray] = deque(maxlen=_REMEMBERED)
        self.steps: list[Step] = []
        self.reasons: list[str] = []
        self.open: list[dict[int, int]] = []
        self.leaves: list[Leaf] = []
        self.done = False

    @property
    @abstractmethod
    def program(self) -> Program:
        """What proposes refutations."""

    @abstractmethod
    def _at_leaf(self, signs: dict[int, int]) -> Leaf:
        """What is known with all signs given, by vertex of the sheet."""

    def searched(self) -> None:
        """Cover all signs, up to `done`."""
        if not self._stays_flat():
            self._at_vertices()
            self._search()

    def tree(self) -> Tree[Leaf]:
        """What the search has done, with the refuted sets that it used."""
        used = sorted({at[0] for kind, *at in self.steps if kind in ("force", "refuted")})
        place = {number: k for k, number in enumerate(used)}
        refuted = tuple(self.clauses.known[number] for number in used)
        steps = tuple(
            (kind, place[at[0]], *at[1:]) if kind in ("force", "refuted") else (kind, *at)
            for kind, *at in self.steps
        )
        return Tree(refuted, steps, tuple(self.leaves))

    def named(self, signs: Mapping[int, int]) -> dict[int, int]:
        """Signs by vertex of the pattern."""
        return {self.labels[v]: sign for v, sign in signs.items()}

    def _stays_flat(self) -> bool:
        """Whether a letter is on a fold inside a triangulated triangle."""
        moving = {_fold(self.labels[i], self.labels[j]) for i, j in self.sheet.folds}
        for fold, letter in self.letters.items():
            if letter in "MV" and fold not in moving:
                self.reasons.append(f"fold {fold} lies in a triangulated triangle and stays flat")
                self.steps.append(("flat", *fold))
                return True
        return False

    def _at_vertices(self) -> None:
        """Learn what the letters of single stars refute, up to one that has no sign left."""
        for v in self.sheet.interior:
            left = 2
            for sign in (1, -1):
                found = refuted_at(self.sheet, self.own, v, sign)
                if isinstance(found, str):
                    self.reasons.append(f"vertex {self.labels[v]} {found}")
                    self.clauses.learn(Refuted({v: sign}, None))
                    left -= 1
                elif found is not None and found.holds(self.sheet, self.own):
                    self.clauses.learn(Refuted(found.signs, found))
                    left -= 1
            if not left:
                return

    def _search(self) -> None:
        """Try all signs that are not refuted."""
        stack: list[dict[int, int]] = [{}]
        while stack and not self.done:
            signs = self._closed(stack.pop())
            if signs is None:
                continue
            unknown = [v for v in self.sheet.interior if v not in signs]
            if not unknown:
                self.steps.append(("leaf",))
                self.leaves.append(self._at_leaf(signs))
            elif len(self.leaves) + len(stack) + 2 > self.most:
                self.open.append(self.named(signs))
            else:
                v = self._by_weight(unknown)[0]
                self.steps.append(("split", v))
                stack += [signs | {v: sign} for sign in (-1, 1)]

    def _closed(self, before: dict[int, int]) -> dict[int, int] | None:
        """The signs with all that is found to follow; None if they contradict."""
        signs = self._forced(before)
        if signs is None:
            return None
        if not self._seems_possible(signs):
            return self._forced(signs)
        for v in self._by_weight([v for v in self.sheet.interior if v not in signs]):
            for sign in (1, -1):
                if v in signs or self._seems_possible(signs | {v: sign}):
                    continue
                signs = self._forced(signs)
                if signs is None:
                    return None
        return signs

    def _by_weight(self, vertices: list[int]) -> list[int]:
        """Those that most refutations name first."""
        return sorted(vertices, key=lambda v: -self.clauses.weight[v])

    def _forced(self, signs: dict[int, int]) -> dict[int, int] | None:
        """The signs with those that the refuted sets force; None if they contradict."""
        forced = self.clauses.forced(signs)
        self.steps += [("force", number, v) for number, v in forced.steps]
        if forced.contradicted is None:
            return forced.signs
        self.steps.append(("refuted", forced.contradicted))
        return None

    def _seems_possible(self, signs: dict[int, int]) -> bool:
        """False if the signs are refuted, which is learned then."""
        at = [self.place[v] for v in signs]
        values = np.array(list(signs.values()), dtype=np.int8)
        if any(np.array_equal(known[at], values) for known in self.possible):
            return True
        found = self.program.solved(signs)
        if isinstance(found, Refutation):
            self.clauses.learn(Refuted(found.signs, found))
            return False
        if found is not None:
            known = np.zeros(len(self.place), dtype=np.int8)
            for v, sign in found.items():
                known[self.place[v]] = sign
            self.possible.appendleft(known)
        return True


def _fold(i: int, j: int) -> Edge:
    return (i, j) if i < j else (j, i)
