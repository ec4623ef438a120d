"""The search through the vertex signs that given letters allow; subclasses decide the leaves."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections import deque
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Generic, Protocol, TypeVar

from exactfold.design.refutations.clauses import Clauses, Refuted, bits_of
from exactfold.design.refutations.cone_program import Witness
from exactfold.design.refutations.refutation import Letters, Refutation, refuted_at
from exactfold.pattern.crease_pattern import CreasePattern, Edge

_REMEMBERED = 512
"""Sign vectors that seem possible are kept, so that no cone program is solved for a part of them.
"""

_MANY = 16
"""So many leaves are many: with fewer, time hardly matters, and refutations say more."""

Step = tuple[Any, ...]
"""The kind of a step of a `Tree`, followed by its numbers."""

Leaf = TypeVar("Leaf")


@dataclass(frozen=True)
class Tree(Generic[Leaf]):
    """How the search covered all signs of the vertices.

    `steps` are in the order in which the tree is walked. ("force", k, v): all signs of the k-th
    refuted set but that of v hold, so v has the opposite sign. ("split", v): the following steps
    first treat v up, then v down. ("refuted", k): the signs contain the k-th refuted set.
    ("leaf",): all vertices have signs, and the next entry of `leaves` is about these signs.
    ("flat", i, j): a mountain or a valley is asked for at a fold where the sheet stays flat. The
    vertices are those of the sheet without the folds and vertices inside triangulated triangles,
    except in "flat", which has those of the pattern.
    """

    refuted: tuple[Refuted, ...]
    steps: tuple[Step, ...]
    leaves: tuple[Leaf, ...]

    @property
    def refutations(self) -> tuple[Refutation, ...]:
        """The refutations by vectors among the refuted sets."""
        return tuple(each.refutation for each in self.refuted if each.refutation is not None)


class Program(Protocol):
    """A program that proposes refutations: `ConeProgram` or `BendProgram`."""

    def solved(self, signs: Mapping[int, int]) -> Refutation | Witness | None:
        """Return a verified refutation, else signs that seem possible, or None if neither
        is found.
        """


class SignSearch(ABC, Generic[Leaf]):
    """The search tree of vertex signs of a sheet that has nothing inside triangulated triangles.

    `letters` are given by fold of the pattern; vertex v of `sheet` is vertex `labels[v]` of the
    pattern. A subclass says in `_at_leaf` what happens once all vertices have signs; this happens
    for at most `most` sign vectors. `open` contains the signs, by vertex of the pattern, for which
    the question remains open.
    """

    compared_at_once = -1
    """Once there are many leaves and no more vertices than this are without a sign, no program is
    solved: all signs of them that the known refuted sets leave become leaves.
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
        self.clauses = Clauses()
        self.possible: deque[int] = deque(maxlen=_REMEMBERED)
        self.steps: list[Step] = []
        self.reasons: list[str] = []
        self.open: list[dict[int, int]] = []
        self.leaves: list[Leaf] = []
        self.done = False

    @property
    @abstractmethod
    def program(self) -> Program:
        """The program that proposes refutations."""

    @abstractmethod
    def _at_leaf(self, signs: dict[int, int]) -> Leaf:
        """What is found for these signs of all vertices, given by vertex of the sheet."""

    def searched(self) -> None:
        """Cover all signs; stop early once `done` is set."""
        if not self._stays_flat():
            self._at_vertices()
            self._search()

    def tree(self) -> Tree[Leaf]:
        """The tree of the search, with only those refuted sets that it uses."""
        used = sorted({at[0] for kind, *at in self.steps if kind in ("force", "refuted")})
        place = {number: k for k, number in enumerate(used)}
        refuted = tuple(self.clauses.known[number] for number in used)
        steps = tuple(
            (kind, place[at[0]], *at[1:]) if kind in ("force", "refuted") else (kind, *at)
            for kind, *at in self.steps
        )
        return Tree(refuted, steps, tuple(self.leaves))

    def named(self, signs: Mapping[int, int]) -> dict[int, int]:
        """The signs by vertex of the pattern."""
        return {self.labels[v]: sign for v, sign in signs.items()}

    def _stays_flat(self) -> bool:
        """Whether a mountain or valley is asked for inside a triangulated triangle."""
        moving = {_fold(self.labels[i], self.labels[j]) for i, j in self.sheet.folds}
        for fold, letter in self.letters.items():
            if letter in "MV" and fold not in moving:
                self.reasons.append(f"fold {fold} lies in a triangulated triangle and stays flat")
                self.steps.append(("flat", *fold))
                return True
        return False

    def _at_vertices(self) -> None:
        """Learn which signs single stars refute; stop at a vertex that has no sign left."""
        for v in self.sheet.interior:
            left = 2
            for sign in (1, -1):
                reason = refuted_at(self.sheet, self.own, v, sign)
                if isinstance(reason, str):
                    self.reasons.append(f"vertex {self.labels[v]} {reason}")
                    self.clauses.learn(Refuted({v: sign}, None))
                    left -= 1
                elif reason is not None and reason.holds(self.sheet, self.own):
                    self.clauses.learn(Refuted(reason.signs, reason))
                    left -= 1
            if not left:
                return

    def _search(self) -> None:
        """Walk through all signs that are not refuted."""
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
        """The signs together with all signs found to follow from them; None if they contradict."""
        signs = self._forced(before)
        if signs is None:
            return None
        unknown = len(self.sheet.interior) - len(signs)
        if unknown <= self.compared_at_once and len(self.leaves) >= _MANY:
            return signs
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
        """The vertices, those that most refutations name first."""
        return sorted(vertices, key=lambda v: -self.clauses.weight[v])

    def _forced(self, signs: dict[int, int]) -> dict[int, int] | None:
        """The signs together with those that refuted sets force; None if they contradict."""
        forced = self.clauses.forced(signs)
        self.steps += [("force", number, v) for number, v in forced.steps]
        if forced.contradicted is None:
            return forced.signs
        self.steps.append(("refuted", forced.contradicted))
        return None

    def _seems_possible(self, signs: dict[int, int]) -> bool:
        """False if the program refutes the signs; the refutation is then learned."""
        wanted = bits_of(signs)
        if any(wanted & known == wanted for known in self.possible):
            return True
        answer = self.program.solved(signs)
        if isinstance(answer, Refutation):
            self.clauses.learn(Refuted(answer.signs, answer))
            return False
        if answer is not None:
            self.possible.appendleft(bits_of(answer))
        return True


def _fold(i: int, j: int) -> Edge:
    return (i, j) if i < j else (j, i)
