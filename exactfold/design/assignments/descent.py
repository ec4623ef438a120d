"""A search for rays with few other letters that pops one or two vertices at a time."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from itertools import combinations

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED
from exactfold.branches.counting.find import BranchFinder
from exactfold.branches.values.letters import differing
from exactfold.design.assignments.result import MatchedRay
from exactfold.design.refutations.refutation import Letters
from exactfold.pattern.crease_pattern import CreasePattern


@dataclass
class Descent:
    """Finds branches one by one, at most `finds` of them, and remembers what it has found.

    If it finds nothing, nothing follows.
    """

    pattern: CreasePattern
    letters: Letters
    finds: int
    progress: Progress | None = None
    seen: dict[tuple[int, ...], tuple[int, tuple[MatchedRay, ...]]] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.finder = BranchFinder(self.pattern)
        self.done = 0

    def leaning(self) -> dict[int, int]:
        """For each vertex, the sign that most of its letters suggest: mountains suggest up."""
        signs = {}
        for v in self.finder.poppable:
            near = [letter for fold, letter in self.letters.items() if v in fold and letter in "MV"]
            signs[v] = 1 if 2 * near.count("M") >= len(near) else -1
        return signs

    def descended(self, signs: Mapping[int, int]) -> list[MatchedRay]:
        """Descend from these signs of all vertices that can pop, and return the rays found on the
        way.
        """
        here = dict(signs)
        best, rays = self._looked_at(here)
        all_rays = [*rays]
        moved = True
        while moved and best and self.done < self.finds:
            moved = False
            for moves in self._moves(here):
                there = here | {v: -here[v] for v in moves}
                distance, rays = self._looked_at(there)
                all_rays += rays
                if distance < best:
                    here, best, moved = there, distance, True
                    break
                if self.done >= self.finds:
                    break
        return all_rays

    def _looked_at(self, signs: Mapping[int, int]) -> tuple[int, tuple[MatchedRay, ...]]:
        """The two rays with these signs, and the least number of letters at which one of them
        differs.
        """
        key = tuple(signs[v] for v in self.finder.poppable)
        if key not in self.seen:
            rays = []
            for side in (1, -1):
                self.done += 1
                if self.progress is not None:
                    self.progress("branches near the letters", self.done, self.finds)
                branch = self.finder.find({v: side * sign for v, sign in signs.items()})
                if branch.status is PROVED:
                    rays.append(MatchedRay(branch, side))
            far = len(self.letters) + 1
            distance = min((sum(map(len, self._differing(h))) for h in rays), default=far)
            self.seen[key] = distance, tuple(rays)
        return self.seen[key]

    def _differing(self, ray: MatchedRay) -> tuple[list[tuple[int, int]], list[tuple[int, int]]]:
        return differing(self.letters, ray.assignment)

    def _moves(self, signs: Mapping[int, int]) -> Iterator[tuple[int, ...]]:
        """The sets of vertices to pop: first single ends of folds with another letter, then pairs.

        Vertices with the most such folds come first.
        """
        _, rays = self._looked_at(signs)
        wrong: Counter[int] = Counter()
        for ray in rays:
            wrong.update(v for fold in self._differing(ray)[0] for v in fold)
        near = sorted((v for v in self.finder.poppable if v in wrong), key=lambda v: (-wrong[v], v))
        yield from ((v,) for v in near)
        yield from combinations(near, 2)
