"""The relations accepted so far, with the equations they make, and the rule for accepting more."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import NamedTuple

from exactfold.pattern.drawing.meant.drawn import Drawn, gathered
from exactfold.pattern.drawing.meant.noise import CHANCE
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
    by chance.
    """

    drawn: Drawn
    tolerance: float
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
        chance explains less than `CHANCE` of those found, and so are all that hold exactly as
        written. Relations that follow from others are left out.
        """
        expected, hits, last = 0.0, 0, 0
        for number, (probability, relation) in enumerate(trials, 1):
            if relation is None or relation.defect:
                expected += probability
                hits += relation is not None
                if expected < CHANCE * hits:
                    last, chance = number, expected
        if last:
            self.chance += chance
        for number, (_, relation) in enumerate(trials, 1):
            if (
                relation is not None
                and (number <= last or not relation.defect)
                and not self.is_implied(relation.terms, relation.parts)
            ):
                self.add([relation])

    def free(self) -> list[Edge]:
        """The edges whose angles are free so far, the longest first.

        The shortest edges of an equation are solved for first, so that each free edge is the
        longest of those that are parallel to it by the relations.
        """
        free = [edge for edge in self.drawn.edges if not self.system.is_solved(edge)]
        return sorted(free, key=lambda edge: -self.drawn.lengths[edge])
