"""`nearest_branches`: the branches whose letters differ from given ones at the fewest folds."""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from itertools import count

from exactfold._support.progress import Progress
from exactfold._support.verdict import PROVED, UNDECIDED, Verdict
from exactfold.branches.counting.collect import count_branches
from exactfold.branches.values.letters import differing
from exactfold.design.assignments.conflicts import (
    Clause,
    Folds,
    Stars,
    clause_of,
    disjoint,
    to_blame,
)
from exactfold.design.assignments.descent import Descent
from exactfold.design.assignments.result import Match, MatchedRay, NearestDocument
from exactfold.design.assignments.search import match
from exactfold.design.assignments.why import fold_text
from exactfold.pattern.crease_pattern import Edge

LISTED = 12
"""On sheets with up to this many foldable vertices, all branches are listed."""
_MOST, _LEAST = 1000, 8
"""The most searches of a sheet with one vertex, divided by the number of vertices for others, and
the least number for any sheet.
"""
_FINDS = 6
"""The number of branches that are found one by one, for each of the searches."""
_LOCAL = 10
"""Refuting this many sets of folds by single stars takes about the time of one full search."""


@dataclass(frozen=True, repr=False)
class Nearest:
    """The rays whose letters differ at the fewest folds from those of `match`.

    A ray is one of the two halves of a branch. Each ray of `rays` differs at `distance` folds. If
    none was found, `distance` is None and `rays` is empty. It is proved that every ray differs at
    `at_least` folds or more. So `status` is PROVED if `distance` equals `at_least`; if `status` is
    UNDECIDED, `rays` are the nearest rays that were found. `complete` is true if no other ray is
    as near. `by` is "match" if some ray has the letters, "list" if all branches were listed, and
    "search" otherwise.
    """

    match: Match
    status: Verdict
    distance: int | None
    at_least: int
    rays: tuple[MatchedRay, ...]
    complete: bool
    by: str

    def differences(self, ray: MatchedRay) -> dict[Edge, tuple[str, str]]:
        """For each fold at which a ray differs: the letter wanted, and the letter of the ray."""
        letters = ray.assignment
        wanted = self.match.letters
        return {f: (wanted[f], letters[f]) for f in differing(wanted, letters)[0]}

    def to_dict(self) -> NearestDocument:
        """The key `nearest` of the JSON of a match."""
        return {
            "status": str(self.status),
            "distance": self.distance,
            "at_least": self.at_least,
            "complete": self.complete,
            "by": self.by,
            "branches": [
                {
                    **ray.to_dict(),
                    "differences": [
                        {"fold": fold_text(fold), "wanted": wanted, "actual": actual}
                        for fold, (wanted, actual) in sorted(self.differences(ray).items())
                    ],
                }
                for ray in self.rays
            ],
        }

    def __repr__(self) -> str:
        far = "none found" if self.distance is None else f"distance {self.distance}"
        return f"<Nearest: {self.status}, {far}, at least {self.at_least}, {len(self.rays)} halves>"


def nearest_branches(
    matched: Match, *, tries: int | None = None, progress: Progress | None = None
) -> Nearest:
    """Find the rays whose letters differ at the fewest folds from those of a match.

    If the sheet has at most 12 foldable vertices, all branches are listed. Otherwise sets of folds
    are freed, the smallest sets first, until some ray has the letters of the other folds. Where no
    ray has them, the refutations name folds at one of which every ray differs, so only these folds
    need to be freed next (docs/assignment.md, The nearest branches). Besides, vertices are popped
    one by one as long as more letters agree.

    `tries` limits the number of sets for which `match` is run; by default it is 1000 divided by the
    number of foldable vertices, but at least 8. At most half of these tries look for further rays
    as near as one that is proved to be nearest. Rays that are not proved to be nearest have status
    UNDECIDED. Raises the errors of `count_branches`.

    >>> from exactfold.pattern.triangulating.random_squares import random_square
    >>> none = match(random_square(8, seed=1), "VMMVMVVMMVVMMVMVMMVVMVVVM")
    >>> near = nearest_branches(none)
    >>> near
    <Nearest: proved, distance 1, at least 1, 1 halves>
    >>> near.differences(near.rays[0])
    {(0, 4): ('V', 'M')}
    """
    if matched.matches:
        complete = matched.status is PROVED
        return Nearest(matched, PROVED, 0, 0, matched.matches, complete, "match")
    if matched.sheet.Vi <= LISTED:
        listed = _listed(matched, progress)
        if listed is not None:
            return listed
    return _NearestSearch(matched, tries, progress).result()


def _listed(matched: Match, progress: Progress | None) -> Nearest | None:
    """The nearest rays of all branches.

    None if some branch is not proved, or if an unproved letter could change the answer.
    """
    listed = count_branches(matched.pattern, progress=progress)
    if listed.status is not PROVED:
        return None
    rays = [MatchedRay(branch, side) for branch in listed.branches for side in (1, -1)]
    sets = [differing(matched.letters, ray.assignment) for ray in rays]
    least = min(len(other) + len(unknown) for other, unknown in sets)
    if any(unknown and len(other) <= least for other, unknown in sets):
        return None
    near = [h for h, (other, _) in zip(rays, sets, strict=True) if len(other) == least]
    return Nearest(matched, PROVED, least, least, tuple(near), True, "list")


class _NearestSearch:
    """The search over sets of freed folds; the set with the least bound comes first.

    A set F stands for the rays that differ at all folds of F. If no unknown ray has the letters of
    the folds outside F, every unknown ray of F also differs at a fold of some set C. So the sets
    that consist of F and one fold of C take the place of F. Every unknown ray differs at no fewer
    folds than the least bound of the sets that are left.
    """

    def __init__(self, matched: Match, tries: int | None, progress: Progress | None) -> None:
        self.matched, self.progress = matched, progress
        n = matched.sheet.Vi
        self.tries = max(_LEAST, _MOST // n) if tries is None else tries
        labels = matched.labels
        moving = {
            (min(labels[i], labels[j]), max(labels[i], labels[j])) for i, j in matched.sheet.folds
        }
        self.stuck = [f for f, x in matched.letters.items() if x in "MV" and f not in moving]
        """Folds inside triangulated triangles; every ray differs at them."""
        self.letters = {f: x if f in moving else "U" for f, x in matched.letters.items()}
        own = {
            (i, j): self.letters[min(labels[i], labels[j]), max(labels[i], labels[j])]
            for i, j in matched.sheet.folds
        }
        self.stars = Stars(matched.sheet, own, labels)
        self.known: dict[tuple[str, int], MatchedRay] = {}
        self.unclear: int | None = None
        self.tried = 0

    def result(self) -> Nearest:
        bound = self._bound(frozenset())
        for _, rays in self.matched.compared:
            self._note(rays)
        descent = Descent(self.matched.pattern, self.letters, _FINDS * self.tries, self.progress)
        alone: dict[int, set[int]] = {}
        for clause in self.stars.clauses(frozenset()):
            for v, sign in clause.signs:
                alone.setdefault(v, set()).add(-sign)
        forced = {v: sign for v, (sign, *more) in alone.items() if not more}
        starts = [signs for signs, _ in self.matched.compared[:1]] or [forced]
        self._note(descent.descended(descent.leaning() | dict(starts[0])))
        left = self._freed(bound)
        best = self._best()
        bounds = [bound for bound in (left, best, self.unclear) if bound is not None]
        at_least = min(bounds, default=len(self.stuck))
        others = [bound for bound in (left, self.unclear) if bound is not None]
        return Nearest(
            self.matched,
            PROVED if best is not None and best == at_least else UNDECIDED,
            best,
            at_least,
            () if best is None else self._at(best),
            best is not None and all(bound > best for bound in others),
            "search",
        )

    def _freed(self, bound: int) -> int | None:
        """A lower bound of the distance of all unknown rays; None if there are no unknown rays."""
        order = count()
        queue: list[tuple[int, int, Folds]] = [(bound, next(order), frozenset())]
        seen: set[Folds] = {frozenset()}
        open_: list[int] = []
        stars = 0
        while queue:
            bound, _, freed = queue[0]
            best = self._best()
            distance = bound + len(self.stuck)
            tries = self.tries // 2 if distance == best else self.tries
            over = self.tried >= tries or stars >= _LOCAL * tries
            if (best is not None and distance > best) or over:
                break
            heapq.heappop(queue)
            stars += 1
            blamed = self._blamed(freed)
            if blamed is None:
                open_.append(bound)
                continue
            sets = [freed | {fold} for fold in sorted(blamed - freed)]
            bounds = {more: max(bound, self._bound(more)) for more in sets if more not in seen}
            seen |= bounds.keys()
            for more, larger in bounds.items():
                heapq.heappush(queue, (larger, next(order), more))
            best = self._best()
            near = sum(row[0] + len(self.stuck) == best for row in queue)
            if best == distance and self.tried + near > self.tries // 2:
                break  # too few tries are left for all sets that may be as near
        left = [*open_, *(row[0] for row in queue[:1])]
        return min(left) + len(self.stuck) if left else None

    def _letters(self, freed: Folds) -> dict[Edge, str]:
        return {f: "U" if f in freed else x for f, x in self.letters.items()}

    def _bound(self, freed: Folds) -> int:
        return len(freed) + disjoint(self.stars.conflicts(freed))

    def _blamed(self, freed: Folds) -> Folds | None:
        """A set of folds such that every unknown ray has another letter at one of them, or None.

        Every ray found to have the letters is noted.
        """
        matched = self.matched
        conflicts = self.stars.conflicts(freed)
        if conflicts:
            return min(conflicts.values(), key=lambda folds: (len(folds), sorted(folds)))
        if freed or self.stuck:
            self.tried += 1
            if self.progress is not None:
                self.progress("letters freed", self.tried, self.tries)
            matched = match(matched.pattern, self._letters(freed))
        for _, rays in matched.compared:
            self._note(rays)
        if matched.status is not PROVED:
            return None
        clauses = [clause_of(refutation, matched.labels) for refutation in matched.refutations]
        clauses += self.stars.clauses(freed)
        clauses += [Clause(frozenset(signs.items()), frozenset()) for signs, _ in matched.compared]
        return to_blame(clauses)

    # --- the rays that are known -----------------------------------------------------------------

    def _note(self, rays: list[MatchedRay] | tuple[MatchedRay, ...]) -> None:
        for ray in rays:
            if ray.branch.status is not PROVED or ray.names in self.known:
                continue
            other, unknown = differing(self.matched.letters, ray.assignment)
            if unknown and (self.unclear is None or len(other) < self.unclear):
                self.unclear = len(other)
            self.known[ray.names] = ray

    def _distance(self, ray: MatchedRay) -> int | None:
        other, unknown = differing(self.matched.letters, ray.assignment)
        return None if unknown else len(other)

    def _best(self) -> int | None:
        known = (self._distance(ray) for ray in self.known.values())
        return min((d for d in known if d is not None), default=None)

    def _at(self, distance: int) -> tuple[MatchedRay, ...]:
        near = (ray for ray in self.known.values() if self._distance(ray) == distance)
        return tuple(sorted(near, key=lambda ray: ray.names))
