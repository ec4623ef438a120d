"""The relations accepted so far, with the equations they make, and the rule for accepting more."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from typing import NamedTuple

from exactfold.pattern.drawing.meant.drawn import Drawn, gathered
from exactfold.pattern.drawing.meant.noise import LOOKED_FOR, TOLERANCE, is_rare
from exactfold.pattern.drawing.meant.system import System
from exactfold.pattern.drawing.meant.values import Edge, Relation


class Trial(NamedTuple):
    """A look for a relation: what was found, and how likely chance finds one as good."""

    probability: float
    relation: Relation | None


@dataclass
class Accepted:
    """Relations that hold in the meant sheet, and the edge angles that they leave free.

    Each relation becomes an equation between real angles near the drawn ones: the sum of angles is
    the multiple of pi / `parts` that is nearest to the drawn sum. `contradicting` holds relations
    that no sheet has together with those before them. `chance` is the number of relations expected
    by chance. A relation may be missed by up to `tolerance`, and digits cannot tell a defect below
    `floor` from 0; both are lengths over the size.
    """

    drawn: Drawn
    tolerance: float
    floor: float
    relations: list[Relation] = field(default_factory=list)
    contradicting: list[Relation] = field(default_factory=list)
    chance: float = 0.0
    system: System[Edge] = field(init=False)

    def __post_init__(self) -> None:
        lengths = self.drawn.lengths
        self.system = System(lambda edge: lengths[edge])

    def is_implied(self, terms: Sequence[tuple[Edge, int]], parts: int = 1) -> bool:
        """Whether a relation with these terms follows from those accepted."""
        left, value = self.system.rest(gathered(terms), self.drawn.turns(terms, parts))
        return not left and not value

    def has(self, relation: Relation) -> bool:
        """Whether a relation was accepted, perhaps as one of another kind with the same terms."""
        terms = {frozenset((edge, sign * n) for edge, n in relation.terms) for sign in (1, -1)}
        alike = any(frozenset(known.terms) in terms for known in self.relations)
        return alike and self.is_implied(relation.terms, relation.parts)

    def add(self, relations: Iterable[Relation]) -> None:
        """Accepts relations."""
        for relation in relations:
            terms, value = dict(relation.terms), self.drawn.turns(relation.terms, relation.parts)
            new = self.system.add(terms, value)
            if not new and self.system.rest(terms, value)[1]:
                self.contradicting.append(relation)
            else:
                self.relations.append(relation)

    def believe(self, trials: Sequence[Trial]) -> None:
        """Accepts what was found, as far as chance hardly finds so much.

        The trials stand with the surest first. Relations are accepted up to the last trial by which
        chance explains few of those found (`is_rare`). The same holds for those that are missed
        by no more than the noise, which chance finds less often; as this is a second look at
        them, chance counts twice. And it holds for those that are satisfied exactly, for which
        chance has to hit the last digit. Relations that follow from others are left out.
        """
        exactly = min(1.0, self.floor / self.tolerance)
        last = self._last([(p, r is not None) for p, r in trials])
        looks = [(p if p == 1 else 2 * p / TOLERANCE, self._is_close(r)) for p, r in trials]
        last_close = self._last(looks)
        last_exact = self._last([(exactly * p, _is_exact(r)) for p, r in trials])
        for number, (_, relation) in enumerate(trials, 1):
            if relation is None:
                continue
            believed = number <= max(
                last,
                last_close if self._is_close(relation) else 0,
                last_exact if _is_exact(relation) else 0,
            )
            if believed and not self.is_implied(relation.terms, relation.parts):
                self.add([relation])

    def _is_close(self, relation: Relation | None) -> bool:
        return relation is not None and relation.defect <= self.tolerance / TOLERANCE

    def _last(self, trials: Sequence[tuple[float, bool]]) -> int:
        """How many trials there are up to the last one by which chance explains few of the hits."""
        expected, hits, last, chance = 0.0, 0, 0, 0.0
        for number, (probability, hit) in enumerate(trials, 1):
            expected += probability
            hits += hit
            if is_rare(expected, hits, unlikely=LOOKED_FOR):
                last, chance = number, expected
        self.chance += chance
        return last

    def reasons(self, relations: Iterable[Relation]) -> list[tuple[str, ...]]:
        """For each relation, the names of accepted relations that imply or contradict it."""
        lengths = self.drawn.lengths
        # Each accepted relation has an unknown of its own, its index, which is never solved for.
        system: System[Edge | int] = System(lambda u: None if isinstance(u, int) else lengths[u])
        for number, known in enumerate(self.relations):
            terms: dict[Edge | int, int] = {**dict(known.terms), number: -1}
            system.add(terms, self.drawn.turns(known.terms, known.parts))
        reasons = []
        for relation in relations:
            left, _ = system.rest(dict(relation.terms), Fraction(0))
            numbers = sorted(number for number in left if isinstance(number, int))
            reasons.append(tuple(self.relations[number].name for number in numbers))
        return reasons

    def free(self) -> list[Edge]:
        """The edges whose angles are free so far, the longest first.

        The shortest edges of an equation are solved for first, so that each free edge is the
        longest of those that are parallel to it by the relations.
        """
        free = [edge for edge in self.drawn.edges if not self.system.is_solved(edge)]
        return sorted(free, key=lambda edge: -self.drawn.lengths[edge])


def _is_exact(relation: Relation | None) -> bool:
    return relation is not None and not relation.defect
